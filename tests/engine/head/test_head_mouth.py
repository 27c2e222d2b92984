"""The mouth: teeth of human size in a row, gums round them, palate, floor and tongue inside."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from engine.head import Head, Part
from engine.head.parts.teeth import CHEEK_HEIGHTS, CROWN_POINTS, FRONT_HEIGHTS, LOWER, UPPER, Arch

TRIANGLES_OF_THE_MOUTH = 14_000
PIECES = (
    "teeth.upper",
    "teeth.lower",
    "gum.upper",
    "gum.lower",
    "palate",
    "mouth_floor",
    "tongue",
)


def part(head: Head, name: str) -> Part:
    """Return the part called `name`."""
    return next(candidate for candidate in head.parts if candidate.name == name)


def crowns(head: Head, arch: Arch) -> list[np.ndarray]:
    """Return the left crowns' vertices from the midline back."""
    vertices = part(head, f"teeth.{arch.jaw}").vertices
    found, start = [], 0
    for tooth in arch.teeth:
        count = CROWN_POINTS * len(FRONT_HEIGHTS if tooth.is_front else CHEEK_HEIGHTS)
        found.append(vertices[start : start + count])
        start += 2 * count
    assert start == len(vertices)
    return found


def test_the_mouth_is_within_its_budget(head: Head) -> None:
    assert sum(len(part(head, name).triangles) for name in PIECES) <= TRIANGLES_OF_THE_MOUTH


@pytest.mark.parametrize("arch", [UPPER, LOWER], ids=lambda arch: arch.jaw)
def test_front_crowns_have_the_size_of_their_kind(head: Head, arch: Arch) -> None:
    for tooth, vertices in zip(arch.teeth[:3], crowns(head, arch), strict=False):
        across = np.hypot(*np.ptp(vertices[:, [0, 2]], axis=0))
        assert tooth.width * 0.9 < across < np.hypot(tooth.width, tooth.thickness) * 1.15
        assert np.ptp(vertices[:, 1]) == pytest.approx(tooth.height * 1.2, rel=0.1)


@pytest.mark.parametrize("name", ["teeth.upper", "teeth.lower", "gum.upper", "gum.lower", "tongue"])
def test_closed_but_for_points_and_ends(head: Head, name: str) -> None:
    """Every edge has two sides, but for the rims inside the gum and at its ends."""
    piece = part(head, name)
    _, place = np.unique(np.round(piece.vertices, 6), axis=0, return_inverse=True)
    corners = place.reshape(-1)[piece.triangles]
    edges = np.sort(np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    sides = Counter(Counter(map(tuple, edges.tolist())).values())
    assert sides[2] > 0.9 * sum(sides.values())


def test_upper_front_teeth_stand_before_the_lower_ones(head: Head) -> None:
    upper, lower = part(head, "teeth.upper").vertices, part(head, "teeth.lower").vertices
    front = [teeth[np.abs(teeth[:, 0]) < 4] for teeth in (upper, lower)]
    overbite = front[1][:, 1].max() - front[0][:, 1].min()
    overjet = front[0][:, 2].max() - front[1][:, 2].max()
    assert 1.5 < overbite < 3.5
    assert 1.5 < overjet < 4.5


def test_the_tongue_lies_within_the_lower_arch(head: Head) -> None:
    tongue, teeth = part(head, "tongue").vertices, part(head, "teeth.lower").vertices
    assert tongue[:, 2].max() < teeth[:, 2].max() - 4
    assert np.abs(tongue[:, 0]).max() < np.abs(teeth[:, 0]).max() - 4
    palate = part(head, "palate").vertices
    for z in (60, 70, 80):
        near = [np.abs(piece[:, 2] - z) < 4 for piece in (tongue, palate)]
        assert tongue[near[0]][:, 1].max() < palate[near[1]][:, 1].max() - 2


def test_gums_hold_the_necks(head: Head) -> None:
    """The gum's edge lies on the crowns: nowhere far from the teeth, nowhere over the edges."""
    for jaw, up in (("upper", 1), ("lower", -1)):
        teeth, gum = part(head, f"teeth.{jaw}").vertices, part(head, f"gum.{jaw}").vertices
        edge = (up * teeth[:, 1]).min()
        assert (up * gum[:, 1]).min() > edge + 2.5
        assert (up * gum[:, 1]).max() > (up * teeth[:, 1]).max()


def test_light_fades_towards_the_throat(head: Head) -> None:
    for name in ("palate", "tongue"):
        piece = part(head, name)
        depth = piece.vertices[:, 2]
        light = piece.colors.mean(axis=1)
        assert light[depth > 78].mean() > 2.5 * light[depth < 52].mean()
