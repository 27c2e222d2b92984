"""The version that is installed."""

from engine import version

__all__ = ["version"]
