"""An analysis as tables for the command line."""

from __future__ import annotations

from typing import Any

from .insight_bodies import AnalysisBody, MeasuredBody, StrainBody

_REGIONS_SHOWN = 8
_SHOWN_MM = 1.0


def analysis_markdown(data: dict[str, Any]) -> str:
    """Return the plain data of an analysis as Markdown tables.

    Args:
        data: From `engine.Analysis.to_json`.
    """
    body = AnalysisBody.model_validate(data)
    parts = [] if body.measured is None else _measured(body.measured)
    parts += ["", *_muscles(body), "", *_layers(body), "", *_regions(body)]
    return "\n".join(parts).lstrip("\n")


def _measured(measured: MeasuredBody) -> list[str]:
    lines = ["| action unit | requested | measured |", "|---|---|---|"]
    for unit in measured.action_units:
        name = f"{unit.side}{unit.unit.removeprefix('AU')}" if unit.side else unit.unit
        seen = "moves no tissue" if unit.measured is None else f"{unit.measured:.2f}"
        alike = f" (looks like {unit.shown_as})" if unit.shown_as else ""
        lines.append(f"| {name} | {unit.requested:.2f} | {seen}{alike} |")
    lines += ["", f"Not explained by any unit: {measured.residual:.0%} of the motion."]
    for fight in measured.fights:
        one, other = fight.units
        lines.append(
            f"{one} fights {other}: {one} shows {fight.measured[0]:.2f} of "
            f"{fight.requested[0]:.2f}, {other} {fight.measured[1]:.2f} of "
            f"{fight.requested[1]:.2f}."
        )
    for pair in measured.antagonists:
        lines.append(f"{pair.muscles[0]} pulls against {pair.muscles[1]} ({pair.opposed:.0%}).")
    return lines


def _muscles(body: AnalysisBody) -> list[str]:
    lines = [
        "| muscle | activation | force, mN | shorter by, mm | share |",
        "|---|---|---|---|---|",
    ]
    for muscle in body.muscles:
        shorter = muscle.contraction_mm or 0.0
        if muscle.activation < 0.005 and abs(shorter) < _SHOWN_MM:
            continue
        if muscle.turn_degrees is not None:
            turn = ", ".join(f"{angle:.1f}" for angle in muscle.turn_degrees)
            way = f"turns lids by {turn} degrees | "
        else:
            way = f"{shorter:.1f} | {muscle.contraction_share or 0.0:.0%}"
        lines.append(f"| {muscle.name} | {muscle.activation:.2f} | {muscle.force_mN:.0f} | {way} |")
    return lines


def _layers(body: AnalysisBody) -> list[str]:
    lines = [
        "| layer | tension: mean | p95 | max | compression: mean | p95 | max |",
        "|---|---|---|---|---|---|---|",
    ]
    return [*lines, *(f"| {name} | {_strain(strain)} |" for name, strain in body.layers.items())]


def _strain(strain: StrainBody) -> str:
    spreads = (strain.tension, strain.compression)
    return " | ".join(f"{v:.1%}" for s in spreads for v in (s.mean, s.p95, s.max))


def _regions(body: AnalysisBody) -> list[str]:
    lines = [
        f"Elastic energy above rest: {body.energy.total_uJ:.0f} µJ.",
        "",
        "| region | energy, µJ | epidermis: tension p95 | compression p95 |",
        "|---|---|---|---|",
    ]
    most = sorted(body.regions.items(), key=lambda item: -item[1].energy)[:_REGIONS_SHOWN]
    for name, region in most:
        skin = region.layers["epidermis"]
        lines.append(
            f"| {name} | {region.energy_uJ:.0f} | {skin.tension.p95:.1%} "
            f"| {skin.compression.p95:.1%} |"
        )
    return lines
