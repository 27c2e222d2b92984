"""What a session's writers hold is kept as the engine holds it, with what is left of each lease."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from hypothesis import example, given, settings
from hypothesis import strategies as st

from engine import Keyframe, Rig, Writers, builtin_rig
from service.commands import held_from_json, held_to_json

RIG: Rig = builtin_rig("standard")
UNITS = st.dictionaries(
    st.sampled_from(["AU12", "L12", "R12", "12", "AU6", "L6"]),
    st.sampled_from([0.0, 0.5, 1.0]),
    max_size=3,
)
COMMANDS = st.builds(
    Keyframe,
    layer=st.sampled_from(["emotion", "puppet"]),
    owner=st.sampled_from(["anyone", "agent"]),
    action_units=UNITS,
    jaw=st.dictionaries(st.just("pitch"), st.sampled_from([0.0, 5.0]), max_size=1),
    emotion=st.none() | st.just(("happiness", 0.5)),
    expression=st.booleans(),
    plays=st.sampled_from([{}, {"label": "joy", "parts": [{"recipe": "happiness"}]}]),
    weight=st.sampled_from([0.5, 1.0]),
    ttl=st.none() | st.just(3.0),
    replace=st.booleans(),
)


def holding(commands: Sequence[Keyframe], tick: int = 0) -> Writers:
    writers = Writers(RIG)
    for command in commands:
        writers.take(command, tick)
    return writers


def restarted(writers: Writers, tick: int) -> Writers:
    """Return what a service that starts again reads of what another one kept at `tick`."""
    kept: list[dict[str, Any]] = json.loads(json.dumps(held_to_json(writers.keyframes(tick))))
    return holding(held_from_json(kept, RIG))


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
def test_a_restart_holds_what_was_held(commands: list[Keyframe]) -> None:
    writers = holding(commands)
    assert restarted(writers, 0).report(0) == writers.report(0)


def test_a_restart_goes_on_with_what_is_left_of_a_lease() -> None:
    writers = holding([Keyframe(owner="agent", action_units={"AU12": 1.0}, ttl=2.0)])
    assert restarted(writers, 90).alarm() == 30
    assert restarted(writers, 120).alarm() is None
    assert restarted(writers, 120).report(0) == {}


def test_what_was_kept_before_there_were_owners_is_read() -> None:
    kept = [
        {"time": 0.0, "layer": "puppet", "action_units": {"AU12": 0.5}},
        {"time": 0.0, "layer": "emotion", "emotion": {"label": "happiness", "intensity": 0.5}},
    ]
    layers = holding(held_from_json(kept, RIG)).report(0)
    assert set(layers) == {"emotion", "puppet"}


def test_a_command_that_lapses_leaves_what_others_hold() -> None:
    writers = holding([Keyframe(action_units={"AU12": 1.0})])
    writers.take(Keyframe(owner="agent", action_units={"AU1": 1.0}, hold=0.5), 0)
    assert [keyframe.owner for keyframe in writers.keyframes(29)] == ["anyone", "agent"]
    assert [keyframe.owner for keyframe in writers.keyframes(30)] == ["anyone"]
