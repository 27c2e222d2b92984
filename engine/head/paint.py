"""Paint: the colours of skin, lips, lids and hair at the vertices of the finest level.

Colours are mixed as an artist sees them (sRGB) and turned into linear light at the end. Where the
numbers come from: looking at faces and at renders.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..arrays import FloatArray
from .anatomy import smoothstep
from .cage import Cage
from .geometry import linear_rgb, vertex_normals
from .hairline import scalp_cover
from .noise import noise
from .parts.brows import brow_line
from .subdivision import Limit
from .tissue_surface import triangulated

Color = Sequence[float]

SKIN = (0.805, 0.575, 0.46)
RED = (0.775, 0.40, 0.335)
SALLOW = (0.80, 0.61, 0.47)
BROWNISH = (0.61, 0.39, 0.325)
BEARD = (0.62, 0.475, 0.415)
LID_EDGE = (0.68, 0.39, 0.345)
LASH_LINE = (0.21, 0.125, 0.095)
LID_INSIDE = (0.64, 0.28, 0.25)
UPPER_LIP = (0.635, 0.345, 0.305)
LOWER_LIP = (0.70, 0.41, 0.36)
LIP_INSIDE = (0.50, 0.18, 0.17)
MOUTH = (0.46, 0.175, 0.16)
NOSTRIL = (0.25, 0.09, 0.075)
SCALP_HAIR = (0.175, 0.135, 0.11)
BROW_SHADE = (0.25, 0.16, 0.115)


@dataclass(frozen=True, eq=False)
class Paint:
    """Colours of the finest level.

    Attributes:
        colors: Linear RGB, shape (d, 3).
        hair: Hair mask in 0..1, shape (d,).
        reference: Positions on the built-in head [mm], shape (d, 3).
    """

    colors: FloatArray
    hair: FloatArray
    reference: FloatArray


def painted(cage: Cage, limit: Limit, vertices: FloatArray) -> Paint:
    """Return the skin's colours.

    Args:
        cage: The cage, for its regions.
        limit: Its limit surface.
        vertices: Positions of the finest level [mm], shape (d, 3).
    """
    canvas = Canvas(cage, limit, vertices)
    _paint_complexion(canvas)
    _paint_lids(canvas)
    _paint_lips(canvas)
    canvas.blend(MOUTH, canvas.region("mouth_inner"))
    canvas.blend(NOSTRIL, 0.95 * canvas.region("nostril", blur=1))
    canvas.blend(BROW_SHADE, 0.26 * _brow_mask(canvas))
    hair = scalp_cover(vertices) * (1 - canvas.region("ear", blur=1))
    # Where hair is thin the skin shows between it; the viewer draws the single hairs there.
    canvas.blend(SCALP_HAIR, 0.9 * hair**3)
    _paint_unevenness(canvas)
    _paint_shade(canvas)
    return Paint(linear_rgb(canvas.colors), hair, vertices)


class Canvas:
    """The surface being painted; `colors` (sRGB) change as paint goes on."""

    def __init__(self, cage: Cage, limit: Limit, vertices: FloatArray) -> None:
        finest = limit.levels[-1]
        faces = finest.topology.faces
        self.vertices = vertices
        self.x, self.y, self.z = np.abs(vertices[:, 0]), vertices[:, 1], vertices[:, 2]
        self.normals = vertex_normals(vertices, triangulated(faces, vertices))
        self.colors = np.tile(np.array(SKIN), (len(vertices), 1))
        self._around = finest.topology.neighbours()
        to_vertices = sp.csr_array(finest.topology.faces_to_vertices().T)
        self._mean_of_faces = sp.csr_array(
            sp.diags_array(1 / to_vertices.sum(axis=1)) @ to_vertices
        )
        self._face_regions = np.array(cage.regions)[finest.parents]

    def region(self, *names: str, blur: int = 0) -> FloatArray:
        """Return the mask of some regions, 0..1: the share of faces around each vertex."""
        mask = self._mean_of_faces @ np.isin(self._face_regions, names).astype(float)
        return self.blurred(mask, blur)

    def blurred(self, mask: FloatArray, passes: int) -> FloatArray:
        """Return a mask averaged with its neighbours `passes` times."""
        for _ in range(passes):
            mask = 0.5 * mask + 0.5 * (self._around @ mask)
        return mask

    def spot(self, x: float, y: float, width: float, height: float | None = None) -> FloatArray:
        """Return a soft ellipse in the front view, on both sides of the face and not behind."""
        tall = width if height is None else height
        spot = np.exp(-(((self.x - x) / width) ** 2) - ((self.y - y) / tall) ** 2)
        return np.asarray(spot * smoothstep(20, 60, self.z))

    def blend(self, color: Color | FloatArray, share: FloatArray) -> None:
        """Lay `color` over the canvas with an opacity of `share`, shape (d,)."""
        self.colors += (np.asarray(color) - self.colors) * share[:, None]

    def scale(self, light: FloatArray) -> None:
        """Multiply the colours by `light`, shape (d,)."""
        self.colors *= light[:, None]


def _paint_complexion(canvas: Canvas) -> None:
    blush = 1 + 0.35 * noise(canvas.vertices, 7.0, 3)
    canvas.blend(RED, 0.17 * canvas.spot(42, -38, 22, 19) * blush)
    canvas.blend(RED, 0.34 * canvas.spot(0, -42, 15, 9) * smoothstep(85, 100, canvas.z))
    canvas.blend(RED, 0.20 * canvas.region("ala", blur=3))
    canvas.blend(RED, 0.20 * canvas.spot(0, -103, 16, 10) * blush)
    canvas.blend(SALLOW, 0.25 * canvas.spot(0, 55, 45, 30))
    canvas.blend(BROWNISH, 0.34 * canvas.spot(31, -11, 17, 5))
    canvas.blend((0.55, 0.37, 0.36), 0.12 * canvas.spot(18, -10, 7, 6))
    canvas.blend(BROWNISH, 0.28 * canvas.spot(31, 9, 18, 6))
    jowl = smoothstep(-78, -106, canvas.y) * smoothstep(10, 40, canvas.z)
    moustache = 0.7 * canvas.region("perioral_upper", "philtrum", blur=4)
    stubble = np.maximum(jowl * (1 - smoothstep(-122, -140, canvas.y)), moustache)
    canvas.blend(BEARD, 0.22 * stubble * (1 + 0.4 * noise(canvas.vertices, 2.5, 9)))


def _paint_lids(canvas: Canvas) -> None:
    edge = canvas.region("upper_lid_margin", "lower_lid_margin", blur=1)
    canvas.blend(LID_EDGE, 0.7 * edge)
    upper = canvas.region("upper_lid_margin", blur=1) * (canvas.y > 0)
    canvas.blend(LASH_LINE, 0.75 * upper)
    canvas.blend(LASH_LINE, 0.16 * canvas.region("lower_lid_margin", blur=1) * (canvas.y < 0))
    canvas.blend(LID_INSIDE, 0.8 * canvas.region("upper_lid_inner", "lower_lid_inner"))


def _paint_lips(canvas: Canvas) -> None:
    lip = canvas.region("upper_lip", "lower_lip", blur=1)  # its border is soft
    is_upper = smoothstep(-72.2, -71.0, canvas.y)[:, None]
    tone = np.array(UPPER_LIP) * is_upper + np.array(LOWER_LIP) * (1 - is_upper)
    # Lips are darker towards the corners and finely streaked upwards.
    streak = noise(canvas.vertices * [1.0, 0.28, 0.28], 1.5, 12)
    tone = tone * (1 + 0.045 * streak[:, None])
    tone = tone * (1 - 0.12 * smoothstep(14, 25, canvas.x))[:, None]
    canvas.blend(tone, 0.82 * lip)
    canvas.blend(LIP_INSIDE, 0.9 * canvas.region("upper_lip_inner", "lower_lip_inner", blur=1))


def _brow_mask(canvas: Canvas) -> FloatArray:
    """Return where hairs of the brows shade the skin between them."""
    start, end = brow_line(np.array([0.0, 1.0]))[0]
    share = np.clip((canvas.x - start) / (end - start), 0, 1)
    _, middle, width = brow_line(share)
    band = np.exp(-(((canvas.y - middle - 0.8) / (0.55 * width)) ** 2))
    ends = smoothstep(start - 1, start + 7, canvas.x) * smoothstep(end + 1, end - 5, canvas.x)
    return np.asarray(band * ends * smoothstep(40, 60, canvas.z))


def _paint_unevenness(canvas: Canvas) -> None:
    broad, fine = noise(canvas.vertices, 9.0, 1), noise(canvas.vertices, 3.6, 2)
    canvas.scale(1 + 0.014 * broad + 0.011 * fine)
    ruddy = 0.008 * noise(canvas.vertices, 13.0, 4)
    canvas.colors[:, 0] *= 1 + ruddy
    canvas.colors[:, 1] *= 1 - ruddy


def _paint_shade(canvas: Canvas) -> None:
    """Darken hollows and lighten ridges, at the scale of a crease and of a feature."""
    moved = canvas.vertices
    for passes, strength in ((1, 0.55), (12, 0.05)):
        for _ in range(passes):
            moved = 0.5 * moved + 0.5 * (canvas._around @ moved)
        hollow = 2.0 * ((moved - canvas.vertices) * canvas.normals).sum(axis=1)
        hollow = canvas.blurred(hollow, 2)
        canvas.scale(np.clip(1 - strength * np.clip(hollow, -0.25, 2.0), 0.62, 1.1))
