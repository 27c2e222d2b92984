"""What a start costs, in ratios that hold on any machine."""

from __future__ import annotations

import subprocess
import sys

import pytest

from service.starting import (
    LIBRARIES,
    import_figures,
    imported,
    memory_figures,
    start_markdown,
)

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")


def test_the_engine_imports_little_beside_its_libraries() -> None:
    assert import_figures(3)["ratio"] <= 1.6


def test_a_start_does_not_import_what_only_agents_need() -> None:
    code = "import sys, service.serving; sys.exit('mcp' in sys.modules or 'httpx2' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_further_face_takes_less_than_a_megabyte() -> None:
    memory = memory_figures(imported(LIBRARIES)[1])
    assert memory["further_face_mb"] < 1.0


def test_the_table_has_a_row_for_each_figure() -> None:
    seconds = {"baseline": 1.0, "answers": 1.5, "ready": 2.0, "ratio": 2.0}
    memory = {"baseline_mb": 150.0, "ready_mb": 90.0, "faces_10_mb": 99.0, "further_face_mb": 0.4}
    imports = {"libraries": 0.9, "engine": 1.0, "ratio": 1.11}
    table = start_markdown({"imports": imports, "warm": seconds, "memory": memory})
    assert "| service ready, warm caches | 1.00 s | 2.00 s | 2.0 |" in table
    assert "| 10 faces awake | 150 MB | +99 MB |  |" in table
    assert "cold" not in table
