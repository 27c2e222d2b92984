"""A GLB file under construction: accessors, meshes, nodes, animation; the only pygltflib user.

Layout rules are those of the glTF 2.0 specification, sections 3.6 (buffers and accessors), 3.7
(meshes, morph targets) and 3.11 (animation).
"""

from __future__ import annotations

import hashlib
import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from ..arrays import IntArray
from .materials import MATERIALS, Look, Maps
from .packing import EXTENSION, WEIGHT_STEPS, Grid, Packing, packed, packed_turns
from .tangents import tangents_of

if TYPE_CHECKING:
    import pygltflib
else:

    class _Later:
        """The library from when it is first used: a start does without."""

        def __getattr__(self, name):
            return getattr(importlib.import_module("pygltflib"), name)

    pygltflib = _Later()

Array = npt.NDArray[Any]
Extras = Mapping[str, Any]
Textures = Mapping[str, bytes]

_COMPONENTS = {
    "int8": "BYTE",
    "int16": "SHORT",
    "float32": "FLOAT",
    "uint32": "UNSIGNED_INT",
    "uint16": "UNSIGNED_SHORT",
    "uint8": "UNSIGNED_BYTE",
}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_PNG = b"\x89PNG"
_SPARSE_GAIN = 0.9
"""A sparse accessor must be at least this much smaller, for it costs the reader a pass."""


def metres(millimetres: Array) -> npt.NDArray[np.float32]:
    """Return lengths in metres, single precision, as glTF wants them."""
    return np.asarray(np.asarray(millimetres, dtype=np.float64) * 1e-3, dtype=np.float32)


def compact_indices(indices: Array) -> Array:
    """Return `indices` in the smallest type that every reader takes: uint16, else uint32."""
    # 65535 itself is the primitive restart value and may not be used.
    small = indices.size == 0 or int(indices.max()) < 65535
    return np.asarray(indices, dtype=np.uint16 if small else np.uint32)


@dataclass(frozen=True)
class Channel:
    """One animated property: `values` per key of `node`'s `path` ("rotation", "weights", …)."""

    node: int
    path: str
    values: Array


class GlbBuilder:
    """Collects the objects of one GLB file; indices that it returns are glTF indices."""

    def __init__(
        self,
        extras: Extras,
        textures: Textures | None = None,
        packing: Packing | None = None,
    ) -> None:
        """Begin a file.

        Args:
            extras: What the file says of itself.
            textures: The head's maps by file name, to be embedded where a material shows them.
            packing: How its meshes are stored; numbers as they are, where None.
        """
        self.packing = packing or Packing()
        # pygltflib is annotated in part only, and wrongly where targets may be plain dicts.
        self._gltf: Any = pygltflib.GLTF2(
            asset=pygltflib.Asset(generator="Risorius", extras=dict(extras)),
            scene=0,
            scenes=[pygltflib.Scene(name="risorius")],
        )
        if self.packing.quantize:
            self._gltf.extensionsUsed = [EXTENSION]
            self._gltf.extensionsRequired = [EXTENSION]
        self._blob = bytearray()
        self._stored: dict[tuple[object, ...], int] = {}
        self._zeros: dict[int, int] = {}
        self._rows, self._values = _Pool(), _Pool()
        self._row_lists: dict[tuple[str, bytes], int] = {}
        self._materials: dict[tuple[str, bool, tuple[float, ...]], int] = {}
        self._textures = dict(textures or {})
        self._pictures: dict[str, int] = {}

    def tell(self, extras: Extras) -> None:
        """Have the file say more of itself.

        The library leaves out what is empty or None, but not what is in tuples.
        """
        self._gltf.asset.extras.update(extras)

    def view(self, data: Array) -> int:
        """Store bytes that are no vertices; return their buffer view."""
        return self._view(data, None)

    # Accessors

    def accessor(
        self,
        array: Array,
        *,
        target: int | None = None,
        bounds: bool = False,
        normalized: bool = False,
    ) -> int:
        """Store `array`, shape (n,) or (n, 2 to 4), and return its accessor; equal ones share it.

        Args:
            array: float32, or integers of 8, 16 or 32 bits.
            target: ARRAY_BUFFER or ELEMENT_ARRAY_BUFFER for vertex data, None for the rest.
            bounds: State the smallest and largest value per component.
            normalized: Whether integers stand for -1 to 1, or 0 to 1.
        """
        digest = hashlib.sha256(np.ascontiguousarray(array).tobytes()).digest()
        key = (digest, array.shape, array.dtype, target, bounds, normalized)
        if key not in self._stored:  # Both eyes have the same triangles.
            accessor = self._describe(array.shape, array.dtype)
            accessor.bufferView = self._view(array, target)
            accessor.normalized = normalized or None
            if bounds:
                _state_bounds(accessor, array)
            self._stored[key] = self._append(self._gltf.accessors, accessor)
        return self._stored[key]

    def moves(
        self, moves: Array, *, smallest: float, grid: Grid, within: IntArray | None = None
    ) -> int:
        """Store the displacements of a morph target [m], shape (n, 3), on the grid of its mesh.

        Those whose components all stay below `smallest` are taken as none. Targets that move
        vertices of the same rows only, those `within`, may share the list of them.
        """
        kept = np.where((np.abs(moves) >= smallest).any(axis=1, keepdims=True), moves, 0.0)
        return self._delta(grid.moves(kept.astype(np.float32)), bounds=True, within=within)

    def turns(self, turns: Array, *, smallest: float, within: IntArray | None = None) -> int:
        """Store the changes of normals of a morph target, shape (n, 3), those above `smallest`."""
        kept = np.where((np.abs(turns) >= smallest).any(axis=1, keepdims=True), turns, 0.0)
        if self.packing.quantize:
            return self._delta(packed_turns(kept), normalized=True, within=within)
        return self._delta(kept.astype(np.float32), within=within)

    def _delta(
        self,
        array: Array,
        *,
        bounds: bool = False,
        normalized: bool = False,
        within: IntArray | None = None,
    ) -> int:
        """Store a morph target attribute, shape (n, 3), sparse where that may be and is smaller."""
        rows = np.flatnonzero(array.any(axis=1))
        if rows.size == 0 and self.packing.sparse:
            return self._zero(len(array))
        each = int(array[0].nbytes)
        size = len(rows) * (compact_indices(rows).itemsize + each)
        if within is not None and len(within) * each < size:
            # A few zeros more, and a list of rows that others share.
            rows, size = within, len(within) * each
        if not self.packing.sparse or size > _SPARSE_GAIN * len(array) * _stride(array):
            return self.accessor(
                array, target=pygltflib.ARRAY_BUFFER, bounds=bounds, normalized=normalized
            )
        values = np.ascontiguousarray(array[rows])
        indices = compact_indices(rows)
        accessor = self._describe(array.shape, array.dtype)
        accessor.normalized = normalized or None
        accessor.sparse = pygltflib.Sparse(
            count=len(rows),
            indices=pygltflib.AccessorSparseIndices(
                bufferView=self._pooled(self._rows),
                byteOffset=self._row_list(indices) or None,
                componentType=getattr(pygltflib, _COMPONENTS[indices.dtype.name]),
            ),
            values=pygltflib.AccessorSparseValues(
                bufferView=self._pooled(self._values), byteOffset=self._values.add(values) or None
            ),
        )
        if bounds:
            kept = np.concatenate([values, np.zeros((1, 3), values.dtype)])
            _state_bounds(accessor, kept if len(rows) < len(array) else values)
        return self._append(self._gltf.accessors, accessor)

    def _row_list(self, indices: Array) -> int:
        """Store the rows of a sparse accessor, equal ones once; return where among all they are."""
        key = (indices.dtype.name, indices.tobytes())
        if key not in self._row_lists:
            self._row_lists[key] = self._rows.add(indices)
        return self._row_lists[key]

    def _pooled(self, pool: _Pool) -> int:
        """Return the buffer view of a pool, whose bytes come last."""
        if pool.view is None:
            pool.view = self._append(self._gltf.bufferViews, pygltflib.BufferView(buffer=0))
        return pool.view

    def _zero(self, count: int) -> int:
        """Return an accessor of `count` zero vectors, which takes no bytes (section 3.6.2.3)."""
        if count not in self._zeros:
            accessor = self._describe((count, 3), np.dtype(np.float32))
            _state_bounds(accessor, np.zeros((1, 3), np.float32))
            self._zeros[count] = self._append(self._gltf.accessors, accessor)
        return self._zeros[count]

    def _describe(self, shape: tuple[int, ...], dtype: np.dtype[Any]) -> pygltflib.Accessor:
        return pygltflib.Accessor(
            # No offset: pygltflib would write one for accessors without a buffer view too.
            byteOffset=None,
            componentType=getattr(pygltflib, _COMPONENTS[dtype.name]),
            count=shape[0],
            type=_TYPES[shape[1] if len(shape) > 1 else 1],
        )

    def _view(self, array: Array, target: int | None) -> int:
        stride = _stride(array) if target == pygltflib.ARRAY_BUFFER else array[0].nbytes
        padded = stride > array[0].nbytes
        if padded:
            # Vertex attributes begin at multiples of four bytes (section 3.6.2.4).
            wide = np.zeros((len(array), stride // array.itemsize), array.dtype)
            wide[:, : array[0].size] = array.reshape(len(array), -1)
            array = wide
        data = np.ascontiguousarray(array).tobytes()
        view = pygltflib.BufferView(
            buffer=0,
            byteOffset=len(self._blob),
            byteLength=len(data),
            byteStride=stride if padded else None,
            target=target,
        )
        self._blob += data + bytes(-len(data) % 4)
        return self._append(self._gltf.bufferViews, view)

    # Meshes

    def primitive(
        self,
        attributes: Mapping[str, Array],
        triangles: Array,
        *,
        material: str,
        targets: Sequence[Mapping[str, int]] = (),
        grid: Grid | None = None,
    ) -> pygltflib.Primitive:
        """Return triangles with vertex `attributes`, each shape (n,) or (n, 2 to 4).

        Where the file embeds the colours of the material, those of the vertices are left out:
        glTF would multiply the two. On a grid, attributes of our own are left out too, and places
        on textures that the file does not have.
        """
        maps = self._maps_of(material) if "TEXCOORD_0" in attributes else None
        if maps is not None:
            attributes = self._mapped(attributes, triangles, maps)
        tint: tuple[float, ...] = ()
        if grid is not None and grid.origin is not None:
            shown = maps is not None or MATERIALS[material].picture is not None
            left_out = ("_",) if shown else ("_", "TEXCOORD")
            attributes = {
                name: each for name, each in attributes.items() if not name.startswith(left_out)
            }
            if "COLOR_0" in attributes:
                # The material has the greatest, so that eight bits are enough for dark hair.
                tint = tuple(float(value) for value in attributes["COLOR_0"].max(axis=0))
                colors = attributes["COLOR_0"] / np.maximum(tint, 1e-6)
                attributes = {**attributes, "COLOR_0": colors}
        stored = {name: self._attribute(name, each, grid) for name, each in attributes.items()}
        indices = self.accessor(
            compact_indices(np.asarray(triangles).ravel()),
            target=pygltflib.ELEMENT_ARRAY_BUFFER,
        )
        return pygltflib.Primitive(
            attributes=pygltflib.Attributes(**stored),
            indices=indices,
            material=self._material(material, maps, tint),
            targets=cast(Any, [dict(target) for target in targets]),
        )

    def lines(self, places: Array, pairs: Array) -> pygltflib.Primitive:
        """Return lines between `pairs`, shape (k, 2), of points at `places` [m], shape (n, 3)."""
        stored = self.accessor(places, target=pygltflib.ARRAY_BUFFER, bounds=True)
        indices = self.accessor(
            compact_indices(np.asarray(pairs).ravel()), target=pygltflib.ELEMENT_ARRAY_BUFFER
        )
        return pygltflib.Primitive(
            attributes=pygltflib.Attributes(POSITION=stored), indices=indices, mode=pygltflib.LINES
        )

    def _attribute(self, name: str, values: Array, grid: Grid | None) -> int:
        kind, place = pygltflib.ARRAY_BUFFER, name == "POSITION"
        if grid is None or grid.origin is None:
            return self.accessor(np.asarray(values), target=kind, bounds=place)
        if place:
            return self.accessor(grid.places(values), target=kind, bounds=True)
        return self.accessor(packed(name, values), target=kind, normalized=True)

    def mesh(
        self,
        name: str,
        primitives: Sequence[pygltflib.Primitive],
        *,
        target_names: Sequence[str] = (),
    ) -> int:
        """Return a mesh; with `target_names` also its morph weights, all zero."""
        extras = {"targetNames": list(target_names)} if target_names else {}
        mesh = pygltflib.Mesh(
            name=name,
            primitives=list(primitives),
            weights=[0.0] * len(target_names),
            extras=extras,
        )
        return self._append(self._gltf.meshes, mesh)

    def _mapped(
        self, attributes: Mapping[str, Array], triangles: Array, maps: Maps
    ) -> dict[str, Array]:
        """Return the vertex attributes without colours, and with tangents for a normal map."""
        mapped = {name: values for name, values in attributes.items() if name != "COLOR_0"}
        if maps.normal in self._textures:
            mapped["TANGENT"] = tangents_of(
                mapped["POSITION"], mapped["NORMAL"], mapped["TEXCOORD_0"], triangles
            )
        return mapped

    def _maps_of(self, material: str) -> Maps | None:
        """Return the maps that a material shows, if the file embeds them."""
        maps = MATERIALS[material].maps
        return maps if maps is not None and maps.color in self._textures else None

    def _material(self, name: str, maps: Maps | None, tint: tuple[float, ...] = ()) -> int:
        key = (name, maps is not None, tint)
        if key not in self._materials:
            material = _material_named(name, tint)
            picture = MATERIALS[name].picture
            if picture is not None:
                texture = pygltflib.TextureInfo(index=self._shared(name, picture))
                _shading(material).baseColorTexture = texture
            if maps is not None:
                self._lay_on(material, maps)
            self._materials[key] = self._append(self._gltf.materials, material)
        return self._materials[key]

    def _lay_on(self, material: pygltflib.Material, maps: Maps) -> None:
        """Give a material its maps (specification, sections 3.9.2 and 3.9.3)."""
        shading = _shading(material)
        shading.baseColorTexture = pygltflib.TextureInfo(index=self._map(maps.color))
        if maps.normal in self._textures:
            material.normalTexture = pygltflib.NormalMaterialTexture(index=self._map(maps.normal))
        if maps.packed in self._textures:
            packed = self._map(maps.packed)
            shading.metallicRoughnessTexture = pygltflib.TextureInfo(index=packed)
            shading.roughnessFactor = 1.0  # The map says it whole.
            material.occlusionTexture = pygltflib.OcclusionTextureInfo(index=packed)

    def _map(self, file: str) -> int:
        return self._shared(file.partition(".")[0], lambda: self._textures[file])

    def _shared(self, name: str, make: Callable[[], bytes]) -> int:
        """Return the texture of a picture that several materials may show."""
        if name not in self._pictures:
            self._pictures[name] = self.picture(name, make())
        return self._pictures[name]

    def picture(self, name: str, data: bytes) -> int:
        """Store a PNG or JPEG; return the texture that shows it (specification, section 3.8)."""
        view = self._view(np.frombuffer(data, np.uint8), None)
        kind = "image/png" if data.startswith(_PNG) else "image/jpeg"
        image = pygltflib.Image(name=name, mimeType=kind, bufferView=view)
        if not self._gltf.samplers:
            # Linear between texels and between mip levels, clamped at the edges.
            self._gltf.samplers.append(
                pygltflib.Sampler(magFilter=9729, minFilter=9987, wrapS=33071, wrapT=33071)
            )
        source = self._append(self._gltf.images, image)
        texture = pygltflib.Texture(source=source, sampler=0)
        return self._append(self._gltf.textures, texture)

    # Nodes and animation

    def node(
        self,
        name: str,
        *,
        parent: int | None = None,
        mesh: int | None = None,
        translation: Array | None = None,
        extras: Extras | None = None,
        grid: Grid | None = None,
    ) -> int:
        """Add a node under `parent` (the scene, if None), at `translation` mm from it.

        One whose mesh lies on a grid is scaled by its step.
        """
        node = pygltflib.Node(name=name, mesh=mesh, extras=dict(extras or {}))
        place = np.zeros(3) if translation is None else metres(translation).astype(np.float64)
        if grid is not None and grid.origin is not None:
            place = place + grid.origin
            node.scale = [grid.step] * 3
        if np.any(place):
            node.translation = [float(value) for value in place.astype(np.float32)]
        index = self._append(self._gltf.nodes, node)
        siblings = self._gltf.scenes[0].nodes if parent is None else self._children(parent)
        siblings.append(index)
        return index

    def _children(self, node: int) -> list[int]:
        children: list[int] = self._gltf.nodes[node].children
        return children

    def animation(self, name: str, times: Array, channels: Sequence[Channel]) -> None:
        """Add a named animation: every channel has one key per entry of `times`, seconds.

        Channels of the same array share it.
        """
        keys = self.accessor(np.asarray(times, np.float32), bounds=True)
        animation = pygltflib.Animation(name=name)
        samplers: dict[int, int] = {}
        for channel in channels:
            if id(channel.values) not in samplers:
                output = self._animated(channel)
                sampler = pygltflib.AnimationSampler(
                    input=keys, output=output, interpolation="LINEAR"
                )
                samplers[id(channel.values)] = self._append(animation.samplers, sampler)
            target = pygltflib.AnimationChannelTarget(node=channel.node, path=channel.path)
            animation.channels.append(
                pygltflib.AnimationChannel(sampler=samplers[id(channel.values)], target=target)
            )
        self._gltf.animations.append(animation)

    def _animated(self, channel: Channel) -> int:
        values = np.asarray(channel.values, np.float32)
        if channel.path == "weights" and self.packing.quantize and np.abs(values).max() <= 1.0:
            steps = np.rint(values.astype(np.float64) * WEIGHT_STEPS)
            return self.accessor(steps.astype(np.int16), normalized=True)
        return self.accessor(values)

    def to_bytes(self) -> bytes:
        """Return the GLB file."""
        for pool in (self._rows, self._values):
            if pool.view is not None:
                view = self._gltf.bufferViews[pool.view]
                view.byteOffset, view.byteLength = len(self._blob), len(pool.data)
                self._blob += pool.data + bytes(-len(pool.data) % 4)
        self._gltf.buffers = [pygltflib.Buffer(byteLength=len(self._blob))]
        self._gltf.set_binary_blob(self._blob)
        return b"".join(bytes(part) for part in self._gltf.save_to_bytes())

    @staticmethod
    def _append(items: list[Any], item: Any) -> int:
        items.append(item)
        return len(items) - 1


class _Pool:
    """Bytes of many sparse accessors in one buffer view: a view each takes more than some hold."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.view: int | None = None

    def add(self, array: Array) -> int:
        """Add an array; return where it begins, a multiple of four."""
        self.data += bytes(-len(self.data) % 4)
        place = len(self.data)
        self.data += array.tobytes()
        return place


def _stride(array: Array) -> int:
    """Return the bytes from one vertex to the next, a multiple of four."""
    return int(array[0].nbytes + 3) // 4 * 4


def _state_bounds(accessor: pygltflib.Accessor, array: Array) -> None:
    accessor.min = np.atleast_1d(array.min(axis=0)).tolist()
    accessor.max = np.atleast_1d(array.max(axis=0)).tolist()


def _material_named(name: str, tint: tuple[float, ...]) -> pygltflib.Material:
    look = MATERIALS[name]
    color = [*look.color[:3], look.color[3]]
    for channel, value in enumerate(tint):
        color[channel] *= value
    return pygltflib.Material(
        name=name,
        pbrMetallicRoughness=pygltflib.PbrMetallicRoughness(
            baseColorFactor=color, metallicFactor=0.0, roughnessFactor=look.roughness
        ),
        alphaMode=_alpha_mode(look),
        alphaCutoff=look.cutoff,
        doubleSided=look.double_sided,
    )


def _shading(material: pygltflib.Material) -> pygltflib.PbrMetallicRoughness:
    return cast(pygltflib.PbrMetallicRoughness, material.pbrMetallicRoughness)


def _alpha_mode(look: Look) -> str:
    if look.cutoff is not None:
        return "MASK"
    return "BLEND" if look.color[3] < 1 else "OPAQUE"
