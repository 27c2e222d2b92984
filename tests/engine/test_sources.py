"""The hash of the engine's files: code and data count, what Python leaves beside them does not."""

from __future__ import annotations

import ast
import importlib.util
import sys
from pathlib import Path

import pytest

import engine  # noqa: F401 - for its modules
from engine import compiling, sources
from engine.sources import files_in, hash_of, of_kernels


def test_code_and_data_count_and_compiled_files_do_not(tmp_path: Path) -> None:
    def write(place: str, text: str) -> str:
        path = tmp_path / place
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        return hash_of(files_in(tmp_path))

    first = write("muscle.py", "reach = 1")
    data = write("data/muscles.json", "[1]")
    changed = write("data/muscles.json", "[2]")
    moved = write("data/more.json", "[2]")
    assert len({first, data, changed, moved}) == 4
    assert write("__pycache__/muscle.pyc", "bytes") == moved


def test_the_engine_s_own_files_are_read_with_it() -> None:
    folder = Path(sources.__file__).parent
    files = files_in(folder)
    assert hash_of(files) == sources.ENGINE_HASH
    assert hash_of(files_in(folder / "head", "head/")) == sources.HEAD_HASH
    assert hash_of(of_kernels(files)) == sources.KERNELS_HASH
    assert {"dynamics.py", "lanes/advance.py"} <= of_kernels(files).keys() < files.keys()


def test_kernels_are_made_of_what_their_hash_covers() -> None:
    """Of all that a kernel names, functions and numbers come from the covered modules or head."""
    seen = set()
    for place, module in list(sys.modules.items()):
        if not place.startswith("engine."):
            continue
        for value in vars(module).values():
            function = getattr(value, "py_func", None)
            if function is not None:
                seen.add(function.__module__)
    assert "engine.lanes.advance" in seen
    packages = {name.split(".")[1] for name in seen}
    assert not packages & (set(sources._NO_KERNELS) - {"head"})
    for name in seen:
        names = {
            node.module or ""
            for node in ast.walk(ast.parse(Path(sys.modules[name].__file__ or "").read_text()))
            if isinstance(node, ast.ImportFrom) and node.level > 0
        }
        if not name.startswith("engine.head"):
            # `Head` is a type there.
            assert not {n.partition(".")[0] for n in names - {"head"}} & set(sources._NO_KERNELS)


def test_a_kept_kernel_is_forgotten_when_other_code_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def load(stamp: str) -> int:
        monkeypatch.setattr(compiling, "KERNELS_HASH", stamp)
        source = tmp_path / "kernels.py"
        source.write_text("def twice(a):\n    return 2 * a\n")
        spec = importlib.util.spec_from_file_location("kernels", source)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        # Numba finds what a kept kernel is part of by the name of its module.
        monkeypatch.setitem(sys.modules, "kernels", module)
        spec.loader.exec_module(module)
        twice = compiling.kernel(module.twice)
        assert twice(3) == 6
        return sum(twice.stats.cache_hits.values())

    assert load("one") == 0
    assert load("one") == 1
    assert load("another") == 0
