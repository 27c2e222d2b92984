"""Emotion words as Markdown: recipes, vocabularies, and how each face settles."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from engine import NEUTRAL, lexicon

from .emotion_words import described_recipes, described_vocabularies
from .tables import markdown_table

COMMAND = "risorius emotions"


def words_markdown() -> str:
    """Return every recipe with its place among feelings and its other words, and every label."""
    forms = sum(len(recipe.variants) for recipe in lexicon().recipes.values())
    lines = [
        "# Emotions",
        "",
        f"`{COMMAND}` prints this page: {len(lexicon().recipes)} recipes in {forms} variants, the",
        "words that play them, and what each does to the tissue. `GET /api/emotions` has the same",
        "words as data; [api.md](api.md#emotions) says how they are found and mixed. Of the",
        "publications we take facts only: names of labels, lists of action units, coordinates.",
        '"Ours" is our own reading, tuned on this face.',
        "",
        "## Recipes",
        "",
        "Valence, arousal and dominance are -1 to 1; the faces in bold are anchors, between which",
        "coordinates are played.",
        "",
    ]
    head = ("recipe", "valence", "arousal", "dominance", "after", "other words")
    lines += markdown_table(head, [_recipe(recipe) for recipe in described_recipes()])
    for vocabulary in described_vocabularies():
        lines += ["", f"## {vocabulary['title']}", ""]
        lines += [f"`{vocabulary['name']}`: {vocabulary['source']}. {_faces(vocabulary)}", ""]
        rows = [(_label(row), _plays(row), f"`{row['recipe']}`") for row in vocabulary["labels"]]
        lines += markdown_table(("label", "plays", "action units"), rows)
    return "\n".join(lines)


def figures_markdown(figures: Sequence[Mapping[str, Any]]) -> str:
    """Return how each face settles.

    Args:
        figures: Of `emotion_measuring.measure_forms`.
    """
    lines = [
        "",
        "## The faces, measured",
        "",
        "Each at intensity 1 on the standard face, a second after a step from rest: its turns of a",
        "round, the least volume of an element as a share of its own, elements turned over,",
        "triangles of the drawn skin folded over, vertices of teeth, gums, tongue and eyeballs",
        "that stand before the skin, and the greatest speed of a node.",
        "",
    ]
    head = (
        "face",
        "action units",
        "turns",
        "source",
        "least element",
        "inverted",
        "folds",
        "through",
        "mm/s",
    )
    return "\n".join([*lines, *markdown_table(head, (_figures(row) for row in figures))])


def _recipe(recipe: Mapping[str, Any]) -> tuple[str, ...]:
    name = f"**{recipe['name']}**" if recipe["anchor"] else recipe["name"]
    place = (f"{recipe[axis]:.2f}" for axis in ("valence", "arousal", "dominance"))
    return (name, *place, recipe["coordinates_source"], ", ".join(recipe["synonyms"]))


def _faces(vocabulary: Mapping[str, Any]) -> str:
    text = str(vocabulary["faces"])
    return f"{text[:1].upper()}{text[1:]}."


def _label(row: Mapping[str, Any]) -> str:
    return f"{row['label']} {row['name']}" if "name" in row else str(row["label"])


def _plays(row: Mapping[str, Any]) -> str:
    if [*row["plays"]] == [row["label"]]:
        return "itself"
    return " + ".join(
        recipe if weight == 1.0 else f"{weight:g} {recipe}"
        for recipe, weight in row["plays"].items()
    )


def _figures(row: Mapping[str, Any]) -> tuple[object, ...]:
    folds, through = (", ".join(_counts(row[what])) or 0 for what in ("folds", "through"))
    least, speed = f"{row['least_share']:.2f}", f"{row['speed_mm_s']:.2f}"
    units = f"`{row['facs'] or NEUTRAL}`"
    turns = f"{row['weight']} of {row['turns']}"
    return (
        row["face"],
        units,
        turns,
        row["source"],
        least,
        row["inverted"],
        folds,
        through,
        speed,
    )


def _counts(found: Mapping[str, int]) -> Iterator[str]:
    for name, count in found.items():
        yield f"{count} {name}"
