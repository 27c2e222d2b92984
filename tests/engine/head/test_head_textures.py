"""The textures: their sizes and weight, the same bytes each time, tones in their classes."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from glb_tools import assert_valid
from measured_color import typology_angle
from PIL import Image

from engine.gltf import face_to_glb
from engine.head import Head, Recipe
from engine.head.recipe import SKIN_TONES, STANDARD
from engine.head.textures import TEXTURE_NAMES, head_textures
from engine.head.textures.albedo import albedo
from engine.head.textures.relief import relief
from engine.head.textures.texels import Texels
from engine.head.textures.zones import Surface, Zones, zones_of
from engine.rig import Rig
from engine.simulator import Simulator

ANGLES = {
    "very_light": (55, 90),
    "light": (41, 55),
    "intermediate": (28, 41),
    "tan": (10, 28),
    "brown": (-30, 10),
    "dark": (-90, -30),
}
"""Individual typology angle of each class [degrees] (Chardon et al., 1991)."""
SMALL = 256
MOST_BYTES = 3_000_000


@pytest.fixture(scope="module")
def skin(head: Head) -> tuple[Texels, Zones]:
    drawn = head.drawn
    texels = Texels.of(drawn.uvs, drawn.triangles, drawn.vertices, SMALL)
    return texels, zones_of(Surface.of(drawn), STANDARD)


@pytest.fixture(scope="module")
def files(head: Head) -> dict[str, bytes]:
    return head_textures(head, STANDARD)


def test_files(files: dict[str, bytes]) -> None:
    assert tuple(files) == TEXTURE_NAMES
    assert sum(map(len, files.values())) < MOST_BYTES
    assert Image.open(io.BytesIO(files["albedo.jpg"])).size == (2048, 2048)
    for name in ("normal.jpg", "orm.jpg", "wrinkles.jpg"):
        assert Image.open(io.BytesIO(files[name])).size == (1024, 1024)


def test_files_that_embed_them_are_valid(
    standard_rig: Rig, files: dict[str, bytes], tmp_path: Path
) -> None:
    still = Simulator(standard_rig)
    still.add("face")
    data = face_to_glb(standard_rig, still.frame("face"), textures=files)
    assert files["albedo.jpg"] in data
    assert_valid(tmp_path, face=data)


@pytest.mark.parametrize("tone", SKIN_TONES)
def test_tones_lie_in_their_class(head: Head, skin: tuple[Texels, Zones], tone: str) -> None:
    recipe = Recipe.of({"skin": tone, "undertone": 0.0})
    colors = albedo(*skin, head.drawn.reference, recipe)
    places = skin[0].carried(head.drawn.reference)
    forehead = (np.abs(places[:, 0]) < 22) & (np.abs(places[:, 1] - 45) < 10) & (places[:, 2] > 60)
    angle = typology_angle(colors[forehead].mean(axis=0).astype(float))
    low, high = ANGLES[tone]
    assert low < angle < high


def test_same_recipe_same_colours(head: Head, skin: tuple[Texels, Zones]) -> None:
    first = albedo(*skin, head.drawn.reference, STANDARD)
    np.testing.assert_array_equal(first, albedo(*skin, head.drawn.reference, STANDARD))
    other = albedo(*skin, head.drawn.reference, replace(STANDARD, seed=1))
    assert np.abs(first - other).max() > 0.01


def test_relief_is_as_deep_as_skin(head: Head, skin: tuple[Texels, Zones]) -> None:
    rest, wrinkled = relief(*skin, head.drawn.reference, STANDARD)
    assert 0.02 < rest.std() < 0.12  # mm
    assert -0.5 < rest.min()
    assert -2.0 < wrinkled.min() < -0.5
