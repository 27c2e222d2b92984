"""The hair of the scalp by recipe: cards combed from the whorl, with single hairs at the edges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ..anatomy import smoothstep
from ..geometry import unit
from ..hair_color import strand_colors
from ..hairline import hair_mask
from ..head import DrawnSurface, Part
from ..noise import noise as smooth_noise
from ..recipe import STANDARD, Recipe
from .cards import Cards, cards_part, on_forehead
from .scalp import EAR_CENTER, EAR_RADII, Scalp
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
ROOT_LIGHT = 0.5
"""Light that reaches the roots, of that at the tips."""
INNER_LIGHT = 0.62
"""Light that reaches the lowest layer of cards, of that on the outermost."""
SEGMENT = 8.5
"""Length of a card's pieces where their number allows, mm."""
FULL = 0.97
"""Hair at least this dense hides how the skin moves under it."""
LONGEST_SINGLE = 42.0
"""Length of a single hair that stands off, at most, mm."""
SINGLE_PIECES = 2
"""Pieces of a single hair."""
STANDING = 22.0
"""How high hair stands over the front hairline at most, mm."""
LEAST = 0.5
"""No card grows where hair is thinner than this, or it would stand alone as a tuft."""
HEM = -96.0
"""Where a bob ends, mm: at the chin."""
HEM_RAGGED = 2.2
"""How unevenly it is cut, mm."""
COVERED_ROOTS = 0.16
"""How far down the texture long hair begins where hair is full: below the tops of all strands."""
CLOSING = (0.88, 1.0)
"""Density of hair between which its roots stand apart, and are covered."""
UNCUT = 0.4
"""How far down it is where the cut begins: above the tips of all but the shortest."""
STRAY = 0.12
"""No hanging hair lies on a forehead that bears less hair than this."""
PARTING_HALF = 0.5
"""Half the width of a parting, mm, and how far from it hair still begins at it:"""
PARTING_REACH = 8.0
HANG_AXIS = np.array([0.0, -8.0])
"""Middle of the head that hanging hair turns in to, as (x, z), mm."""
FACE_EDGE = 44.0
"""No hair hangs further forward than this at the height of the eyes, mm."""
COIL_LENGTH = 24.0
"""Length of hair in one turn of a curl, mm."""
COIL_RADIUS = (3.0, 6.0)
CLUMPING = (13.0, 26.0)
"""Hair shorter than this stands singly, longer than this in clumps, mm."""


def hair_parts(skin: DrawnSurface, recipe: Recipe = STANDARD) -> list[Part]:
    """Return the scalp's hair in reference space: "hair" are cards, "flyaways" are single hairs.

    The first rows over the forehead, "hairline" and "baby_hairs", ride its skin.

    Args:
        skin: The drawn skin.
        recipe: Whose hair; its seed places every one.
    """
    style = style_of(recipe)
    scalp = Scalp(skin, recipe)
    noise = np.random.default_rng([31, recipe.seed])
    grow = {"combed": _combed, "hanging": _hanging, "coiled": _coiled}[style.kind]
    cards = _card_groups(scalp, style, grow, noise)
    strands = [_edge(scalp, style, noise), _flyaways(scalp, style, noise)]
    first = [_first_rows(group.lines[:, 0], recipe) for group in cards]
    rows = [group.only(chosen) for group, chosen in zip(cards, first, strict=True)]
    rest = [group.only(~chosen) for group, chosen in zip(cards, first, strict=True)]
    single = strands[0] + strands[1]
    ahead = _first_rows(single.lines[:, 0], recipe)
    parts = [
        cards_part(name, groups, surface)
        for name, groups, surface in (("hairline", rows, skin), ("hair", rest, None))
        if any(len(group.lines) for group in groups)
    ]
    parts += [
        strand_part(name, single.only(chosen), surface, root_light=0.7)
        for name, chosen, surface in (("baby_hairs", ahead, skin), ("flyaways", ~ahead, None))
        if chosen.any()
    ]
    return parts


def _first_rows(roots: FloatArray, recipe: Recipe) -> BoolArray:
    """Return which roots (n, 3) stand where the forehead moves and begins to bear hair, (n,)."""
    moving = on_forehead(roots)
    moving[moving] = hair_mask(roots[moving], recipe) < FULL
    return moving


@dataclass(frozen=True, eq=False)
class _Grown:
    """Middle lines from roots to tips: points, the scalp's normals, and directions, (n, k, 3)."""

    lines: FloatArray
    normals: FloatArray
    tangents: FloatArray


def _grown(lines: FloatArray, normals: FloatArray) -> _Grown:
    return _Grown(lines, normals, unit(np.gradient(lines, axis=1)))


Grow = Callable[
    [Scalp, Style, FloatArray, FloatArray, FloatArray, int, np.random.Generator], _Grown
]
"""Makes lines of so many pieces from roots (n, 3), lengths and rises (n,)."""


def _card_groups(scalp: Scalp, style: Style, grow: Grow, noise: np.random.Generator) -> list[Cards]:
    roots, mask = scalp.scatter(style, style.density, noise, least=LEAST)
    count = len(roots)
    if count == 0:
        return []
    y = roots[:, 1]
    thin = 0.45 + 0.55 * smoothstep(0.1, 0.8, mask)
    layer = noise.uniform(0, 1, count) ** 0.8
    length = style.at(style.length, y) * (0.4 + 0.6 * thin) * noise.uniform(0.72, 1.15, count)
    rise = style.at(style.rise, y) * (0.3 + 0.8 * layer) * (0.6 + 0.4 * thin)
    combed = off_temples(roots) if style.kind == "combed" else np.zeros(count)
    rise *= 1 + 0.45 * front(roots) * combed
    # At the front hairline hairs stand singly and rise off the forehead.
    first = front_edge(roots, mask) * combed
    rise = np.maximum(rise, first * np.minimum(0.62 * length, STANDING))
    width = style.at(style.width, y) * noise.uniform(0.7, 1.25, count) * (0.6 + 0.4 * thin)
    width *= 1 - 0.3 * first
    # A clump mixes its hairs: where few are grey, none of them is a grey streak.
    spread = 0.15 * min(1.0, 3 * scalp.recipe.grayness)
    colors = strand_colors(scalp.recipe, count, noise, spread=spread, tone=0.12)
    edge = 1 - smoothstep(0.75, 1.0, mask)
    if style.kind == "hanging":
        width *= 1 - 0.5 * edge
    # At the edge hairs show singly, unless they are long.
    loosened = 0.8 * edge if style.kind == "combed" else 0.0
    lanes = _lanes(length * (1 - loosened), layer, mask, noise)
    if style.kind == "coiled":  # curls hang together, however long they are
        lanes = np.clip(lanes, 0, 4)
    segments = np.clip(np.ceil(length / SEGMENT), *style.segments).astype(np.int64)
    cards = []
    for pieces in np.unique(segments):
        some = segments == pieces
        grown = grow(scalp, style, roots[some], length[some], rise[some], int(pieces), noise)
        light = _light(layer[some], edge[some], int(pieces) + 1)
        tinted = light[..., None] * colors[some, None, :]
        down = _down(style, mask[some], int(pieces) + 1, noise)
        drawn = _cards(grown, style, width[some], tinted, lanes[some], down, noise)
        if style.kind == "hanging":
            drawn = drawn.only(~_astray(grown, scalp.recipe))
        cards.append(drawn)
    return cards


def _down(style: Style, mask: FloatArray, points: int, noise: np.random.Generator) -> FloatArray:
    """Return how far down the texture the points of cards lie, shape (n, points).

    Long hair covers its roots, but at the hair's edge, where within a piece of the card they stand
    apart; and it is cut: all strands are there until they end within the last piece.
    """
    along = np.linspace(0, 1, points)[None, :]
    tips = noise.uniform(*style.cut, len(mask))[:, None]
    if style.kind != "hanging":
        return np.asarray(along * tips)
    whole = COVERED_ROOTS + (UNCUT - COVERED_ROOTS) * along / along[:, -2:-1]
    apart = noise.uniform(0.6, 1.0, len(mask)) * (1 - smoothstep(*CLOSING, mask))
    down = np.where(along < 1, whole, tips)
    down[:, 0] *= 1 - apart
    return down


def _astray(grown: _Grown, recipe: Recipe) -> BoolArray:
    """Return which lines hang over the bare forehead, shape (n,): a lock that nobody combed."""
    points = grown.lines[:, 1:].reshape(-1, 3)
    bare = on_forehead(points)
    bare[bare] = hair_mask(points[bare], recipe) < STRAY
    return np.asarray(bare.reshape(len(grown.lines), -1).any(axis=1))


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
    style: Style,
    width: FloatArray,
    colors: FloatArray,
    lanes: IntArray,
    down: FloatArray,
    noise: np.random.Generator,
) -> Cards:
    count = len(grown.lines)
    along = np.linspace(0, 1, grown.lines.shape[1])
    across = unit(np.cross(grown.tangents, grown.normals))
    up = np.cross(across, grown.tangents)
    loose = np.where(lanes >= LOOSE.start, 0.4, 1.0)
    roll = noise.normal(0, 0.38, count)[:, None] + noise.normal(0, 0.3, count)[:, None] * along
    roll = roll * loose[:, None]
    sides = np.cos(roll)[..., None] * across + np.sin(roll)[..., None] * up
    return Cards(
        lines=grown.lines,
        sides=sides,
        normals=grown.normals + 0.25 * up,
        widths=width[:, None] * (1.0 - style.taper * along**2)[None, :],
        colors=colors,
        lanes=lanes,
        flipped=noise.integers(0, 2, count).astype(bool),
        down=down,
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
        1.3 * smooth_noise(roots, 22.0, 41 + scalp.recipe.seed)
        + 0.6 * smooth_noise(roots, 8.0, 42 + scalp.recipe.seed)
        + noise.normal(0, 0.5, count)
    )
    stiffness = style.stiffness + (0.95 - style.stiffness) * front(roots) * off_temples(roots)
    step = length / pieces
    along = np.linspace(0, 1, pieces + 1)
    profile = along * (1.55 - 0.55 * along)
    place, normal = _planted(scalp, style, roots)
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
    return _grown(np.stack(lines, axis=1), np.stack(normals, axis=1))


def _hanging(
    scalp: Scalp,
    style: Style,
    roots: FloatArray,
    length: FloatArray,
    rise: FloatArray,
    pieces: int,
    noise: np.random.Generator,
) -> _Grown:
    """Return lines that lie on the head as far as it carries them, then hang and turn in."""
    count = len(roots)
    turn = style.ruffle * (
        1.2 * smooth_noise(roots, 16.0, 41 + scalp.recipe.seed) + noise.normal(0, 0.4, count)
    )
    # All end at one height, the chin's, a little lower in front.
    hem = HEM - 6 * smoothstep(-20, 40, roots[:, 2]) + noise.normal(0, HEM_RAGGED, count)
    place, normal = _planted(scalp, style, roots)
    lines, normals = [place], [normal]
    fallen = np.zeros((count, 1))
    # Its way over the head takes the longer, the higher it begins.
    way = 0.72 * np.linalg.norm(roots[:, [0, 2]] - HANG_AXIS, axis=1)
    reach = np.maximum(roots[:, 1] - hem, 12.0) + np.maximum(66 - way, 0)
    step = (np.minimum(reach, length) / pieces)[:, None]
    for k in range(pieces):
        share = (k + 1) / pieces
        over = turned(flow(scalp, style, place, normal), normal, turn)
        drop = np.column_stack([np.zeros((count, 1)), np.full((count, 1), -1.0), np.zeros(count)])
        heading = unit(over + fallen * (drop - over))
        place = place + step * heading
        below = place[:, 1:2] < HEM + 22
        place = place - np.where(below, 0.16 * step, 0.0) * _from_axis(place)
        lifted = rise * min(1.0, 0.35 + 2.5 * share)
        place, normal = _clear(scalp, place, lifted)
        fallen = np.maximum(fallen, smoothstep(0.35, 0.1, normal[:, 1:2]))
        lines.append(place)
        normals.append(normal)
    # What comes to the hem was cut at it.
    at_hem = np.stack(lines, axis=1)
    at_hem[:, -1, 1] -= np.clip(at_hem[:, -1, 1] - hem, 0, 0.9 * step[:, 0])
    at_hem[..., 1] = np.maximum(at_hem[..., 1], hem[:, None] + np.arange(pieces, -1, -1.0))
    return _grown(at_hem, np.stack(normals, axis=1))


def _planted(scalp: Scalp, style: Style, roots: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return where in the skin hair of roots (n, 3) begins, and the scalp's normals there."""
    place = roots.copy()
    if style.parting is not None:
        place[:, 0] += _to_parting(roots, style.parting)
    height, normal = scalp.height(place)
    return place - (height[:, None] + ROOT_DEPTH) * normal, normal


def _to_parting(roots: FloatArray, parting: float) -> FloatArray:
    """Return how far in x to move roots (n, 3) on the head's top, so that a parting is a line."""
    aside = roots[:, 0] - parting
    off = np.abs(aside)
    near = smoothstep(2 * PARTING_REACH, PARTING_REACH, off) * smoothstep(58, 72, roots[:, 1])
    return np.asarray(-np.sign(aside) * np.maximum(off - PARTING_HALF, 0) * near)


def _clear(scalp: Scalp, points: FloatArray, lifted: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return points (n, 3) pushed out of head, ears and face, and which way the hair there faces.

    Args:
        scalp: The head.
        points: Places of hair.
        lifted: How far each keeps off the scalp [mm], shape (n,).
    """
    height, normal = scalp.height(points)
    points = points + np.maximum(lifted - height, 0)[:, None] * normal
    # Past the ear, hair lies on it.
    aside = np.sign(points[:, :1])
    from_ear = (points - EAR_CENTER * np.hstack([aside, np.ones((len(points), 2))])) / EAR_RADII
    inside = np.linalg.norm(from_ear, axis=1)
    layer = (0.35 * lifted / EAR_RADII[0])[:, None]
    pushed = np.where((inside < 1 + layer[:, 0])[:, None], _to_side(from_ear, aside, layer), 0.0)
    points = points + pushed * EAR_RADII
    # Nothing hangs into the face: a curtain of hair ends beside it.
    face = FACE_EDGE + 0.25 * np.maximum(points[:, 1] - 10, 0) - 1.6 * lifted
    face += 60 * smoothstep(35, 78, points[:, 1])
    points[:, 2] = np.minimum(points[:, 2], face)
    outward = _from_axis(points)
    low = smoothstep(20, -30, points[:, 1])[:, None]
    mixed = normal + low * (outward - normal)
    return points, unit(mixed)


def _from_axis(points: FloatArray) -> FloatArray:
    """Return the level unit vectors from the axis that hanging hair turns in to, (n, 3)."""
    return unit(points * [1.0, 0.0, 1.0] - [0, 0, HANG_AXIS[1]])


def _to_side(from_ear: FloatArray, aside: FloatArray, layer: FloatArray) -> FloatArray:
    """Return the push (n, 3), in radii, that takes points out of the ear's ball sideways."""
    across = np.linalg.norm(from_ear[:, 1:], axis=1, keepdims=True)
    out = np.sqrt(np.maximum((1 + layer) ** 2 - across**2, 0))
    return np.asarray(
        np.hstack([aside * np.maximum(out - aside * from_ear[:, :1], 0), 0 * from_ear[:, 1:]])
    )


def _coiled(
    scalp: Scalp,
    style: Style,
    roots: FloatArray,
    length: FloatArray,
    rise: FloatArray,
    pieces: int,
    noise: np.random.Generator,
) -> _Grown:
    """Return lines that stand off the head and wind about their way: curls."""
    count = len(roots)
    _, normal = scalp.height(roots)
    # Curls stand off, fall over a little, and each goes its own way.
    stray = noise.normal(0, style.ruffle, (count, 3))
    axis = normal * (rise / length)[:, None] * 1.5 + stray + [0, -0.15, 0]
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    first = unit(np.cross(axis, noise.normal(0, 1, (count, 3))))
    second = np.cross(axis, first)
    along = np.linspace(0, 1, pieces + 1)
    turns = length / COIL_LENGTH * noise.uniform(0.8, 1.25, count)
    radius = noise.uniform(*COIL_RADIUS, count)[:, None] * np.minimum(1, 3.0 * along)[None, :]
    angle = 2 * np.pi * turns[:, None] * along[None, :] * noise.choice([-1, 1], count)[:, None]
    distance = (0.78 * length)[:, None] * along[None, :]
    lines = (roots - ROOT_DEPTH * normal)[:, None] + distance[..., None] * axis[:, None]
    lines = lines + (radius * np.cos(angle))[..., None] * first[:, None]
    lines = lines + (radius * np.sin(angle))[..., None] * second[:, None]
    flat = lines[:, 1:].reshape(-1, 3)
    height, _ = scalp.height(flat)
    least = np.tile(along[1:] * 3.0, count)
    ground = np.repeat(normal, pieces, axis=0)
    flat = flat + np.clip(least - height, 0, 25)[:, None] * ground
    over_face = (flat[:, 2] > 62) & (flat[:, 1] < 62)
    flat[:, 1] = np.where(over_face, 62 + 0.2 * (flat[:, 1] - 62), flat[:, 1])
    lines = np.concatenate([lines[:, :1], flat.reshape(count, pieces, 3)], axis=1)
    # A curl faces away from its own axis, and from the head.
    curl = radius[..., None] * (
        np.cos(angle)[..., None] * first[:, None] + np.sin(angle)[..., None] * second[:, None]
    )
    faces = normal[:, None] + 0.16 * curl
    return _grown(lines, unit(faces))


def flow(scalp: Scalp, style: Style, points: FloatArray, normals: FloatArray) -> FloatArray:
    """Return which way hair lies at points (n, 3) with scalp normals (n, 3): unit tangents."""
    from_whorl = points - WHORL
    away = np.linalg.norm(from_whorl, axis=1, keepdims=True)
    heading = from_whorl / np.maximum(away, 1e-9)
    heading = heading + SWIRL * np.exp(-away / SWIRL_REACH) * np.cross(heading, normals)
    top = smoothstep(52, 88, points[:, 1])[:, None]
    # Beside the forehead hair leaves the face, backwards.
    temple = smoothstep(24, 46, np.abs(points[:, 0])) * smoothstep(20, 48, points[:, 2])
    temple = (temple if style.kind == "combed" else 0.0 * temple)[:, None]
    forward = (1 - temple) * smoothstep(-20, 60, points[:, 2])[:, None]
    combed = np.array([-style.sweep, 0.3, 0.9]) * forward
    if style.parting is not None:
        side = np.tanh((points[:, 0] - style.parting) / 3.0)
        over = front(points)
        combed = np.column_stack([1.5 * side, 0.4 * over, 0.35 - 0.75 * over])
        if style.kind == "hanging":
            row = front_row(points)[:, None]
            back = np.column_stack([1.1 * side, 0.0 * over + 1.0, 0.0 * over - 1.0])
            combed = combed + row * (back - combed)
    # On the sides hair falls, at the temples backwards.
    back = 0.75 * smoothstep(15, 50, points[:, 2])
    fallen = np.column_stack([np.zeros(len(points)), np.full(len(points), -1.0), -0.1 - back])
    # The first row stands up and aside, and does not lie on the forehead.
    if style.parting is None and style.kind == "combed":
        row = front_row(points)[:, None]
        combed = combed + row * (np.array([-0.9, 0.55, 0.1]) - combed)
        top = np.maximum(top, row)
    top = top * (1 - 0.8 * temple)
    whorl = 1 - temple
    heading = top * (0.55 * whorl * heading + combed) + (1 - top) * (
        0.45 * whorl * heading + fallen
    )
    heading -= normals * (heading * normals).sum(axis=1, keepdims=True)
    return unit(heading)


def front(points: FloatArray) -> FloatArray:
    """Return how far points (n, 3) lie in the front of the hair, over the forehead, 0..1."""
    return np.asarray(smoothstep(25, 65, points[:, 2]) * smoothstep(50, 72, points[:, 1]))


def off_temples(points: FloatArray) -> FloatArray:
    """Return how far points (n, 3) lie over the forehead rather than at a temple, 0..1."""
    return np.asarray(smoothstep(40, 16, np.abs(points[:, 0])))


def front_row(points: FloatArray) -> FloatArray:
    """Return how far points (n, 3) lie in the first rows over the forehead, 0..1."""
    return np.asarray(smoothstep(52, 74, points[:, 2]) * smoothstep(58, 68, points[:, 1]))


def front_edge(points: FloatArray, mask: FloatArray) -> FloatArray:
    """Return how near points (n, 3) of hair mask (n,) lie to the hairline of the forehead, 0..1."""
    ahead = smoothstep(30, 50, points[:, 2]) * smoothstep(48, 60, points[:, 1])
    return np.asarray(ahead * (1 - smoothstep(0.7, 1.0, mask)))


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
    length = np.minimum(style.at(style.length, y), LONGEST_SINGLE) * noise.uniform(0.8, 1.15, count)
    rise = style.at(style.rise, y) * noise.uniform(0.95, 1.5, count)
    grown = _combed(scalp, style, roots, length, rise, SINGLE_PIECES, noise)
    return _single(scalp, grown, noise.uniform(0.10, 0.17, count), noise)


def _edge(scalp: Scalp, style: Style, noise: np.random.Generator) -> Strands:
    """Return the short fine hairs of the hairline."""
    roots, mask = scalp.scatter(style, (style.edge,) * 7, noise)
    keep = noise.uniform(size=len(roots)) < smoothstep(0.98, 0.5, mask)
    roots, mask = roots[keep], mask[keep]
    count, y = len(roots), roots[:, 1]
    length = np.minimum(style.at(style.length, y), 17.0) * (0.35 + 0.65 * mask)
    rise = np.minimum(style.at(style.rise, y), 4.0) * noise.uniform(0.1, 0.8, count)
    length = length * noise.uniform(0.5, 1.1, count)
    grown = _combed(scalp, style, roots, length, rise, SINGLE_PIECES, noise)
    return _single(scalp, grown, 0.10 + 0.09 * mask, noise)


def _single(scalp: Scalp, grown: _Grown, width: FloatArray, noise: np.random.Generator) -> Strands:
    return Strands(
        lines=grown.lines,
        normals=grown.normals,
        width=width,
        colors=strand_colors(scalp.recipe, len(width), noise),
    )
