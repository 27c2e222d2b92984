"""Processes that work for the service: how they end."""

from __future__ import annotations

import asyncio
import pickle
import sys
from asyncio.subprocess import PIPE
from pathlib import Path

import pytest

from engine import Keyframe
from service.apart import environment
from service.expression_orders import Face, Look, PictureOrder
from service.kept_processes import KeptProcesses

PHOTOGRAPHER = """
import contextlib, pathlib, sys, time
import service.picture_process

@contextlib.contextmanager
def studio(**folders):
    opened = folders["cache_dir"] / "opened"
    opened.mkdir()
    try:
        print("opened", flush=True, file=sys.stderr)
        time.sleep(600)
        yield
    finally:
        opened.rmdir()

service.picture_process.studio = studio
service.picture_process.main()
"""


def test_who_is_ended_in_the_middle_of_a_picture_leaves_nothing_behind(tmp_path: Path) -> None:
    order = PictureOrder(Face("standard", [], Keyframe()), Look())

    async def body() -> int:
        folders = [str(tmp_path), str(tmp_path)]
        command = [sys.executable, "-c", PHOTOGRAPHER, *folders]
        process = await asyncio.create_subprocess_exec(
            *command, env=environment(), stdin=PIPE, stdout=PIPE, stderr=PIPE
        )
        assert process.stdin is not None
        assert process.stderr is not None
        process.stdin.write(pickle.dumps(order))
        assert await process.stderr.readline() == b"opened\n"
        assert list(tmp_path.iterdir())
        await KeptProcesses("picture_process").end(process)
        assert process.returncode is not None
        return process.returncode

    assert asyncio.run(asyncio.wait_for(body(), 120)) == 0
    assert list(tmp_path.iterdir()) == []


def test_who_does_not_end_is_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.kept_processes._ENDING_SECONDS", 0.2)
    code = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print(flush=True)"

    async def body() -> None:
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-c", f"{code}; time.sleep(600)", stdout=PIPE
        )
        assert process.stdout is not None
        await process.stdout.readline()
        await KeptProcesses("picture_process").end(process)
        assert process.returncode == -9

    asyncio.run(asyncio.wait_for(body(), 120))
