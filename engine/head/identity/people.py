"""The people who come with the engine: recipes by name."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources

from ..recipe import Recipe


@dataclass(frozen=True)
class Person:
    """A named recipe.

    Attributes:
        name: As in "amara": a rig is called so.
        title: One line about them.
        recipe: What they look like.
    """

    name: str
    title: str
    recipe: Recipe


@cache
def people() -> Mapping[str, Person]:
    """Return the people by name."""
    text = resources.files(__package__).joinpath("data", "people.json").read_text("utf-8")
    return {
        name: Person(name, entry["title"], Recipe.of(entry["recipe"]))
        for name, entry in json.loads(text)["people"].items()
    }
