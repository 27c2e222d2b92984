"""What a default clip weighs, whatever is played: a megabyte at most for ten seconds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from glb_reader import Glb

from engine import Keyframe, Model, Timeline, builtin_rig, clip_to_glb, random_mixes, record
from engine.speech import cues_of, speech_keyframes

SECONDS, BETWEEN = 10.0, 2.5
EMOTIONS = ("joy", "surprise", "anger", "sadness")
SOUNDS = "PP aa TH ih SS E nn oh FF ou DD E CH aa RR ih kk I nn U sil aa PP E RR oh".split()
LEVEL, FPS = "medium", 30
"""Those of a clip of which nothing is said."""


def mixes() -> tuple[Keyframe, ...]:
    """Two to five units at once, of any, and others every 2.5 s."""
    several = random_mixes(builtin_rig("standard"), 4, 2001)
    return tuple(
        replace(mix, time=number * BETWEEN, fade=0.3, replace=True)
        for number, mix in enumerate(several)
    )


def expressions() -> tuple[Keyframe, ...]:
    """One emotion after the other."""
    return tuple(
        Keyframe(time=number * BETWEEN, emotion=(label, 1.0), layer="emotion", fade=0.3)
        for number, label in enumerate(EMOTIONS)
    )


def speech() -> tuple[Keyframe, ...]:
    """Ten sounds a second, without a pause."""
    sounds = (SOUNDS * 4)[:98]
    cues, end = cues_of([{"viseme": each, "duration": 0.1} for each in sounds])
    return tuple(speech_keyframes(cues, end))


@pytest.mark.parametrize("play", [mixes, expressions, speech])
def test_ten_seconds_weigh_a_megabyte_at_most(
    play: Callable[[], tuple[Keyframe, ...]],
) -> None:
    rig = builtin_rig("standard").at_level(LEVEL)
    model = replace(Model.for_rig(rig), integrator="verlet")
    data = clip_to_glb(record(rig, Timeline(play(), SECONDS), fps=FPS, model=model))
    assert len(data) <= 1_000_000
    extras = Glb(data).json["asset"]["extras"]
    assert (extras["frames"], extras["form"]) == (301, "basis")
    assert extras["max_error_mm"] <= extras["tolerance_mm"] == 0.1
