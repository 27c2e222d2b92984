"""Kernels are compiled beside a first start, once, by a process that ends with the service."""

from __future__ import annotations

import asyncio
import gc
import importlib
import pickle
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import settings_in, until
from starlette.testclient import TestClient
from typer.testing import CliRunner

from service import compile_process, components, kernels
from service.app import create_app
from service.cli import app as command_line
from service.kernels import begin_compiling, compiled

Scripted = Callable[[str], None]


@pytest.fixture
def scripted(monkeypatch: pytest.MonkeyPatch) -> Scripted:
    """Have another script in place of the compiler, on a machine that never compiled."""

    def put(script: str) -> None:
        monkeypatch.setattr(kernels, "bound", lambda _module: (sys.executable, "-c", script))

    monkeypatch.setattr(kernels, "kernels_are_kept", lambda: False)
    return put


def writing(mark: Path) -> str:
    """Return a script that shows that it runs, for ever."""
    return f"import time\nwhile True: open({str(mark)!r}, 'w').write('.'); time.sleep(0.02)"


def silent(mark: Path) -> bool:
    """Return whether nobody writes any more."""
    mark.unlink()
    time.sleep(0.2)
    return not mark.exists()


def test_the_process_compiles_what_moves_faces(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []
    monkeypatch.setattr(compile_process, "compile_motion", lambda: done.append("motion"))
    assert importlib.import_module(f"service.{kernels._MODULE}") is compile_process
    compile_process.main()
    gc.enable()
    assert done == ["motion"]


def test_it_is_waited_for(scripted: Scripted, tmp_path: Path) -> None:
    done = tmp_path / "done"
    scripted(f"import time; time.sleep(0.3); open({str(done)!r}, 'w')")
    asyncio.run(compiled(begin_compiling()))
    assert done.exists()


def test_what_is_kept_takes_no_process(scripted: Scripted, monkeypatch: pytest.MonkeyPatch) -> None:
    scripted("")
    monkeypatch.setattr(kernels, "kernels_are_kept", lambda: True)
    assert begin_compiling() is None


def test_where_no_process_can_be_had_a_start_goes_on(
    scripted: Scripted, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kernels, "bound", lambda _module: ("/nowhere/python",))
    compiling = begin_compiling()
    assert compiling is None
    asyncio.run(compiled(compiling))


def test_a_service_that_stops_takes_along_what_was_begun_before_it(
    scripted: Scripted, tmp_path: Path
) -> None:
    mark = tmp_path / "alive"
    scripted(writing(mark))
    compiling = begin_compiling()
    app = create_app(settings_in(tmp_path), compiling=compiling)
    with TestClient(app, base_url="http://localhost"):
        until(mark.exists)
    assert compiling is not None
    assert compiling.poll() is not None
    assert silent(mark)


def test_a_service_that_cannot_warm_up_does_not_wait_for_it(
    scripted: Scripted, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fail(_rig: object) -> None:
        until(mark.exists)
        raise OSError("no room")

    mark = tmp_path / "alive"
    scripted(writing(mark))
    monkeypatch.setattr(components, "warm_surface", fail)
    with TestClient(create_app(settings_in(tmp_path)), base_url="http://localhost") as client:
        until(lambda: "no room" in client.get("/api/ready").text, seconds=120)
        assert silent(mark)


def test_a_cache_that_cannot_be_read_is_told_of_by_who_needs_it(
    scripted: Scripted, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken() -> bool:
        raise pickle.UnpicklingError("pickle data was truncated")

    scripted("")
    monkeypatch.setattr(kernels, "kernels_are_kept", broken)
    assert begin_compiling() is None


def test_a_service_that_is_refused_leaves_nothing(
    scripted: Scripted, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    begun: list[kernels.Compiling | None] = []

    def begin() -> kernels.Compiling | None:
        begun.append(begin_compiling())
        return begun[-1]

    scripted(writing(tmp_path / "alive"))
    monkeypatch.setattr(kernels, "begin_compiling", begin)
    assert CliRunner().invoke(command_line, ["serve", "--workers", "2"]).exit_code == 2
    (compiling,) = begun
    assert compiling is not None
    assert compiling.poll() is not None
