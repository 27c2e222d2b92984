"""Risorius engine: a physically simulated face, driven by the Facial Action Coding System.

It implements "Animation of Facial Expressions by Physical Modeling" (Zhang, Prakash, Sung,
Eurographics 2001). A face is a rig; commands are keyframes; a simulator plays them.
"""

from .emotion import Emotion, blend
from .errors import (
    Diverged,
    EngineError,
    InvalidHead,
    InvalidNotation,
    InvalidTrack,
    InvalidValue,
    UnknownName,
)
from .facs import LETTERS, ActionUnit, Term, format_facs, parse_facs
from .frame import Frame, Pose
from .jaw import JawHinge
from .rig import BUILTIN_RIGS, MODEL_CHOICES, Model, Rig, builtin_rig
from .simulator import FaceState, Simulator
from .timeline import LAYERS, TICKS_PER_SECOND, Keyframe, Timeline

__all__ = [
    "BUILTIN_RIGS",
    "LAYERS",
    "LETTERS",
    "MODEL_CHOICES",
    "TICKS_PER_SECOND",
    "ActionUnit",
    "Diverged",
    "Emotion",
    "EngineError",
    "FaceState",
    "Frame",
    "InvalidHead",
    "InvalidNotation",
    "InvalidTrack",
    "InvalidValue",
    "JawHinge",
    "Keyframe",
    "Model",
    "Pose",
    "Rig",
    "Simulator",
    "Term",
    "Timeline",
    "UnknownName",
    "blend",
    "builtin_rig",
    "format_facs",
    "parse_facs",
]
