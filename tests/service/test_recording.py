"""What a live face did last, recorded: the same bits from its first tick, the same face later."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
import pytest

from engine import Clip, Keyframe, Model, Timeline, builtin_rig, record
from service.bodies import NewClip
from service.commands import clip_timeline, model_of
from service.errors import Conflict, Refused
from service.recording import LEAD_SECONDS, recorded_clip
from service.runner import Move
from service.tail import Command, Tail

RIG = builtin_rig("standard")
MODEL = Model.for_rig(RIG, integrator="verlet")
TOLD: Mapping[int, Keyframe] = {
    0: Keyframe(layer="mood", owner="a", action_units={"AU4": 0.5}, fade=0.2),
    20: Keyframe(layer="emotion", owner="b", emotion=("happiness", 0.7), fade=None, replace=True),
    60: Keyframe(
        layer="emotion", owner="b", action_units={"L12": 0.9}, expression=True, replace=True
    ),
    90: Keyframe(
        layer="puppet",
        owner="c",
        jaw={"pitch": 8.0},
        muscles={"risorius.L": 0.3},
        ttl=2.0,
        weight=0.5,
    ),
    180: Keyframe(layer="emotion", owner="b", action_units={"AU1": 1.0}, fade=0.1, hold=0.2),
}
NOW = 240


def commands() -> list[Command]:
    return [Command(tick, keyframe) for tick, keyframe in TOLD.items()]


def told(commands: Iterable[Command]) -> Tail:
    """Return the tail of a new face that was told these."""
    tail = Tail(RIG)
    for command in commands:
        tail.add(command)
    return tail


def live(ticks: int) -> Clip:
    """What the face did, as a live one does it."""
    timeline = Timeline(
        tuple(replace(keyframe, time=tick / 60) for tick, keyframe in TOLD.items()), ticks / 60
    )
    return record(RIG, timeline, fps=60, model=MODEL)


def played(clip: NewClip) -> Clip:
    timeline, _ = clip_timeline(clip, RIG)
    rendered = record(RIG, timeline, fps=clip.fps, model=model_of(clip.model, RIG))
    return rendered.after(clip.start)


def test_a_young_face_is_recorded_bit_for_bit() -> None:
    clip = recorded_clip(told(commands()), RIG, MODEL, now=NOW, last=60.0, fps=60)
    assert clip.start == 0.0
    assert clip.duration == NOW / 60
    assert np.array_equal(played(clip).displacements, live(NOW).displacements)


@pytest.mark.parametrize("now", [NOW, 131])
def test_the_last_second_is_the_face_s_own(now: int) -> None:
    clip = recorded_clip(told(commands()), RIG, MODEL, now=now, last=1.0, fps=60)
    assert clip.start == LEAD_SECONDS
    seen, was = played(clip), live(now)
    assert len(seen) == 61
    apart = np.abs(seen.displacements - was.displacements[-61:]).max()
    moved = np.abs(was.displacements[-61:]).max()
    assert apart < 0.02 * moved


def test_a_face_that_sleeps_is_shown_still_until_the_seconds_are_full() -> None:
    smile = told([Command(0, Keyframe(action_units={"AU12": 0.8}, fade=0.1))])
    clip = recorded_clip(smile, RIG, MODEL, now=80, last=3.0, fps=30, filled=3.0)
    assert (clip.start, clip.duration) == (0.0, 3.0)
    frames = played(clip).displacements
    assert len(frames) == 91
    late = np.abs(frames[45:] - frames[-1]).max()
    assert late < 0.01 < np.abs(frames[10] - frames[-1]).max()


@pytest.mark.parametrize(("ends", "until"), [(None, 180), (100, 100), (80, 80), (30, 80)])
def test_a_still_face_is_shown_until_a_lease_ends(ends: int | None, until: int) -> None:
    smile = told([Command(0, Keyframe(action_units={"AU12": 0.8}))])
    clip = recorded_clip(smile, RIG, MODEL, now=80, last=3.0, fps=30, filled=3.0, ends=ends)
    assert clip.duration == until / 60


def test_what_is_recorded_is_kept_as_plain_json() -> None:
    clip = recorded_clip(told(commands()), RIG, MODEL, now=NOW, last=1.0, fps=30)
    kept = clip.model_dump(mode="json", exclude_unset=True)
    assert NewClip.model_validate(kept) == clip


def test_a_face_that_moved_to_another_rig_is_recorded_on_its_last() -> None:
    moved = [*commands(), Command(120, Move(RIG))]
    clip = recorded_clip(told(moved), RIG, MODEL, now=NOW, last=60.0, fps=60)
    assert clip == recorded_clip(told(commands()), RIG, MODEL, now=NOW, last=60.0, fps=60)


def test_a_face_that_was_told_nothing_has_nothing_to_record() -> None:
    with pytest.raises(Conflict, match="nothing was ever set"):
        recorded_clip(told([Command(3, Move(RIG))]), RIG, MODEL, now=9, last=1.0, fps=30)


def test_a_clip_starts_before_its_end() -> None:
    clip = NewClip.model_validate({"timeline": [{"time": 0}], "duration": 2.0, "start": 2.0})
    with pytest.raises(Refused, match="below that"):
        clip_timeline(clip, RIG)
