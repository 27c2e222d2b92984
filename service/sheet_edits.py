"""Edits of a rig that a contact sheet shows beside it, and what each picture calls them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from .bodies import NewRig
from .explaining import explain

_EXAMPLE = """{"palsy": {"side": "left", "grade": "IV"}}"""
_LONGEST = 60
"""Most characters of a label that nobody wrote: a map has a number for every node."""
_UNSAID = ("side", "grade")
"""Fields whose values say what they are: palsy left IV."""


class EditRefused(Exception):
    """An edit that cannot be used; the message is one sentence."""


@dataclass(frozen=True)
class Edit:
    """What is changed of a rig.

    Attributes:
        label: Written under its pictures.
        changes: Body of `POST /api/rigs` without its base.
    """

    label: str
    changes: Mapping[str, Any]


def read_edits(texts: Sequence[str]) -> tuple[Edit, ...]:
    """Return the edits that JSON texts hold, each a body of `POST /api/rigs`.

    Raises:
        EditRefused: If one is not JSON or no such body, names a base, changes nothing, or if two
            have one label.
    """
    edits = tuple(_edit(text) for text in texts)
    labels = [edit.label for edit in edits]
    for label in labels:
        if labels.count(label) > 1:
            raise EditRefused(f'Two edits are called {label!r}; give each a "name" of its own.')
    return edits


def _edit(text: str) -> Edit:
    try:
        data = json.loads(text)
        body = NewRig.model_validate(data)
    except ValidationError as error:
        found = explain(list(error.errors()), data)
        raise EditRefused(f"The edit {_shortened(text)} cannot be used: {found}.") from error
    except json.JSONDecodeError as error:
        raise EditRefused(
            f"The edit {_shortened(text)} is not JSON ({error.msg.lower()} at character"
            f" {error.pos + 1}); write it like '{_EXAMPLE}', in single quotes for the shell."
        ) from error
    except (ValueError, RecursionError) as error:
        raise EditRefused(f"The edit {_shortened(text)} is not JSON: {error}.") from error
    if "base" in body.model_fields_set:
        raise EditRefused(f"The edit {_shortened(text)} names a base; name it with --rig instead.")
    changes = body.model_dump(exclude={"base", "passing"}, exclude_none=True, exclude_unset=True)
    said = {name: value for name, value in changes.items() if name != "name"}
    if not any(said.values()):
        raise EditRefused(
            f"The edit {_shortened(text)} changes nothing; write it like '{_EXAMPLE}'."
        )
    return Edit(body.name or _shortened(", ".join(_words(said))), changes)


def _words(changes: Mapping[str, Any], before: str = "") -> Iterator[str]:
    """Yield in words what each part of some changes asks for: "palsy left IV"."""
    plain = {name: value for name, value in changes.items() if not isinstance(value, Mapping)}
    if before and plain:
        yield " ".join((before, *(_said(name, value) for name, value in plain.items())))
    elif plain:
        yield from (_said(name, value) for name, value in plain.items())
    for name, value in changes.items():
        if isinstance(value, Mapping):
            yield from _words(value, f"{before} {_plain(name)}".lstrip())


def _said(name: str, value: object) -> str:
    if isinstance(value, list):
        return f"{_plain(name)} (a map)"
    said = f"{value:g}" if isinstance(value, float) else f"{value}"
    return said if name in _UNSAID else f"{_plain(name)} {said}"


def _plain(name: str) -> str:
    return name.replace("_", " ")


def _shortened(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
