"""The parts: well-formed, where they belong, and riding what they should."""

from __future__ import annotations

import numpy as np
import pytest

from engine.head import Head, Part
from engine.head.hairline import HIDDEN_SCALP

FOLLOWERS = {"skull", "jaw", "eye.L", "eye.R", "skin"}
MATERIALS = {"skin", "eye", "cornea", "wet", "teeth", "hair"}
BOTH = ("high", "paper")


def part(head: Head, name: str) -> Part:
    """Return the part called `name`."""
    return next(candidate for candidate in head.parts if candidate.name == name)


@pytest.mark.parametrize("which", BOTH)
def test_well_formed(heads: dict[str, Head], which: str) -> None:
    head = heads[which]
    names = [piece.name for piece in head.parts]
    assert len(set(names)) == len(names)
    for piece in head.parts:
        count = len(piece.vertices)
        assert piece.vertices.shape == piece.normals.shape == piece.colors.shape == (count, 3)
        assert np.isfinite(piece.vertices).all()
        np.testing.assert_allclose(np.linalg.norm(piece.normals, axis=1), 1, atol=1e-9)
        assert 0 <= piece.colors.min() <= piece.colors.max() <= 1
        assert piece.triangles.min() >= 0
        assert piece.triangles.max() < count
        assert piece.follows in FOLLOWERS
        assert piece.material in MATERIALS
        assert (piece.roots is not None) == (piece.follows == "skin")


def test_nothing_is_missing(head: Head) -> None:
    sided = {f"{name}.{side}" for name in ("eye", "cornea", "caruncle") for side in "LR"}
    jaws = {f"{name}.{jaw}" for name in ("teeth", "gum") for jaw in ("upper", "lower")}
    present = {piece.name for piece in head.parts}
    assert present == sided | jaws | {
        "palate",
        "mouth_floor",
        "tongue",
        "tear_line",
        "brows",
        "lashes",
        "hair",
        "hairline",
        "flyaways",
        "baby_hairs",
    }


@pytest.mark.parametrize("name", ["eye", "cornea", "caruncle"])
def test_sides_mirror(head: Head, name: str) -> None:
    left, right = part(head, f"{name}.L"), part(head, f"{name}.R")
    low, high = left.vertices.min(axis=0), left.vertices.max(axis=0)
    np.testing.assert_allclose(right.vertices[:, 0].min(), -high[0], atol=1e-9)
    np.testing.assert_allclose(right.vertices[:, 0].max(), -low[0], atol=1e-9)
    assert left.vertices[:, 0].mean() > 0


@pytest.mark.parametrize("name", ["eye.L", "cornea.R", "teeth.upper", "gum.lower", "tongue"])
def test_triangles_face_outwards(head: Head, name: str) -> None:
    piece = part(head, name)
    a, b, c = (piece.vertices[piece.triangles[:, corner]] for corner in range(3))
    area = np.cross(b - a, c - a)
    mean_normal = piece.normals[piece.triangles].mean(axis=1)
    agree = (area * mean_normal).sum(axis=1) > 0
    assert agree.mean() > 0.97
    outward = ((a - piece.vertices.mean(axis=0)) * area).sum()
    assert outward > 0


def test_eyes_fill_their_balls(head: Head) -> None:
    for side, eye in zip("LR", head.eyes, strict=True):
        ball = part(head, f"eye.{side}").vertices - eye.center
        assert np.linalg.norm(ball, axis=1).max() == pytest.approx(eye.radius, abs=1e-9)
        cornea = part(head, f"cornea.{side}").vertices - eye.center
        assert np.linalg.norm(cornea, axis=1).max() < eye.radius + 1.35


def test_eye_shows_between_the_lids(head: Head) -> None:
    """The pupil lies between the lids and the iris is cut a little by the upper one."""
    upper, lower = (head.drawn.vertices[head.landmarks[name]] for name in ("ps.L", "pi.L"))
    assert lower[1] + 2 < head.eyes[0].center[1] < upper[1] - 2
    assert upper[1] - head.eyes[0].center[1] < 5.85


def test_teeth_stay_behind_closed_lips(head: Head) -> None:
    lips = np.array([head.points[head.point(name)] for name in ("M0_0", "M0_2.L", "M0_4.L")])
    teeth = part(head, "teeth.upper").vertices
    for x, _, z in lips:
        near = np.abs(teeth[:, 0] - x) < 3
        assert teeth[near, 2].max() < z - 2


def test_jaw_carries_the_lower_teeth(head: Head) -> None:
    by_follower = {piece.name: piece.follows for piece in head.parts}
    for name in ("teeth.lower", "gum.lower", "tongue"):
        assert by_follower[name] == "jaw"
    assert by_follower["teeth.upper"] == "skull"


@pytest.mark.parametrize("name", ["brows", "lashes"])
def test_strands_ride_the_skin_under_them(head: Head, name: str) -> None:
    piece = part(head, name)
    assert piece.roots is not None
    away = np.linalg.norm(piece.vertices - head.drawn.vertices[piece.roots], axis=1)
    assert away.max() < 30
    assert np.percentile(away, 10) < 3


def test_brows_lie_over_the_eyes(head: Head) -> None:
    brows = part(head, "brows").vertices
    assert brows[:, 1].min() > 10
    assert brows[:, 1].max() < 32
    assert (brows[:, 0] > 0).mean() == pytest.approx(0.5, abs=0.05)


def test_paper_has_a_back_to_its_mask(heads: dict[str, Head]) -> None:
    back = part(heads["paper"], "scalp")
    assert back.follows == "skull"
    assert back.vertices[:, 2].min() < -90
    assert back.hair is not None
    # One vertex over the temple lies in the fade of the hairline: 0.876.
    assert back.hair[back.vertices[:, 1] > 60].min() > 0.87
    np.testing.assert_allclose(back.hair[back.vertices[:, 1] > 90], HIDDEN_SCALP)
    assert len(back.triangles) + len(heads["paper"].triangles) == 3_516
