"""The skull side of sixteen faces at the end of a tick, and what pulls at them in it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import Float32Array, FloatArray, IntArray
from ..compiling import brief
from ..dynamics import IndexArray
from ..jaw import JawHinge
from ..lids import stand_lids
from ..tissue import TissueModel
from ..tissue.contact import skin_angles
from .network import COLUMN, NODE, Order
from .sweep import Faces
from .vector import WIDTH, Lanes, load, part, sine_cosine, splat, store

F = np.float32
Y, Z = WIDTH, 2 * WIDTH
RADIAN = np.pi / 180.0


class Posing(NamedTuple):
    """What jaw, lids and muscles do to each column, in the order of `order_columns`.

    Attributes:
        rest: Nodes at rest, mm, shape (9 columns,).
        bone, normals: Foot of the fat and skull's normal at rest, shape (3 columns,).
        dead: Dead load of each node, shape (9 columns,).
        share: Of the jaw's pose that each column takes.
        center: Of the jaw's hinge, mm, shape (3,).
        lid: Which lid each column turns with, -1 for none: 0 left upper, 1 left lower, 2 and 3.
        lid_share, lid_center: How much of its angle, and about what y and z, mm, (2 columns,).
        tarsal: Which columns are part of a lid's plate.
        held: Offset of the columns that are moved and not simulated, in order.
        grip: How the layers share a muscle's force, shape (3 columns,).
        start: First entry of each column in the list of what muscles pull it, and the end.
        muscle: Of each entry.
        force: Of each entry at activation 1, shape (3 entries,).
    """

    rest: Float32Array
    bone: Float32Array
    normals: Float32Array
    dead: Float32Array
    share: Float32Array
    center: Float32Array
    lid: IndexArray
    lid_share: Float32Array
    lid_center: Float32Array
    tarsal: IndexArray
    held: IndexArray
    grip: Float32Array
    start: IndexArray
    muscle: IndexArray
    force: Float32Array


class Lidding(NamedTuple):
    """What the lids follow.

    Attributes:
        turns: Turn of upper and lower lid at activation 1, degrees, shape (muscles, 2, 2).
        pitch: Which channel is the gaze's.
        skin: Offsets of the nodes of skin that push the lids, shape (s,).
        channel, place, center: As in `tissue.contact.Lids`.
        shares: κ of upper and lower lid, shape (2,).
        opening: Of the eyes at rest, degrees, shape (2,).
    """

    turns: FloatArray
    pitch: int
    skin: IndexArray
    channel: IntArray
    place: FloatArray
    center: FloatArray
    shares: FloatArray
    opening: FloatArray


def posing_of(
    tissue: TissueModel, jaw: JawHinge, jaw_weight: FloatArray, basis: FloatArray, order: Order
) -> Posing:
    """Return what moves the columns.

    Args:
        tissue: The rig's.
        jaw: Its hinge.
        jaw_weight: Share of each column, shape (n,).
        basis: Muscles' forces at activation 1, shape (m, 3, n).
        order: Of the columns.
    """
    n, columns, lids = tissue.node_count, order.columns, tissue.lids
    lid, lid_share = np.full(n, -1), np.zeros(n)
    center, tarsal = np.zeros((n, 2)), np.zeros(n, np.int64)
    lid[lids.nodes], lid_share[lids.nodes], center[lids.nodes] = (
        lids.channel,
        lids.share,
        lids.centers[:, 1:],
    )
    tarsal[lids.nodes] = lids.tarsal
    pulled = np.abs(basis).max(axis=1).T[columns] > 0.0
    at, muscle = np.nonzero(pulled)
    rest = tissue.layers.nodes.reshape(3, n, 3).transpose(1, 0, 2)
    dead = tissue.dead_load.T.reshape(3, n, 3).transpose(1, 0, 2)
    return Posing(
        rest=_flat(rest[columns]),
        bone=_flat(tissue.layers.bone[columns]),
        normals=_flat(tissue.layers.normals[columns]),
        dead=_flat(dead[columns]),
        share=_flat(jaw_weight[columns]),
        center=_flat(np.array(jaw.center)),
        lid=lid[columns].astype(np.int32),
        lid_share=_flat(lid_share[columns]),
        lid_center=_flat(center[columns]),
        tarsal=tarsal[columns].astype(np.int32),
        held=(COLUMN * np.flatnonzero(tissue.held[columns])).astype(np.int32),
        grip=_flat(tissue.arrays.grip.T[columns]),
        start=np.searchsorted(at, np.arange(n + 1)).astype(np.int32),
        muscle=muscle.astype(np.int32),
        force=_flat(basis.transpose(2, 0, 1)[columns][pulled]),
    )


def _flat(values: FloatArray) -> Float32Array:
    return np.ascontiguousarray(values, dtype=np.float32).reshape(-1)


@brief
def turn_lids(x: Float32Array, signals: FloatArray, lidding: Lidding, angles: Float32Array) -> None:
    """Set `angles`, radians, shape (4 x 16,), to where the lids of sixteen faces stand.

    Args:
        x: Positions, as in `Faces`.
        signals: Activations and axes, shape (16, channels).
        lidding: What the lids follow.
        angles: Overwritten: left upper, left lower, right upper, right lower, of all lanes each.
    """
    muscles, skin = lidding.turns.shape[0], lidding.skin.shape[0]
    y, z = np.zeros(skin), np.zeros(skin)
    for lane in range(WIDTH):
        own = np.zeros((2, 2))
        for m in range(muscles):
            activation = signals[lane, m]
            if activation != 0.0:
                for side in range(2):
                    for lid in range(2):
                        own[side, lid] += activation * lidding.turns[m, side, lid]
        for k in range(skin):
            i = lidding.skin[k] + lane
            y[k], z[k] = x[i + Y] - lidding.center[0, k], x[i + Z] - lidding.center[1, k]
        pushed = skin_angles(lidding.channel, lidding.place, y, z)
        pitch = signals[lane, lidding.pitch]
        stood = stand_lids(own, pitch, pushed, lidding.shares, lidding.opening)
        for side in range(2):
            for lid in range(2):
                angles[(2 * side + lid) * WIDTH + lane] = F(stood[side, lid] * RADIAN)


@part
def turned(
    sx: Lanes, cx: Lanes, sy: Lanes, cy: Lanes, x: Lanes, y: Lanes, z: Lanes
) -> tuple[Lanes, Lanes, Lanes]:
    """Return a vector turned by the jaw: Eq. 18, row by row."""
    level = sx * y + cx * z
    return cy * x - sy * level, cx * y - sx * z, sy * x + cy * level


@brief
def pose(
    faces: Faces,
    posing: Posing,
    jaw: Float32Array,
    lids: Float32Array,
    activations: Float32Array,
    per_second: float,
) -> None:
    """Set skull, held nodes and loads of sixteen faces as they are at the end of a tick.

    `skull.pose_skull`, `skull.pose_held` and `dynamics.add_basis_forces`.

    Args:
        faces: Skull, loads, places and the velocities of held nodes are overwritten.
        posing: What moves the columns.
        jaw: Opening, radians, turn to the right, radians, slide and thrust, mm, of all lanes each.
        lids: From `turn_lids`.
        activations: Of each muscle, of all lanes each.
        per_second: Ticks in a second.
    """
    rate, held = splat(F(per_second)), 0
    cx0, cy0 = splat(posing.center[0]), splat(posing.center[1])
    cz0 = splat(posing.center[2])
    opening, turn, thrust = load(jaw, 0), load(jaw, Y), load(jaw, Z)
    zero, one = splat(F(0.0)), splat(F(1.0))
    for column in range(posing.share.shape[0]):
        i, lid = NODE * column, posing.lid[column]
        share = posing.share[column]
        sx, cx, sy, cy, slide = zero, one, zero, one, zero
        if share > F(0.0):
            sx, cx = sine_cosine(opening * splat(share))
            sy, cy = sine_cosine(turn * splat(share))
            slide = thrust * splat(share)
        sl, cl = zero, one
        if lid >= 0:
            sl, cl = sine_cosine(load(lids, int(lid) * WIDTH) * splat(posing.lid_share[column]))
        ly = splat(posing.lid_center[2 * column])
        lz = splat(posing.lid_center[2 * column + 1])
        stays = held < posing.held.shape[0] and posing.held[held] == COLUMN * column
        for layer in range(0 if stays else 2, 3):
            k = 9 * column + 3 * layer
            x, y, z = splat(posing.rest[k]), splat(posing.rest[k + 1]), splat(posing.rest[k + 2])
            if share > F(0.0):
                x, y, z = turned(sx, cx, sy, cy, x - cx0, y - cy0, z - cz0)
                x, y, z = x + cx0, y + cy0, z + cz0 + slide
            bx, by, bz = x, y, z
            if lid >= 0:
                dy, dz = y - ly, z - lz
                y, z = cl * dy - sl * dz + ly, sl * dy + cl * dz + lz
            if layer == 2:
                store(faces.travel, i, x - load(faces.target, i))
                store(faces.travel, i + Y, y - load(faces.target, i + Y))
                store(faces.travel, i + Z, z - load(faces.target, i + Z))
                store(faces.target, i, x)
                store(faces.target, i + Y, y)
                store(faces.target, i + Z, z)
            if stays:
                if posing.tarsal[column] == 0:
                    x, y, z = bx, by, bz
                p = COLUMN * held + NODE * layer
                j = COLUMN * column + NODE * layer
                store(faces.places, p, x)
                store(faces.places, p + Y, y)
                store(faces.places, p + Z, z)
                store(faces.v, j, rate * (x - load(faces.x, j)))
                store(faces.v, j + Y, rate * (y - load(faces.x, j + Y)))
                store(faces.v, j + Z, rate * (z - load(faces.x, j + Z)))
        if stays:
            held += 1
        k = 3 * column
        x, y, z = splat(posing.bone[k]), splat(posing.bone[k + 1]), splat(posing.bone[k + 2])
        nx = splat(posing.normals[k])
        ny, nz = splat(posing.normals[k + 1]), splat(posing.normals[k + 2])
        if share > F(0.0):
            x, y, z = turned(sx, cx, sy, cy, x - cx0, y - cy0, z - cz0)
            x, y, z = x + cx0, y + cy0, z + cz0 + slide
            nx, ny, nz = turned(sx, cx, sy, cy, nx, ny, nz)
        store(faces.bone, i, x)
        store(faces.bone, i + Y, y)
        store(faces.bone, i + Z, z)
        store(faces.normal, i, nx)
        store(faces.normal, i + Y, ny)
        store(faces.normal, i + Z, nz)
        fx, fy, fz = zero, zero, zero
        for e in range(posing.start[column], posing.start[column + 1]):
            activation = load(activations, int(posing.muscle[e]) * WIDTH)
            fx = fx + activation * splat(posing.force[3 * e])
            fy = fy + activation * splat(posing.force[3 * e + 1])
            fz = fz + activation * splat(posing.force[3 * e + 2])
        for layer in range(3):
            k, j = 9 * column + 3 * layer, COLUMN * column + NODE * layer
            grip = splat(posing.grip[3 * column + layer])
            x, y, z = splat(posing.dead[k]), splat(posing.dead[k + 1]), splat(posing.dead[k + 2])
            if share > F(0.0):
                x, y, z = turned(sx, cx, sy, cy, x, y, z)
            store(faces.load, j, x + grip * fx)
            store(faces.load, j + Y, y + grip * fy)
            store(faces.load, j + Z, z + grip * fz)
