"""Strain of the tissue's layers: how far springs along them are stretched or pressed from rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..dynamics import Tissue


@dataclass(frozen=True)
class Spread:
    """Mean, 95th percentile and greatest of a share of length; zeros where there is none."""

    mean: float
    p95: float
    max: float

    @classmethod
    def of(cls, values: FloatArray) -> Spread:
        """Return the spread of `values`, shape (k,), not negative."""
        if not len(values):
            return cls(0.0, 0.0, 0.0)
        return cls(float(values.mean()), float(np.quantile(values, 0.95)), float(values.max()))


@dataclass(frozen=True)
class Strain:
    """Strain of the springs along one layer, as shares of their length at rest.

    Attributes:
        tension: Of every spring, those that are shorter than at rest counting as 0.
        compression: The same of those that are shorter, positive.
    """

    tension: Spread
    compression: Spread


@dataclass(frozen=True, eq=False)
class AlongLayer:
    """Springs that run along the layers, and how far each is strained.

    Attributes:
        layer: 0 epidermis, 1 dermis, 2 hypodermis, shape (k,).
        first, second: Ends as nodes of the sheet, shape (k,).
        strain: Length over length at rest, less 1, shape (k,).
    """

    layer: IntArray
    first: IntArray
    second: IntArray
    strain: FloatArray


def strains_along(x: FloatArray, tissue: Tissue) -> AlongLayer:
    """Return the strain of every in-layer spring.

    Measured from the face at rest, where pre-tension stretches the springs already.

    Args:
        x: Node positions, mm, shape (3, nodes).
        tissue: The rig's arrays.
    """
    n = x.shape[1] // 3
    first, second = (
        ends.astype(np.int64) for ends in (tissue.springs.first, tissue.springs.second)
    )
    along = first // n == second // n
    first, second = first[along], second[along]
    length = np.linalg.norm(x[:, second] - x[:, first], axis=0)
    rest = np.linalg.norm(tissue.rest[:, second] - tissue.rest[:, first], axis=0)
    return AlongLayer(first // n, first % n, second % n, length / rest - 1.0)


def strain_of(springs: AlongLayer, chosen: BoolArray) -> Strain:
    """Return the strain of the `chosen` springs, shape (k,)."""
    strain = springs.strain[chosen]
    return Strain(Spread.of(np.maximum(strain, 0.0)), Spread.of(np.maximum(-strain, 0.0)))
