"""How action units act together where their sums would look wrong (FACS manual, combinations).

Most combinations are sums: muscles pull at once, and the tissue finds the common shape. A rule is
needed only where units share what they move, or where one muscle of a unit gives way to another.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from .errors import InvalidValue

SIDES = ("L", "R")


@dataclass(frozen=True)
class Combination:
    """One rule about units that are commanded together.

    Attributes:
        units: The units it is about; it acts where all of them are above 0 ("yields": any two).
        look: What the combined face should look like.
        source: Where the look is described, and who chose the numbers.
        yields: Full reach of each unit along what they share, mm: a unit then adds only what goes
            beyond those of greater reach, so that the greatest is seen and not the sum.
        factors: By unit, by muscle without side: what becomes of its weight when all units are
            equally strong. Where the weakest has a share r of the strongest, it is 1 + r (f - 1).
        adds: By muscle without side, activation per intensity of the weakest unit.
    """

    units: tuple[str, ...]
    look: str = ""
    source: str = ""
    yields: Mapping[str, float] = field(default_factory=dict)
    factors: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    adds: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        named = {*self.yields, *self.factors}
        if len(self.units) < 2 or not named <= set(self.units):
            raise InvalidValue(
                f"combination of {'+'.join(self.units)}: names {sorted(named)}; a rule has two "
                "units or more and speaks of no other"
            )

    @property
    def name(self) -> str:
        """The units as FACS writes them: "1+4"."""
        return "+".join(unit.removeprefix("AU") for unit in self.units)

    def strength(self, levels: Mapping[str, float]) -> tuple[float, float]:
        """Return the weakest unit's intensity, and its share of the strongest's, both 0..1.

        The share does not change as the whole expression grows: its look grows, not switches.
        """
        here = []
        for unit in self.units:
            level = levels.get(unit, 0.0)
            if level <= 0.0:  # Of most rules a unit is missing.
                return 0.0, 0.0
            here.append(level)
        weakest = min(here)
        return weakest, weakest / max(here)

    def yielded(self, levels: Mapping[str, float]) -> dict[str, float]:
        """Return the intensities at which units of `yields` act, so that the greatest is seen."""
        taken: dict[str, float] = {}
        covered = 0.0
        for unit in sorted(self.yields, key=lambda name: -self.yields[name]):
            if levels.get(unit, 0.0) > 0.0:
                reach = self.yields[unit] * levels[unit]
                taken[unit] = max(0.0, reach - covered) / self.yields[unit]
                covered = max(covered, reach)
        return taken


@dataclass(frozen=True)
class Together:
    """What the rules make of one side's units.

    Attributes:
        levels: Intensity at which each unit acts.
        factors: By (unit, muscle without side), on the muscle's weight.
        adds: By muscle without side, activation.
    """

    levels: Mapping[str, float]
    factors: Mapping[tuple[str, str], float]
    adds: Mapping[str, float]


def together(combinations: Sequence[Combination], levels: Mapping[str, float]) -> Together:
    """Return what `combinations` make of units at intensities `levels`, of one side of the face."""
    acting = dict(levels)
    factors: dict[tuple[str, str], float] = {}
    adds: dict[str, float] = {}
    for rule in combinations:
        if rule.yields:
            acting.update(rule.yielded(levels))
        weakest, share = rule.strength(levels)
        if share == 0.0:
            continue
        for unit, weights in rule.factors.items():
            for muscle, factor in weights.items():
                key = (unit, muscle)
                factors[key] = factors.get(key, 1.0) * (1.0 + share * (factor - 1.0))
        for muscle, activation in rule.adds.items():
            adds[muscle] = adds.get(muscle, 0.0) + weakest * activation
    return Together(acting, factors, adds)
