"""glTF output: surface, rig, face and clip files; the only package that knows the format."""

from .surface import surface_to_glb

__all__ = ["surface_to_glb"]
