"""Insight: what a face does inside, and what it shows beside what it was asked for."""

from .basis import UnitBasis, unit_basis
from .report import Analysis, analyze, analyze_facs

__all__ = ["Analysis", "UnitBasis", "analyze", "analyze_facs", "unit_basis"]
