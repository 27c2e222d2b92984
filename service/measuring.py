"""The table of action units against human motion, and how well the tissue behaves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from engine import Keyframe, Rig, builtin_rig, judge, measure_units, people

from .tables import markdown_table

Stage = Callable[[str], None]


def measure_rig(rig: Rig, show: Stage) -> dict[str, Any]:
    """Return every landmark of the rig's action units, and each expression's figures.

    Args:
        rig: A rig with named points.
        show: Told what is being measured.
    """
    show("action units")
    landmarks = [
        {
            "action_unit": m.landmark.unit,
            "what": m.landmark.what,
            "scale": m.landmark.scale,
            "low_mm": m.landmark.low,
            "high_mm": m.landmark.high,
            "measured_mm": round(m.value, 2),
            "direction_right": m.direction_right,
            "in_range": m.in_range,
        }
        for m in measure_units(rig)
    ]
    show("tissue")
    expressions = {unit: Keyframe(action_units={unit: 1.0}) for unit in rig.action_units}
    expressions |= {
        label: Keyframe(emotion=(label, 1.0))
        for label, emotion in rig.emotions.items()
        if emotion.recipe
    }
    judged = judge(rig, list(expressions.values()))
    quality = [
        {
            "expression": name,
            "folded_triangles": q.folded,
            "roughness": round(q.roughness, 3),
            "asymmetry_mm": round(q.asymmetry, 3),
            "residual_speed_mm_s": round(q.residual_speed, 3),
            "settling_ms": round(1000.0 * q.settling_share),
            "path_dependence_mm": round(q.path, 3),
        }
        for name, q in zip(expressions, judged, strict=True)
    ]
    return {"rig": rig.id, "landmarks": landmarks, "tissue": quality}


def markdown(figures: dict[str, Any]) -> str:
    """Return the figures as two Markdown tables."""
    landmarks = []
    for row in figures["landmarks"]:
        verdict = (
            "" if row["in_range"] else (" (out)" if row["direction_right"] else " (WRONG WAY)")
        )
        span = f"{_span(row['low_mm'], row['high_mm'])} {row['scale']}"
        measured = f"{row['measured_mm']:.1f} {row['scale']}{verdict}"
        landmarks.append((row["action_unit"], row["what"], span, measured))
    tissue = [
        (
            row["expression"],
            row["folded_triangles"],
            f"{row['roughness']:.3f}",
            f"{row['asymmetry_mm']:.2f}",
            f"{row['residual_speed_mm_s']:.2f}",
            row["settling_ms"],
            f"{row['path_dependence_mm']:.2f}",
        )
        for row in figures["tissue"]
    ]
    head = (
        "expression",
        "folded",
        "roughness",
        "asymmetry, mm",
        "mm/s",
        "settling, ms",
        "path, mm",
    )
    return "\n".join(
        [
            *markdown_table(("AU", "landmark", "human motion", "measured"), landmarks),
            "",
            *markdown_table(head, tissue),
        ]
    )


def measure_people(show: Stage) -> dict[str, dict[str, list[float | bool]]]:
    """Return, by person and landmark, the motion at full intensity, mm, and whether it is right."""
    figures: dict[str, dict[str, list[float | bool]]] = {}
    for name in ("standard", *people()):
        show(name)
        figures[name] = {
            f"{m.landmark.unit} {m.landmark.what}": [round(m.value, 2), m.direction_right]
            for m in measure_units(builtin_rig(name))
            if m.landmark.scale == "mm"  # Eyes and head turn alike on everybody.
        }
    return figures


def people_markdown(figures: dict[str, dict[str, list[float | bool]]]) -> str:
    """Return the people's figures as a Markdown table, a landmark a row."""
    names = list(figures)
    rows = []
    for landmark in figures[names[0]]:
        found = (figures[name][landmark] for name in names)
        cells = (f"{value:.1f}" + ("" if right else " (WRONG WAY)") for value, right in found)
        rows.append((landmark, *cells))
    return "\n".join(markdown_table(("motion, mm", *names), rows))


def _span(low: float, high: float) -> str:
    return f"up to {high:g}" if low < 0 else f"{low:g} to {high:g}"
