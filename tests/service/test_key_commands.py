"""`risorius keys`, and what `risorius serve` does with and without a key."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from service.cli import app

KEY = re.compile(r"rsr_[0-9a-f]{8}_[0-9a-f]{64}")


@pytest.fixture(autouse=True)
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of its own for the database."""
    monkeypatch.setenv("RISORIUS_DATA_DIR", str(tmp_path))
    return tmp_path


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def refused(result: Result) -> str:
    assert result.exit_code == 2, result.output
    assert "Traceback" not in result.output
    return " ".join(result.output.split())


def test_a_key_is_made_listed_and_taken_away() -> None:
    made = run("keys", "add", "ada", "--sessions", 3, "--upload-bytes", 5_000_000_000)
    assert made.exit_code == 0, made.output
    key = made.stdout.strip()
    assert KEY.fullmatch(key)
    assert run("keys", "add", "bob").stdout.strip() != key
    (ada, bob) = json.loads(run("keys", "list", "--json").stdout)["keys"]
    assert (ada["name"], ada["sessions"], ada["viewers"]) == ("ada", 3, None)
    assert ada["upload_bytes"] == 5_000_000_000
    assert bob["name"] == "bob"
    shown = run("keys", "list").output
    assert key not in shown
    assert key[: len("rsr_") + 9] in shown
    assert run("keys", "remove", "ada").exit_code == 0
    assert "ada" not in run("keys", "list").output
    run("keys", "remove", "bob")
    assert "no keys" in run("keys", "list").output


def test_what_cannot_be_done_is_said() -> None:
    assert "names no key" in refused(run("keys", "add", "a b"))
    run("keys", "add", "ada")
    assert "There is a key named 'ada'" in refused(run("keys", "add", "ada"))
    assert "there is ada" in refused(run("keys", "remove", "eve"))
    refused(run("keys", "add", "bob", "--sessions", 0))


def test_an_unreadable_database_is_said(data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (data / "file").write_text("")
    monkeypatch.setenv("RISORIUS_DATA_DIR", str(data / "file" / "data"))
    assert "cannot be opened" in refused(run("keys", "list"))


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.0.2.1"])
def test_without_a_key_no_other_machine_is_listened_to(host: str) -> None:
    said = refused(run("serve", "--host", host, "--port", 0))
    assert said.startswith(f"Without a key risorius listens on this machine only, and {host} is")
    assert "risorius keys add NAME" in said
    assert said.count(".") - host.count(".") == 1, "one sentence"


def started(port: int) -> subprocess.Popen[str]:
    """Start a service as the image does."""
    image = {"RISORIUS_HOST": "0.0.0.0", "RISORIUS_MAKE_KEY": "1"}
    return subprocess.Popen(
        [sys.executable, "-m", "service", "serve", "--port", str(port)],
        env={**os.environ, **image},
        cwd=Path(__file__).parents[2],
        stderr=subprocess.PIPE,
        text=True,
    )


def status(port: int, key: str = "") -> int:
    """Return what a service answers, once it does."""
    request = urllib.request.Request(
        f"http://127.0.0.1:{port}/api/sessions", headers={"X-API-Key": key} if key else {}
    )
    deadline = time.monotonic() + 60
    while True:
        try:
            with urllib.request.urlopen(request, timeout=5) as answer:
                return int(answer.status)
        except urllib.error.HTTPError as error:
            error.close()
            return error.code
        except OSError:
            assert time.monotonic() < deadline
            time.sleep(0.1)


def test_the_image_makes_a_key_at_its_first_start_and_prints_it_once(data: Path) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    keys: list[str] = []
    for turn in range(2):
        process = started(port)
        said = ""
        try:
            assert process.stderr is not None
            while "Risorius at" not in said:
                line = process.stderr.readline()
                assert line, said
                said += line
            keys += KEY.findall(said)
            assert len(keys) == 1, f"start {turn}: {said}"
            assert status(port) == 401
            assert status(port, keys[0]) == 200
            process.send_signal(signal.SIGINT)
            _, rest = process.communicate(timeout=60)
        finally:
            process.kill()
            process.communicate()
        assert not KEY.search(rest)
    kept = b"".join(path.read_bytes() for path in data.glob("risorius.sqlite3*"))
    assert keys[0].encode() not in kept
    assert [row["name"] for row in json.loads(run("keys", "list", "--json").stdout)["keys"]] == [
        "first"
    ]
