"""A running application for each test module, on the real engine."""

from __future__ import annotations

import io
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import structlog
from fastapi import FastAPI
from PIL import Image
from starlette.testclient import TestClient

import service.rendering
import service.rigs
from engine import Rig, texture_names
from service.app import create_app
from service.components import Components
from service.settings import Settings

MakeClient = Callable[..., TestClient]
LOCAL = "http://localhost"


def settings_in(folder: Path, **changes: object) -> Settings:
    """Return settings that touch nothing outside `folder` but the engine's own cache."""
    values = {"data_dir": folder / "data", "cache_dir": folder / "cache", **changes}
    return Settings(**values)  # type: ignore[arg-type]


def api_routes() -> list[tuple[str, str]]:
    """Return method and path of every documented route."""
    paths = create_app(Settings()).openapi()["paths"]
    return [(method.upper(), path) for path, methods in paths.items() for method in methods]


def until(true: Callable[[], bool], *, seconds: float = 30.0) -> None:
    """Wait until `true` holds."""
    deadline = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < deadline, "it did not come true in time"
        time.sleep(0.02)


@pytest.fixture(scope="session", autouse=True)
def short_tracebacks() -> None:
    """Log as the command line does: the arrays of a rig fill books, and take as long to print."""
    plain = structlog.dev.ConsoleRenderer(
        colors=False, exception_formatter=structlog.dev.plain_traceback
    )
    structlog.configure(processors=[structlog.processors.add_log_level, plain])


@pytest.fixture(scope="session", autouse=True)
def no_bake() -> Iterator[None]:
    """Stand-ins for the maps of every rig: a bake takes seconds and is tested with the engine."""

    def stand_in(rig: Rig, **_options: object) -> dict[str, bytes]:
        file = io.BytesIO()
        Image.new("RGB", (4, 4), (180, 130, 110)).save(file, "JPEG")
        return dict.fromkeys(texture_names(rig), file.getvalue())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(service.rigs, "textures_of", stand_in)
        patch.setattr(service.rendering, "textures_of", stand_in)
        yield


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    """A ready application with default limits."""
    app = create_app(settings_in(tmp_path_factory.mktemp("service")))
    with TestClient(app, base_url=LOCAL) as running:
        until(lambda: running.get("/api/ready").status_code == 200, seconds=120)
        yield running


def parts_of(client: TestClient) -> Components:
    """Return the parts of a running application, for what its API does not show."""
    assert isinstance(client.app, FastAPI)
    parts: Components = client.app.state.parts
    return parts


@pytest.fixture
def session(client: TestClient) -> Iterator[str]:
    """A fresh session of the standard rig."""
    answer = client.post("/api/sessions", json={})
    assert answer.status_code == 201, answer.text
    session_id = answer.json()["id"]
    yield session_id
    client.delete(f"/api/sessions/{session_id}")
