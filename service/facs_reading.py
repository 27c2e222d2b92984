"""What a FACS string says, as an answer: each unit, the canonical form, and what breaks rules."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

from pydantic import BaseModel, Field

from engine import (
    EngineError,
    FacsWarning,
    InvalidNotation,
    Keyframe,
    Rig,
    Term,
    facs_codes,
    format_facs,
    letter_of,
    print_facs,
    term_of,
)

from .bodies import FacsRequest, Scale
from .clashes import clashes
from .errors import Unprocessable, refused_by_engine
from .facs import named_units, playable


class FacsUnit(BaseModel):
    """One unit of a FACS string."""

    name: str = Field(examples=["AU12"])
    side: str = Field(description="L or R of the face, T or B of the lips; empty is all of it.")
    intensity: float = Field(description="0 to 1.")
    letter: str | None = Field(description="The letter that is exactly this intensity, if any.")
    title: str
    on_rig: bool = Field(description="Whether the rig has it.")


class FacsRule(BaseModel):
    """What is played otherwise than it was written, under the rule that says so."""

    rule: str = Field(examples=["head_turns_one_way"])
    units: list[str] = Field(examples=[["AU51", "AU52"]])
    message: str


class FacsReading(BaseModel):
    """FACS, read and written."""

    canonical: str = Field(
        description="Each unit once, by rising number; what is no letter is written as 12:0.37."
    )
    letters: str = Field(description="The same in letters alone, each the nearest.")
    units: list[FacsUnit]
    scale: Scale
    rig: str
    warnings: list[FacsRule]


def read_facs(body: FacsRequest, rig: Rig) -> FacsReading:
    """Return what `body` says on `rig`.

    Raises:
        Unprocessable: If it says nothing, cannot be read, or names what neither FACS nor the rig
            has.
    """
    if body.facs is None and body.action_units is None:
        raise Unprocessable("invalid_body", "give 'facs', 'action_units', or both")
    played = playable(body, rig)
    terms = sorted(_terms(body, rig), key=lambda term: term.order)
    return FacsReading(
        canonical=print_facs(terms, body.scale),
        letters=format_facs(terms, body.scale) or print_facs(()),
        units=[_unit(term, rig, body.scale) for term in terms],
        scale=body.scale,
        rig=rig.id,
        warnings=[
            FacsRule(rule=found.rule, units=list(found.units), message=found.message)
            for found in _warnings(body, Keyframe(action_units=played.units), rig)
        ],
    )


def _terms(body: FacsRequest, rig: Rig) -> Iterator[Term]:
    """The units with a number, each once: of one named again the latter counts."""
    latest = {named.key: named.intensity for named in named_units(body, rig)}
    for key, intensity in latest.items():
        with suppress(InvalidNotation):
            yield term_of(key, intensity)


def _unit(term: Term, rig: Rig, scale: str) -> FacsUnit:
    own, code = rig.action_units.get(term.name), facs_codes().get(term.name)
    title = own.title if own is not None else code.title if code is not None else term.name
    return FacsUnit(
        name=term.name,
        side=term.side,
        intensity=term.intensity,
        letter=letter_of(term.intensity, scale),
        title=title,
        on_rig=own is not None,
    )


def _warnings(body: FacsRequest, keyframe: Keyframe, rig: Rig) -> list[FacsWarning]:
    try:
        own = rig.unit_warnings(keyframe.action_units)
    except EngineError as error:
        raise refused_by_engine(error) from error
    return own + clashes(body, keyframe, rig)
