"""A GLB file under construction: its numbers, and the meshes, nodes and animation made of them.

By the glTF 2.0 specification, sections 3.7 (meshes, morph targets) and 3.11 (animation).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from .accessors import Accessors, compact_indices, metres
from .library import Array, Extras, Textures, append, pygltflib
from .materials import MATERIALS
from .packing import EXTENSION, WEIGHT_STEPS, Grid, Packing, packed
from .painting import Painter


@dataclass(frozen=True)
class Channel:
    """One animated property: `values` per key of `node`'s `path` ("rotation", "weights", …)."""

    node: int
    path: str
    values: Array


class GlbBuilder(Accessors):
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
        packing = packing or Packing()
        gltf = pygltflib.GLTF2(
            asset=pygltflib.Asset(generator="Risorius", extras=dict(extras)),
            scene=0,
            scenes=[pygltflib.Scene(name="risorius")],
        )
        if packing.quantize:
            gltf.extensionsUsed = [EXTENSION]
            gltf.extensionsRequired = [EXTENSION]
        super().__init__(gltf, packing)
        self._painter = Painter(gltf, self, textures or {})

    def tell(self, extras: Extras) -> None:
        """Have the file say more of itself.

        The library leaves out what is empty or None, but not what is in tuples.
        """
        self._gltf.asset.extras.update(extras)

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
        maps = self._painter.maps_of(material) if "TEXCOORD_0" in attributes else None
        if maps is not None:
            attributes = self._painter.mapped(attributes, triangles, maps)
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
            material=self._painter.material(material, maps, tint),
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
        return append(self._gltf.meshes, mesh)

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
        index = append(self._gltf.nodes, node)
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
                samplers[id(channel.values)] = append(animation.samplers, sampler)
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
        blob = self.buffer()
        self._gltf.buffers = [pygltflib.Buffer(byteLength=len(blob))]
        self._gltf.set_binary_blob(blob)
        return b"".join(bytes(part) for part in self._gltf.save_to_bytes())
