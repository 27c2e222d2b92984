"""Arrays kept on disk come back as they were built, to the layout in memory."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from engine import assembly, builtin_rig, cache
from engine.assembly import _compiled
from engine.cache import cached_arrays
from engine.kept import keep


def test_what_is_read_has_the_layout_of_what_was_built(tmp_path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("RISORIUS_CACHE_DIR", str(tmp_path))
    grid = np.arange(12.0).reshape(3, 4)

    def build() -> dict[str, np.ndarray]:
        return {"columns": grid.T, "strided": grid[:, ::2], "plain": grid}

    built = cached_arrays("grid", "key", build)
    read = cached_arrays("grid", "key", lambda: pytest.fail("built again"))
    for name, array in built.items():
        assert array.flags.c_contiguous
        assert read[name].flags.c_contiguous
        assert np.array_equal(array, read[name])


def test_what_was_asked_for_longest_ago_makes_room(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RISORIUS_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(cache, "MOST_BYTES", 25_000)
    for age, name in enumerate(("new", "old", "middle")):
        cached_arrays("grid", name, lambda: {"values": np.zeros(1000)})
        os.utime(tmp_path / f"grid-{name}.npz", (1000 - age, 1000 - age))
    os.utime(tmp_path / "grid-old.npz", (1, 1))
    cached_arrays("grid", "newest", lambda: {"values": np.zeros(1000)})
    assert {file.stem for file in tmp_path.iterdir()} == {"grid-new", "grid-middle", "grid-newest"}


def test_a_file_that_cannot_be_written_in_full_leaves_nothing(tmp_path: Path) -> None:
    def fail(_file: object) -> None:
        raise RuntimeError("half way")

    with pytest.raises(RuntimeError):
        keep(tmp_path / "face.glb", fail, 1000)
    assert list(tmp_path.iterdir()) == []


def test_what_is_made_often_pushes_out_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RISORIUS_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(cache, "MOST_BYTES_ASIDE", 10_000)
    cached_arrays("head", "slow", lambda: {"values": np.zeros(1000)})
    for step in range(3):
        cached_arrays("assembly", f"{step}", lambda: {"values": np.zeros(1000)}, aside=True)
        os.utime(tmp_path / "assembly" / f"assembly-{step}.npz", (step + 1, step + 1))
    assert [path.name for path in (tmp_path / "assembly").iterdir()] == ["assembly-2.npz"]
    assert (tmp_path / "head-slow.npz").exists()


def test_a_rig_read_from_disk_steps_as_one_that_was_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = builtin_rig("standard")
    monkeypatch.setenv("RISORIUS_CACHE_DIR", str(tmp_path))
    made = _compiled.__wrapped__(rig, rig.model, None)
    monkeypatch.setattr(assembly, "rest_basis", lambda *a, **k: pytest.fail("made again"))
    read = _compiled.__wrapped__(rig, rig.model, None)
    assert np.array_equal(made.basis, read.basis)
    assert (made.omega, made.substeps) == (read.omega, read.substeps)
