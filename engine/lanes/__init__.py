"""Sixteen faces side by side: the same tissue, one face a lane of a vector register."""

from __future__ import annotations

from .bank import Bank, Plan, plan_of
from .vector import WIDTH

__all__ = ["WIDTH", "Bank", "Plan", "plan_of"]
