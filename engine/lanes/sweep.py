"""One pass over the tissue of sixteen faces: every force, and every node moved (section 6).

The forces are those of `engine.dynamics`, term by term, which is the reference; here they are taken
column by column, all that acts on a column before it moves, so that nodes are read and written
where the cache still holds them. What a node gets from columns before its own waits in `force`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import Float32Array
from ..dynamics import LEAST_VOLUME, MOST_VOLUME
from .network import COLUMN, NODE, Network
from .vector import (
    WIDTH,
    Lanes,
    add_at,
    greater,
    inverse_root,
    lesser,
    load,
    part,
    splat,
    store,
)

F = np.float32
Y, Z = WIDTH, 2 * WIDTH
"""Where a node's second and third component begin."""
LEAST_SHARE, MOST_SHARE = F(LEAST_VOLUME), F(MOST_VOLUME)
TINY = F(1.0e-12)


class Faces(NamedTuple):
    """Sixteen faces: flat arrays, a node's x of all lanes, then its y, then its z.

    Attributes:
        x, v: Positions, mm, and velocities, mm/s, node by node.
        force: What nodes have got of this step's forces; `load` between steps.
        load: Dead load and muscles, node by node.
        target: Where each column's tie will be at the end of the tick.
        travel: How far it goes in the tick.
        normal, bone: Skull's normal at each column, and the foot of its fat.
        places: Where the nodes of held columns are at the end of the tick.
    """

    x: Float32Array
    v: Float32Array
    force: Float32Array
    load: Float32Array
    target: Float32Array
    travel: Float32Array
    normal: Float32Array
    bone: Float32Array
    places: Float32Array


@part
def node_sum(x: Float32Array, i: int) -> tuple[Lanes, Lanes, Lanes]:
    """Return the sum of the three nodes of the column that begins at `i`."""
    j, k = i + NODE, i + 2 * NODE
    return (
        load(x, i) + load(x, j) + load(x, k),
        load(x, i + Y) + load(x, j + Y) + load(x, k + Y),
        load(x, i + Z) + load(x, j + Z) + load(x, k + Z),
    )


@part
def add_node(force: Float32Array, i: int, fx: Lanes, fy: Lanes, fz: Lanes) -> None:
    """Add a force to the node that begins at `i`."""
    add_at(force, i, fx)
    add_at(force, i + Y, fy)
    add_at(force, i + Z, fz)


@part
def add_elements(x: Float32Array, force: Float32Array, net: Network, column: int) -> None:
    """Add what the elements of one column do: `dynamics.add_prism_forces`.

    Upper and lower node of a corner are taken as sum and difference; see `Network.volume`.
    """
    one, zero = splat(F(1.0)), splat(F(0.0))
    least, lowest, highest = splat(net.least), splat(LEAST_SHARE), splat(MOST_SHARE)
    for gap in range(2):
        first, end = net.element_start[2 * column + gap], net.element_start[2 * column + gap + 1]
        if first == end:
            continue
        a = COLUMN * column + NODE * gap
        la = a + NODE
        ax, ay, az = load(x, a), load(x, a + Y), load(x, a + Z)
        kx, ky, kz = load(x, la), load(x, la + Y), load(x, la + Z)
        max_, may, maz = ax + kx, ay + ky, az + kz
        hax, hay, haz = ax - kx, ay - ky, az - kz
        sx, sy, sz, tx, ty, tz = zero, zero, zero, zero, zero, zero
        for e in range(first, end):
            b, c = int(net.second[e]), int(net.third[e])
            lb, lc = b + NODE, c + NODE
            ax, ay, az = load(x, b), load(x, b + Y), load(x, b + Z)
            kx, ky, kz = load(x, lb), load(x, lb + Y), load(x, lb + Z)
            px, py, pz = ax + kx - max_, ay + ky - may, az + kz - maz
            hx, hy, hz = hax + (ax - kx), hay + (ay - ky), haz + (az - kz)
            ax, ay, az = load(x, c), load(x, c + Y), load(x, c + Z)
            kx, ky, kz = load(x, lc), load(x, lc + Y), load(x, lc + Z)
            rx, ry, rz = ax + kx - max_, ay + ky - may, az + kz - maz
            hx, hy, hz = hx + (ax - kx), hy + (ay - ky), hz + (az - kz)
            nx, ny, nz = py * rz - pz * ry, pz * rx - px * rz, px * ry - py * rx
            share = (nx * hx + ny * hy + nz * hz) * splat(net.volume[e])
            share = lesser(greater(share, lowest), highest)
            pressed = lesser(share - least, zero)
            push = splat(net.order[e]) * pressed * pressed + (one - share)
            push = splat(net.stiffness[e]) * push
            hx, hy, hz = push * hx, push * hy, push * hz
            nx, ny, nz = push * nx, push * ny, push * nz
            ax, ay, az = ry * hz - rz * hy, rz * hx - rx * hz, rx * hy - ry * hx
            kx, ky, kz = hy * pz - hz * py, hz * px - hx * pz, hx * py - hy * px
            sx, sy, sz = sx + nx, sy + ny, sz + nz
            tx, ty, tz = tx - ax - kx, ty - ay - ky, tz - az - kz
            add_node(force, b, ax + nx, ay + ny, az + nz)
            add_node(force, lb, ax - nx, ay - ny, az - nz)
            add_node(force, c, kx + nx, ky + ny, kz + nz)
            add_node(force, lc, kx - nx, ky - ny, kz - nz)
        add_node(force, a, tx + sx, ty + sy, tz + sz)
        add_node(force, la, tx - sx, ty - sy, tz - sz)


@part
def add_to_column(force: Float32Array, i: int, fx: Lanes, fy: Lanes, fz: Lanes) -> None:
    """Add one force to each node of the column that begins at `i`."""
    for layer in range(3):
        j = i + layer * NODE
        add_node(force, j, fx, fy, fz)


@part
def add_fat(
    x: Float32Array, bone: Float32Array, force: Float32Array, net: Network, column: int
) -> None:
    """Add what the fat of one column does: `dynamics.add_pressure_forces`."""
    one, three = splat(F(1.0)), splat(F(3.0))
    for q in range(net.fat_start[column], net.fat_start[column + 1]):
        a, b = int(net.fat_corners[4 * q]), int(net.fat_corners[4 * q + 1])
        c, d = int(net.fat_corners[4 * q + 2]), int(net.fat_corners[4 * q + 3])
        ax, ay, az = node_sum(x, a)
        bx, by, bz = node_sum(x, b)
        cx, cy, cz = node_sum(x, c)
        dx, dy, dz = node_sum(x, d)
        hx, hy, hz = ax + bx + cx + dx, ay + by + cy + dy, az + bz + cz + dz
        px, py, pz = cx - ax, cy - ay, cz - az
        rx, ry, rz = dx - bx, dy - by, dz - bz
        i, j, k, m = a // 3, b // 3, c // 3, d // 3
        hx = hx - three * (load(bone, i) + load(bone, j) + load(bone, k) + load(bone, m))
        i, j, k, m = i + Y, j + Y, k + Y, m + Y
        hy = hy - three * (load(bone, i) + load(bone, j) + load(bone, k) + load(bone, m))
        i, j, k, m = i + Y, j + Y, k + Y, m + Y
        hz = hz - three * (load(bone, i) + load(bone, j) + load(bone, k) + load(bone, m))
        nx, ny, nz = py * rz - pz * ry, pz * rx - px * rz, px * ry - py * rx
        share = (nx * hx + ny * hy + nz * hz) * splat(net.fat_volume[q])
        push = splat(net.fat_stiffness[q]) * (one - share)
        hx, hy, hz = push * hx, push * hy, push * hz
        nx, ny, nz = push * nx, push * ny, push * nz
        gx, gy, gz = ry * hz - rz * hy, rz * hx - rx * hz, rx * hy - ry * hx
        add_to_column(force, a, nx - gx, ny - gy, nz - gz)
        add_to_column(force, c, nx + gx, ny + gy, nz + gz)
        gx, gy, gz = hy * pz - hz * py, hz * px - hx * pz, hx * py - hy * px
        add_to_column(force, b, nx - gx, ny - gy, nz - gz)
        add_to_column(force, d, nx + gx, ny + gy, nz + gz)


@part
def tie(
    faces: Faces, net: Network, column: int, behind: Lanes, x: Lanes, y: Lanes, z: Lanes
) -> tuple[Lanes, Lanes, Lanes]:
    """Return the skull's hold on a hypodermis node: `dynamics.add_anchor_forces`."""
    one, zero = splat(F(1.0)), splat(F(0.0))
    i = NODE * column
    ux = load(faces.target, i) - behind * load(faces.travel, i) - x
    uy = load(faces.target, i + Y) - behind * load(faces.travel, i + Y) - y
    uz = load(faces.target, i + Z) - behind * load(faces.travel, i + Z) - z
    nx, ny, nz = load(faces.normal, i), load(faces.normal, i + Y), load(faces.normal, i + Z)
    depth = ux * nx + uy * ny + uz * nz
    tangential, normal = splat(net.tangential[column]), splat(net.normal[column])
    inverse = inverse_root(ux * ux + uy * uy + uz * uz + splat(TINY))
    far = greater(one - splat(net.excess_distance) * inverse, zero)
    along = tangential + tangential * splat(net.excess) * far
    wall = greater(depth - splat(net.skull_gap), zero)
    across = (normal - tangential) * depth + normal * splat(net.skull) * wall
    return along * ux + across * nx, along * uy + across * ny, along * uz + across * nz


@part
def sweep(
    faces: Faces,
    net: Network,
    behind: np.float32,
    keep: np.float32,
    gain: np.float32,
    drift: np.float32,
) -> None:
    """Kick and move every node of sixteen faces once: `dynamics.kick` and `shift`.

    Args:
        faces: Positions, velocities, loads; all are overwritten but the skull's.
        net: Their tissue.
        behind: Share of the tick that is still to come.
        keep: Share of the velocities that damping leaves: `dynamics.kick`.
        gain: Time for which forces act, damped, s: the same.
        drift: How long nodes go with their new velocity, s.
    """
    x, v, force = faces.x, faces.v, faces.force
    one, zero = splat(F(1.0)), splat(F(0.0))
    knee, brace, still_to_go = splat(net.knee), splat(net.brace), splat(behind)
    kept, time = splat(keep), splat(drift)
    for column in range(net.tangential.shape[0]):
        add_elements(x, force, net, column)
        add_fat(x, faces.bone, force, net, column)
        for layer in range(3):
            node = 3 * column + layer
            i = NODE * node
            x0, y0, z0 = load(x, i), load(x, i + Y), load(x, i + Z)
            fx, fy, fz = load(force, i), load(force, i + Y), load(force, i + Z)
            for s in range(net.spring_start[node], net.spring_start[node + 1]):
                j = int(net.spring_end[s])
                dx, dy, dz = load(x, j) - x0, load(x, j + Y) - y0, load(x, j + Z) - z0
                # Every stretch of Eq. 20 as a share of the length: 1 - d0 (1 + ε) / |d|.
                short = splat(net.rest[s]) * inverse_root(dx * dx + dy * dy + dz * dz)
                pull = (
                    splat(net.low[s]) * (one - short)
                    + splat(net.more[s]) * greater(one - knee * short, zero)
                    + splat(net.guard[s]) * lesser(one - brace * short, zero)
                )
                dx, dy, dz = pull * dx, pull * dy, pull * dz
                fx, fy, fz = fx + dx, fy + dy, fz + dz
                store(force, j, load(force, j) - dx)
                store(force, j + Y, load(force, j + Y) - dy)
                store(force, j + Z, load(force, j + Z) - dz)
            if layer == 2:
                dx, dy, dz = tie(faces, net, column, still_to_go, x0, y0, z0)
                fx, fy, fz = fx + dx, fy + dy, fz + dz
            vx, vy, vz = load(v, i), load(v, i + Y), load(v, i + Z)
            inverse = net.inverse_mass[node]
            if inverse > F(0.0):
                push = splat(inverse * gain)
                vx, vy, vz = kept * vx + push * fx, kept * vy + push * fy, kept * vz + push * fz
                store(v, i, vx)
                store(v, i + Y, vy)
                store(v, i + Z, vz)
            store(x, i, x0 + time * vx)
            store(x, i + Y, y0 + time * vy)
            store(x, i + Z, z0 + time * vz)
            store(force, i, load(faces.load, i))
            store(force, i + Y, load(faces.load, i + Y))
            store(force, i + Z, load(faces.load, i + Z))
