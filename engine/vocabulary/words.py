"""Words as they are written and as they are looked up: one form, and one stem."""

from __future__ import annotations

import re
import unicodedata

_JOINTS = re.compile(r"[\s_\-\u2010-\u2015.,!?/]+")
_INVISIBLE = re.compile(
    "[\u200b\u2060\ufeff\ufe00-\ufe0f\U000e0100-\U000e01ef\U0001f3fb-\U0001f3ff]"
)
"""What changes only how a word or an emoji is drawn: variation selectors of both of Unicode's
blocks, tones of skin, spaces of no width."""
_ENDINGS = ("ness", "ment", "ful", "ing", "est", "ed", "er", "ly", "es", "s")
_LEAST = 3
"""Fewest letters of a stem."""


def normal(text: str) -> str:
    """Return `text` as labels are compared: lower case, words apart by one space."""
    plain = _INVISIBLE.sub("", unicodedata.normalize("NFKC", text)).casefold()
    return _JOINTS.sub(" ", plain).strip()


def stem(text: str) -> str:
    """Return what the inflections of a normal form have in common: "happi-ly", "happi-ness".

    Only endings that keep a word's sense are taken off, "joyful" to "joy"; "joyless" stays.
    """
    return " ".join(_stem(word) for word in text.split())


def _stem(word: str) -> str:
    shorter = word
    while (ending := _ending(shorter)) is not None:
        shorter = shorter.removesuffix(ending)
    while len(shorter) > _LEAST and shorter[-1] in "eiy":
        shorter = shorter[:-1]
    if len(shorter) > _LEAST and shorter[-1] == shorter[-2]:
        shorter = shorter[:-1]
    return shorter


def _ending(word: str) -> str | None:
    for ending in _ENDINGS:
        whole = ending == "s" and word.endswith(("ss", "us", "is"))
        if word.endswith(ending) and len(word) - len(ending) >= _LEAST and not whole:
            return ending
    return None
