"""Files as trackers write them, made from numbers."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping, Sequence

from engine import Track, TrackOptions, arkit_table, read_track

OPENFACE_UNITS = (1, 2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 20, 23, 25, 26, 45)
INTENSITIES = tuple(f"AU{number:02d}_r" for number in OPENFACE_UNITS)
PRESENCES = tuple(f"AU{number:02d}_c" for number in (*OPENFACE_UNITS[:-1], 28, 45))
POSE = ("pose_Rx", "pose_Ry", "pose_Rz")
GAZE = ("gaze_angle_x", "gaze_angle_y")
PYFEAT_UNITS = (1, 2, 4, 5, 6, 7, 9, 10, 11, 12, 14, 15, 17, 20, 23, 24, 25, 26, 28, 43)
ARKIT = tuple(arkit_table().shapes)


def numbered(prefix: str, count: int) -> list[str]:
    """Return "x_0", "x_1" and so on."""
    return [f"{prefix}{index}" for index in range(count)]


def openface_header(columns: int) -> list[str]:
    """Return a header of OpenFace 2 of so many columns."""
    start = ["frame", "face_id", "timestamp", "confidence", "success"]
    units = [*INTENSITIES, *PRESENCES]
    if columns == 40:
        return [*start, *units]
    if columns == 26:
        return [start[0], *start[2:], *GAZE, *POSE, *INTENSITIES]
    eyes = [f"gaze_{eye}_{axis}" for eye in "01" for axis in "xyz"]
    place = ["pose_Tx", "pose_Ty", "pose_Tz", *POSE]
    flat = [*numbered("x_", 68), *numbered("y_", 68)]
    space = [name for axis in "XYZ" for name in numbered(f"{axis}_", 68)]
    model = ["p_scale", "p_rx", "p_ry", "p_rz", "p_tx", "p_ty", *numbered("p_", 34)]
    if columns == 431:
        return [start[0], *start[2:], *eyes, *place, *flat, *space, *model, *units]
    if columns == 334:
        lids = [*numbered("eye_lmk_x_", 56), *numbered("eye_lmk_y_", 56)]
        return [*start, *eyes, *GAZE, *lids, *place, *flat, *units, *numbered("of_mine_", 32)]
    assert columns == 714
    lids = [name for axis in "xyXYZ" for name in numbered(f"eye_lmk_{axis}_", 56)]
    return [*start, *eyes, *GAZE, *lids, *place, *flat, *space, *model, *units]


def openface_rows(
    header: Sequence[str], count: int, values: Mapping[str, Iterable[float]], *, fps: float = 30.0
) -> list[list[str]]:
    """Return rows of which only some columns are not usual."""
    usual = {"confidence": "0.98", "success": "1"}
    columns = {name: list(each) for name, each in values.items()}
    rows = []
    for index in range(count):
        usual |= {"frame": str(index + 1), "timestamp": f"{index / fps:.3f}"}
        rows.append(
            [
                repr(columns[name][index]) if name in columns else usual.get(name, "0")
                for name in header
            ]
        )
    return rows


def csv_of(header: Sequence[str], rows: Iterable[Sequence[str]], comma: str = ",") -> bytes:
    """Return a table as bytes."""
    lines = [comma.join(header), *(comma.join(row) for row in rows)]
    return ("\n".join(lines) + "\n").encode()


def openface(
    values: Mapping[str, Iterable[float]], count: int, *, columns: int = 40, fps: float = 30.0
) -> bytes:
    """Return a file of OpenFace 2."""
    header = openface_header(columns)
    assert len(header) == columns
    return csv_of(header, openface_rows(header, count, values, fps=fps))


def read(data: bytes, **options: object) -> Track:
    """Read a file from memory."""
    return read_track(io.BytesIO(data), TrackOptions(**options))  # type: ignore[arg-type]


def unit(track: Track, key: str) -> list[float]:
    """Return the intensities of a unit."""
    return [float(value) for value in track.intensities[:, track.units.index(key)]]


def angle(track: Track, group: str, axis: str) -> list[float]:
    """Return the angles of an axis, degrees."""
    return [float(value) for value in track.angles[:, track.axes.index((group, axis))]]
