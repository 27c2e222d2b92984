"""Builds the viewer when the Python package is built, if node is there to build it."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class ViewerBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Runs `npm ci` and `npm run build` in `static/`, which writes `service/viewer/`.

    Without npm the package installs all the same; the service then says at `/` that the viewer is
    not built, and how to build it. RISORIUS_SKIP_VIEWER=1 leaves the build to make or Docker.
    """

    def initialize(self, version: str, build_data: dict[str, object]) -> None:
        """Build the viewer, unless told not to or npm is missing."""
        static = Path(self.root) / "static"
        npm = shutil.which("npm")
        if os.environ.get("RISORIUS_SKIP_VIEWER") or npm is None or not static.is_dir():
            return
        subprocess.run([npm, "ci", "--no-audit", "--no-fund"], cwd=static, check=True)
        subprocess.run([npm, "run", "build"], cwd=static, check=True)
