"""Textures over HTTP: named, tagged, refused; baked once, in the background, at first sight."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import LOCAL, settings_in, until
from starlette.testclient import TestClient

import service.rigs
from engine import Cancelled, Rig, texture_names
from service.app import create_app

NAMES = ("albedo.jpg", "normal.jpg", "orm.jpg", "wrinkles.jpg", "eye.jpg")


class Bakery:
    """A bake that says what it was asked for and waits to be told to go on."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.go = threading.Event()
        self.stopped = False

    def __call__(  # type: ignore[no-untyped-def]
        self, rig: Rig, bake=None, cancelled=None
    ) -> dict[str, bytes]:
        self.asked.append(rig.name)
        while not self.go.wait(0.01):
            if cancelled():
                self.stopped = True
                raise Cancelled("stopped")
        return dict.fromkeys(texture_names(rig), b"\xff\xd8")


@pytest.fixture
def bakery(monkeypatch: pytest.MonkeyPatch) -> Bakery:
    bakery = Bakery()
    monkeypatch.setattr(service.rigs, "textures_of", bakery)
    return bakery


@pytest.fixture
def fresh(bakery: Bakery, tmp_path: Path) -> Iterator[TestClient]:
    """A ready application that has not baked yet."""
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        until(lambda: client.get("/api/ready").status_code == 200, seconds=120)
        yield client


@pytest.mark.parametrize("name", NAMES)
def test_a_texture_is_sent_once(client: TestClient, name: str) -> None:
    path = f"/api/rigs/standard/textures/{name}"
    answer = client.get(path)
    assert answer.status_code == 200
    assert answer.headers["Content-Type"] == "image/jpeg"
    assert answer.content.startswith(b"\xff\xd8")
    again = client.get(path, headers={"If-None-Match": answer.headers["ETag"]})
    assert (again.status_code, again.content) == (304, b"")


def test_textures_have_tags_of_their_own(client: TestClient) -> None:
    paths = [f"/api/rigs/{rig}/textures/{name}" for rig in ("standard", "amara") for name in NAMES]
    tags = {client.get(path).headers["ETag"] for path in paths}
    assert len(tags) == len(paths)


def test_an_unknown_texture_is_not_found(client: TestClient) -> None:
    answer = client.get("/api/rigs/standard/textures/albedo.png")
    assert answer.status_code == 404
    assert answer.json()["error"] == "unknown_texture"
    assert tuple(answer.json()["known"]) == NAMES
    assert client.get("/api/rigs/nobody/textures/albedo.jpg").json()["error"] == "unknown_rig"


def test_the_paper_s_mask_has_none(client: TestClient) -> None:
    answer = client.get("/api/rigs/paper/textures/albedo.jpg")
    assert answer.status_code == 404
    assert answer.json()["known"] == []
    assert client.get("/api/rigs/paper/expressions/12C.glb").status_code == 200


def test_the_first_face_is_baked_at_the_start_and_another_when_it_is_opened(
    fresh: TestClient, bakery: Bakery
) -> None:
    until(lambda: bakery.asked == ["standard"])
    fresh.post("/api/sessions", json={"rig": "standard"})
    fresh.post("/api/sessions", json={"rig": "amara"})
    assert bakery.asked == ["standard"]  # One at a time, and nobody twice.
    bakery.go.set()
    until(lambda: bakery.asked == ["standard", "amara"])
    assert fresh.get("/api/rigs/amara/textures/eye.jpg").status_code == 200
    assert bakery.asked == ["standard", "amara"]


def test_an_edit_of_the_tissue_bakes_nothing(fresh: TestClient, bakery: Bakery) -> None:
    bakery.go.set()
    session = fresh.post("/api/sessions", json={}).json()["id"]
    assert fresh.patch(f"/api/sessions/{session}/tissue", json={"damping": 50}).status_code == 200
    rig = fresh.get(f"/api/sessions/{session}").json()["rig"]
    assert fresh.get(f"/api/rigs/{rig}/textures/albedo.jpg").status_code == 200
    assert bakery.asked == ["standard"]


def test_faces_move_while_one_is_baked(fresh: TestClient, bakery: Bakery) -> None:
    session = fresh.post("/api/sessions", json={}).json()["id"]
    path = f"/api/sessions/{session}"
    start = fresh.get(path).json()["tick"]
    fresh.put(f"{path}/controls", json={"action_units": {"AU12": 1.0}})
    until(lambda: fresh.get(path).json()["tick"] > start + 10)
    assert fresh.get(f"{path}.glb", params={"textures": 0}).status_code == 200
    assert fresh.get("/api/rigs/standard/surface.glb").status_code == 200
    assert not bakery.go.is_set()


def test_strangers_in_a_loop_fill_no_queue(
    fresh: TestClient, bakery: Bakery, monkeypatch: pytest.MonkeyPatch
) -> None:
    until(lambda: bakery.asked == ["standard"])
    rigs = []
    for skin in range(service.rigs._WAITING_BAKES + 4):
        body = {"recipe": {"skin": skin / 20}, "name": f"stranger {skin}"}
        rigs.append(fresh.post("/api/rigs", json=body).json()["id"])
        session = fresh.post("/api/sessions", json={"rig": rigs[-1]}).json()["id"]
        fresh.delete(f"/api/sessions/{session}")
    bakery.go.set()
    until(lambda: len(bakery.asked) == 1 + service.rigs._WAITING_BAKES)
    assert "stranger 0" not in bakery.asked
    assert fresh.get(f"/api/rigs/{rigs[0]}/textures/albedo.jpg").status_code == 200
    assert bakery.asked[-1] == "stranger 0"


def test_a_service_that_stops_ends_the_bake(tmp_path: Path, bakery: Bakery) -> None:
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL):
        until(lambda: bakery.asked == ["standard"], seconds=120)
    assert bakery.stopped
