"""Heads in the cache: the same after a round trip, rebuilt when damaged, keyed by content."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

from engine.head import Head, standard_head
from engine.head import standard as standard_module
from engine.head.storage import head_from_arrays, head_to_arrays, source_key


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("RISORIUS_CACHE_DIR", str(tmp_path))
    standard_module.reference_head.cache_clear()
    return tmp_path


def same(first: object, second: object) -> bool:
    """Tell whether two heads, or pieces of them, hold the same."""
    if dataclasses.is_dataclass(first):
        return type(first) is type(second) and all(
            same(getattr(first, field.name), getattr(second, field.name))
            for field in dataclasses.fields(first)
        )
    if isinstance(first, np.ndarray):
        return (
            isinstance(second, np.ndarray)
            and first.dtype == second.dtype
            and np.array_equal(first, second)
        )
    if isinstance(first, sp.csr_array):
        return first.shape == second.shape and abs(first - second).sum() == 0
    if isinstance(first, tuple):
        return len(first) == len(second) and all(map(same, first, second))
    return first == second


@pytest.mark.parametrize("which", ["low", "high", "paper"])
def test_round_trip(heads: dict[str, Head], which: str) -> None:
    head = heads[which]
    assert same(head, head_from_arrays(head_to_arrays(head)))


def test_hit_builds_nothing(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = standard_head("low")
    assert len(list(cache.glob("head-*.npz"))) == 1

    def fail() -> None:
        raise AssertionError("the head was built again")

    standard_module.reference_head.cache_clear()
    monkeypatch.setattr(standard_module, "sculpt", fail)
    assert same(first, standard_head("low"))


# numpy leaves the damaged file to the garbage collector, which says so.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_corrupt_file_is_rebuilt(cache: Path) -> None:
    first = standard_head("low")
    (stored,) = cache.glob("head-*.npz")
    stored.write_bytes(stored.read_bytes()[:1000])
    standard_module.reference_head.cache_clear()
    assert same(first, standard_head("low"))
    assert stored.stat().st_size > 1000


def test_unwritable_cache_costs_only_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    occupied = tmp_path / "file"
    occupied.write_text("in the way")
    monkeypatch.setenv("RISORIUS_CACHE_DIR", str(occupied))
    standard_module.reference_head.cache_clear()
    assert standard_head("low").sheet_count == 786


def test_key_depends_on_the_name() -> None:
    assert source_key("standard-low") == source_key("standard-low")
    assert source_key("standard-low") != source_key("paper")


def test_arrays_are_ready_for_kernels(head: Head) -> None:
    for name in ("points", "jaw_weight", "depth", "anchor_weight", "follow_jaw"):
        array = getattr(head, name)
        assert array.dtype == np.float64
        assert array.flags.c_contiguous
    for name in ("polygons", "triangles", "mirror"):
        array = getattr(head, name)
        assert array.dtype == np.int64
        assert array.flags.c_contiguous
    assert head.fixed.dtype == np.bool_
