"""The baking of all maps of a head, one after the other."""

from __future__ import annotations

import io
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from PIL import Image

from ...errors import Cancelled
from ..head import Head
from ..parts import eye_texture
from ..recipe import Recipe
from .albedo import albedo
from .occlusion import occlusion
from .pigment import srgb
from .relief import creases, normals, relief
from .roughness import roughness
from .texels import Texels
from .zones import Surface, zones_of

TEXTURE_NAMES = ("albedo.jpg", "normal.jpg", "orm.jpg", "wrinkles.jpg", "eye.jpg")
"""Files of a head's textures, as they are served."""
ALBEDO_SIZE, MAP_SIZE = 2048, 1024
ALBEDO_QUALITY, NORMAL_QUALITY, MAP_QUALITY = 90, 92, 88


def head_textures(
    head: Head, recipe: Recipe, *, cancelled: Callable[[], bool] | None = None
) -> dict[str, bytes]:
    """Return the files of a head's textures by name; none for a head without a map of its skin.

    Args:
        head: The person's head.
        recipe: The person.
        cancelled: Asked between the maps whether to stop.

    Raises:
        Cancelled: `cancelled` said so.
    """

    def check() -> None:
        if cancelled is not None and cancelled():
            raise Cancelled("the bake of textures was stopped")

    drawn = head.drawn
    if drawn.uvs is None or drawn.reference is None:
        return {}
    zones = zones_of(Surface.of(drawn), recipe)
    check()
    fine = Texels.of(drawn.uvs, drawn.triangles, drawn.vertices, ALBEDO_SIZE)
    colors = srgb_bytes(albedo(fine, zones, drawn.reference, recipe))
    check()
    texels = Texels.of(drawn.uvs, drawn.triangles, drawn.vertices, MAP_SIZE)
    rest, wrinkled = relief(texels, zones, drawn.reference, recipe)
    check()
    rough = roughness(texels, zones, drawn.reference, rest, recipe)
    packed = np.column_stack([texels.carried(occlusion(head)), rough, np.zeros(len(rough))])
    return {
        "albedo.jpg": jpeg(fine.image(colors), ALBEDO_QUALITY),
        "normal.jpg": jpeg(normals(texels, rest), NORMAL_QUALITY),
        "orm.jpg": jpeg(texels.image((packed * 255 + 0.5).astype(np.uint8)), MAP_QUALITY),
        "wrinkles.jpg": jpeg(creases(texels, wrinkled, rest), NORMAL_QUALITY),
        "eye.jpg": jpeg(eye_texture(recipe), MAP_QUALITY),
    }


def srgb_bytes(linear: npt.NDArray[np.float32]) -> npt.NDArray[np.uint8]:
    """Return linear light as sRGB of 8 bits."""
    return np.asarray(_SRGB[np.clip(linear * (len(_SRGB) - 1), 0, len(_SRGB) - 1).astype(np.int64)])


_SRGB = (srgb(np.linspace(0, 1, 2**14)) * 255 + 0.5).astype(np.uint8)


def jpeg(image: npt.NDArray[np.generic], quality: int) -> bytes:
    """Return an image of 8 bits, shape (h, w, 3), as JPEG."""
    file = io.BytesIO()
    Image.fromarray(image.astype(np.uint8)).save(file, "JPEG", quality=quality, subsampling=0)
    return file.getvalue()
