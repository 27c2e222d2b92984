"""Vocabularies and recipes as plain data, for whoever chooses a word."""

from __future__ import annotations

from typing import Any

from engine import NEUTRAL, UnknownName, lexicon, resolve_label

_AXES = ("valence", "arousal", "dominance")


def described_vocabularies(only: str | None = None) -> list[dict[str, Any]]:
    """Return each vocabulary with the first variant of each of its labels.

    Args:
        only: Name of the one vocabulary that is asked for.

    Raises:
        UnknownName: There is no such vocabulary.
    """
    known = lexicon().vocabularies
    if only is not None and only not in known:
        raise UnknownName("vocabulary", only, known)
    return [
        {
            "name": vocabulary.name,
            "title": vocabulary.title,
            "source": vocabulary.source,
            "faces": vocabulary.faces,
            "labels": [_label(label, vocabulary.name) for label in vocabulary.labels],
        }
        for vocabulary in known.values()
        if only in (None, vocabulary.name)
    ]


def described_recipes() -> list[dict[str, Any]]:
    """Return each recipe with its variants, its other words, and where it lies."""
    return [
        {
            "name": recipe.name,
            "variants": [
                {"facs": form.facs or NEUTRAL, "weight": form.weight, "source": form.source}
                for form in recipe.variants
            ],
            **dict(zip(_AXES, recipe.place.tolist(), strict=True)),
            "coordinates_source": recipe.place_source,
            "anchor": recipe.anchor,
            "synonyms": list(recipe.synonyms),
        }
        for recipe in lexicon().recipes.values()
    ]


def _label(label: str, vocabulary: str) -> dict[str, Any]:
    plays = resolve_label(label, vocabulary=vocabulary)
    name = lexicon().vocabularies[vocabulary].names.get(label)
    return {
        "label": label,
        **({} if name is None else {"name": name}),
        "plays": {part.recipe: part.weight for part in plays.parts},
        "recipe": plays.facs,
        "source": plays.source,
    }
