"""A process that compiles the kernels that move faces, and keeps them on disk."""

from __future__ import annotations

import gc

from engine import compile_motion


def main() -> None:
    """Compile and end."""
    gc.disable()  # What a compiler makes is used until it ends.
    compile_motion()


if __name__ == "__main__":
    main()
