"""Processes beside live faces: held while a full tick is stepped, never for good."""

from __future__ import annotations

import asyncio
import math
import subprocess
import sys
import textwrap
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import until

import service.embedded
from engine import Keyframe, Model, Timeline, builtin_rig
from service.bystanders import Bystanders
from service.embedded import EmbeddedRunner
from service.load import TICK_SECONDS

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux holds them so")


def state(process: int) -> str:
    """Return a process's state as Linux shows it, X where it is gone."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return "X"


@pytest.fixture
def worker() -> Iterator[subprocess.Popen[bytes]]:
    with subprocess.Popen([sys.executable, "-c", "while True: pass"]) as process:
        yield process
        process.kill()


class Watch:
    """A clock that is set."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


def test_who_works_waits_and_goes_on(worker: subprocess.Popen[bytes]) -> None:
    bystanders = Bystanders()
    bystanders.add(worker.pid)
    for _ in range(3):
        bystanders.hold()
        until(lambda: state(worker.pid) == "T")
        bystanders.let_go()
        until(lambda: state(worker.pid) != "T")


def test_who_is_taken_off_while_it_is_held_goes_on(worker: subprocess.Popen[bytes]) -> None:
    bystanders = Bystanders()
    bystanders.add(worker.pid)
    bystanders.hold()
    bystanders.remove(worker.pid)
    until(lambda: state(worker.pid) != "T")
    bystanders.hold()
    time.sleep(0.05)
    assert state(worker.pid) not in "TX"


def test_who_has_ended_or_was_never_there_is_no_matter(worker: subprocess.Popen[bytes]) -> None:
    bystanders = Bystanders()
    bystanders.add(worker.pid)
    bystanders.add(2**30)
    worker.kill()
    worker.wait()
    bystanders.hold()
    bystanders.let_go()
    bystanders.remove(worker.pid)
    bystanders.remove(worker.pid)


def test_where_no_gap_is_left_they_run_a_twentieth_of_the_time(
    worker: subprocess.Popen[bytes],
) -> None:
    watch = Watch()
    bystanders = Bystanders(watch)
    bystanders.add(worker.pid)
    held = 0
    for _ in range(6000):
        bystanders.hold()
        held += bystanders._held
        watch.now += TICK_SECONDS
        bystanders.let_go()
    assert 0.9 < held / 6000 < 0.96


def test_where_ticks_leave_a_gap_every_tick_holds_them(worker: subprocess.Popen[bytes]) -> None:
    watch = Watch()
    bystanders = Bystanders(watch)
    bystanders.add(worker.pid)
    for _ in range(600):
        bystanders.hold()
        assert bystanders._held
        watch.now += 0.9 * TICK_SECONDS
        bystanders.let_go()
        watch.now += 0.1 * TICK_SECONDS


@pytest.mark.parametrize(("full", "expected"), [(0.0, True), (math.inf, False)])
def test_full_ticks_are_stepped_alone(
    monkeypatch: pytest.MonkeyPatch,
    worker: subprocess.Popen[bytes],
    full: float,
    expected: bool,
) -> None:
    monkeypatch.setattr(service.embedded, "_FULL_SECONDS", full)
    bystanders = Bystanders(Watch())  # Nobody is owed anything, however long a tick takes.
    bystanders.add(worker.pid)
    seen = []

    async def body() -> None:
        runner = EmbeddedRunner(bystanders=bystanders)
        step = runner._step

        def stepping() -> int:
            seen.append(bystanders._held)
            return step()

        runner._step = stepping  # type: ignore[method-assign]
        runner.start()
        rig = builtin_rig("standard")
        await runner.open("a", rig, Timeline((), 1.0), Model.for_rig(rig))
        await runner.apply("a", Keyframe(action_units={"AU12": 1.0}))
        while len(seen) < 20:
            await asyncio.sleep(0.01)
        await asyncio.to_thread(runner.stop)

    asyncio.run(asyncio.wait_for(body(), 60))
    assert seen[5:].count(expected) > 0.9 * len(seen[5:])
    until(lambda: state(worker.pid) != "T")


def test_who_is_held_ends_with_a_service_that_is_killed() -> None:
    code = """
        import asyncio, pathlib, time
        from service.bystanders import Bystanders
        from service.kept_processes import KeptProcesses

        async def body():
            bystanders = Bystanders()
            process = await KeptProcesses("render_process", bystanders=bystanders).take()
            # It has only begun to read in what it needs.
            shown = pathlib.Path(f"/proc/{process.pid}/maps")
            deadline = time.monotonic() + 60.0
            while "numpy" not in shown.read_text():
                assert time.monotonic() < deadline
                time.sleep(0.001)
            bystanders.hold()
            print(process.pid, flush=True)
            time.sleep(600)

        asyncio.run(body())
    """
    command = [sys.executable, "-c", textwrap.dedent(code)]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE) as owner:
        try:
            assert owner.stdout is not None
            process = int(owner.stdout.readline())
            until(lambda: state(process) == "T")
        finally:
            owner.kill()
    until(lambda: state(process) in "XZ")
