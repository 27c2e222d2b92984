"""A tracked performance: intensities and angles at an even rate, and how they came about."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Float32Array
from ..errors import UnknownName
from ..rig import Rig
from .report import TrackReport


@dataclass(frozen=True, eq=False)
class Track:
    """A tracked performance.

    Attributes:
        rate: Frames a second, 30 or 60: whole ticks lie between two.
        units: "AU12", "L12" or "T28".
        intensities: Of each frame and unit, 0..1, shape (frames, units).
        axes: ("head", "yaw") and so on: empty where neither head nor gaze moves.
        angles: Of each frame and axis [degrees], shape (frames, axes).
        report: How they came about.
    """

    rate: int
    units: tuple[str, ...]
    intensities: Float32Array
    axes: tuple[tuple[str, str], ...]
    angles: Float32Array
    report: TrackReport

    def __len__(self) -> int:
        return len(self.intensities)

    @property
    def duration(self) -> float:
        """Seconds that it lasts, each frame its whole time."""
        return len(self) / self.rate

    def on(self, rig: Rig) -> Track:
        """Return the track without the units that a rig does not have; its report names them."""
        absent = [key for key in self.units if not _plays(rig, key)]
        if not absent:
            return self
        kept = [index for index, key in enumerate(self.units) if key not in absent]
        columns = tuple(c for key in absent for c in self.report.units[key].columns)
        report = replace(
            self.report,
            units={key: unit for key, unit in self.report.units.items() if key not in absent},
            ignored={**self.report.ignored, "the rig has no such unit": columns},
        )
        return replace(
            self,
            units=tuple(self.units[index] for index in kept),
            intensities=np.ascontiguousarray(self.intensities[:, kept]),
            report=report,
        )


def _plays(rig: Rig, key: str) -> bool:
    try:
        rig.resolve_unit(key)
    except UnknownName:
        return False
    return True
