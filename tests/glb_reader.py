"""A small reader of GLB files that shares nothing with the writer: json, struct and numpy."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

DTYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Glb:
    """One GLB file: `json`, arrays by accessor, node matrices at rest or at a time."""

    def __init__(self, data: bytes) -> None:
        magic, version, length = struct.unpack_from("<4sII", data)
        assert (magic, version, length) == (b"glTF", 2, len(data))
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON"
        self.json: dict[str, Any] = json.loads(data[20 : 20 + size])
        binary = 20 + size
        size, kind = struct.unpack_from("<I4s", data, binary)
        assert kind == b"BIN\0"
        self._blob = data[binary + 8 : binary + 8 + size]

    def array(self, accessor: int) -> np.ndarray:
        """Return an accessor's values, sparse ones filled in, normalised ones as what they mean."""
        entry = self.json["accessors"][accessor]
        width, dtype = WIDTHS[entry["type"]], DTYPES[entry["componentType"]]
        values = np.zeros((entry["count"], width), dtype)
        if "bufferView" in entry:
            offset = entry.get("byteOffset", 0)
            values = self._rows(entry["bufferView"], dtype, entry["count"], width, offset)
        if "sparse" in entry:
            sparse = entry["sparse"]
            where, what = sparse["indices"], sparse["values"]
            kind = DTYPES[where["componentType"]]
            count = sparse["count"]
            rows = self._rows(where["bufferView"], kind, count, 1, where.get("byteOffset", 0))
            values = values.copy()
            values[rows[:, 0]] = self._rows(
                what["bufferView"], dtype, count, width, what.get("byteOffset", 0)
            )
        if entry.get("normalized"):
            most = np.iinfo(dtype).max
            values = np.maximum(values.astype(np.float64) / most, -1.0)
        return values[:, 0] if width == 1 else values

    def _rows(self, view: int, dtype: str, count: int, width: int, offset: int) -> np.ndarray:
        entry = self.json["bufferViews"][view]
        size = np.dtype(dtype).itemsize
        stride = entry.get("byteStride", width * size)
        start = entry.get("byteOffset", 0) + offset
        assert offset + stride * (count - 1) + width * size <= entry["byteLength"]
        raw = np.frombuffer(self._blob, np.uint8, stride * (count - 1) + width * size, start)
        padded = np.concatenate([raw, np.zeros(stride - width * size, np.uint8)])
        rows = padded.reshape(count, stride)[:, : width * size]
        return np.ascontiguousarray(rows).view(dtype).reshape(count, width)

    def buffer(self, view: int) -> bytes:
        """Return the bytes of a buffer view: an image."""
        entry = self.json["bufferViews"][view]
        start = entry.get("byteOffset", 0)
        return self._blob[start : start + entry["byteLength"]]

    def node(self, name: str) -> int:
        """Return the index of the only node of that name."""
        (found,) = (i for i, node in enumerate(self.json["nodes"]) if node["name"] == name)
        return found

    def mesh(self, node: str) -> dict[str, Any]:
        """Return the mesh of the node of that name."""
        return self.json["meshes"][self.json["nodes"][self.node(node)]["mesh"]]

    def matrix(self, name: str, time: float | None = None) -> np.ndarray:
        """Return the 4 x 4 matrix from a node's space to the scene's."""
        node = self.node(name)
        matrix = self._local(node, time)
        while (parent := self._parent(node)) is not None:
            matrix = self._local(parent, time) @ matrix
            node = parent
        return matrix

    def positions(
        self, name: str, *, time: float | None = None, weights: np.ndarray | None = None
    ) -> np.ndarray:
        """Return the vertices of a node's primitives, stacked, in the scene's space.

        Args:
            name: Of the node.
            time: Of the animation, s; its nearest key is taken.
            weights: Of the morph targets, where there is no animation.
        """
        if time is not None:
            weights = self.animated(name, "weights", time)
        primitives = self.mesh(name)["primitives"]
        stacked = np.concatenate([self._morphed(entry, weights) for entry in primitives])
        matrix = self.matrix(name, time)
        return stacked @ matrix[:3, :3].T + matrix[:3, 3]

    def animated(self, name: str, path: str, time: float) -> np.ndarray | None:
        """Return a node's animated property at the key nearest to `time`, s."""
        node = self.node(name)
        for animation in self.json.get("animations", []):
            for channel in animation["channels"]:
                if channel["target"] == {"node": node, "path": path}:
                    sampler = animation["samplers"][channel["sampler"]]
                    times = self.array(sampler["input"])
                    values = self.array(sampler["output"]).reshape(len(times), -1)
                    return values[np.abs(times - time).argmin()].astype(float)
        return None

    def _morphed(self, primitive: dict[str, Any], weights: np.ndarray | None) -> np.ndarray:
        positions = self.array(primitive["attributes"]["POSITION"]).astype(float)
        if weights is None:
            return positions
        assert len(weights) == len(primitive["targets"])
        for weight, target in zip(weights, primitive["targets"], strict=True):
            positions = positions + weight * self.array(target["POSITION"])
        return positions

    def _parent(self, node: int) -> int | None:
        for index, entry in enumerate(self.json["nodes"]):
            if node in entry.get("children", []):
                return index
        return None

    def _local(self, node: int, time: float | None) -> np.ndarray:
        entry = self.json["nodes"][node]
        parts = {
            "translation": np.array(entry.get("translation", (0, 0, 0)), float),
            "rotation": np.array(entry.get("rotation", (0, 0, 0, 1)), float),
        }
        if time is not None:
            for path in parts:
                animated = self.animated(entry["name"], path, time)
                parts[path] = parts[path] if animated is None else animated
        matrix = np.eye(4)
        matrix[:3, :3] = rotation_matrix(parts["rotation"]) * np.array(
            entry.get("scale", (1, 1, 1))
        )
        matrix[:3, 3] = parts["translation"]
        return matrix


def rotation_matrix(quaternion: np.ndarray) -> np.ndarray:
    """Return the rotation of a unit quaternion x, y, z, w."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
