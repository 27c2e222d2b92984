"""What a head is: a tissue surface to simulate, a finer skin to draw, and the parts beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..arrays import BoolArray, FloatArray, IntArray
from ..errors import UnknownName

# The eyeball as the lids feel it: a sphere a hair wider than the drawn one, with the cornea
# standing out of its front.
LID_GAP = 0.05
"""Space between the eyeball and the sphere that lids may not enter, mm."""
BULGE_HEIGHT = 1.25
"""How far the cornea stands out of the ball at its middle, mm."""
BULGE_RADIUS = 6.6
"""Distance from the eye's axis at which the corneal bulge ends, mm."""
BULGE_POWER = 1.2
"""Exponent of the bulge's profile."""


@dataclass(frozen=True, eq=False)
class Part:
    """A piece drawn beside the skin, at rest in the head's frame.

    Attributes:
        name: "eye.L", "cornea.L", "caruncle.L", "teeth.upper", "brows", …
        vertices: Positions [mm], shape (v, 3).
        normals: Unit normals, shape (v, 3).
        triangles: Vertex indices, counter-clockwise from outside, shape (t, 3).
        colors: Linear RGB in 0..1, shape (v, 3).
        material: "skin", "eye", "cornea", "wet", "teeth" or "hair".
        follows: What it moves with: "skull", "jaw", "eye.L", "eye.R" or "skin".
        roots: Drawn vertex that each vertex rides, shape (v,); only when it follows the skin.
        hair: Cropped-hair mask in 0..1, shape (v,); only where a part is skin that hair grows on.
        uvs: Where each vertex lies on its material's texture, origin top left, shape (v, 2).
    """

    name: str
    vertices: FloatArray
    normals: FloatArray
    triangles: IntArray
    colors: FloatArray
    material: str
    follows: str
    roots: IntArray | None = None
    hair: FloatArray | None = None
    uvs: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class Eye:
    """An eyeball: `center` [mm], shape (3,), and `radius` [mm]."""

    center: FloatArray
    radius: float


@dataclass(frozen=True, eq=False)
class LidContact:
    """Drawn vertices that slide over an eyeball and its cornea.

    Attributes:
        vertices: Drawn vertex indices, shape (k,).
        eyes: 0 for the left eye, 1 for the right, shape (k,).
        clearance: Least height over ball and bulge [mm], shape (k,).
    """

    vertices: IntArray
    eyes: IntArray
    clearance: FloatArray

    def least_radius(self, offsets: FloatArray, radius: FloatArray) -> FloatArray:
        """Return how near each vertex may come to its eye's centre.

        Args:
            offsets: Vertex minus eye centre [mm], shape (k, 3).
            radius: Ball radius of each vertex's eye [mm], shape (k,).
        """
        return radius + LID_GAP + corneal_bulge(offsets) + self.clearance

    def project(self, vertices: FloatArray, eyes: Sequence[Eye]) -> FloatArray:
        """Return `vertices` with the lids pushed radially out of the eyes, shape (d, 3)."""
        if not len(self.vertices) or not eyes:
            return vertices
        centers = np.array([eye.center for eye in eyes])[self.eyes]
        radius = np.array([eye.radius for eye in eyes])[self.eyes]
        offsets = vertices[self.vertices] - centers
        distance = np.linalg.norm(offsets, axis=1)
        least = self.least_radius(offsets, radius)
        inside = (distance < least) & (offsets[:, 2] > 0)
        scale = least[inside] / distance[inside]
        pushed = vertices.copy()
        pushed[self.vertices[inside]] = centers[inside] + offsets[inside] * scale[:, None]
        return pushed


def corneal_bulge(offsets: FloatArray) -> FloatArray:
    """Return the height of the cornea over the ball at offsets (k, 3) from its centre, mm."""
    axis_distance = np.hypot(offsets[:, 0], offsets[:, 1])
    profile = np.maximum(0.0, 1.0 - (axis_distance / BULGE_RADIUS) ** 2) ** BULGE_POWER
    return np.where(offsets[:, 2] > 0, BULGE_HEIGHT * profile, 0.0)


@dataclass(frozen=True, eq=False)
class DrawnSurface:
    """The skin as it is drawn, finer than the tissue and moved by it.

    Attributes:
        vertices: Positions at rest [mm], shape (d, 3).
        normals: Unit normals at rest, shape (d, 3).
        triangles: Counter-clockwise from outside, shape (t, 3).
        colors: Linear RGB in 0..1, shape (d, 3).
        hair: Cropped-hair mask in 0..1, shape (d,).
        regions: Index into `region_names` of each vertex, shape (d,).
        region_names: The regions' names.
        map: Drawn displacement = map @ surface displacement, sparse (d, s).
        lids: The vertices that may not enter the eyes.
        uvs: Place of each vertex on the textures, origin top left, shape (d, 2); None for a head
            without textures.
        reference: The same skin on the built-in head [mm], shape (d, 3): where textures and other
            fields are looked up; None without textures.
        seams: First vertex at the same place, shape (d,): where islands of the texture meet,
            vertices are doubled and their normals are the same; None where none is doubled.
    """

    vertices: FloatArray
    normals: FloatArray
    triangles: IntArray
    colors: FloatArray
    hair: FloatArray
    regions: IntArray
    region_names: tuple[str, ...]
    map: sp.csr_array
    lids: LidContact
    uvs: FloatArray | None = None
    reference: FloatArray | None = None
    seams: IntArray | None = None

    def deform(self, displacements: FloatArray, eyes: Sequence[Eye]) -> FloatArray:
        """Return the drawn vertices [mm], shape (d, 3), of a displaced tissue surface.

        The viewer computes the same in TypeScript; this is the reference.

        Args:
            displacements: Of the tissue surface from rest [mm], shape (s, 3).
            eyes: The head's eyes, empty for none.
        """
        moved: FloatArray = self.vertices + self.map @ displacements
        return self.lids.project(moved, eyes)


@dataclass(frozen=True, eq=False)
class Head:
    """A head at rest: millimetres, +x its own left, +y up, +z out of the face.

    Attributes:
        name: "standard", "paper", or a file's stem.
        points: The tissue surface [mm], shape (s, 3): the `sheet_count` simulated points, then
            the followers.
        names: Name of each point ("M1_5.L", "M0_0" on the midline); empty strings for files.
        sheet_count: How many points are simulated, n.
        polygons: Faces of the sheet, shape (p, 4), counter-clockwise from outside; a triangle has
            -1 in the last column.
        polygon_regions: Name of each polygon's region, length p.
        triangles: Triangulation of sheet and followers, shape (t, 3).
        mirror: Each point's mirror image (itself on the midline, -1 for none), shape (s,).
        fixed: Sheet points held to the skull, shape (n,).
        jaw_weight: Share of the jaw's rotation, 0..1, shape (s,).
        depth: Skin-to-bone depth [mm], shape (n,).
        anchor_weight: Regional strength of the attachment to the skull, shape (n,).
        follow: Followers' displacement = follow @ sheet displacement + `follow_jaw` times the
            rigid jaw's displacement at that point, sparse (s - n, n).
        follow_jaw: Share of the rigid jaw's displacement, shape (s - n,).
        drawn: The skin to draw.
        parts: Eyes, teeth, hair …; empty for files.
        eyes: Left and right eyeball; empty for files.
        landmarks: Drawn vertex of each anthropometric landmark ("ch.L", "prn").
        teeth: How far the dental arches stand from those of the built-in head [mm], shape (3,).
    """

    name: str
    points: FloatArray
    names: tuple[str, ...]
    sheet_count: int
    polygons: IntArray
    polygon_regions: tuple[str, ...]
    triangles: IntArray
    mirror: IntArray
    fixed: BoolArray
    jaw_weight: FloatArray
    depth: FloatArray
    anchor_weight: FloatArray
    follow: sp.csr_array
    follow_jaw: FloatArray
    drawn: DrawnSurface
    parts: tuple[Part, ...]
    eyes: tuple[Eye, ...]
    landmarks: Mapping[str, int]
    teeth: FloatArray = field(default_factory=lambda: np.zeros(3))

    @cached_property
    def _index(self) -> dict[str, int]:
        return {name: index for index, name in enumerate(self.names) if name}

    @cached_property
    def landmark_places(self) -> Mapping[str, FloatArray]:
        """Where each landmark lies at rest, mm, shape (3,)."""
        return {name: self.drawn.vertices[index] for name, index in self.landmarks.items()}

    def point(self, name: str) -> int:
        """Return the index of the tissue point called `name`.

        Raises:
            UnknownName: No point has that name.
        """
        index = self._index.get(name)
        if index is None:
            raise UnknownName("point", name, self._index)
        return index
