"""A recipe: one expression with the forms it takes, and where it lies among feelings."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ..arrays import FloatArray


@dataclass(frozen=True)
class Variant:
    """One form of an expression.

    Attributes:
        facs: Its action units at intensity 1, "6D+12D"; empty for the face at rest.
        weight: How often it comes among the others.
        source: Publication it comes from, or "ours" and why.
    """

    facs: str
    weight: int
    source: str


@dataclass(frozen=True)
class Recipe:
    """An expression with a name.

    Attributes:
        name: "happiness".
        variants: Its forms, the first one first.
        place: Valence, arousal and dominance, -1..1 each, shape (3,).
        place_source: Publication these come from, or "ours".
        anchor: Whether coordinates are played by it.
        synonyms: Other words for it.
    """

    name: str
    variants: tuple[Variant, ...]
    place: FloatArray
    place_source: str
    anchor: bool
    synonyms: tuple[str, ...]

    def turn(self, number: int) -> int:
        """Return which variant comes at turn `number`, 0 or more: the first one at 0.

        In each round of turns a variant comes as often as it weighs; one that weighs no more than
        all others together never follows itself.
        """
        return self.round[number % len(self.round)]

    @cached_property
    def round(self) -> tuple[int, ...]:
        """One round of turns: every second place first, from the heaviest variant on."""
        heaviest_first = sorted(
            range(len(self.variants)), key=lambda index: -self.variants[index].weight
        )
        coming = [index for index in heaviest_first for _ in range(self.variants[index].weight)]
        order = [0] * len(coming)
        for place, index in zip(
            [*range(0, len(coming), 2), *range(1, len(coming), 2)], coming, strict=True
        ):
            order[place] = index
        begin = order.index(0)
        return (*order[begin:], *order[:begin])
