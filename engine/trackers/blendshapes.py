"""Tables of ARKit's 52 names: Live Link Face, A2F-3D, and any other in any order and case.

Live Link Face tells the head's turn in radians as Unreal's ARKit source has it for a face that is
not mirrored: yaw to the person's left, pitch up, roll to the left shoulder. Where the eyes look is
in eight of the 52 names already.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..arkit import arkit_table, known_arkit
from ..blend import Shape, split_name
from ..errors import InvalidTrack
from .angles import turns_of
from .columns import Columns
from .layout import AxisColumn, Layout, TimeColumn, Turn, UnitColumn

LEAST_SHAPES = 8
"""So many of ARKit's names make a table one of blend shapes. Ours."""
_A2F = "blendshapes."


def blendshape_layout(columns: Columns) -> Layout | None:
    """Return what a header with ARKit's names means, None where it has too few of them.

    Raises:
        InvalidTrack: If two columns are the same shape.
    """
    shapes = shapes_of(columns.header)
    if len(shapes) < LEAST_SHAPES:
        return None
    units, axes = unit_columns(shapes), axis_columns(shapes)
    timecode = columns.find("timecode")
    time: TimeColumn | None
    if timecode is not None and any(name.startswith(_A2F) for name in columns):
        tracker, time = "A2F-3D", TimeColumn(timecode, "number")
    elif timecode is not None:
        tracker, time = "Live Link Face", TimeColumn(timecode, "timecode")
    else:
        stamp = columns.first("timestamp", "time", "time_ms", "timestamp_ms", "timestampms")
        tracker, time = "ARKit's blend shapes", _time(stamp)
    return Layout(
        tracker=tracker,
        version=f"{len(shapes)} blend shapes",
        units=units,
        axes=axes,
        time=time,
        frame=columns.first("frame", "frame_idx"),
        face=columns.first("face_id", "face"),
        confidence=columns.find("confidence"),
        head=_head(columns),
        ignored={
            f"{side}Eye{axis}": "the eyes' turn is in the shapes eyeLook… already"
            for side in ("Left", "Right")
            for axis in ("Yaw", "Pitch", "Roll")
        },
    )


def shapes_of(header: Sequence[str]) -> dict[str, Shape]:
    """Return the shape of each column that is named as one and moves anything.

    Raises:
        InvalidTrack: If two columns are the same shape.
    """
    shapes: dict[str, Shape] = {}
    seen: dict[tuple[str, tuple[str, ...]], str] = {}
    for name in header:
        plain = name[len(_A2F) :] if name.lower().startswith(_A2F) else name
        shape = known_arkit(plain)
        if shape is None or not (shape.units or shape.axes):
            continue
        # The left half of a shape and its right half have one name and other units.
        same = shape.name, tuple(shape.units)
        if same in seen:
            raise InvalidTrack(
                f"the columns {seen[same]!r} and {name!r} are the same shape; remove one"
            )
        seen[same] = name
        shapes[name] = shape
    return shapes


def unit_columns(shapes: Mapping[str, Shape]) -> tuple[UnitColumn, ...]:
    """Return what columns of shapes ask of units; a unit told by sides is told so by all."""
    parts = [
        (column, *split_name(key), share)
        for column, shape in shapes.items()
        for key, share in shape.units.items()
    ]
    sided = {name for _, name, side, _ in parts if side}
    units = []
    for column, name, side, share in parts:
        sides = "LR" if name in sided and not side else [side]
        number = name.removeprefix("AU")
        units += [UnitColumn(column, f"{s}{number}" if s else name, share) for s in sides]
    return tuple(units)


def axis_columns(shapes: Mapping[str, Shape]) -> tuple[AxisColumn, ...]:
    """Return what columns of shapes ask of the gaze."""
    return tuple(
        AxisColumn(column, axis, degrees)
        for column, shape in shapes.items()
        for axis, degrees in shape.axes.items()
    )


def arkit_names() -> tuple[str, ...]:
    """Return ARKit's names, as Apple writes them."""
    return tuple(arkit_table().shapes)


def _time(stamp: str | None) -> TimeColumn | None:
    if stamp is None:
        return None
    milliseconds = stamp.lower().replace("_", "").endswith("ms")
    return TimeColumn(stamp, "milliseconds" if milliseconds else "number")


def _head(columns: Columns) -> Turn | None:
    names = tuple(
        n for name in ("HeadYaw", "HeadPitch", "HeadRoll") if (n := columns.find(name)) is not None
    )
    return Turn(names, lambda v: turns_of(np.degrees(v))) if len(names) == 3 else None
