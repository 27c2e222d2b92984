"""Clips of trackers' files: what may be asked of one, and what the service remembers of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, Field

from engine import NEUTRAL_QUANTILE, EngineError, TrackOptions

from .bodies import ClipForm, Name
from .errors import Unprocessable, refused_by_engine


def read_neutral(text: str) -> float | tuple[int, int] | None:
    """Return what "auto", "0.1" or "0-30" means as the neutral face; an empty text means none.

    Raises:
        ValueError: For anything else.
    """
    if not text:
        return None
    if text.lower() == "auto":
        return NEUTRAL_QUANTILE
    first, dash, last = text.partition("-")
    try:
        return (int(first), int(last)) if dash else float(text)
    except ValueError as error:
        raise ValueError(
            f"neutral is {text!r}; expected auto, a share such as 0.1, or frames such as 0-30"
        ) from error


def read_map(text: str) -> dict[str, str] | None:
    """Return the unit of each column in "AU01_r:AU1,AU03_r:AU4"; an empty text means no map.

    Raises:
        ValueError: For anything else, or a column that is named twice.
    """
    units: dict[str, str] = {}
    for pair in filter(None, map(str.strip, text.split(","))):
        column, colon, unit = (part.strip() for part in pair.rpartition(":"))
        if not (column and colon and unit):
            raise ValueError(
                f"au_map has {pair[:40]!r}; expected a column and its unit, as in "
                "AU01_r:AU1,AU03_r:AU4"
            )
        if column in units:
            raise ValueError(f"au_map names the column {column[:40]!r} twice; leave one out")
        units[column] = unit
    return units or None


def map_text(units: Mapping[str, str]) -> str:
    """Return a map as `read_map` reads it."""
    return ",".join(f"{column}:{unit}" for column, unit in units.items())


def _map(text: str) -> str:
    """Refuse a text that is no map."""
    read_map(text)
    return text


def _neutral(text: str) -> str:
    """Refuse a text that means no neutral face."""
    read_neutral(text)
    return text


class TrackClip(ClipForm):
    """What is asked of a tracker's file, in the address of its POST."""

    # An address holds text: what is strict in a body is read from it here.
    textures: bool = Field(
        default=True, description="Whether the maps of skin and eyes are embedded."
    )
    tolerance: float = Field(
        default=0.1,
        ge=0.01,
        le=10,
        allow_inf_nan=False,
        description="Largest error of any vertex with the form basis, mm.",
    )
    quantize: bool = Field(
        default=True, description="Whether numbers are stored by KHR_mesh_quantization."
    )
    sparse: bool = Field(
        default=True, description="Whether accessors may be sparse, where that is smaller."
    )
    gain: float = Field(
        default=1.0, ge=0, le=100, allow_inf_nan=False, description="Factor on every intensity."
    )
    face: Name | None = Field(
        default=None, description="Which face of several, as the file names them."
    )
    neutral: Annotated[str, Field(max_length=24), AfterValidator(_neutral)] = Field(
        default="",
        description="Takes off the face at rest: auto, a share of the frames such as 0.1, or the "
        "frames that show it, 0-30.",
    )
    smooth: float | None = Field(
        default=None,
        ge=0,
        le=30,
        allow_inf_nan=False,
        description="One-euro filter, Hz at rest; 0 is off. Without it, the tracker's usual.",
    )
    confidence: float = Field(
        default=0.5, ge=0, le=1, allow_inf_nan=False, description="Rows of a lower one are dropped."
    )
    max_gap: float = Field(
        default=0.5,
        ge=0,
        le=60,
        allow_inf_nan=False,
        description="Seconds without a row that are filled; over longer gaps the face rests.",
    )
    full_scale: float | None = Field(
        default=None,
        ge=1e-6,
        le=1e6,
        allow_inf_nan=False,
        description="What the file calls full intensity. Without it, the tracker's.",
    )
    au_map: Annotated[str, Field(max_length=2000), AfterValidator(_map)] = Field(
        default="",
        description="Unit by column, AU01_r:AU1,AU03_r:AU4, of a file that numbers units by index.",
    )
    head: bool = Field(default=True, description="Whether the head moves.")
    gaze: bool = Field(default=True, description="Whether the eyes move.")
    seconds: float | None = Field(
        default=None,
        gt=0,
        le=3600,
        allow_inf_nan=False,
        description="Longest clip; what comes later is counted and not played.",
    )


def options_of(clip: TrackClip, max_seconds: float) -> TrackOptions:
    """Return how a file is read for a clip of so many seconds at most.

    Raises:
        Unprocessable: If a longer one is asked for.
        Refused: If an option is beyond what the engine takes.
    """
    if clip.seconds is not None and clip.seconds > max_seconds:
        message = f"seconds is {clip.seconds:g}; a clip lasts at most {max_seconds:g} s"
        raise Unprocessable("clip_too_long", message)
    try:
        return TrackOptions(
            # Unless it is said, a file without a clock has its tracker's usual rate.
            fps=clip.fps if "fps" in clip.model_fields_set else None,
            gain=clip.gain,
            neutral=read_neutral(clip.neutral),
            smooth=clip.smooth,
            face=clip.face,
            min_confidence=clip.confidence,
            max_gap=clip.max_gap,
            full_scale=clip.full_scale,
            au_map=read_map(clip.au_map),
            head=clip.head,
            gaze=clip.gaze,
            max_seconds=max_seconds if clip.seconds is None else clip.seconds,
        )
    except EngineError as error:
        raise refused_by_engine(error) from error


def query_parameters() -> list[dict[str, Any]]:
    """Return what may be asked in the address, as OpenAPI describes it."""
    properties = TrackClip.model_json_schema()["properties"]
    return [
        {
            "name": name,
            "in": "query",
            "required": False,
            "description": f"Of a tracker's file: {schema.pop('description', name)}",
            "schema": schema,
        }
        for name, schema in properties.items()
        if name != "textures"  # Of a timeline, too.
    ]
