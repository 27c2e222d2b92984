"""Heads from files: any surface that trimesh reads becomes a sheet of tissue, drawn as it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.sparse as sp

from ..arrays import BoolArray, FloatArray, IntArray
from ..cache import cached_arrays
from ..errors import InvalidHead
from .geometry import linear_rgb, triangle_areas, vertex_normals
from .head import DrawnSurface, Head, LidContact
from .storage import head_from_arrays, head_to_arrays, source_key
from .topology import Topology, boundary_loops, components

MOST_VERTICES = 20_000
"""More than this cannot be simulated in real time."""
LEAST_TRIANGLES = 50
HEAD_SIZE = (60.0, 600.0)
"""Largest extent that a face or head may have, mm."""
UNITS = {"millimetres": 1.0, "metres": 1000.0, "centimetres": 10.0}

DEPTH = 8.0
ANCHOR_WEIGHT = 0.5
BACK_SHARE = 1 / 3
"""Rear part of a closed mesh that is held to the skull."""
MIRROR_TOLERANCE = 1.0
"""Farthest that a point may lie from its partner's mirror image, mm."""
SKIN_COLOR = (0.80, 0.57, 0.455)


def read_head(path: str | Path) -> Head:
    """Return the head in a mesh file (OBJ, PLY, STL, GLB, … whatever trimesh reads).

    The face must look along +z with +y up. Sizes that make a head in metres or centimetres are
    turned into millimetres. Only the largest connected piece is used.

    Raises:
        InvalidHead: The file cannot be read or its mesh cannot carry tissue.
    """
    file = Path(path)
    try:
        content = file.read_bytes()
    except OSError as error:
        raise InvalidHead(f"cannot read {file}: {error.strerror or error}") from error

    def build() -> Head:
        vertices, triangles = _loaded(file)
        return head_from_mesh(vertices, triangles, name=file.stem)

    key = source_key(file.name, content)
    return head_from_arrays(cached_arrays("head", key, lambda: head_to_arrays(build())))


def head_from_mesh(vertices: FloatArray, triangles: IntArray, *, name: str) -> Head:
    """Return a bare head: the mesh itself as tissue, without followers, eyes or parts.

    An open mesh is held along its longest boundary; other holes (eyes, mouth) stay free. A closed
    one is held at the rear third.

    Args:
        vertices: Positions, the face towards +z, shape (v, 3); see `read_head` for units.
        triangles: Vertex indices, shape (t, 3).
        name: Name of the head.

    Raises:
        InvalidHead: The mesh cannot carry tissue; the message says why.
    """
    points, faces = _checked(np.asarray(vertices, dtype=float), np.asarray(triangles))
    topology = Topology.of(faces, len(points))
    faces = _facing_outwards(points, faces, topology)
    count = len(points)
    normals = vertex_normals(points, faces)
    drawn = DrawnSurface(
        vertices=points,
        normals=normals,
        triangles=faces,
        colors=np.tile(linear_rgb(SKIN_COLOR), (count, 1)),
        hair=np.zeros(count),
        regions=np.zeros(count, dtype=np.int64),
        region_names=("face",),
        map=sp.csr_array(sp.eye_array(count)),
        lids=LidContact(np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0)),
    )
    return Head(
        name=name,
        points=points,
        names=("",) * count,
        sheet_count=count,
        polygons=np.column_stack([faces, np.full(len(faces), -1)]),
        polygon_regions=("face",) * len(faces),
        triangles=faces,
        mirror=_mirror(points),
        fixed=_held(points, topology),
        jaw_weight=np.zeros(count),
        depth=np.full(count, DEPTH),
        anchor_weight=np.full(count, ANCHOR_WEIGHT),
        follow=sp.csr_array((0, count)),
        follow_jaw=np.zeros(0),
        drawn=drawn,
        parts=(),
        eyes=(),
        landmarks={},
    )


def _loaded(file: Path) -> tuple[FloatArray, IntArray]:
    import trimesh  # half a second that only heads from files need

    try:
        scene = trimesh.load_scene(file)
        mesh = scene.to_mesh()
    except Exception as error:  # trimesh's readers raise whatever their formats make them raise
        raise InvalidHead(f"cannot read {file.name} as a mesh: {error}") from error
    if not isinstance(mesh, trimesh.Trimesh) or not len(mesh.faces):
        raise InvalidHead(f"{file.name} has no triangles; a head must be a surface mesh")
    # Texture seams and hard edges double vertices that are one point of skin.
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    return np.array(mesh.vertices, dtype=float), np.array(mesh.faces, dtype=np.int64)


def _checked(vertices: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the mesh's largest piece in millimetres, or raise InvalidHead."""
    if vertices.ndim != 2 or vertices.shape[1:] != (3,) or not len(vertices):
        raise InvalidHead(f"vertices have shape {vertices.shape}; expected (v, 3) with v > 0")
    if triangles.ndim != 2 or triangles.shape[1:] != (3,) or not len(triangles):
        raise InvalidHead("the mesh has no triangles; a head must be a surface, not a point cloud")
    if not np.isfinite(vertices).all():
        bad = int((~np.isfinite(vertices)).any(axis=1).sum())
        raise InvalidHead(f"{bad} vertices are not finite numbers")
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise InvalidHead(f"triangles name vertices outside 0..{len(vertices) - 1}")
    points = vertices * _scale_to_millimetres(vertices[np.unique(triangles)])
    points, faces = _largest_piece(points, triangles.astype(np.int64))
    if len(faces) < LEAST_TRIANGLES:
        raise InvalidHead(f"the mesh has {len(faces)} triangles; at least {LEAST_TRIANGLES} needed")
    if len(points) > MOST_VERTICES:
        raise InvalidHead(
            f"the mesh has {len(points)} vertices; simplify it to {MOST_VERTICES} or fewer"
        )
    _check_manifold(faces, len(points))
    return points, faces


def _scale_to_millimetres(vertices: FloatArray) -> float:
    extent = float(np.ptp(vertices, axis=0).max())
    for factor in UNITS.values():
        if HEAD_SIZE[0] <= extent * factor <= HEAD_SIZE[1]:
            return factor
    raise InvalidHead(
        f"the mesh is {extent:g} units large; a face is {HEAD_SIZE[0]:g} to {HEAD_SIZE[1]:g} mm "
        f"(centimetres and metres are understood too)"
    )


def _largest_piece(points: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the connected piece with the largest area, without degenerate triangles."""
    faces = faces[triangle_areas(points, faces) > 1e-9]
    if not len(faces):
        raise InvalidHead("every triangle of the mesh is degenerate (no area)")
    piece = components(Topology.of(faces, len(points)))[faces[:, 0]]
    largest = np.bincount(piece, triangle_areas(points, faces)).argmax()
    used, renumbered = np.unique(faces[piece == largest], return_inverse=True)
    return points[used], renumbered.reshape(-1, 3)


def _check_manifold(faces: IntArray, count: int) -> None:
    topology = Topology.of(faces, count)
    crowded = int((topology.face_count_of_edge > 2).sum())
    if crowded:
        raise InvalidHead(f"the mesh is not manifold: {crowded} edges have more than two triangles")
    boundary_degree = np.bincount(topology.edges[topology.boundary_edges].ravel(), minlength=count)
    pinched = int((boundary_degree > 2).sum())
    if pinched:
        raise InvalidHead(f"the mesh is not manifold: {pinched} vertices join two boundaries")


def _facing_outwards(points: FloatArray, faces: IntArray, topology: Topology) -> IntArray:
    """Return the faces wound alike and outwards, or raise InvalidHead for a one-sided surface."""
    faces = wound_alike(faces, topology)
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    area = np.cross(b - a, c - a)
    if topology.boundary_edges.any():
        outward = area[:, 2].sum()
    else:
        outward = np.einsum("ti,ti->", a - points.mean(axis=0), area)
    return faces if outward >= 0 else faces[:, ::-1].copy()


def wound_alike(faces: IntArray, topology: Topology) -> IntArray:
    """Return connected triangles (t, 3) turned so that neighbours run their edge in opposite ways.

    Raises:
        InvalidHead: The surface is one-sided, so that no such winding exists.
    """
    edges = topology.face_edges[:, :3].ravel()
    forward = (faces < np.roll(faces, -1, axis=1)).ravel()
    by_edge = np.argsort(edges, kind="stable")
    shared = topology.face_count_of_edge[edges[by_edge]] == 2
    first, second = by_edge[shared].reshape(-1, 2).T
    disagree = forward[first] == forward[second]
    flip = _flips(first // 3, second // 3, disagree, len(faces))
    if (disagree != (flip[first // 3] ^ flip[second // 3])).any():
        raise InvalidHead("the mesh is one-sided: its triangles cannot all face outwards")
    return np.where(flip[:, None], faces[:, ::-1], faces)


def _flips(first: IntArray, second: IntArray, disagree: BoolArray, count: int) -> BoolArray:
    """Return which triangles to turn, walking from the first one over pairs of neighbours."""
    from scipy.sparse.csgraph import breadth_first_order  # Here: a start does without.

    # An entry of 2 tells "disagree" from 1, "agree"; 0 would be no neighbour at all.
    value = 1 + disagree.astype(float)
    graph = sp.csr_array((value, (first, second)), shape=(count, count))
    graph = sp.csr_array(graph.maximum(graph.T))
    order, previous = breadth_first_order(graph, 0, directed=False)
    flip = np.zeros(count, dtype=bool)
    turned = np.zeros(count, dtype=bool)
    turned[order[1:]] = np.asarray(graph[order[1:], previous[order[1:]]]).ravel() > 1
    for triangle in order[1:]:
        flip[triangle] = flip[previous[triangle]] ^ turned[triangle]
    return flip


def _held(points: FloatArray, topology: Topology) -> BoolArray:
    """Return which points are fixed to the skull, shape (v,)."""
    if not topology.boundary_edges.any():
        depth = points[:, 2]
        return np.asarray(depth < depth.min() + BACK_SHARE * np.ptp(depth))
    held = np.zeros(len(points), dtype=bool)
    held[boundary_loops(topology)[0]] = True
    return held


def _mirror(points: FloatArray) -> IntArray:
    """Return each point's mirror image in the plane x = middle, -1 where there is none."""
    from scipy.spatial import cKDTree  # Here: a start does without.

    middle = (points[:, 0].min() + points[:, 0].max()) / 2
    reflected = points * [-1.0, 1.0, 1.0] + [2 * middle, 0.0, 0.0]
    found = cKDTree(points).query(reflected)
    distance, nearest = np.asarray(found[0]), np.asarray(found[1])
    mutual = nearest[nearest] == np.arange(len(points))
    return np.where(mutual & (distance <= MIRROR_TOLERANCE), nearest, -1)
