"""Action units of the Facial Action Coding System, and the notation for them (section 3)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from .errors import InvalidNotation

LETTERS: Mapping[str, float] = {"A": 0.2, "B": 0.4, "C": 0.6, "D": 0.8, "E": 1.0}
"""FACS intensities A (trace) to E (maximum) in even steps, as trackers count them."""
REGIONS = ("upper", "lids", "lower", "cheeks", "jaw", "tongue", "gaze", "head")
"""Where on the face a unit acts."""
UNSCORED = 0.6
"""Intensity of a unit without letter, or with `*`: the middle of the scale, C."""

_SHOWN = 60
"""Most characters of an unreadable string that are repeated."""
_TERM = re.compile(r"(?P<side>[LR])?(?:AU)?0*(?P<number>\d{1,2})(?P<letter>[A-E*])?")
_NAME = re.compile(r"(?:(?P<left_first>[LR])(?:AU)?|AU)?0*(?P<number>\d{1,2})")


@dataclass(frozen=True)
class ActionUnit:
    """One visible action of the face, as weighted muscle contractions.

    Attributes:
        name: "AU12".
        title: FACS' name, "Lip corner puller".
        region: One of `REGIONS`, for grouping.
        muscles: Weight of each muscle, named without side, at intensity 1; below 0 a muscle with
            tone relaxes, and air is sucked in.
        pose: Turn (degrees) or thrust (mm) at intensity 1 by axis: "jaw.pitch", "gaze.yaw".
        one_sided: True where FACS scores one side only: the unit without a side is the left one.
        curve: Knots (intensity, scale of the recipe), rising from (0, 0): the calibration that
            makes intensity the fraction of the full landmark displacement.
        source: Where the recipe comes from.
        description: What is seen, after the FACS manual, in our words.
        sources: Where each muscle of the recipe comes from, by muscle.
        onset, offset: Seconds from rest to full and back, where a command gives no time.
        timing: Where these two come from.
    """

    name: str
    title: str
    region: str = "lower"
    muscles: Mapping[str, float] = field(default_factory=dict)
    pose: Mapping[str, float] = field(default_factory=dict)
    one_sided: bool = False
    curve: tuple[tuple[float, float], ...] = ((0.0, 0.0), (1.0, 1.0))
    source: str = ""
    description: str = ""
    sources: Mapping[str, str] = field(default_factory=dict)
    onset: float = 0.35
    offset: float = 0.5
    timing: str = ""

    @property
    def jaw(self) -> float:
        """Turn of the jaw at intensity 1, degrees: what opens the mouth."""
        return self.pose.get("jaw.pitch", 0.0)

    @property
    def still(self) -> bool:
        """Whether it moves nothing at all."""
        return not (any(self.muscles.values()) or any(self.pose.values()))

    def scale(self, intensity: float) -> float:
        """Return the factor on the recipe at `intensity`, 0..1, along the calibrated curve."""
        last_intensity, last_scale = 0.0, 0.0
        for knot, scale in self.curve:
            if intensity <= knot:
                span = knot - last_intensity
                share = (intensity - last_intensity) / span if span > 0.0 else 1.0
                return last_scale + (scale - last_scale) * share
            last_intensity, last_scale = knot, scale
        return last_scale

    def reaching(self, factor: float) -> ActionUnit:
        """Return the unit with its curve scaled: on a face that it moves too far or not enough."""
        return replace(self, curve=tuple((knot, factor * scale) for knot, scale in self.curve))


@dataclass(frozen=True)
class Term:
    """One unit of a FACS string: `R12D` is side "R", name "AU12", intensity 0.8."""

    name: str
    side: str
    intensity: float

    @property
    def key(self) -> str:
        """The unit as controls name it: "AU12", "L12" or "R12"."""
        return f"{self.side}{self.name.removeprefix('AU')}" if self.side else self.name


def parse_facs(text: str) -> tuple[Term, ...]:
    """Read a FACS string such as "1C+2C+L4B+R12D+26".

    Spaces and lower case are allowed, as is "AU12" for "12"; letters are `LETTERS`, a unit without
    letter or with `*` is `UNSCORED`.

    Raises:
        InvalidNotation: With the part that cannot be read.
    """
    cleaned = re.sub(r"\s+", "", text).upper()
    if not cleaned:
        raise InvalidNotation("the FACS string is empty; expected units such as '6C+12D'")
    terms = []
    for part in cleaned.split("+"):
        match = _TERM.fullmatch(part)
        if match is None:
            raise InvalidNotation(_unreadable(part, text))
        letter = match["letter"]
        intensity = LETTERS[letter] if letter in LETTERS else UNSCORED
        terms.append(Term(f"AU{int(match['number'])}", match["side"] or "", intensity))
    return tuple(terms)


def _unreadable(part: str, text: str) -> str:
    """Return what is wrong with a part of a FACS string, and what was probably meant."""
    # Units that are set apart by something else than a plus.
    meant = [unit for unit in re.split(r"[\s,;+]+", text.strip().upper()) if unit]
    if len(meant) > 1 and all(_TERM.fullmatch(unit) for unit in meant):
        return f"units are joined by '+': {_short(text)} may mean '{'+'.join(meant)}'"
    return (
        f"cannot read {_short(part)} in {_short(text)}; expected an optional side L or R, a unit's "
        "number, and an optional letter A to E, such as 'R12D'"
    )


def _short(text: str) -> str:
    return repr(text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…")


def format_facs(terms: Iterable[Term]) -> str:
    """Write terms as a FACS string, each with the nearest letter."""
    return "+".join(
        f"{term.side}{term.name.removeprefix('AU')}{nearest_letter(term.intensity)}"
        for term in terms
    )


def nearest_letter(intensity: float) -> str:
    """Return the letter whose intensity is nearest."""
    return min(LETTERS, key=lambda letter: abs(LETTERS[letter] - intensity))


def split_side(key: str) -> tuple[str, str]:
    """Return ("AU12", "L") for "L12", ("AU12", "") for "AU12", "12" or "au12".

    Raises:
        InvalidNotation: If `key` does not name an action unit.
    """
    match = _NAME.fullmatch(key.strip().upper())
    if match is None:
        raise InvalidNotation(
            f"{key!r} does not name an action unit; expected 'AU12', 'L12' or 'R12'"
        )
    return f"AU{int(match['number'])}", match["left_first"] or ""
