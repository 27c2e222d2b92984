"""The contract of a runner, for every runner there is."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager

import numpy as np
import pytest

from engine import Frame, Idle, Keyframe, Model, Rig, Simulator, Timeline, builtin_rig
from service.embedded import EmbeddedRunner
from service.errors import Busy, NotFound
from service.runner import Move, Runner

NOTHING = Timeline((), 1.0)
SMILE = Keyframe(action_units={"AU12": 1.0}, fade=0.1)


@pytest.fixture(scope="module")
def rig() -> Rig:
    """The standard rig."""
    return builtin_rig("standard")


@asynccontextmanager
async def embedded() -> AsyncIterator[Runner]:
    runner = EmbeddedRunner(simulation_threads=1)
    runner.start()
    try:
        yield runner
    finally:
        await asyncio.to_thread(runner.stop)


RUNNERS = [embedded]


def contract(test: Callable[[Runner, Rig], Awaitable[None]]) -> Callable[..., None]:
    """Run an asynchronous test with every runner, half a minute at most."""

    @pytest.mark.parametrize("make", RUNNERS)
    def run(make: Callable[[], object], rig: Rig) -> None:
        async def body() -> None:
            async with make() as runner:  # type: ignore[attr-defined]
                await asyncio.wait_for(test(runner, rig), 30)

        asyncio.run(body())

    return run


async def frames_until(runner: Runner, face: str, true: Callable[[Frame], bool]) -> list[Frame]:
    """Read ticks until a frame of `face` for which `true` holds."""
    frames = []
    async for tick in runner.ticks():
        if face in tick.frames:
            frames.append(tick.frames[face])
            if true(frames[-1]):
                return frames
    raise AssertionError("the runner ended")


def played(rig: Rig, keyframe: Keyframe, at: int, until: int) -> Frame:
    """Return what a fresh simulator shows at `until`."""
    simulator = Simulator(rig)
    simulator.add("a")
    for tick in range(until):
        if tick == at:
            simulator.apply("a", keyframe)
        simulator.step()
    return simulator.frame("a")


async def a_face_does_what_a_simulator_does(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    tick = await runner.apply("a", SMILE)
    last = (await frames_until(runner, "a", lambda f: f.asleep and f.tick > tick))[-1]
    same = played(rig, SMILE, tick, last.tick)
    np.testing.assert_array_equal(last.displacements, same.displacements)


async def a_face_opens_with_its_timeline(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, Timeline((SMILE,), 1.0), Model.for_rig(rig))
    view = await runner.view("a")
    assert view.report["layers"]["puppet"]["action_units"] == {"AU12": 1.0}  # type: ignore[index]


async def a_command_that_lapses_lets_go_of_a_sleeping_face(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    await runner.apply("a", Keyframe(action_units={"AU12": 1.0}, hold=2.0, fade_out=0.1))
    frames = await frames_until(runner, "a", lambda f: f.tick > 130 and f.asleep)
    assert any(frame.asleep for frame in frames if frame.tick < 120)
    assert np.abs(frames[-1].displacements).max() < 0.5


async def a_sleeping_face_costs_nothing(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    await frames_until(runner, "a", lambda f: f.asleep)
    counters = runner.counters  # type: ignore[attr-defined]
    before = counters.ticks
    await asyncio.sleep(0.3)
    assert counters.ticks <= before + 1


async def a_face_moves_to_another_rig_as_it_stands(runner: Runner, rig: Rig) -> None:
    other = rig.derive(muscles={"zygomatic_major.L": {"strength": 1.2}})
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    await runner.apply("a", SMILE)
    await frames_until(runner, "a", lambda f: f.asleep and f.tick > 10)
    before = await runner.view("a")
    tick = await runner.apply("a", Move(other))
    after = await runner.view("a")
    assert tick >= before.frame.tick
    assert np.abs(after.frame.displacements - before.frame.displacements).max() < 1.0
    assert after.report["layers"] == before.report["layers"]


async def faces_of_one_rig_do_not_know_each_other(runner: Runner, rig: Rig) -> None:
    for face in ("a", "b", "c"):
        await runner.open(face, rig, NOTHING, Model.for_rig(rig))
    tick = await runner.apply("b", SMILE)
    last = (await frames_until(runner, "b", lambda f: f.asleep and f.tick > tick))[-1]
    same = played(rig, SMILE, tick, last.tick)
    np.testing.assert_array_equal(last.displacements, same.displacements)
    assert np.abs((await runner.view("a")).frame.displacements).max() < 1e-9


async def a_closed_face_is_gone(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    await runner.close("a")
    for question in (runner.view("a"), runner.close("a"), runner.apply("a", SMILE)):
        with pytest.raises(NotFound):
            await question


async def a_face_that_diverges_is_reported(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    await runner.apply("a", SMILE)
    group = runner._home["a"]  # type: ignore[attr-defined]
    group.simulator._faces["a"].v[:] = np.nan
    async for tick in runner.ticks():
        if "a" in tick.reset:
            break
    view = await runner.view("a")
    assert np.isfinite(view.frame.displacements).all()
    assert view.report["layers"] == {}


async def a_simulator_that_raises_ends_nothing(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    group = runner._home["a"]  # type: ignore[attr-defined]
    group.simulator._faces["a"].x = None
    await runner.apply("a", SMILE)
    async for tick in runner.ticks():
        if "a" in tick.reset:
            break
    await runner.apply("a", SMILE)
    await frames_until(runner, "a", lambda f: bool(np.abs(f.displacements).max() > 3))


async def a_simulation_that_ended_is_said(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    runner._step = None  # type: ignore[attr-defined]
    asked = [asyncio.create_task(runner.view("a")) for _ in range(3)]
    await asyncio.gather(*asked, return_exceptions=True)
    await asyncio.to_thread(runner._thread.join)  # type: ignore[attr-defined]
    for question in (runner.view("a"), runner.apply("a", SMILE), runner.close("a")):
        with pytest.raises(Busy, match="log says why"):
            await question


async def what_is_asked_while_it_stops_is_answered(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    runner._mailbox.stop()  # type: ignore[attr-defined]
    late = [asyncio.create_task(runner.view("a")) for _ in range(3)]
    results = await asyncio.gather(*late, return_exceptions=True)
    assert all(isinstance(result, Busy) for result in results)


async def a_view_names_the_writers(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig))
    await runner.apply("a", Keyframe(layer="emotion", emotion=("happiness", 0.5)))
    await runner.apply("a", Keyframe(action_units={"AU12": 1.0}, jaw={"pitch": 5.0}))
    merged = (await runner.view("a")).report["merged"]
    writers = merged["writers"]  # type: ignore[index]
    assert writers["AU12"] == ["emotion", "puppet"]
    assert writers["AU6"] == ["emotion"]
    assert writers["jaw.pitch"] == ["puppet"]


async def a_face_lives_waits_goes_on_and_ends(runner: Runner, rig: Rig) -> None:
    await runner.open("a", rig, NOTHING, Model.for_rig(rig, integrator="verlet"))
    await runner.live("a", Idle(seed=1, blinks=0.0, gaze=0.0, micro=0.0))
    await frames_until(runner, "a", lambda frame: frame.pose.head[0] != 0.0)
    await runner.pause("a")
    last = (await frames_until(runner, "a", lambda frame: frame.asleep))[-1]
    assert last.pose.head == (0.0, 0.0, 0.0)
    await runner.resume("a")
    await frames_until(runner, "a", lambda frame: any(frame.pose.head))
    await runner.live("a", None)
    await frames_until(runner, "a", lambda frame: frame.asleep)
    assert (await runner.view("a")).report["layers"] == {}
    for question in (runner.live("b", None), runner.pause("b"), runner.resume("b")):
        with pytest.raises(NotFound):
            await question


test_a_face_lives = contract(a_face_lives_waits_goes_on_and_ends)
test_a_face_does_what_a_simulator_does = contract(a_face_does_what_a_simulator_does)
test_a_face_opens_with_its_timeline = contract(a_face_opens_with_its_timeline)
test_a_lapse_wakes_a_sleeping_face = contract(a_command_that_lapses_lets_go_of_a_sleeping_face)
test_a_sleeping_face_costs_nothing = contract(a_sleeping_face_costs_nothing)
test_a_face_moves_to_another_rig = contract(a_face_moves_to_another_rig_as_it_stands)
test_faces_do_not_know_each_other = contract(faces_of_one_rig_do_not_know_each_other)
test_a_closed_face_is_gone = contract(a_closed_face_is_gone)
test_a_face_that_diverges_is_reported = contract(a_face_that_diverges_is_reported)
test_a_simulator_that_raises_ends_nothing = contract(a_simulator_that_raises_ends_nothing)
test_a_simulation_that_ended_is_said = contract(a_simulation_that_ended_is_said)
test_what_is_asked_late_is_answered = contract(what_is_asked_while_it_stops_is_answered)
test_a_view_names_the_writers = contract(a_view_names_the_writers)
