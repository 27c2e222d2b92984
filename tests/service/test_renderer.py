"""Clips in processes of their own: the same files, whole or not at all, and nobody left behind."""

import asyncio
import os
import signal
import subprocess
import sys
import time
from asyncio.subprocess import Process
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import pytest

from engine import Keyframe, Model, Timeline, builtin_rig
from service.errors import Unprocessable
from service.priority import BEHIND
from service.render_process import Order, carry_out
from service.renderer import Renderer, RenderingEnded
from service.whole_files import part_of

SMILE = Keyframe(action_units={"AU12": 1.0})
Scene = Callable[[Renderer], Awaitable[None]]
on_linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux shows processes in /proc")


def order_in(folder: Path, *, seconds: float = 0.2) -> Order:
    return Order(
        root="standard",
        steps=[{"tissue": {"damping": 40.0}}],
        timeline=Timeline((SMILE,), seconds),
        fps=30,
        model=Model.for_rig(builtin_rig("standard")),
        start=0.0,
        level="low",
        textures={},
        glb=folder / "clip.glb",
        csv=folder / "clip.csv",
    )


def play(scene: Scene) -> None:
    async def body() -> None:
        renderer = Renderer()
        try:
            await scene(renderer)
        finally:
            await renderer.stop()

    asyncio.run(asyncio.wait_for(body(), 120))


def only(renderer: Renderer) -> Process:
    (process,) = renderer._processes.waiting
    return process


@on_linux
def test_a_process_makes_the_same_bits_and_stands_back(tmp_path: Path) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    there.mkdir()
    shares: list[float] = []

    async def scene(renderer: Renderer) -> None:
        figures = await renderer.render(order_in(there), shares.append)
        process = only(renderer)
        nice = os.getpriority(os.PRIO_PROCESS, 0)
        assert os.getpriority(os.PRIO_PROCESS, process.pid) == min(nice + BEHIND, 19)
        unknown = Timeline((Keyframe(action_units={"AU99": 1.0}),), 0.2)
        with pytest.raises(Unprocessable, match="AU99"):
            await renderer.render(replace(order_in(there), timeline=unknown), lambda share: None)
        assert only(renderer) is process
        alone = carry_out(order_in(here), lambda share: None)
        assert figures["frames"] == alone["frames"] == 7
        assert figures["bytes"] == (there / "clip.glb").stat().st_size
        await renderer.stop()
        assert process.returncode == 0, "let go, not killed"

    play(scene)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    for name in ("clip.glb", "clip.csv"):
        assert (here / name).read_bytes() == (there / name).read_bytes()


def test_what_is_stopped_or_killed_leaves_no_file(tmp_path: Path) -> None:
    long = order_in(tmp_path, seconds=600.0)

    async def scene(renderer: Renderer) -> None:
        moving = asyncio.Event()
        started: list[Process] = []
        make = renderer._processes.take

        async def noted() -> Process:
            started.append(await make())
            return started[-1]

        renderer._processes.take = noted  # type: ignore[method-assign]
        task = asyncio.create_task(renderer.render(long, lambda share: moving.set()))
        await moving.wait()
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task
        assert started[0].returncode is not None
        moving.clear()
        task = asyncio.create_task(renderer.render(long, lambda share: moving.set()))
        await moving.wait()
        part_of(long.glb, started[1].pid).write_bytes(b"half of it")
        os.kill(started[1].pid, signal.SIGKILL)
        with pytest.raises(RenderingEnded, match="-9"):
            await task
        assert not renderer._processes.waiting

    play(scene)
    assert list(tmp_path.iterdir()) == []


SERVICE = """
import asyncio, os, pathlib, signal, sys
from service.renderer import Renderer
from tests.service.test_renderer import order_in

def moving(share):
    os.kill(os.getpid(), signal.SIGKILL)

async def body():
    renderer = Renderer()
    make = renderer._processes.take
    async def noted():
        process = await make()
        print(process.pid, flush=True)
        return process
    renderer._processes.take = noted
    await renderer.render(order_in(pathlib.Path(sys.argv[1]), seconds=600.0), moving)

asyncio.run(body())
"""


@on_linux
def test_it_ends_with_its_service(tmp_path: Path) -> None:
    home = Path(__file__).parents[2]
    ended = subprocess.run(
        [sys.executable, "-c", SERVICE, str(tmp_path)],
        cwd=home,
        env={**os.environ, "PYTHONPATH": str(home)},
        stdout=subprocess.PIPE,
        text=True,
        timeout=60,
        check=False,
    )
    assert ended.returncode == -signal.SIGKILL
    deadline = time.monotonic() + 20.0
    while Path(f"/proc/{int(ended.stdout)}").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not Path(f"/proc/{int(ended.stdout)}").exists()
    assert list(tmp_path.iterdir()) == []
