"""Where the jaw carries bone, against the golden file that the viewer's tests read as well."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from engine import Frame, JawHinge, Pose
from service.protocol import surface_frame

FILE = Path(__file__).parents[1] / "golden" / "rides.json"
POSES = ((0.0, 0.0, 0.0), (30.0, 0.0, 0.0), (24.0, 8.0, 3.0), (-1.0, -10.0, 0.0))
"""Pitch and yaw [degrees], thrust [mm]."""
SHARES = (0.0, 0.437, 1.0)
PLACE = (20.0, -100.0, 80.0)


def rides() -> list[dict[str, object]]:
    """Return the jaw as the stream tells it, and where it takes a place, as told to 0.1 µm."""
    hinge = JawHinge()
    found: list[dict[str, object]] = []
    for pitch, yaw, thrust in POSES:
        pose = Pose(jaw_pitch=pitch, jaw_yaw=yaw, jaw_thrust=thrust)
        told = surface_frame(Frame(0, np.zeros((1, 3)), np.zeros(0), pose, False, False), hinge)
        for share in SHARES:
            carried = hinge.move(np.array([PLACE]), np.array([share]), pitch, yaw, thrust)
            found.append(
                {
                    "hinge": list(hinge.center),
                    "quaternion": [round(value, 8) for value in told.jaw_quaternion],
                    "offset": [round(1000.0 * value, 4) for value in told.jaw_offset],
                    "share": share,
                    "place": list(PLACE),
                    "carried": carried[0].round(4).tolist(),
                }
            )
    return found


def test_golden_rides(update_golden: bool) -> None:
    if update_golden:
        lines = ",\n".join(json.dumps(ride) for ride in rides())
        FILE.write_text(f"[\n{lines}\n]\n")
    golden = json.loads(FILE.read_text())
    assert len(golden) == len(POSES) * len(SHARES)
    for ride, expected in zip(rides(), golden, strict=True):
        assert ride.keys() == expected.keys()
        for name, value in ride.items():
            assert value == pytest.approx(expected[name], abs=2e-4), name
