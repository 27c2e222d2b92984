"""The materials of a GLB file, with the maps and pictures that it embeds.

By the glTF 2.0 specification, sections 3.8 (textures) and 3.9 (materials).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, cast

import numpy as np

from .accessors import Accessors
from .library import Array, Textures, append, pygltflib
from .materials import MATERIALS, Look, Maps
from .tangents import tangents_of

_PNG = b"\x89PNG"


class Painter:
    """Collects materials and textures; each is stored once."""

    def __init__(self, gltf: Any, accessors: Accessors, textures: Textures) -> None:
        """Begin with none.

        Args:
            gltf: The file.
            accessors: Where pictures are stored.
            textures: The head's maps, to be embedded where a material shows them.
        """
        self._gltf = gltf
        self._accessors = accessors
        self._textures = dict(textures)
        self._materials: dict[tuple[str, bool, tuple[float, ...]], int] = {}
        self._pictures: dict[str, int] = {}

    def mapped(
        self, attributes: Mapping[str, Array], triangles: Array, maps: Maps
    ) -> dict[str, Array]:
        """Return the vertex attributes without colours, and with tangents for a normal map."""
        mapped = {name: values for name, values in attributes.items() if name != "COLOR_0"}
        if maps.normal in self._textures:
            mapped["TANGENT"] = tangents_of(
                mapped["POSITION"], mapped["NORMAL"], mapped["TEXCOORD_0"], triangles
            )
        return mapped

    def maps_of(self, material: str) -> Maps | None:
        """Return the maps that a material shows, if the file embeds them."""
        maps = MATERIALS[material].maps
        return maps if maps is not None and maps.color in self._textures else None

    def material(self, name: str, maps: Maps | None, tint: tuple[float, ...] = ()) -> int:
        """Return a material of `MATERIALS`, in its maps if any, its colour times `tint`."""
        key = (name, maps is not None, tint)
        if key not in self._materials:
            material = _material_named(name, tint)
            picture = MATERIALS[name].picture
            if picture is not None:
                texture = pygltflib.TextureInfo(index=self._shared(name, picture))
                _shading(material).baseColorTexture = texture
            if maps is not None:
                self._lay_on(material, maps)
            self._materials[key] = append(self._gltf.materials, material)
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
        view = self._accessors.view(np.frombuffer(data, np.uint8))
        kind = "image/png" if data.startswith(_PNG) else "image/jpeg"
        image = pygltflib.Image(name=name, mimeType=kind, bufferView=view)
        if not self._gltf.samplers:
            # Linear between texels and between mip levels, clamped at the edges.
            self._gltf.samplers.append(
                pygltflib.Sampler(magFilter=9729, minFilter=9987, wrapS=33071, wrapT=33071)
            )
        source = append(self._gltf.images, image)
        texture = pygltflib.Texture(source=source, sampler=0)
        return append(self._gltf.textures, texture)


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
