"""A process that bakes the textures of one rig: it reads a pickled rig and writes pickled files."""

from __future__ import annotations

import pickle

from engine import bake_textures

from .apart import orders_and_answers
from .priority import stand_back


def main() -> None:
    """Bake and end."""
    stand_back()
    orders, answers = orders_and_answers()
    pickle.dump(bake_textures(pickle.load(orders)), answers)
    answers.flush()


if __name__ == "__main__":
    main()
