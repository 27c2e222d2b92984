"""Measured action units: what a face shows, whatever it was asked for, and what fights in it.

The displacement of the skin is explained by the fields of the rig's own units, without negative
ones (Lawson and Hanson's non-negative least squares): each of both sides, and more on either. Where
two units pull against each other the tissue shows less of both, and other units take part.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..errors import UnknownName
from ..facs import whole_of
from ..head import Head
from ..landmarks import LANDMARKS_68
from ..muscle import LidMuscle
from ..rig import Rig
from ..tissue.layers import Sheet
from .basis import UnitBasis, per_intensity

REFITS = 4
"""Times that each unit's field is taken anew at the intensity found."""
PARSIMONY = 0.05
"""Least correlation with what is left over at which a unit that nobody asked for takes part: the
penalty of its intensity (Tibshirani's lasso), which leaves out what little is gained by. It goes
with the share of the motion that is not explained, as the scaled lasso's does (Sun and Zhang 2012),
so that what is well explained is not shrunk."""
ONE_SIDED = 0.01
"""The same, in addition, for one side of a unit where nobody asked for the sides to differ."""
UNASKED_START = 0.5
"""Intensity at which the field of a unit that nobody asked for is first taken."""
SHOWN = 0.05
"""Least intensity that is reported of a unit nobody asked for."""
ALIKE = 0.98
"""Cosine from which two units cannot be told apart by their fields (AU43 and AU45)."""
SHORTFALL = 0.15
"""By how much a unit must be seen below its request to count as held back."""
OPPOSED = 0.20
"""Share of the smaller field's energy that two units, or muscles, must cancel to be opponents."""
SIDES = ("L", "R")


@dataclass(frozen=True)
class MeasuredUnit:
    """One unit of one side, asked for or seen.

    Attributes:
        unit: "AU12".
        side: "", "L" or "R".
        requested: Intensity asked for, 0 if nobody did.
        measured: Intensity at which the face shows it; None for a unit that moves no tissue.
        shown_as: Another unit whose field is the same, under which it is measured; "" for none.
    """

    unit: str
    side: str
    requested: float
    measured: float | None
    shown_as: str = ""


@dataclass(frozen=True)
class Fight:
    """Two units asked for together that undo each other.

    Attributes:
        units: As they were asked for, the one that lost most first: ("AU15", "AU12").
        opposed: Share of the smaller field's energy, 0..1, where they move skin against each other.
        requested, measured: Of both.
    """

    units: tuple[str, str]
    opposed: float
    requested: tuple[float, float]
    measured: tuple[float, float]


@dataclass(frozen=True)
class Antagonists:
    """Two active muscles that pull the same tissue opposite ways.

    Attributes:
        muscles: Their names, the stronger pull there first.
        opposed: Share of the weaker's squared force that acts against the other, 0..1.
    """

    muscles: tuple[str, str]
    opposed: float


@dataclass(frozen=True)
class Seen:
    """What a face shows.

    Attributes:
        units: Everything that was asked for or is seen, in FACS order.
        fights: Pairs of units that hold each other back.
        antagonists: Pairs of active muscles that pull against each other.
        residual: Share of the displacement's size that no unit explains, 0..1.
    """

    units: tuple[MeasuredUnit, ...]
    fights: tuple[Fight, ...]
    antagonists: tuple[Antagonists, ...]
    residual: float


def measure_face(
    rig: Rig,
    sheet: Sheet,
    basis: UnitBasis,
    displacements: FloatArray,
    requested: Mapping[str, float],
    activations: FloatArray,
    forces: FloatArray,
) -> Seen:
    """Return the units that a face shows beside those asked for.

    Args:
        rig: Whose face.
        sheet: Its surface.
        basis: Fields of its units.
        displacements: Of the sheet from rest, mm, shape (n, 3).
        requested: Intensity by "AU12", "L12" or "R12".
        activations: Of each muscle, shape (m,).
        forces: Of each muscle, paper units x mm, shape (m, 3, n).

    Raises:
        UnknownName: For a unit the rig does not have.
    """
    asked = {side: _asked(rig, requested, side) for side in SIDES}
    weights = _weights(rig.head, sheet)
    leaders = _leaders(basis, weights, {unit for side in asked.values() for unit in side})
    found, residual = _fit(basis, weights, displacements, asked, leaders)
    units = _merged(rig, basis, asked, found, leaders)
    return Seen(
        units=units,
        fights=_fights(basis, weights, units),
        antagonists=_antagonists(rig, activations, forces),
        residual=residual,
    )


def _asked(rig: Rig, requested: Mapping[str, float], side: str) -> dict[str, float]:
    asked: dict[str, float] = {}
    for key, value in requested.items():
        unit, its_side = rig.resolve_unit(key)
        if unit.one_sided and not its_side:
            its_side = "L"
        if its_side in ("", side) and value > 0.0:
            if unit.name not in rig.action_units:  # One lip is half of the unit that is measured.
                whole = whole_of(unit.name)
                asked[whole] = asked.get(whole, 0.0) + 0.5 * value
                continue
            asked[unit.name] = max(value, asked.get(unit.name, 0.0))
    return asked


def _weights(head: Head, sheet: Sheet) -> FloatArray:
    """Return each node's weight in the fit: half by area, half at the landmarks, shape (n,)."""
    area = sheet.node_area * ~head.fixed
    weights = area / area.sum()
    try:
        index = np.unique([head.point(name) for name in LANDMARKS_68])
    except UnknownName:  # A head from a file: all of its skin counts alike.
        return np.asarray(weights)
    marks = np.zeros(len(weights))
    marks[index] = 1.0 / len(index)
    return np.asarray(0.5 * weights + 0.5 * marks)


def _leaders(basis: UnitBasis, weights: FloatArray, asked: set[str]) -> list[int]:
    """Return, for each unit, the one it is measured as: itself, or the first that looks alike.

    Those asked for come first, so that a blink is not measured as eyes closed.
    """
    full = basis.fields[-1] * np.sqrt(weights)[:, None]
    flat = full.reshape(len(full), -1)
    flat = flat / np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-12)
    alike = flat @ flat.T
    order = sorted(range(len(basis.units)), key=lambda u: (basis.units[u] not in asked, u))
    leaders = list(range(len(basis.units)))
    chosen: list[int] = []
    for unit in order:
        same = [leader for leader in chosen if alike[unit, leader] > ALIKE]
        leaders[unit] = same[0] if same else unit
        if not same:
            chosen.append(unit)
    return leaders


def _fit(
    basis: UnitBasis,
    weights: FloatArray,
    displacements: FloatArray,
    asked: Mapping[str, Mapping[str, float]],
    leaders: Sequence[int],
) -> tuple[dict[str, dict[str, float]], float]:
    """Return the intensity of each leader by side, and the share of the motion left over."""
    chosen = sorted(set(leaders))
    root = np.sqrt(weights)[:, None]
    target = (root * displacements).ravel()
    size = np.linalg.norm(target)
    if size == 0.0:
        return {side: dict.fromkeys((basis.units[u] for u in chosen), 0.0) for side in SIDES}, 0.0
    wanted = np.array([[asked[side].get(basis.units[u], 0.0) for u in chosen] for side in SIDES])
    # Intensities of both sides, and of more on the left and on the right.
    even = np.where(wanted.any(axis=0), wanted.min(axis=0), UNASKED_START)
    levels = np.stack([even, *np.where(wanted > 0.0, wanted, UNASKED_START)])
    spare = np.where(np.stack([wanted.max(axis=0), *wanted]) > 0.0, 0.0, PARSIMONY)
    # One side alone is an explanation only where both are none.
    spare[1:] += np.where(wanted[0] == wanted[1], ONE_SIDED, 0.0)
    # What acts on one side only is never on both.
    fields = (basis.fields * ~basis.one_sided[:, None, None], basis.left, basis.right)
    residual = 1.0
    for _ in range(REFITS):
        columns = [
            (root * per_intensity(field[:, unit], float(level))).ravel()
            for field, row in zip(fields, levels, strict=True)
            for unit, level in zip(chosen, row, strict=True)
        ]
        matrix = np.stack(columns, axis=1)
        solution = sparse_nnls(matrix, target, spare.ravel() * residual)
        residual = float(np.linalg.norm(target - matrix @ solution) / size)
        levels = solution.reshape(3, len(chosen))
    even, left, right = levels
    return {
        side: {basis.units[u]: float(value) for u, value in zip(chosen, even + more, strict=True)}
        for side, more in zip(SIDES, (left, right), strict=True)
    }, residual


def sparse_nnls(columns: FloatArray, target: FloatArray, spare: FloatArray) -> FloatArray:
    """Return x ≥ 0 of least ½ |A x - b|² + |b| Σ s_k |A_k| x_k, shape (k,).

    A linear penalty only shifts Aᵀb, so that the small square problem of the normal equations is
    one of non-negative least squares again.

    Args:
        columns: A, shape (p, k); columns of zeros stay at 0.
        target: b, shape (p,).
        spare: s, least correlation at which each column takes part, shape (k,).
    """
    from scipy.optimize import nnls  # Here: a start does without.

    sizes = np.linalg.norm(columns, axis=0)
    used = sizes > 1e-9
    scaled = columns[:, used] / sizes[used]
    gram = scaled.T @ scaled + 1e-8 * np.eye(int(used.sum()))
    pull = scaled.T @ target - spare[used] * np.linalg.norm(target)
    root = np.linalg.cholesky(gram)
    solution = np.zeros(len(sizes))
    solution[used] = nnls(root.T, np.linalg.solve(root, pull))[0] / sizes[used]
    return solution


def _merged(
    rig: Rig,
    basis: UnitBasis,
    asked: Mapping[str, Mapping[str, float]],
    found: Mapping[str, Mapping[str, float]],
    leaders: Sequence[int],
) -> tuple[MeasuredUnit, ...]:
    shown_as = {
        name: basis.units[leader]
        for name, leader in zip(basis.units, leaders, strict=True)
        if basis.units[leader] != name
    }
    result = []
    for name in rig.action_units:
        wanted = [asked[side].get(name, 0.0) for side in SIDES]
        if name not in basis.units:
            seen: list[float | None] = [None, None]
        else:
            leader = shown_as.get(name, name)
            seen = [found[side].get(leader, 0.0) for side in SIDES]
            if name in shown_as and not any(wanted):
                continue
        result += _sides(name, wanted, seen, shown_as.get(name, ""))
    return tuple(result)


def _sides(
    name: str, wanted: Sequence[float], seen: Sequence[float | None], shown_as: str
) -> list[MeasuredUnit]:
    left, right = seen
    if left is None or right is None:
        whole = max(wanted)
        return [MeasuredUnit(name, "", whole, None)] if whole else []
    even = wanted[0] == wanted[1] and abs(left - right) < SHOWN
    if even:
        both = 0.5 * (left + right)
        return (
            [MeasuredUnit(name, "", wanted[0], both, shown_as)] if wanted[0] or both > SHOWN else []
        )
    return [
        MeasuredUnit(name, side, want, see, shown_as)
        for side, want, see in zip(SIDES, wanted, (left, right), strict=True)
        if want or see > SHOWN
    ]


def _fights(
    basis: UnitBasis, weights: FloatArray, units: Sequence[MeasuredUnit]
) -> tuple[Fight, ...]:
    asked = [unit for unit in units if unit.requested and unit.measured is not None]
    fights = []
    for index, one in enumerate(asked):
        for other in asked[index + 1 :]:
            if one.side and other.side and one.side != other.side:
                continue
            lost = [u.requested - (u.measured or 0.0) for u in (one, other)]
            if max(lost) < SHORTFALL:
                continue
            fields = [basis.fields[-1, basis.units.index(u.unit)] for u in (one, other)]
            opposed = opposition(fields[0], fields[1], weights)
            if opposed < OPPOSED:
                continue
            pair = (one, other) if lost[0] >= lost[1] else (other, one)
            fights.append(
                Fight(
                    units=(_key(pair[0]), _key(pair[1])),
                    opposed=opposed,
                    requested=(pair[0].requested, pair[1].requested),
                    measured=(pair[0].measured or 0.0, pair[1].measured or 0.0),
                )
            )
    return tuple(sorted(fights, key=lambda fight: -fight.opposed))


def opposition(one: FloatArray, other: FloatArray, weights: FloatArray) -> float:
    """Return how much two vector fields undo each other, as a share of the smaller one's energy.

    Args:
        one: Vectors, shape (n, 3).
        other: Vectors, shape (n, 3).
        weights: Of each point, shape (n,).
    """
    against = weights @ np.maximum(-(one * other).sum(axis=1), 0.0)
    energies = [weights @ (field**2).sum(axis=1) for field in (one, other)]
    return float(min(against / max(min(energies), 1e-12), 1.0))


def _antagonists(rig: Rig, activations: FloatArray, forces: FloatArray) -> tuple[Antagonists, ...]:
    """Return pairs of active muscles whose forces meet on the same tissue and differ in way."""
    active = [int(row) for row in np.flatnonzero(activations > SHOWN)]
    pairs = []
    for index, one in enumerate(active):
        for other in active[index + 1 :]:
            opposed = _muscles_opposed(rig, activations, forces, one, other)
            if opposed >= OPPOSED:
                sizes = [float((forces[row] ** 2).sum()) for row in (one, other)]
                rows = (one, other) if sizes[0] >= sizes[1] else (other, one)
                names = (rig.muscle_names[rows[0]], rig.muscle_names[rows[1]])
                pairs.append(Antagonists(names, opposed))
    return tuple(sorted(pairs, key=lambda pair: -pair.opposed))


def _muscles_opposed(
    rig: Rig, activations: FloatArray, forces: FloatArray, one: int, other: int
) -> float:
    first, second = rig.muscles[one], rig.muscles[other]
    if isinstance(first, LidMuscle) and isinstance(second, LidMuscle):
        if first.name[-2:] != second.name[-2:]:
            return 0.0
        turns = [
            np.array([m.upper, m.lower]) * activations[row]
            for m, row in ((first, one), (second, other))
        ]
        against = np.maximum(-turns[0] * turns[1], 0.0).sum()
        return float(min(against / max(min((t**2).sum() for t in turns), 1e-12), 1.0))
    return opposition(forces[one].T, forces[other].T, np.ones(forces.shape[2]))


def _key(unit: MeasuredUnit) -> str:
    return f"{unit.side}{unit.unit.removeprefix('AU')}" if unit.side else unit.unit
