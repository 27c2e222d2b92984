"""A head as plain arrays and back, so that it can be kept in the cache."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from ..cache import Arrays, content_key
from ..sources import HEAD_HASH
from .head import DrawnSurface, Eye, Head, LidContact, Part

HEAD_ARRAYS = (
    "points", "polygons", "triangles", "mirror", "fixed", "jaw_weight", "depth", "anchor_weight",
    "follow_jaw", "teeth",
)  # fmt: skip
DRAWN_ARRAYS = ("vertices", "normals", "triangles", "colors", "hair", "regions")
TEXTURE_ARRAYS = ("uvs", "reference", "seams")
LID_ARRAYS = ("vertices", "eyes", "clearance")
PART_ARRAYS = ("vertices", "normals", "triangles", "colors", "roots", "hair", "uvs")


def source_key(*parts: object) -> str:
    """Return a hash of `parts`, of the authored data and of all code that makes heads from it."""
    return content_key(*parts, HEAD_HASH)


def head_to_arrays(head: Head) -> Arrays:
    """Return every array of `head` under a name of its own, and the rest as JSON text."""
    drawn = head.drawn
    arrays: Arrays = {name: getattr(head, name) for name in HEAD_ARRAYS}
    arrays |= _matrix_to_arrays("follow", head.follow)
    arrays |= {f"drawn.{name}": getattr(drawn, name) for name in DRAWN_ARRAYS}
    for name in TEXTURE_ARRAYS:
        if getattr(drawn, name) is not None:
            arrays[f"drawn.{name}"] = getattr(drawn, name)
    arrays |= _matrix_to_arrays("drawn.map", drawn.map)
    arrays |= {f"lids.{name}": getattr(drawn.lids, name) for name in LID_ARRAYS}
    for index, part in enumerate(head.parts):
        for name in PART_ARRAYS:
            values = getattr(part, name)
            if values is not None:
                arrays[f"part{index}.{name}"] = values
    rest = {
        "name": head.name,
        "names": head.names,
        "sheet_count": head.sheet_count,
        "polygon_regions": head.polygon_regions,
        "region_names": drawn.region_names,
        "parts": [(part.name, part.material, part.follows) for part in head.parts],
        "eyes": [(eye.center.tolist(), eye.radius) for eye in head.eyes],
        "landmarks": dict(head.landmarks),
    }
    arrays["rest"] = np.frombuffer(json.dumps(rest).encode(), dtype=np.uint8)
    return arrays


def head_from_arrays(arrays: Arrays) -> Head:
    """Return the head that `head_to_arrays` took apart."""
    rest = json.loads(arrays["rest"].tobytes())
    drawn = DrawnSurface(
        **_stored("drawn.", (*DRAWN_ARRAYS, *TEXTURE_ARRAYS), arrays),
        region_names=tuple(rest["region_names"]),
        map=_matrix_from_arrays("drawn.map", arrays),
        lids=LidContact(**_stored("lids.", LID_ARRAYS, arrays)),
    )
    parts = tuple(
        Part(
            name,
            material=material,
            follows=follows,
            **_stored(f"part{index}.", PART_ARRAYS, arrays),
        )
        for index, (name, material, follows) in enumerate(rest["parts"])
    )
    return Head(
        name=rest["name"],
        names=tuple(rest["names"]),
        sheet_count=rest["sheet_count"],
        polygon_regions=tuple(rest["polygon_regions"]),
        follow=_matrix_from_arrays("follow", arrays),
        drawn=drawn,
        parts=parts,
        eyes=tuple(Eye(np.array(center), radius) for center, radius in rest["eyes"]),
        landmarks=rest["landmarks"],
        **_stored("", HEAD_ARRAYS, arrays),
    )


def _stored(prefix: str, names: Sequence[str], arrays: Arrays) -> Arrays:
    """Return the arrays of those names that were stored: what has a default may be missing."""
    return {name: arrays[prefix + name] for name in names if prefix + name in arrays}


def _matrix_to_arrays(name: str, matrix: sp.csr_array) -> Arrays:
    return {
        f"{name}.data": matrix.data,
        f"{name}.indices": matrix.indices,
        f"{name}.indptr": matrix.indptr,
        f"{name}.shape": np.array(matrix.shape),
    }


def _matrix_from_arrays(name: str, arrays: Arrays) -> sp.csr_array:
    values = tuple(arrays[f"{name}.{key}"] for key in ("data", "indices", "indptr"))
    return sp.csr_array(values, shape=tuple(arrays[f"{name}.shape"]))
