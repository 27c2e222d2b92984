"""Expressions without a session: tagged by what they show, kept, made apart, cancelled."""

from __future__ import annotations

import asyncio
import io
import os
import socket
from asyncio.subprocess import Process
from collections.abc import Awaitable, Iterator, MutableMapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from conftest import LOCAL, parts_of, settings_in, until
from fastapi import Request
from PIL import Image
from starlette.testclient import TestClient

from engine import Keyframe, builtin_rig, face_to_glb, settled
from service.api.leaving import AskerLeft, while_there
from service.app import create_app
from service.awaited import Awaited
from service.errors import Busy, Refused
from service.expression_orders import Face, FaceOrder
from service.priority import BEHIND
from service.server import running
from service.workshop import WorkEnded, Workshop

TAG_LETTERS = 32
FACES = "/api/rigs/standard/expressions"
BARE = {"textures": "0", "level": "low"}


def test_the_file_is_the_settled_face_and_is_kept(client: TestClient) -> None:
    answer = client.get(f"{FACES}/12C+6B.glb", params=BARE)
    assert answer.status_code == 200, answer.text
    rig = builtin_rig("standard")
    keyframe = Keyframe(action_units={"AU6": 0.4, "AU12": 0.6}, fade=0.15)
    assert answer.content == face_to_glb(
        rig.at_level("low"), settled(rig, [keyframe])[0], textures={}
    )
    folder = parts_of(client).settings.cache_dir / "files"
    kept = folder / f"{answer.headers['ETag'][1:-1]}.glb"
    assert kept.read_bytes() == answer.content
    assert answer.headers["Cache-Control"] == "public, max-age=86400"


def test_the_tag_is_that_of_what_is_shown(client: TestClient) -> None:
    def tag(facs: str, **query: str) -> str:
        asked = {"If-None-Match": "*"}
        answer = client.get(f"{FACES}/{facs}", params=query, headers=asked)
        assert answer.status_code == 304
        assert answer.content == b""
        return answer.headers["ETag"]

    assert tag("6B+12C.glb") == tag("12C+6B.glb") == tag("12:0.6+6:0.4.glb")
    assert tag("0.png") == tag("0.png", view="front", size="512", theme="dark")
    assert tag("0.png", view="-025") == tag("0.png", view="-25")
    different = [
        tag("6B+12C.glb"),
        tag("6B+12C.glb", scale="banded"),
        tag("6B+12C.glb", level="low"),
        tag("6B+12C.glb", textures="0"),
        tag("6B+12C.png"),
        tag("6B+12C.png", size="128"),
        tag("6B+12C.png", view="profile"),
        tag("6B+12C.png", whole="1"),
        tag("6B+12C.png", theme="light"),
        tag("6B+12D.png"),
    ]
    assert len(set(different)) == len(different)


def test_rules_that_it_breaks_are_named(client: TestClient) -> None:
    asked = {"If-None-Match": "*"}
    answer = client.get(f"{FACES}/51C+52C.glb", headers=asked)
    said = client.post("/api/facs", json={"facs": "51C+52C"}).json()["warnings"]
    rules = "; ".join(f"{one['rule']}={'+'.join(one['units'])}" for one in said)
    assert rules
    assert answer.headers["Facs-Warnings"] == rules
    assert "Facs-Warnings" not in client.get(f"{FACES}/12C.glb", headers=asked).headers


@pytest.mark.parametrize("kind", ["glb", "png"])
@pytest.mark.parametrize("facs", ["smile", "99", "12Q", "+".join(["12C"] * 600)])
def test_what_cannot_be_read_is_refused(client: TestClient, kind: str, facs: str) -> None:
    answer = client.get(f"{FACES}/{facs}.{kind}")
    assert answer.status_code == 422
    assert set(answer.json()) <= {"error", "message", "known"}


@pytest.mark.parametrize(
    "query", [{"size": "9"}, {"size": "5000"}, {"view": "behind"}, {"view": "181"}, {"theme": "x"}]
)
def test_a_picture_that_cannot_be_looked_at_so_is_refused(
    client: TestClient, query: dict[str, str]
) -> None:
    answer = client.get(f"{FACES}/12C.png", params=query)
    assert answer.status_code == 422
    assert next(iter(query.values())) in answer.json()["message"]


@pytest.fixture
def unseen(tmp_path: Path) -> Iterator[TestClient]:
    """A service whose viewer is not built."""
    app = create_app(settings_in(tmp_path, viewer_dir=tmp_path / "none"))
    with TestClient(app, base_url=LOCAL) as running:
        yield running


def test_without_a_viewer_pictures_are_501_with_a_sentence(unseen: TestClient) -> None:
    answer = unseen.get(f"{FACES}/12C.png")
    assert answer.status_code == 501
    assert answer.json()["error"] == "no_pictures"
    assert "npm run build" in answer.json()["message"]


def test_without_chromium_pictures_are_501_with_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "viewer").mkdir()
    (tmp_path / "viewer" / "index.html").write_text("a page")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("PLAYWRIGHT_BROWSERS_PATH", str(tmp_path))
    app = create_app(settings_in(tmp_path, viewer_dir=tmp_path / "viewer"))
    with TestClient(app, base_url=LOCAL) as running:
        answer = running.get(f"{FACES}/12C.png")
    assert answer.status_code == 501
    assert "apt install chromium" in answer.json()["message"]


def test_a_picture_shows_the_expression_as_it_is_asked_for(client: TestClient) -> None:
    def picture(facs: str, **query: Any) -> Image.Image:
        answer = client.get(f"{FACES}/{facs}.png", params={"size": 96, **query})
        if answer.status_code == 501:
            pytest.skip(answer.json()["message"])
        assert answer.status_code == 200, answer.text
        assert answer.headers["Content-Type"] == "image/png"
        image = Image.open(io.BytesIO(answer.content)).convert("RGB")
        assert image.size == (96, 96)
        return image

    rest, jaw, light = picture("0"), picture("27E"), picture("27E", theme="light")
    assert rest.tobytes() != jaw.tobytes()
    assert sum(light.getpixel((2, 2))) > 2 * sum(jaw.getpixel((2, 2)))  # type: ignore[arg-type]
    assert picture("27E", view="profile").tobytes() != jaw.tobytes()
    assert _least_niceness(client) >= min(os.getpriority(os.PRIO_PROCESS, 0) + BEHIND, 19)
    before = os.listdir(parts_of(client).settings.cache_dir / "files")
    assert picture("27E").tobytes() == jaw.tobytes()
    assert os.listdir(parts_of(client).settings.cache_dir / "files") == before


def _least_niceness(client: TestClient) -> int:
    """Return the least niceness of any thread of the processes that draw pictures."""
    (process,) = parts_of(client).expressions._pictures._processes.waiting
    parents: dict[int, list[int]] = {}
    for status in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):  # It has ended since.
            parent = int(status.read_text().rpartition(")")[2].split()[1])
            parents.setdefault(parent, []).append(int(status.parent.name))
    family = [process.pid]
    for each in family:
        family += parents.get(each, [])
    assert len(family) > 3, "Chromium has several processes"
    threads = [path for each in family for path in Path(f"/proc/{each}/task").glob("*/stat")]
    found = []
    for status in threads:
        with suppress(OSError):
            found.append(int(status.read_text().rpartition(")")[2].split()[16]))
    return min(found)


def test_who_closes_the_connection_ends_the_work(tmp_path: Path) -> None:
    settings = settings_in(tmp_path)
    app = create_app(settings)
    with running(app, settings) as url:
        made = app.state.parts.expressions
        host, port = url.removeprefix("http://").split(":")
        with socket.create_connection((host, int(port))) as asker:
            path = f"{FACES}/2D.glb?textures=0"
            asker.sendall(f"GET {path} HTTP/1.1\r\nHost: {host}:{port}\r\n\r\n".encode())
            until(lambda: len(made._under_way._under_way) == 1, seconds=120)
        until(lambda: not made._under_way._under_way)
        assert not made._faces._processes.waiting
    kept = (tmp_path / "cache").rglob("*.glb")
    assert [file.name for file in kept if len(file.stem) == TAG_LETTERS] == []


ORDER = FaceOrder(Face("standard", [], Keyframe(action_units={"AU12": 1.0})), "low", {})


def test_a_process_is_kept_refuses_and_ends_with_who_cancels() -> None:
    async def scene() -> None:
        workshop = Workshop("expression_process")
        try:
            assert (await workshop.make(ORDER))[:4] == b"glTF"
            (process,) = workshop._processes.waiting
            nobody = FaceOrder(Face("nobody", [], Keyframe()), "low", {})
            with pytest.raises(Refused, match="nobody") as refused:
                await workshop.make(nobody)
            assert refused.value.status == 422
            assert list(workshop._processes.waiting) == [process]
            task = asyncio.create_task(workshop.make(ORDER))
            while workshop._processes.waiting:
                await asyncio.sleep(0)
            task.cancel()
            with pytest.raises(asyncio.CancelledError):
                await task
            assert process.returncode is not None
            started: list[Process] = []
            start = workshop._processes.take

            async def noted() -> Process:
                started.append(await start())
                return started[-1]

            workshop._processes.take = noted  # type: ignore[method-assign]
            ending = asyncio.create_task(workshop.make(ORDER))
            while not started:
                await asyncio.sleep(0.01)
            started[0].kill()
            with pytest.raises(WorkEnded, match="-9"):
                await ending
        finally:
            await workshop.stop()

    asyncio.run(asyncio.wait_for(scene(), 120))


def test_what_nobody_waits_for_any_more_is_cancelled() -> None:
    async def scene() -> None:
        ended: list[str] = []
        go = asyncio.Event()

        async def make() -> bytes:
            try:
                await go.wait()
            except asyncio.CancelledError:
                ended.append("cancelled")
                raise
            return b"made"

        under_way: Awaited[bytes] = Awaited(most=1)
        first, second = (asyncio.create_task(under_way.get("a", make)) for _ in range(2))
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        with pytest.raises(Busy):
            await under_way.get("b", make)
        first.cancel()
        await asyncio.gather(first, return_exceptions=True)
        assert ended == []
        go.set()
        assert await second == b"made"
        go.clear()
        third = asyncio.create_task(under_way.get("b", make))
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        third.cancel()
        await asyncio.gather(third, return_exceptions=True)
        await asyncio.sleep(0)
        assert ended == ["cancelled"]
        assert under_way._under_way == {}

    asyncio.run(asyncio.wait_for(scene(), 10))


def test_work_goes_on_for_as_long_as_its_asker_is_there() -> None:
    gone = asyncio.Event()

    async def receive() -> MutableMapping[str, Any]:
        await gone.wait()
        return {"type": "http.disconnect"}

    async def ask(work: Awaitable[bytes]) -> bytes:
        return await while_there(Request({"type": "http"}, receive), work)

    async def scene() -> None:
        assert await ask(asyncio.sleep(0, b"made")) == b"made"
        work = asyncio.ensure_future(asyncio.sleep(60, b""))
        gone.set()
        with pytest.raises(AskerLeft):
            await ask(work)
        assert work.cancelled()

    asyncio.run(asyncio.wait_for(scene(), 10))


def test_faces_move_on_while_expressions_are_made(client: TestClient, session: str) -> None:
    late = parts_of(client).runner.counters
    client.patch(f"/api/sessions/{session}/controls", json={"facs": "12E", "fade": 2.0})
    before = late.ticks
    assert client.get(f"{FACES}/4D+7C.glb", params=BARE).status_code == 200
    assert late.ticks > before
    until(lambda: client.get(f"/api/sessions/{session}").json()["merged"]["facs"] == "12E")
