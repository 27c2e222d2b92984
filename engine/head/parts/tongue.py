"""The tongue: a flattened ellipsoid with a groove along its middle."""

from __future__ import annotations

import numpy as np

from ..anatomy import smoothstep
from ..geometry import unit_sphere, vertex_normals
from ..head import Part
from .teeth import mouth_shade

CENTER = np.array([0.0, -80.0, 57.0])
RADII = np.array([18.5, 6.5, 30.0])
GROOVE_DEPTH = 1.8
GROOVE_WIDTH = 2.6
TIP = np.array([0.60, 0.23, 0.21])
BACK = np.array([0.55, 0.25, 0.22])


def tongue_part() -> Part:
    """Return the tongue, which lies on the lower jaw."""
    sphere, triangles = unit_sphere(28, 36)
    vertices = sphere * RADII
    top = smoothstep(-0.2, 0.7, sphere[:, 1])
    vertices[:, 1] -= GROOVE_DEPTH * top * np.exp(-((vertices[:, 0] / GROOVE_WIDTH) ** 2))
    vertices[:, 1] -= 2.5 * np.maximum(0, sphere[:, 2]) ** 3  # the tip dips behind the teeth
    vertices += CENTER
    coat = smoothstep(0.9, -0.2, sphere[:, 2])[:, None] * top[:, None]
    speckle = np.random.default_rng(5).normal(0, 0.035, len(vertices))[:, None]
    colors = (TIP * (1 - coat) + BACK * coat) * (1 + speckle) * mouth_shade(vertices)
    return Part(
        name="tongue",
        vertices=vertices,
        normals=vertex_normals(vertices, triangles),
        triangles=triangles,
        colors=np.clip(colors, 0, 1),
        material="wet",
        follows="jaw",
    )
