"""Vocabularies: published sets of labels, and what each label means on a face."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Meaning:
    """What a label plays.

    Attributes:
        label: As its vocabulary writes it.
        vocabulary: Whose label it is; `OWN_NAMES` for the name of a recipe.
        parts: Recipes with their shares, which add up to 1 at most: their sum is its intensity.
        facs: A FACS string in place of recipes; empty if there are recipes.
    """

    label: str
    vocabulary: str
    parts: tuple[tuple[str, float], ...]
    facs: str = ""


OWN_NAMES = "recipes"
"""Vocabulary of the recipes' own names and synonyms."""


@dataclass(frozen=True)
class Vocabulary:
    """A set of labels.

    Attributes:
        name: "goemotions".
        title: Of the publication.
        source: Where its labels are published.
        faces: Where the faces of the labels come from.
        labels: By label.
        names: Other names of labels, by label.
    """

    name: str
    title: str
    source: str
    faces: str
    labels: Mapping[str, Meaning]
    names: Mapping[str, str]
