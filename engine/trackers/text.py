"""Lines of text out of a stream of bytes: encodings told apart, and what is no text refused."""

from __future__ import annotations

import codecs
import io
from collections.abc import Iterator
from typing import BinaryIO

from ..errors import InvalidTrack

BLOCK = 65_536
"""Bytes read at a time."""
MAX_LINE = 1_048_576
"""Characters of the longest line: a hundred for each column that a table may have."""
_LOOK = 4096
"""Bytes by which an encoding without a mark is told."""
_EXPECTED = (
    "expected a CSV of OpenFace 2, py-feat, LibreFace, Live Link Face or A2F-3D, or JSON lines"
)
_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_MAGIC = (
    (b"PK\x03\x04", "a ZIP archive or an Excel workbook; unpack it, or save the table as CSV"),
    (b"\x1f\x8b", "a gzip archive; unpack it first"),
    (b"%PDF", "a PDF document; give the tracker's own CSV"),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook; save the table as CSV"),
)


def text_lines(source: BinaryIO) -> Iterator[str]:
    r"""Yield the lines of a file without their ends, whether these are \n, \r\n or \r.

    UTF-8 and UTF-16 are read, the latter with its byte order mark or, in a table of plain digits,
    without. Memory is bounded by a block and a line.

    Raises:
        InvalidTrack: If the file is empty or binary, or has a line longer than `MAX_LINE`.
    """
    block = source.read(BLOCK)
    if not block.strip(b"\x00 \t\r\n\xef\xbb\xbf"):
        raise InvalidTrack(f"the file is empty; {_EXPECTED}")
    _refuse_archives(block)
    encoding = _encoding(block)
    # A file's name in another code page stands in some tables, in a column that is not read.
    errors = "replace" if encoding.startswith("utf-8") else "strict"
    decoder = io.IncrementalNewlineDecoder(
        codecs.getincrementaldecoder(encoding)(errors=errors), translate=True
    )
    pending = ""
    first = True
    while True:
        text = _decoded(decoder, block)
        if "\x00" in text or (first and _is_garbage(text)):
            raise InvalidTrack(f"the file is binary, not text; {_EXPECTED}")
        first = False
        *lines, pending = (pending + text).split("\n")
        for line in lines:
            _check_length(line)
            yield line
        _check_length(pending)
        if not block:
            break
        block = source.read(BLOCK)
    if pending:
        yield pending


def _refuse_archives(block: bytes) -> None:
    for magic, what in _MAGIC:
        if block.startswith(magic):
            raise InvalidTrack(f"the file is {what}")


def _encoding(block: bytes) -> str:
    for mark, name in _MARKS:
        if block.startswith(mark):
            return name
    look = block[:_LOOK]
    even, odd = look[0::2].count(0), look[1::2].count(0)
    if odd > 0.9 * len(look[1::2]) and even == 0:
        return "utf-16-le"
    if even > 0.9 * len(look[0::2]) and odd == 0:
        return "utf-16-be"
    return "utf-8"


def _decoded(decoder: io.IncrementalNewlineDecoder, block: bytes) -> str:
    try:
        return decoder.decode(block, final=not block)
    except UnicodeDecodeError as error:
        raise InvalidTrack(
            f"the file begins as {error.encoding} text but cannot be read as it: {error.reason}; "
            "it is damaged or cut off: save it as UTF-8 and send it again"
        ) from error


def _is_garbage(text: str) -> bool:
    """Return whether more than one character of twenty is none that text has."""
    bad = sum(1 for each in text if each == "\ufffd" or (each < " " and each not in "\t\n"))
    return bad > 0.05 * len(text)


def _check_length(line: str) -> None:
    if len(line) > MAX_LINE:
        raise InvalidTrack(
            f"a line of the file has more than {MAX_LINE:,} characters; expected a header and one "
            "row a frame, of 10,000 columns at most"
        )
