"""Every constant of the tissue, with its source or its reason, and the terms that can be switched.

Stiffness is in the paper's units (Table 2), where one unit stands for 17.3 g/s²; only the ratio of
stiffness to mass, and of force to stiffness, shows in the motion.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace

from ..errors import InvalidValue, UnknownName

LAYERS = ("epidermis", "dermis", "hypodermis")


@dataclass(frozen=True)
class Layered:
    """One value for each tissue layer, from the surface down."""

    epidermis: float
    dermis: float
    hypodermis: float

    def __getitem__(self, layer: int) -> float:
        return (self.epidermis, self.dermis, self.hypodermis)[layer]


@dataclass(frozen=True)
class TissueParameters:
    """Constants of one face's tissue. The defaults are the `standard` rig's.

    The paper's own (section 5, Table 2):
        stiffness_low, stiffness_high: k_L and k_H of each layer's springs; springs between two
            layers take the lower layer's.
    Left open by the paper:
        strain_threshold: ε_c. 0.15 keeps the knee just above the rest strain of the pre-tension;
            0.20 brought a lateral asymmetry of 1 mm back in AU1 and AU4.
        compression_guard, guard_strain: third spring phase, k_g k_H beyond ε_k of compression;
            without it compressed layers fold. The best of eleven pairs tried.
        reference_length: L0, mm: springs scale by element size against it, so that a finer mesh
            of the same face is as stiff.
        dermis_depth: Epidermis to dermis, mm.
        hypodermis_share, hypodermis_least, hypodermis_most: Dermis to hypodermis as a share of
            the depth to bone, and its limits, mm. The paper gives no depths.
        anchor_tangential, anchor_normal: Tie of hypodermis to skull, along and across it.
        anchor_excess, anchor_excess_distance: The ties stiffen beyond this distance, mm.
        skull_stiffness, skull_gap: Wall of the skull, as a share of the normal tie, and the free
            way to it, mm.
        damping: c, 1/s, in C = c M; settles a step in about 0.2 s.
        mass_frequency: ω, rad/s: masses are 2 D / ω² with D the stiffness at a node, so that no
            mode is faster. Equilibria do not depend on it.
        activation_lag, lid_lag: First-order lags of muscles and jaw, and of lids, s; a blink must
            close in 0.1 s.
    Terms beyond the paper, each off at zero or False (all are off in the `paper` rig):
        pretension: Share by which in-layer springs are shorter than at rest. Living skin is under
            tension; without it compressed skin buckles. The rest residual is carried as a load.
        skin_volume: Modulus with which each element between two layers keeps its volume, per mm.
            Skin is nearly incompressible; at 100 a face keeps its volume to 2 % in a smile.
        layer_order: How many times harder an element resists when it is pressed flat, so that no
            layer passes another; it sets in smoothly, for a kink there makes lips chatter.
        layer_gap: Share of its volume below which an element counts as pressed flat.
        thin_skin_grip: Whether a muscle takes hold of the whole column where the layers lie close
            together, as in the corner of the lips, and not of its lowest node only.
        plate: Bending stiffness of the epidermis. Off here too: at 20 the skin looks no smoother
            and a substep costs a tenth more.
        force_smoothing: Passes that smooth the muscles' force over the skin.
        fat_pressure: Pressure modulus of the fat columns of cheek and lips.
        ligament: Factor on the normal tie along the nasolabial fold.
        upper_lid_skin, lower_lid_skin: The skin's share of the stiffness that holds a lid's plate,
            the rest being its muscles': a raised cheek lifts the lower lid, a brow the upper one.
        cross_diagonals: Springs along both diagonals of a quad, not only along edges.
        force_quadrature: Muscle weights integrated over each quad, not sampled at nodes.
        regional_depth: Skin depth by region; off: `uniform_depth` everywhere.
        uniform_depth: Depth to bone where it is not regional, mm (1.5 + 3 + 3).
    What goes by region (a label of the head's polygons such as "cheek", a part of several such as
    "lip", or "face"; "cheek.L" is one side) or by point, all empty on the built-in rigs:
        region_stiffness, region_thickness, region_pretension: Factor on the springs along the
            layers, on skin and depth to bone, and on the pre-tension.
        region_laxity: 0, as it is, to 1, wholly lax: see `engine.tissue.fields`.
        skin_thickness: Epidermis to dermis, mm, as ultrasound or MRI measures it.
        tissue_depth: Skin to bone, mm, as CT or MRI measures it. Both maps are by cage point
            ("M1_5.L"; "M1_5" is both sides), interpolated between them, or one value for each
            tissue node of the sheet, in the order of the stream.
    Muscles:
        muscle_strength: Force of every muscle against what is stored for it.
    """

    stiffness_low: Layered = Layered(50.0, 20.0, 30.0)
    stiffness_high: Layered = Layered(100.0, 40.0, 80.0)
    strain_threshold: float = 0.15
    compression_guard: float = 1.0
    guard_strain: float = 0.10
    reference_length: float = 8.0
    dermis_depth: float = 1.5
    hypodermis_share: float = 0.35
    hypodermis_least: float = 1.0
    hypodermis_most: float = 4.5
    anchor_tangential: float = 30.0
    anchor_normal: float = 150.0
    anchor_excess: float = 2.0
    anchor_excess_distance: float = 5.0
    skull_stiffness: float = 5.0
    skull_gap: float = 1.5
    damping: float = 30.0
    mass_frequency: float = 750.0
    activation_lag: float = 0.040
    lid_lag: float = 0.010
    pretension: float = 0.12
    skin_volume: float = 175.0
    layer_order: float = 6.0
    layer_gap: float = 0.8
    thin_skin_grip: bool = True
    plate: float = 0.0
    force_smoothing: int = 2
    fat_pressure: float = 120.0
    ligament: float = 3.0
    upper_lid_skin: float = 0.1
    lower_lid_skin: float = 0.3
    cross_diagonals: bool = True
    force_quadrature: bool = True
    regional_depth: bool = True
    uniform_depth: float = 7.5
    region_stiffness: Mapping[str, float] = field(default_factory=dict)
    region_thickness: Mapping[str, float] = field(default_factory=dict)
    region_laxity: Mapping[str, float] = field(default_factory=dict)
    region_pretension: Mapping[str, float] = field(default_factory=dict)
    skin_thickness: Mapping[str, float] | tuple[float, ...] = field(default_factory=dict)
    tissue_depth: Mapping[str, float] | tuple[float, ...] = field(default_factory=dict)
    muscle_strength: float = 1.0

    def __post_init__(self) -> None:
        for name, (low, high) in LIMITS.items():
            _check(name, getattr(self, name), low, high)
        for name in ("stiffness_low", "stiffness_high"):
            for layer in LAYERS:
                _check(f"{name}.{layer}", getattr(getattr(self, name), layer), *STIFFNESS_LIMITS)
        for layer in LAYERS:
            if getattr(self.stiffness_high, layer) < getattr(self.stiffness_low, layer):
                raise InvalidValue(
                    f"stiffness_high.{layer} is below stiffness_low.{layer}; "
                    "skin stiffens past the strain threshold"
                )
        for name, (low, high) in MAP_LIMITS.items():
            values = getattr(self, name)
            entries = values.items() if isinstance(values, Mapping) else enumerate(values)
            for entry, value in entries:
                _check(f"{name}.{entry}", value, low, high)
        most = LIMITS["pretension"][1]
        for region, factor in self.region_pretension.items():
            _check(
                f"pretension times region_pretension.{region}", self.pretension * factor, 0, most
            )

    def edited(self, changes: Mapping[str, object]) -> TissueParameters:
        """Return these parameters with `changes`, by field name; layered fields take a mapping.

        Raises:
            UnknownName: For a field or layer that does not exist.
            InvalidValue: For a value outside its limits.
        """
        known = {f.name for f in fields(self)}
        edits: dict[str, object] = {}
        for name, value in changes.items():
            if name not in known:
                raise UnknownName("tissue parameter", name, known)
            edits[name] = self._edit(name, value)
        return replace(self, **edits)  # type: ignore[arg-type]

    def _edit(self, name: str, value: object) -> object:
        old = getattr(self, name)
        if isinstance(old, Layered):
            return _edited_layers(name, old, value)
        if name in MAP_LIMITS:
            return _edited_map(name, old, value)
        if isinstance(old, bool):
            if not isinstance(value, bool):
                raise InvalidValue(f"{name} is {value!r}; expected true or false")
            return value
        number = _number(name, value)
        return round(number) if isinstance(old, int) else number

    def edits_of(self, before: TissueParameters) -> dict[str, object]:
        """Return the changes that make these parameters of others, as `edited` takes them."""
        edits: dict[str, object] = {}
        for f in fields(self):
            now, old = getattr(self, f.name), getattr(before, f.name)
            if now == old:
                continue
            if isinstance(now, Layered):
                layers = {layer: getattr(now, layer) for layer in LAYERS}
                edits[f.name] = {k: v for k, v in layers.items() if v != getattr(old, k)}
            else:
                edits[f.name] = now
        return edits

    def to_json(self) -> dict[str, object]:
        """Return the parameters as plain data."""
        return asdict(self)


STIFFNESS_LIMITS = (1.0, 2000.0)
"""Allowed range of k_L and k_H of each layer."""
LIMITS: Mapping[str, tuple[float, float]] = {
    "strain_threshold": (0.0, 1.0),
    "compression_guard": (0.0, 10.0),
    "guard_strain": (0.0, 1.0),
    "reference_length": (1.0, 50.0),
    "dermis_depth": (0.2, 5.0),
    "hypodermis_share": (0.05, 0.8),
    "hypodermis_least": (0.2, 5.0),
    "hypodermis_most": (0.5, 15.0),
    "anchor_tangential": (0.1, 1000.0),
    "anchor_normal": (0.1, 3000.0),
    "anchor_excess": (0.0, 50.0),
    "anchor_excess_distance": (0.1, 50.0),
    "skull_stiffness": (0.0, 50.0),
    "skull_gap": (0.0, 20.0),
    "damping": (5.0, 200.0),
    "mass_frequency": (100.0, 1000.0),
    "activation_lag": (0.0, 2.0),
    "lid_lag": (0.0, 2.0),
    "pretension": (0.0, 0.4),
    "skin_volume": (0.0, 1000.0),
    "layer_order": (0.0, 100.0),
    "layer_gap": (0.0, 1.0),
    "plate": (0.0, 500.0),
    "force_smoothing": (0, 20),
    "fat_pressure": (0.0, 600.0),
    "ligament": (0.0, 20.0),
    "upper_lid_skin": (0.0, 0.8),
    "lower_lid_skin": (0.0, 0.8),
    "uniform_depth": (2.0, 40.0),
    "muscle_strength": (0.0, 2.0),
}
"""Allowed range of each single number; beyond it a face is not stable or no longer a face."""

MAP_LIMITS: Mapping[str, tuple[float, float]] = {
    "region_stiffness": (0.25, 10.0),
    "region_thickness": (0.4, 2.5),
    "region_laxity": (0.0, 1.0),
    "region_pretension": (0.0, 3.0),
    "skin_thickness": (0.3, 5.0),
    "tissue_depth": (3.0, 40.0),
}
"""Allowed range of each entry of what goes by region or by point."""
POINT_MAPS = ("skin_thickness", "tissue_depth")
"""Those that may be given by tissue node too."""


def _edited_map(
    name: str, old: Mapping[str, float] | tuple[float, ...], value: object
) -> Mapping[str, float] | tuple[float, ...]:
    """Return a map with `value` taken in: sorted, so that the same input has the same id.

    None empties it; an array by node replaces it, and is replaced.
    """
    if value is None:
        return {}
    by_node = name in POINT_MAPS
    if isinstance(value, list | tuple) and by_node:
        return tuple(_number(f"{name}.{node}", v) for node, v in enumerate(value))
    if not isinstance(value, Mapping):
        what = "an object by cage point or an array by node, mm" if by_node else "one by region"
        raise InvalidValue(f"{name} is {value!r}; expected {what}")
    before = old if isinstance(old, Mapping) else {}
    after = {str(k): _number(f"{name}.{k}", v) for k, v in value.items()}
    return dict(sorted({**before, **after}.items()))


def _edited_layers(name: str, old: Layered, value: object) -> Layered:
    if not isinstance(value, Mapping):
        raise InvalidValue(f"{name} is {value!r}; expected a mapping such as {{'dermis': 20}}")
    for layer in value:
        if layer not in LAYERS:
            raise UnknownName("tissue layer", str(layer), LAYERS)
    return replace(old, **{layer: _number(f"{name}.{layer}", v) for layer, v in value.items()})


def _number(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InvalidValue(f"{name} is {value!r}; expected a number")
    return float(value)


def _check(name: str, value: float, low: float, high: float) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise InvalidValue(f"{name} is {value!r}; it must lie between {low:g} and {high:g}")


PAPER_PARAMETERS = TissueParameters(
    compression_guard=0.0,
    reference_length=7.7,
    damping=40.0,
    pretension=0.0,
    mass_frequency=600.0,
    skin_volume=0.0,
    layer_order=0.0,
    plate=0.0,
    force_smoothing=0,
    fat_pressure=0.0,
    ligament=1.0,
    upper_lid_skin=0.0,
    lower_lid_skin=0.0,
    thin_skin_grip=False,
    cross_diagonals=False,
    force_quadrature=False,
    regional_depth=False,
)
"""The paper's literal tissue: every term beyond it is off."""
