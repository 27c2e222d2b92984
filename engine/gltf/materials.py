"""How each material of a head looks, in glTF's metallic-roughness terms."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Look:
    """One material; vertex colours multiply `color`.

    Attributes:
        color: Linear red, green, blue and opacity, 0 to 1.
        roughness: 0 is a mirror, 1 is chalk.
        double_sided: Draw the back too; for ribbons, which have no inside.
    """

    color: tuple[float, float, float, float]
    roughness: float
    double_sided: bool = False


MATERIALS = {
    "skin": Look(color=(1.0, 1.0, 1.0, 1.0), roughness=0.55),
    "eye": Look(color=(1.0, 1.0, 1.0, 1.0), roughness=0.25),
    # Nearly clear: what is seen of a cornea is its highlight.
    "cornea": Look(color=(1.0, 1.0, 1.0, 0.08), roughness=0.03),
    "wet": Look(color=(1.0, 1.0, 1.0, 1.0), roughness=0.3),
    "teeth": Look(color=(1.0, 1.0, 1.0, 1.0), roughness=0.25),
    "hair": Look(color=(1.0, 1.0, 1.0, 1.0), roughness=0.7, double_sided=True),
}
