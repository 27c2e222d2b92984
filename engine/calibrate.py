"""Fits each action unit's curve: intensity becomes the fraction of the full landmark displacement.

Run `python -m engine.calibrate` after a change to tissue, muscles or recipes, or with the units to
fit, `… AU12 AU18`; it rewrites the curves in `engine/data/action_units.json`. `… people` then
rewrites `engine/data/reaches.json`: what the curves are scaled by on the people whose landmarks
would move farther, or less far, than those of human faces.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from .arrays import FloatArray
from .head import people
from .measure import LANDMARKS, Landmark, measure_units, settle
from .rig import Rig, builtin_rig
from .rig_data import load_action_units
from .timeline import Keyframe

SCALES = np.round(np.arange(0.1, 1.81, 0.1), 3)
"""Scales of a recipe that are simulated; what lies between is interpolated."""
INTENSITIES = (0.25, 0.5, 0.75, 1.0)
AIM = 0.3
"""Where in the human range the full displacement is put: 0 its low end, 1 its high end."""


SPARE = 0.05
"""Share of the human range that people are brought inside its ends."""
FARTHEST_REACH = (0.6, 1.6)
"""Least and greatest factor on a person's curve."""
REACH_ROUNDS = 3


def fit_curve(scales: FloatArray, values: FloatArray, full: float) -> list[list[float]]:
    """Return curve knots at which a landmark reaches each fraction of `full`, mm.

    Args:
        scales: Of the recipe, rising from 0.
        values: The landmark's figure at each, mm.
        full: Figure at intensity 1; if it is never reached, the greatest that is.
    """
    rising = np.maximum.accumulate(values)
    rest, reachable = float(values[0]), min(full, float(rising[-1]))
    knots = [[0.0, 0.0]]
    for intensity in INTENSITIES:
        wanted = rest + intensity * (reachable - rest)
        index = int(np.searchsorted(rising, wanted))
        index = min(max(index, 1), len(scales) - 1)
        low, high = rising[index - 1], rising[index]
        share = (wanted - low) / (high - low) if high > low else 1.0
        scale = scales[index - 1] + share * (scales[index] - scales[index - 1])
        knots.append([intensity, round(float(scale), 4)])
    return knots


def uncalibrated(rig: Rig) -> Rig:
    """Return `rig` with every curve straight, reaching up to the greatest scale."""
    top = float(SCALES[-1])
    straight = ((0.0, 0.0), (1.0, top))
    units = {name: replace(unit, curve=straight) for name, unit in rig.action_units.items()}
    return replace(rig, action_units=units)


def calibrate(rig: Rig, *only: str) -> Mapping[str, list[list[float]]]:
    """Return the fitted curve of every unit that has a landmark to fit, or of `only` some."""
    plain, top = uncalibrated(rig), float(SCALES[-1])
    curves: dict[str, list[list[float]]] = {}
    for landmark in (mark for mark in LANDMARKS if not only or mark.unit in only):
        if landmark.calibrates and landmark.unit in rig.action_units:
            curves[landmark.unit] = _curve(plain, landmark, top)
    return curves


def _curve(rig: Rig, landmark: Landmark, top: float) -> list[list[float]]:
    keyframes = [Keyframe()] + [
        Keyframe(action_units={landmark.unit: float(scale) / top}) for scale in SCALES
    ]
    values = np.array([landmark.measure(face) for face in settle(rig, keyframes)])
    full = landmark.full or landmark.low + AIM * (landmark.high - landmark.low)
    return fit_curve(np.concatenate([[0.0], SCALES]), values, full)


def reaches(rig: Rig) -> dict[str, float]:
    """Return the factors on the curves of a rig's units that bring its landmarks into range.

    Units that are in range by `SPARE` of it have none. A unit with several landmarks gets the
    factor nearest 1 that suits all of them, if one does, or else the one that is calibrated.
    """
    factors: dict[str, float] = {}
    for _ in range(REACH_ROUNDS):
        units = {
            name: unit.reaching(factors[name]) if name in factors else unit
            for name, unit in rig.action_units.items()
        }
        low: dict[str, float] = {}
        high: dict[str, float] = {}
        for found in measure_units(replace(rig, action_units=units)):
            mark, value = found.landmark, found.value
            if mark.scale != "mm" or min(value, mark.low) <= 0.0:
                continue
            spare = SPARE * (mark.high - mark.low)
            least, most = (mark.low + spare) / value, (mark.high - spare) / value
            if mark.unit in low and not mark.calibrates and least > high[mark.unit]:
                continue
            low[mark.unit] = max(low.get(mark.unit, 0.0), least)
            high[mark.unit] = min(high.get(mark.unit, math.inf), most)
        for unit, least in low.items():
            most = max(high[unit], least)
            factor = factors.get(unit, 1.0) * min(max(1.0, least), most)
            factor = min(max(factor, FARTHEST_REACH[0]), FARTHEST_REACH[1])
            if factor != 1.0:
                factors[unit] = round(factor, 3)
    return factors


def main() -> None:
    """Rewrite the curves of the built-in action units, or the reaches of the people."""
    data = Path(__file__).parent / "data"
    if sys.argv[1:] == ["people"]:
        _write_reaches(data / "reaches.json")
        return
    path = data / "action_units.json"
    stored = json.loads(path.read_text(encoding="utf-8"))
    curves = calibrate(builtin_rig("standard"), *sys.argv[1:])
    for entry in stored["action_units"]:
        entry["curve"] = curves.get(entry["name"], entry["curve"])
    path.write_text(json.dumps(stored, indent=1) + "\n", encoding="utf-8")


def _write_reaches(path: Path) -> None:
    stored = json.loads(path.read_text(encoding="utf-8"))
    plain = load_action_units()
    for name in people():
        rig = replace(builtin_rig(name), action_units=plain)
        stored["people"][name] = dict(sorted(reaches(rig).items()))
    path.write_text(json.dumps(stored, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
