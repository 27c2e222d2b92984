"""OpenFace 2 in all its layouts, and tables that borrow its names (Baltrušaitis et al. 2018).

Its wiki, "Output Format": timestamps in seconds; intensities 0 to 5; head turns in radians as
R = Rx Ry Rz and gaze in radians, both in the camera's axes. A positive pose_Rx looks down, a
positive pose_Ry turns to the person's right and a positive pose_Rz leans to the left shoulder;
gaze_angle_x is positive to the person's left, gaze_angle_y downwards.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..errors import InvalidNotation, InvalidTrack
from ..facs import split_side
from .angles import HALF_TURN, sight_of
from .columns import Columns
from .layout import SCORE_SMOOTH, Layout, TimeColumn, Turn, UnitColumn

INTENSITIES = frozenset({1, 2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 20, 23, 25, 26, 45})
"""The units whose intensity OpenFace 2 estimates."""
FULL = 5.0
PRESENCE = "presence, 0 or 1: the intensity beside it is played"
ABSENT_INTENSITY = "presence, 0 or 1: OpenFace estimates no intensity of it"
_INTENSITY = re.compile(r"au(\d+)_r")
_PRESENCE = re.compile(r"au(\d+)_c")
_CLEAN = {"frame", "timestamp", "confidence", "success", "gaze_angle_x", "gaze_angle_y"} | {
    f"pose_r{axis}" for axis in "xyz"
}
"""What FACSvatar keeps beside the 17 intensities, which it divides by five."""
_LAYOUTS = {
    714: "714 columns: everything",
    431: "431 columns, of before version 2",
    334: "334 columns",
    40: "40 columns: action units only",
}


def openface_layout(columns: Columns) -> Layout | None:
    """Return what a header with OpenFace's names means, None where it has none of them.

    Raises:
        InvalidTrack: If its numbers are not those of OpenFace 2's units.
    """
    found = {name: int(match[1]) for name in columns if (match := _INTENSITY.fullmatch(name))}
    if not found:
        return None
    strange = sorted(set(found.values()) - INTENSITIES)
    if strange:
        raise InvalidTrack(
            f"the header has AU{strange[0]:02d}_r, which no OpenFace 2 estimates: such files "
            "number the units of OpenFace 3 by index, in an order that differs between them; say "
            'what each column is with a map, such as {"AU01_r": "AU1", "AU03_r": "AU4"}'
        )
    units = tuple(
        UnitColumn(str(columns.find(name)), f"AU{number}") for name, number in found.items()
    )
    clean = set(columns) == _CLEAN | set(found) and len(found) == len(INTENSITIES)
    version = "26 columns, already divided by five" if clean else _version(columns)
    return with_common(
        columns,
        Layout(
            tracker="OpenFace 2",
            version=version,
            units=units,
            full=1.0 if clean else FULL,
            decided=not clean,
            ignored={
                **{
                    name: ABSENT_INTENSITY if int(match[1]) not in INTENSITIES else PRESENCE
                    for name in columns
                    if (match := _PRESENCE.fullmatch(name))
                },
                **dict.fromkeys(
                    ("p_rx", "p_ry", "p_rz"), "of the shape model, not the head's turn"
                ),
            },
        ),
    )


def mapped_layout(columns: Columns, au_map: Mapping[str, str]) -> Layout:
    """Return what a header means whose units a map names by column, at a full scale of 1.

    Raises:
        InvalidTrack: For a column that is not there, or a name that is no unit's.
    """
    units = []
    for column, key in au_map.items():
        name = columns.find(column.strip())
        if name is None:
            raise InvalidTrack(
                f"the map names the column {column!r}, which the header does not have; it has "
                f"{', '.join(columns.header[:12])}, …"
            )
        try:
            unit, side = split_side(key)
        except InvalidNotation as error:
            raise InvalidTrack(f"the map of {column!r}: {error}") from error
        units.append(UnitColumn(name, f"{side}{unit.removeprefix('AU')}" if side else unit))
    if not units:
        raise InvalidTrack('the map names no column; expected such as {"AU01_r": "AU1"}')
    return with_common(
        columns,
        Layout(
            tracker="a table with a map",
            version=f"{len(units)} units",
            units=tuple(units),
            scores=True,
            smooth=SCORE_SMOOTH,
        ),
    )


def with_common(columns: Columns, layout: Layout) -> Layout:
    """Return a layout with OpenFace's columns beside the units, where they are there."""
    timestamp = columns.find("timestamp")
    return replace(
        layout,
        time=None if timestamp is None else TimeColumn(timestamp, "seconds"),
        frame=columns.find("frame"),
        face=columns.find("face_id"),
        confidence=columns.find("confidence"),
        success=columns.find("success"),
        head=_head(columns),
        gaze=_gaze(columns),
    )


def head_turns(radians: FloatArray) -> FloatArray:
    """Return rotations of the head, shape (n, 3, 3), of pose_Rx, pose_Ry, pose_Rz, shape (n, 3).

    OpenFace's `Utilities::Euler2RotationMatrix` is R = Rx Ry Rz in the camera's axes.
    """
    from scipy.spatial.transform import Rotation  # Here: a start does without.

    turns = np.asarray(Rotation.from_euler("XYZ", radians).as_matrix())
    return np.asarray(HALF_TURN @ turns @ HALF_TURN)


def _head(columns: Columns) -> Turn | None:
    names = [columns.find(f"pose_R{axis}") for axis in "xyz"]
    found = tuple(name for name in names if name is not None)
    return Turn(found, head_turns) if len(found) == 3 else None


def _gaze(columns: Columns) -> Turn | None:
    """Return where the gaze stands: by angles, or of before version 2 by a vector of each eye."""
    angles = tuple(n for axis in "xy" if (n := columns.find(f"gaze_angle_{axis}")) is not None)
    if len(angles) == 2:
        return Turn(angles, lambda v: sight_of(v[:, 0], -v[:, 1]), in_space=True)
    names = [columns.find(f"gaze_{eye}_{axis}") for eye in "01" for axis in "xyz"]
    vectors = tuple(name for name in names if name is not None)
    if len(vectors) == 6:
        return Turn(vectors, lambda v: (v[:, :3] + v[:, 3:]) @ HALF_TURN / 2.0, in_space=True)
    return None


def _version(columns: Columns) -> str:
    return _LAYOUTS.get(len(columns), f"{len(columns)} columns")
