"""JSON lines of MediaPipe's face landmarker: an object a frame, blend shapes by name.

Each line is what a program writes of a result: its time, and the blend shapes as an object
({"jawOpen": 0.4}), as MediaPipe's categories ([{"categoryName": "jawOpen", "score": 0.4}]) of one
face or of several, or among the fields themselves. A facial transformation matrix of sixteen
numbers, by rows or by columns, turns the head. A line without shapes is a frame without a face.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain

import numpy as np

from ..arkit import known_arkit
from ..arrays import FloatArray
from ..errors import InvalidTrack
from .blendshapes import arkit_names, axis_columns, shapes_of, unit_columns
from .layout import Layout, TimeColumn, Turn
from .table import CHUNK_ROWS, Chunk

TIMES = ("timestamp", "time", "timestampms", "timems", "t")
FRAMES = ("frame", "frameidx", "frameindex")
_SHAPES = ("blendshapes", "faceblendshapes", "categories")
_MATRICES = ("facialtransformationmatrixes", "facialtransformationmatrix", "matrix", "transform")
_NAMES = ("categoryname", "name", "displayname", "shape")
_SCORES = ("score", "value", "weight")
_DEEPEST = 4
"""Lists and objects within one another in which shapes are looked for: MediaPipe has three."""
_FACE = "face"
_MATRIX = tuple(f"matrix_{index}" for index in range(16))


class JsonLines:
    """The lines of a file, read once.

    Attributes:
        header: Names of what is read of each line.
        kind: Of its time, None where its first line has none.
    """

    def __init__(self, lines: Iterator[str]) -> None:
        """Read the first line.

        Raises:
            InvalidTrack: If it is no object, or has no blend shapes.
        """
        first = next((line for line in lines if line.strip()), "")
        if first.strip() in ("[", "{"):
            raise InvalidTrack(
                "the file is one JSON document over several lines; expected JSON lines: an object "
                "a line for each frame, without brackets or commas around them"
            )
        data = _fields(_object(first, 1, last=False))
        self.kind = _kind_of_time(data)
        self._has_frame = _number(data, FRAMES) is not None
        self._lines = chain([first], lines)
        self.header = [*arkit_names(), "time", "frame", _FACE, *_MATRIX]

    def layout(self) -> Layout:
        """Return what the lines mean."""
        shapes = shapes_of(arkit_names())
        return Layout(
            tracker="MediaPipe",
            version="JSON lines of blend shapes",
            units=unit_columns(shapes),
            axes=axis_columns(shapes),
            time=None if self.kind is None else TimeColumn("time", self.kind),
            frame="frame" if self._has_frame else None,
            face=_FACE,
            head=Turn(_MATRIX, _turns),
        )

    def chunks(self, numbers: Sequence[str], texts: Sequence[str]) -> Iterator[Chunk]:
        """Yield the frames, a row for each face of one.

        Raises:
            InvalidTrack: For a line that is no object, or holds what is no number.
        """
        places = [self.header.index(name) for name in numbers]
        face = self.header.index(_FACE)
        first, rows = 1, list[list[float]]()
        for row in self._rows():
            rows.append(row)
            if len(rows) == CHUNK_ROWS:
                yield _chunk(first, rows, places, face, texts)
                first, rows = first + len(rows), []
        if rows:
            yield _chunk(first, rows, places, face, texts)

    def _rows(self) -> Iterator[list[float]]:
        number = 0
        pending: str | None = None
        for line in chain((each for each in self._lines if each.strip()), [None]):
            if pending is not None:
                number += 1
                yield from _faces(_object(pending, number, last=line is None), number)
            pending = line


def _chunk(
    first: int, rows: list[list[float]], places: list[int], face: int, texts: Sequence[str]
) -> Chunk:
    table = np.array(rows)
    words = {name: [str(int(each)) for each in table[:, face]] for name in texts}
    return Chunk(first, table[:, places], words)


def _object(line: str, number: int, *, last: bool) -> Mapping[str, object]:
    try:
        data = json.loads(line)
    except (ValueError, RecursionError) as error:
        hint = ": the file is cut off; send it again whole" if last and number > 1 else ""
        raise InvalidTrack(f"line {number} is no JSON object{hint or f': {error}'}") from error
    if isinstance(data, list):
        data = {"categories": data}
    if not isinstance(data, dict):
        raise InvalidTrack(f"line {number} is {line[:40]!r}; expected an object with blend shapes")
    return data


def _fields(data: Mapping[str, object]) -> dict[str, object]:
    """Return fields by their names in small letters, without underscores."""
    return {str(name).lower().replace("_", ""): value for name, value in data.items()}


def _kind_of_time(fields: Mapping[str, object]) -> str | None:
    for name in TIMES:
        if name in fields:
            return "milliseconds" if name.endswith("ms") else "number"
    return None


def _number(fields: Mapping[str, object], names: Sequence[str]) -> object | None:
    return next((fields[name] for name in names if name in fields), None)


def _faces(data: Mapping[str, object], number: int) -> Iterator[list[float]]:
    """Yield a row for each face of a line; one without numbers where it has none."""
    fields = _fields(data)
    given = next((fields[name] for name in _SHAPES if name in fields), data)
    faces = _by_face(given)
    matrices = _by_matrix(next((fields[name] for name in _MATRICES if name in fields), None))
    time = _float(_number(fields, TIMES), "its time", number)
    frame = _float(_number(fields, FRAMES), "its frame", number)
    for index, shapes in enumerate(faces or [{}]):
        matrix = matrices[index] if index < len(matrices) else None
        yield [*_weights(shapes, number), time, frame, float(index), *_sixteen(matrix, number)]


def _by_face(given: object, depth: int = 0) -> list[Mapping[str, object]]:
    """Return blend shapes by name, of each face."""
    if depth > _DEEPEST:
        return []
    if isinstance(given, Mapping):
        fields = _fields(given)
        inner = next((fields[name] for name in _SHAPES if name in fields), None)
        return [given] if inner is None else _by_face(inner, depth + 1)
    if not isinstance(given, list) or not given:
        return []
    named = [_named(each) for each in given]
    if all(pair is not None for pair in named):
        return [dict(pair for pair in named if pair is not None)]
    return [face for each in given for face in _by_face(each, depth + 1)[:1]]


def _named(entry: object) -> tuple[str, object] | None:
    """Return name and score of one of MediaPipe's categories."""
    if not isinstance(entry, Mapping):
        return None
    fields = _fields(entry)
    name, score = _number(fields, _NAMES), _number(fields, _SCORES)
    return (name, score) if isinstance(name, str) and score is not None else None


def _weights(shapes: Mapping[str, object], number: int) -> list[float]:
    """Return the weights of ARKit's shapes; those that a line leaves out are 0."""
    found: dict[str, float] = {}
    for name, value in shapes.items():
        shape = known_arkit(str(name))
        if shape is not None:
            found[shape.name] = _float(value, str(name), number)
    if not found:
        return [math.nan] * len(arkit_names())
    return [found.get(name, 0.0) for name in arkit_names()]


def _by_matrix(given: object) -> list[object]:
    if isinstance(given, list) and given and all(isinstance(e, Mapping | list) for e in given):
        return [given] if all(isinstance(e, list) and len(e) == 4 for e in given) else given
    return [] if given is None else [given]


def _sixteen(matrix: object, number: int) -> list[float]:
    """Return a transformation by rows, NaN where there is none."""
    if isinstance(matrix, Mapping):
        matrix = _fields(matrix).get("data")
    if isinstance(matrix, list) and len(matrix) == 4:
        matrix = [value for row in matrix for value in (row if isinstance(row, list) else [row])]
    if not isinstance(matrix, list) or len(matrix) != 16:
        return [math.nan] * 16
    values = [_float(each, "its matrix", number) for each in matrix]
    # MediaPipe's tasks for the web list it by columns: the shift is then last.
    by_columns = any(values[12:15]) and not any(values[3:12:4])
    return np.array(values).reshape(4, 4).T.ravel().tolist() if by_columns else values


def _float(value: object, name: str, number: int) -> float:
    if value is None:
        return math.nan
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InvalidTrack(f"line {number}: {name} is {value!r:.40}; expected a number")
    try:
        return float(value)
    except OverflowError as error:
        raise InvalidTrack(f"line {number}: {name} is beyond every number") from error


def _turns(values: FloatArray) -> FloatArray:
    """Return rotations, shape (n, 3, 3), of matrices by rows, shape (n, 16).

    MediaPipe's canonical face has x to the face's left, y up and z out of the face, and its
    camera looks along -z: both as here.
    """
    turns = values.reshape(-1, 4, 4)[:, :3, :3]
    scale = np.linalg.norm(turns, axis=1, keepdims=True)
    return np.asarray(np.divide(turns, scale, out=np.zeros_like(turns), where=scale > 0.0))
