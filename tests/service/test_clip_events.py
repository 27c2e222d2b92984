"""Clips tell how far they are as server-sent events, to all who listen, also again or slowly."""

from __future__ import annotations

import json
import socket
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from urllib.parse import urlsplit

import httpx2
import pytest
from conftest import parts_of, settings_in, until
from starlette.testclient import TestClient

import service.clip_events
from service.app import create_app
from service.clip_events import clip_events
from service.errors import Busy
from service.server import running

SHORT = {"timeline": [{"time": 0, "action_units": {"AU12": 1}}], "textures": False, "level": "low"}
LONG = 100.0


def queued(client: TestClient, seconds: float) -> str:
    answer = client.post("/api/clips", json={**SHORT, "duration": seconds})
    assert answer.status_code == 202, answer.text
    return str(answer.json()["id"])


def read(text: str) -> list[dict[str, str]]:
    """Return the fields of each event of a stream."""
    blocks = [block for block in text.split("\n\n") if block and not block.startswith(":")]
    return [dict(line.split(": ", 1) for line in block.splitlines()) for block in blocks]


def hearing(
    client: TestClient, clip: str, welcome: Callable[[], bool] = lambda: True
) -> Future[list[str]]:
    """Return what will have been told of a clip, once somebody listens to it."""
    parts = parts_of(client)

    async def heard() -> list[str]:
        return [text async for text in clip_events(parts.clips, clip, welcome)]

    assert client.portal is not None
    told = client.portal.start_task_soon(heard)
    until(lambda: told.done() or parts.clips.job(clip).watchers == 1)  # type: ignore[union-attr]
    return told


def test_a_clip_tells_how_far_it_is_until_it_is_done(client: TestClient) -> None:
    clip = queued(client, 1.0)
    answer = client.get(f"/api/clips/{clip}/events")
    assert answer.status_code == 200
    assert answer.headers["Content-Type"].startswith("text/event-stream")
    retry, *events = read(answer.text)
    assert int(retry["retry"]) > 0
    assert len(events) > 2
    assert [event["event"] for event in events] == ["progress"] * (len(events) - 1) + ["end"]
    lines = [json.loads(event["data"]) for event in events]
    shares = [line["progress"] for line in lines]
    assert shares == sorted(shares)
    assert lines[-1] == client.get(f"/api/clips/{clip}").json()
    assert lines[-1]["status"] == "done"
    # One who comes late, or again, hears the end; one who has heard it is not to ask again.
    (_, late) = read(client.get(f"/api/clips/{clip}/events").text)
    assert late == events[-1]
    again = client.get(f"/api/clips/{clip}/events", headers={"Last-Event-ID": late["id"]})
    assert (again.status_code, again.content) == (204, b"")
    client.delete(f"/api/clips/{clip}")
    assert client.get(f"/api/clips/{clip}/events").status_code == 404


def test_a_stream_ends_with_its_clip_however_that_ends(client: TestClient) -> None:
    running_one, waiting = queued(client, LONG), queued(client, LONG)
    for clip in (waiting, running_one):
        told = hearing(client, clip)
        assert client.delete(f"/api/clips/{clip}").status_code == 204
        last = told.result(30)[-1]
        assert last.startswith("event: end\n")
        assert '"status":"cancelled"' in last
        client.delete(f"/api/clips/{clip}")


def test_who_is_no_longer_welcome_is_told_nothing_more(client: TestClient) -> None:
    before, clip = queued(client, LONG), queued(client, LONG)
    answers = iter([True, False])
    told = hearing(client, clip, lambda: next(answers))
    for each in (clip, before):
        client.delete(f"/api/clips/{each}")
    (_, only) = told.result(30)
    assert only.startswith("event: progress\n")


def test_silence_is_broken_and_who_listens_is_bounded(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(service.clip_events, "_SILENT_SECONDS", 0.05)
    monkeypatch.setattr(service.clip_events, "MOST_WATCHERS", 1)
    before, clip = queued(client, LONG), queued(client, LONG)
    parts = parts_of(client)

    async def heard() -> list[str]:
        events = clip_events(parts.clips, clip, lambda: True)
        said = [await anext(events) for _ in range(4)]
        with pytest.raises(Busy):
            clip_events(parts.clips, clip, lambda: True)
        await events.aclose()
        return said

    assert client.portal is not None
    said = client.portal.start_task_soon(heard).result(30)
    assert said[2:] == [": still here\n\n"] * 2
    assert parts.clips.job(clip).watchers == 0  # type: ignore[union-attr]
    for each in (clip, before):
        client.delete(f"/api/clips/{each}")


def test_a_slow_reader_and_one_who_leaves_delay_nobody(tmp_path: Path) -> None:
    settings = settings_in(tmp_path)
    app = create_app(settings)
    with running(app, settings) as url, httpx2.Client(base_url=url, timeout=180) as client:
        until(lambda: client.get("/api/ready").status_code == 200, seconds=120)
        clip = client.post("/api/clips", json={**SHORT, "duration": 1.0}).json()["id"]
        place = urlsplit(url)
        request = f"GET /api/clips/{clip}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()
        address = (str(place.hostname), place.port or 80)
        with socket.create_connection(address) as leaving:
            leaving.sendall(request)
            assert leaving.recv(10)
        with socket.create_connection(address) as slow:
            slow.sendall(request)  # It reads nothing until the end.
            text = client.get(f"/api/clips/{clip}/events").text
            assert read(text)[-1]["event"] == "end"
            said = b""
            while b"event: end" not in said:
                block = slow.recv(65_536)
                assert block
                said += block
