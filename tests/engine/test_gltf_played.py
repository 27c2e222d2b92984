"""A clip's file carries what it takes to play it again, bit for bit."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from glb_reader import Glb
from glb_tools import assert_valid
from recorded import FPS, TIMELINE, standard_clip
from small_motion import small_clip

from engine import Keyframe, Model, Performance, Rig, Timeline, builtin_rig, version
from engine.clip import record
from engine.errors import InvalidTrack
from engine.gltf import clip_to_glb, face_to_glb, performance_of
from engine.gltf.played import MOST_TEXT

ORIGIN = {"root": "standard", "steps": [{"tissue": {"damping": 40.0}}]}
KEYFRAMES = tuple(
    Keyframe(time=number / 50, action_units={"R12": 1 / (3 + number)}, fade=None, owner="a:b")
    for number in range(400)
)


def small_performance(timeline: Timeline) -> Any:
    """The small clip as if that timeline had been played on it."""
    clip = vars(small_clip(4))
    return SimpleNamespace(
        **{**clip, "timeline": timeline, "model": Model(integrator="verlet"), "start": 0.25}
    )


@pytest.mark.parametrize("count", [1, 400])
def test_what_was_played_is_read_back(count: int, tmp_path: Path) -> None:
    timeline = Timeline(KEYFRAMES[:count], duration=9.0)
    clip = small_performance(timeline)
    data = clip_to_glb(clip, tolerance=0.07, origin=ORIGIN, seed=4_000_000_000)
    told = performance_of(data)
    assert told.timeline == timeline
    assert told.model == clip.model
    assert (told.fps, told.start, told.seed) == (30, 0.25, 4_000_000_000)
    assert (told.version, told.level) == (version(), "high")
    assert told.rig == {"id": clip.rig.id, "name": "small", "recipe": None, **ORIGIN}
    assert told.file["tolerance"] == 0.07
    assert_valid(tmp_path, played=data)


def test_a_long_timeline_is_compressed() -> None:
    timeline = Timeline(KEYFRAMES, duration=9.0)
    assert len(json.dumps(timeline.to_json())) > MOST_TEXT
    long = clip_to_glb(small_performance(timeline))
    assert len(long) - len(clip_to_glb(small_performance(Timeline(KEYFRAMES[:1], 9.0)))) < 10_000
    assert set(Glb(long).json["asset"]["extras"]["performance"]["timeline"]) == {
        "bufferView",
        "encoding",
    }


@pytest.mark.parametrize("layer", ["emotion", "puppet", "speech"])
def test_a_timeline_keeps_the_layer_that_was_meant(layer: str) -> None:
    timeline = Timeline((Keyframe(emotion=("fear", 0.5), layer=layer),), duration=1.0)
    assert Timeline.from_json(timeline.to_json()) == timeline


def test_a_recorded_clip_is_played_again_bit_for_bit() -> None:
    clip = standard_clip()
    told = performance_of(clip_to_glb(clip, origin={"root": "standard", "steps": []}))
    rig: Rig = builtin_rig(told.rig["root"])
    assert rig.id == told.rig["id"]
    assert told.rig["recipe"] == rig.recipe.to_json() if rig.recipe else None
    assert told.timeline == TIMELINE
    again = record(rig.at_level(told.level), told.timeline, fps=told.fps, model=told.model)
    np.testing.assert_array_equal(again.displacements, clip.displacements)
    assert again.poses == clip.poses


@pytest.mark.parametrize("seconds", [0.26, 0.5])
def test_what_was_left_out_is_left_out_again(seconds: float) -> None:
    clip = standard_clip().after(seconds)
    again = standard_clip().after(clip.start)
    assert clip.start == pytest.approx(seconds, abs=0.5 / FPS)
    np.testing.assert_array_equal(again.displacements, clip.displacements)


def test_frames_that_were_put_together_have_none() -> None:
    data = clip_to_glb(small_clip(4))
    with pytest.raises(InvalidTrack, match="holds no performance"):
        performance_of(data)
    rig = small_clip(4).rig
    still = SimpleNamespace(tick=0, displacements=np.zeros_like(rig.head.points), pose=None)
    still.pose = small_clip(4).poses[0]
    with pytest.raises(InvalidTrack, match="holds no performance"):
        performance_of(face_to_glb(rig, still))


@pytest.mark.parametrize("data", [b"", b"glTF", b"hello, world, how are you", b"glTF" * 9])
def test_what_is_no_glb_file_is_refused(data: bytes) -> None:
    with pytest.raises(InvalidTrack, match="no GLB file"):
        performance_of(data)


@pytest.mark.parametrize("field", ["rig", "model", "timeline", "fps"])
def test_a_performance_with_a_hole_is_refused(field: str) -> None:
    performance = Performance.of(small_performance(Timeline(KEYFRAMES[:1], 1.0)))
    assert performance is not None
    told = performance.to_json()
    assert Performance.from_json(told) == performance
    del told[field]
    with pytest.raises(InvalidTrack, match=field):
        Performance.from_json(told)


@pytest.mark.parametrize("packed", [{"bufferView": 7}, {"bufferView": 0}, {"bufferView": "no"}, {}])
def test_a_timeline_that_is_not_where_it_should_be_is_refused(packed: dict[str, object]) -> None:
    performance = Performance.of(small_performance(Timeline(KEYFRAMES[:1], 1.0)))
    assert performance is not None
    told = {**performance.to_json(), "timeline": packed}
    document = {
        "asset": {"version": "2.0", "extras": {"performance": told}},
        "bufferViews": [{"buffer": 0, "byteLength": 4}],
    }
    with pytest.raises(InvalidTrack, match="unpacked"):
        performance_of(glb(document, b"\0\0\0\0"))


def glb(document: dict[str, object], binary: bytes) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + len(binary)
    head = struct.pack("<4sIII4s", b"glTF", 2, size, len(text), b"JSON")
    return head + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
