"""Hair styles: how long, high and dense hair is over the head, by a recipe's names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import FloatArray
from ..recipe import Recipe

HEIGHTS = (-80.0, -40.0, 0.0, 35.0, 60.0, 85.0, 112.0)
"""Where on the head [mm above the pupils] a style states its measures."""
Measures = tuple[float, float, float, float, float, float, float]


@dataclass(frozen=True)
class Style:
    """How a head of hair is cut and combed; measures go from the nape up to the crown.

    Attributes:
        kind: "combed" along the head, "hanging" from the parting, or "coiled".
        length: Of the cards [mm].
        rise: How far the tips stand off the scalp [mm].
        width: Of the cards [mm].
        density: Cards per square centimetre.
        parting: Where hair is parted [mm to the left]; None combs all of it forward.
        sweep: How far hair on top is combed aside, to the right; 1 is wholly.
        ruffle: How much neighbouring clumps differ in direction, radians.
        stiffness: How far hair goes on straight where the head bends away from it, 0 to 1.
        segments: Fewest and most pieces of a card.
        cut: Which share of the texture's strands the cards end at: 1 tapers, less is blunt.
        taper: How much narrower cards are at their tips.
        flyaways: Single hairs per square centimetre that stand off.
        edge: Baby hairs per square centimetre of the hairline.
    """

    kind: str
    length: Measures
    rise: Measures
    width: Measures
    density: Measures
    parting: float | None = None
    sweep: float = 0.0
    ruffle: float = 0.25
    stiffness: float = 0.35
    segments: tuple[int, int] = (2, 5)
    cut: tuple[float, float] = (1.0, 1.0)
    taper: float = 0.5
    flyaways: float = 1.2
    edge: float = 30.0

    def at(self, measures: Measures, y: FloatArray) -> FloatArray:
        """Return one of the measures at heights y (n,), shape (n,)."""
        return np.asarray(np.interp(y, HEIGHTS, measures))


STYLES: Mapping[str, Style] = {
    "bald": Style(
        kind="combed",
        length=(1.0,) * 7,
        rise=(0.5,) * 7,
        width=(1.0,) * 7,
        density=(0.0,) * 7,
        flyaways=0.0,
        edge=0.0,
    ),
    "buzz": Style(
        kind="combed",
        length=(3.0, 3.5, 4.2, 5.0, 6.0, 7.0, 7.0),
        rise=(0.7, 0.9, 1.3, 1.8, 2.6, 3.4, 3.4),
        width=(6.0,) * 7,
        density=(6.0, 8.0, 9.0, 9.0, 9.0, 9.0, 9.0),
        ruffle=0.12,
        flyaways=0.0,
        edge=20.0,
    ),
    "crop": Style(
        kind="combed",
        length=(4.5, 6.0, 9.0, 15.0, 25.0, 34.0, 36.0),
        rise=(0.5, 0.8, 1.6, 3.4, 7.5, 12.0, 9.0),
        width=(6.0, 6.0, 5.6, 4.8, 4.0, 3.8, 3.8),
        density=(8.0, 8.0, 8.0, 7.5, 7.0, 6.6, 6.6),
        sweep=0.45,
        ruffle=0.24,
        segments=(1, 4),
    ),
    "short": Style(
        kind="combed",
        length=(7.0, 12.0, 20.0, 32.0, 52.0, 64.0, 58.0),
        rise=(1.0, 1.8, 3.2, 5.5, 9.0, 13.0, 10.0),
        width=(3.2, 3.8, 4.6, 5.4, 6.4, 7.0, 7.0),
        density=(7.0, 8.0, 6.4, 4.8, 3.8, 3.6, 3.6),
        parting=24.0,
        ruffle=0.16,
        flyaways=1.6,
    ),
    "bob": Style(
        kind="hanging",
        segments=(8, 8),
        length=(70.0, 90.0, 110.0, 135.0, 160.0, 185.0, 195.0),
        rise=(7.0, 8.0, 9.0, 10.0, 10.0, 9.5, 7.5),
        width=(5.5, 5.9, 6.3, 6.3, 6.3, 6.3, 6.3),
        density=(3.6, 3.8, 3.8, 3.8, 4.2, 4.6, 4.8),
        cut=(0.62, 0.9),
        taper=0.15,
        parting=8.0,
        ruffle=0.10,
        flyaways=0.3,
        edge=18.0,
    ),
    "curly": Style(
        kind="coiled",
        segments=(7, 9),
        length=(16.0, 24.0, 32.0, 40.0, 46.0, 50.0, 48.0),
        rise=(5.0, 9.0, 15.0, 24.0, 32.0, 36.0, 34.0),
        width=(3.6, 4.4, 5.2, 6.0, 6.4, 6.6, 6.6),
        density=(5.2, 5.1, 4.7, 4.5, 4.35, 4.35, 4.35),
        ruffle=0.5,
        flyaways=0.0,
    ),
}
RECEDING = replace(
    STYLES["crop"],
    length=(4.0, 6.0, 9.0, 13.0, 18.0, 22.0, 22.0),
    rise=(0.6, 1.0, 1.8, 3.0, 4.0, 4.0, 3.5),
    density=(8.0, 8.0, 8.0, 7.5, 7.0, 7.0, 7.0),
    edge=14.0,
)


def style_of(recipe: Recipe) -> Style:
    """Return how the recipe's hair is cut and combed."""
    return RECEDING if recipe.hair_style == "receding" else STYLES[recipe.hair_style]
