"""What the skin of sixteen faces may not pass: the other lip, the teeth, the eyeballs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import Float32Array
from ..dynamics import ARCH_ROUND_MM, IndexArray, Tissue
from .network import NODE, Order
from .vector import (
    WIDTH,
    add_at,
    floor,
    greater,
    inverse_root,
    lesser,
    load,
    lookup,
    part,
    pick,
    splat,
    store,
)

F = np.float32
Y, Z = WIDTH, 2 * WIDTH
ROUND = F(ARCH_ROUND_MM)


class Touching(NamedTuple):
    """`dynamics.Contacts` with offsets for nodes, in the order of `order_columns`.

    Attributes:
        upper_lip, lower_lip, lip_gap: Pairs, and the height kept between them.
        lip_share: How much of a pair's overlap the upper one gives way.
        tooth, tooth_clearance: Nodes before the teeth.
        arch: Depth of the arch at |x| = 0, 1, 2, … mm.
        arch_bottom, arch_fall: Its lower edge, mm, and the way behind it, mm per mm.
        eye: Nodes on eyeballs.
        eye_center: Centre of each, x, y, z, shape (3 e,).
        eye_radius: Least distance, mm.
    """

    upper_lip: IndexArray
    lower_lip: IndexArray
    lip_gap: Float32Array
    lip_share: Float32Array
    tooth: IndexArray
    tooth_clearance: Float32Array
    arch: Float32Array
    arch_bottom: np.float32
    arch_fall: np.float32
    eye: IndexArray
    eye_center: Float32Array
    eye_radius: Float32Array


def touching(tissue: Tissue, order: Order) -> Touching:
    """Return the contacts of `tissue` for nodes in `order`; held pairs are left out."""
    contacts, mass = tissue.contacts, tissue.inverse_mass
    above, below = contacts.upper_lip, contacts.lower_lip
    total = mass[above] + mass[below]
    free = total > 0.0

    def offset(nodes: IndexArray) -> IndexArray:
        return np.ascontiguousarray(NODE * order.nodes[nodes], dtype=np.int32)

    return Touching(
        upper_lip=offset(above[free]),
        lower_lip=offset(below[free]),
        lip_gap=contacts.lip_gap[free].astype(np.float32),
        lip_share=(mass[above] / np.maximum(total, 1e-300))[free].astype(np.float32),
        tooth=offset(contacts.tooth_nodes),
        tooth_clearance=contacts.tooth_clearance.astype(np.float32),
        arch=contacts.arch.astype(np.float32),
        arch_bottom=F(contacts.arch_bottom),
        arch_fall=F(contacts.arch_fall),
        eye=offset(contacts.eye_nodes),
        eye_center=np.ascontiguousarray(contacts.eye_centers.T.ravel(), dtype=np.float32),
        eye_radius=contacts.eye_radius.astype(np.float32),
    )


@part
def keep_lips(x: Float32Array, v: Float32Array, at: Touching) -> None:
    """Keep each upper-lip node above its partner: `dynamics.resolve_lips`."""
    zero, one = splat(F(0.0)), splat(F(1.0))
    for q in range(at.upper_lip.shape[0]):
        i, j = int(at.upper_lip[q]) + Y, int(at.lower_lip[q]) + Y
        upper = splat(at.lip_share[q])
        lower = one - upper
        overlap = splat(at.lip_gap[q]) - (load(x, i) - load(x, j))
        closing = pick(overlap, zero, lesser(load(v, i) - load(v, j), zero), zero)
        overlap = greater(overlap, zero)
        add_at(x, i, overlap * upper)
        add_at(x, j, zero - overlap * lower)
        add_at(v, i, zero - closing * upper)
        add_at(v, j, closing * lower)


@part
def keep_off_teeth(x: Float32Array, v: Float32Array, at: Touching) -> None:
    """Keep the lips before the upper dental arch: `dynamics.resolve_teeth`."""
    zero, one = splat(F(0.0)), splat(F(1.0))
    last = splat(F(at.arch.shape[0] - 1))
    edge, per_edge, fall = splat(ROUND), splat(F(0.5) / ROUND), splat(at.arch_fall)
    for q in range(at.tooth.shape[0]):
        i = int(at.tooth[q])
        x0, y0, z0 = load(x, i), load(x, i + Y), load(x, i + Z)
        lateral = greater(x0, zero - x0)
        place = greater(lesser(lateral, last - one), zero)
        cell = floor(place)
        start = lookup(at.arch, cell)
        slope = lookup(at.arch, cell + one) - start
        front = start + (lateral - cell) * slope + splat(at.tooth_clearance[q])
        nx = (zero - slope) * lesser(greater(x0, zero - one), one)
        below = splat(at.arch_bottom) - y0
        past = lesser(greater(below + edge, zero), edge + edge) * per_edge
        front = front - (edge * past * past + greater(below - edge, zero)) * fall
        ny = zero - fall * past
        inside = pick(last, lateral, greater(front - z0, zero), zero)
        squared = nx * nx + ny * ny + one
        push = inside / squared
        store(x, i, x0 + push * nx)
        store(x, i + Y, y0 + push * ny)
        store(x, i + Z, z0 + push)
        inwards = load(v, i) * nx + load(v, i + Y) * ny + load(v, i + Z)
        stop = pick(inside, zero, zero - lesser(inwards, zero), zero) / squared
        add_at(v, i, stop * nx)
        add_at(v, i + Y, stop * ny)
        add_at(v, i + Z, stop)


@part
def keep_off_eyes(x: Float32Array, v: Float32Array, at: Touching) -> None:
    """Keep the lids outside the eyeballs: `dynamics.resolve_eyes`."""
    zero, one = splat(F(0.0)), splat(F(1.0))
    for q in range(at.eye.shape[0]):
        i = int(at.eye[q])
        cx, cy = splat(at.eye_center[3 * q]), splat(at.eye_center[3 * q + 1])
        cz = splat(at.eye_center[3 * q + 2])
        dx, dy, dz = load(x, i) - cx, load(x, i + Y) - cy, load(x, i + Z) - cz
        inverse = inverse_root(dx * dx + dy * dy + dz * dz)
        # 1 where the node is outside, so that it stays where it is.
        inside = greater(splat(at.eye_radius[q]) * inverse - one, zero)
        add_at(x, i, inside * dx)
        add_at(x, i + Y, inside * dy)
        add_at(x, i + Z, inside * dz)
        inwards = lesser(load(v, i) * dx + load(v, i + Y) * dy + load(v, i + Z) * dz, zero)
        stop = pick(inside, zero, zero - inwards * inverse * inverse, zero)
        add_at(v, i, stop * dx)
        add_at(v, i + Y, stop * dy)
        add_at(v, i + Z, stop * dz)
