"""What of sixteen faces is seen: the sheet and what follows it; and how they fare."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import Float32Array, FloatArray
from ..compiling import brief
from ..dynamics import IndexArray
from ..head import Head
from .network import COLUMN, Order
from .posing import turned
from .vector import WIDTH, greater, load, pick, sine_cosine, splat, store

F = np.float32
Y, Z = WIDTH, 2 * WIDTH


class Following(NamedTuple):
    """The points of a head's surface: the sheet's columns, then its followers.

    Attributes:
        column: Offset of each sheet point's epidermis node, in the head's own order, shape (n,).
        rest: Of those, shape (3 n,).
        start, source, weight: Rows of `Head.follow`; sources are sheet points.
        jaw: `Head.follow_jaw`.
        points: Followers at rest, mm, shape (3 k,).
        center: Of the jaw's hinge, shape (3,).
    """

    column: IndexArray
    rest: Float32Array
    start: IndexArray
    source: IndexArray
    weight: Float32Array
    jaw: Float32Array
    points: Float32Array
    center: Float32Array


def following(head: Head, center: tuple[float, float, float], order: Order) -> Following:
    """Return the points of `head` whose columns stand in `order`."""
    n = head.sheet_count
    follow = head.follow.tocsr()
    return Following(
        column=(COLUMN * order.places).astype(np.int32),
        rest=head.points[:n].astype(np.float32).ravel(),
        start=follow.indptr.astype(np.int32),
        source=follow.indices.astype(np.int32),
        weight=follow.data.astype(np.float32),
        jaw=head.follow_jaw.astype(np.float32),
        points=head.points[n:].astype(np.float32).ravel(),
        center=np.array(center, np.float32),
    )


@brief
def surface(
    x: Float32Array, at: Following, jaw: Float32Array, moved: Float32Array, out: FloatArray
) -> None:
    """Set `out`, shape (16, s, 3), to the displacements of sixteen faces from rest, mm.

    Args:
        x: Positions, as in `Faces`.
        at: The surface.
        jaw: As in `posing.pose`.
        moved: Scratch, shape (s x 3 x 16,).
        out: Overwritten.
    """
    n, k = at.column.shape[0], at.jaw.shape[0]
    for i in range(n):
        for c in range(3):
            here = load(x, int(at.column[i]) + c * WIDTH)
            store(moved, (3 * i + c) * WIDTH, here - splat(at.rest[3 * i + c]))
    if k > 0:
        sx, cx = sine_cosine(load(jaw, 0))
        sy, cy = sine_cosine(load(jaw, Y))
        for i in range(k):
            px = splat(at.points[3 * i] - at.center[0])
            py = splat(at.points[3 * i + 1] - at.center[1])
            pz = splat(at.points[3 * i + 2] - at.center[2])
            rx, ry, rz = turned(sx, cx, sy, cy, px, py, pz)
            share = splat(at.jaw[i])
            dx, dy = share * (rx - px), share * (ry - py)
            dz = share * (rz + load(jaw, Z) - pz)
            for e in range(at.start[i], at.start[i + 1]):
                j, weight = 3 * int(at.source[e]) * WIDTH, splat(at.weight[e])
                dx = dx + weight * load(moved, j)
                dy = dy + weight * load(moved, j + Y)
                dz = dz + weight * load(moved, j + Z)
            j = 3 * (n + i) * WIDTH
            store(moved, j, dx)
            store(moved, j + Y, dy)
            store(moved, j + Z, dz)
    for i in range(n + k):
        for c in range(3):
            for lane in range(WIDTH):
                out[lane, i, c] = moved[(3 * i + c) * WIDTH + lane]


@brief
def fare(
    x: Float32Array, before: Float32Array, rest: Float32Array, most: float, out: Float32Array
) -> None:
    """Set `out`, shape (2 x 16,), to how sixteen faces fare.

    First how far a node went since the last tick, at most along one axis, mm; then how many
    components of positions are `most` mm from rest or farther, or no numbers at all.

    Args:
        x: As in `Faces`.
        before: Positions after the last tick.
        rest: Nodes at rest, one number for each component.
        most: mm.
        out: Overwritten.
    """
    zero, one, limit = splat(F(0.0)), splat(F(1.0)), splat(F(most))
    farthest, lost = zero, zero
    for i in range(rest.shape[0]):
        here = load(x, i * WIDTH)
        way = here - load(before, i * WIDTH)
        farthest = greater(greater(way, zero - way), farthest)
        gone = here - splat(rest[i])
        # The limit is not greater than what is no number.
        lost = lost + pick(limit, greater(gone, zero - gone), zero, one)
    store(out, 0, farthest)
    store(out, WIDTH, lost)


@brief
def remember(x: Float32Array, before: Float32Array) -> None:
    """Set `before` to `x`, both as in `fare`.

    Not by numpy: that would let another thread in, and wait for it, in the middle of a tick.
    """
    for i in range(x.shape[0]):
        before[i] = x[i]
