"""A face looked into: muscles, strain, energy, and what it shows beside what it was asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache

import numpy as np

from ..arrays import FloatArray
from ..assembly import Assembly
from ..dynamics import Skull
from ..facs import parse_facs
from ..rig import Model, Rig
from ..settling import UNIT_FADE, Progress
from ..simulator import Simulator, Snapshot
from ..skull import pose_skull
from ..timeline import TICKS_PER_SECOND, Keyframe
from ..tissue.parameters import LAYERS
from .basis import UnitBasis, unit_basis
from .energy import node_energy
from .measured import Seen, measure_face
from .muscles import MILLINEWTON, MuscleState, muscle_forces, muscle_states
from .strain import Strain, strain_of, strains_along

MICROJOULE = 17.3e-3
"""µJ of energy in one paper stiffness unit x mm²: 17.3 g/s² x mm²."""
SETTLE_SECONDS = 1.0


@dataclass(frozen=True, eq=False)
class Analysis:
    """A face at one moment.

    Attributes:
        snapshot: The face.
        muscles: Every muscle, in channel order.
        strain: By layer.
        region_strain: By region and layer.
        energy: Of each term over the whole face, paper stiffness units x mm², above rest.
        region_energy: The sum of all terms by region.
        seen: Measured action units; None if they were not asked for.
    """

    snapshot: Snapshot
    muscles: tuple[MuscleState, ...]
    strain: Mapping[str, Strain]
    region_strain: Mapping[str, Mapping[str, Strain]]
    energy: Mapping[str, float]
    region_energy: Mapping[str, float]
    seen: Seen | None

    def to_json(self) -> dict[str, object]:
        """Return the analysis as plain data, rounded for reading."""
        return {
            "rig": self.snapshot.assembly.rig.id,
            "tick": self.snapshot.tick,
            "muscles": [_muscle(state) for state in self.muscles],
            "layers": {layer: _rounded(asdict(s)) for layer, s in self.strain.items()},
            "energy": {
                "total": round(sum(self.energy.values()), 2),
                "total_uJ": round(sum(self.energy.values()) * MICROJOULE, 4),
                "terms": {name: round(value, 2) for name, value in self.energy.items()},
            },
            "regions": {
                region: {
                    "energy": round(self.region_energy[region], 2),
                    "energy_uJ": round(self.region_energy[region] * MICROJOULE, 4),
                    "layers": {layer: _rounded(asdict(s)) for layer, s in layers.items()},
                }
                for region, layers in self.region_strain.items()
            },
            **({} if self.seen is None else {"measured": _seen(self.seen)}),
        }


def analyze(
    snapshot: Snapshot,
    *,
    basis: UnitBasis | None = None,
    requested: Mapping[str, float] | None = None,
) -> Analysis:
    """Return what a face does inside.

    Args:
        snapshot: The face, from `Simulator.snapshot`.
        basis: Fields of the rig's units, from `unit_basis`; without them, none are measured.
        requested: Intensity by unit, as it was asked for.

    Raises:
        UnknownName: For a requested unit that the rig does not have.
    """
    assembly = snapshot.assembly
    tissue = assembly.tissue
    n = tissue.node_count
    regions = _regions(assembly)
    springs = strains_along(snapshot.x, tissue.arrays)
    forces = muscle_forces(snapshot)
    by_node = node_energy(snapshot.x, tissue.arrays, snapshot.skull, _rest_skull(assembly))
    whole = np.sum(list(by_node.values()), axis=0)
    seen = None
    if basis is not None:
        seen = measure_face(
            assembly.rig,
            tissue.sheet,
            basis,
            (snapshot.x[:, :n] - tissue.arrays.rest[:, :n]).T,
            requested or {},
            snapshot.signals[: assembly.rig.channels.muscle_count],
            forces,
        )
    in_layer = [springs.layer == layer for layer in range(3)]
    region_strain = {}
    for region, share in regions.items():
        inside = 0.5 * (share[springs.first] + share[springs.second]) >= 0.5
        region_strain[region] = {
            name: strain_of(springs, inside & in_layer[layer]) for layer, name in enumerate(LAYERS)
        }
    return Analysis(
        snapshot=snapshot,
        muscles=tuple(muscle_states(snapshot, forces)),
        strain={name: strain_of(springs, in_layer[layer]) for layer, name in enumerate(LAYERS)},
        region_strain=region_strain,
        energy={name: float(values.sum()) for name, values in by_node.items()},
        region_energy={region: float(share @ whole) for region, share in regions.items()},
        seen=seen,
    )


def analyze_facs(
    rig: Rig,
    facs: str,
    *,
    scale: str = "linear",
    model: Model | None = None,
    progress: Progress | None = None,
) -> Analysis:
    """Return the analysis of a FACS string such as "12C+15C", settled on a fresh face of `rig`.

    Raises:
        InvalidNotation: If the string cannot be read.
        UnknownName: For a unit the rig does not have, or a scale that there is not.
    """
    units = {term.key: term.intensity for term in parse_facs(facs, scale)}
    model = model or rig.model.live
    simulator = Simulator(rig, model=model)
    simulator.add("face")
    simulator.apply("face", Keyframe(action_units=units, fade=UNIT_FADE))
    for _ in range(round(SETTLE_SECONDS * TICKS_PER_SECOND)):
        simulator.step()
    basis = unit_basis(rig, model, progress=progress)
    return analyze(simulator.snapshot("face"), basis=basis, requested=units)


@lru_cache(maxsize=16)
def _regions(assembly: Assembly) -> dict[str, FloatArray]:
    """Return each region's share of each node, shape (n,); the shares of a node add up to 1."""
    sheet = assembly.tissue.sheet
    labels = sorted(set(sheet.polygon_regions))
    row = {label: index for index, label in enumerate(labels)}
    of_polygon = np.array([row[label] for label in sheet.polygon_regions])
    shares = np.zeros((len(labels), len(sheet.points)))
    for corner in range(4):
        has = sheet.polygons[:, corner] >= 0
        np.add.at(shares, (of_polygon[has], sheet.polygons[has, corner]), 1.0)
    shares /= np.maximum(shares.sum(axis=0), 1.0)
    return dict(zip(labels, shares, strict=True))


@lru_cache(maxsize=16)
def _rest_skull(assembly: Assembly) -> Skull:
    return pose_skull(assembly.rig, assembly.tissue, (0.0, 0.0, 0.0), np.zeros(4))


def _muscle(state: MuscleState) -> dict[str, object]:
    line: dict[str, object] = {
        "name": state.name,
        "activation": round(state.activation, 4),
        "force": round(state.force, 2),
        "force_mN": round(state.force * MILLINEWTON, 3),
    }
    if state.turn is not None:
        return {**line, "turn_degrees": [round(angle, 3) for angle in state.turn]}
    if state.rest_length is None or state.contraction is None or state.contraction_share is None:
        return line
    return {
        **line,
        "length_mm": round(state.rest_length - state.contraction, 3),
        "contraction_mm": round(state.contraction, 3),
        "contraction_share": round(state.contraction_share, 4),
    }


def _seen(seen: Seen) -> dict[str, object]:
    return {
        "action_units": [
            {
                "unit": u.unit,
                "side": u.side,
                "requested": round(u.requested, 3),
                "measured": None if u.measured is None else round(u.measured, 3),
                **({"shown_as": u.shown_as} if u.shown_as else {}),
            }
            for u in seen.units
        ],
        "fights": [_rounded(asdict(fight)) for fight in seen.fights],
        "antagonists": [_rounded(asdict(pair)) for pair in seen.antagonists],
        "residual": round(seen.residual, 4),
    }


def _rounded(value: object) -> object:
    """Return plain data with its floats rounded to four places."""
    if isinstance(value, float):
        return round(value, 4)
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(entry) for entry in value]
    return value
