"""All words that name a face: recipes, vocabularies, and what is found under a word."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property, lru_cache
from importlib import resources
from typing import Any

import numpy as np

from ..emotion import Emotion
from ..errors import UnknownName
from ..rig_data import load_emotions
from .meaning import OWN_NAMES, Meaning, Vocabulary
from .recipe import Recipe, Variant
from .words import normal, stem

_NEAREST = 5
"""Known words named to somebody who asked for an unknown one."""


@dataclass(frozen=True)
class Entry:
    """A word that is known.

    Attributes:
        word: In its normal form.
        kind: "label", or "synonym" for another word.
        meaning: What it plays.
    """

    word: str
    kind: str
    meaning: Meaning


@dataclass(frozen=True)
class Lexicon:
    """Every recipe and every vocabulary, by name."""

    recipes: Mapping[str, Recipe]
    vocabularies: Mapping[str, Vocabulary]

    def find(self, label: str, vocabulary: str | None = None) -> tuple[Meaning, str]:
        """Return what `label` means, and how it was found: "label", "synonym" or "inflection".

        Names of recipes come first, then labels in the order of the vocabularies, then other
        words, then inflections. Within one vocabulary, a word that is none of its labels is taken
        for the label of the same face.

        Args:
            label: Any word or emoji.
            vocabulary: Whose labels alone are meant.

        Raises:
            UnknownName: With the nearest labels, or the known vocabularies.
        """
        word = normal(label)
        if vocabulary is not None:
            return self._find_in(self._vocabulary(vocabulary), label)
        entry = self._words.get(word)
        if entry is not None:
            return entry.meaning, entry.kind
        entry = self._stems.get(stem(word))
        if entry is not None:
            return entry.meaning, "inflection"
        raise self._unknown(label, list(self.recipes), list(self._words))

    @cached_property
    def _words(self) -> Mapping[str, Entry]:
        """The first entry of each word."""
        words: dict[str, Entry] = {}
        for entry in self._entries():
            words.setdefault(entry.word, entry)
        return words

    @cached_property
    def _stems(self) -> Mapping[str, Entry]:
        """The first entry of each stem."""
        stems: dict[str, Entry] = {}
        for entry in self._words.values():
            stems.setdefault(stem(entry.word), entry)
        return stems

    def _entries(self) -> Iterator[Entry]:
        for name in self.recipes:
            yield Entry(normal(name), "label", self._own(name))
        for vocabulary in self.vocabularies.values():
            for label, meaning in vocabulary.labels.items():
                yield Entry(normal(label), "label", meaning)
        for name, recipe in self.recipes.items():
            for synonym in recipe.synonyms:
                yield Entry(normal(synonym), "synonym", self._own(name))
        for vocabulary in self.vocabularies.values():
            for label, other in vocabulary.names.items():
                yield Entry(normal(other), "synonym", vocabulary.labels[label])

    def _own(self, name: str) -> Meaning:
        return Meaning(name, OWN_NAMES, ((name, 1.0),))

    def _vocabulary(self, name: str) -> Vocabulary:
        found = self.vocabularies.get(name.strip().casefold())
        if found is None:
            raise UnknownName("vocabulary", name, self.vocabularies)
        return found

    def _find_in(self, vocabulary: Vocabulary, label: str) -> tuple[Meaning, str]:
        word = normal(label)
        for known, meaning in vocabulary.labels.items():
            if normal(known) == word:
                return meaning, "label"
        for known, meaning in vocabulary.labels.items():
            if stem(normal(known)) == stem(word):
                return meaning, "inflection"
        entry = self._words.get(word) or self._stems.get(stem(word))
        if entry is not None:
            for meaning in vocabulary.labels.values():
                same_face = (meaning.parts, meaning.facs) == (
                    entry.meaning.parts,
                    entry.meaning.facs,
                )
                if same_face:
                    return meaning, "synonym" if word in self._words else "inflection"
        labels = list(vocabulary.labels)
        raise self._unknown(label, labels, labels)

    @staticmethod
    def _unknown(label: str, known: list[str], words: list[str]) -> UnknownName:
        near = get_close_matches(normal(label), words, n=_NEAREST)
        return UnknownName("emotion", label, known, nearest=near)


@lru_cache(maxsize=1)
def lexicon() -> Lexicon:
    """Return the built-in lexicon, read from `engine/data`."""
    emotions = load_emotions()
    recipes = {e["name"]: _recipe(e, emotions) for e in _read("recipes.json")["recipes"]}
    entries = _read("vocabularies.json")["vocabularies"]
    return Lexicon(recipes, {entry["name"]: _vocabulary(entry) for entry in entries})


def _recipe(entry: Mapping[str, Any], emotions: Mapping[str, Emotion]) -> Recipe:
    words = [normal(word) for word in entry.get("synonyms", ())]
    if entry["name"] in emotions:
        words = [*emotions[entry["name"]].synonyms, *words]
    return Recipe(
        name=entry["name"],
        variants=tuple(_variant(variant, emotions) for variant in entry["variants"]),
        place=np.array([entry["valence"], entry["arousal"], entry["dominance"]], dtype=np.float64),
        place_source=entry["coordinates"],
        anchor=entry.get("anchor", False),
        synonyms=tuple(dict.fromkeys(words)),
    )


def _variant(entry: Mapping[str, Any], emotions: Mapping[str, Emotion]) -> Variant:
    if "emotion" in entry:  # A face of the rig: its units stand in one place.
        emotion = emotions[entry["emotion"]]
        return Variant(emotion.recipe, entry["weight"], emotion.source)
    return Variant(entry["facs"], entry["weight"], entry["source"])


def _vocabulary(entry: Mapping[str, Any]) -> Vocabulary:
    labels = {
        label: _meaning(label, entry["name"], plays) for label, plays in entry["labels"].items()
    }
    names = entry.get("names", {})
    return Vocabulary(entry["name"], entry["title"], entry["source"], entry["faces"], labels, names)


def _meaning(label: str, vocabulary: str, plays: str | Mapping[str, Any]) -> Meaning:
    if isinstance(plays, str):
        return Meaning(label, vocabulary, ((plays, 1.0),))
    if "facs" in plays:
        return Meaning(label, vocabulary, (), plays["facs"])
    return Meaning(label, vocabulary, tuple((name, float(w)) for name, w in plays.items()))


def _read(name: str) -> dict[str, Any]:
    text = resources.files("engine").joinpath("data", name).read_text(encoding="utf-8")
    data: dict[str, Any] = json.loads(text)
    return data
