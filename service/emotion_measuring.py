"""How every face that an emotion word plays settles on a rig."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from engine import Keyframe, Rig, examine, lexicon, parse_facs

_SIDE_BY_SIDE = 24
"""Faces that settle at a time."""


@dataclass(frozen=True)
class Form:
    """One face: a variant of a recipe, or a label's own FACS string.

    Attributes:
        face: The recipe's or the label's name.
        facs: Its action units.
        source: Where they come from.
        weight: How many turns of a round it has.
        turns: Of a round.
    """

    face: str
    facs: str
    source: str
    weight: int
    turns: int


def forms() -> Iterator[Form]:
    """Every face that is not the face at rest: of the recipes, then of labels of their own."""
    for recipe in lexicon().recipes.values():
        for variant in recipe.variants:
            if variant.facs:
                turns = len(recipe.round)
                yield Form(recipe.name, variant.facs, variant.source, variant.weight, turns)
    for vocabulary in lexicon().vocabularies.values():
        for label, meaning in vocabulary.labels.items():
            if meaning.facs:
                yield Form(f"{label} ({vocabulary.name})", meaning.facs, "ours", 1, 1)


def measure_forms(rig: Rig, show: Callable[[str], None]) -> list[dict[str, Any]]:
    """Return the figures of every face at intensity 1.

    Args:
        rig: Whose faces.
        show: Told what is being measured.
    """
    every = list(forms())
    figures = []
    for begin in range(0, len(every), _SIDE_BY_SIDE):
        part = every[begin : begin + _SIDE_BY_SIDE]
        show(f"{part[0].face} and {len(every) - begin - 1} more faces")
        for form, flesh in zip(part, examine(rig, [_keyframe(f) for f in part]), strict=True):
            figures.append(
                {
                    "face": form.face,
                    "facs": form.facs,
                    "source": form.source,
                    "weight": form.weight,
                    "turns": form.turns,
                    "least_share": round(flesh.least_share, 4),
                    "inverted": flesh.inverted,
                    "folds": dict(flesh.folds),
                    "through": dict(flesh.through),
                    "speed_mm_s": round(flesh.speed, 4),
                }
            )
    return figures


def _keyframe(form: Form) -> Keyframe:
    return Keyframe(action_units={term.key: term.intensity for term in parse_facs(form.facs)})
