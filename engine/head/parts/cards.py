"""Hair cards: curved strips that a clump of strands is drawn on."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ..geometry import unit
from ..head import DrawnSurface, Part
from .strand_texture import LANES, MARGIN, WIDTH, lane_edges

ROUNDNESS = 0.4
"""How far a clump's sides face away from its middle, so that it is lit as a round lock."""


@dataclass(frozen=True, eq=False)
class Cards:
    """Some cards of one number of points.

    Attributes:
        lines: Middle line from root to tip [mm], shape (n, k, 3).
        sides: Unit vectors across each card, to its left, shape (n, k, 3).
        normals: Which way the hair there faces, for its light, shape (n, k, 3).
        widths: At each point [mm], shape (n, k).
        colors: Linear RGB at each point, shape (n, k, 3).
        lanes: Which clump of the texture is drawn on each, shape (n,).
        flipped: Whether it is drawn mirrored, shape (n,).
        down: How far down the texture each point lies, shape (n, k): roots that begin below its top
            stand close, tips that end above its foot are cut bluntly.
    """

    lines: FloatArray
    sides: FloatArray
    normals: FloatArray
    widths: FloatArray
    colors: FloatArray
    lanes: IntArray
    flipped: IntArray
    down: FloatArray

    def only(self, chosen: BoolArray) -> Cards:
        """Return the cards that are chosen, shape (n,)."""
        return Cards(*(getattr(self, field.name)[chosen] for field in fields(self)))


def cards_part(name: str, groups: list[Cards], skin: DrawnSurface | None = None) -> Part:
    """Return cards as one part that rides the forehead's skin, or the skull when `skin` is None.

    Cards that ride do so where they lie over the forehead; farther on they stay where they are.
    """
    groups = [cards for cards in groups if len(cards.lines)]
    pieces = [_strips(cards) for cards in groups]
    starts = np.cumsum([0, *(len(piece[0]) for piece in pieces[:-1])])
    vertices, normals, colors, uvs = (
        np.concatenate([piece[k] for piece in pieces]) for k in range(4)
    )
    triangles = [piece[4] + start for piece, start in zip(pieces, starts, strict=True)]
    return Part(
        name=name,
        vertices=vertices,
        normals=normals,
        triangles=np.concatenate(triangles),
        colors=np.clip(colors, 0, 1),
        material="hair",
        follows="skull" if skin is None else "skin",
        roots=None if skin is None else _roots(groups, skin),
        uvs=uvs,
    )


def on_forehead(points: FloatArray) -> BoolArray:
    """Return which points (n, 3) lie over skin that the forehead's muscle moves, shape (n,)."""
    return np.asarray((points[:, 1] > 45) & (points[:, 2] > 22))


def _roots(groups: list[Cards], skin: DrawnSurface) -> IntArray:
    """Return the skin vertex that each vertex of the cards rides: the nearest, or a still one."""
    from scipy.spatial import cKDTree  # Here: a start does without.

    middles = np.concatenate([cards.lines.reshape(-1, 3) for cards in groups])
    still = np.argmax(skin.vertices[:, 1])
    nearest = cKDTree(skin.vertices).query(middles)[1]
    return np.repeat(np.where(on_forehead(middles), nearest, still).astype(np.int64), 2)


def _strips(cards: Cards) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, IntArray]:
    """Return vertices, normals, colours, texture places and triangles: two vertices a point."""
    count, points = cards.lines.shape[:2]
    half = 0.5 * cards.widths[..., None] * cards.sides
    vertices = np.stack([cards.lines - half, cards.lines + half], axis=2)
    lean = ROUNDNESS * cards.sides
    normals = unit(np.stack([cards.normals - lean, cards.normals + lean], axis=2))
    colors = np.repeat(cards.colors[:, :, None, :], 2, axis=2)

    edges = np.array([lane_edges(lane) for lane in range(len(LANES))])[cards.lanes]
    inset = 0.5 * MARGIN / WIDTH
    left = np.where(cards.flipped, edges[:, 1] - inset, edges[:, 0] + inset)
    right = np.where(cards.flipped, edges[:, 0] + inset, edges[:, 1] - inset)
    uvs = np.empty((count, points, 2, 2))
    uvs[:, :, 0, 0], uvs[:, :, 1, 0] = left[:, None], right[:, None]
    uvs[..., 1] = cards.down[:, :, None]

    one = [
        corner
        for k in range(points - 1)
        for corner in ((2 * k, 2 * k + 1, 2 * k + 2), (2 * k + 1, 2 * k + 3, 2 * k + 2))
    ]
    triangles = np.array(one)[None] + 2 * points * np.arange(count)[:, None, None]
    flat = (-1, 3)
    return (
        vertices.reshape(flat),
        normals.reshape(flat),
        colors.reshape(flat),
        uvs.reshape(-1, 2),
        triangles.reshape(flat),
    )
