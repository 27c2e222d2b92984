"""What the skin of a head may not pass: lips, teeth, eyeballs; and the lids' tarsal plates."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..compiling import kernel
from ..dynamics import Contacts, IndexArray
from ..head import Head

LIP_GAP_MM = 0.12
"""Height that is left between closed lips, or their rest gap where that is less."""
LIP_RING = 10
"""Points of a half mouth ring run from 0, upper middle, over 5, the corner, to 10, lower."""
CORNER = 5
TOOTH_CLEARANCE_MM = {"M0": 3.0, "M1": 5.5, "M2": 5.0, "M3": 4.0}
"""Skin before the upper dental arch, by mouth ring: the flesh of the lip lies between."""
TOOTH_MARGIN_MM = 0.3
TOOTH_REACH_MM = 26.0
ARCH_BOTTOM_MM = -75.0
"""Lower edge of the upper teeth; lips may fall back below it."""
ARCH_FALL = 0.8
ARCH_HALF_WIDTH_MM = 28.0
"""Half width of the upper dental arch; the cheek beside it touches no teeth."""
EYE_CLEARANCE_MM = {"E0": 12.45, "E1": 12.75, "E2": 14.4, "E3": 14.2}
"""Least distance from the eye's centre, by lid ring: ball, cornea and the lid's own thickness."""
LID_SHARE = {"EB": 1.0, "E0": 1.0, "E1": 1.0, "E2": 0.5}
"""Share of the lid's angle that each ring's skull side turns by."""
TARSAL_RINGS = ("E0", "E1")
"""Rings that are cartilage: moved with the lid, not by forces."""
CANTHAL_HOLD = {1: 0.62, 6: 0.91, 7: 0.76}
"""Greatest turn, as a share of the middle's, by the spokes next to the canthi: farther, the skin
folds over its joined end."""
SKIN_RING = "E3"
SKIN_SPOKES = range(2, 7)
"""Skin of the upper lid whose way about the eye is the lid skin's; the lower lid's lies below."""
LID_SPOKES = 16
"""Points of an eye ring run from 0, inner canthus, over 4, top, and 8, outer canthus, to 12."""


@dataclass(frozen=True, eq=False)
class Lids:
    """The nodes that turn with the lids.

    Attributes:
        nodes: Epidermis nodes, shape (k,).
        channel: Which angle: 0 left upper, 1 left lower, 2 right upper, 3 right lower, shape (k,).
        share: Turn about the eye's x axis per degree of lid angle, signed, shape (k,).
        centers: Eye centre of each, mm, shape (k, 3).
        tarsal: Nodes that are moved, all three layers, shape (k,).
        skin: Nodes of the skin that pushes the lids, shape (s,).
        skin_channel: Which angle each belongs to, shape (s,).
        skin_place: Their place from the eye's centre at rest, y and z, mm, shape (2, s).
        skin_center: The eye's centre, y and z, mm, shape (2, s).
        opening: Angle between the lids of the left and the right eye at rest, degrees, shape (2,).
    """

    nodes: IntArray
    channel: IntArray
    share: FloatArray
    centers: FloatArray
    tarsal: BoolArray
    skin: IntArray
    skin_channel: IntArray
    skin_place: FloatArray
    skin_center: FloatArray
    opening: FloatArray

    def skin_angles(self, x: FloatArray) -> FloatArray:
        """Return how far the skin around each lid has gone about the eye, degrees, shape (4,).

        Signed as the lids' angles are: positive where the skin would close the eye.

        Args:
            x: Positions of the nodes, mm, shape (3, nodes).
        """
        y, z = x[1:, self.skin] - self.skin_center
        return skin_angles(self.skin_channel, self.skin_place, y, z)


@kernel
def skin_angles(channel: IntArray, place: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    """Return how far the skin around each lid has gone about the eye, degrees, shape (4,).

    Args:
        channel: `Lids.skin_channel`.
        place: `Lids.skin_place`.
        y: How far above the eye's centre each node is now, mm, shape (s,).
        z: How far before it, mm, shape (s,).
    """
    angles, count = np.zeros(4), np.zeros(4)
    for k in range(channel.shape[0]):
        y0, z0 = place[0, k], place[1, k]
        turned = math.degrees(math.atan2(y[k] * z0 - z[k] * y0, y[k] * y0 + z[k] * z0))
        angles[channel[k]] += -turned if channel[k] % 2 == 0 else turned
        count[channel[k]] += 1.0
    for lid in range(4):
        angles[lid] /= max(count[lid], 1.0)
    return angles


def ring_and_spoke(name: str) -> tuple[str, int, str]:
    """Return ("E1", 4, "L") for the cage point "E1_4.L"; ("", -1, "") for a point without name."""
    stem, _, side = name.partition(".")
    ring, _, spoke = stem.partition("_")
    return (ring, int(spoke), side) if spoke.isdigit() else (ring, -1, side)


def lids_of(head: Head) -> Lids:
    """Return the lid nodes of `head`; none where it has no eyes."""
    nodes, channel, share, centers, tarsal = [], [], [], [], []
    fissure, opening = _fissure(head)
    for node, name in enumerate(head.names[: head.sheet_count]):
        ring, spoke, side = ring_and_spoke(name)
        if ring not in LID_SHARE or not head.eyes:
            continue
        upper = 0 < spoke < LID_SPOKES // 2
        bend = fissure[side][spoke if upper else LID_SPOKES - spoke]
        nodes.append(node)
        channel.append((0 if upper else 1) + (2 if side == "R" else 0))
        share.append(LID_SHARE[ring] * bend * (1.0 if upper else -1.0))
        centers.append(head.eyes[1 if side == "R" else 0].center)
        tarsal.append(ring in TARSAL_RINGS)
    return Lids(
        np.array(nodes, dtype=np.int64),
        np.array(channel, dtype=np.int64),
        np.array(share),
        np.array(centers).reshape(-1, 3),
        np.array(tarsal, dtype=bool),
        *_pushing_skin(head),
        np.array([opening.get(side, math.inf) for side in "LR"]),
    )


def _pushing_skin(head: Head) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Return nodes that push lids, the angle each pushes, their places and the eyes' centres."""
    nodes, channel, centers = [], [], []
    for node, name in enumerate(head.names[: head.sheet_count]):
        ring, spoke, side = ring_and_spoke(name)
        upper = spoke in SKIN_SPOKES
        if ring != SKIN_RING or not head.eyes or not (upper or LID_SPOKES - spoke in SKIN_SPOKES):
            continue
        nodes.append(node)
        channel.append((0 if upper else 1) + (2 if side == "R" else 0))
        centers.append(head.eyes[1 if side == "R" else 0].center[1:])
    index = np.array(nodes, dtype=np.int64)
    center = np.array(centers).reshape(-1, 2).T
    return index, np.array(channel, dtype=np.int64), head.points[index, 1:].T - center, center


def _fissure(head: Head) -> tuple[dict[str, FloatArray], dict[str, float]]:
    """Return by side the opening at each spoke and that in the middle, degrees.

    The former is a share of the latter, shape (17,).

    Lids that turn in this proportion meet along their whole length at once; at the canthi, where
    they are joined, they do not turn.
    """
    index = {name: node for node, name in enumerate(head.names) if name}
    openings, middles = {}, {}
    for side, eye in zip("LR", head.eyes, strict=False):
        opening = np.zeros(LID_SPOKES + 1)
        for spoke in range(1, LID_SPOKES // 2):
            ends = (f"E1_{spoke}.{side}", f"E1_{LID_SPOKES - spoke}.{side}")
            above, below = (head.points[index[end]] - eye.center for end in ends)
            opening[spoke] = math.atan2(above[1], above[2]) - math.atan2(below[1], below[2])
        middle = opening[LID_SPOKES // 4]
        share = opening / max(middle, 1e-9)
        for spoke, most in CANTHAL_HOLD.items():
            share[spoke] = min(share[spoke], most)
        openings[side], middles[side] = share, math.degrees(middle)
    return openings, middles


def contacts_of(head: Head) -> Contacts:
    """Return the contact pairs and surfaces of `head`; empty where it has no named points."""
    index = {name: node for node, name in enumerate(head.names[: head.sheet_count]) if name}
    upper, lower = _lip_pairs(index)
    points = head.points
    tooth_nodes, tooth_clearance = _teeth(head)
    eye_nodes, eye_centers, eye_radius = _eyes(head)
    return Contacts(
        upper_lip=upper,
        lower_lip=lower,
        lip_gap=np.minimum(LIP_GAP_MM, points[upper, 1] - points[lower, 1]),
        tooth_nodes=tooth_nodes,
        tooth_clearance=tooth_clearance,
        arch=dental_arch(np.arange(ARCH_HALF_WIDTH_MM)) + head.teeth[2],
        arch_bottom=ARCH_BOTTOM_MM + float(head.teeth[1]),
        arch_fall=ARCH_FALL,
        eye_nodes=eye_nodes,
        eye_centers=np.ascontiguousarray(eye_centers.T),
        eye_radius=eye_radius,
    )


def dental_arch(lateral: FloatArray) -> FloatArray:
    """Return the depth z, mm, of the upper dental arch's front at |x| = `lateral`, mm."""
    t = 2.0 / math.pi * np.arcsin(np.minimum(lateral / 29.0, 0.999))
    return np.asarray(94.9 - 44.0 * t**2.1)


def _lip_pairs(index: dict[str, int]) -> tuple[IndexArray, IndexArray]:
    pairs: list[tuple[int, int]] = []
    for j in range(CORNER):
        for side in ("",) if j == 0 else (".L", ".R"):
            upper, lower = index.get(f"M0_{j}{side}"), index.get(f"M0_{LIP_RING - j}{side}")
            if upper is not None and lower is not None:
                pairs.append((upper, lower))
    array = np.array(pairs, dtype=np.int32).reshape(-1, 2)
    return np.ascontiguousarray(array[:, 0]), np.ascontiguousarray(array[:, 1])


def _teeth(head: Head) -> tuple[IndexArray, FloatArray]:
    nodes, clearance = [], []
    for node, name in enumerate(head.names[: head.sheet_count]):
        ring, spoke, _ = ring_and_spoke(name)
        x, _, z = head.points[node]
        if ring in TOOTH_CLEARANCE_MM and spoke >= 0 and abs(x) < TOOTH_REACH_MM:
            arch = float(dental_arch(np.array([abs(x)]))[0]) + float(head.teeth[2])
            at_rest = z - arch - TOOTH_MARGIN_MM
            nodes.append(node)
            clearance.append(min(TOOTH_CLEARANCE_MM[ring], at_rest))
    return np.array(nodes, dtype=np.int32), np.array(clearance)


def _eyes(head: Head) -> tuple[IndexArray, FloatArray, FloatArray]:
    nodes, centers, radius = [], [], []
    for node, name in enumerate(head.names[: head.sheet_count]):
        ring, spoke, side = ring_and_spoke(name)
        if ring in EYE_CLEARANCE_MM and spoke >= 0 and head.eyes:
            center = head.eyes[1 if side == "R" else 0].center
            nodes.append(node)
            centers.append(center)
            at_rest = float(np.linalg.norm(head.points[node] - center))
            radius.append(min(EYE_CLEARANCE_MM[ring], at_rest))
    return np.array(nodes, dtype=np.int32), np.array(centers).reshape(-1, 3), np.array(radius)
