"""How flesh bears every expression, mixes of them, and the lack of each term of the tissue."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from engine import (
    Flesh,
    Keyframe,
    Rig,
    Simulator,
    examine,
    jolts,
    path_dependence,
    random_mixes,
)

from .tables import markdown_table

Stage = Callable[[str], None]

HISTORIES = 10
MIX_SEED = 2001
LACKING: Mapping[str, Mapping[str, object]] = {
    "all of them": {},
    "no pre-tension": {"pretension": 0.0},
    "no volume of elements": {"skin_volume": 0.0},
    "no hold on thin columns": {"thin_skin_grip": False},
    "no fat columns": {"fat_pressure": 0.0},
    "a bending plate besides": {"plate": 20.0},
    "no smoothing of forces": {"force_smoothing": 0},
    "no ligament": {"ligament": 1.0},
    "bare springs": {
        "pretension": 0.0,
        "skin_volume": 0.0,
        "thin_skin_grip": False,
        "fat_pressure": 0.0,
        "force_smoothing": 0,
        "ligament": 1.0,
    },
}
"""Edits that take one of the terms beyond the paper away, and one that takes all."""
LACKING_UNITS = ("AU1", "AU4", "AU6", "AU9", "AU10", "AU12", "AU15", "AU17", "AU18", "AU23", "AU26")
COST_TICKS = 20
_EXPRESSION_HEAD = (
    "expression",
    "inverted",
    "least element",
    "volume",
    "worst region",
    "folds",
    "roughness",
    "drawn",
    "left-right, mm",
    "mm/s",
    "path, mm",
    "jolt, mm",
    "through",
)
_TERM_HEAD = (
    "tissue",
    "inverted",
    "folds",
    "volume, %",
    "roughness",
    "mm/s",
    "left-right, mm",
    "cost of a substep",
)


def measure_flesh(rig: Rig, mixes: int, show: Stage) -> dict[str, Any]:
    """Return the flesh's figures in every unit and emotion, in random mixes, and term by term.

    Args:
        rig: The rig.
        mixes: How many random mixes of units.
        show: Told what is being measured.
    """
    expressions = {
        unit: Keyframe(action_units={unit: 1.0})
        for unit, one in rig.action_units.items()
        if one.region not in ("gaze", "head")
    }
    expressions |= {
        label: Keyframe(emotion=(label, 1.0)) for label, e in rig.emotions.items() if e.recipe
    }
    show("action units and emotions")
    single = examine(rig, list(expressions.values()))
    show(f"{len(expressions)} expressions from {HISTORIES} pasts")
    paths = path_dependence(rig, list(expressions.values()), histories=HISTORIES)
    show(f"{len(expressions)} expressions taken up and let go slowly")
    abrupt = jolts(rig, list(expressions.values()))
    show(f"{mixes} random mixes")
    mixed = examine(rig, random_mixes(rig, mixes, MIX_SEED))
    return {
        "rig": rig.id,
        "expressions": {
            name: {**_row(flesh), "path_mm": round(path, 3), "jolt_mm": round(jolt, 3)}
            for name, flesh, path, jolt in zip(expressions, single, paths, abrupt, strict=True)
        },
        "mixes": _summary(mixed),
        "terms": _terms(rig, show),
    }


def _row(flesh: Flesh) -> dict[str, Any]:
    worst = max(flesh.regions, key=lambda region: abs(flesh.regions[region]))
    return {
        "inverted": flesh.inverted,
        "least_share": round(flesh.least_share, 3),
        "volume_percent": round(100.0 * flesh.volume, 2),
        "worst_region": worst,
        "worst_region_percent": round(100.0 * flesh.regions[worst], 1),
        "folds": dict(flesh.folds),
        "roughness": round(flesh.roughness, 3),
        "drawn_roughness": round(flesh.drawn_roughness, 3),
        "asymmetry_mm": round(flesh.asymmetry, 3),
        "speed_mm_s": round(flesh.speed, 3),
        "through": dict(flesh.through),
    }


def _summary(mixed: Sequence[Flesh]) -> dict[str, float]:
    def most(values: list[float]) -> float:
        return round(max(values), 3)

    return {
        "count": len(mixed),
        "with_inverted_elements": sum(f.inverted > 0 for f in mixed),
        "inverted_elements": sum(f.inverted for f in mixed),
        "with_folds": sum(bool(f.folds) for f in mixed),
        "greatest_volume_change_percent": most([100.0 * abs(f.volume) for f in mixed]),
        "mean_roughness": round(float(np.mean([f.roughness for f in mixed])), 3),
        "mean_drawn_roughness": round(float(np.mean([f.drawn_roughness for f in mixed])), 3),
        "above_half_a_mm_per_s": sum(f.speed > 0.5 for f in mixed),
        "greatest_speed_mm_s": most([f.speed for f in mixed]),
        "with_anything_through_the_skin": sum(bool(f.through) for f in mixed),
    }


def _terms(rig: Rig, show: Stage) -> dict[str, dict[str, float]]:
    """Return the worst figures of some units without each term, and what a substep costs then.

    Costs are shares of the bare springs', the least of several runs taken turn by turn.
    """
    keyframes = [Keyframe(action_units={unit: 1.0}) for unit in LACKING_UNITS]
    rigs = {
        name: replace(rig, parameters=rig.parameters.edited(edits))
        for name, edits in LACKING.items()
    }
    show("what a substep costs")
    costs = _substep_costs(rigs)
    table = {}
    for name, edited in rigs.items():
        show(f"the tissue with {name}")
        found = examine(edited, keyframes)
        table[name] = {
            "inverted": sum(f.inverted for f in found),
            "folds": sum(sum(f.folds.values()) for f in found),
            "volume_percent": round(100.0 * max(abs(f.volume) for f in found), 1),
            "roughness": round(float(np.mean([f.roughness for f in found])), 3),
            "speed_mm_s": round(max(f.speed for f in found), 2),
            "asymmetry_mm": round(max(f.asymmetry for f in found), 2),
            "cost": round(costs[name] / costs["bare springs"], 2),
        }
    return table


def _substep_costs(rigs: Mapping[str, Rig]) -> dict[str, float]:
    simulators = {name: Simulator(rig, threads=1) for name, rig in rigs.items()}
    best = dict.fromkeys(rigs, float("inf"))
    for turn in range(4):
        for name, simulator in simulators.items():
            face = f"{turn}"
            simulator.add(face)
            simulator.apply(face, Keyframe(action_units={"AU12": 1.0}))
            start = time.thread_time()
            for _ in range(COST_TICKS):
                simulator.step()
            spent = (time.thread_time() - start) / (COST_TICKS * simulator.assembly.substeps)
            best[name] = min(best[name], spent)
            simulator.remove(face)
    return best


def flesh_markdown(figures: dict[str, Any]) -> str:
    """Return the figures as Markdown tables."""
    expressions = []
    for name, row in figures["expressions"].items():
        folds = ", ".join(f"{count} {region}" for region, count in row["folds"].items()) or "0"
        expressions.append(
            (
                name,
                row["inverted"],
                f"{row['least_share']:.2f}",
                f"{row['volume_percent']:+.1f} %",
                f"{row['worst_region']} {row['worst_region_percent']:+.0f} %",
                folds,
                f"{row['roughness']:.3f}",
                f"{row['drawn_roughness']:.3f}",
                f"{row['asymmetry_mm']:.2f}",
                f"{row['speed_mm_s']:.2f}",
                f"{row['path_mm']:.2f}",
                f"{row['jolt_mm']:.2f}",
                sum(row["through"].values()),
            )
        )
    mixes = [(name.replace("_", " "), f"{value:g}") for name, value in figures["mixes"].items()]
    terms = [
        (
            name,
            row["inverted"],
            row["folds"],
            f"{row['volume_percent']:.1f}",
            f"{row['roughness']:.3f}",
            f"{row['speed_mm_s']:.2f}",
            f"{row['asymmetry_mm']:.2f}",
            f"{row['cost']:.2f}",
        )
        for name, row in figures["terms"].items()
    ]
    return "\n".join(
        [
            *markdown_table(_EXPRESSION_HEAD, expressions),
            "",
            *markdown_table(("random mixes of 2 to 5 units", ""), mixes),
            "",
            *markdown_table(_TERM_HEAD, terms),
        ]
    )
