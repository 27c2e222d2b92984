"""What can go wrong in the engine.

EngineError
├── UnknownName      a rig, muscle, action unit, emotion or point that is not there
├── InvalidValue     a number or field outside what is allowed
├── InvalidHead      a mesh that cannot carry tissue
├── InvalidNotation  a FACS string that cannot be read
├── InvalidTrack     a timeline or tracker file that cannot be read
├── Diverged         a simulation that left the finite numbers
└── Cancelled        work that its caller stopped
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches


class EngineError(Exception):
    """Anything the engine refuses; the message says what was given and what was expected."""


class UnknownName(EngineError):
    """A name that is not known.

    Attributes:
        kind: What was looked for ("muscle", "emotion", …).
        name: The name that was given.
        known: The names that exist.
        nearest: Known names that look like the given one, best first.
    """

    def __init__(
        self, kind: str, name: str, known: Iterable[str], *, nearest: Sequence[str] | None = None
    ) -> None:
        self.kind = kind
        self.name = name
        self.known = sorted(known)
        if nearest is None:
            self.nearest = get_close_matches(name, self.known, n=3)
        else:  # Found among more names than are worth telling: they come first.
            self.nearest = list(nearest)
            self.known = list(dict.fromkeys([*nearest, *self.known]))
        hint = f"; did you mean {', '.join(self.nearest)}?" if self.nearest else ""
        super().__init__(f"there is no {kind} named {name!r}{hint}")


class InvalidValue(EngineError):
    """A value outside its allowed range or of the wrong kind."""


class InvalidHead(EngineError):
    """A mesh that cannot be used as a face."""


class InvalidNotation(EngineError):
    """A FACS string that cannot be read."""


class InvalidTrack(EngineError):
    """A timeline or tracker file that cannot be read."""


class Diverged(EngineError):
    """A simulation whose numbers are no longer finite."""


class Cancelled(EngineError):
    """Raised where a recording stops because its caller asked for it."""
