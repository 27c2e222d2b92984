"""Emotions as weighted action units, and the words that name them (paper section 3)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from .errors import InvalidValue, UnknownName
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

    @property
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


def blend(
    emotions: Mapping[str, Emotion], scores: Iterable[tuple[str, float]], intensity: float = 1.0
) -> dict[str, float]:
    """Return unit intensities of a scored list of labels: each recipe weighted by its share.

    Args:
        emotions: The rig's.
        scores: Labels with scores, 0 or more; they need not add up to 1.
        intensity: Of the whole, 0..1.

    Raises:
        UnknownName: For a label that is not known.
        InvalidValue: If no score is above 0.
    """
    pairs = [(find_emotion(emotions, label), score) for label, score in scores]
    total = sum(score for _, score in pairs)
    if total <= 0.0:
        raise InvalidValue("the scores add up to 0; at least one must be above 0")
    mixed: dict[str, float] = {}
    for emotion, score in pairs:
        for term in emotion.terms:
            share = term.intensity * intensity * score / total
            mixed[term.key] = min(1.0, mixed.get(term.key, 0.0) + share)
    return mixed
