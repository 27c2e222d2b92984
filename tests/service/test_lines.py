"""Sockets of a real server: frames written at once, acknowledged, and a viewer that stalls."""

from __future__ import annotations

import asyncio
import json
import urllib.request
from collections.abc import Iterator

import pytest
from conftest import settings_in
from fastapi import FastAPI
from websockets.frames import Frame, Opcode
from websockets.sync.client import connect

from service.app import create_app
from service.benching.onlookers import onlooker
from service.lines import Line, _head
from service.packed import decode_packed
from service.protocol import SUBPROTOCOL, SurfaceFrame
from service.server import running
from service.soak_client import Client


@pytest.fixture(scope="module")
def app(tmp_path_factory: pytest.TempPathFactory) -> FastAPI:
    return create_app(settings_in(tmp_path_factory.mktemp("lines")))


@pytest.fixture(scope="module")
def url(app: FastAPI, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A server of its own."""
    with running(app, settings_in(tmp_path_factory.mktemp("served"))) as address:
        yield address


async def commanded(client: Client, session: str, seconds: float, **units: float) -> None:
    """Have a face take `seconds` to a new expression."""
    body = {"action_units": units, "fade": seconds}
    assert (await client.call("PUT", f"/api/sessions/{session}/controls", body)).status == 200


def test_a_stalled_viewer_delays_nobody_holds_little_and_comes_back_to_now(
    app: FastAPI, url: str
) -> None:
    async def watched() -> None:
        client = Client(url)
        await client.until_ready()
        session = (await client.call("POST", "/api/sessions", {})).body["id"]
        stream = f"/api/sessions/{session}/stream"
        quick, stalled = [await onlooker(url, stream) for _ in range(2)]
        live = app.state.parts.sessions._live[session]

        async def ticks_past(count: int) -> None:
            target = live.frame.tick + count
            async with asyncio.timeout(60):
                while live.frame.tick < target:
                    await asyncio.sleep(0.02)

        await commanded(client, session, 12.0, AU12=1.0)
        await ticks_past(20)
        assert stalled.frames > 2
        stalled.pause()
        seen, read, began = quick.frames, stalled.bytes, live.frame.tick
        await ticks_past(120)
        # The quick one misses what the machine itself misses, as it would alone.
        assert quick.frames - seen > 0.5 * (live.frame.tick - began)
        waiting = [each for each in live.viewers if each.skipped > 60]
        assert len(waiting) == 1
        assert len(waiting[0]._unread) <= 2
        assert len(waiting[0]._events) <= 2
        stalled.go_on()
        async with asyncio.timeout(60):
            while stalled.tick < began + 120:
                await asyncio.sleep(0.02)
        # What lay in between: a frame or two each second, and states; not the frames it missed.
        assert stalled.bytes - read < 60_000
        for each in (quick, stalled):
            each.leave()
        client.close()

    asyncio.run(watched())


def test_packed_frames_that_are_written_at_once_come_in_order_and_whole(url: str) -> None:
    asked = urllib.request.Request(
        f"{url}/api/sessions", b"{}", {"Content-Type": "application/json"}, method="POST"
    )
    with urllib.request.urlopen(asked, timeout=60) as answer:
        stream = json.load(answer)["stream"]
    address = f"{url.replace('http', 'ws')}{stream}?frames=packed"
    with connect(address, subprotocols=[SUBPROTOCOL]) as socket:  # type: ignore[list-item]
        held: SurfaceFrame | None = None
        ticks, changes, turn = [0], 0, 0
        while changes < 40:
            # What is said goes through the task that also sends frames, so both ways are taken.
            if turn % 8 == 0:
                units = {"AU12": (turn // 8) % 2, "AU1": 1.0}
                socket.send(json.dumps({"type": "controls", "action_units": units, "fade": 0.5}))
                socket.send("{")
            turn += 1
            message = socket.recv(timeout=30)
            if isinstance(message, bytes):
                changes += message[66:68] != b"\0\0"
                held = decode_packed(message, held)  # None is lost: each is told by the last.
                assert held.tick >= ticks[-1]
                ticks.append(held.tick)
                socket.send(json.dumps({"type": "ack", "tick": held.tick}))


@pytest.mark.parametrize("size", [0, 125, 126, 65_535, 65_536])
def test_messages_of_every_length_have_the_head_that_the_protocol_says(size: int) -> None:
    head = _head(size)
    assert head[0] == 0x82
    expected = {2: size, 4: 126, 10: 127}[len(head)]
    assert head[1] == expected
    assert size == (head[1] if len(head) == 2 else int.from_bytes(head[2:], "big"))


@pytest.mark.parametrize(
    ("text", "tick"),
    [
        (b'{"type":"ack","tick":12}', 12),
        (b'{"type": "ack", "tick": 0}', 0),
        (b'{"type":"ack","tick":-1}', None),
        (b'{"type":"ack","tick":012}', None),
        (b'{"type":"ack","tick":99999999999}', None),
        (b'{"type":"ack","tick":1,"more":2}', None),
        (b'{"type":"emotion","label":"joy"}', None),
    ],
)
def test_only_acknowledgements_that_cannot_be_wrong_take_the_short_way(
    text: bytes, tick: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    long_way: list[bytes] = []
    monkeypatch.setattr(
        "uvicorn.protocols.websockets.websockets_sansio_impl.WebSocketsSansIOProtocol.handle_text",
        lambda _, event: long_way.append(event.data),
    )
    line, drawn = Line.__new__(Line), []
    line.on_ack = drawn.append
    line.handle_text(Frame(Opcode.TEXT, text))
    assert drawn == ([] if tick is None else [tick])
    assert long_way == ([text] if tick is None else [])
