"""What a session's layers hold is kept as the engine holds it, whatever came before."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from engine import Keyframe, Rig, Simulator, builtin_rig
from service.commands import held_from_json, held_to_json, hold

RIG: Rig = builtin_rig("standard")
UNITS = st.dictionaries(
    st.sampled_from(["AU12", "L12", "R12", "12", "AU6", "L6"]),
    st.sampled_from([0.0, 0.5, 1.0]),
    max_size=3,
)
COMMANDS = st.builds(
    Keyframe,
    layer=st.sampled_from(["emotion", "puppet"]),
    action_units=UNITS,
    jaw=st.dictionaries(st.just("pitch"), st.sampled_from([0.0, 5.0]), max_size=1),
    emotion=st.none() | st.just(("happiness", 0.5)),
    weight=st.sampled_from([0.5, 1.0]),
    replace=st.booleans(),
)


def layers(simulator: Simulator, face: str, keyframes: Sequence[Keyframe]) -> object:
    simulator.add(face)
    for keyframe in keyframes:
        simulator.apply(face, keyframe)
    report = simulator.report(face)["layers"]
    simulator.remove(face)
    return report


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    """One simulator for every example."""
    return Simulator(RIG, threads=1)


@given(commands=st.lists(COMMANDS, max_size=5))
@example(commands=[Keyframe(action_units={"AU12": 0.0, "12": 1.0})])
@example(commands=[Keyframe(action_units={"L12": 1.0}), Keyframe(action_units={"AU12": 0.5})])
@example(
    commands=[
        Keyframe(action_units={"AU12": 0.0, "L12": 0.5}),
        Keyframe(action_units={"R12": 0.0}),
    ]
)
@settings(max_examples=150, deadline=None)
def test_a_restart_holds_what_was_held(simulator: Simulator, commands: list[Keyframe]) -> None:
    held: dict[str, Keyframe] = {}
    for command in commands:
        hold(held, command, RIG)
    again = held_from_json(held_to_json(held), RIG)
    assert layers(simulator, "again", again) == layers(simulator, "live", commands)


def test_a_command_that_lapses_leaves_nothing_of_its_layer() -> None:
    held: dict[str, Keyframe] = {}
    hold(held, Keyframe(action_units={"AU12": 1.0}), RIG)
    hold(held, Keyframe(action_units={"AU1": 1.0}, hold=0.5), RIG)
    assert held == {}
