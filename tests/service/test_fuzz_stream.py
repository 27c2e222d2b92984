"""Whatever is sent over a socket, or to the address of chat agents, is answered or refused.

`RISORIUS_FUZZ_EXAMPLES=1000` tries as many of each kind.
"""

from __future__ import annotations

import http.client
import itertools
import json
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any
from urllib.parse import urlsplit

import pytest
from fuzzing import ANYTHING, TIMEOUT, examples, fuzzed
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from service.protocol import SUBPROTOCOL, decode_frame
from service.settings import Settings

pytestmark = [
    pytest.mark.timeout(TIMEOUT),
    # Threads of the service are in this process, and draw from `random` while examples are made.
    pytest.mark.filterwarnings("ignore:Do not use the `random` module inside strategies"),
]
EVENTS = {"hello", "state", "rig", "warning", "error"}
REFUSED = {1002, 1003, 1007, 1009}
"""Codes with which a socket may be closed for what was sent; 1011 says that the service failed."""
TEN_MEGABYTES = 10_000_000
BEYOND = 4 * Settings().max_message_bytes
"""Bytes from which on a message is not read to its end."""
FEW = settings(
    max_examples=examples(40),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
_NUMBERS = itertools.count()


class Conversation:
    """A socket of one face, opened anew when the service closes it."""

    def __init__(self, url: str) -> None:
        self.url = url
        request = urllib.request.Request(
            f"{url}/api/sessions", b"{}", {"Content-Type": "application/json"}
        )
        with urllib.request.urlopen(request, timeout=60) as answer:
            self.address = f"{url.replace('http', 'ws')}{json.load(answer)['stream']}"
        self.socket: ClientConnection | None = None
        self.closing = ExitStack()

    def open(self) -> ClientConnection:
        """Return the socket."""
        if self.socket is None:
            protocols: list[Any] = [SUBPROTOCOL]
            self.closing.close()
            opened = connect(self.address, subprotocols=protocols, max_size=None)
            self.socket = self.closing.enter_context(opened)
        return self.socket

    def survives(self, message: str | bytes, *, text: bool | None = None) -> None:
        """Send a message, then a wrong one: the socket must answer that, or have been closed."""
        socket = self.open()
        mark = f"mark {next(_NUMBERS)}"
        try:
            socket.send(message, text=text)
            socket.send(json.dumps({"type": mark}))
            while mark not in self.event(socket).get("message", ""):
                pass
        except ConnectionClosed as closed:
            self.socket = None
            # Who still sends when the service hangs up may lose what it said last.
            if closed.rcvd is None and len(message) > BEYOND:
                return
            if closed.rcvd is None or closed.rcvd.code not in REFUSED:
                raise

    def event(self, socket: ClientConnection) -> dict[str, Any]:
        """Return the next event; frames between must be whole."""
        while isinstance(message := socket.recv(timeout=30), bytes):
            decode_frame(message)
        event: dict[str, Any] = json.loads(message, parse_constant=pytest.fail)
        assert event["type"] in EVENTS
        if event["type"] == "error":
            assert (
                {"type", "error", "message"} <= set(event) <= {"type", "error", "message", "known"}
            )
            assert event["error"] != "internal"
        return event

    def close(self) -> None:
        """Close the socket."""
        self.closing.close()


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A service of its own, which must be well in the end."""
    with fuzzed(tmp_path_factory.mktemp("fuzz")) as (address, app):
        yield address
        with urllib.request.urlopen(f"{address}/api/ready", timeout=30) as answer:
            assert answer.status == 200
        assert not any(task.done() for task in app.state.parts.sessions._tasks)


@pytest.fixture(scope="module")
def conversation(url: str) -> Iterator[Conversation]:
    """One face for every example."""
    conversation = Conversation(url)
    yield conversation
    conversation.close()


KEYS = (
    "action_units facs scale muscles jaw gaze head tongue arkit visemes owner weight hold ttl "
    "fade_out fade fade_in layer replace label vocabulary intensity scores valence arousal "
    "dominance seed tick pitch AU12 L12 zygomatic_major.L jawOpen aa score"
).split()
NUMBERS = st.floats(0, 1) | st.floats() | st.integers() | st.sampled_from(["A", "F", None, True])
VALUES = (
    ANYTHING
    | NUMBERS
    | st.sampled_from(["6C+12D", "joy", "😀", "emotion", "puppet", "banded", "goemotions"])
    | st.dictionaries(st.sampled_from(KEYS), NUMBERS, max_size=3)
    | st.lists(st.fixed_dictionaries({"label": st.just("joy"), "score": NUMBERS}), max_size=3)
)
MESSAGES = st.fixed_dictionaries(
    {"type": st.sampled_from(["controls", "emotion", "ack", "hello", "", None])}
).flatmap(
    lambda kind: st.dictionaries(st.sampled_from(KEYS), VALUES, max_size=4).map(
        lambda more: {**kind, **more}
    )
)
"""Messages that are nearly right, with what JSON does not have: NaN, infinity, half a surrogate."""


@given(message=MESSAGES)
@FEW
def test_nearly_right_messages(conversation: Conversation, message: dict[str, Any]) -> None:
    conversation.survives(json.dumps(message))


@given(message=ANYTHING)
@FEW
def test_any_json(conversation: Conversation, message: object) -> None:
    conversation.survives(json.dumps(message))


@given(message=MESSAGES, data=st.data())
@FEW
def test_broken_json(conversation: Conversation, message: object, data: st.DataObject) -> None:
    """Cut off, doubled, or with any text in the middle."""
    text = json.dumps(message)
    at = data.draw(st.integers(0, len(text)))
    amid = data.draw(st.text(st.characters(exclude_categories=["Cs"]), max_size=5))
    conversation.survives(text[:at] + amid + text[data.draw(st.integers(at, len(text))) :])


@given(message=st.binary(max_size=200))
@FEW
def test_binary_where_text_belongs(conversation: Conversation, message: bytes) -> None:
    conversation.survives(message)


@given(message=st.binary(min_size=1, max_size=50))
@FEW
def test_text_that_is_no_utf_8(conversation: Conversation, message: bytes) -> None:
    conversation.survives(b'{"type":"ack","tick":' + message, text=True)


@pytest.mark.parametrize(
    "message",
    [
        "x" * TEN_MEGABYTES,
        b"\0" * TEN_MEGABYTES,
        json.dumps({"type": "controls", "facs": "1+" * (TEN_MEGABYTES // 2)}),
        "[" * 60_000,
        '{"type":"ack","tick":' + "9" * 60_000 + "}",
        '{"type":"controls","jaw":{"pitch":1e400}}',
        '{"type":"controls","weight":-0.0,"weight":1,"type":"ack"}',
        json.dumps({"type": "controls", "muscles": {f"m{n}": 1 for n in range(4000)}}),
    ],
    ids=["text", "binary", "facs", "deep", "digits", "infinite", "twice", "wide"],
)
def test_messages_beyond_measure(conversation: Conversation, message: str | bytes) -> None:
    conversation.survives(message)


NAMES = ("initialize", "tools/list", "tools/call", "ping", "notifications/initialized", "resources")
TOOLS = ("open_face", "set_emotion", "set_action_units", "get_state", "list_expressions")
CALLS = st.fixed_dictionaries(
    {"jsonrpc": st.sampled_from(["2.0", "1.0", None]), "method": st.sampled_from(NAMES)},
    optional={
        "id": st.integers() | ANYTHING,
        "params": ANYTHING
        | st.fixed_dictionaries(
            {"name": st.sampled_from(TOOLS), "arguments": ANYTHING},
        ),
    },
)
HEADERS = st.fixed_dictionaries(
    {},
    optional={
        "Content-Type": st.sampled_from(["application/json", "text/plain", ""]),
        "Accept": st.sampled_from(["application/json, text/event-stream", "*/*", "text/html"]),
        "Mcp-Session-Id": st.text("abc 1", max_size=5),
        "Mcp-Protocol-Version": st.sampled_from(["2025-06-18", "1", ""]),
    },
)


@given(
    body=st.one_of(
        CALLS.map(json.dumps).map(str.encode),
        st.lists(CALLS, max_size=2).map(json.dumps).map(str.encode),
        ANYTHING.map(json.dumps).map(str.encode),
        st.binary(max_size=100),
    ),
    headers=HEADERS,
)
@FEW
def test_whatever_is_posted_to_agents_address(
    url: str, body: bytes, headers: dict[str, str]
) -> None:
    place = urlsplit(url)
    connection = http.client.HTTPConnection(str(place.hostname), place.port, timeout=60)
    connection.request("POST", "/mcp/", body, headers)
    answer = connection.getresponse()
    said = answer.read()
    connection.close()
    assert answer.status < 500, said
