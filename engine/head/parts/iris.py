"""The colours of an eye as one map: an iris of fibres and crypts, a sclera with its vessels.

The iris is a dark pigment sheet under a paler stroma: what little melanin the stroma holds makes it
blue, what more makes it green, hazel and brown, densest round the pupil (Sturm and Larsson,
"Genetics of human iris colour and patterns", 2009). Its forms and where they lie (ruff, pupillary
zone, collarette, crypts, contraction furrows, limbal ring) follow Snell and Lemp, "Clinical Anatomy
of the Eye", 1998.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray, IntArray
from ..anatomy import smoothstep
from ..patches import EYE_RADIUS
from ..recipe import Recipe

SIZE = 512
IRIS_RADIUS = 5.85
"""Visible iris, 11.7 mm across (Snell and Lemp: 11.7 mm horizontally)."""
PUPIL_RADIUS = 1.75
"""Of a pupil in a lit room, mm."""
LIMBUS_WIDTH = 0.95
"""Over which the iris fades into the sclera, mm."""
MAP_POWER = 0.75
"""Radius on the map = 0.5 (angle / 90 degrees) ** this: the iris gets more of it than its share."""


@dataclass(frozen=True)
class IrisColors:
    """The pigments of an iris as painted for a screen (sRGB, 0 to 255).

    Attributes:
        stroma: The ciliary zone, which is most of the iris.
        inner: Round the pupil, out to the collarette and a little farther.
        ring: The rim at the limbus.
        spread: How far the inner colour reaches outwards, share of the iris.
        contrast: Of the fibres; dense pigment fills the gaps between them.
        flecks: How many spots of pigment.
    """

    stroma: tuple[float, float, float]
    inner: tuple[float, float, float]
    ring: tuple[float, float, float]
    spread: float
    contrast: float
    flecks: int


IRISES: Mapping[str, IrisColors] = {
    "blue": IrisColors((84, 92, 101), (104, 101, 91), (30, 37, 46), 0.20, 1.0, 4),
    "gray": IrisColors((94, 99, 102), (108, 104, 94), (38, 43, 48), 0.18, 0.95, 3),
    "green": IrisColors((84, 90, 73), (108, 94, 68), (34, 39, 35), 0.30, 0.95, 7),
    "hazel": IrisColors((80, 78, 62), (100, 77, 52), (34, 32, 27), 0.40, 0.9, 9),
    "amber": IrisColors((106, 81, 54), (114, 83, 52), (52, 36, 24), 0.45, 0.8, 5),
    "brown": IrisColors((74, 54, 41), (82, 58, 41), (34, 23, 18), 0.50, 0.7, 3),
    "dark_brown": IrisColors((50, 37, 30), (53, 38, 30), (25, 19, 16), 0.50, 0.5, 0),
}
RUFF = (38.0, 22.0, 15.0)
"""The pigment sheet turns forward round the pupil's edge (sRGB)."""
FLECK = (84.0, 55.0, 32.0)

# Linear RGB.
PUPIL = np.array([0.0035, 0.003, 0.003])
SCLERA = np.array([0.43, 0.37, 0.33])
SCLERA_AGED = np.array([0.41, 0.34, 0.27])
SCLERA_CORNER = np.array([0.39, 0.245, 0.20])
SCLERA_MELANIN = np.array([0.26, 0.31, 0.37])
"""What the conjunctiva of the darkest skin takes from the sclera's light."""
SCLERA_NEAR_LIMBUS = np.array([0.40, 0.38, 0.36])
VESSEL = np.array([0.42, 0.115, 0.09])
VESSELS = 46


def eye_uvs(directions: FloatArray) -> FloatArray:
    """Return where directions (v, 3) from the ball's middle lie on the map, shape (v, 2).

    Azimuthal about the front pole (0.5, 0.5): up is up, the eye's +x is right, radius 0.5 is 90
    degrees off the axis, and so is all that lies farther back.
    """
    across = np.hypot(directions[:, 0], directions[:, 1])
    angle = np.arctan2(across, directions[:, 2])
    radius = 0.5 * np.clip(angle / (np.pi / 2), 0, 1) ** MAP_POWER
    turn = radius / np.maximum(across, 1e-12)
    return np.column_stack([0.5 + directions[:, 0] * turn, 0.5 - directions[:, 1] * turn])


def eye_texture(recipe: Recipe) -> npt.NDArray[np.uint8]:
    """Return the map of a person's eyes as sRGB bytes, shape (512, 512, 3), the top row first."""
    linear = eye_colors(recipe)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.asarray((srgb * 255 + 0.5).clip(0, 255), dtype=np.uint8)


def eye_colors(recipe: Recipe) -> FloatArray:
    """Return the map of a person's eyes as linear RGB in 0..1, shape (512, 512, 3)."""
    rows, columns = np.indices((SIZE, SIZE))
    return colors_at(recipe, rows, columns)


def colors_at(recipe: Recipe, rows: IntArray, columns: IntArray) -> FloatArray:
    """Return some pixels of the map of a person's eyes as linear RGB in 0..1, shape (..., 3).

    Args:
        recipe: The person.
        rows: Of the pixels, from the top, shape (...).
        columns: Shape (...).
    """
    center = (np.arange(SIZE) + 0.5) / SIZE - 0.5
    right, up = center[columns], -center[rows]
    radius = np.hypot(right, up)
    around = np.arctan2(up, right)
    angle = np.pi / 2 * np.clip(2 * radius, 0, 1) ** (1 / MAP_POWER)
    off_axis = EYE_RADIUS * np.sin(angle)
    noise = np.random.default_rng([recipe.seed, 131])
    iris = _iris(off_axis, around, IRISES[recipe.eye_color], noise)
    sclera = _sclera(angle, around, recipe, noise, (rows, columns))
    # The sclera laps over the cornea unevenly, more above and below than to the sides.
    lap = 0.12 * np.abs(np.sin(around)) + 0.06 * _ringed(noise, around, 0 * around, 17, 1)
    edge = IRIS_RADIUS + 0.12 - lap
    to_sclera = smoothstep(-0.55 * LIMBUS_WIDTH, 0.55 * LIMBUS_WIDTH, off_axis - edge)
    return np.asarray((iris + (sclera - iris) * to_sclera[..., None]).clip(0, 1))


def _iris(
    off_axis: FloatArray, around: FloatArray, colors: IrisColors, noise: np.random.Generator
) -> FloatArray:
    """Return the iris's colour at distances from the axis [mm] and angles round it."""
    wavy = 0.03 * (_ringed(noise, around, 0 * around, 24, 1) - 0.5)
    share = (off_axis - PUPIL_RADIUS - wavy) / (IRIS_RADIUS - PUPIL_RADIUS)
    t = share.clip(0, 1)
    bend = 0.10 * (_ringed(noise, around, t, 9, 2) - 0.5) + 0.05 * (
        _ringed(noise, around, t, 31, 4) - 0.5
    )
    turned = around + bend
    # The collarette zigzags where the pupil's own muscle ends.
    frill = 0.27 + 0.09 * (_ringed(noise, around, 0 * t, 11, 1) - 0.5)
    frill = frill + 0.06 * (_ringed(noise, around, 0 * t, 34, 1) - 0.5)
    outside = smoothstep(-0.03, 0.05, t - frill)

    threads = (
        0.45 * _ridges(noise, turned, t, 58, 2)
        + 0.35 * _ridges(noise, turned, t, 104, 3)
        + 0.30 * _ridges(noise, turned, t, 190, 5)
    )
    pupillary = 0.6 * _ridges(noise, around, t, 120, 2) + 0.4 * _ringed(noise, around, t, 70, 3)
    fibre = outside * threads + (1 - outside) * (0.15 + 0.6 * pupillary)
    light = 1 + colors.contrast * (1.25 * (fibre - 0.42))
    light = light * (1 - 0.62 * colors.contrast * _crypts(t, turned, frill, noise))
    light = light + 0.34 * colors.contrast * np.exp(-(((t - frill) / 0.045) ** 2))
    for place in (0.60, 0.73, 0.85):
        arc = place + 0.03 * (_ringed(noise, around, 0 * t, 7, 1) - 0.5)
        depth = smoothstep(0.35, 0.75, _ringed(noise, around, 0 * t, 6, 1))
        light = light * (1 - 0.16 * depth * np.exp(-(((t - arc) / 0.018) ** 2)))

    stroma, inner, ring, ruff, fleck = (
        _linear(color) for color in (colors.stroma, colors.inner, colors.ring, RUFF, FLECK)
    )
    reach = colors.spread * (0.7 + 0.9 * _ringed(noise, turned, 0 * t, 26, 1))
    to_inner = 1 - smoothstep(0.0, 1.0, (t - 0.55 * reach) / (0.8 * reach + 0.12))
    color = stroma + (inner - stroma) * (0.92 * to_inner)[..., None]
    tint = (_ringed(noise, around, t, 6, 2) - 0.5)[..., None] * np.array([0.16, 0.04, -0.16])
    color = color * (1 + tint)
    spots = _spots(t, around, colors.flecks, noise)
    color = color + (fleck - color) * (0.75 * spots)[..., None]
    color = color * light.clip(0.12, 2.2)[..., None]
    to_ring = 0.88 * smoothstep(0.66, 1.0, t + 0.08 * (threads - 0.4))
    color = color + (ring - color) * to_ring[..., None]
    to_ruff = 1 - smoothstep(0.012, 0.05, t + 0.012 * pupillary)
    color = color + (ruff - color) * (0.9 * to_ruff)[..., None]
    in_pupil = 1 - smoothstep(-0.018, 0.012, share)
    return np.asarray(color + (PUPIL - color) * in_pupil[..., None])


def _crypts(
    t: FloatArray, around: FloatArray, frill: FloatArray, noise: np.random.Generator
) -> FloatArray:
    """Return how deep the stroma's gaps are, 0..1: lozenges just outside the collarette."""
    depth = np.zeros_like(t)
    count = 20
    places = 2 * np.pi * (np.arange(count) + noise.uniform(-0.3, 0.3, count)) / count
    for place in places:
        width, height = noise.uniform(0.04, 0.12), noise.uniform(0.07, 0.2)
        middle = frill + height * noise.uniform(0.5, 1.2)
        across = np.abs(np.angle(np.exp(1j * (around - place)))) / width
        along = np.abs(t - middle) / height
        lozenge = 1 - smoothstep(0.35, 1.15, across**1.3 + along**1.3)
        depth = np.maximum(depth, lozenge * noise.uniform(0.35, 1.0))
    return depth


def _spots(t: FloatArray, around: FloatArray, count: int, noise: np.random.Generator) -> FloatArray:
    cover = np.zeros_like(t)
    for _ in range(count):
        place, middle = noise.uniform(-np.pi, np.pi), noise.uniform(0.25, 0.9)
        size = noise.uniform(0.018, 0.05)
        across = np.angle(np.exp(1j * (around - place))) * (0.42 + 0.58 * middle)
        cover = np.maximum(cover, np.exp(-((across**2 + (t - middle) ** 2) / size**2)))
    return cover


def _sclera(
    angle: FloatArray,
    around: FloatArray,
    recipe: Recipe,
    noise: np.random.Generator,
    pixels: tuple[IntArray, IntArray],
) -> FloatArray:
    """Return the sclera's colour at angles from and round the eye's axis, and at those pixels."""
    limbus = float(np.arcsin(IRIS_RADIUS / EYE_RADIUS))
    years = float(smoothstep(35, 85, np.array(recipe.age)))
    base = (SCLERA + (SCLERA_AGED - SCLERA) * years) * (1 - recipe.skin * SCLERA_MELANIN)
    color = np.broadcast_to(base, (*angle.shape, 3))
    near = 1 - smoothstep(limbus, limbus + 0.16, angle)
    color = color + (np.minimum(SCLERA_NEAR_LIMBUS, base) - color) * (0.6 * near)[..., None]
    cloud = _ringed(noise, around, angle / np.pi * 2, 9, 5) - 0.5
    color = color * (1 + cloud[..., None] * np.array([0.02, 0.05, 0.09]))
    to_corner = smoothstep(0.5, 0.98, angle) * (0.55 + 0.45 * np.abs(np.cos(around)))
    color = color + (SCLERA_CORNER - color) * to_corner[..., None]
    vessels = _vessels(noise)[pixels] * smoothstep(limbus + 0.02, limbus + 0.22, angle)
    return np.asarray(color + (VESSEL - color) * (vessels * (0.75 + 0.25 * years))[..., None])


def _vessels(noise: np.random.Generator) -> FloatArray:
    """Return how much vessels cover the map: winding trees from the corners towards the limbus."""
    from scipy.ndimage import gaussian_filter  # Here: a start does without.

    cover = np.zeros((SIZE, SIZE))
    for number in range(VESSELS):
        side = 0.0 if number % 2 else np.pi
        start = side + noise.normal(0, 0.55)
        _grow(cover, noise, start, 0.5, noise.uniform(0.35, 1.0), depth=0)
    fine = gaussian_filter(cover, 0.55)
    blurred = gaussian_filter(cover, 3.5)
    return np.asarray((1.05 * fine + 0.85 * blurred).clip(0, 0.62))


def _grow(
    cover: FloatArray,
    noise: np.random.Generator,
    around: float,
    radius: float,
    strength: float,
    depth: int,
) -> None:
    """Draw one vessel inwards from a place on the map, and its branches."""
    steps = int(noise.uniform(60, 230) / (1 + 0.6 * depth))
    heading = noise.normal(0, 0.5)
    for step in range(steps):
        heading = 0.93 * heading + noise.normal(0, 0.22)
        radius -= 0.5 / SIZE
        around += heading * 0.6 / SIZE / radius
        if radius < 0.2:
            return
        fading = strength * (1 - step / steps) ** 0.6
        column = SIZE * (0.5 + radius * math.cos(around)) - 0.5
        row = SIZE * (0.5 - radius * math.sin(around)) - 0.5
        i, j = int(row), int(column)
        if not (0 <= i < SIZE - 1 and 0 <= j < SIZE - 1):
            continue
        y, x, ink = row - i, column - j, 0.42 * fading
        # One by one: for four numbers an array takes five times as long.
        cover[i, j] += ink * (1 - y) * (1 - x)
        cover[i, j + 1] += ink * (1 - y) * x
        cover[i + 1, j] += ink * y * (1 - x)
        cover[i + 1, j + 1] += ink * y * x
        if depth < 2 and noise.uniform() < 0.012:
            _grow(cover, noise, around, radius, 0.7 * fading, depth + 1)


def _linear(color: tuple[float, float, float]) -> FloatArray:
    value = np.array(color) / 255
    return np.asarray(np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4))


def _ridges(
    noise: np.random.Generator, around: FloatArray, t: FloatArray, columns: int, rows: int
) -> FloatArray:
    """Return threads in 0..1 that run outwards: crests of ring noise."""
    return np.asarray((1 - np.abs(2 * _ringed(noise, around, t, columns, rows) - 1)) ** 1.6)


def _ringed(
    noise: np.random.Generator, around: FloatArray, t: FloatArray, columns: int, rows: int
) -> FloatArray:
    """Return smooth noise in 0..1 that closes round the ring.

    Args:
        noise: Where its values come from.
        around: Angle, radians.
        t: Place outwards, 0..1.
        columns: Cells round the ring.
        rows: Cells from inside out.
    """
    table = noise.uniform(size=(rows + 1, columns))
    x = np.mod(around / (2 * np.pi), 1.0) * columns
    y = np.clip(t, 0, 1) * rows
    j, i = (
        np.floor(x).astype(np.int64) % columns,
        np.minimum(np.floor(y), rows - 1).astype(np.int64),
    )
    fx, fy = x - np.floor(x), y - i
    fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    beside = (j + 1) % columns
    top = table[i, j] * (1 - fx) + table[i, beside] * fx
    bottom = table[i + 1, j] * (1 - fx) + table[i + 1, beside] * fx
    return np.asarray(top * (1 - fy) + bottom * fy)
