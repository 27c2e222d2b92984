"""Emotions as weighted action units, and the words that name them (paper section 3)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from .errors import UnknownName
from .facs import Term, parse_facs


@dataclass(frozen=True)
class Emotion:
    """A named expression.

    Attributes:
        name: "happiness".
        recipe: FACS string at intensity 1, "6D+12E+25B"; empty for neutral.
        source: Publication the recipe comes from, or "ours" and why.
        synonyms: Other words for it.
    """

    name: str
    recipe: str
    source: str = ""
    synonyms: tuple[str, ...] = ()

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """The recipe's units; none for neutral."""
        return parse_facs(self.recipe) if self.recipe.strip() else ()


def find_emotion(emotions: Mapping[str, Emotion], label: str) -> Emotion:
    """Return the emotion that `label` names, by name or synonym, in any case.

    Raises:
        UnknownName: With every known label, and the nearest.
    """
    wanted = label.strip().lower()
    for emotion in emotions.values():
        if wanted == emotion.name or wanted in emotion.synonyms:
            return emotion
    known = [word for e in emotions.values() for word in (e.name, *e.synonyms)]
    raise UnknownName("emotion", label, known)
