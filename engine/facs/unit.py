"""An action unit: one visible action of the face, as muscles and pose (section 3)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

REGIONS = ("upper", "lids", "lower", "cheeks", "jaw", "tongue", "gaze", "head")
"""Where on the face a unit acts."""


@dataclass(frozen=True)
class ActionUnit:
    """One visible action of the face, as weighted muscle contractions.

    Attributes:
        name: "AU12".
        title: FACS' name, "Lip corner puller".
        region: One of `REGIONS`, for grouping.
        muscles: Weight of each muscle, named without side, at intensity 1; below 0 a muscle with
            tone relaxes, and air is sucked in.
        pose: Turn (degrees) or thrust (mm) at intensity 1 by axis: "jaw.pitch", "gaze.yaw".
        one_sided: True where FACS scores one side only: the unit without a side is the left one.
        curve: Knots (intensity, scale of the recipe), rising from (0, 0): the calibration that
            makes intensity the fraction of the full landmark displacement.
        source: Where the recipe comes from.
        description: What is seen, after the FACS manual, in our words.
        sources: Where each muscle of the recipe comes from, by muscle.
        onset, offset: Seconds from rest to full and back, where a command gives no time.
        timing: Where these two come from.
    """

    name: str
    title: str
    region: str = "lower"
    muscles: Mapping[str, float] = field(default_factory=dict)
    pose: Mapping[str, float] = field(default_factory=dict)
    one_sided: bool = False
    curve: tuple[tuple[float, float], ...] = ((0.0, 0.0), (1.0, 1.0))
    source: str = ""
    description: str = ""
    sources: Mapping[str, str] = field(default_factory=dict)
    onset: float = 0.35
    offset: float = 0.5
    timing: str = ""

    @property
    def jaw(self) -> float:
        """Turn of the jaw at intensity 1, degrees: what opens the mouth."""
        return self.pose.get("jaw.pitch", 0.0)

    @property
    def still(self) -> bool:
        """Whether it moves nothing at all."""
        return not (any(self.muscles.values()) or any(self.pose.values()))

    def scale(self, intensity: float) -> float:
        """Return the factor on the recipe at `intensity`, 0..1, along the calibrated curve."""
        last_intensity, last_scale = 0.0, 0.0
        for knot, scale in self.curve:
            if intensity <= knot:
                span = knot - last_intensity
                share = (intensity - last_intensity) / span if span > 0.0 else 1.0
                return last_scale + (scale - last_scale) * share
            last_intensity, last_scale = knot, scale
        return last_scale

    def reaching(self, factor: float) -> ActionUnit:
        """Return the unit with its curve scaled: on a face that it moves too far or not enough."""
        return replace(self, curve=tuple((knot, factor * scale) for knot, scale in self.curve))
