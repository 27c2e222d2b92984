"""What is wrong with a body, in plain words: what was given, what was expected, what to do.

Every complaint of pydantic about what a client, a file or a setting says passes through `explain`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

UNKNOWN_FIELD = "unknown_field"
"""Error of a field that a body does not have; its context has `given`, and those `known`."""
_PARTS = ("body", "query", "path", "header")
_JSON_HEADER = "the header 'Content-Type: application/json'"
_SHOWN = 40
"""Most characters of what was given that are repeated."""
_PLAIN_TYPES = (
    (("float", "finite"), "a number"),
    (("int",), "a whole number"),
    (("bool",), "true or false"),
    (("string",), "text"),
    (("dict", "model", "mapping"), "an object, {…}"),
    (("list", "tuple", "set"), "a list, […]"),
    (("none",), "null"),
)
_BOUNDS = {
    "less_than_equal": ("le", "a number of at most {}"),
    "less_than": ("lt", "a number below {}"),
    "greater_than_equal": ("ge", "a number of at least {}"),
    "greater_than": ("gt", "a number above {}"),
    "string_too_long": ("max_length", "at most {} characters"),
    "string_too_short": ("min_length", "at least {} characters"),
    "too_long": ("max_length", "at most {} entries"),
    "too_short": ("min_length", "at least {} entries"),
}


@dataclass(frozen=True)
class Explained:
    """What is wrong.

    Attributes:
        message: One sentence without its full stop.
        known: Names that would have been accepted, if it is about a name.
    """

    message: str
    known: tuple[str, ...] | None = None

    def __str__(self) -> str:
        return self.message


def explain(
    errors: Sequence[Any], data: object = None, *, media_type: str | None = None
) -> Explained:
    """Return what is wrong, by pydantic's `errors`.

    Args:
        errors: From `ValidationError.errors()`.
        data: What was read, by which names in it are told from pydantic's own.
        media_type: Content type with which it was sent over HTTP.
    """
    if not errors:
        return Explained("what was sent cannot be read; send JSON, encoded as UTF-8")
    places: dict[tuple[str, ...], list[Mapping[str, Any]]] = {}
    for error in errors:
        places.setdefault(_place(error, data), []).append(error)
    # Where one form out of several is asked for, that which was followed farthest is meant.
    meant = [
        place for place in places if not any(p[: len(place)] == place != p for p in places if place)
    ]
    place = meant[0]
    found = _explained(place, places[place], media_type)
    more = len(meant) - 1
    if not more:
        return found
    also = "and one more thing is" if more == 1 else f"and {more} more things are"
    return Explained(f"{found.message} ({also} wrong)", found.known)


def did_you_mean(name: str, known: Sequence[str]) -> str:
    """Return the end of a sentence about an unknown name, empty if no known one looks like it."""
    near = get_close_matches(name, known, n=3)
    return f"; did you mean {_either([repr(one) for one in near])}?" if near else ""


def _place(error: Mapping[str, Any], data: object) -> tuple[str, ...]:
    """Return where an error is, without what pydantic calls the alternatives of a choice."""
    parts = list(error["loc"])
    where = [parts.pop(0)] if parts and parts[0] in _PARTS else ["body"]
    if error["type"] == "json_invalid":
        return ()
    here, names = data, []
    for index, part in enumerate(parts):
        last = index == len(parts) - 1
        if isinstance(here, Mapping) and part in here:
            here = here[part]
        elif isinstance(here, list) and isinstance(part, int) and part < len(here):
            here = here[part]
        elif not (where[0] != "body" or data is None or (last and error["type"] == "missing")):
            continue
        names.append(str(part))
    return tuple(names)


def _explained(
    place: tuple[str, ...], errors: Sequence[Mapping[str, Any]], media_type: str | None
) -> Explained:
    first = errors[0]
    name = ".".join(place)
    kind = first["type"]
    if kind == "json_invalid":
        return _not_json(first)
    if not place and kind != "missing" and media_type is not None and not is_json(media_type):
        sent = f"as {media_type!r}" if media_type else "without a content type"
        return Explained(f"the body was sent {sent}; send JSON with {_JSON_HEADER}")
    if kind == UNKNOWN_FIELD:
        return _unknown_field(name, first)
    if not place and kind == "missing":
        return Explained(f"the body is empty; send JSON with {_JSON_HEADER}")
    expected = _either(list(dict.fromkeys(map(_expected, errors))))
    if kind == "missing":
        return Explained(f"{name} is missing")
    what, given = name or "the body", first.get("input")
    if kind == "union_tag_not_found":
        field = str(first["ctx"]["discriminator"]).strip("'")
        return Explained(f"{'.'.join([*place, field])} is missing")
    if kind == "union_tag_invalid":
        field = str(first["ctx"]["discriminator"]).strip("'")
        what, given = ".".join([*place, field]), first["ctx"]["tag"]
    if "[key]" in first["loc"]:
        what, given = f"the name {_shown(place[-1])}", ...
    hint = ""
    words = [word for error in errors for word in _words(error)]
    if isinstance(given, str) and words:
        hint = did_you_mean(given, words)
    said = "" if given is ... else f" is {_shown(given)}"
    if not expected:
        return Explained(f"{what}{said}: {_own_words(first)}")
    verb = "; expected " if said else " cannot be used; expected "
    return Explained(f"{what}{said}{verb}{expected}{hint}")


def is_json(media_type: str) -> bool:
    """Return whether a content type is that of JSON."""
    kind = media_type.partition(";")[0].strip().lower()
    return kind == "application/json" or kind.endswith("+json")


def _not_json(error: Mapping[str, Any]) -> Explained:
    reason = _uncapitalized(str(error.get("ctx", {}).get("error", "")) or _own_words(error))
    loc = error["loc"]
    at = f", at character {loc[-1] + 1}" if loc and isinstance(loc[-1], int) else ""
    return Explained(f"the body is not JSON: {reason}{at}; check quotes, commas and braces there")


def _unknown_field(name: str, error: Mapping[str, Any]) -> Explained:
    known = tuple(str(field) for field in error["ctx"]["known"])
    field = str(error["ctx"]["given"])
    of = f" in {name}" if name else ""
    hint = did_you_mean(field, known) or f"; there {'are' if len(known) > 1 else 'is'} "
    tail = "" if "did you mean" in hint else _either(list(map(repr, known)), "and")
    return Explained(f"there is no field {_shown(field)}{of}{hint}{tail}", known)


def _expected(error: Mapping[str, Any]) -> str:
    """Return what an error asks for, in words; nothing where its own words say more."""
    kind, context = str(error["type"]), error.get("ctx", {})
    if kind in _BOUNDS:
        name, phrase = _BOUNDS[kind]
        bound = context[name]
        return phrase.format(f"{bound:g}" if isinstance(bound, float) else bound)
    if words := _words(error):
        return _either(
            ["one of " + ", ".join(map(repr, words)) if len(words) > 1 else repr(words[0])]
        )
    if kind in ("missing", "value_error", "assertion_error"):
        return ""
    stem = kind.partition("_")[0]
    if kind == "finite_number":
        return "a finite number"
    return next((plain for stems, plain in _PLAIN_TYPES if stem in stems), "")


def _words(error: Mapping[str, Any]) -> list[str]:
    """Return the words that a choice would have accepted."""
    context = error.get("ctx", {})
    said = str(context.get("expected") or context.get("expected_tags") or "")
    return re.findall(r"'([^']*)'", said)


def _own_words(error: Mapping[str, Any]) -> str:
    message = str(error.get("msg", "it cannot be used")).removeprefix("Value error, ")
    return _uncapitalized(message)


def _uncapitalized(sentence: str) -> str:
    return sentence if sentence[1:2].isupper() else sentence[:1].lower() + sentence[1:]


def _shown(value: object) -> str:
    """Return what was given, as JSON where it can be, shortened."""
    if isinstance(value, str):
        text = repr(value)
    else:
        try:
            text = json.dumps(value, ensure_ascii=False)
        except (TypeError, ValueError, RecursionError):
            text = type(value).__name__
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 1]}…"


def _either(words: list[str], join: str = "or") -> str:
    words = [word for word in words if word]
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} {join} {words[-1]}"
