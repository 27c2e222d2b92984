"""Emotions on the face: what tells them apart stands in their landmarks, and grows with them."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from engine import Keyframe
from engine.measure import (
    ALA,
    CHEEK,
    CORNER,
    INNER_BROW,
    LIP_BOTTOM,
    LIP_TOP,
    LOWER_LID,
    OUTER_BROW,
    UPPER_LID,
    UPPER_LIP,
    Face,
    settle,
)

INTENSITIES = (0.4, 0.7, 1.0)
EMOTIONS = ("happiness", "sadness", "fear", "anger", "surprise", "disgust", "contempt")


@pytest.fixture(scope="module")
def faces(standard_rig) -> dict[tuple[str, float], Face]:
    keys = [(name, intensity) for name in EMOTIONS for intensity in INTENSITIES]
    return dict(
        zip(keys, settle(standard_rig, [Keyframe(emotion=key) for key in keys]), strict=True)
    )


def up(face: Face, point: str) -> float:
    return float(face.u(point)[1])


def drawn_in(face: Face) -> float:
    """Return how far the inner brow went to the middle, mm."""
    return -float(face.u(INNER_BROW)[0])


def gap(face: Face) -> float:
    return face.distance(LIP_TOP, LIP_BOTTOM)


def corner_over_seam(face: Face) -> float:
    """Return how high the corner stands over the middle of the lips' line, mm."""
    return float(face.at(CORNER)[1] - (face.at(LIP_TOP)[1] + face.at(LIP_BOTTOM)[1]) / 2.0)


MARKS: dict[str, tuple[Callable[[Face], float], ...]] = {
    "happiness": (lambda f: up(f, CORNER), gap, lambda f: f.narrowing(), lambda f: up(f, CHEEK)),
    "sadness": (lambda f: up(f, INNER_BROW), lambda f: -up(f, CORNER), drawn_in),
    "fear": (lambda f: up(f, INNER_BROW), drawn_in, lambda f: up(f, UPPER_LID), gap),
    "anger": (lambda f: -up(f, INNER_BROW), drawn_in, lambda f: up(f, LOWER_LID)),
    "surprise": (lambda f: up(f, INNER_BROW), lambda f: up(f, OUTER_BROW), gap),
    "disgust": (lambda f: up(f, ALA), lambda f: up(f, UPPER_LIP)),
    "contempt": (lambda f: up(f, "M1_5.R"),),
}
"""What each is known by, rising."""


@pytest.mark.parametrize("name", EMOTIONS)
def test_an_emotion_grows_with_its_intensity(faces, name):
    for mark in MARKS[name]:
        weak, middling, full = (mark(faces[name, intensity]) for intensity in INTENSITIES)
        assert 0.0 < weak < middling < full
        assert 0.2 < weak / full < 0.65


def test_happiness_shows_teeth_and_narrows_the_eyes(faces):
    happy = faces["happiness", 1.0]
    assert gap(happy) > 6.5
    assert up(happy, UPPER_LIP) > 5.5
    assert up(happy, CORNER) > 6.0
    assert happy.narrowing() > 2.0


@pytest.mark.parametrize("intensity", INTENSITIES)
def test_anger_does_not_look_sad(faces, intensity):
    """It lowers and draws in the brow over open, tightened lids; the mouth's corners stay."""
    angry, sad = faces["anger", intensity], faces["sadness", intensity]
    assert up(angry, INNER_BROW) < -4.0 * intensity
    assert drawn_in(angry) > 1.8 * intensity
    assert up(angry, UPPER_LID) > 1.1 * intensity
    assert up(angry, LOWER_LID) > 1.5 * intensity
    assert corner_over_seam(angry) > -0.9
    assert corner_over_seam(sad) < corner_over_seam(angry) - 3.0 * intensity


def test_fear_is_not_surprise(faces):
    """Its brows are drawn together and raised less, in one line; its mouth is wide and flat."""
    afraid, surprised = faces["fear", 1.0], faces["surprise", 1.0]
    assert drawn_in(afraid) > 1.8 > 0.0 > drawn_in(surprised)
    assert abs(up(afraid, INNER_BROW) - up(afraid, OUTER_BROW)) < 1.0
    assert up(surprised, INNER_BROW) > up(afraid, INNER_BROW) + 3.0
    assert float(afraid.u(CORNER)[0]) > 3.0 > -1.0 > float(surprised.u(CORNER)[0])
    assert gap(surprised) > gap(afraid) + 8.0


def test_disgust_is_not_anger(faces):
    disgusted, angry = faces["disgust", 1.0], faces["anger", 1.0]
    assert up(disgusted, ALA) > 5.0 > 0.0 > up(angry, ALA)
    assert up(disgusted, INNER_BROW) > up(angry, INNER_BROW) + 3.0
    assert up(disgusted, UPPER_LIP) > 4.0
    assert disgusted.narrowing() > 1.0 > angry.narrowing()
