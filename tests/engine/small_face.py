"""A hand-made face of a few points, for tests that need a head but not the head."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import scipy.sparse as sp

from engine.head.head import DrawnSurface, Eye, Head, LidContact, Part
from engine.jaw import JawHinge

COLUMNS, ROWS = 5, 4
EYES = (
    Eye(np.array([31.0, 0.0, 72.3]), 12.0),
    Eye(np.array([-31.0, 0.0, 72.3]), 12.0),
)


def small_head() -> Head:
    """A sheet of 5 x 4 points with 2 followers, drawn 9 x 7, with jaw, eyes and strands."""
    x, y = np.meshgrid(np.linspace(-60, 60, COLUMNS), np.linspace(-90, 60, ROWS))
    sheet = np.stack([x.ravel(), y.ravel(), 95 - (x.ravel() / 12) ** 2], axis=1)
    followers = sheet[:2] - (0.0, 20.0, 5.0)
    points = np.concatenate([sheet, followers])
    quads = grid_quads(COLUMNS, ROWS)
    follow = sp.csr_array(
        (np.ones(2), (np.arange(2), np.arange(2))), shape=(2, len(sheet)), dtype=float
    )
    return Head(
        name="small",
        points=points,
        names=tuple(f"P{i}" for i in range(len(points))),
        sheet_count=len(sheet),
        polygons=quads,
        polygon_regions=("cheek",) * len(quads),
        triangles=split(quads),
        mirror=np.arange(len(points)),
        fixed=np.zeros(len(sheet), bool),
        jaw_weight=(points[:, 1] < -60).astype(float),
        depth=np.full(len(sheet), 8.0),
        anchor_weight=np.full(len(sheet), 0.5),
        follow=follow,
        follow_jaw=np.zeros(2),
        drawn=drawn_surface(sheet, len(points)),
        parts=parts(),
        eyes=EYES,
        landmarks={"prn": 31, "ch.L": 14},
    )


def drawn_surface(sheet: np.ndarray, points: int) -> DrawnSurface:
    """The sheet, each quad halved both ways by bilinear interpolation."""
    weights = np.kron(halved(ROWS), halved(COLUMNS))
    padded = np.concatenate([weights, np.zeros((len(weights), points - len(sheet)))], axis=1)
    vertices = weights @ sheet
    count = len(vertices)
    lids = np.flatnonzero(np.hypot(vertices[:, 0] - 31, vertices[:, 1]) < 25)
    return DrawnSurface(
        vertices=vertices,
        normals=np.tile([0.0, 0.0, 1.0], (count, 1)),
        triangles=split(grid_quads(2 * COLUMNS - 1, 2 * ROWS - 1)),
        colors=np.full((count, 3), (0.5, 0.3, 0.2)),
        hair=np.zeros(count),
        regions=np.zeros(count, np.int64),
        region_names=("cheek",),
        map=sp.csr_array(padded),
        lids=LidContact(lids, np.zeros(len(lids), np.int64), np.full(len(lids), 0.3)),
    )


def parts() -> tuple[Part, ...]:
    """One part of each kind that moves differently."""
    return (
        block("eye.L", (31, 0, 72), "eye", "eye.L"),
        block("cornea.L", (31, 0, 84), "cornea", "eye.L"),
        block("eye.R", (-31, 0, 72), "eye", "eye.R"),
        block("teeth.upper", (0, -70, 90), "teeth", "skull"),
        block("teeth.lower", (0, -78, 90), "teeth", "jaw"),
        block("brows", (30, 20, 96), "hair", "skin", root=30),
    )


def block(
    name: str, center: tuple[float, float, float], material: str, follows: str, root: int = -1
) -> Part:
    """A little tetrahedron."""
    corners = np.array([[-2.0, 0, 0], [2, 0, 0], [0, 3, 0], [0, 1, 2]])
    return Part(
        name=name,
        vertices=corners + center,
        normals=np.tile([0.0, 0.0, 1.0], (4, 1)),
        triangles=np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
        colors=np.full((4, 3), 0.8),
        material=material,
        follows=follows,
        roots=np.array([root, root + 1, root, root]) if root >= 0 else None,
    )


def grid_quads(columns: int, rows: int) -> np.ndarray:
    """The quads of a grid of points, counter-clockwise from +z."""
    index = np.arange(columns * rows).reshape(rows, columns)
    corners = (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1])
    return np.stack([corner.ravel() for corner in corners], axis=1)


def split(quads: np.ndarray) -> np.ndarray:
    """Two triangles a quad."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def halved(count: int) -> np.ndarray:
    """The matrix that puts a point between each two of a row of points."""
    weights = np.zeros((2 * count - 1, count))
    for row in range(2 * count - 1):
        weights[row, row // 2] += 0.5
        weights[row, (row + 1) // 2] += 0.5
    return weights


def small_rig() -> Any:
    """As much of a rig as the writers look at."""
    return SimpleNamespace(
        id="0123456789abcdef",
        name="small",
        head=small_head(),
        jaw=JawHinge(),
        action_units={},
        recipe=None,
        level="high",
    )
