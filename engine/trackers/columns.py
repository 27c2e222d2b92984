"""Columns by name: case and spaces never matter, nor does their order."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from ..errors import InvalidTrack

MOST_NAMED = 64
"""Columns of one kind that a report names."""
_NUMBERED = re.compile(r"\d+$")


class Columns:
    """The columns of a header, found by their names in small letters."""

    def __init__(self, header: Sequence[str]) -> None:
        self.header = tuple(header)
        self._places: dict[str, list[str]] = {}
        for name in header:
            self._places.setdefault(name.lower(), []).append(name)

    def __len__(self) -> int:
        return len(self.header)

    def __contains__(self, name: str) -> bool:
        return name.lower() in self._places

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names in small letters."""
        return iter(self._places)

    def has(self, *names: str) -> bool:
        """Return whether every one of these columns is there."""
        return all(name in self for name in names)

    def find(self, name: str) -> str | None:
        """Return a column's name as it stands in the header, None where it is not there.

        Raises:
            InvalidTrack: If several columns have that name.
        """
        found = self._places.get(name.lower(), [])
        if len(found) > 1:
            raise InvalidTrack(
                f"the header has {len(found)} columns named {name!r}; expected one: rename or "
                "remove the others"
            )
        return found[0] if found else None

    def first(self, *names: str) -> str | None:
        """Return the first of several names that is there."""
        return next((self.find(name) for name in names if name in self), None)


def grouped(names: Iterable[str]) -> dict[str, int]:
    """Return columns counted by what they have in common: "x_0" to "x_67" are 68 of "x_#"."""
    groups: dict[str, int] = {}
    for name in names:
        group = _NUMBERED.sub("#", name) if "_" in name else name
        groups[group] = groups.get(group, 0) + 1
    return groups


def shortened(names: Sequence[str]) -> tuple[str, ...]:
    """Return the first `MOST_NAMED` of some names, and how many more there are."""
    more = len(names) - MOST_NAMED
    return (*names[:MOST_NAMED], *([f"{more} more"] if more > 0 else []))
