"""The scalp as hair finds it: where roots may stand, how high over it a point is."""

from __future__ import annotations

import numpy as np

from ...arrays import BoolArray, FloatArray
from ..geometry import triangle_areas, unit
from ..hairline import hair_mask
from ..head import DrawnSurface
from ..recipe import Recipe
from .styles import Measures, Style

COVERED = ("scalp", "temple", "forehead", "neck", "preauricular", "mandible", "brow", "cheek")
"""Regions that hair may lie on."""
NEIGHBOURS = 3
EAR_CENTER = np.array([72.0, -16.0, -8.0])
EAR_RADII = np.array([21.0, 40.0, 29.0])
"""What hair keeps clear of beside the head, mm: an ellipsoid about each ear."""
CANDIDATES = 3.0
"""Places tried for each root, so that roots keep their distance."""
HAIRLINE_DENSITY = 4.8
"""How many more, but thinner, cards make up the front hairline."""
PACKING = 0.72
"""That distance, of the mean distance of roots in a square grid."""


class Scalp:
    """A head's skin in reference space, asked by hair."""

    def __init__(self, skin: DrawnSurface, recipe: Recipe) -> None:
        """Prepare `skin` for the hair of `recipe`."""
        from scipy.spatial import cKDTree  # Here: a start does without.

        self.recipe = recipe
        self._vertices = skin.vertices if skin.reference is None else skin.reference
        self._normals = skin.normals
        names = np.array(skin.region_names)[skin.regions]
        bearing = np.isin(names, COVERED)
        self._triangles = skin.triangles[bearing[skin.triangles].all(axis=1)]
        ground = np.unique(self._triangles)
        self._ground, self._ground_normals = self._vertices[ground], self._normals[ground]
        self._tree = cKDTree(self._ground)

    def height(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how high points (n, 3) are over the skin [mm], (n,), and its normals there (n, 3).

        Near enough for hair: by the tangent planes of the nearest vertices.
        """
        distance, near = self._tree.query(points, k=NEIGHBOURS)
        weight = 1 / (np.asarray(distance) + 0.3) ** 2
        weight = weight / weight.sum(axis=1, keepdims=True)
        normals = self._ground_normals[near]
        off = np.einsum("nkx,nkx->nk", points[:, None] - self._ground[near], normals)
        mean = np.einsum("nk,nkx->nx", weight, normals)
        return np.asarray((weight * off).sum(axis=1)), unit(mean)

    def scatter(
        self, style: Style, density: Measures, noise: np.random.Generator, *, least: float = 0.03
    ) -> tuple[FloatArray, FloatArray]:
        """Return evenly scattered roots (n, 3) where hair grows, and the hair mask there, (n,).

        Args:
            style: Says at which heights the measures stand.
            density: Roots per square centimetre where hair is full.
            noise: Chooses the places.
            least: Nothing grows where the mask is below this.
        """
        corners = self._vertices[self._triangles]
        area = triangle_areas(self._vertices, self._triangles)
        rate = style.at(density, corners.mean(axis=1)[:, 1]) / 100
        chosen = np.repeat(np.arange(len(area)), noise.poisson(CANDIDATES * area * rate))
        first, second = np.sqrt(noise.uniform(size=len(chosen))), noise.uniform(size=len(chosen))
        weights = np.column_stack([1 - first, first * (1 - second), first * second])
        points = np.einsum("nc,ncx->nx", weights, corners[chosen])
        mask = hair_mask(points, self.recipe)
        grows = mask > least
        points, mask, rate = points[grows], mask[grows], rate[chosen][grows]
        hairline = (points[:, 1] > 55) & (points[:, 2] > 30) & (mask < 0.97)
        rate = rate * np.where(hairline, 1 + HAIRLINE_DENSITY, 1)
        reach = PACKING / np.sqrt(np.maximum(rate * mask, 1e-6))
        kept = _apart(points, reach)
        return points[kept], mask[kept]


def _apart(points: FloatArray, reach: FloatArray) -> BoolArray:
    """Return which points to keep, shape (n,), so that none lies within a kept one's reach."""
    from scipy.spatial import cKDTree  # Here: a start does without.

    kept = np.ones(len(points), dtype=bool)
    tree = cKDTree(points)
    for index, near in enumerate(tree.query_ball_point(points, reach)):
        if kept[index]:
            kept[near] = False
            kept[index] = True
    return kept
