"""The hash of the engine's files: code and data count, what Python leaves beside them does not."""

from __future__ import annotations

from pathlib import Path

from engine import sources
from engine.sources import sources_hash


def test_code_and_data_count_and_compiled_files_do_not(tmp_path: Path) -> None:
    def write(place: str, text: str) -> str:
        path = tmp_path / place
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        return sources_hash(tmp_path)

    first = write("muscle.py", "reach = 1")
    data = write("data/muscles.json", "[1]")
    changed = write("data/muscles.json", "[2]")
    moved = write("data/more.json", "[2]")
    assert len({first, data, changed, moved}) == 4
    assert write("__pycache__/muscle.pyc", "bytes") == moved


def test_the_engine_s_own_files_are_read_with_it() -> None:
    folder = Path(sources.__file__).parent
    assert sources.ENGINE_HASH == sources_hash(folder)
    assert sources.HEAD_HASH == sources_hash(folder / "head")
