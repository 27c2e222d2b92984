"""From a label, a scored list or coordinates to the action units that play it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..emotion import Emotion
from ..errors import InvalidValue
from ..facs import NEUTRAL, Term, format_facs, nearest_letter, split_side
from .coordinates import dominance_with, shares_around
from .lexicon import lexicon
from .meaning import Meaning
from .mixture import HALVES, mixed
from .words import normal

Turn = Callable[[str], int]
"""Which turn it is of the recipe of a name: chooses its variant."""
OWN_SOURCE = "yours"
"""Source of the emotions that a client gave to its rig."""
MOST_MIXED = 4
"""Labels of a scored list that are seen; more of them hide each other on a face."""
_SEEN = 0.1
"""Least intensity of a unit that the FACS string names: half of A."""
_TOLD = 0.1
"""Least share of a recipe whose source is told."""


@dataclass(frozen=True)
class Part:
    """One recipe of what is played.

    Attributes:
        recipe: Its name; the label's where it has a FACS string of its own.
        weight: Its share, 0..1.
        variant: Which of its forms, counted from 0.
        facs: That form at intensity 1.
        source: Where that comes from.
    """

    recipe: str
    weight: float
    variant: int
    facs: str
    source: str


@dataclass(frozen=True)
class Resolved:
    """What is played.

    Attributes:
        label: The known label that was meant; empty for scores and coordinates.
        vocabulary: Whose label it is: a vocabulary's, "recipes" or "rig"; empty if there is none.
        found: "label", "synonym", "inflection", "scores" or "coordinates".
        parts: What it is made of, in the order in which it was asked for or found.
    """

    label: str
    vocabulary: str
    found: str
    parts: tuple[Part, ...]

    @cached_property
    def units(self) -> Mapping[str, float]:
        """Intensities by unit, or by side of one, at intensity 1."""
        return mixed([(part.facs, part.weight) for part in self.parts])

    @property
    def facs(self) -> str:
        """The same as a FACS string, a mixture's with the nearest letters; "0" for rest."""
        if len(self.parts) == 1 and self.parts[0].weight == 1.0:
            return self.parts[0].facs or NEUTRAL
        terms = sorted(_seen(self.units), key=lambda term: term.order)
        return format_facs(terms) or NEUTRAL

    @property
    def source(self) -> str:
        """Where the faces come from, each source once."""
        least = min(_TOLD, max(part.weight for part in self.parts))
        return "; ".join(dict.fromkeys(p.source for p in self.parts if p.weight >= least))


def first(_recipe: str) -> int:
    """Return the turn of a recipe's first variant."""
    return 0


def resolve_label(
    label: str,
    *,
    own: Mapping[str, Emotion] | None = None,
    vocabulary: str | None = None,
    turn: Turn = first,
) -> Resolved:
    """Return what a label plays.

    Args:
        label: A label of any vocabulary, a synonym, an inflection of either, or an emoji.
        own: The rig's emotions: those that a client gave to it come before everything else.
        vocabulary: Whose labels alone are meant.
        turn: Chooses among a recipe's variants.

    Raises:
        UnknownName: For a label or vocabulary that is not known, with the nearest.
    """
    emotion = None if vocabulary is not None else _given(own or {}, label)
    if emotion is not None:
        part = Part(emotion.name, 1.0, 0, emotion.recipe, emotion.source)
        return Resolved(emotion.name, "rig", "label", (part,))
    meaning, found = lexicon().find(label, vocabulary)
    parts = tuple(_parts(meaning, 1.0, turn))
    return Resolved(meaning.label, meaning.vocabulary, found, parts)


def resolve_scores(
    scores: Iterable[tuple[str, float]],
    *,
    own: Mapping[str, Emotion] | None = None,
    vocabulary: str | None = None,
    turn: Turn = first,
) -> Resolved:
    """Return the one expression that a classifier's scored labels play.

    Scores that add up to more than 1 are divided by their sum; below 1, what is missing is rest,
    and so is the share of neutral. Of the others the greatest `MOST_MIXED` are seen, and stand for
    the rest of them: their shares are raised to the same sum. Equal ones count in the order of
    their names, so that the order of the list does not matter.

    Args:
        scores: Labels with scores, 0 or more.
        own: As for a label.
        vocabulary: As for a label.
        turn: As for a label.

    Raises:
        UnknownName: For a label or vocabulary that is not known.
        InvalidValue: If no score is above 0.
    """
    shares: dict[str, float] = {}
    found: dict[str, Resolved] = {}
    for label, score in scores:
        one = resolve_label(label, own=own, vocabulary=vocabulary, turn=turn)
        key = f"{one.vocabulary} {one.label}"
        found[key], shares[key] = one, shares.get(key, 0.0) + score
    total = sum(sorted(shares.values()))
    if total <= 0.0:
        raise InvalidValue("the scores add up to 0; at least one must be above 0")
    felt = {key: share / max(1.0, total) for key, share in shares.items() if found[key].units}
    kept = sorted((k for k in felt if felt[k] > 0.0), key=lambda key: (-felt[key], key))
    kept = kept[:MOST_MIXED]
    raised = sum(sorted(felt.values())) / sum(felt[key] for key in kept) if kept else 1.0
    parts = [
        Part(p.recipe, p.weight * felt[key] * raised, p.variant, p.facs, p.source)
        for key in kept
        for p in found[key].parts
    ]
    if not parts:  # Neutral is all that was scored.
        parts = [part for one in found.values() for part in one.parts]
    return Resolved("", vocabulary or "", "scores", tuple(parts))


def resolve_coordinates(
    valence: float, arousal: float, dominance: float | None = None, *, turn: Turn = first
) -> Resolved:
    """Return the expression of a point among feelings, continuous in it.

    Args:
        valence: Pleasure, -1..1.
        arousal: -1..1.
        dominance: Or potency, -1..1; what goes with the other two if None.
        turn: Chooses among a recipe's variants.
    """
    recipes = lexicon().recipes
    if dominance is None:
        dominance = dominance_with(valence, arousal, recipes.values())
    point = np.array([valence, arousal, dominance], dtype=np.float64)
    parts = [
        part
        for name, share in shares_around(point, recipes.values())
        for part in _parts(Meaning(name, "", ((name, 1.0),)), share, turn)
    ]
    return Resolved("", "", "coordinates", tuple(parts))


def _given(own: Mapping[str, Emotion], label: str) -> Emotion | None:
    """Return the emotion that a client gave to its rig under this label, if it did."""
    word = normal(label)
    for emotion in own.values():
        if emotion.source == OWN_SOURCE and word in map(normal, (emotion.name, *emotion.synonyms)):
            return emotion
    return None


def _seen(units: Mapping[str, float]) -> Iterable[Term]:
    """Return what of `units` is seen, both sides as one where they have the same letter."""
    read = {split_side(key): value for key, value in units.items() if value >= _SEEN}
    for (name, side), value in read.items():
        other = read.get((name, HALVES.get(side, "")), 0.0) if side in HALVES else 0.0
        even = other > 0.0 and nearest_letter(other) == nearest_letter(value)
        if not (even and side == "R"):
            yield Term(name, "" if even else side, value)


def _parts(meaning: Meaning, share: float, turn: Turn) -> Iterable[Part]:
    if meaning.facs:
        yield Part(meaning.label, share, 0, meaning.facs, "ours")
    for name, weight in meaning.parts:
        recipe = lexicon().recipes[name]
        index = recipe.turn(turn(name))
        variant = recipe.variants[index]
        yield Part(name, share * weight, index, variant.facs, variant.source)
