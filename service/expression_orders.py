"""What is ordered of the processes that make expressions: a face, as a file or as a picture."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from engine import Frame, Keyframe, Rig, settled

from .deriving import Steps, made_from
from .stage import Look


@dataclass(frozen=True)
class Face:
    """An expression on a rig.

    Attributes:
        root: Named rig that its own comes from.
        steps: What was changed in it, step by step.
        keyframe: What is asked of it.
    """

    root: str
    steps: Steps
    keyframe: Keyframe

    def rig(self) -> Rig:
        """Return whose face it is, made once."""
        return _rig(self.root, json.dumps(list(self.steps)))

    def frame(self) -> Frame:
        """Return where the expression settles."""
        return settled(self.rig(), [self.keyframe], threads=1)[0]


@dataclass(frozen=True)
class FaceOrder:
    """A file of an expression.

    Attributes:
        face: Whose, and which.
        level: Of detail.
        textures: Maps of skin and eyes that it embeds, by file name; none for colours.
    """

    face: Face
    level: str
    textures: Mapping[str, bytes]


@dataclass(frozen=True)
class PictureOrder:
    """A picture of an expression: whose face and which, and how it is looked at."""

    face: Face
    look: Look


@lru_cache(maxsize=4)
def _rig(root: str, steps: str) -> Rig:
    return made_from(root, json.loads(steps))
