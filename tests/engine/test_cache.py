"""Arrays kept on disk come back as they were built, to the layout in memory."""

from __future__ import annotations

import numpy as np
import pytest

from engine.cache import cached_arrays


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
