"""Visemes shape the mouth, and a speech of them closes, opens and rounds it in time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import (
    InvalidTrack,
    InvalidValue,
    Keyframe,
    Model,
    Rig,
    Simulator,
    Timeline,
    UnknownName,
    builtin_rig,
    cues_of,
    speech_keyframes,
    ticks,
    viseme_blend,
    viseme_table,
)
from engine.measure import CHEEK, CORNER, LOWER_LID
from engine.speech import CLOSING_FADE, LEAD, STAYS_CLOSED
from engine.visemes import find_viseme

RIG: Rig = builtin_rig("standard")
NAMES = list(viseme_table().shapes)
SMILE = Keyframe(layer="emotion", action_units={"AU6": 0.8, "AU12": 0.8})
JOY = Keyframe(layer="emotion", action_units={"AU6": 0.8, "AU12": 0.8, "AU25": 0.6, "AU26": 0.6})
CLOSED_MM = 0.3
CHEEK_SHARE, LID_SHARE = 0.65, 0.9
"""How much of its way in a smile a point keeps at least, whatever viseme is spoken."""
WORDS = ("sil", "aa", "PP", "ou", "SS", "FF", "aa", "PP", "E", "CH", "oh", "sil")


def mouth(name: str) -> Keyframe:
    """Return the command that holds a viseme."""
    blend = viseme_blend({name: 1.0})
    axes = {group: blend.axes.get(group, {}) for group in ("jaw", "tongue")}
    return Keyframe(layer="speech", owner="voice", action_units=blend.units, fade=0.1, **axes)


def simulator() -> Simulator:
    """Return a simulator as a live face's."""
    return Simulator(RIG, model=Model.for_rig(RIG, integrator="verlet"), threads=1)


def at(frame: np.ndarray, point: str) -> np.ndarray:
    """Return where a point is, mm."""
    index = RIG.head.point(point)
    return np.asarray(RIG.head.points[index] + frame[index])


def gap(frame: np.ndarray) -> float:
    """Return the most that the lips are apart in their middle, mm."""
    pairs = [("M0_0", "M0_10"), ("M0_1.L", "M0_9.L"), ("M0_2.R", "M0_8.R")]
    return max(float((at(frame, up) - at(frame, low))[1]) for up, low in pairs)


def width(frame: np.ndarray) -> float:
    """Return the width of the mouth, mm."""
    return float((at(frame, CORNER) - at(frame, CORNER.replace(".L", ".R")))[0])


def to_teeth(frame: np.ndarray) -> float:
    """Return how far the lower lip is from the upper teeth, mm."""
    (teeth,) = [part for part in RIG.head.parts if part.name == "teeth.upper"]
    lip = [at(frame, name) for name in ("M0_10", "M1_10", "M0_9.L")]
    return min(float(np.linalg.norm(teeth.vertices - point, axis=1).min()) for point in lip)


@pytest.fixture(scope="module")
def faces() -> dict[str, np.ndarray]:
    """Displacements of a face that holds each viseme, by itself and over a smile and a laugh."""
    sim = simulator()
    for name in NAMES:
        for before, feeling in (("", None), ("smile ", SMILE), ("joy ", JOY)):
            sim.add(before + name)
            if feeling is not None:
                sim.apply(before + name, feeling)
            sim.apply(before + name, mouth(name))
    for _ in range(60):
        sim.step()
    return {face: sim.frame(face).displacements for face in sim.faces}


@pytest.mark.parametrize("feeling", ["", "smile ", "joy "])
def test_lips_close_on_pp(faces: dict[str, np.ndarray], feeling: str) -> None:
    assert gap(faces[f"{feeling}PP"]) < CLOSED_MM


def test_a_laugh_without_speech_is_open(faces: dict[str, np.ndarray]) -> None:
    assert gap(faces["joy sil"]) > 3.0


def test_ff_brings_the_lower_lip_to_the_upper_teeth(faces: dict[str, np.ndarray]) -> None:
    assert to_teeth(faces["FF"]) < 0.6 * to_teeth(faces["sil"])
    assert at(faces["FF"], "M0_10")[1] > at(faces["sil"], "M0_10")[1]
    assert all(to_teeth(faces["FF"]) < to_teeth(faces[name]) for name in NAMES if name != "FF")


def test_aa_opens_the_most(faces: dict[str, np.ndarray]) -> None:
    assert gap(faces["aa"]) > 8.0
    assert all(gap(faces["aa"]) > gap(faces[name]) for name in NAMES if name != "aa")


@pytest.mark.parametrize("name", ["oh", "ou"])
def test_round_vowels_narrow_and_push_out(faces: dict[str, np.ndarray], name: str) -> None:
    rest = faces["sil"]
    assert width(faces[name]) < 0.9 * width(rest)
    assert at(faces[name], "M1_0")[2] > at(rest, "M1_0")[2] + 1.0
    assert gap(faces["oh"]) > gap(faces["ou"]) > 2.0
    assert width(faces["ih"]) > width(rest)


@pytest.mark.parametrize("name", NAMES)
def test_the_smile_stays_in_cheeks_and_eyes(faces: dict[str, np.ndarray], name: str) -> None:
    for point, share in ((CHEEK, CHEEK_SHARE), (LOWER_LID, LID_SHARE)):
        index = RIG.head.point(point)
        smile, now = faces["smile sil"][index], faces[f"smile {name}"][index]
        assert share < float(now @ smile / (smile @ smile)) < 1.15


def spoken(feeling: Keyframe | None = None, pace: float = 0.12) -> list[np.ndarray]:
    """Return displacements, tick by tick, of a face that speaks `WORDS`, `pace` s each."""
    return said(WORDS, pace, feeling)


def said(words: Sequence[str], pace: float, feeling: Keyframe | None = None) -> list[np.ndarray]:
    """Return displacements, tick by tick, of a face that speaks, `pace` s each word."""
    sim = simulator()
    sim.add("face")
    if feeling is not None:
        sim.apply("face", feeling)
        for _ in range(60):
            sim.step()
    cues, end = cues_of([{"viseme": name, "duration": pace} for name in words])
    coming, frames = speech_keyframes(cues, end), []
    for tick in range(ticks(end) + 50):
        while coming and ticks(coming[0].time) <= tick:
            sim.apply("face", coming.pop(0))
        sim.step()
        frames.append(sim.frame("face").displacements)
    return frames


@pytest.mark.parametrize("pace", [0.12, 0.09])
def test_lips_meet_when_a_p_is_heard(pace: float) -> None:
    gaps = [gap(frame) for frame in spoken(pace=pace)][ticks(LEAD) :]
    heard = [
        (name, gaps[ticks(place * pace) : ticks((place + 1) * pace)])
        for place, name in enumerate(WORDS)
    ]
    assert all(min(now) < CLOSED_MM for name, now in heard if name == "PP")
    assert gaps[-1] < CLOSED_MM  # It lets go at the end.
    if pace == 0.12:
        assert all(max(now) > 3.0 for name, now in heard if name == "aa")


def test_a_smile_goes_on_while_the_mouth_speaks() -> None:
    frames = spoken(SMILE)
    for point, share in ((CHEEK, CHEEK_SHARE), (LOWER_LID, LID_SHARE)):
        index = RIG.head.point(point)
        smile = frames[0][index]
        kept = [float(frame[index] @ smile / (smile @ smile)) for frame in frames]
        assert min(kept) > share
        assert kept[-1] == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize(
    ("name", "means"), [("I", "ih"), ("O", "oh"), ("U", "ou"), ("E", "E"), ("viseme_PP", "PP")]
)
def test_other_names_are_understood(name: str, means: str) -> None:
    assert len(NAMES) == 15
    assert find_viseme(name).name == means


def test_visemes_say_the_whole_mouth() -> None:
    every = viseme_blend({})
    assert set(every.units.values()) == {0.0}
    assert set(viseme_blend({"aa": 0.5}).units) == set(every.units)
    assert viseme_blend({"PP": 0.5, "aa": 0.5}).axes["jaw"]["pitch"] == pytest.approx(4.2)


def test_what_is_no_viseme_is_refused() -> None:
    with pytest.raises(UnknownName, match="viseme"):
        viseme_blend({"zz": 1.0})
    with pytest.raises(InvalidValue, match="0 to 1"):
        viseme_blend({"aa": 1.5})
    with pytest.raises(InvalidValue, match="are the same"):
        viseme_blend({"ih": 0.5, "I": 0.5})


def test_a_keyframe_of_visemes_alone_is_speech() -> None:
    timeline = Timeline.from_json({"timeline": [{"time": 0.0, "visemes": {"aa": 0.5}}]})
    assert timeline.keyframes[0].layer == "speech"
    assert timeline.keyframes[0].action_units["AU25"] == pytest.approx(0.25)


CUES = st.lists(
    st.tuples(st.sampled_from(NAMES), st.floats(0.0, 0.5), st.floats(0.0, 1.0)),
    min_size=1,
    max_size=30,
)


@given(CUES)
def test_a_speech_goes_forward_and_ends_silent(spoken: list[tuple[str, float, float]]) -> None:
    entries = [{"viseme": n, "duration": d, "weight": w} for n, d, w in spoken]
    cues, end = cues_of(entries)
    keyframes = speech_keyframes(cues, end)
    starts = [keyframe.time for keyframe in keyframes]
    assert all(ticks(b) > ticks(a) for a, b in pairwise(starts))
    for keyframe in keyframes[:-1]:
        RIG.check(keyframe)
        assert keyframe.layer == "speech"
        assert keyframe.ttl is not None
        assert keyframe.time + keyframe.ttl >= starts[-1]
    last = keyframes[-1]
    assert last.replace
    assert not last.action_units
    assert not last.jaw


@given(CUES)
def test_lips_close_in_time_and_stay_closed_until_they_have_met(
    spoken: list[tuple[str, float, float]],
) -> None:
    cues, end = cues_of([{"viseme": n, "duration": d, "weight": w} for n, d, w in spoken])
    starts = [ticks(keyframe.time) for keyframe in speech_keyframes(cues, end)[:-1]]
    own = [ticks(cue.time + LEAD - LEAD) for cue in cues]
    closing = [find_viseme(cue.viseme).closes for cue in cues]
    stays = ticks(CLOSING_FADE + STAYS_CLOSED)
    for place in range(len(cues)):
        if not closing[place]:
            continue
        assert starts[place] == max(own[place], starts[place - 1] + 1 if place else 0)
        opens = next((at for at in range(place + 1, len(cues)) if not closing[at]), None)
        if opens == place + 1:
            next_closing = [own[at] - at for at in range(opens, len(cues)) if closing[at]]
            hurried = any(time + opens < starts[place] + stays for time in next_closing)
            assert hurried or starts[opens] >= starts[place] + stays


def test_quick_speech_does_not_fall_behind_its_sound() -> None:
    cues, end = cues_of([{"viseme": n, "duration": 0.05} for n in ("PP", "aa") * 500])
    keyframes = speech_keyframes(cues, end)
    assert keyframes[-1].time == pytest.approx(end + LEAD)
    late = [ticks(k.time) - ticks(c.time) for k, c in zip(keyframes, cues, strict=False)]
    assert max(late) <= ticks(CLOSING_FADE + STAYS_CLOSED)


@pytest.mark.parametrize("vowel", ["aa", "E", "ou"])
@pytest.mark.parametrize("pace", [0.06, 0.08, 0.1])
def test_lips_meet_between_any_vowels_however_quick(vowel: str, pace: float) -> None:
    words = [vowel, *("PP", vowel) * 3]
    gaps = [gap(frame) for frame in said(words, pace)]
    for place in range(1, len(words), 2):
        heard = gaps[ticks(LEAD + place * pace) : ticks(LEAD + (place + 1) * pace) + 1]
        assert min(heard) < CLOSED_MM


def test_the_lower_lip_reaches_the_teeth_in_quick_speech(faces: dict[str, np.ndarray]) -> None:
    words = ["aa", *("FF", "aa") * 3]
    teeth = [to_teeth(frame) for frame in said(words, 0.08)]
    for place in range(1, len(words), 2):
        heard = teeth[ticks(LEAD + place * 0.08) : ticks(LEAD + (place + 1) * 0.08) + 1]
        assert min(heard) < 0.6 * to_teeth(faces["sil"])


@given(CUES)
def test_both_forms_say_the_same(spoken: list[tuple[str, float, float]]) -> None:
    entries = [{"viseme": n, "duration": d, "weight": w} for n, d, w in spoken]
    cues, _ = cues_of(entries)
    timed = [{"viseme": c.viseme, "time": c.time, "weight": c.weight} for c in cues]
    assert cues_of(timed)[0] == cues


@given(CUES, st.floats(0.02, 2.0))
def test_nothing_is_said_after_a_lease(spoken: list[tuple[str, float, float]], ttl: float) -> None:
    cues, end = cues_of([{"viseme": n, "duration": d, "weight": w} for n, d, w in spoken])
    for keyframe in speech_keyframes(cues, end, ttl=ttl):
        assert keyframe.time < ttl
        if keyframe.ttl is not None:
            assert keyframe.time + keyframe.ttl <= ttl + 1e-9


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ([], "0 visemes"),
        ([{"viseme": "aa"}], "give 'time'"),
        ([{"viseme": "aa", "time": 0.0}, {"viseme": "aa", "duration": 0.1}], "give 'time'"),
        ([{"viseme": "aa", "time": 0.0, "duration": 0.1}], "give 'time'"),
        ([{"viseme": "aa", "time": 1.0}, {"viseme": "PP", "time": 0.5}], "before the last"),
        ([{"viseme": "aa", "time": -1.0}], "time is -1.0"),
        ([{"viseme": "aa", "time": 0.0, "weight": 2.0}], "weight is 2"),
        ([{"viseme": "aa", "duration": 2000.0}] * 2, "lasts 4000 s"),
    ],
)
def test_a_speech_that_cannot_be_played_is_refused(entries: list[dict], said: str) -> None:
    with pytest.raises(InvalidTrack, match=said):
        cues_of(entries)
