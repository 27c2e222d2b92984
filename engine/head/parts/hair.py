"""The hair of the scalp by recipe: cards combed from the whorl, with single hairs at the edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ..anatomy import smoothstep
from ..hair_color import hair_color, strand_colors
from ..head import DrawnSurface, Part
from ..noise import noise as smooth_noise
from ..recipe import STANDARD, Recipe
from .cards import Cards, cards_part
from .scalp import Scalp
from .strand_texture import CLUMPS, LOOSE
from .strands import Strands, strand_part
from .styles import Style, style_of

WHORL = np.array([7.0, 108.0, -44.0])
"""Where the hair parts in all directions, mm; on the left of most heads."""
SWIRL = 0.5
"""How far hair turns about the whorl, and within this many mm of it:"""
SWIRL_REACH = 26.0
ROOT_DEPTH = 0.5
"""Cards begin this deep in the skin, mm."""
ROOT_LIGHT = 0.42
"""Light that reaches the roots, of that at the tips."""
INNER_LIGHT = 0.5
"""Light that reaches the lowest layer of cards, of that on the outermost."""
SEGMENT = 6.5
"""Length of a card's pieces, mm; between these numbers of them:"""
SEGMENTS = (2, 5)
CLUMPING = (13.0, 26.0)
"""Hair shorter than this stands singly, longer than this in clumps, mm."""


def hair_parts(skin: DrawnSurface, recipe: Recipe = STANDARD) -> list[Part]:
    """Return the scalp's hair in reference space: "hair" are cards, "flyaways" are single hairs.

    Args:
        skin: The drawn skin.
        recipe: Whose hair; its seed places every one.
    """
    style = style_of(recipe)
    scalp = Scalp(skin, recipe)
    noise = np.random.default_rng([31, recipe.seed])
    cards = _combed_cards(scalp, style, noise)
    strands = [_edge(scalp, style, noise), _flyaways(scalp, style, noise)]
    parts = [cards_part("hair", cards)] if any(len(group.lines) for group in cards) else []
    single = strands[0] + strands[1]
    if len(single.lines):
        parts.append(strand_part("flyaways", single, None, root_light=0.7))
    return parts


@dataclass(frozen=True, eq=False)
class _Grown:
    """Middle lines from roots to tips: points, the scalp's normals, and directions, (n, k, 3)."""

    lines: FloatArray
    normals: FloatArray
    tangents: FloatArray


def _combed_cards(scalp: Scalp, style: Style, noise: np.random.Generator) -> list[Cards]:
    roots, mask = scalp.scatter(style, style.density, noise, least=0.3)
    count = len(roots)
    if count == 0:
        return []
    y = roots[:, 1]
    thin = 0.45 + 0.55 * smoothstep(0.1, 0.8, mask)
    layer = noise.uniform(0, 1, count) ** 0.8
    length = style.at(style.length, y) * (0.4 + 0.6 * thin) * noise.uniform(0.72, 1.15, count)
    rise = style.at(style.rise, y) * (0.3 + 0.8 * layer) * (0.6 + 0.4 * thin)
    rise *= 1 + 0.45 * front(roots)
    width = style.at(style.width, y) * noise.uniform(0.7, 1.25, count) * (0.6 + 0.4 * thin)
    colors = strand_colors(scalp.recipe, count, noise, spread=0.45)
    edge = 1 - smoothstep(0.75, 1.0, mask)
    lanes = _lanes(length * (1 - 0.8 * edge), layer, mask, noise)
    segments = np.clip(np.ceil(length / SEGMENT), *SEGMENTS).astype(np.int64)
    cards = []
    for pieces in np.unique(segments):
        some = segments == pieces
        grown = _combed(scalp, style, roots[some], length[some], rise[some], int(pieces), noise)
        light = _light(layer[some], edge[some], int(pieces) + 1)
        tinted = light[..., None] * colors[some, None, :]
        cards.append(_cards(grown, width[some], tinted, lanes[some], noise))
    return cards


def _lanes(
    length: FloatArray, layer: FloatArray, mask: FloatArray, noise: np.random.Generator
) -> IntArray:
    """Return what is drawn on each card: solid clumps below, wisps above and at the hair's edge."""
    open_ = layer * noise.uniform(0.3, 1.0, len(length)) + 0.8 * (1 - smoothstep(0.2, 0.95, mask))
    clump = np.clip(6.0 * open_, 0, len(CLUMPS) - 1.5).astype(np.int64)
    loose = LOOSE.start + np.clip(3.2 * open_, 0, len(LOOSE) - 1).astype(np.int64)
    short = noise.uniform(size=len(length)) > smoothstep(*CLUMPING, length)
    return np.where(short, loose, clump)


def _cards(
    grown: _Grown,
    width: FloatArray,
    colors: FloatArray,
    lanes: IntArray,
    noise: np.random.Generator,
) -> Cards:
    count = len(grown.lines)
    along = np.linspace(0, 1, grown.lines.shape[1])
    across = np.cross(grown.tangents, grown.normals)
    across /= np.maximum(np.linalg.norm(across, axis=2, keepdims=True), 1e-9)
    up = np.cross(across, grown.tangents)
    loose = np.where(lanes >= LOOSE.start, 0.4, 1.0)
    roll = noise.normal(0, 0.5, count)[:, None] + noise.normal(0, 0.35, count)[:, None] * along
    roll = roll * loose[:, None]
    sides = np.cos(roll)[..., None] * across + np.sin(roll)[..., None] * up
    return Cards(
        lines=grown.lines,
        sides=sides,
        normals=grown.normals + 0.25 * up,
        widths=width[:, None] * (0.85 + 0.25 * np.sin(np.pi * along))[None, :],
        colors=colors,
        lanes=lanes,
        flipped=noise.integers(0, 2, count).astype(bool),
    )


def _light(layer: FloatArray, edge: FloatArray, points: int) -> FloatArray:
    """Return how much light reaches cards from root to tip, (n, points); all of it at the edge."""
    along = np.asarray(smoothstep(0.0, 0.75, np.linspace(0, 1, points)))[None, :]
    root = ROOT_LIGHT + (1 - ROOT_LIGHT) * np.maximum(along, 0.75 * edge[:, None])
    depth = INNER_LIGHT + (1 - INNER_LIGHT) * np.maximum(layer, edge)
    return np.asarray(depth[:, None] * root)


def _combed(
    scalp: Scalp,
    style: Style,
    roots: FloatArray,
    length: FloatArray,
    rise: FloatArray,
    pieces: int,
    noise: np.random.Generator,
) -> _Grown:
    """Return lines that follow the head from their roots, rising off it."""
    count = len(roots)
    turn = style.ruffle * (
        1.1 * smooth_noise(roots, 13.0, 41 + scalp.recipe.seed) + noise.normal(0, 0.55, count)
    )
    stiffness = style.stiffness + (0.95 - style.stiffness) * front(roots)
    step = length / pieces
    along = np.linspace(0, 1, pieces + 1)
    profile = along * (1.55 - 0.55 * along)
    _, normal = scalp.height(roots)
    place = roots - ROOT_DEPTH * normal
    lines, normals = [place], [normal]
    for k in range(pieces):
        heading = turned(flow(scalp, style, place, normal), normal, turn * (0.6 + 0.6 * along[k]))
        climb = np.clip(rise * (profile[k + 1] - profile[k]) / step, -0.9, 0.94)
        level = np.sqrt(1 - climb**2)
        place = place + step[:, None] * level[:, None] * heading
        height, normal = scalp.height(place)
        lack = rise * profile[k + 1] - height
        # What stands off further than it is combed to comes down only as far as it bends.
        place = place + np.where(lack < 0, (1 - stiffness) * lack, lack)[:, None] * normal
        lines.append(place)
        normals.append(normal)
    grown = np.stack(lines, axis=1)
    tangents = np.gradient(grown, axis=1)
    tangents /= np.maximum(np.linalg.norm(tangents, axis=2, keepdims=True), 1e-9)
    return _Grown(grown, np.stack(normals, axis=1), tangents)


def flow(scalp: Scalp, style: Style, points: FloatArray, normals: FloatArray) -> FloatArray:
    """Return which way hair lies at points (n, 3) with scalp normals (n, 3): unit tangents."""
    from_whorl = points - WHORL
    away = np.linalg.norm(from_whorl, axis=1, keepdims=True)
    heading = from_whorl / np.maximum(away, 1e-9)
    heading = heading + SWIRL * np.exp(-away / SWIRL_REACH) * np.cross(heading, normals)
    top = smoothstep(52, 88, points[:, 1])[:, None]
    forward = smoothstep(-20, 60, points[:, 2])[:, None]
    combed = np.array([-style.sweep, 0.3, 0.9]) * forward
    if style.parting is not None:
        side = np.tanh((points[:, 0] - style.parting) / 6.0)
        over = front(points)
        combed = np.column_stack([1.5 * side, 0.4 * over, 0.35 - 0.75 * over])
    # On the sides hair falls, at the temples backwards.
    back = 0.75 * smoothstep(15, 50, points[:, 2])
    fallen = np.column_stack([np.zeros(len(points)), np.full(len(points), -1.0), -0.1 - back])
    heading = top * (0.55 * heading + combed) + (1 - top) * (0.45 * heading + fallen)
    heading -= normals * (heading * normals).sum(axis=1, keepdims=True)
    return np.asarray(heading / np.maximum(np.linalg.norm(heading, axis=1, keepdims=True), 1e-9))


def front(points: FloatArray) -> FloatArray:
    """Return how far points (n, 3) lie in the front of the hair, over the forehead, 0..1."""
    return np.asarray(smoothstep(25, 65, points[:, 2]) * smoothstep(50, 72, points[:, 1]))


def turned(vectors: FloatArray, axes: FloatArray, angles: FloatArray) -> FloatArray:
    """Return vectors (n, 3) turned about unit axes across them by angles (n,) [radians]."""
    sine, cosine = np.sin(angles)[:, None], np.cos(angles)[:, None]
    return np.asarray(cosine * vectors + sine * np.cross(axes, vectors))


def _flyaways(scalp: Scalp, style: Style, noise: np.random.Generator) -> Strands:
    """Return single hairs that stand off the rest and soften the outline."""
    roots, mask = scalp.scatter(style, (style.flyaways,) * 7, noise)
    keep = noise.uniform(size=len(roots)) < smoothstep(0.3, 0.9, mask)
    roots = roots[keep]
    count, y = len(roots), roots[:, 1]
    length = style.at(style.length, y) * noise.uniform(0.8, 1.15, count)
    rise = style.at(style.rise, y) * noise.uniform(0.95, 1.5, count)
    grown = _combed(scalp, style, roots, length, rise, 3, noise)
    return _single(scalp, grown, noise.uniform(0.10, 0.17, count), noise)


def _edge(scalp: Scalp, style: Style, noise: np.random.Generator) -> Strands:
    """Return the short fine hairs of the hairline."""
    roots, mask = scalp.scatter(style, (style.edge,) * 7, noise)
    keep = noise.uniform(size=len(roots)) < smoothstep(0.98, 0.5, mask)
    roots, mask = roots[keep], mask[keep]
    count, y = len(roots), roots[:, 1]
    length = np.minimum(style.at(style.length, y), 15.0) * (0.35 + 0.65 * mask)
    rise = np.minimum(style.at(style.rise, y), 4.0) * noise.uniform(0.1, 0.8, count)
    grown = _combed(scalp, style, roots, length * noise.uniform(0.5, 1.1, count), rise, 2, noise)
    return _single(scalp, grown, 0.08 + 0.08 * mask, noise)


def _single(scalp: Scalp, grown: _Grown, width: FloatArray, noise: np.random.Generator) -> Strands:
    count, points = grown.lines.shape[:2]
    if points == 3:  # as many points as the longest, so that all make one part
        lines = np.concatenate([grown.lines, grown.lines[:, -1:]], axis=1)
        share = np.array([0, 2 / 3, 4 / 3, 2])
        low = np.minimum(share.astype(int), 1)
        part = (share - low)[None, :, None]
        lines = grown.lines[:, low] * (1 - part) + grown.lines[:, low + 1] * part
        normals = grown.normals[:, low] * (1 - part) + grown.normals[:, low + 1] * part
    else:
        lines, normals = grown.lines, grown.normals
    return Strands(
        lines=lines,
        normals=normals,
        width=width,
        colors=strand_colors(scalp.recipe, count, noise),
    )


__all__ = ["flow", "hair_color", "hair_parts", "turned"]
