"""FACS on a rig: which units a command plays, and what is said of the others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass

from engine import (
    LIPS,
    SCALES,
    EngineError,
    FacsWarning,
    InvalidNotation,
    Rig,
    UnknownName,
    facs_codes,
    parse_facs,
    print_facs,
    split_side,
    term_of,
)

from .bodies import Units
from .errors import Unprocessable, refused_by_engine

_DECIMALS = 3
"""Of an intensity that is a product or a mixture: more would be noise of the arithmetic."""


@dataclass(frozen=True)
class Named:
    """One unit as a command names it.

    Attributes:
        place: The field it stands in: "facs" or "action_units".
        key: "AU12", "L12", "T28", or the name of a rig's own unit.
        intensity: 0..1.
    """

    place: str
    key: str
    intensity: float


@dataclass(frozen=True)
class Playable:
    """What of a command's units a rig plays.

    Attributes:
        units: Intensities by key, for the rig.
        warnings: What is played otherwise than it was named, or not at all.
    """

    units: Mapping[str, float]
    warnings: tuple[FacsWarning, ...]


def named_units(command: Units, rig: Rig) -> list[Named]:
    """Return the units of a command in order, the FACS string first, letters read by its scale.

    Raises:
        Unprocessable: If the FACS string cannot be read.
    """
    letters = SCALES[command.scale]
    named = []
    if command.facs is not None:
        try:
            terms = parse_facs(command.facs, command.scale)
        except EngineError as error:
            raise refused_by_engine(error) from error
        named = [Named("facs", term.key, term.intensity) for term in terms]
    for key, value in (command.action_units or {}).items():
        intensity = letters[value] if isinstance(value, str) else value
        named.append(Named("action_units", one_key(key, rig), intensity))
    return named


def one_key(key: str, rig: Rig) -> str:
    """Return the one way to write a unit's key: "AU12" for "12", "L12" for "lau12"."""
    if key in rig.action_units:
        return key
    with suppress(InvalidNotation):
        return term_of(key, 0.0).key
    return key


def playable(command: Units, rig: Rig) -> Playable:
    """Return what `rig` plays of a command's units; of a unit named twice the latter counts.

    Raises:
        Unprocessable: If the FACS string cannot be read, or for a code that FACS does not have.
    """
    units: dict[str, float] = {}
    lips: dict[str, float] = {}
    warnings = []
    for named in named_units(command, rig):
        try:
            rig.resolve_unit(named.key)
        except UnknownName as error:
            whole, warning = _instead(named.key, rig, error)
            warnings.append(warning)
            if whole is not None:
                lips[whole] = max(named.intensity, lips.get(whole, 0.0))
        else:
            units[named.key] = named.intensity
    return Playable({**lips, **units}, tuple(dict.fromkeys(warnings)))


def written(units: Mapping[str, float], scale: str = "linear") -> str:
    """Return what a face plays as a FACS string, to a thousandth.

    A rig's own units, which have no number, are not in it.
    """
    terms = []
    for key, intensity in units.items():
        shown = round(intensity, _DECIMALS)
        with suppress(InvalidNotation):
            terms += [term_of(key, shown)] if shown > 0.0 else []
    return print_facs(terms, scale)


def with_facs(report: Mapping[str, object], scale: str = "linear") -> dict[str, object]:
    """Return a face's report with the units of `merged` as a FACS string too, and its scale."""
    merged = report["merged"]
    assert isinstance(merged, Mapping)
    facs = written(merged["action_units"], scale)
    return {**report, "merged": {**merged, "facs": facs, "scale": scale}}


def _instead(key: str, rig: Rig, error: UnknownName) -> tuple[str | None, FacsWarning]:
    """Return the unit that is played for one that the rig does not have, if any, and a warning.

    Raises:
        Unprocessable: If FACS does not have it either.
    """
    try:
        name, side = split_side(key)
    except InvalidNotation:
        raise refused_by_engine(error) from error
    code = facs_codes().get(name)
    if name in rig.action_units and side in LIPS:
        return name, _whole_lips(key, name, side)
    if code is None:
        message = f"FACS has no code {name.removeprefix('AU')}, and this rig no unit {key!r}"
        raise Unprocessable("unknown_action_unit", message, known=sorted(rig.action_units))
    near = " and ".join(_near(code.nearest, rig))
    hint = f"; nearest is {near}" if near else ""
    message = f"{key} ({code.title}) is absent on this rig and is not played{hint}"
    return None, FacsWarning("absent", (key,), message)


def _whole_lips(key: str, name: str, side: str) -> FacsWarning:
    code = facs_codes().get(name)
    if code is None or side not in code.sides:
        able = ", ".join(each.name for each in facs_codes().values() if set(LIPS) & {*each.sides})
        message = f"{key}: FACS scores one lip only of {able}; {name} is played whole"
        return FacsWarning("no_lip", (key,), message)
    message = f"{key}: the muscles of {name} move both lips of this rig; {name} is played whole"
    return FacsWarning("both_lips", (key,), message)


def _near(names: tuple[str, ...], rig: Rig) -> Iterator[str]:
    for name in names:
        if name in rig.action_units:
            yield f"{name} ({rig.action_units[name].title})"
