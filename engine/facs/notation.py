"""FACS notation, read and written: "1C+2C+L4B+R12D+26" (FACS manual, chapter on scoring)."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from ..errors import InvalidNotation
from .scales import UNSCORED, letter_of, nearest_letter, scale_named

SIDES = ("", "L", "R", "T", "B")
"""What of a unit is meant, as it is ordered: all, the face's left or right, top or bottom lip."""
NEUTRAL = "0"
"""How FACS writes a face on which nothing is seen; it stands alone."""

_SHOWN = 60
"""Most characters of an unreadable string that are repeated."""
_UNIT = r"(?P<side>[LRTB])?(?P<prefix>A[UD]|M)?0*(?P<number>[1-9]\d?)"
_NUMBER = r"\d{1,2}(?:\.\d{1,40})?(?:E-?\d{1,3})?|\.\d{1,40}"
_TERM = re.compile(rf"{_UNIT}(?:(?P<letter>[A-E*])|:(?P<intensity>{_NUMBER}))?", re.ASCII)
_NAME = re.compile(_UNIT, re.ASCII)
_NEUTRAL = re.compile(r"(?:AU)?0+", re.ASCII)


@dataclass(frozen=True)
class Term:
    """One unit of a FACS string: `R12D` is side "R", name "AU12", intensity 0.8.

    Attributes:
        name: "AU12"; "M59" for a code of movement.
        side: One of `SIDES`.
        intensity: 0..1.
    """

    name: str
    side: str
    intensity: float

    @property
    def key(self) -> str:
        """The unit as controls name it: "AU12", "L12", "R12", "T28" or "B28"."""
        return f"{self.side}{self._code}" if self.side else self.name

    @property
    def order(self) -> tuple[int, bool, int]:
        """Where FACS coders write it: by rising number, positions before movements, then sides."""
        moves = self.name.startswith("M")
        return int(self._code.removeprefix("M")), moves, SIDES.index(self.side)

    @property
    def _code(self) -> str:
        return self.name.removeprefix("AU")


def parse_facs(text: str, scale: str = "linear") -> tuple[Term, ...]:
    """Read a FACS string such as "1C+2C+L4B+R12D+26".

    Spaces and lower case are allowed, as are "AU12" for "12" and "AD19", as descriptors are often
    written, for "19". A letter is read by `scale`; a unit without letter or with `*` is `UNSCORED`;
    "12:0.37" is an intensity between letters. `NEUTRAL` is a face without units.

    Raises:
        InvalidNotation: With the part that cannot be read.
        UnknownName: If there is no such scale.
    """
    letters = scale_named(scale)
    cleaned = re.sub(r"\s+", "", text).upper()
    if not cleaned:
        raise InvalidNotation("the FACS string is empty; expected units such as '6C+12D'")
    if _NEUTRAL.fullmatch(cleaned):
        return ()
    terms = []
    for part in cleaned.split("+"):
        match = _TERM.fullmatch(part)
        if match is None:
            raise InvalidNotation(_unreadable(part, text))
        if match["intensity"] is None:
            letter = match["letter"]
            intensity = letters[letter if letter in letters else UNSCORED]
        else:
            intensity = float(match["intensity"])
        if intensity > 1.0:
            raise InvalidNotation(
                f"{_short(part)} in {_short(text)} is beyond the scale; an intensity is 0 to 1, "
                "such as '12:0.37'"
            )
        terms.append(Term(_name(match), match["side"] or "", intensity))
    return tuple(terms)


def print_facs(terms: Iterable[Term], scale: str = "linear") -> str:
    """Write terms in the canonical form, so that `parse_facs` reads the very same terms from it.

    Units stand in FACS' order, by rising number. An intensity that is a letter of `scale` is
    written as it; any other as a number, "12:0.37". No terms are `NEUTRAL`.

    Raises:
        UnknownName: If there is no such scale.
    """
    written = [
        f"{term.side}{term._code}{_intensity(term.intensity, scale)}"
        for term in sorted(terms, key=lambda term: term.order)
    ]
    return "+".join(written) or NEUTRAL


def format_facs(terms: Iterable[Term], scale: str = "linear") -> str:
    """Write terms as they come, each with the nearest letter: short, and rounded.

    Raises:
        UnknownName: If there is no such scale.
    """
    return "+".join(
        f"{term.side}{term._code}{nearest_letter(term.intensity, scale)}" for term in terms
    )


def split_side(key: str) -> tuple[str, str]:
    """Return ("AU12", "L") for "L12", ("AU12", "") for "AU12", "12" or "au12".

    "AD19", an action descriptor, is "AU19".

    Raises:
        InvalidNotation: If `key` does not name an action unit.
    """
    match = _NAME.fullmatch(key.strip().upper())
    if match is None:
        raise InvalidNotation(
            f"{key!r} does not name an action unit; expected 'AU12', 'L12' or 'R12'"
        )
    return _name(match), match["side"] or ""


def term_of(key: str, intensity: float) -> Term:
    """Return the term of a unit as controls name it: "L12" at 0.8 is `L12D`.

    Raises:
        InvalidNotation: If `key` does not name an action unit.
    """
    name, side = split_side(key)
    return Term(name, side, intensity)


def _name(match: re.Match[str]) -> str:
    return f"{'M' if match['prefix'] == 'M' else 'AU'}{int(match['number'])}"


def _intensity(value: float, scale: str) -> str:
    # The shortest digits that read back as the same number; 0.0 added, for a zero has no sign.
    return letter_of(value, scale) or f":{float(value) + 0.0!r}".removesuffix(".0")


def _unreadable(part: str, text: str) -> str:
    """Return what is wrong with a part of a FACS string, and what was probably meant."""
    if _NEUTRAL.fullmatch(part):
        return f"'0' is the neutral face and stands alone, but {_short(text)} has other units too"
    # Units that are set apart by something else than a plus.
    meant = [unit for unit in re.split(r"[\s,;+]+", text.strip().upper()) if unit]
    if len(meant) > 1 and all(_TERM.fullmatch(unit) for unit in meant):
        return f"units are joined by '+': {_short(text)} may mean '{'+'.join(meant)}'"
    return (
        f"cannot read {_short(part)} in {_short(text)}; expected an optional side L or R (T or B "
        "of the lips), a unit's number, and an optional letter A to E, such as 'R12D'"
    )


def _short(text: str) -> str:
    return repr(text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…")
