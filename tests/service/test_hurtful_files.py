"""Files made to hurt: a clear refusal, by the service and the command line, and nothing stays."""

from __future__ import annotations

import gzip
import io
import re
import socket
import sys
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import httpx2
import pytest
from conftest import parts_of, settings_in, until
from starlette.testclient import TestClient
from typer.testing import CliRunner

import service.uploads
from service.app import create_app
from service.cli import app as command_line
from service.guard import Guard
from service.server import running
from service.starting import resident
from service.starting import service as started_service
from service.uploads import Uploads

CSV = {"Content-Type": "text/csv"}
HEADER = "frame,timestamp,confidence,success,AU06_r,AU12_r"
ROW = "0,0.0,0.98,1,0.5,"
GOOD = "\n".join([HEADER, *(f"{i},{i / 30:.3f},0.98,1,0.5,{i % 5}" for i in range(6)), ""])


def zipped() -> bytes:
    """Return an archive of a table with a gigabyte of zeros."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        with archive.open("laugh.csv", "w", force_zip64=True) as member:
            for _ in range(64):
                member.write(b"0" * 1_048_576)
    return file.getvalue()


HURTFUL = {
    "empty": (b"", "the file is empty"),
    "blank lines": (b"\n\n \n", "the file is empty"),
    "a header alone": (HEADER.encode(), "a header and no rows"),
    "binary": (bytes(range(256)) * 400, "binary, not text"),
    "a picture": (b"\x89PNG\r\n\x1a\n" + bytes(4000), "binary, not text"),
    "half of UTF-16": (GOOD.encode("utf-16")[:-3], "utf-16"),
    "decimal commas": (
        GOOD.replace("0.5", "0,5").encode(),
        "if its numbers have decimal commas, save it with decimal points|row 1 has 7 cells",
    ),
    "a million columns": ((",".join(f"c{i}" for i in range(1_000_000)) + "\n").encode(), "a line"),
    "many columns": ((",".join(f"c{i}" for i in range(20_000)) + "\n").encode(), "20,000 columns"),
    "NaN": (f"{HEADER}\n{ROW}nan\n".encode(), "AU12_r is missing or NaN"),
    "infinity": (f"{HEADER}\n{ROW}inf\n".encode(), "AU12_r is inf"),
    "negative": (f"{HEADER}\n{ROW}-1.5\n".encode(), "not negative"),
    "a zip archive": (zipped(), "a ZIP archive"),
    "a gzip archive": (gzip.compress(b"0" * 50_000_000), "a gzip archive; unpack it first"),
    "cut off": (GOOD[:-12].encode(), "cut off"),
    "of something else": (b"name,age\nJoe,7\n", "expected those of OpenFace 2"),
    "a JSON document": (b'{\n"jawOpen": 1}\n', "expected JSON lines"),
}


def left(client: TestClient) -> tuple[list[str], int, int]:
    """Return what there is of clips: files, rows, jobs."""
    parts = parts_of(client)
    names = sorted(path.name for path in parts.settings.clips_folder.glob("*"))
    return names, parts.store.clip_count(), parts.clips.under_way


@pytest.mark.parametrize("name", HURTFUL)
def test_the_service_refuses_it_and_keeps_nothing(client: TestClient, name: str) -> None:
    content, said = HURTFUL[name]
    before = left(client)
    answer = client.post("/api/clips", content=content, headers=CSV)
    assert answer.status_code == 422, answer.text
    assert set(answer.json()) <= {"error", "message", "known"}
    assert any(one in answer.json()["message"] for one in said.split("|")), answer.text
    assert left(client) == before


def test_what_would_fill_the_database_with_names_is_refused(client: TestClient) -> None:
    names = ",".join(f"{'x' * 9000}{i}" for i in range(60))
    content = f"AU12_r,{names}\n1{',1' * 60}\n"
    before = left(client)
    answer = client.post("/api/clips", content=content, headers=CSV)
    assert (answer.status_code, answer.json()["error"]) == (422, "invalid_track")
    assert "too long to be reported" in answer.json()["message"]
    assert left(client) == before


@pytest.mark.parametrize("name", HURTFUL)
def test_the_command_line_refuses_it_and_writes_nothing(name: str, tmp_path: Path) -> None:
    content, said = HURTFUL[name]
    source, output = tmp_path / "in.csv", tmp_path / "out.glb"
    source.write_bytes(content)
    result = CliRunner().invoke(command_line, ["clip", str(source), "-o", str(output)])
    assert result.exit_code == 2, result.output
    assert "Traceback" not in result.output
    sentence = " ".join(result.output.split())
    assert any(one in sentence for one in said.split("|")), sentence
    assert [path.name for path in tmp_path.iterdir()] == ["in.csv"]


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig"])
def test_what_is_clear_in_spite_of_its_form_is_read(client: TestClient, encoding: str) -> None:
    semicolons = GOOD.replace(",", ";").replace(".", ",")
    for text in (GOOD, semicolons):
        answer = client.post("/api/clips", content=text.encode(encoding), headers=CSV)
        assert answer.status_code == 202, answer.text
        track = answer.json()["report"]["track"]
        assert (track["used"], track["units"]["AU12"]["peak"]) == (6, 0.8)
        client.delete(answer.headers["Location"])
        client.delete(answer.headers["Location"])


def sent(url: str, request: bytes) -> socket.socket:
    """Send bytes to a service and return the connection."""
    place = urlsplit(url)
    connection = socket.create_connection((str(place.hostname), place.port or 80), timeout=30)
    connection.sendall(request)
    return connection


def answered(url: str, request: bytes) -> str:
    """Send bytes to a service that closes the connection, and return all that it says."""
    with sent(url, request) as connection:
        said = b""
        while block := connection.recv(65_536):
            said += block
    return said.decode()


def request_of(length: int, *lines: str) -> bytes:
    """Return the head of a POST with a tracker's file."""
    head = (
        "POST /api/clips HTTP/1.1",
        "Host: localhost",
        "Connection: close",
        "Content-Type: text/csv",
    )
    return "\r\n".join((*head, f"Content-Length: {length}", *lines, "", "")).encode()


def test_a_client_that_leaves_in_the_middle_leaves_nothing(tmp_path: Path) -> None:
    settings = settings_in(tmp_path)
    app = create_app(settings)
    with running(app, settings) as url:
        uploads = uploads_of(app)
        connection = sent(url, request_of(10_000_000) + b"0" * 3_000_000)
        until(lambda: any(settings.clips_folder.glob("*.upload")))
        assert uploads.under_way == 1
        connection.close()
        until(lambda: uploads.under_way == 0)
        until(lambda: not any(settings.clips_folder.iterdir()))
        assert app.state.parts.store.clip_count() == 0
        # Half of a timeline is none either, also where it reads as a whole one.
        body = b'{"timeline": [{"time": 0}], "duration": 0.1}'
        head = request_of(len(body) + 10).replace(b"text/csv", b"application/json")
        connection = sent(url, head + body)
        time.sleep(0.2)
        connection.close()
        time.sleep(0.5)
        assert app.state.parts.store.clip_count() == 0


def test_one_who_falls_silent_holds_no_place_for_long(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = settings_in(tmp_path, max_queued_clips=1)
    app = create_app(settings)
    with running(app, settings) as url, sent(url, request_of(1000) + b"frame"):
        until(lambda: uploads_of(app).under_way == 1)
        refused = answered(url, request_of(1000) + b"frame")
        assert refused.startswith("HTTP/1.1 503 ")
        assert "too_many_uploads" in refused
    monkeypatch.setattr(service.uploads, "_STALLED_SECONDS", 0.1)
    app = create_app(settings)
    with running(app, settings) as url:
        # Closed without being asked: what would come next is the rest of a file, or nothing.
        asked = request_of(1000).replace(b"Connection: close\r\n", b"")
        refused = answered(url, asked + b"frame")
        assert refused.startswith("HTTP/1.1 408 ")
        assert "upload_stalled" in refused
        assert "\r\nconnection: close\r\n" in refused.lower()
        assert not any(settings.clips_folder.iterdir())


def uploads_of(app: object) -> Uploads:
    """Return what takes in the files of an application."""
    layer = app.middleware_stack  # type: ignore[attr-defined]
    while not isinstance(layer, Guard):
        layer = layer.app
    return layer.uploads


def test_two_gigabytes_are_refused_before_they_are_sent(tmp_path: Path) -> None:
    settings = settings_in(tmp_path)
    with running(create_app(settings), settings) as url:
        refused = answered(url, request_of(2_000_000_000, "Expect: 100-continue"))
        assert refused.startswith("HTTP/1.1 413 ")
        assert "body_too_large" in refused
        bomb = gzip.compress(bytes(100_000_000))
        refused = answered(url, request_of(len(bomb), "Content-Encoding: gzip") + bomb[:1000])
        assert refused.startswith("HTTP/1.1 415 ")
        assert "packed_body" in refused
    assert not settings.clips_folder.exists() or not any(settings.clips_folder.iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux shows processes in /proc")
def test_a_large_file_takes_no_memory_of_the_service(tmp_path: Path) -> None:
    """Sixty megabytes are sent: at no time does the service hold a third of that more."""
    table = f"{HEADER},{','.join(f'odd_{i}' for i in range(100))}\n"
    tail = ",0.98,1,0.5,1" + ",0.12345" * 100 + "\n"

    def content() -> Iterator[bytes]:
        yield table.encode()
        for first in range(0, 72_000, 1000):
            rows = (f"{i},{i / 60:.4f}{tail}" for i in range(first, first + 1000))
            yield "".join(rows).encode()

    with started_service({"RISORIUS_DATA_DIR": str(tmp_path)}) as started:
        process = Path(f"/proc/{started.process.pid}")
        (process / "clear_refs").write_text("5")  # The peak is counted from here on.
        before = resident(started.process.pid)
        address = f"{started.url}/api/clips?textures=0&seconds=0.1"
        answer = httpx2.post(address, content=content(), headers=CSV, timeout=300)
        assert answer.status_code == 202, answer.text
        assert answer.json()["report"]["track"]["rows"] == 72_000
        status = (process / "status").read_text(encoding="utf-8")
        peak = int(re.search(r"VmHWM:\s+(\d+) kB", status)[1]) / 1024  # type: ignore[index]
        assert peak - before < 20.0
        assert not list((tmp_path / "clips").glob("*.upload"))
