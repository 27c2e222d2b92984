"""The drawn skin: a level of the limit surface, carried by the tissue and kept off the eyes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ..arrays import FloatArray, IntArray
from .cage import Cage
from .geometry import vertex_normals
from .graded import drawn_fine, graded_triangles
from .head import DrawnSurface, Eye, LidContact
from .subdivision import Limit
from .surface_map import surface_map
from .tissue_surface import symmetric_triangles
from .uv import CHARTS, Unwrap

LEVELS = {"low": 0, "medium": 1, "high": 2}
"""Refinements of the cage where the face lives; scalp, neck, throat and ear bowl have one fewer."""

# Height that the drawn lids keep over ball and cornea, mm; the first that names a vertex counts.
LID_CLEARANCE = {"lid_margin": 0.22, "eyelid": 0.5, "orbital": 0.6, "lid_inner": 0.12}


@dataclass(frozen=True, eq=False)
class SkinMesh:
    """A level of detail of the skin before it is coloured.

    Attributes:
        level: Level of the vertices.
        indices: Vertex of that level (and of all finer ones) for each drawn vertex, shape (d,).
        vertices: Positions [mm], shape (d, 3).
        triangles: Shape (t, 3).
        cage_faces: Cage face that each triangle belongs to, shape (t,).
        uvs: Place of each vertex on the textures, shape (d, 2), once it has one.
        seams: First vertex at the same place, shape (d,), once there are doubles; the doubles come
            last.
    """

    level: int
    indices: IntArray
    vertices: FloatArray
    triangles: IntArray
    cage_faces: IntArray
    uvs: FloatArray | None = None
    seams: IntArray | None = None


def skin_mesh(cage: Cage, limit: Limit, points: FloatArray, level: int) -> SkinMesh:
    """Return the skin at a level of detail.

    Args:
        cage: The cage.
        limit: Its limit surface.
        points: The cage's points [mm], shape (v, 3).
        level: 0, 1 or 2.
    """
    vertices = limit.positions(points, level)
    if level == 0:
        triangles = symmetric_triangles(cage.faces, points, cage.mirror)
        left = np.repeat(np.arange(len(cage.faces)), (cage.faces >= 0).sum(axis=1) - 2)
        return SkinMesh(0, np.arange(len(points)), vertices, triangles, left)
    triangles, faces = graded_triangles(
        limit.levels[level - 1], limit.levels[level], vertices, drawn_fine(cage)
    )
    used, renumbered = np.unique(triangles, return_inverse=True)
    return SkinMesh(level, used, vertices[used], renumbered.reshape(-1, 3), faces)


def textured(mesh: SkinMesh, unwrap: Unwrap) -> SkinMesh:
    """Return the skin laid out on the textures, its vertices doubled where islands meet."""
    charts = unwrap.charts(mesh.indices[mesh.triangles], mesh.cage_faces)
    count = len(mesh.indices)
    keys, corners = np.unique(mesh.triangles * CHARTS + charts, return_inverse=True)
    vertex, chart = keys // CHARTS, keys % CHARTS
    doubled = np.r_[False, vertex[1:] == vertex[:-1]]
    place = vertex.copy()
    place[doubled] = count + np.arange(doubled.sum())
    seams = np.r_[np.arange(count), vertex[doubled]]
    indices = mesh.indices[seams]
    uvs = np.zeros((len(seams), 2))
    uvs[place] = unwrap.at(indices[place], chart)
    return replace(
        mesh,
        indices=indices,
        vertices=mesh.vertices[seams],
        triangles=place[corners].reshape(-1, 3),
        uvs=uvs,
        seams=seams,
    )


def drawn_surface(
    cage: Cage,
    limit: Limit,
    mesh: SkinMesh,
    reference: FloatArray,
    surface_points: IntArray,
    eyes: Sequence[Eye],
) -> DrawnSurface:
    """Return the skin to draw, not yet painted.

    Args:
        cage: The cage.
        limit: Its limit surface.
        mesh: The level of detail.
        reference: Positions of the finest level [mm].
        surface_points: Cage index of each tissue point, shape (s,).
        eyes: The eyes to stay clear of.
    """
    first = len(mesh.indices)
    if mesh.seams is not None:
        first = int((mesh.seams == np.arange(first)).sum())
    carried = surface_map(limit, mesh.level, mesh.indices[:first], surface_points)
    if mesh.seams is not None:
        carried = sp.csr_array(carried[mesh.seams])
    return _finished(cage, mesh, reference, carried, eyes)


def tissue_as_drawn(cage: Cage, mesh: SkinMesh, eyes: Sequence[Eye]) -> DrawnSurface:
    """Return a tissue surface drawn as it is, its vertices moved one to one, not yet painted."""
    identity = sp.csr_array(sp.eye_array(len(mesh.vertices)))
    return _finished(cage, mesh, mesh.vertices, identity, eyes)


def _finished(
    cage: Cage, mesh: SkinMesh, reference: FloatArray, carried: sp.csr_array, eyes: Sequence[Eye]
) -> DrawnSurface:
    names = tuple(sorted(set(cage.regions)))
    regions = vertex_regions(cage, mesh, names)
    return DrawnSurface(
        vertices=mesh.vertices,
        normals=vertex_normals(mesh.vertices, mesh.triangles, mesh.seams),
        triangles=mesh.triangles,
        colors=np.zeros_like(mesh.vertices),
        hair=np.zeros(len(mesh.vertices)),
        regions=regions,
        region_names=names,
        map=carried,
        lids=_lid_contact(cage, mesh, eyes),
        uvs=mesh.uvs,
        reference=None if mesh.uvs is None else reference[mesh.indices],
        seams=mesh.seams,
    )


def vertex_regions(cage: Cage, mesh: SkinMesh, names: Sequence[str]) -> IntArray:
    """Return the region that most triangles around each vertex belong to, shape (d,)."""
    number = {name: index for index, name in enumerate(names)}
    region = np.array([number[name] for name in cage.regions])[mesh.cage_faces]
    shape = (len(mesh.vertices), len(names))
    votes = np.zeros(shape)
    seams = np.arange(len(votes)) if mesh.seams is None else mesh.seams
    np.add.at(votes, (seams[mesh.triangles], region[:, None]), 1.0)
    return np.asarray(votes.argmax(axis=1)[seams])


def _lid_contact(cage: Cage, mesh: SkinMesh, eyes: Sequence[Eye]) -> LidContact:
    """Return the contact of the lids with the eyes, at ease at rest."""
    clearance = np.zeros(len(mesh.vertices))
    regions = np.array(cage.regions)[mesh.cage_faces]
    for kind, height in LID_CLEARANCE.items():
        named = np.char.endswith(regions, f"_{kind}")
        chosen = np.unique(mesh.triangles[named])
        clearance[chosen[clearance[chosen] == 0]] = height
    vertices = np.flatnonzero(clearance)
    side = (mesh.vertices[vertices, 0] < 0).astype(np.int64)
    offsets = mesh.vertices[vertices] - np.array([eye.center for eye in eyes])[side]
    in_front = offsets[:, 2] > 0
    vertices, side, offsets = vertices[in_front], side[in_front], offsets[in_front]

    radius = np.array([eye.radius for eye in eyes])[side]
    bare = LidContact(vertices, side, np.zeros(len(side)))
    height = np.linalg.norm(offsets, axis=1) - bare.least_radius(offsets, radius)
    # Nothing may move at rest, so no vertex is asked for more height than it has.
    return LidContact(vertices, side, np.minimum(clearance[vertices], height - 1e-9))
