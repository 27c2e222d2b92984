"""The version that is installed."""

from __future__ import annotations

from importlib import metadata


def version() -> str:
    """Return the installed version, or "0" in a tree that was not installed."""
    try:
        return metadata.version("risorius")
    except metadata.PackageNotFoundError:
        return "0"
