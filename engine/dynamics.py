"""The kernels: tissue forces, contact, and the integrators of Lagrangian dynamics (section 6).

Only arrays come in and only arrays go out. A face's nodes are columns: positions, velocities and
forces have shape (3, nodes), components first, so that each component is one run of memory and the
spring loop becomes vector instructions. The first third of the nodes is the epidermis, the second
the dermis, the last the hypodermis. Units: mm, g, s.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import FloatArray
from .compiling import kernel

IndexArray = npt.NDArray[np.int32]

LEAST_VOLUME, MOST_VOLUME = -1.0, 1.5
"""Shares of its volume beyond which an element pulls no harder: torn open or turned over by a jump
of the jaw, it would else be stiffer than its mass allows."""

ARCH_ROUND_MM = 2.0
"""Half height over which the edge of the upper dental arch turns inwards."""

TABLEAUS: dict[str, FloatArray] = {
    "rk2": np.array([[0.5, 0.0], [0.0, 1.0]]),
    "heun": np.array([[1.0, 0.5], [0.0, 0.5]]),
    "rk4": np.array([[0.5, 1 / 6], [0.5, 1 / 3], [1.0, 1 / 3], [0.0, 1 / 6]]),
    "symplectic_euler": np.zeros((0, 2)),
    "verlet": np.zeros((0, 1)),
}
"""Integrators by name. A row is a stage of explicit Runge-Kutta: how far ahead of the step's start
the next stage stands, and this stage's share of the step. "rk2" is the midpoint form: the paper's
second-order Runge-Kutta (section 6), the default and the reference. Symplectic Euler, velocity
first, then position with the new velocity, has no rows; neither has position Verlet, whose forces
are taken half way through the step: it is told from the other by its one column."""


class Springs(NamedTuple):
    """Structural and shear springs between nodes (Eqs. 19-20).

    Attributes:
        first, second: Node indices, shape (springs,).
        rest: Rest length d0, mm.
        low, high: k_L and k_H, below and above the strain threshold.
        guard: Added stiffness of the third phase, in compression.
        threshold: ε_c, shared by all springs.
        guard_strain: ε_k, compressive strain at which the guard sets in.
        literal: True for Eq. 20 as printed, which jumps at the threshold.
    """

    first: IndexArray
    second: IndexArray
    rest: FloatArray
    low: FloatArray
    high: FloatArray
    guard: FloatArray
    threshold: float
    guard_strain: float
    literal: bool


class Anchors(NamedTuple):
    """Ties of the hypodermis to the skull, which cannot be entered (section 5.2).

    Attributes:
        tangential, normal: Stiffness along and across the skull, shape (n,).
        excess: Added share of the tangential stiffness beyond `excess_distance` mm.
        skull: Added share of the normal stiffness beyond `skull_gap` mm inwards.
    """

    tangential: FloatArray
    normal: FloatArray
    excess: float
    excess_distance: float
    skull: float
    skull_gap: float


class Prisms(NamedTuple):
    """Elements between two layers that keep their volume and are never turned inside out.

    Attributes:
        corners: Nodes of the upper face, counter-clockwise from outside, shape (e, 3); the lower
            face's lie one layer deeper.
        stiffness: Modulus times squared height, shape (e,).
        volume: Rest volume, mm³, shape (e,).
        order: How much harder an element resists that is pressed below `least`, shape (e,).
        least: Share of its volume below which the order of the layers is in danger.
    """

    corners: IndexArray
    stiffness: FloatArray
    volume: FloatArray
    order: FloatArray
    least: float


class Plate(NamedTuple):
    """Linear bending stiffness of the epidermis: a sparse symmetric matrix in CSR."""

    start: IndexArray
    columns: IndexArray
    values: FloatArray


class Pressure(NamedTuple):
    """Columns of fat that keep their volume, one a quad.

    Attributes:
        quads: Corner nodes in the epidermis, shape (q, 4).
        stiffness: Pressure modulus times the squared depth, shape (q,).
        volume: Rest volume, mm³, shape (q,).
        height: Rest volume over area, mm, shape (q,).
    """

    quads: IndexArray
    stiffness: FloatArray
    volume: FloatArray
    height: FloatArray


class Contacts(NamedTuple):
    """What the skin may not pass: the other lip, the teeth, the eyeballs.

    Attributes:
        upper_lip, lower_lip: Paired epidermis nodes, shape (l,).
        lip_gap: Least height of the upper over the lower, mm, shape (l,).
        tooth_nodes: Epidermis nodes kept before the dental arch, shape (t,).
        tooth_clearance: Distance kept, mm, shape (t,).
        arch: Depth z of the arch at |x| = 0, 1, 2, … mm.
        arch_bottom: Height below which lips may fall back behind the upper teeth, mm.
        arch_fall: How far they may, mm per mm.
        eye_nodes: Epidermis nodes kept off an eyeball, shape (e,).
        eye_centers: Ball centre for each, shape (3, e).
        eye_radius: Least distance, mm, shape (e,).
    """

    upper_lip: IndexArray
    lower_lip: IndexArray
    lip_gap: FloatArray
    tooth_nodes: IndexArray
    tooth_clearance: FloatArray
    arch: FloatArray
    arch_bottom: float
    arch_fall: float
    eye_nodes: IndexArray
    eye_centers: FloatArray
    eye_radius: FloatArray


class Tissue(NamedTuple):
    """Everything of a rig that does not change while a face moves.

    `grip`, shape (3, n), is how the layers share a muscle's force: the hypodermis takes it, but
    where the layers lie close together the whole column does.
    """

    rest: FloatArray
    grip: FloatArray
    inverse_mass: FloatArray
    damping: float
    springs: Springs
    anchors: Anchors
    prisms: Prisms
    plate: Plate
    pressure: Pressure
    contacts: Contacts


class Skull(NamedTuple):
    """The skull side of a face as the jaw stands: shapes (3, n) unless said.

    Attributes:
        targets: Where the hypodermis is anchored.
        bone: Foot of each pressure column.
        normals: Outward normals of the skull.
        load: Dead load, with the muscles' forces in mode "rest" added, shape (3, nodes).
        travel: How far the targets go, evenly, in the tick at whose end they are where they are.
    """

    targets: FloatArray
    bone: FloatArray
    normals: FloatArray
    load: FloatArray
    travel: FloatArray


class Pull(NamedTuple):
    """Muscles whose weights and directions follow the moving skin (mode "current").

    One row a muscle that is active; empty in mode "rest".

    Attributes:
        kinds: 0 linear, 1 sphincter, 2 sheet, shape (m,).
        shape: Geometry, shape (m, 21); see `engine.force_basis`.
        scale: Force scale times activation, shape (m,).
        share: Each node's share of the muscle, shape (m, n).
    """

    kinds: IndexArray
    shape: FloatArray
    scale: FloatArray
    share: FloatArray


class Scratch(NamedTuple):
    """Where the force loops keep what one of them hands to the next.

    Attributes:
        tension: Of each spring, shape (3, springs).
        terms: Of each element, shape (9, elements).
    """

    tension: FloatArray
    terms: FloatArray


def scratch_for(tissue: Tissue) -> Scratch:
    """Return scratch arrays for the forces of `tissue`."""
    return Scratch(
        np.zeros((3, len(tissue.springs.first))), np.zeros((9, len(tissue.prisms.corners)))
    )


class Workspace(NamedTuple):
    """Scratch arrays of one thread, so that no step allocates."""

    scratch: Scratch
    force: FloatArray
    x: FloatArray
    v: FloatArray
    slope_x: FloatArray
    slope_v: FloatArray


def workspace(tissue: Tissue) -> Workspace:
    """Return scratch arrays for a face of `tissue`."""
    shape = tissue.rest.shape
    return Workspace(scratch_for(tissue), *(np.zeros(shape) for _ in range(5)))


@kernel
def add_spring_forces(
    x: FloatArray, springs: Springs, tension: FloatArray, force: FloatArray
) -> None:
    """Add Σ_j k (|d| - d0) d/|d| at each node (Eqs. 19-20) to `force`.

    First every spring's d, then its tension, then both of its ends, spring by spring. Apart, the
    loop in the middle is vector code; the last has one order, so the bits do not depend on
    anything else that runs. Indices are cast because a signed one might count from the end.
    """
    first, second = springs.first, springs.second
    rest, low, high, guard = springs.rest, springs.low, springs.high, springs.guard
    threshold, guard_strain = springs.threshold, springs.guard_strain
    for c in range(3):
        row, out = x[c], tension[c]
        for s in range(first.shape[0]):
            out[s] = row[np.uint32(second[s])] - row[np.uint32(first[s])]
    t0, t1, t2 = tension[0], tension[1], tension[2]
    if springs.literal:
        for s in range(first.shape[0]):
            dx, dy, dz = t0[s], t1[s], t2[s]
            length = math.sqrt(dx * dx + dy * dy + dz * dz)
            stretch = length - rest[s]
            stiffness = low[s] if stretch <= threshold * rest[s] else high[s]  # Eq. 20
            pull = stiffness * stretch + guard[s] * min(stretch + guard_strain * rest[s], 0.0)
            pull /= length
            t0[s], t1[s], t2[s] = pull * dx, pull * dy, pull * dz
    else:
        for s in range(first.shape[0]):
            dx, dy, dz = t0[s], t1[s], t2[s]
            length = math.sqrt(dx * dx + dy * dy + dz * dz)
            stretch = length - rest[s]
            pull = (
                low[s] * stretch
                + (high[s] - low[s]) * max(stretch - threshold * rest[s], 0.0)
                + guard[s] * min(stretch + guard_strain * rest[s], 0.0)
            ) / length
            t0[s], t1[s], t2[s] = pull * dx, pull * dy, pull * dz
    f0, f1, f2 = force[0], force[1], force[2]
    for s in range(first.shape[0]):
        i, j = np.uint32(first[s]), np.uint32(second[s])
        f0[i] += t0[s]
        f1[i] += t1[s]
        f2[i] += t2[s]
        f0[j] -= t0[s]
        f1[j] -= t1[s]
        f2[j] -= t2[s]


@kernel
def add_anchor_forces(
    x: FloatArray, anchors: Anchors, skull: Skull, behind: float, force: FloatArray
) -> None:
    """Add the skull's hold on the hypodermis to `force`.

    Elastic ties, stiffer when overstretched, and a one-sided wall where the skull begins; the
    targets are the share `behind` of their travel short of where they will be.
    """
    targets, normals, travel = skull.targets, skull.normals, skull.travel
    n = targets.shape[1]
    base = x.shape[1] - n
    for a in range(n):
        i = base + a
        ux = targets[0, a] - behind * travel[0, a] - x[0, i]
        uy = targets[1, a] - behind * travel[1, a] - x[1, i]
        uz = targets[2, a] - behind * travel[2, a] - x[2, i]
        nx, ny, nz = normals[0, a], normals[1, a], normals[2, a]
        depth = ux * nx + uy * ny + uz * nz
        along = anchors.tangential[a]
        across = (anchors.normal[a] - along) * depth
        distance = math.sqrt(ux * ux + uy * uy + uz * uz)
        if distance > anchors.excess_distance:
            along += (
                anchors.excess * anchors.tangential[a] * (1.0 - anchors.excess_distance / distance)
            )
        if depth > anchors.skull_gap:
            across += anchors.skull * anchors.normal[a] * (depth - anchors.skull_gap)
        force[0, i] += along * ux + across * nx
        force[1, i] += along * uy + across * ny
        force[2, i] += along * uz + across * nz


def volume_gradients(nodes: FloatArray, corners: IndexArray) -> FloatArray:
    """Return ∂V/∂x of each element's six nodes, upper face first, mm², shape (e, 6, 3).

    Args:
        nodes: Positions, mm, shape (nodes, 3).
        corners: As in `Prisms`.
    """
    upper, lower = nodes[corners], nodes[corners + len(nodes) // 3]
    middle, height = 0.5 * (upper + lower), (upper - lower).mean(axis=1)
    p, r = middle[:, 1] - middle[:, 0], middle[:, 2] - middle[:, 0]
    by_p, by_r = 0.25 * np.cross(r, height), 0.25 * np.cross(height, p)
    turn = np.stack([-by_p - by_r, by_p, by_r], axis=1)
    rise = np.cross(p, r)[:, None] / 6.0
    return np.concatenate([turn + rise, turn - rise], axis=1)


@kernel
def add_prism_forces(x: FloatArray, prisms: Prisms, terms: FloatArray, force: FloatArray) -> None:
    """Keep the volume of each element between two layers, and the order of the layers.

    V = A·h with A = ½ p x r of the triangle half way between the layers and h the mean of the
    three columns; the force is minus the gradient of ½ k (V/V0 - 1)², steeper where an element
    is nearly flat and level beyond `LEAST_VOLUME` and `MOST_VOLUME`. An element cannot be inverted
    without passing V = 0.

    In three loops for the same reason as the springs. `terms`, shape (9, elements), takes p, r and
    h, then the force of the second and of the third corner that turns the middle triangle, and the
    force along its normal.
    """
    first, second, third = prisms.corners[:, 0], prisms.corners[:, 1], prisms.corners[:, 2]
    n, count = np.uint32(x.shape[1] // 3), first.shape[0]
    for k in range(3):
        row, p, r, h = x[k], terms[k], terms[3 + k], terms[6 + k]
        for e in range(count):
            a, b, c = np.uint32(first[e]), np.uint32(second[e]), np.uint32(third[e])
            up_a, up_b, up_c = row[a], row[b], row[c]
            low_a, low_b, low_c = row[a + n], row[b + n], row[c + n]
            p[e] = 0.5 * (up_b + low_b - up_a - low_a)
            r[e] = 0.5 * (up_c + low_c - up_a - low_a)
            h[e] = (up_a + up_b + up_c - low_a - low_b - low_c) / 3.0
    _prism_terms(prisms, terms)
    for k in range(3):
        out, by_b, by_c, rise = force[k], terms[k], terms[3 + k], terms[6 + k]
        for e in range(count):
            a, b, c = np.uint32(first[e]), np.uint32(second[e]), np.uint32(third[e])
            out[a] += rise[e] - by_b[e] - by_c[e]
            out[b] += rise[e] + by_b[e]
            out[c] += rise[e] + by_c[e]
            out[a + n] -= rise[e] + by_b[e] + by_c[e]
            out[b + n] += by_b[e] - rise[e]
            out[c + n] += by_c[e] - rise[e]


@kernel
def _prism_terms(prisms: Prisms, terms: FloatArray) -> None:
    """Turn p, r and h of each element into its forces, in place; see `add_prism_forces`."""
    px, py, pz = terms[0], terms[1], terms[2]
    rx, ry, rz = terms[3], terms[4], terms[5]
    hx, hy, hz = terms[6], terms[7], terms[8]
    volume, stiffness, order, least = prisms.volume, prisms.stiffness, prisms.order, prisms.least
    for e in range(volume.shape[0]):
        p0, p1, p2 = px[e], py[e], pz[e]
        r0, r1, r2 = rx[e], ry[e], rz[e]
        h0, h1, h2 = hx[e], hy[e], hz[e]
        n0 = 0.5 * (p1 * r2 - p2 * r1)
        n1 = 0.5 * (p2 * r0 - p0 * r2)
        n2 = 0.5 * (p0 * r1 - p1 * r0)
        share = (n0 * h0 + n1 * h1 + n2 * h2) / volume[e]
        share = min(max(share, LEAST_VOLUME), MOST_VOLUME)
        pressed = min(share - least, 0.0)
        push = -stiffness[e] / volume[e] * ((share - 1.0) - order[e] * pressed * pressed)
        # Quarters: A's half, and each corner of the middle triangle is the mean of two nodes.
        turn, rise = 0.25 * push, push / 3.0
        px[e], py[e], pz[e] = (
            turn * (r1 * h2 - r2 * h1),
            turn * (r2 * h0 - r0 * h2),
            turn * (r0 * h1 - r1 * h0),
        )
        rx[e], ry[e], rz[e] = (
            turn * (h1 * p2 - h2 * p1),
            turn * (h2 * p0 - h0 * p2),
            turn * (h0 * p1 - h1 * p0),
        )
        hx[e], hy[e], hz[e] = rise * n0, rise * n1, rise * n2


@kernel
def add_plate_forces(
    x: FloatArray, rest: FloatArray, plate: Plate, scratch: FloatArray, force: FloatArray
) -> None:
    """Resist bending of the epidermis: -K (x - rest), K sparse; `scratch` takes x - rest."""
    start, columns, values = plate.start, plate.columns, plate.values
    u0, u1, u2 = scratch[0], scratch[1], scratch[2]
    for i in range(start.shape[0] - 1):
        u0[i], u1[i], u2[i] = x[0, i] - rest[0, i], x[1, i] - rest[1, i], x[2, i] - rest[2, i]
    for i in range(start.shape[0] - 1):
        fx = fy = fz = 0.0
        for q in range(start[i], start[i + 1]):
            j, k = columns[q], values[q]
            fx += k * u0[j]
            fy += k * u1[j]
            fz += k * u2[j]
        force[0, i] -= fx
        force[1, i] -= fy
        force[2, i] -= fz


@kernel
def column_middle(x: FloatArray, a: int, n: int) -> tuple[float, float, float]:
    """Return the mean of the three layers' nodes at epidermis node `a`."""
    return (
        (x[0, a] + x[0, a + n] + x[0, a + 2 * n]) / 3.0,
        (x[1, a] + x[1, a + n] + x[1, a + 2 * n]) / 3.0,
        (x[2, a] + x[2, a + n] + x[2, a + 2 * n]) / 3.0,
    )


@kernel
def add_pressure_forces(
    x: FloatArray, bone: FloatArray, pressure: Pressure, force: FloatArray
) -> None:
    """Keep the volume of each column of fat between the mid-surface and the bone.

    V = a·d with a = ½ p x r of the quad's diagonals and d from bone to mid-surface; the force is
    minus the gradient of ½ k (V/V0 - 1)².
    """
    quads = pressure.quads
    n = bone.shape[1]
    for q in range(quads.shape[0]):
        c0, c1, c2, c3 = quads[q, 0], quads[q, 1], quads[q, 2], quads[q, 3]
        x0, y0, z0 = column_middle(x, c0, n)
        x1, y1, z1 = column_middle(x, c1, n)
        x2, y2, z2 = column_middle(x, c2, n)
        x3, y3, z3 = column_middle(x, c3, n)
        dx = 0.25 * (x0 + x1 + x2 + x3 - bone[0, c0] - bone[0, c1] - bone[0, c2] - bone[0, c3])
        dy = 0.25 * (y0 + y1 + y2 + y3 - bone[1, c0] - bone[1, c1] - bone[1, c2] - bone[1, c3])
        dz = 0.25 * (z0 + z1 + z2 + z3 - bone[2, c0] - bone[2, c1] - bone[2, c2] - bone[2, c3])
        px, py, pz = x2 - x0, y2 - y0, z2 - z0
        rx, ry, rz = x3 - x1, y3 - y1, z3 - z1
        ax = 0.5 * (py * rz - pz * ry)
        ay = 0.5 * (pz * rx - px * rz)
        az = 0.5 * (px * ry - py * rx)
        volume = ax * dx + ay * dy + az * dz
        push = -pressure.stiffness[q] / pressure.volume[q] * (volume / pressure.volume[q] - 1.0)
        gpx = 0.5 * (ry * dz - rz * dy)
        gpy = 0.5 * (rz * dx - rx * dz)
        gpz = 0.5 * (rx * dy - ry * dx)
        grx = 0.5 * (dy * pz - dz * py)
        gry = 0.5 * (dz * px - dx * pz)
        grz = 0.5 * (dx * py - dy * px)
        for k in range(4):
            along_p = 1.0 if k == 2 else (-1.0 if k == 0 else 0.0)
            along_r = 1.0 if k == 3 else (-1.0 if k == 1 else 0.0)
            fx = push * (0.25 * ax + along_p * gpx + along_r * grx) / 3.0
            fy = push * (0.25 * ay + along_p * gpy + along_r * gry) / 3.0
            fz = push * (0.25 * az + along_p * gpz + along_r * grz) / 3.0
            a = quads[q, k]
            for layer in range(3):
                force[0, a + layer * n] += fx
                force[1, a + layer * n] += fy
                force[2, a + layer * n] += fz


@kernel
def longitudinal(along: float, reach: float, strength: float) -> float:
    """Return Θ1 of one point (Eqs. 7, 15); the twin of `muscle.longitudinal_profile`."""
    if along < 0.0 or along > reach:
        return 0.0
    power = along**strength
    if along <= 1.0:
        return math.cos((1.0 - power) * (math.pi / 2.0))
    return math.cos((power - 1.0) / (reach**strength - 1.0) * (math.pi / 2.0))


@kernel
def ring_weight(rx: float, ry: float, rz: float, g: FloatArray) -> float:
    """Return Θ(r) at an offset from a sphincter's plane point (Eqs. 11-12), 0 outside its zone."""
    out = rx * g[16] + ry * g[17] + rz * g[18]
    across = (rx * g[3] + ry * g[4] + rz * g[5]) / g[12]
    up = (rx * g[6] + ry * g[7] + rz * g[8]) / g[13]
    radius = math.sqrt(across * across + up * up)
    if radius > 1.0 or abs(out) >= g[19]:
        return 0.0
    if g[14] > 0.0:
        weight = math.cos((1.0 - radius) * (math.pi / 2.0))
    elif radius <= g[15]:
        weight = math.sin(radius / g[15] * (math.pi / 2.0))
    else:
        weight = math.cos((radius - g[15]) / (1.0 - g[15]) * (math.pi / 2.0))
    if g[20] > 0.0:
        safe = max(radius, 1e-9)
        sine, cosine = g[12] * up / safe, g[13] * across / safe
        bend = max(sine * sine + cosine * cosine, min(g[12], g[13]) ** 2)
        curvature = (g[13] * g[13] / bend) ** 1.5
        weight *= (1.0 - g[20]) + g[20] * curvature
    return weight


@kernel
def sheet_weight(rx: float, ry: float, rz: float, g: FloatArray) -> float:
    """Return Θ(λ) at an offset from a sheet's attachment (Eqs. 15-17), 0 outside its width W."""
    across = rx * g[9] + ry * g[10] + rz * g[11]
    if g[14] > 0.0 and across < 0.0:
        fade = 0.0
    else:
        fade = min(max((abs(across) / g[12] - (1.0 - g[13])) / (2.0 * g[13]), 0.0), 1.0)
    if fade >= 1.0:
        return 0.0
    weight = longitudinal(-(rx * g[3] + ry * g[4] + rz * g[5]) / g[6], g[7], g[8])
    return weight * math.cos(fade * math.pi / 2.0) ** 2


@kernel
def add_muscle_forces(x: FloatArray, pull: Pull, grip: FloatArray, force: FloatArray) -> None:
    """Add the muscles' forces at the skin's present place (mode "current", Eqs. 1-17).

    Weights come from the epidermis point; the force acts on the nodes under it, as `grip` shares
    it out.
    """
    n = pull.share.shape[1]
    for m in range(pull.kinds.shape[0]):
        g = pull.shape[m]
        for i in range(n):
            share = pull.share[m, i] * pull.scale[m]
            if share == 0.0:
                continue
            rx, ry, rz = x[0, i] - g[0], x[1, i] - g[1], x[2, i] - g[2]
            if pull.kinds[m] == 0:
                distance = max(math.sqrt(rx * rx + ry * ry + rz * rz), 1e-9)
                cosine = (rx * g[3] + ry * g[4] + rz * g[5]) / distance
                across = math.acos(min(max(cosine, -1.0), 1.0)) / g[7]
                if across > 1.0:
                    continue
                weight = longitudinal(distance / g[6], g[8], g[9])
                weight *= math.cos(g[7] * across) * math.cos(across * (math.pi / 2.0))
                dx, dy, dz = -rx / distance, -ry / distance, -rz / distance
            elif pull.kinds[m] == 1:
                weight = ring_weight(rx, ry, rz, g)
                dx, dy, dz = g[9] - x[0, i], g[10] - x[1, i], g[11] - x[2, i]
                distance = max(math.sqrt(dx * dx + dy * dy + dz * dz), 1e-9)
                dx, dy, dz = dx / distance, dy / distance, dz / distance
            else:
                weight = sheet_weight(rx, ry, rz, g)
                dx, dy, dz = g[3], g[4], g[5]
            if weight == 0.0:
                continue
            for layer in range(3):
                hold = share * weight * grip[layer, i]
                force[0, layer * n + i] += hold * dx
                force[1, layer * n + i] += hold * dy
                force[2, layer * n + i] += hold * dz


@kernel
def add_basis_forces(
    basis: FloatArray, grip: FloatArray, activations: FloatArray, force: FloatArray
) -> None:
    """Add the muscles' rest-pose forces (mode "rest"): Σ a_m B_m, shared out to the layers.

    In the order of the muscles, whatever library or thread count: the same bits everywhere.
    """
    n = basis.shape[2]
    for m in range(basis.shape[0]):
        a = activations[m]
        if a == 0.0:
            continue
        for c in range(3):
            for layer in range(3):
                for i in range(n):
                    force[c, layer * n + i] += a * grip[layer, i] * basis[m, c, i]


@kernel
def put(target: FloatArray, values: FloatArray) -> None:
    """Set `target` to `values`.

    Written out: for `target[:] = values` numba compiles the sentence it might have to fail with,
    which takes as long as all forces together.
    """
    for c in range(values.shape[0]):
        for i in range(values.shape[1]):
            target[c, i] = values[c, i]


@kernel
def clear(target: FloatArray) -> None:
    """Set `target` to 0."""
    for c in range(target.shape[0]):
        for i in range(target.shape[1]):
            target[c, i] = 0.0


@kernel
def static_forces(
    x: FloatArray,
    tissue: Tissue,
    skull: Skull,
    pull: Pull,
    scratch: Scratch,
    force: FloatArray,
    behind: float = 0.0,
) -> None:
    """Set `force` to f - Q of Eq. 21: everything that acts on the nodes but damping.

    `behind` is the share of the tick that is still to come.
    """
    put(force, skull.load)
    add_spring_forces(x, tissue.springs, scratch.tension, force)
    add_anchor_forces(x, tissue.anchors, skull, behind, force)
    add_prism_forces(x, tissue.prisms, scratch.terms, force)
    if tissue.plate.values.shape[0] > 0:
        add_plate_forces(x, tissue.rest, tissue.plate, scratch.tension, force)
    add_pressure_forces(x, skull.bone, tissue.pressure, force)
    if pull.kinds.shape[0] > 0:
        add_muscle_forces(x, pull, tissue.grip, force)


@kernel
def accelerations(
    x: FloatArray,
    v: FloatArray,
    tissue: Tissue,
    skull: Skull,
    pull: Pull,
    scratch: Scratch,
    out: FloatArray,
    behind: float,
) -> None:
    """Set `out` to ẍ = M⁻¹ (f - Q) - c ẋ (Eqs. 21-22); fixed nodes have inverse mass 0."""
    static_forces(x, tissue, skull, pull, scratch, out, behind)
    damping = tissue.damping
    for c in range(3):
        for i in range(x.shape[1]):
            inverse = tissue.inverse_mass[i]
            out[c, i] = out[c, i] * inverse - damping * v[c, i] if inverse > 0.0 else 0.0


@kernel
def shift(target: FloatArray, base: FloatArray, slope: FloatArray, dt: float) -> None:
    """Set `target` to `base` + dt `slope`."""
    for c in range(3):
        for i in range(base.shape[1]):
            target[c, i] = base[c, i] + dt * slope[c, i]


@kernel
def runge_kutta_stage(
    x: FloatArray, v: FloatArray, ahead: float, share: float, work: Workspace
) -> None:
    """Take this stage's slope into the step with `share`; stand `ahead` of the start with it."""
    for c in range(3):
        for i in range(x.shape[1]):
            speed, slope = work.v[c, i], work.force[c, i]
            work.slope_x[c, i] += share * speed
            work.slope_v[c, i] += share * slope
            work.x[c, i] = x[c, i] + ahead * speed
            work.v[c, i] = v[c, i] + ahead * slope


@kernel
def resolve_lips(
    x: FloatArray, v: FloatArray, inverse_mass: FloatArray, contacts: Contacts
) -> None:
    """Keep each upper-lip node above its partner, in position and velocity."""
    for q in range(contacts.upper_lip.shape[0]):
        i, j = contacts.upper_lip[q], contacts.lower_lip[q]
        overlap = contacts.lip_gap[q] - (x[1, i] - x[1, j])
        total = inverse_mass[i] + inverse_mass[j]
        if overlap > 0.0 and total > 0.0:
            share = inverse_mass[i] / total
            x[1, i] += overlap * share
            x[1, j] -= overlap * (1.0 - share)
            closing = v[1, i] - v[1, j]
            if closing < 0.0:
                v[1, i] -= closing * share
                v[1, j] += closing * (1.0 - share)


@kernel
def resolve_teeth(x: FloatArray, v: FloatArray, contacts: Contacts) -> None:
    """Keep the lips before the upper dental arch, pushing along the arch's own normal.

    Pushed straight forward, a lip corner on the steep side of the arch gains energy and chatters.
    """
    arch = contacts.arch
    for q in range(contacts.tooth_nodes.shape[0]):
        i = contacts.tooth_nodes[q]
        lateral = abs(x[0, i])
        if not lateral < arch.shape[0] - 1:  # also true for NaN, which has no cell
            continue
        cell = int(lateral)
        slope = arch[cell + 1] - arch[cell]
        front = arch[cell] + (lateral - cell) * slope + contacts.tooth_clearance[q]
        # Level in the middle: a kink there would push the midline to one side.
        nx = -slope * min(max(x[0, i], -1.0), 1.0)
        ny = 0.0
        below = contacts.arch_bottom - x[1, i]
        if below > -ARCH_ROUND_MM:
            # Below the edge of the upper teeth a dropping lower lip may swing back with the jaw.
            # The edge is round: over a sharp one a lip that is sucked in snaps.
            past = min(below + ARCH_ROUND_MM, 2.0 * ARCH_ROUND_MM) / (2.0 * ARCH_ROUND_MM)
            fallen = ARCH_ROUND_MM * past * past + max(below - ARCH_ROUND_MM, 0.0)
            front -= fallen * contacts.arch_fall
            ny = -contacts.arch_fall * past
        inside = front - x[2, i]
        if inside > 0.0:
            squared = nx * nx + ny * ny + 1.0
            push = inside / squared
            x[0, i] += push * nx
            x[1, i] += push * ny
            x[2, i] += push
            inwards = (v[0, i] * nx + v[1, i] * ny + v[2, i]) / squared
            if inwards < 0.0:
                v[0, i] -= inwards * nx
                v[1, i] -= inwards * ny
                v[2, i] -= inwards


@kernel
def resolve_eyes(x: FloatArray, v: FloatArray, contacts: Contacts) -> None:
    """Keep the lids outside the eyeballs; they slide on them."""
    for q in range(contacts.eye_nodes.shape[0]):
        i = contacts.eye_nodes[q]
        cx, cy, cz = (
            contacts.eye_centers[0, q],
            contacts.eye_centers[1, q],
            contacts.eye_centers[2, q],
        )
        dx, dy, dz = x[0, i] - cx, x[1, i] - cy, x[2, i] - cz
        distance = math.sqrt(dx * dx + dy * dy + dz * dz)
        if distance < contacts.eye_radius[q]:
            scale = contacts.eye_radius[q] / distance
            x[0, i], x[1, i], x[2, i] = cx + dx * scale, cy + dy * scale, cz + dz * scale
            inwards = (v[0, i] * dx + v[1, i] * dy + v[2, i] * dz) / (distance * distance)
            if inwards < 0.0:
                v[0, i] -= inwards * dx
                v[1, i] -= inwards * dy
                v[2, i] -= inwards * dz


@kernel
def resolve_contacts(x: FloatArray, v: FloatArray, tissue: Tissue) -> None:
    """Put back every node that has passed what it may not."""
    resolve_lips(x, v, tissue.inverse_mass, tissue.contacts)
    resolve_teeth(x, v, tissue.contacts)
    resolve_eyes(x, v, tissue.contacts)


@kernel
def kick(v: FloatArray, force: FloatArray, tissue: Tissue, dt: float) -> None:
    """Take `force` and damping into the velocities: v' - v = dt (f/m - c (v' + v)/2).

    Nodes without mass are moved, not pushed: theirs stay.
    """
    half = 0.5 * dt * tissue.damping
    keep, gain = (1.0 - half) / (1.0 + half), dt / (1.0 + half)
    for c in range(3):
        for i in range(v.shape[1]):
            inverse = tissue.inverse_mass[i]
            if inverse > 0.0:
                v[c, i] = keep * v[c, i] + gain * inverse * force[c, i]


@kernel
def advance_verlet(
    x: FloatArray,
    v: FloatArray,
    substeps: int,
    dt: float,
    tissue: Tissue,
    skull: Skull,
    pull: Pull,
    work: Workspace,
) -> None:
    """Move one face by `substeps` steps of position Verlet: half a drift, a kick, half a drift.

    Forces are taken once a step, half way. Two half drifts in a row are one, so that contact is
    resolved where forces are taken, and once more at the end.
    """
    shift(x, x, v, 0.5 * dt)
    resolve_contacts(x, v, tissue)
    for step in range(substeps):
        behind = 1.0 - (step + 0.5) / substeps
        static_forces(x, tissue, skull, pull, work.scratch, work.force, behind)
        kick(v, work.force, tissue, dt)
        shift(x, x, v, 0.5 * dt if step == substeps - 1 else dt)
        resolve_contacts(x, v, tissue)


@kernel
def advance(
    x: FloatArray,
    v: FloatArray,
    substeps: int,
    dt: float,
    tableau: FloatArray,
    tissue: Tissue,
    skull: Skull,
    pull: Pull,
    work: Workspace,
) -> None:
    """Move one face by `substeps` steps of `dt` seconds: integrate, then contact.

    `x` and `v`, shape (3, nodes), are overwritten; `tableau` is one of `TABLEAUS`. Nodes without
    mass go as their velocity says. Contact is resolved every substep, with the velocity mended
    too: once a frame, lips chatter.
    """
    if tableau.shape[1] == 1:
        advance_verlet(x, v, substeps, dt, tissue, skull, pull, work)
        return
    stages = tableau.shape[0]
    for step in range(substeps):
        behind = 1.0 - (step + 0.5) / substeps
        put(work.x, x)
        put(work.v, v)
        clear(work.slope_x)
        clear(work.slope_v)
        for stage in range(max(stages, 1)):
            accelerations(work.x, work.v, tissue, skull, pull, work.scratch, work.force, behind)
            if stages > 0:
                ahead, share = tableau[stage, 0] * dt, tableau[stage, 1] * dt
                runge_kutta_stage(x, v, ahead, share, work)
        if stages > 0:
            shift(x, x, work.slope_x, 1.0)
            shift(v, v, work.slope_v, 1.0)
        else:
            shift(v, v, work.force, dt)
            shift(x, x, v, dt)
        resolve_contacts(x, v, tissue)
