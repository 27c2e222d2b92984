"""A process that settles expressions, one after another, and writes them as GLB files."""

from __future__ import annotations

from engine import face_to_glb

from .expression_orders import FaceOrder
from .workbench import work


def face_file(order: FaceOrder) -> bytes:
    """Return the GLB file of a settled expression.

    Raises:
        EngineError, Refused: If it cannot be had.
    """
    rig = order.face.rig().at_level(order.level)
    return face_to_glb(rig, order.face.frame(), textures=order.textures)


def main() -> None:
    """Carry out orders until there are no more."""
    work(face_file)


if __name__ == "__main__":
    main()
