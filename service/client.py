"""A client of a running service, in plain calls: open a face, move it, read its frames, save clips.

    with Client("http://127.0.0.1:8000") as client, client.open_face() as face:
        tick = face.set_emotion("joy")["tick"]
        for frame in face.frames(until_still=True, since=tick):
            print(frame.tick, frame.displacements.shape)
        face.save("joy.glb")

A `with` block closes what it opened.
"""

from __future__ import annotations

import json
import os
import secrets
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self
from urllib.parse import quote, urlencode

import httpx2
from websockets.exceptions import InvalidStatus, WebSocketException
from websockets.sync.client import ClientConnection, connect

from engine import LETS_GO, SPEAKER

from .client_commands import CommandStream, ended
from .client_error import ServiceError, refused
from .protocol import FRAME_VERSION, KIND_SURFACE, SUBPROTOCOL, SurfaceFrame, decode_frame
from .whole_files import write_whole

__all__ = ["DEFAULT_URL", "Client", "CommandStream", "Face", "ServiceError"]

DEFAULT_URL = "http://127.0.0.1:8000"
_TRIES = 4
"""Times that a call is sent which the service puts off (429, 503)."""
_LONGEST_PAUSE = 10.0
"""Waited for a call that is put off [s]; one that has to wait for longer is given back."""
_TIMEOUT_SECONDS = 120.0
_CLIP_WAIT_SECONDS = 2.0
_LARGEST_MESSAGE = 16_000_000
_ON_ITS_WAY = 202
_LINES = (".jsonl", ".ndjson")


class Client:
    """One service, spoken to over one connection that stays open."""

    def __init__(self, url: str = DEFAULT_URL, *, key: str | None = None) -> None:
        """Make a client; nothing is sent yet.

        Args:
            url: Where the service is.
            key: One of its keys, where it has any; None takes it from RISORIUS_API_KEY.
        """
        key = os.environ.get("RISORIUS_API_KEY", "") if key is None else key
        self.url = url.rstrip("/")
        self.headers = {"X-API-Key": key} if key else {}
        self._http = httpx2.Client(headers=self.headers, timeout=_TIMEOUT_SECONDS)

    def __enter__(self) -> Self:
        """Use it."""
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        """Close the connection."""
        self.close()

    def close(self) -> None:
        """Close the connection; faces stay open."""
        self._http.close()

    def wait_until_ready(self, seconds: float = 300.0) -> None:
        """Wait until faces can be opened.

        Raises:
            ServiceError: If they cannot in time.
        """
        deadline = time.monotonic() + seconds
        while True:
            try:
                self.call("GET", "/api/ready")
            except ServiceError as error:
                if time.monotonic() > deadline or error.status not in (0, 503):
                    raise
                time.sleep(0.2)
            else:
                return

    def open_face(
        self, rig: str = "standard", *, idle: bool | Mapping[str, float] = False, **model: str
    ) -> Face:
        """Open a face; a `with` block closes it at its end.

        Args:
            rig: Whose: "standard", "amara", or the id of a rig.
            idle: Whether it lives by itself, or how: `{"seed": 7, "blinks": 1.5}`; else it rests.
            model: Forms of the physics, such as `integrator="rk2"`.

        Raises:
            ServiceError: If there is no such rig, or no room.
        """
        body = {"rig": rig, "idle": idle, **({"model": model} if model else {})}
        return self.face(self.json("POST", "/api/sessions", body)["id"])

    def face(self, session: str) -> Face:
        """Return a face that is open already."""
        return Face(self, session)

    def save_clip(
        self,
        clip: Mapping[str, Any],
        path: str | Path,
        *,
        show: Callable[[float], None] | None = None,
    ) -> dict[str, Any]:
        """Have a clip rendered, save its GLB file, and return its report.

        Args:
            clip: As `POST /api/clips` takes it: `{"timeline": [{"time": 0, "emotion": "joy"}]}`.
            path: File to write.
            show: Told the share of the work done.

        Raises:
            ServiceError: If it cannot be played or rendered.
            OSError: If the file cannot be written.
        """
        return self._finished(self.json("POST", "/api/clips", clip), path, show)

    def expression(
        self, facs: str, *, rig: str = "standard", form: str = "png", **query: str | float
    ) -> bytes:
        """Return an expression that has settled, as a picture or as a GLB file.

        Args:
            facs: Which: "6B+12C".
            rig: Whose: "standard", "amara", or the id of a rig.
            form: "png", which notebooks show, or "glb".
            query: What else its address says, such as `size=256, view="three-quarter"`.

        Raises:
            ServiceError: If it cannot be had; with status 501 nothing there draws pictures.
        """
        asked = f"?{urlencode(query)}" if query else ""
        path = f"/api/rigs/{quote(rig, safe='')}/expressions/{quote(facs, safe='')}.{form}{asked}"
        return self.call("GET", path).content

    def save_track(
        self,
        track: str | Path,
        path: str | Path,
        *,
        show: Callable[[float], None] | None = None,
        **asked: Any,
    ) -> dict[str, Any]:
        """Have a tracker's file rendered, save its GLB file, and return its report.

        Its `track` says what became of each row and column.

        Args:
            track: What the tracker wrote.
            path: File to write.
            show: Told the share of the work done.
            asked: `gain=1.5`, `neutral="auto"`, `rig="amara"`, `fps=30`, as in the address of
                `POST /api/clips`.

        Raises:
            ServiceError: If it cannot be read or rendered.
            OSError: If a file cannot be read or written.
        """
        options = {name: _plain(value) for name, value in asked.items() if value is not None}
        query = f"?{urlencode(options)}" if options else ""
        row = self.call("POST", f"/api/clips{query}", file=Path(track)).json()
        return self._finished(row, path, show)

    def json(self, method: str, path: str, body: object = None) -> Any:
        """Send a request and return the JSON of its answer, None if it has none.

        Raises:
            ServiceError: If it is refused, or there is no answer.
        """
        answer = self.call(method, path, body)
        return answer.json() if answer.content else None

    def call(
        self, method: str, path: str, body: object = None, *, file: Path | None = None
    ) -> httpx2.Response:
        """Send a request, again while it is put off, and return its answer.

        Args:
            method: "GET" and so on.
            path: Below the service's address.
            body: What is sent as JSON.
            file: A tracker's file that is sent in its place, read as it goes.

        Raises:
            ServiceError: If it is refused, or there is no answer.
            OSError: If the file cannot be read.
        """
        # By it a POST that is sent again is not done twice.
        once = {"Idempotency-Key": secrets.token_hex(16)} if method == "POST" else {}
        for turn in range(_TRIES):
            try:
                answer = self._sent(method, path, body, file, once)
            except (httpx2.TransportError, httpx2.InvalidURL) as error:
                raise self._unreachable(error) from error
            put_off = answer.status_code in (429, 503) and path != "/api/ready"
            pause = _pause(answer.headers.get("Retry-After", ""))
            if not put_off or turn == _TRIES - 1 or pause > _LONGEST_PAUSE:
                break
            time.sleep(pause)
        if answer.is_error:
            raise refused(answer.status_code, answer.content)
        return answer

    def _sent(
        self, method: str, path: str, body: object, file: Path | None, once: Mapping[str, str]
    ) -> httpx2.Response:
        if file is None:
            return self._http.request(method, self.url + path, json=body, headers=once)
        kind = "application/jsonl" if file.suffix.lower() in _LINES else "text/csv"
        headers = {**once, "Content-Type": kind}
        with file.open("rb") as content:
            return self._http.request(method, self.url + path, content=content, headers=headers)

    def _finished(
        self, row: Mapping[str, Any], path: str | Path, show: Callable[[float], None] | None = None
    ) -> dict[str, Any]:
        """Wait for a clip that is being rendered, save its file, and return its report."""
        address = f"/api/clips/{row['id']}"
        while row["status"] in ("queued", "running"):
            row = self.json("GET", f"{address}?wait={_CLIP_WAIT_SECONDS:g}")
            if show is not None:
                show(row["progress"])
        if row["status"] != "done":
            message = row.get("message") or f"the clip is {row['status']}"
            raise ServiceError(200, f"clip_{row['status']}", message, [])
        write_whole(Path(path), self.call("GET", f"{address}.glb").content)
        report: dict[str, Any] = row["report"]
        return report

    def _unreachable(self, error: Exception) -> ServiceError:
        message = f"the service at {self.url} does not answer: {error}; is it running there?"
        return ServiceError(0, "unreachable", message, [])


@dataclass(frozen=True)
class Face:
    """One face of a service.

    Attributes:
        client: Of the service.
        session: Its id.
    """

    client: Client
    session: str

    def __enter__(self) -> Self:
        """Use it."""
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        """Close it for good."""
        self.close()

    @property
    def viewer_url(self) -> str:
        """The page that shows it."""
        return f"{self.client.url}/?session={self.session}"

    def link(self, *, role: str = "read", seconds: float = 300.0) -> str:
        """Return an address that shows it to somebody without a key, for a while.

        Args:
            role: "read" to watch, "control" to move it too.
            seconds: How long it is valid, a day at most.

        Raises:
            ServiceError: For another role or time.
        """
        asked = {"role": role, "seconds": seconds}
        return str(self.client.json("POST", f"{self._path}/tickets", asked)["url"])

    def set_controls(self, *, replace: bool = False, **controls: Any) -> dict[str, Any]:
        """Move what is named, as `PATCH …/controls`; return `tick`, `scale` and `warnings`.

        Args:
            replace: Whether to let go of everything else that the owner holds in the layer.
            controls: `facs="6C+12D"`, `action_units={"AU12": 0.8}`, `fade=0.3`, `layer="speech"`…

        Raises:
            ServiceError: For a name or a value that cannot be used.
        """
        method = "PUT" if replace else "PATCH"
        answer: dict[str, Any] = self.client.json(method, f"{self._path}/controls", controls)
        return answer

    def set_emotion(self, label: str | None = None, **emotion: Any) -> dict[str, Any]:
        """Play an emotion; return its `recipe`, `source`, `tick` and more.

        Args:
            label: Any word for it; without it give `scores`, or `valence` and `arousal`.
            emotion: `intensity=0.8`, `hold=1.5`, `fade_in=0.2`…

        Raises:
            ServiceError: For a word that nobody knows.
        """
        body = emotion if label is None else {"label": label, **emotion}
        answer: dict[str, Any] = self.client.json("POST", f"{self._path}/emotions", body)
        return answer

    def speak(self, visemes: Iterable[Mapping[str, Any]], **speech: Any) -> dict[str, Any]:
        """Play visemes in time; return `sound_in`, seconds until their sound is to begin, and more.

        Args:
            visemes: `{"viseme": "PP", "time": 0.1}`, or all with `duration`.
            speech: `owner="voice"`, `intensity=0.5`, `delay=0.2`…

        Raises:
            ServiceError: For a name that is no viseme, or times that cannot be played.
        """
        body = {"visemes": list(visemes), **speech}
        answer: dict[str, Any] = self.client.json("POST", f"{self._path}/speech", body)
        return answer

    def be_silent(self, *, owner: str = SPEAKER, fade: float = LETS_GO) -> dict[str, Any]:
        """End a speech: drop what is still to come, and let go of the mouth; return the `tick`.

        Args:
            owner: Whose speech it is.
            fade: Seconds over which the mouth lets go.
        """
        asked = f"owner={quote(owner)}&fade={fade:g}"
        answer: dict[str, Any] = self.client.json("DELETE", f"{self._path}/speech?{asked}")
        return answer

    def state(self) -> dict[str, Any]:
        """Return what its layers hold, and what they make together."""
        answer: dict[str, Any] = self.client.json("GET", self._path)
        return answer

    def frames(self, *, until_still: bool = False, since: int = 0) -> Iterator[SurfaceFrame]:
        """Yield each new frame; one that comes while the last one is used is left out.

        A frame's `displacements` are an array [m] of shape (vertices, 3), from rest, in the order
        of `surface.glb`.

        Args:
            until_still: Whether to end with the frame after which the face sleeps.
            since: Tick before which frames are left out: that of a command shows what it does.

        Raises:
            ServiceError: If there is no such face, or the service ends.
        """
        with self._connected() as socket:
            latest: tuple[int, bool] | None = None
            try:
                for message in socket:
                    if message[:2] != bytes((KIND_SURFACE, FRAME_VERSION)):
                        continue  # Words, or of a kind that is newer than this client.
                    frame = decode_frame(bytes(message))  # type: ignore[arg-type]
                    news = (frame.tick, frame.asleep) != latest
                    latest = (frame.tick, frame.asleep)
                    if news and frame.tick >= since:
                        yield frame
                        if until_still and frame.asleep:
                            return
                    socket.send(json.dumps({"type": "ack", "tick": frame.tick}))
            except WebSocketException as error:
                raise ended(error) from error

    @contextmanager
    def commands(self) -> Iterator[CommandStream]:
        """Open a socket for commands that come many times a second; the `with` block closes it.

        Raises:
            ServiceError: If there is no such face, or no room for one more socket.
        """
        with self._connected() as socket:
            yield CommandStream(socket)

    def save(self, path: str | Path) -> None:
        """Save the face as it stands as a GLB file.

        Raises:
            ServiceError: If there is no such face.
            OSError: If the file cannot be written.
        """
        Path(path).write_bytes(self.client.call("GET", f"{self._path}.glb").content)

    def save_last(self, path: str | Path, seconds: float = 10.0, *, fps: int = 30) -> None:
        """Save what the face did last as an animated GLB file.

        Args:
            path: File to write.
            seconds: How much of it.
            fps: Frames a second.

        Raises:
            ServiceError: If there is no such face, or nothing was ever set on it.
            OSError: If the file cannot be written.
        """
        asked = f"last={seconds:g}&fps={fps}"
        answer = self.client.call("GET", f"{self._path}/recording.glb?{asked}")
        if answer.status_code == _ON_ITS_WAY:
            self.client._finished(answer.json(), path)
        else:
            Path(path).write_bytes(answer.content)

    def close(self) -> None:
        """Close it for good.

        Raises:
            ServiceError: If there is no such face.
        """
        self.client.call("DELETE", self._path)

    def _connected(self) -> ClientConnection:
        """Return an open socket of the face, of which `with` closes it."""
        try:
            return connect(
                f"{self.client.url.replace('http', 'ws', 1)}{self._path}/stream",
                subprotocols=[SUBPROTOCOL],  # type: ignore[list-item]
                additional_headers=self.client.headers,
                max_size=_LARGEST_MESSAGE,
            )
        except InvalidStatus as turned_away:
            response = turned_away.response
            raise refused(response.status_code, bytes(response.body or b"")) from turned_away
        except WebSocketException as error:
            raise ended(error) from error
        except OSError as error:
            raise self.client._unreachable(error) from error

    @property
    def _path(self) -> str:
        return f"/api/sessions/{self.session}"


def _plain(value: object) -> object:
    """Return a value as an address holds it."""
    return str(value).lower() if isinstance(value, bool) else value


def _pause(retry_after: str) -> float:
    """Return how long to wait [s]; a date, which a proxy may send, is not read."""
    return float(retry_after) if retry_after.isdecimal() else 1.0
