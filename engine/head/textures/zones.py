"""Zones of the skin: where it is redder, browner, oilier, bearded; fields over the built-in head.

Every zone is a smooth field at the drawn vertices, looked up by place on the built-in head and by
region, so that it lies alike on all people. What is finer than a vertex is made texel by texel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ...arrays import BoolArray, FloatArray, IntArray
from ..anatomy import smoothstep
from ..hairline import scalp_cover
from ..head import DrawnSurface
from ..parts.brows import brow_line
from ..recipe import Recipe

LIPS = ("upper_lip", "lower_lip")
LIPS_INSIDE = ("upper_lip_inner", "lower_lip_inner")
LID_MELANIN = 0.75
"""How much browner than the face the upper lids are on the darkest skin."""
NO_HAIR = ("upper_lip", "lower_lip", "nose", "nose_tip", "ala", "columella", "ear")


@dataclass(frozen=True, eq=False)
class Surface:
    """The skin as a field's domain.

    Attributes:
        places: Positions on the built-in head [mm], shape (d, 3).
        regions: Index into `names` of each vertex.
        names: The regions' names.
        around: Mean of a vertex' neighbours across seams, sparse (d, d).
        edges: Pairs of neighbours, shape (e, 2).
    """

    places: FloatArray
    regions: IntArray
    names: tuple[str, ...]
    around: sp.csr_array
    edges: IntArray

    @classmethod
    def of(cls, drawn: DrawnSurface) -> Surface:
        """Return the domain that a drawn skin is."""
        assert drawn.reference is not None
        count = len(drawn.reference)
        seams = np.arange(count) if drawn.seams is None else drawn.seams
        triangles = seams[drawn.triangles]
        sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        edges = np.unique(np.sort(sides, axis=1), axis=0)
        i, j = edges.T
        graph = sp.csr_array((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), (count, count))
        total = np.maximum(np.asarray(graph.sum(axis=1)), 1)
        around = sp.csr_array((sp.diags_array(1 / total) @ graph)[seams])
        return cls(drawn.reference, drawn.regions[seams], drawn.region_names, around, edges)

    def inside(self, *names: str) -> BoolArray:
        """Return which vertices lie in one of some regions, shape (d,)."""
        return np.isin(self.regions, [self.names.index(n) for n in names if n in self.names])

    def mask(self, *names: str, blur: int = 1) -> FloatArray:
        """Return the regions as a mask in 0..1 whose border is softened `blur` times."""
        mask = self.inside(*names).astype(float)
        for _ in range(blur):
            mask = 0.5 * mask + 0.5 * (self.around @ mask)
        return mask

    def depth(self, *names: str) -> FloatArray:
        """Return how deep each vertex lies inside some regions [mm], negative outside."""
        from scipy.spatial import cKDTree  # Here: a start does without.

        inside = self.inside(*names)
        i, j = self.edges.T
        border = inside[i] != inside[j]
        if not border.any():
            return np.full(len(inside), -100.0)
        middles = (self.places[i[border]] + self.places[j[border]]) / 2
        distance = np.asarray(cKDTree(middles).query(self.places, k=2)[0]).mean(axis=1)
        return np.asarray(np.where(inside, distance, -distance))


@dataclass(frozen=True, eq=False)
class Zones:
    """Fields over the skin, shape (d,) each.

    Attributes:
        blood: Redness of the zone, about 0; so are all to `yellow` in units of a pigment.
        melanin: Brownness.
        yellow: Yellowness.
        violet: How thin and veined the skin under the eyes is, 0..1.
        lip: Depth inside the red of the lips [mm], negative outside.
        upper: Share of the upper lip, 0..1.
        mouth: Share of mucosa.
        nostril: Share of the nostril's inside.
        lid: Share of the lids' edges.
        lashes: Share of the line that lashes grow on.
        beard: How densely a beard grows.
        scalp: How far roots of hair hide the scalp.
        brow: How densely the brows grow.
        freckles: How many freckles come.
        pores: How wide pores are.
        oil: How oily the skin is.
        front: 1 on the face, 0 on neck and behind.
    """

    blood: FloatArray
    melanin: FloatArray
    yellow: FloatArray
    violet: FloatArray
    lip: FloatArray
    upper: FloatArray
    mouth: FloatArray
    nostril: FloatArray
    lid: FloatArray
    lashes: FloatArray
    beard: FloatArray
    scalp: FloatArray
    brow: FloatArray
    freckles: FloatArray
    pores: FloatArray
    oil: FloatArray
    front: FloatArray

    def table(self) -> FloatArray:
        """Return all fields side by side, shape (d, k), in the order of the attributes."""
        return np.column_stack(list(vars(self).values()))


def zones_of(surface: Surface, recipe: Recipe) -> Zones:
    """Return the zones of the skin of a person."""
    x, y, z = np.abs(surface.places[:, 0]), surface.places[:, 1], surface.places[:, 2]

    def spot(cx: float, cy: float, width: float, height: float) -> FloatArray:
        ellipse = np.exp(-(((x - cx) / width) ** 2) - ((y - cy) / height) ** 2)
        return np.asarray(ellipse * smoothstep(15, 55, z))

    front = np.asarray(smoothstep(0, 45, z) * smoothstep(-150, -118, y))
    ears = surface.mask("ear", blur=2)
    ala = surface.mask("ala", blur=3)
    tip = spot(0, -40, 15, 10) * smoothstep(88, 102, z)
    nose = spot(0, -30, 17, 18) * smoothstep(82, 95, z)
    cheek = spot(40, -36, 20, 16)
    chin = spot(0, -104, 17, 12)
    under_eye = spot(29, -10.5, 14, 4.6) + 0.8 * spot(18, -8, 6, 6)
    upper_lid = spot(31, 8, 17, 6.5)
    neck = smoothstep(-112, -135, y)
    beard = _beard(surface, x, y, z)
    return Zones(
        blood=0.19 * cheek
        + 0.22 * tip
        + 0.17 * ala
        + 0.16 * chin
        + 0.13 * ears
        + 0.16 * upper_lid
        + 0.07 * spot(22, -40, 9, 12)
        + 0.05 * spot(0, 15, 14, 10)
        + 0.06 * neck * smoothstep(0, 50, z)
        - 0.07 * spot(0, 52, 44, 22),
        melanin=0.08 * spot(31, -12, 16, 7)
        + (0.10 + LID_MELANIN * recipe.skin) * upper_lid
        + 0.08 * spot(0, 62, 60, 16)
        + 0.07 * spot(0, -93, 16, 5)
        + 0.05 * spot(0, -78, 34, 24)
        + 0.06 * ala
        + 0.07 * spot(64, 8, 16, 34)
        + 0.05 * spot(60, -60, 18, 26)
        - 0.05 * spot(38, -26, 18, 9)
        + 0.05 * neck,
        yellow=0.13 * spot(0, 50, 48, 26) + 0.05 * spot(0, -62, 22, 8) + 0.06 * spot(31, 14, 18, 6),
        violet=np.clip(under_eye, 0, 1),
        lip=_softened(surface, surface.depth(*LIPS, *LIPS_INSIDE, "mouth_inner")),
        upper=np.asarray(smoothstep(-72.6, -70.6, y)),
        mouth=np.clip(surface.mask("mouth_inner", blur=1) + 0.8 * surface.mask(*LIPS_INSIDE), 0, 1),
        nostril=surface.mask("nostril", blur=1),
        lid=np.clip(
            surface.mask("upper_lid_margin", "lower_lid_margin")
            + surface.mask("upper_lid_inner", "lower_lid_inner"),
            0,
            1,
        ),
        # Between the roots of the upper lashes the lid lies in their shade.
        lashes=np.clip(1.25 * surface.mask("upper_lid_margin", blur=3), 0, 1)
        * smoothstep(-1, 1.5, y)
        + 0.25 * surface.mask("lower_lid_margin"),
        beard=beard,
        scalp=scalp_cover(surface.places, recipe) * (1 - surface.mask("ear", blur=1)),
        brow=_brow(x, y, z, recipe),
        freckles=np.clip(
            1.1 * spot(24, -26, 34, 18) + nose + 0.45 * spot(0, 45, 50, 30) + 0.25 * front, 0, 1.3
        )
        * (1 - neck),
        pores=np.clip(
            1.1 * nose + 0.3 * ala + 0.95 * spot(26, -34, 16, 14) + 0.55 * spot(0, 25, 22, 18)
            + 0.6 * chin + 0.25 * front, 0, 1.2,
        ) * (1 - np.clip(under_eye + upper_lid, 0, 1)),
        oil=np.clip(
            nose + 0.55 * spot(0, 45, 34, 34) + 0.22 * spot(34, -28, 20, 12) + 0.45 * chin, 0, 1
        ),
        front=front,
    )  # fmt: skip


def _softened(surface: Surface, depth: FloatArray) -> FloatArray:
    """Return a depth whose border no longer steps from triangle to triangle."""
    found = depth
    for _ in range(3):
        found = 0.4 * found + 0.6 * (surface.around @ found)
    return np.asarray(np.where(np.abs(depth) < 8, found, depth))


def _beard(surface: Surface, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    """Return where a beard grows: moustache, chin, jaw, sideburns, thinning out over the cheek."""
    line = np.interp(x, [0, 28, 40, 52, 66, 80], [-58, -62, -72, -66, -34, 10])
    grown = smoothstep(3, -11, y - line) * smoothstep(-146, -118, y) * smoothstep(-18, 22, z)
    nose = np.exp(-((x / 15) ** 4) - ((y + 46) / 9) ** 4)
    corner = 1 - 0.55 * np.exp(-(((x - 27) / 6) ** 2) - ((y + 82) / 7) ** 2)
    under = 1 - 0.7 * np.exp(-(((x - 13) / 9) ** 2) - ((y + 85) / 4) ** 2)
    bald = surface.mask(*NO_HAIR, *LIPS_INSIDE, "mouth_inner", blur=1)
    return np.asarray(np.clip(grown * corner * under * (1 - nose) * (1 - bald), 0, 1))


def _brow(x: FloatArray, y: FloatArray, z: FloatArray, recipe: Recipe) -> FloatArray:
    start, end = brow_line(np.array([0.0, 1.0]), recipe)[0]
    share = np.clip((x - start) / (end - start), 0, 1)
    _, middle, width = brow_line(share, recipe)
    band = np.exp(-(((y - middle) / (0.62 * width)) ** 4))
    ends = smoothstep(start - 3, start + 5, x) * smoothstep(end + 1, end - 5, x)
    return np.asarray(band * ends * smoothstep(40, 60, z))
