"""What figures depend on: processor, system, versions, and what else the machine does."""

from __future__ import annotations

import os
import platform
import subprocess
from importlib import metadata
from pathlib import Path
from typing import Any


def machine() -> dict[str, Any]:
    """Return what the figures of a measurement depend on: processor, system, versions."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(),
        "python": platform.python_version(),
        **{name: metadata.version(name) for name in ("numpy", "numba", "scipy")},
    }


def load_average() -> list[float]:
    """Return how many processes wanted the processor in the last 1, 5 and 15 minutes, or []."""
    try:
        return [round(value, 2) for value in os.getloadavg()]
    except OSError:
        return []


def niceness() -> int:
    """Return how far this process stands back behind others: 0 not at all, 19 behind all."""
    return os.nice(0) if hasattr(os, "nice") else 0


def described() -> str:
    """Return the state of the source as `git describe` names it, or "" outside a clone."""
    try:
        done = subprocess.run(
            ["git", "describe", "--always", "--dirty", "--tags"],
            cwd=Path(__file__).parent,
            capture_output=True,
            text=True,
            timeout=10,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip()


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
