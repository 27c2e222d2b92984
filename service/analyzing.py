"""An analysis as tables for the command line."""

from __future__ import annotations

from typing import Any

from .insight_bodies import AnalysisBody, MeasuredBody, StrainBody
from .tables import markdown_table

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
    rows = []
    for unit in measured.action_units:
        name = f"{unit.side}{unit.unit.removeprefix('AU')}" if unit.side else unit.unit
        seen = "moves no tissue" if unit.measured is None else f"{unit.measured:.2f}"
        alike = f" (looks like {unit.shown_as})" if unit.shown_as else ""
        rows.append((name, f"{unit.requested:.2f}", f"{seen}{alike}"))
    lines = markdown_table(("action unit", "requested", "measured"), rows)
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
    rows = []
    for muscle in body.muscles:
        shorter = muscle.contraction_mm or 0.0
        if muscle.activation < 0.005 and abs(shorter) < _SHOWN_MM:
            continue
        if muscle.turn_degrees is not None:
            turn = ", ".join(f"{angle:.1f}" for angle in muscle.turn_degrees)
            way = (f"turns lids by {turn} degrees", "")
        else:
            way = (f"{shorter:.1f}", f"{muscle.contraction_share or 0.0:.0%}")
        rows.append((muscle.name, f"{muscle.activation:.2f}", f"{muscle.force_mN:.0f}", *way))
    return markdown_table(("muscle", "activation", "force, mN", "shorter by, mm", "share"), rows)


def _layers(body: AnalysisBody) -> list[str]:
    head = ("layer", "tension: mean", "p95", "max", "compression: mean", "p95", "max")
    return markdown_table(head, ((name, *_strain(strain)) for name, strain in body.layers.items()))


def _strain(strain: StrainBody) -> list[str]:
    spreads = (strain.tension, strain.compression)
    return [f"{v:.1%}" for s in spreads for v in (s.mean, s.p95, s.max)]


def _regions(body: AnalysisBody) -> list[str]:
    most = sorted(body.regions.items(), key=lambda item: -item[1].energy)[:_REGIONS_SHOWN]
    rows = []
    for name, region in most:
        skin = region.layers["epidermis"]
        spreads = (skin.tension.p95, skin.compression.p95)
        rows.append((name, f"{region.energy_uJ:.0f}", *(f"{p95:.1%}" for p95 in spreads)))
    head = ("region", "energy, µJ", "epidermis: tension p95", "compression p95")
    energy = f"Elastic energy above rest: {body.energy.total_uJ:.0f} µJ."
    return [energy, "", *markdown_table(head, rows)]
