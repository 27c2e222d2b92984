"""How each material of a head looks, in glTF's metallic-roughness terms."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..head.head import Part
from ..head.parts.strand_texture import hair_texture


@dataclass(frozen=True)
class Maps:
    """Files of a head's textures that a material shows, where a GLB file embeds them.

    Attributes:
        color: Its colours, sRGB; they replace those of the vertices.
        normal: Normals in tangent space, green up.
        packed: Occlusion in red, roughness in green.
    """

    color: str
    normal: str | None = None
    packed: str | None = None


@dataclass(frozen=True)
class Look:
    """One material; vertex colours multiply `color`.

    Attributes:
        color: Linear red, green, blue and opacity, 0 to 1.
        roughness: 0 is a mirror, 1 is chalk.
        double_sided: Draw the back too; for ribbons, which have no inside.
        picture: Makes the PNG that multiplies the colour, where it is part of the shape.
        cutoff: Nothing is drawn where the picture is clearer than this.
        maps: Files of the head's textures that it shows.
    """

    color: tuple[float, float, float, float]
    roughness: float
    double_sided: bool = False
    picture: Callable[[], bytes] | None = None
    cutoff: float | None = None
    maps: Maps | None = None


MATERIALS = {
    "skin": Look(
        color=(1.0, 1.0, 1.0, 1.0),
        roughness=0.55,
        maps=Maps("albedo.jpg", normal="normal.jpg", packed="orm.jpg"),
    ),
    "eye": Look(color=(1.0, 1.0, 1.0, 1.0), roughness=0.25, maps=Maps("eye.jpg")),
    # Nearly clear: what is seen of a cornea is its highlight.
    "cornea": Look(color=(1.0, 1.0, 1.0, 0.08), roughness=0.03),
    "wet": Look(color=(1.0, 1.0, 1.0, 1.0), roughness=0.3),
    "teeth": Look(color=(1.0, 1.0, 1.0, 1.0), roughness=0.25),
    "hair": Look(color=(1.0, 1.0, 1.0, 1.0), roughness=0.7, double_sided=True),
    "hair_cards": Look(
        color=(1.0, 1.0, 1.0, 1.0),
        roughness=0.6,
        double_sided=True,
        picture=hair_texture,
        cutoff=0.3,
    ),
}


def look_name(part: Part) -> str:
    """Return which of `MATERIALS` a part is drawn with: hair with texture places is cards."""
    return "hair_cards" if part.material == "hair" and part.uvs is not None else part.material
