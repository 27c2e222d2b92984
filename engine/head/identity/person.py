"""A person's head: the built-in head, warped, its fields kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ...cache import Arrays
from ..geometry import vertex_normals
from ..head import DrawnSurface, Eye, Head, LidContact, Part
from ..recipe import Recipe
from .ageing import depth_of_life
from .asymmetry import asymmetry_at
from .shape import Warp, warp_of

_MIRROR = np.array([-1.0, 1.0, 1.0])
IN_THE_MOUTH = ("teeth", "gum", "tongue", "palate", "mouth")
"""Parts whose names begin so move with the jaws as a whole."""
WITH_THE_EYE = ("eye", "cornea")
"""Parts that move with the eyeball as a whole."""


def person_from(reference: Head, recipe: Recipe) -> Head:
    """Return the head of a person.

    All that is a field over the skin (hold, jaw, map, colours, maps) stays as it is on the
    built-in head; positions are warped and normals made anew. The tissue is symmetric; what is
    drawn is not quite.

    Args:
        reference: The built-in head, with the parts and the colours that the recipe asks for.
        recipe: The person.
    """
    warp = warp_of(recipe, reference)
    shift = warp.eye_shift
    eyes = tuple(
        Eye(eye.center + shift * (_MIRROR if eye.center[0] < 0 else 1.0), eye.radius)
        for eye in reference.eyes
    )
    return replace(
        reference,
        points=warp(reference.points),
        depth=depth_of_life(recipe, reference.depth),
        drawn=_drawn(reference.drawn, warp, recipe, eyes),
        parts=tuple(_part(part, warp, recipe) for part in reference.parts),
        eyes=eyes,
        teeth=reference.teeth + warp.teeth_shift(),
    )


def moved_arrays(person: Head) -> Arrays:
    """Return what sets a person's head apart from the built-in one, to be kept."""
    arrays: Arrays = {
        "points": person.points,
        "depth": person.depth,
        "teeth": person.teeth,
        "vertices": person.drawn.vertices,
        "normals": person.drawn.normals,
        "colors": person.drawn.colors,
        "hair": person.drawn.hair,
        "clearance": person.drawn.lids.clearance,
        "eyes": np.array([eye.center for eye in person.eyes]),
    }
    for index, part in enumerate(person.parts):
        arrays[f"part{index}.vertices"] = part.vertices
        arrays[f"part{index}.normals"] = part.normals
    return arrays


def with_moved(reference: Head, arrays: Arrays) -> Head:
    """Return the person whose `moved_arrays` were kept."""
    drawn = reference.drawn
    return replace(
        reference,
        points=arrays["points"],
        depth=arrays["depth"],
        teeth=arrays["teeth"],
        drawn=replace(
            drawn,
            vertices=arrays["vertices"],
            normals=arrays["normals"],
            colors=arrays["colors"],
            hair=arrays["hair"],
            lids=replace(drawn.lids, clearance=arrays["clearance"]),
        ),
        parts=tuple(
            replace(
                part,
                vertices=arrays[f"part{index}.vertices"],
                normals=arrays[f"part{index}.normals"],
            )
            for index, part in enumerate(reference.parts)
        ),
        eyes=tuple(
            replace(eye, center=center)
            for eye, center in zip(reference.eyes, arrays["eyes"], strict=True)
        ),
    )


def _seen(points: FloatArray, warp: Warp, recipe: Recipe) -> FloatArray:
    """Return where points of the built-in head are drawn: warped, and their sides not quite alike.

    The difference is that of the place on the built-in head, so that levels and parts agree.
    """
    return np.asarray(warp(points) + asymmetry_at(recipe, points, warp.anchors))


def _drawn(drawn: DrawnSurface, warp: Warp, recipe: Recipe, eyes: tuple[Eye, ...]) -> DrawnSurface:
    vertices = _seen(drawn.vertices, warp, recipe)
    lids = drawn.lids
    bare = replace(lids, clearance=np.zeros(len(lids.vertices)))
    offsets = vertices[lids.vertices] - np.array([eye.center for eye in eyes])[lids.eyes]
    radius = np.array([eye.radius for eye in eyes])[lids.eyes]
    height = np.linalg.norm(offsets, axis=1) - bare.least_radius(offsets, radius)
    # Nothing may move at rest, so no vertex is asked for more height than it has.
    clearance = np.minimum(lids.clearance, height - 1e-9)
    return replace(
        drawn,
        vertices=vertices,
        normals=_normals(drawn, vertices),
        lids=LidContact(lids.vertices, lids.eyes, clearance),
    )


def _normals(drawn: DrawnSurface, vertices: FloatArray) -> FloatArray:
    """Return normals over the welded skin, so that no seam of the texture shows."""
    seams = drawn.seams
    if seams is None:
        return vertex_normals(vertices, drawn.triangles)
    return np.asarray(vertex_normals(vertices, seams[drawn.triangles])[seams])


def _part(part: Part, warp: Warp, recipe: Recipe) -> Part:
    if part.name.partition(".")[0] in WITH_THE_EYE:
        return replace(part, vertices=_with_the_eye(part.vertices, warp))
    if part.name.startswith(IN_THE_MOUTH):
        return replace(part, vertices=part.vertices + warp.teeth_shift())
    vertices = _seen(part.vertices, warp, recipe)
    if part.material == "hair":  # lit as the head under it, which a warp hardly turns
        return replace(part, vertices=vertices)
    return replace(part, vertices=vertices, normals=vertex_normals(vertices, part.triangles))


def _with_the_eye(vertices: FloatArray, warp: Warp) -> FloatArray:
    shift = warp.eye_shift
    return np.asarray(vertices + np.where(vertices[:, :1] < 0, shift * _MIRROR, shift))
