"""What ships of the head beside its authored points: the skin's islands, laid flat.

`python -m engine.head.shipping` flattens them anew, after a change of the cage or of the islands.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .layout import layout_file, layout_key
from .standard import sculpt
from .uv import Pieces, flattened_islands


def write_layout(pieces: Pieces, path: Path) -> None:
    """Flatten the islands of the skin and write them to `path`, at single precision."""
    flat = flattened_islands(pieces).astype(np.float32)
    np.savez_compressed(path, key=np.array(layout_key(pieces)), flat=flat)


if __name__ == "__main__":
    made = sculpt()
    write_layout(Pieces.of(made.cage, made.limit, made.points), layout_file())
