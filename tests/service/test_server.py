"""The service behind a real server: sockets that are refused, and a viewer that stops reading."""

from __future__ import annotations

import json
import socket
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import httpx2
import pytest
from conftest import settings_in
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from service.app import create_app
from service.protocol import SUBPROTOCOL, SurfaceFrame, decode_frame, encode_frame
from service.server import listen, running, server_of


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A server of its own."""
    settings = settings_in(tmp_path_factory.mktemp("server"))
    with running(create_app(settings), settings) as address:
        yield address


def test_connections_outlive_what_clients_and_proxies_keep(tmp_path: Path) -> None:
    """Whoever closes first must be the client: a request sent as the server closes is lost."""
    settings = settings_in(tmp_path)
    kept = server_of(create_app(settings), settings).config.timeout_keep_alive
    assert kept > max(60, httpx2.Limits().keepalive_expiry or 0.0)


def call(url: str, method: str, body: object) -> dict[str, object]:
    data = json.dumps(body).encode()
    request = urllib.request.Request(url, data, {"Content-Type": "application/json"}, method=method)
    with urllib.request.urlopen(request, timeout=30) as answer:
        return json.load(answer)


@pytest.fixture
def session(url: str) -> str:
    """A fresh session."""
    return str(call(f"{url}/api/sessions", "POST", {})["id"])


def stream(url: str, session: str, **options: object) -> ClientConnection:
    address = f"{url.replace('http', 'ws')}/api/sessions/{session}/stream"
    return connect(address, subprotocols=[SUBPROTOCOL], **options)  # type: ignore[arg-type]


def frames(connection: ClientConnection) -> Iterator[SurfaceFrame]:
    while True:
        message = connection.recv(timeout=30)
        if isinstance(message, bytes):
            yield decode_frame(message)


def of_one_tick(
    ones: Iterator[SurfaceFrame], others: Iterator[SurfaceFrame]
) -> Iterator[tuple[SurfaceFrame, SurfaceFrame]]:
    """Yield what two viewers are sent of the same ticks; whoever is slow misses some."""
    while True:
        one, other = next(ones), next(others)
        while one.tick != other.tick:
            if one.tick < other.tick:
                one = next(ones)
            else:
                other = next(others)
        yield one, other


@pytest.mark.parametrize(
    ("session_id", "options", "status"),
    [
        ("nobody", {}, 404),
        ("nobody", {"origin": "https://evil.example"}, 403),
    ],
)
def test_a_socket_is_refused_with_a_status(
    url: str, session_id: str, options: dict[str, object], status: int
) -> None:
    with pytest.raises(InvalidStatus) as refused:
        stream(url, session_id, **options)
    assert refused.value.response.status_code == status
    assert "error" in json.loads(refused.value.response.body or b"{}")


def test_a_socket_for_another_host_is_refused(url: str) -> None:
    there = socket.create_connection(("127.0.0.1", urllib.parse.urlsplit(url).port))
    address = "ws://evil.example/api/sessions/nobody/stream"
    with there, pytest.raises(InvalidStatus) as refused:
        connect(address, sock=there, subprotocols=[SUBPROTOCOL])
    assert refused.value.response.status_code == 421


def test_another_version_is_closed_with_a_reason(url: str, session: str) -> None:
    address = f"{url.replace('http', 'ws')}/api/sessions/{session}/stream"
    with connect(address, subprotocols=["risorius.v2"]) as connection:  # type: ignore[list-item]
        with pytest.raises(ConnectionClosed) as closed:
            connection.recv(timeout=10)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1002
        assert SUBPROTOCOL in closed.value.rcvd.reason


def test_frames_are_not_compressed(url: str, session: str) -> None:
    with stream(url, session) as connection:
        assert connection.protocol.extensions == []


def deaf_viewer(url: str, session: str) -> socket.socket:
    """Return a socket that asks for the stream and never reads the answer."""
    host, port = url.removeprefix("http://").split(":")
    deaf = socket.create_connection((host, int(port)))
    deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    deaf.sendall(
        f"GET /api/sessions/{session}/stream HTTP/1.1\r\nHost: {host}:{port}\r\n"
        "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode()
    )
    return deaf


def test_a_viewer_that_stops_reading_delays_nobody(url: str, session: str) -> None:
    with deaf_viewer(url, session), stream(url, session) as reader:
        started = time.monotonic()
        for turn in range(6):
            body = {"action_units": {"AU12": 1.0 - turn % 2}, "fade": 0.3}
            call(f"{url}/api/sessions/{session}/controls", "PATCH", body)
            target = next(frames(reader)).tick + 20
            arrived = next(frame for frame in frames(reader) if frame.tick >= target)
            assert arrived.tick < target + 30
        assert time.monotonic() - started < 60
        text = urllib.request.urlopen(f"{url}/metrics", timeout=30).read().decode()
        assert "risorius_viewers 2.0" in text


def test_a_viewer_whose_line_broke_is_whole_again_within_a_second_of_the_face(
    url: str, session: str
) -> None:
    """It says nothing but hello; who never left sees the very same, bit for bit."""
    place = f"{url}/api/sessions/{session}/controls"
    short = {"close_timeout": 0.1}  # Frames that nobody reads any more are not waited for.
    with stream(url, session, **short) as stayed:
        with stream(url, session, **short) as lost:
            call(place, "PATCH", {"action_units": {"AU12": 0.7, "L4": 0.5}, "fade": 6.0})
            last = next(frame for frame in frames(lost) if frame.steps.any())
            # Gone as a cable that is pulled: no closing words.
            lost.socket.shutdown(socket.SHUT_RDWR)
        call(place, "PATCH", {"head": {"yaw": 9.0}, "fade": 6.0})
        with stream(url, session, **short) as back:
            hello = json.loads(back.recv(timeout=30))
            first = next(frames(back))
            assert hello["type"] == "hello"
            assert last.tick < first.tick <= hello["tick"] + 60
            held = hello["state"]["layers"]["puppet"]
            assert held["action_units"] == {"AU12": 0.7, "L4": 0.5}
            assert held["head"] == {"yaw": 9.0}
            for one, other in islice(of_one_tick(frames(stayed), frames(back)), 20):
                assert encode_frame(one) == encode_frame(other)
                assert one.steps.any()


def test_a_body_that_is_too_long_is_refused(url: str) -> None:
    request = urllib.request.Request(
        f"{url}/api/sessions", b" " * 5_000_000, {"Content-Type": "application/json"}
    )
    with pytest.raises((urllib.error.HTTPError, ConnectionError, urllib.error.URLError)) as refused:
        urllib.request.urlopen(request, timeout=30)
    if isinstance(refused.value, urllib.error.HTTPError):
        assert refused.value.code == 413
        refused.value.close()


def test_what_is_written_to_a_connection_does_not_wait_for_an_answer() -> None:
    """Else the body of an answer, and each frame, waits 40 ms until what went before is read."""
    listener = listen("127.0.0.1", 0)
    with listener, socket.create_connection(listener.getsockname()):
        accepted, _ = listener.accept()
        with accepted:
            assert accepted.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
            # asyncio, too, looks at this before it turns the waiting off.
            assert accepted.proto == socket.IPPROTO_TCP
