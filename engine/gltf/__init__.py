"""glTF output: surface, rig, face and clip files; the only package that knows the format."""

from .clip import FORMS, ClipFile, clip_file, clip_to_glb
from .face import face_to_glb
from .played import performance_of
from .rig import arkit_to_glb, rig_to_glb, targets_to_glb
from .surface import surface_to_glb
from .tissue import tissue_to_glb

__all__ = [
    "FORMS",
    "ClipFile",
    "arkit_to_glb",
    "clip_file",
    "clip_to_glb",
    "face_to_glb",
    "performance_of",
    "rig_to_glb",
    "surface_to_glb",
    "targets_to_glb",
    "tissue_to_glb",
]
