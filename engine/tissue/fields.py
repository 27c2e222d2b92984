"""What of the tissue goes by region or by point: stiffness, thickness, laxity, pre-tension."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..errors import InvalidValue, UnknownName
from ..head import Head
from .layers import Sheet
from .parameters import TissueParameters
from .places import WHOLE_FACE, region_share, tautness

LAXITY_OF_TENSION = 0.4
"""Share of the pre-tension that wholly lax skin has lost; a face that loses 80 % crumples."""
LAXITY_OF_FIBRES = 0.35
"""Share of the stiffness below the strain threshold, and of the ties to the skull, that wholly lax
skin has lost; elasticity halves from 20 to 80 years (Cua, Wilhelm, Maibach 1990)."""
MOST_TENSION = 0.4
"""Greatest pre-tension anywhere; the same bound as on what an edit asks for."""
SPREAD_MM = 18.0
"""How far a measured thickness speaks for the skin around it."""
DERMIS_OF_DEPTH = 0.4
"""Greatest share of the depth to bone that the skin itself may have where either is edited."""
THICKNESS_EFFECT = (0.3, 3.0)
"""Least and greatest factor on a stiffness that a given thickness makes."""


@dataclass(frozen=True, eq=False)
class TissueFields:
    """What the assembly takes by node, each of shape (n,); without maps, one value everywhere.

    Attributes:
        depth: Skin to bone, mm.
        dermis: Epidermis to dermis, mm.
        stiffness: Factor on springs along the layers.
        skin: The same for epidermis and dermis only: a membrane is as stiff as it is thick.
        slack: Factor on their stiffness below the strain threshold.
        pretension: Share by which they are shorter than at rest.
        ties: Factor on the ties to the skull: a tall column holds less than a low one.
    """

    depth: FloatArray
    dermis: FloatArray
    stiffness: FloatArray
    skin: FloatArray
    slack: FloatArray
    pretension: FloatArray
    ties: FloatArray


def fields_of(head: Head, sheet: Sheet, parameters: TissueParameters) -> TissueFields:
    """Return the tissue of `head` by node.

    Args:
        head: For its depths, point names and mirror.
        sheet: Its surface.
        parameters: Whole-face constants, region factors and thickness maps.
    """
    p, n = parameters, head.sheet_count
    own_depth = head.depth if p.regional_depth else np.full(n, p.uniform_depth)
    own_dermis = np.full(n, p.dermis_depth)
    thickness = _region_factor(sheet, p.region_thickness)
    depth = thickness * _mapped(head, own_depth, p.tissue_depth)
    dermis = thickness * _mapped(head, own_dermis, p.skin_thickness)
    edited = (depth != own_depth) | (dermis != own_dermis)
    dermis = np.where(edited, np.minimum(dermis, DERMIS_OF_DEPTH * depth), dermis)
    laxity = _region_value(sheet, p.region_laxity)
    ties = np.clip(own_depth / depth, *THICKNESS_EFFECT) * (1.0 - LAXITY_OF_FIBRES * laxity)
    return TissueFields(
        depth=depth,
        dermis=dermis,
        stiffness=_region_factor(sheet, p.region_stiffness),
        skin=np.clip(dermis / own_dermis, *THICKNESS_EFFECT),
        slack=1.0 - LAXITY_OF_FIBRES * laxity,
        pretension=np.minimum(
            p.pretension
            * tautness(sheet)
            * _region_factor(sheet, p.region_pretension)
            * (1.0 - LAXITY_OF_TENSION * laxity),
            MOST_TENSION,
        ),
        ties=ties,
    )


def check_fields(head: Head, parameters: TissueParameters) -> None:
    """Check what the parameters name against the head that they are for.

    Raises:
        UnknownName: For a region or a cage point that the head does not have.
        InvalidValue: For a map by node of another length.
    """
    labels = {WHOLE_FACE, *head.polygon_regions}
    for name in ("region_stiffness", "region_thickness", "region_laxity", "region_pretension"):
        for region in getattr(parameters, name):
            stem, _, side = region.partition(".")
            if side not in ("", "L", "R") or not any(stem and stem in label for label in labels):
                raise UnknownName("region", region, labels)
    n = head.sheet_count
    for name in ("skin_thickness", "tissue_depth"):
        values = getattr(parameters, name)
        if isinstance(values, Mapping):
            for point in values:
                _nodes(head, point)
        elif values and len(values) != n:
            raise InvalidValue(
                f"{name} has {len(values)} entries; expected {n}, one for each tissue node of the "
                "sheet, or an object by cage point"
            )


def _region_factor(sheet: Sheet, factors: Mapping[str, float]) -> FloatArray:
    scale = np.ones(len(sheet.points))
    for region, factor in factors.items():
        scale *= 1.0 + (factor - 1.0) * region_share(sheet, region)
    return scale


def _region_value(sheet: Sheet, values: Mapping[str, float]) -> FloatArray:
    """Return the greatest of what the regions give each node, shape (n,); 0 where none does."""
    result = np.zeros(len(sheet.points))
    for region, value in values.items():
        result = np.maximum(result, value * region_share(sheet, region))
    return result


def _mapped(
    head: Head, own: FloatArray, given: Mapping[str, float] | tuple[float, ...]
) -> FloatArray:
    """Return the thickness by node, mm, shape (n,): as given, and spread to what lies around.

    Between measured points the ratio to the head's own thickness is interpolated (Shepard's
    inverse squared distances), and fades to 1 away from them.

    Args:
        head: For point names and places.
        own: The head's own thickness, mm, shape (n,).
        given: By cage point, or by node.
    """
    if not given:
        return own
    if not isinstance(given, Mapping):
        return np.array(given)
    nodes: dict[int, float] = {}
    for name, value in given.items():
        for node in _nodes(head, name):
            nodes[node] = value
    index = np.array(list(nodes))
    ratio = np.array(list(nodes.values())) / own[index]
    points = head.points[: head.sheet_count]
    squared = ((points[:, None] - points[index][None]) ** 2).sum(axis=2)
    weight = 1.0 / np.maximum(squared, 1.0e-6)
    background = 1.0 / SPREAD_MM**2
    spread = (weight @ ratio + background) / (weight.sum(axis=1) + background)
    spread[index] = ratio
    return np.asarray(own * spread)


def _nodes(head: Head, name: str) -> list[int]:
    """Return the nodes of a cage point; without side, "M1_5" is both.

    Raises:
        UnknownName: If the sheet has no such point.
    """
    index = {point: node for node, point in enumerate(head.names[: head.sheet_count]) if point}
    found = [index[each] for each in (name, f"{name}.L", f"{name}.R") if each in index]
    if not found:
        raise UnknownName("point", name, index)
    return found
