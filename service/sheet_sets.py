"""Sets of expressions that contact sheets show, by name."""

from __future__ import annotations

from collections.abc import Mapping

from engine import lexicon

EMOTIONS = ("happiness", "sadness", "fear", "anger", "surprise", "disgust", "contempt")
STRENGTHS = (0.4, 0.7, 1.0)
COMBINATIONS = (
    "1E+2E",
    "1E+4E",
    "1D+2D+4D",
    "4E+5E",
    "5E+7E",
    "4E+5D+7E+24D",
    "6E+12E",
    "6E+12E+25E",
    "12E+15E",
    "6D+15E",
    "9E+10E",
    "9D+10D+17D",
    "10E+25E",
    "12C+14E",
    "14D+17D+24D",
    "15E+17E",
    "20E+25E",
    "18E+22D+25D",
    "1E+2E+5E+27E",
    "R12D+L15D",
)
"""Units that meet on the face: together, against each other, and on one side each."""

SETS: Mapping[str, tuple[str, ...]] = {
    "emotions": ("rest", *EMOTIONS),
    "intensities": tuple(f"{name}@{share}" for share in STRENGTHS for name in EMOTIONS),
    "combinations": COMBINATIONS,
    "recipes": tuple(lexicon().recipes),
}
"""Names of poses, as `--only` takes them."""
