"""The kernel of the Taichi peer, in Taichi's language: Python by its letters, not by its types."""

# Annotations are not postponed here: Taichi reads them as types when a kernel is made.

from typing import Any

import numpy as np

from .common import Blocks, Tables


class Fields:
    """The fields of one preparation, and the kernel that goes with them."""

    def __init__(self, ti: Any, tables: Tables, layout: Blocks) -> None:
        """Build both for `tables` and the faces of `layout`; `ti` is the package, started."""
        lanes, blocks, n, nodes = layout.lanes, layout.count, tables.points, tables.nodes
        springs, volumes, ties = tables.springs, tables.volumes, tables.ties
        s, prisms, quads = len(springs.first), volumes.prisms.shape[1], volumes.quads.shape[1]
        least, beyond, gap = volumes.least, ties.excess_distance, ties.gap
        damping = tables.damping

        def whole(array):
            return _field(ti, ti.i32, array.astype(np.int32))

        def real(array):
            return _field(ti, ti.f32, array.astype(np.float32))

        ends = whole(np.stack([springs.first, springs.second], axis=1))
        spring_law = real(np.concatenate([springs.along, springs.law]).T)
        corners, fat = whole(volumes.prisms.T), whole(volumes.quads.T)
        volume_law = real(np.concatenate([volumes.p, volumes.r, volumes.h, volumes.law]).T)
        tie_law, inverse_mass = real(ties.law.T), real(tables.inverse_mass)

        def vectors(rows: int) -> Any:
            return ti.Vector.field(lanes, ti.f32, shape=(blocks, rows, 3))

        self.targets, self.normals, self.load = vectors(n), vectors(n), vectors(nodes)
        # A field of no columns is not allowed.
        self.depth = vectors(max(quads, 1))
        self.u, self.v, self.at, self.mid_v = (vectors(nodes) for _ in range(4))
        self.force = vectors(nodes)
        targets, normals, load, depth = self.targets, self.normals, self.load, self.depth
        u, v, at, mid_v, f = self.u, self.v, self.at, self.mid_v, self.force

        @ti.func
        def pull(g):
            for k in range(s):
                i, j = ends[k, 0], ends[k, 1]
                x = at[g, j, 0] - at[g, i, 0] + spring_law[k, 0]
                y = at[g, j, 1] - at[g, i, 1] + spring_law[k, 1]
                z = at[g, j, 2] - at[g, i, 2] + spring_law[k, 2]
                length = ti.sqrt(x * x + y * y + z * z)
                stretch = length - spring_law[k, 3]
                over = ti.max(stretch - spring_law[k, 7], 0.0)
                under = ti.min(stretch - spring_law[k, 8], 0.0)
                tension = stretch * spring_law[k, 4] + over * spring_law[k, 5]
                tension = (tension + under * spring_law[k, 6]) / length
                # Not `+=`, which Taichi makes atomic.
                f[g, i, 0] = f[g, i, 0] + tension * x
                f[g, i, 1] = f[g, i, 1] + tension * y
                f[g, i, 2] = f[g, i, 2] + tension * z
                f[g, j, 0] = f[g, j, 0] - tension * x
                f[g, j, 1] = f[g, j, 1] - tension * y
                f[g, j, 2] = f[g, j, 2] - tension * z

        @ti.func
        def hold(share, e):
            held = share * (0.5 * volume_law[e, 9])
            held = ti.min(ti.max(held, volume_law[e, 12]), volume_law[e, 13])
            pressed = ti.min(held - least, 0.0)
            harder = pressed * pressed * volume_law[e, 11]
            return (1.0 - held + harder) * (0.5 * volume_law[e, 10])

        @ti.func
        def between(g, a, b, e, k: ti.template(), law: ti.template()):
            way = at[g, b, k] + at[g, b + n, k] - at[g, a, k] - at[g, a + n, k]
            return way * 0.5 + volume_law[e, law]

        @ti.func
        def height(g, a, b, c, e, k: ti.template()):
            upper = at[g, a, k] + at[g, b, k] + at[g, c, k]
            lower = at[g, a + n, k] + at[g, b + n, k] + at[g, c + n, k]
            return (upper - lower) * (1.0 / 3.0) + volume_law[e, 6 + k]

        @ti.func
        def hand_out(g, a, b, c, k: ti.template(), rise, second, third):
            turn = second + third
            f[g, a, k] = f[g, a, k] + (rise - turn)
            f[g, b, k] = f[g, b, k] + (rise + second)
            f[g, c, k] = f[g, c, k] + (rise + third)
            f[g, a + n, k] = f[g, a + n, k] - (rise + turn)
            f[g, b + n, k] = f[g, b + n, k] + (second - rise)
            f[g, c + n, k] = f[g, c + n, k] + (third - rise)

        @ti.func
        def swell(g):
            for e in range(prisms):
                a, b, c = corners[e, 0], corners[e, 1], corners[e, 2]
                px, py, pz = (
                    between(g, a, b, e, 0, 0),
                    between(g, a, b, e, 1, 1),
                    between(g, a, b, e, 2, 2),
                )
                rx, ry, rz = (
                    between(g, a, c, e, 0, 3),
                    between(g, a, c, e, 1, 4),
                    between(g, a, c, e, 2, 5),
                )
                hx = height(g, a, b, c, e, 0)
                hy = height(g, a, b, c, e, 1)
                hz = height(g, a, b, c, e, 2)
                nx, ny, nz = py * rz - pz * ry, pz * rx - px * rz, px * ry - py * rx
                push = hold(nx * hx + ny * hy + nz * hz, e)
                turn, rise = push * 0.5, push * (1.0 / 3.0)
                # Along p and r, which the second and the third corner carry.
                second, third = turn * (ry * hz - rz * hy), turn * (hy * pz - hz * py)
                hand_out(g, a, b, c, 0, rise * nx, second, third)
                second, third = turn * (rz * hx - rx * hz), turn * (hz * px - hx * pz)
                hand_out(g, a, b, c, 1, rise * ny, second, third)
                second, third = turn * (rx * hy - ry * hx), turn * (hx * py - hy * px)
                hand_out(g, a, b, c, 2, rise * nz, second, third)

        @ti.func
        def middle(g, i, k: ti.template()):
            return (at[g, i, k] + at[g, i + n, k] + at[g, i + 2 * n, k]) * (1.0 / 3.0)

        @ti.func
        def center(g, q, k: ti.template()):
            across = middle(g, fat[q, 0], k) + middle(g, fat[q, 2], k)
            other = middle(g, fat[q, 1], k) + middle(g, fat[q, 3], k)
            return (across + other) * 0.25 + depth[g, q, k]

        @ti.func
        def spread(g, a, b, k: ti.template(), rise, turn):
            for layer in range(3):
                i, j = a + layer * n, b + layer * n
                f[g, i, k] = f[g, i, k] + (rise - turn)
                f[g, j, k] = f[g, j, k] + (rise + turn)

        @ti.func
        def cushion(g):
            for q in range(quads):
                e = prisms + q
                a, b, c, d = fat[q, 0], fat[q, 1], fat[q, 2], fat[q, 3]
                px = middle(g, c, 0) - middle(g, a, 0) + volume_law[e, 0]
                py = middle(g, c, 1) - middle(g, a, 1) + volume_law[e, 1]
                pz = middle(g, c, 2) - middle(g, a, 2) + volume_law[e, 2]
                rx = middle(g, d, 0) - middle(g, b, 0) + volume_law[e, 3]
                ry = middle(g, d, 1) - middle(g, b, 1) + volume_law[e, 4]
                rz = middle(g, d, 2) - middle(g, b, 2) + volume_law[e, 5]
                hx, hy, hz = center(g, q, 0), center(g, q, 1), center(g, q, 2)
                nx, ny, nz = py * rz - pz * ry, pz * rx - px * rz, px * ry - py * rx
                push = hold(nx * hx + ny * hy + nz * hz, e) * (1.0 / 3.0)
                rise = push * 0.25
                spread(g, a, c, 0, rise * nx, push * (ry * hz - rz * hy))
                spread(g, a, c, 1, rise * ny, push * (rz * hx - rx * hz))
                spread(g, a, c, 2, rise * nz, push * (rx * hy - ry * hx))
                spread(g, b, d, 0, rise * nx, push * (hy * pz - hz * py))
                spread(g, b, d, 1, rise * ny, push * (hz * px - hx * pz))
                spread(g, b, d, 2, rise * nz, push * (hx * py - hy * px))

        @ti.func
        def tie(g):
            for i in range(n):
                j = 2 * n + i
                x = targets[g, i, 0] - at[g, j, 0]
                y = targets[g, i, 1] - at[g, j, 1]
                z = targets[g, i, 2] - at[g, j, 2]
                nx, ny, nz = normals[g, i, 0], normals[g, i, 1], normals[g, i, 2]
                inwards = x * nx + y * ny + z * nz
                distance = ti.max(ti.sqrt(x * x + y * y + z * z), beyond)
                along = (1.0 - beyond / distance) * tie_law[i, 2] + tie_law[i, 0]
                inside = ti.max(inwards - gap, 0.0)
                across = inwards * tie_law[i, 1] + inside * tie_law[i, 3]
                f[g, j, 0] = f[g, j, 0] + along * x + across * nx
                f[g, j, 1] = f[g, j, 1] + along * y + across * ny
                f[g, j, 2] = f[g, j, 2] + along * z + across * nz

        @ti.kernel
        def advance(verlet: ti.i32, stages: ti.i32, dt: ti.f32):
            half = 0.5 * dt
            drag = half * damping
            keep, kick = (1.0 - drag) / (1.0 + drag), dt / (1.0 + drag)
            for g in range(blocks):
                for stage in range(stages):
                    for i in range(nodes):
                        for c in ti.static(range(3)):
                            if verlet:
                                at[g, i, c] = u[g, i, c] + v[g, i, c] * half
                            f[g, i, c] = load[g, i, c]
                    pull(g)
                    swell(g)
                    cushion(g)
                    tie(g)
                    for i in range(nodes):
                        inverse = inverse_mass[i]
                        for c in ti.static(range(3)):
                            if verlet:
                                speed = v[g, i, c] * keep + f[g, i, c] * (kick * inverse)
                                place = at[g, i, c] + speed * half
                                v[g, i, c] = speed
                                u[g, i, c] = place
                                at[g, i, c] = place
                            elif dt > 0.0 and stage % 2 == 0:
                                speed = v[g, i, c]
                                slope = f[g, i, c] * inverse - speed * damping
                                at[g, i, c] = u[g, i, c] + speed * half
                                mid_v[g, i, c] = speed + slope * half
                            elif dt > 0.0:
                                speed = mid_v[g, i, c]
                                slope = f[g, i, c] * inverse - speed * damping
                                place = u[g, i, c] + speed * dt
                                u[g, i, c] = place
                                at[g, i, c] = place
                                v[g, i, c] = v[g, i, c] + slope * dt

        self.advance = advance


def _field(ti: Any, kind: Any, array: Any) -> Any:
    # A field of no rows is not allowed.
    field = ti.field(kind, shape=(max(len(array), 1), *array.shape[1:]))
    if len(array):
        field.from_numpy(np.ascontiguousarray(array))
    return field
