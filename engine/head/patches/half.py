"""Half a cage while it is being put together: named points and the faces over their names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...arrays import FloatArray


@dataclass
class HalfCage:
    """Named surface points of the head's left half and the faces between them.

    Attributes:
        points: Position of each named point [mm], shape (3,).
        faces: Names of each face's corners (three or four), in either winding.
        regions: Region of each face.
    """

    points: dict[str, FloatArray] = field(default_factory=dict)
    faces: list[tuple[str, ...]] = field(default_factory=list)
    regions: list[str] = field(default_factory=list)

    def place(self, name: str, position: Sequence[float] | FloatArray) -> None:
        """Put point `name` at `position` [mm], in place of any point of that name."""
        self.points[name] = np.array(position, dtype=float)

    def face(self, region: str, *corners: str) -> None:
        """Add a face of `region` over three or four named corners."""
        self.faces.append(corners)
        self.regions.append(region)
