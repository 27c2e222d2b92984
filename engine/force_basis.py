"""What each muscle does to each node at full activation, in the two declared force modes.

Mode "rest": weights and directions are taken once, at rest, and a muscle's force is its row of a
constant basis times its activation. Mode "current": both are recomputed as the skin moves, the
literal reading of the paper. They differ by up to 10 mm at full AU4, so a session chooses one.
Air and bellies press along the rest pose's normals in both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .arrays import FloatArray
from .dynamics import Pull
from .head import Head
from .head.anatomy import smoothstep
from .head.geometry import vertex_normals
from .jaw import JawHinge
from .muscle import (
    MIDLINE_BLEND_MM,
    RING_PEAK,
    SHEET_TAPER,
    SPHINCTER_REACH_MM,
    AirPressure,
    LidMuscle,
    LinearMuscle,
    Muscle,
    SheetMuscle,
    SphincterMuscle,
    gain_at,
    mirrored,
)
from .tissue import TissueModel

PACKED = 21
"""Numbers that hold one muscle's geometry in the kernel of mode "current"."""

FLIP = np.array([-1.0, 1.0, 1.0])
"""To the other side of the face."""
LID_EDGE = (0.35, 0.6)
"""Radius, as a share of the orbital ellipse, over which the lids end and the cheek begins."""


@dataclass(frozen=True, eq=False)
class Samples:
    """Places where muscles are evaluated.

    Attributes:
        points, normals: mm and unit, shape (k, 3).
        jaw: Jaw weight, shape (k,): 0 above the lip slit, 1 below.
    """

    points: FloatArray
    normals: FloatArray
    jaw: FloatArray


def whole_pull(head: Head, muscles: Sequence[Muscle]) -> FloatArray:
    """Return how much of `head`'s loose skin each muscle pulls on, weighted, mm², shape (m,).

    Lid muscles, which turn lids instead of pulling skin, have 1.
    """
    n = head.sheet_count
    points = head.points[:n]
    triangles = head.triangles[(head.triangles < n).all(axis=1)]
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    share = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6.0
    area = np.bincount(triangles.ravel(), np.repeat(share, 3), minlength=n)
    area[head.fixed] = 0.0
    samples = Samples(points, vertex_normals(points, triangles), head.jaw_weight[:n])
    pulls = np.ones(len(muscles))
    for row, muscle in enumerate(muscles):
        if not isinstance(muscle, LidMuscle):
            force = force_density(muscle, samples, ring="ring")
            if isinstance(muscle, AirPressure):
                force = press_density(muscle, samples)
            pulls[row] = np.linalg.norm(force, axis=1) @ area
    return pulls


def force_density(muscle: Muscle, samples: Samples, *, ring: str) -> FloatArray:
    """Return weight times direction of `muscle`'s pull at `samples`, shape (k, 3).

    Right muscles are evaluated as the left one on mirrored points, so that both sides agree to the
    last bit.
    """
    left, samples = _as_left(muscle, samples)
    points = samples.points
    assert not isinstance(left, LidMuscle)
    if isinstance(left, AirPressure):
        return np.zeros_like(points)
    if isinstance(left, SphincterMuscle):
        weight = left.weights(points, profile=ring)
    else:
        weight = left.weights(points)
    weight = weight * share_of(left, points, samples.jaw)
    direction = _along_skin(left, left.directions(points), samples.normals)
    force = weight[:, None] * direction
    return force * FLIP if left is not muscle else force


def press_density(muscle: Muscle, samples: Samples) -> FloatArray:
    """Return what `muscle` presses along the normals at `samples`, shape (k, 3).

    Air does nothing else; a belly lifts what lies over it, thicker as it shortens.
    """
    left, samples = _as_left(muscle, samples)
    points = samples.points
    if isinstance(left, AirPressure):
        pressure = left.weights(points)
    elif isinstance(left, LinearMuscle | SphincterMuscle) and left.bulge > 0.0:
        pressure = left.bulge * left.belly(points)
    else:
        return np.zeros_like(points)
    pressed = (pressure * share_of(left, points, samples.jaw))[:, None] * samples.normals
    return pressed * FLIP if left is not muscle else pressed


def _as_left(muscle: Muscle, samples: Samples) -> tuple[Muscle, Samples]:
    """Return a right muscle as the left one, on samples mirrored; any other as it is."""
    if not muscle.name.endswith(".R"):
        return muscle, samples
    flipped = replace(samples, points=samples.points * FLIP, normals=samples.normals * FLIP)
    return mirrored(muscle), flipped


def share_of(muscle: Muscle, points: FloatArray, jaw: FloatArray) -> FloatArray:
    """Return the part of its own weight that a left or midline muscle has at `points`, shape (k,).

    Paired muscles share the midline; levators act on the upper side of the lip slit, depressors on
    the lower; the cheek-raising part of the orbital ring is its lower lateral sector.
    """
    share = np.ones(len(points))
    if "." in muscle.name:
        share *= smoothstep(-MIDLINE_BLEND_MM, MIDLINE_BLEND_MM, points[:, 0])
    if isinstance(muscle, SphincterMuscle) and muscle.sector == "lower_lateral":
        # Whole, the ring also pulls the brow down and AU6 frowns.
        share *= 1.0 - 0.88 * smoothstep(-2.0, 8.0, points[:, 1])
        share *= 0.15 + 0.85 * smoothstep(12.0, 26.0, points[:, 0])
        # The orbital part lies outside the lids; pulling on them too made AU6 bistable.
        share *= smoothstep(*LID_EDGE, muscle.radius_at(points))
    acts_on = "skin" if isinstance(muscle, LidMuscle) else muscle.acts_on
    if acts_on == "upper_lip":
        share *= 1.0 - jaw
    elif acts_on == "lower_lip":
        share *= jaw
    return share


def moving_pull(head: Head, tissue: TissueModel, muscles: Sequence[Muscle], *, ring: str) -> Pull:
    """Return the muscles for mode "current", `scale` holding the force scales at activation 1."""
    n = tissue.node_count
    points, jaw = tissue.sheet.points, head.jaw_weight[:n]
    kinds, shapes, scales, shares = [], [], [], []
    for muscle in muscles:
        if isinstance(muscle, LidMuscle | AirPressure):
            kinds.append(0)
            shapes.append(np.zeros(PACKED))
            scales.append(0.0)
            shares.append(np.zeros(n))
            continue
        right = muscle.name.endswith(".R")
        here = points * np.array([-1.0, 1.0, 1.0]) if right else points
        share = share_of(mirrored(muscle) if right else muscle, here, jaw) * tissue.scale
        share *= tissue.parameters.muscle_strength * gain_at(muscle, points[:, 0])
        share[tissue.held] = 0.0
        kinds.append({"linear": 0, "sphincter": 1, "sheet": 2}[muscle.kind])
        shapes.append(packed_shape(muscle, ring=ring))
        scales.append(muscle.force_scale)
        shares.append(share)
    return Pull(np.array(kinds, np.int32), np.array(shapes), np.array(scales), np.array(shares))


def jaw_rides(head: Head, muscles: Sequence[Muscle]) -> FloatArray:
    """Return the share of the jaw that each muscle's attachment and insertion turn by, (m, 2).

    A linear muscle's ends ride as the skin nearest to them; a sphincter as the mean of the skin
    that it rings; a sheet does not ride.
    """
    points, weight = head.points[: head.sheet_count], head.jaw_weight[: head.sheet_count]
    rides = np.zeros((len(muscles), 2))
    for row, muscle in enumerate(muscles):
        if isinstance(muscle, LinearMuscle):
            for column, end in enumerate((muscle.attachment, muscle.insertion)):
                nearest = np.linalg.norm(points - np.array(end), axis=1).argmin()
                rides[row, column] = weight[nearest]
        elif isinstance(muscle, SphincterMuscle):
            ringed = muscle.weights(points, profile="literal") > 0.0
            rides[row] = weight[ringed].mean() if ringed.any() else 0.0
    return rides


def ride_jaw(
    pull: Pull, rides: FloatArray, hinge: JawHinge, jaw: tuple[float, float, float]
) -> Pull:
    """Return the muscles of mode "current" with their ends carried along by the open jaw.

    Left on the skull, a muscle of the mandible would pull the lowered lip back up to where its
    attachment was. A muscle that lengthens keeps its δ.

    Args:
        pull: With the jaw closed.
        rides: From `jaw_rides`, the same rows.
        hinge: The rig's.
        jaw: Pitch and yaw, degrees, thrust, mm.
    """
    shape = pull.shape.copy()
    linear = (pull.kinds == 0) & (shape[:, 6] > 0.0)
    g, share = shape[linear], rides[linear]
    attachment = hinge.move(g[:, 0:3], share[:, 0], *jaw)
    insertion = hinge.move(g[:, 0:3] + g[:, 3:6] * g[:, 6:7], share[:, 1], *jaw)
    fibre = insertion - attachment
    length = np.maximum(np.linalg.norm(fibre, axis=1, keepdims=True), 1e-9)
    g[:, 0:3], g[:, 3:6], g[:, 6:7] = attachment, fibre / length, length
    shape[linear] = g
    ring = pull.kinds == 1
    g, mean = shape[ring], rides[ring, 0]
    for point in (slice(0, 3), slice(9, 12)):
        g[:, point] = hinge.move(g[:, point], mean, *jaw)
    for axis in (slice(3, 6), slice(6, 9), slice(16, 19)):
        g[:, axis] = hinge.turn(g[:, axis], mean, *jaw[:2])
    shape[ring] = g
    return pull._replace(shape=shape)


def packed_shape(muscle: Muscle, *, ring: str) -> FloatArray:
    """Return a muscle's geometry as the kernel reads it, shape (21,).

    Linear: attachment (0-2), unit fibre (3-5), length 6, angle 7 (radians), δ 8, η 9.
    Sphincter: plane point (0-2), e_x (3-5), e_y (6-8), epicentre (9-11), a 12, b 13,
    literal 14, ring peak 15, normal (16-18), reach across the plane 19, hoop 20. Sheet: middle of
    the attachment line (0-2), pull (3-5), length 6, δ 7, η 8, lateral unit (9-11), half of the
    width W 12, tapered share 13, whether its inner side has no edge 14.
    """
    g = np.zeros(PACKED)
    if isinstance(muscle, LinearMuscle):
        attachment, insertion = np.array(muscle.attachment), np.array(muscle.insertion)
        length = math.dist(muscle.attachment, muscle.insertion)
        g[0:3], g[3:6] = attachment, (insertion - attachment) / length
        g[6:10] = length, math.radians(muscle.angle), muscle.radius / length, muscle.strength
    elif isinstance(muscle, SphincterMuscle):
        normal = np.array(muscle.normal) / math.sqrt(sum(c * c for c in muscle.normal))
        e_x = np.array([1.0, 0.0, 0.0]) - normal * normal[0]
        e_x /= math.sqrt(e_x @ e_x)
        g[0:3], g[3:6], g[6:9] = muscle.plane, e_x, np.cross(normal, e_x)
        g[9:12] = muscle.center
        g[12:16] = muscle.semi_major, muscle.semi_minor, float(ring == "literal"), RING_PEAK
        g[16:19], g[19:21] = normal, (SPHINCTER_REACH_MM, muscle.hoop)
    elif isinstance(muscle, SheetMuscle):
        middle, pull, length, line, width = muscle.frame()
        g[0:3], g[3:6], g[9:12] = middle, pull, line
        g[6:9] = length, muscle.radius / length, muscle.strength
        g[12:15] = width / 2.0, SHEET_TAPER, float(muscle.open_inwards)
    return g


def _along_skin(muscle: Muscle, direction: FloatArray, normals: FloatArray) -> FloatArray:
    """Return directions without what would press the skin into the bone.

    Linear muscles lose their inward part, sheets and the orbital ring their whole normal part;
    the ring of the mouth keeps it, to pout. Attachments lie deeper than the skin they pull, and
    forces into the bone only strain the layers.
    """
    if isinstance(muscle, SphincterMuscle) and not muscle.tangential:
        return direction
    across = (direction * normals).sum(axis=1, keepdims=True)
    if isinstance(muscle, LinearMuscle):
        across = np.minimum(across, 0.0)
    direction = direction - across * normals
    norm = np.linalg.norm(direction, axis=1, keepdims=True)
    return np.asarray(direction / np.maximum(norm, 1e-9))
