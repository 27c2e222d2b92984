"""Runs the node tools that read our GLB files: Khronos' validator and three.js."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).parent
MODULES = HERE.parents[1] / "static" / "node_modules"


def run_node(script: str, *arguments: str, needs: str) -> list[dict[str, Any]]:
    """Return the JSON lines that a node script prints; skip where its package is missing."""
    if shutil.which("node") is None:
        pytest.skip("node is not installed")
    if not (MODULES / needs).is_dir():
        pytest.skip(f"static/node_modules has no {needs}: run `npm ci` in static/")
    command = ["node", str(HERE / script), *arguments]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert ran.returncode == 0, ran.stderr
    return [json.loads(line) for line in ran.stdout.splitlines()]


def assert_valid(folder: Path, **files: bytes) -> None:
    """Assert that Khronos' validator finds neither errors nor warnings in `files`."""
    paths = []
    for name, data in files.items():
        path = folder / f"{name}.glb"
        path.write_bytes(data)
        paths.append(str(path))
    for report in run_node("validate_glb.mjs", *paths, needs="gltf-validator"):
        serious = [issue for issue in report["messages"] if issue["severity"] < 2]
        assert report["numErrors"] == report["numWarnings"] == 0, (report["path"], serious)
