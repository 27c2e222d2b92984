"""Edits make the rows of muscle forces that they change, and what is kept is what would be made."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine import Rig
from engine.assembly import _compiled
from engine.rest_basis import _row


def compiled(rig: Rig) -> tuple[Any, int]:
    """Return a rig compiled anew, and how many rows were made for it."""
    made = _row.cache_info().misses
    assembly = _compiled.__wrapped__(rig, rig.model, None)
    return assembly, _row.cache_info().misses - made


def test_an_edit_makes_the_rows_that_it_changes(
    standard_rig: Rig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = standard_rig
    weak = rig.derive(tissue={"stiffness_low": {"dermis": 25.0}, "muscle_strength": 0.9})
    strong = weak.derive(muscles={"zygomatic_major.L": {"force_scale": 400.0, "gain": [0.7, 1.0]}})
    wide = strong.derive(muscles={"zygomatic_major.L": {"angle": 33.0}})
    smooth = wide.derive(tissue={"force_smoothing": 0})
    monkeypatch.setenv("RISORIUS_CACHE_DIR", str(tmp_path))
    pulling = sum(1 for muscle in rig.muscles if muscle.kind != "lid")
    _row.cache_clear()
    rows = {one.id: compiled(one) for one in (rig, weak, strong, wide, smooth)}
    assert [made for _, made in rows.values()] == [pulling, 0, 0, 1, pulling]

    monkeypatch.setenv("RISORIUS_CACHE_DIR", str(tmp_path / "anew"))
    _row.cache_clear()
    anew, made = compiled(wide)
    assert made == pulling
    edited, _ = rows[wide.id]
    np.testing.assert_array_equal(edited.basis, anew.basis)
    assert edited.omega == anew.omega
