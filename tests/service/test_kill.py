"""A service that is killed in the middle of writes: what it had answered is there again."""

from __future__ import annotations

import http.client
import json
import threading
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from websockets.sync.client import connect

from service.protocol import SUBPROTOCOL, decode_frame
from service.starting import Started, service
from service.store import Store

FACES = 4
WRITES_A_SECOND = 200
SECONDS = 2.0
LEASE = 1000.0
WRITERS = (
    {"layer": "puppet", "owner": "hand"},
    {"layer": "speech", "owner": "voice", "ttl": LEASE},
)
"""Who writes on each face: one who stays, and one with a lease."""
CLIP = {"timeline": [{"time": 0, "action_units": {"AU12": 1}}], "textures": False, "fps": 5}


@dataclass
class Writer:
    """One who writes a number after another, and remembers how far it got.

    Attributes:
        session: On which face.
        about: Layer, owner and lease of its writes.
        sent: The last number that it sent.
        answered: The last one that was answered with 200.
    """

    session: str
    about: dict[str, Any]
    sent: int = 0
    answered: int = 0

    def write(self, url: str, pause: float) -> None:
        """Write until the service is gone, a write every `pause` seconds."""
        place = urlsplit(url)
        connection = http.client.HTTPConnection(str(place.hostname), place.port, timeout=30)
        due = time.monotonic()
        with suppress(OSError, http.client.HTTPException):
            while True:
                self.sent += 1
                body = {"action_units": {"AU12": value_of(self.sent)}, **self.about}
                path = f"/api/sessions/{self.session}/controls"
                headers = {"Content-Type": "application/json"}
                connection.request("PATCH", path, json.dumps(body), headers)
                answer = connection.getresponse()
                answer.read()
                if answer.status == 200:
                    self.answered = self.sent
                due += pause
                time.sleep(max(0.0, due - time.monotonic()))
        connection.close()


def value_of(number: int) -> float:
    """Return the intensity that stands for a number below 10,000."""
    return number / 10_000


def number_in(state: dict[str, Any], writer: Writer) -> int:
    """Return the number that a face holds of a writer, and check its lease."""
    held = {each["owner"]: each for each in state["layers"][writer.about["layer"]]["writers"]}
    mine = held[writer.about["owner"]]
    if "ttl" in writer.about:
        assert 0.9 * LEASE < mine["expires_in"] <= LEASE
    else:
        assert mine["expires_in"] is None
    return round(10_000 * mine["action_units"]["AU12"])


def numbers_told(store: Store, writer: Writer) -> set[int]:
    """Return the numbers of a writer that stand on its session's timeline."""
    told = [line[2] for _, lines in store.tail(writer.session) for line in lines]
    mine = [each for each in told if each.get("owner") == writer.about["owner"]]
    return {round(10_000 * each["action_units"]["AU12"]) for each in mine}


def killed_while_written_to(started: Started, writers: list[Writer]) -> None:
    """Have everybody write, kill the service at once with SIGKILL, and wait for the writers."""
    pause = len(writers) / WRITES_A_SECOND
    threads = [threading.Thread(target=each.write, args=(started.url, pause)) for each in writers]
    for thread in threads:
        thread.start()
    time.sleep(SECONDS)
    started.process.kill()
    for thread in threads:
        thread.join()
    started.process.wait()


def test_a_killed_service_has_what_it_had_answered(tmp_path: Path) -> None:
    folder = {"RISORIUS_DATA_DIR": str(tmp_path)}
    with service(folder) as started:
        ask, port = started.ask, urlsplit(started.url).port
        rig = ask("POST", "/api/rigs", {"name": "mine", "tissue": {"damping": 31.0}})["id"]
        faces = [ask("POST", "/api/sessions", {"rig": "standard"})["id"] for _ in range(FACES)]
        faces.append(ask("POST", "/api/sessions", {"rig": rig})["id"])
        edit = f"/api/sessions/{faces[-1]}/muscles/risorius.L"
        edited = ask("PATCH", edit, {"strength": 1.1})["rig"]
        long = [{"viseme": "aa", "duration": 30.0}, {"viseme": "PP", "duration": 1.0}]
        ask("POST", f"/api/sessions/{faces[-1]}/speech", {"visemes": long})
        clip = ask("POST", "/api/clips", {**CLIP, "duration": 0.2})["id"]
        while ask("GET", f"/api/clips/{clip}?wait=10", None)["status"] != "done":
            pass
        queued = ask("POST", "/api/clips", {**CLIP, "duration": 2.0})["id"]
        writers = [Writer(face, about) for face in faces[:FACES] for about in WRITERS]
        killed_while_written_to(started, writers)
    assert sum(writer.answered for writer in writers) > 0.2 * SECONDS * WRITES_A_SECOND
    store = Store(f"sqlite:///{tmp_path / 'risorius.sqlite3'}")
    for writer in writers:
        assert set(range(1, writer.answered + 1)) <= numbers_told(store, writer)
    store.close()
    with service(folder, port=port) as again:
        ask = again.ask
        listed = {each["id"] for each in ask("GET", "/api/sessions", None)["sessions"]}
        assert listed == set(faces)
        for writer in writers:
            state = ask("GET", f"/api/sessions/{writer.session}", None)
            assert writer.answered <= number_in(state, writer) <= writer.sent
        last = ask("GET", f"/api/sessions/{faces[-1]}", None)
        assert last["rig"] == edited
        assert "speech" not in last["layers"]  # It ended with the service.
        assert rig in {each["id"] for each in ask("GET", "/api/rigs", None)["rigs"]}
        assert ask("GET", f"/api/clips/{clip}", None)["status"] == "done"
        assert ask("GET", f"/api/clips/{queued}", None)["status"] in ("queued", "running", "done")
        again.wait_for(f"/api/clips/{clip}.glb")
        # What was told before is recorded, though the face has lived for a moment only.
        asked = "recording.glb?last=60&wait=0&level=low&textures=0"
        recorded = ask("GET", f"/api/sessions/{faces[1]}/{asked}", None)
        assert recorded["status"] in ("queued", "running", "done")
        # A viewer finds the face at its address, moved to what was held.
        address = f"{again.url.replace('http', 'ws')}/api/sessions/{faces[0]}/stream"
        with connect(address, subprotocols=[SUBPROTOCOL]) as viewer:  # type: ignore[list-item]
            assert json.loads(viewer.recv(timeout=30))["session"] == faces[0]
            while not isinstance(message := viewer.recv(timeout=30), bytes):
                pass
            assert len(decode_frame(message).steps) > 0
