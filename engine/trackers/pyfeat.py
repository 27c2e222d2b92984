"""py-feat of every version (Cheong et al. 2023): classifiers' scores, without a clock.

Pitch is positive upwards, roll to the left shoulder and yaw to the person's right, as its own
`draw_facepose` draws them; before version 1 in degrees, since then in radians. Gaze, of version 2
only, is told in radians: positive up and to the person's left, in the head.
"""

from __future__ import annotations

import re

import numpy as np

from ..arrays import FloatArray
from ..errors import InvalidTrack
from .angles import sight_of, turns_of
from .blendshapes import shapes_of
from .columns import Columns
from .layout import SCORE_SMOOTH, Layout, Reader, TimeColumn, Turn, UnitColumn

UNITS = frozenset({1, 2, 4, 5, 6, 7, 9, 10, 11, 12, 14, 15, 17, 20, 23, 24, 25, 26, 28, 43})
"""The units of py-feat; those of OpenFace 3, which some tools write under these names, are
among them."""
_UNIT = re.compile(r"au_?(\d+)")
_FEELINGS = (
    *("anger", "disgust", "fear", "happiness", "sadness", "surprise", "neutral"),
    *("Happy", "Sad", "valence", "arousal"),
)
_MOST_RADIANS = 1.6
"""No head that a camera sees is turned further, radians; one in degrees is, by its jitter."""


def pyfeat_layout(columns: Columns) -> Layout | None:
    """Return what a header with columns such as AU12 means, None where there are none.

    Raises:
        InvalidTrack: If its numbers are not those of py-feat's units.
    """
    found = {name: int(match[1]) for name in columns if (match := _UNIT.fullmatch(name))}
    if not found:
        return None
    strange = sorted(set(found.values()) - UNITS)
    if strange:
        raise InvalidTrack(
            f"the header has {columns.find(_first(found, strange[0]))}, which py-feat does not "
            "estimate: a file that numbers units by index can be read only with a map, such as "
            '{"AU0": "AU1", "AU2": "AU4"}'
        )
    units = tuple(
        UnitColumn(str(columns.find(name)), f"AU{number}") for name, number in found.items()
    )
    second = columns.has("valence", "arousal") or any(n.startswith("mesh_x_") for n in columns)
    tracker = "py-feat" if columns.has("FaceScore") or "frame" in columns else "scores of units"
    timestamp = columns.first("timestamp", "time")
    return Layout(
        tracker=tracker,
        version="version 2" if second else "version 0 or 1",
        units=units,
        scores=True,
        time=None if timestamp is None else TimeColumn(timestamp, "number"),
        frame=columns.find("frame"),
        coarse_time=columns.find("approx_time"),
        face=columns.first("Identity", "face_id"),
        confidence=columns.first("FaceScore", "confidence"),
        success=columns.find("success"),
        head=_head(columns, radians=second),
        gaze=_gaze(columns),
        smooth=SCORE_SMOOTH,
        ignored={
            "Identity_#": "embeddings of the face: they are never read",
            "mesh_x_#": "landmarks",
            "mesh_y_#": "landmarks",
            "mesh_z_#": "landmarks",
            **dict.fromkeys(shapes_of(columns.header), "a blend shape: the units are played"),
            **dict.fromkeys(_FEELINGS, "a feeling: the units are played"),
        },
    )


def _first(found: dict[str, int], number: int) -> str:
    return next(name for name, each in found.items() if each == number)


def _head(columns: Columns, *, radians: bool) -> Turn | None:
    names = tuple(n for name in ("Pitch", "Roll", "Yaw") if (n := columns.find(name)) is not None)
    if len(names) < 3:
        return None
    return Turn(names, _radians, settle=None if radians else _degrees_or_radians)


def _radians(values: FloatArray) -> FloatArray:
    """Return rotations, shape (n, 3, 3), of pitch, roll and yaw [radians], shape (n, 3)."""
    pitch, roll, yaw = np.degrees(values).T
    return turns_of(np.stack([-yaw, pitch, roll], axis=1))


def _degrees_or_radians(values: FloatArray) -> Reader:
    """Return how the turns of a file are read, by its first rows, shape (n, 3).

    Version 0 writes degrees and version 1 radians, under the same names: if no angle is beyond
    that of any head in radians, radians they are.
    """
    beyond = np.nanmax(np.abs(values), initial=0.0) > _MOST_RADIANS
    return _degrees if beyond else _radians


def _degrees(values: FloatArray) -> FloatArray:
    return _radians(np.radians(values))


def _gaze(columns: Columns) -> Turn | None:
    pitch, yaw = columns.find("gaze_pitch"), columns.find("gaze_yaw")
    if pitch is None or yaw is None:
        return None
    return Turn((yaw, pitch), lambda v: sight_of(v[:, 0], v[:, 1]))
