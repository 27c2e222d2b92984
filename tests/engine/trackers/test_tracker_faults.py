"""Files made to hurt: read where they are clear, else refused by a sentence that helps."""

from __future__ import annotations

import io
import tracemalloc
from collections.abc import Iterator

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from tracker_files import csv_of, openface, openface_header, openface_rows, read, unit

from engine import EngineError, InvalidTrack, TrackOptions, read_track

HEADER = openface_header(40)
GOOD = openface({"AU12_r": [1.0, 2.0, 3.0]}, 3)


def with_cell(column: str, cell: str, row: int = 1) -> bytes:
    rows = openface_rows(HEADER, 3, {"AU12_r": [1.0, 2.0, 3.0]})
    rows[row][HEADER.index(column)] = cell
    return csv_of(HEADER, rows)


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"", "the file is empty; expected a CSV"),
        (b"\n\n  \n", "the file is empty"),
        (b"\xef\xbb\xbf", "the file is empty"),
        (csv_of(HEADER, []), "a header and no rows"),
        (bytes(range(256)) * 8, "binary"),
        (b"PK\x03\x04" + b"x" * 99, "Excel workbook"),
        (b"\x1f\x8b\x08" + b"x" * 99, "gzip archive; unpack it"),
        (b"\x89PNG\r\n\x1a\n" + bytes(200), "binary"),
        (b"name,age\nJoe,7\n", "'name', 'age'; expected those of OpenFace 2"),
        (b"hello there", "expected those of OpenFace 2"),
        (",".join(f"c{i}" for i in range(20_000)).encode() + b"\n", "20,000 columns; at most"),
        (b"a," * 1_000_000 + b"\n1\n", "a line of the file has more than"),
        (GOOD[:-30], r"the last row, 3, has \d+ of 40 columns: the file is cut off"),
        (GOOD.replace(b"\n2,", b"\n", 1), "row 2 has 39 of the header's 40"),
        (with_cell("AU12_r", "nan"), "row 2: AU12_r is missing or NaN"),
        (with_cell("AU12_r", "inf"), "row 2: AU12_r is inf; expected a number from 0 to 5"),
        (with_cell("AU12_r", "-1.2"), "row 2: AU12_r is -1.2; .* not negative"),
        (with_cell("AU12_r", "80"), "row 2: AU12_r is 80; .*full_scale"),
        (with_cell("AU12_r", "smile"), "row 2: AU12_r is 'smile'; expected a number"),
        (with_cell("timestamp", "nan"), "row 2: its time or frame is nan"),
        (with_cell("timestamp", "1e300"), "row 2: its time or frame is 1e"),
        (b'{"blendshapes": {"jawOpen": 0.1}}\n{"blendsha', "line 2 is no JSON object: .*cut off"),
        (b'[\n{"jawOpen": 0.1},\n{"jawOpen": 0.1}\n]\n', "expected JSON lines"),
        (b'{"jawOpen": "wide"}\n', "line 1: jawOpen is 'wide'"),
        (b"AU01_c,AU02_c\n1,0\n", "only presences"),
    ],
)
def test_it_is_refused_by_a_sentence(data: bytes, sentence: str) -> None:
    with pytest.raises(InvalidTrack, match=sentence):
        read(data)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-8-sig", "utf-32"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_encodings_and_line_ends_are_told_apart(encoding: str, end: str) -> None:
    track = read(GOOD.decode().replace("\n", end).encode(encoding))
    assert unit(track, "AU12") == pytest.approx([0.2, 0.4, 0.6])


def test_semicolons_and_decimal_commas_are_read() -> None:
    text = GOOD.decode().replace(",", ";").replace(".", ",")
    assert unit(read(text.encode()), "AU12") == pytest.approx([0.2, 0.4, 0.6])
    assert unit(read(("sep=;\n" + text).encode()), "AU12") == pytest.approx([0.2, 0.4, 0.6])


def test_decimal_commas_between_commas_are_refused_unless_quoted() -> None:
    rows = openface_rows(HEADER, 3, {"AU12_r": [1.0, 2.0, 3.0]})
    commas = [[cell.replace(".", ",") for cell in row] for row in rows]
    full = [[f"{i},{i}" for i in range(40)]]
    with pytest.raises(InvalidTrack, match="decimal commas"):
        read(csv_of(HEADER, full))
    with pytest.raises(InvalidTrack, match="row 1 has"):
        read(csv_of(HEADER, commas))
    quoted = [[f'"{cell}"' for cell in row] for row in commas]
    assert unit(read(csv_of(HEADER, quoted)), "AU12") == pytest.approx([0.2, 0.4, 0.6])


def test_a_little_below_0_is_0_and_counted() -> None:
    track = read(with_cell("AU12_r", "-0.01"))
    assert unit(track, "AU12")[1] == 0.0
    assert track.report.held == 1


def test_what_does_not_count_may_hold_anything() -> None:
    rows = openface_rows(HEADER, 3, {"AU12_r": [1.0, 9999.0, 1.0], "success": [1.0, 0.0, 1.0]})
    assert unit(read(csv_of(HEADER, rows)), "AU12") == pytest.approx([0.2] * 3)


def test_rows_of_empty_cells_are_frames_without_a_face() -> None:
    header = ["frame", "AU12", "AU06"]
    rows = [["0", "0.5", "0.5"], ["1", "", ""], ["2", "0.5", "0.5"]]
    track = read(csv_of(header, rows), fps=30)
    assert track.report.filled == 1
    assert unit(track, "AU12") == pytest.approx([0.5] * 3)


def test_cells_beyond_the_header_may_be_empty() -> None:
    assert len(read(GOOD.replace(b"\n", b",\n").replace(b"AU45_c,", b"AU45_c"))) == 3


@given(st.binary(max_size=400))
@example(b'"')
@example(b"{")
@example(b"\xff\xfe\x00")
@example(b"[[[[")
@example(b"[" * 900 + b"]" * 900)
@example(b'{"blendshapes":' * 400 + b"1" + b"}" * 400)
def test_garbage_is_never_more_than_refused(data: bytes) -> None:
    with pytest.raises(EngineError):
        read(data)


@given(st.integers(0, len(GOOD) - 1), st.binary(min_size=1, max_size=8))
def test_a_damaged_file_is_read_or_refused(place: int, patch: bytes) -> None:
    try:
        track = read(GOOD[:place] + patch + GOOD[place + len(patch) :])
    except EngineError:
        return
    assert ((track.intensities >= 0.0) & (track.intensities <= 1.0)).all()


@given(st.integers(1, len(GOOD) - 2))
def test_a_cut_file_is_read_or_refused(length: int) -> None:
    try:
        read(GOOD[:length])
    except EngineError:
        return


class Endless(io.RawIOBase):
    """A file of so many rows, made as it is read."""

    def __init__(self, rows: int) -> None:
        self._lines = self._made(rows)
        self._rest = b""

    def _made(self, rows: int) -> Iterator[bytes]:
        yield b"frame,face_id,timestamp,success,AU12_r,AU06_r,AU45_r\n"
        for index in range(rows):
            yield f"{index},0,{index / 30:.3f},1,{index % 5},0.5,0\n".encode()

    def read(self, size: int = -1) -> bytes:
        parts, length = [self._rest], len(self._rest)
        while length < size and (line := next(self._lines, None)) is not None:
            parts.append(line)
            length += len(line)
        self._rest = b"".join(parts)
        block, self._rest = self._rest[:size], self._rest[size:]
        return block


def peak_memory(rows: int) -> int:
    tracemalloc.start()
    try:
        track = read_track(Endless(rows), TrackOptions(max_seconds=60.0))  # type: ignore[arg-type]
        assert track.report.rows == rows
        assert len(track) == 1800
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_a_long_file_takes_no_more_memory_than_a_short_one() -> None:
    short, long = peak_memory(10_000), peak_memory(100_000)
    assert long < 1.1 * short
