"""The relief of the skin in millimetres: pores, fine lines, wrinkles; and normals made from it.

Depths are of the order that profilometry of skin gives: pores and the net of fine lines some
hundredths of a millimetre, lip furrows a tenth, wrinkles up to one.
"""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import numpy.typing as npt

from ...arrays import Float32Array, FloatArray
from ...compiling import kept
from ..noise import cell_edges, hashed, spot_noise, value_noise
from ..recipe import Recipe
from .texels import Texels
from .zones import Zones

OLD = (28.0, 75.0)
"""Ages between which lines stay when the face is at rest."""
STAYING = 0.8
"""Share of a wrinkle's depth that stays on the oldest face."""
SHADED = ((1.5, 0.6), (4.5, 1.8))
"""A furrow is what lies lower than the skin about so far around it, and gets none of the light from
all around where it is so much lower [mm]; narrow ones, and what lies at the foot of broad rolls."""

_ZONES = ("lip", "beard", "pores", "front", "mouth", "violet", "scalp", "nostril")


def relief(
    texels: Texels, zones: Zones, places: FloatArray, recipe: Recipe
) -> tuple[Float32Array, Float32Array]:
    """Return the skin's height [mm] at rest and with every wrinkle formed, shape (n,) each.

    Args:
        texels: Where they lie.
        zones: Fields over the skin.
        places: Positions of the vertices on the built-in head [mm], shape (d, 3).
        recipe: The person.
    """
    names = [field.name for field in fields(Zones)]
    columns = [names.index(name) for name in _ZONES]
    table = texels.carried(zones.table()[:, columns])
    at = texels.carried(places)
    seed = recipe.seed % 2**20
    fine = _fine_relief(at, table, recipe.sex, seed)
    folds = _folds(at, table, seed)
    age = float(np.clip((recipe.age - OLD[0]) / (OLD[1] - OLD[0]), 0, 1))
    rest = fine + STAYING * age**1.2 * folds
    return rest, np.asarray(fine + np.float32(1.05 + 0.3 * age) * folds)


def creases(texels: Texels, heights: Float32Array, rest: Float32Array) -> npt.NDArray[np.uint8]:
    """Return a relief's normals with, for blue, how open its furrows are; 8 bits, (s, s, 3).

    Blue is 255 where the skin does not fold, and less the deeper a point lies in a furrow: a
    wrinkle's floor sees less light, its walls and the rolls beside it see as much as before.

    Args:
        texels: Where they lie.
        heights: With every wrinkle formed [mm], shape (n,).
        rest: At rest [mm], shape (n,).
    """
    from scipy.ndimage import gaussian_filter  # Here: a start does without.

    found = normals(texels, heights)
    formed = texels.image(heights - rest).astype(np.float32)
    width = float(np.median(texels.width))
    hollow = np.zeros_like(formed)
    for around, dark in SHADED:
        hollow += np.maximum(gaussian_filter(formed, around / width) - formed, 0) / dark
    found[:, :, 2] = (255.5 - 255 * np.clip(hollow, 0, 1)).astype(np.uint8)
    return found


def normals(texels: Texels, heights: Float32Array) -> npt.NDArray[np.uint8]:
    """Return tangent-space normals of a relief as a map of 8 bits, green up, shape (s, s, 3)."""
    height = texels.image(heights).astype(np.float32)
    width = texels.image(texels.width).astype(np.float32)
    across = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) / (2 * width)
    down = (np.roll(height, -1, axis=0) - np.roll(height, 1, axis=0)) / (2 * width)
    steep = np.sqrt(1 + across**2 + down**2)
    normal = np.stack([-across / steep, down / steep, 1 / steep], axis=2)
    return np.asarray((normal * 127.5 + 128).clip(0, 255), dtype=np.uint8)


@kept(nogil=True)
def _fine_relief(
    places: Float32Array, table: Float32Array, sex: float, seed: int
) -> npt.NDArray[np.float32]:
    found = np.empty(len(places), dtype=np.float32)
    for n in range(len(places)):
        x, y, z = float(places[n, 0]), float(places[n, 1]), float(places[n, 2])
        lip_depth, beard, pored, front = table[n, 0], table[n, 1], table[n, 2], table[n, 3]
        wet, thin = table[n, 4], table[n, 5]
        lip = min(max((lip_depth + 0.6) / 1.6, 0.0), 1.0)
        skin = (1 - lip) * (1 - wet)
        n8 = value_noise(x / 8, y / 8, z / 8, seed + 51)
        n3 = value_noise(x / 2.6, y / 2.6, z / 2.6, seed + 52)
        n1 = value_noise(x / 1.0, y / 1.0, z / 1.0, seed + 53)
        height = skin * (0.075 * n8 + 0.045 * n3 + 0.024 * n1) * (1 + 0.5 * pored)
        # The net of fine lines, coarser where skin is thick, drawn along under the eyes.
        scale = 1.15 if thin < 0.2 else 0.8
        bend = 0.35 * n3
        net = cell_edges((x + bend) / scale, (y + bend) / scale, z / scale, seed + 54)
        height -= skin * (0.034 + 0.014 * front) * np.exp(-((net / 0.16) ** 2))
        if pored > 0.05:
            pore = spot_noise(x / 1.02, y / 1.02, z / 1.02, 0.6, 0.16, 0.34, seed + 26)
            height -= skin * 0.115 * pored * min(pore * 1.5, 1.0)
        if beard > 0.05:
            root = spot_noise(x / 0.95, y / 0.95, z / 0.95, 0.8, 0.15, 0.3, seed + 41)
            height += skin * 0.04 * beard * sex * root
        if lip > 0:
            bend = 0.5 * n3
            line = value_noise((x + bend) / 0.85, y / 5.5, z / 5.5, seed + 31)
            fine = value_noise((x + bend) / 1.5, y / 7.0, z / 7.0, seed + 55)
            furrow = np.exp(-((line / 0.28) ** 2)) * 0.09 + np.exp(-((fine / 0.22) ** 2)) * 0.11
            height -= lip * furrow * (1 - wet) * min(1.0, 0.35 + lip_depth / 4)
        found[n] = height
    return found


@kept(nogil=True)
def _groove(noise: float, spacing: float, width: float) -> float:
    """Return the profile of a line where noise crosses zero: 1 at its bottom, raised beside it."""
    gap = noise * spacing / width
    return float(np.exp(-gap * gap) - 0.32 * np.exp(-((abs(gap) - 2.0) ** 2)))


@kept(nogil=True)
def _crease(gap: float, width: float) -> float:
    """Return the profile of a crease between two rolls of skin: sharp below, rounded above."""
    apart = abs(gap) / width
    return float(0.62 * np.exp(-apart * apart) + 0.42 * np.exp(-apart / 3.2))


@kept(nogil=True)
def _rolls(gap: float, spacing: float, width: float) -> float:
    """Return the profile of a furrow between soft rolls, each as broad as furrows lie apart.

    Args:
        gap: Distance from the furrow [mm].
        spacing: From furrow to furrow [mm]; halfway the roll is highest, and the profile ends.
        width: Of the furrow's floor [mm].
    """
    turn = np.pi * gap / spacing
    if abs(turn) > np.pi / 2:
        return 0.0
    round_floor = np.pi * width / spacing
    fall = np.sqrt(np.sin(turn) ** 2 + round_floor**2) - round_floor
    whole = np.sqrt(1 + round_floor**2) - round_floor
    return float(0.8 * (1 - fall / whole) + 0.2 * np.exp(-((gap / width) ** 2)))


@kept(nogil=True)
def cheek_step(gap: float) -> tuple[float, float]:
    """Return the fold beside the mouth: the cheek's roll over the lip's side, and the valley.

    Args:
        gap: Distance from the fold [mm], towards the cheek.

    Returns:
        Height of the roll, 0 on the lip and 1 at its crest, and depth of the valley, 0..1.
    """
    roll = _ramp(-1.2, 4.8, gap) * np.exp(-((max(gap - 3.6, 0.0) / 5.6) ** 2))
    width = 0.9 if gap > 0 else 2.0
    return float(roll), float(np.exp(-((gap / width) ** 2)))


@kept(nogil=True)
def dimples(x: float, y: float, z: float, seed: int) -> float:
    """Return how deep a point lies in scattered shallow pits: 0 between, about 1 in a deep one.

    Lengths are in units of the pits' spacing. Pits have no rim, and differ in size and depth.
    """
    i, j, k = int(np.floor(x)), int(np.floor(y)), int(np.floor(z))
    depth = 0.0
    for di in range(-1, 2):
        for dj in range(-1, 2):
            for dk in range(-1, 2):
                a, b, c = i + di, j + dj, k + dk
                dx = a + 0.15 + 0.7 * hashed(a, b, c, seed + 2) - x
                dy = b + 0.15 + 0.7 * hashed(a, b, c, seed + 3) - y
                dz = c + 0.15 + 0.7 * hashed(a, b, c, seed + 4) - z
                radius = 0.28 + 0.16 * hashed(a, b, c, seed + 1)
                share = 0.35 + 0.65 * hashed(a, b, c, seed)
                away = (dx * dx + dy * dy + dz * dz) / (radius * radius)
                depth += share * np.exp(-away)
    return float(depth)


@kept(nogil=True)
def _ramp(low: float, high: float, value: float) -> float:
    share = min(max((value - low) / (high - low), 0.0), 1.0)
    return share * share * (3 - 2 * share)


@kept(nogil=True)
def _spot(x: float, y: float, cx: float, cy: float, width: float, height: float) -> float:
    u, v = (x - cx) / width, (y - cy) / height
    return float(np.exp(-((u * u + v * v) ** 2)))


@kept(nogil=True)
def _own(line: int, kind: float, seed: int) -> float:
    """Return a number in 0..1 of one line of a kind.

    Kinds are counted in fractions: for each whole number in a call, Numba compiles anew.
    """
    return hashed(line, int(kind), 0, seed)


@kept(nogil=True)
def _along(x: float, y: float, curve: FloatArray) -> tuple[float, float]:
    """Return the signed distance from a curve (k, 2), and the share of the way along it."""
    best, sign, share = 1e9, 1.0, 0.0
    for k in range(len(curve) - 1):
        ax, ay = curve[k]
        bx, by = curve[k + 1, 0] - ax, curve[k + 1, 1] - ay
        s = min(max(((x - ax) * bx + (y - ay) * by) / (bx * bx + by * by), 0.0), 1.0)
        dx, dy = x - ax - s * bx, y - ay - s * by
        square = dx * dx + dy * dy
        if square < best:
            best, share = square, (k + s) / (len(curve) - 1)
            sign = 1.0 if bx * dy - by * dx > 0 else -1.0
    return sign * np.sqrt(best), share


_NASOLABIAL = np.array([
    [16.4, -31.0], [18.5, -37.0], [22.0, -44.0], [26.5, -52.0], [31.0, -60.0], [34.5, -69.0],
    [35.5, -78.0],
])  # fmt: skip
_MARIONETTE = np.array([[30.0, -74.0], [32.0, -82.0], [33.0, -91.0], [32.0, -99.0]])
_MENTOLABIAL = np.array([[0.0, -91.0], [8.0, -90.5], [16.0, -89.0], [22.0, -86.5]])
_TEAR = np.array([[13.0, -8.0], [18.0, -14.0], [25.0, -18.5], [34.0, -20.0], [43.0, -18.0]])


@kept(nogil=True)
def _folds(places: Float32Array, table: Float32Array, seed: int) -> npt.NDArray[np.float32]:
    """Return the depth (negative) of fully formed wrinkles [mm], shape (n,)."""
    found = np.empty(len(places), dtype=np.float32)
    for n in range(len(places)):
        side, y, z = float(places[n, 0]), float(places[n, 1]), float(places[n, 2])
        x = abs(side)
        hidden = max(table[n, 4], table[n, 7])
        lip_depth, scalp = table[n, 0], table[n, 6]
        if z < -30 or hidden > 0.5:
            found[n] = 0.0
            continue
        w6 = value_noise(side / 7, y / 7, z / 7, seed + 61)
        w2 = value_noise(side / 2.3, y / 2.3, z / 2.3, seed + 62)
        depth = 0.0
        left = 0 if side > 0 else 40
        # Forehead: lines across that rise over the brows, break off, fork and fade out.
        mask = _spot(x, y, 0.0, 46.0, 56.0, 26.0)
        if mask > 0.01:
            rise = y - 2.6 * np.sin((x - 8.0) / 17.0) + 0.5 * w6
            rise -= 1.6 * value_noise(side / 24, 3.1, 0.5, seed + 63)
            for k in range(5):
                line = 26.0 + 8.8 * k + 2.0 * _own(k, 1.0, seed)
                gap = rise - line - 0.9 * value_noise(side / 17, 3.1 * k, 0.5, seed + 63)
                if abs(gap) > 9:
                    continue
                whole = 0.62 + 0.95 * value_noise(side / 24, 5.3 * k, 1.5, seed + 64)
                whole = min(max(whole, 0.0), 1.0) * (0.65 + 0.35 * _own(k, 2.0, seed))
                fork = 3.4 * value_noise(side / 17, 7.7 * k, 2.5, seed + 75)
                depth += mask * 0.95 * whole * _rolls(gap, 9.4, 0.55)
                if fork > 0.2:
                    depth += mask * 0.14 * min(whole, fork) * _crease(gap - fork, 0.42)
        # Glabella: upright lines between the brows, one deeper than the other, and lesser ones.
        mask = _spot(x, y, 0.0, 17.0, 15.0, 17.0)
        if mask > 0.01:
            for k in range(3):
                own = _own(k + left, 3.0, seed)
                middle = (6.3, 10.2, 2.2)[k] + 1.6 * own
                share = (0.80, 0.30, 0.22)[k] * (0.6 + 0.4 * _own(k + left, 4.0, seed))
                top, low = 24.0 + 8 * own - 4 * k, 8.0 - 4 * own + 2 * k
                ends = _ramp(low - 3, low + 4, y) * _ramp(top + 4, top - 5, y)
                gap = x - middle - 0.13 * (y - 14.0) + 0.006 * (y - 16.0) ** 2 + 0.45 * w6
                depth += mask * share * ends * _crease(gap, 0.75 - 0.1 * k)
        # Root of the nose: lines across, and on its sides slanting ones (AU 9).
        mask = _spot(x, y, 0.0, 3.5, 11.5, 9.5)
        if mask > 0.01:
            for k in range(3):
                own = _own(k, 5.0, seed)
                gap = y - (3.6, -1.2, 8.4)[k] - 1.5 * own + 0.018 * x * x + 0.4 * w6
                depth += mask * (0.5, 0.3, 0.22)[k] * _crease(gap, 0.62)
        mask = _spot(x, y, 10.0, -11.0, 6.5, 12.0)
        if mask > 0.01:
            for k in range(4):
                own = _own(k + left, 6.0, seed)
                gap = 0.75 * (y - 0.85 * (x - 9.0) + 3.0 + 3.4 * k + 1.5 * own) + 0.35 * w6
                depth += mask * (0.16 + 0.16 * own) * _crease(gap, 0.48)
        # Crow's feet: rays from the corner of the eye, each of its own length, some forked.
        ray_x, ray_y = x - 43.0, y - 0.5
        reach = np.sqrt(ray_x * ray_x + ray_y * ray_y + (z - 73.0) ** 2 * 0.35)
        if x > 44 and reach < 34:
            angle = np.arctan2(ray_y, ray_x + 0.25 * abs(z - 73.0))
            for k in range(6):
                own = _own(k + left, 7.0, seed)
                other = _own(k + left, 8.0, seed)
                bend = 1 + 0.014 * (reach - 9.0)
                aim = (0.66 - 0.27 * k + 0.16 * (own - 0.5)) * bend
                gap = (angle - aim) * reach + 0.5 * w6 + 0.2 * w2
                if abs(gap) > 6:
                    continue
                long = 18.0 + 11.0 * other - 1.2 * abs(k - 2.5)
                fan = _ramp(4.5 + 2 * own, 10.0 + 2 * own, reach) * np.exp(-((reach / long) ** 4))
                share = 0.42 + 0.34 * own
                depth += fan * share * _crease(gap, 0.46 + 0.012 * reach)
                if other > 0.45:
                    fork = 0.30 * max(reach - 10.0, 0.0) * (1 if own > 0.5 else -1)
                    apart = min(abs(fork), 1.0)
                    depth += 0.55 * apart * fan * share * _crease(gap - fork, 0.42)
        # Lower lid: fine lines below the lashes that follow it outwards, and the tear trough.
        mask = _spot(x, y, 32.0, -10.5, 17.0, 6.0)
        if mask > 0.01:
            follow = y + 0.012 * (x - 31.0) ** 2 + 0.25 * w6
            lines = value_noise(side / 17 + 0.08 * w2, follow / 2.6, z / 60, seed + 70)
            depth += mask * 0.24 * _groove(lines, 2.6, 0.42)
        # The bag that a raised cheek pushes up below them, and the crease at its foot.
        mask = _spot(x, y, 32.0, -11.0, 15.0, 11.0)
        if mask > 0.01:
            below = 10.2 - 0.014 * (x - 31.0) ** 2 + y + 0.3 * w6
            foot = _ramp(15.0, 27.0, x) * np.exp(-(((below + 4.8) / 1.1) ** 2))
            depth += mask * (0.3 * foot - 0.55 * np.exp(-((below / 3.2) ** 2)))
        gap, share = _along(x, y, _TEAR)
        depth += 0.16 * np.exp(-((gap / 1.7) ** 2)) * np.sin(np.pi * min(max(share, 0.0), 1.0))
        # Fold from nose to mouth, the corner's line below it, and lines beside both.
        gap, share = _along(x, y, _NASOLABIAL)
        if abs(gap) < 16:
            gap += 0.6 * w6 + 0.12 * w2
            whole = _ramp(0.0, 0.2, share) * _ramp(1.0, 0.5, share) * (1 - 0.4 * share)
            roll, valley = cheek_step(gap)
            uneven = 0.75 + 0.45 * value_noise(5 * share, float(left), 0.5, seed + 78)
            depth += whole * (0.65 * uneven * valley - 1.9 * roll)
            beside = gap - 5.5 - 1.6 * _own(left, 9.0, seed) - 3.0 * (share - 0.8)
            depth += 0.14 * _ramp(0.4, 0.7, share) * _ramp(1.0, 0.8, share) * _crease(beside, 0.6)
        gap, share = _along(x, y, _MARIONETTE)
        depth += 0.4 * np.exp(-(((gap + 0.3 * w6) / 1.0) ** 2)) * np.sin(np.pi * share) ** 0.7
        # Chin: the fold above it, and the dimples of a knotted mentalis.
        gap, share = _along(x, y, _MENTOLABIAL)
        depth += 0.45 * np.exp(-(((gap + 0.3 * w6) / 1.5) ** 2)) * (1 - share) ** 0.5
        mask = _spot(x, y, 0.0, -103.0, 17.0, 11.0)
        if mask > 0.01:
            sway = 0.12 * w2
            knot = dimples(side / 3.3 + sway, y / 3.3 + sway, z / 3.3, seed + 72)
            depth += mask * (0.58 * knot * (0.85 + 0.3 * w6) - 0.15 * w6)
        # Lines that purse the lips.
        if lip_depth < 0.5 and x < 26:
            mask = np.exp(-(((lip_depth + 2.5) / 3.2) ** 2)) * (1 - (x / 27) ** 4)
            purse = value_noise((side + 0.5 * w6) / 3.4, y / 30, z / 60, seed + 73)
            depth += mask * 0.30 * _groove(purse, 3.4, 0.5)
        # Rings round the neck.
        if y < -116:
            for k in range(4):
                line = -122.0 - 13.5 * k - 5.0 * _own(k, 10.0, seed)
                sway = 2.5 * value_noise(side / 26, 4.4 * k, 0.5, seed + 74)
                gap = y - line - 0.10 * (z - 40.0) - sway
                whole = 0.55 + 0.8 * value_noise(side / 30, 6.1 * k, 1.5, seed + 77)
                if abs(gap) < 10:
                    depth += 0.40 * min(max(whole, 0.0), 1.0) * _crease(gap, 0.9)
        found[n] = -depth * (1 - min(max(scalp, 0.0), 1.0)) * (1 - hidden)
    return found
