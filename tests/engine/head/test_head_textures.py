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
from engine.head.textures.relief import cheek_step, creases, dimples, relief
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


def test_fold_beside_the_mouth_is_a_step_of_the_cheek() -> None:
    gaps = np.linspace(-12, 14, 261)
    roll, valley = np.array([cheek_step(gap) for gap in gaps]).T
    heights = roll - 0.35 * valley
    crest, floor = gaps[heights.argmax()], gaps[heights.argmin()]
    assert 2 < crest < 6  # mm, on the cheek's side
    assert -2 < floor < 0.5
    assert np.abs(heights[gaps < -5]).max() < 0.02  # nothing stands on the lip's side
    shaded = gaps[heights > 0.1]
    assert shaded.max() - shaded.min() > 8
    assert (np.diff(heights[(gaps > floor) & (gaps < crest)]) > 0).all()  # one step, no ridges


def test_knotted_chin_has_pits_and_no_bumps() -> None:
    side = np.linspace(0, 20, 200)
    depth = np.array([[dimples(x, y, 0.5, 7) for x in side] for y in side])
    assert depth.min() >= 0
    # Most of the skin is plain and pits lie in it, not the other way about.
    assert np.median(depth) < depth.mean() < 0.5 * depth.max()
    inside = depth[1:-1, 1:-1]
    rims = [depth[1 + j : 199 + j, 1 + i : 199 + i] for i in (-1, 0, 1) for j in (-1, 0, 1)]
    pits = (inside >= np.max(rims, axis=0)) & (inside > 0.15)
    assert 1.0 < np.sqrt(side[-1] ** 2 / pits.sum()) < 1.6  # spacings between pits
    assert depth[1:-1, 1:-1][pits].std() > 0.1


def test_floors_of_furrows_are_dark_and_walls_are_not(head: Head) -> None:
    drawn = head.drawn
    texels = Texels.of(drawn.uvs, drawn.triangles, drawn.vertices, 1024)
    places = texels.carried(drawn.reference)
    rest = np.zeros(len(places), dtype=np.float32)
    # Furrows across the forehead, 9 mm apart.
    heights = (-0.7 * np.exp(-((((places[:, 1] + 4.5) % 9 - 4.5) / 1.0) ** 2))).astype(np.float32)
    found = creases(texels, heights, rest)[texels.rows, texels.columns]
    there = (np.abs(places[:, 0]) < 20) & (np.abs(places[:, 1] - 45) < 12) & (places[:, 2] > 60)
    off = np.abs((places[:, 1] + 4.5) % 9 - 4.5)
    floor, flank = found[there & (off < 0.3), 2], found[there & (off > 2.0), 2]
    assert np.median(floor) < 130
    assert np.median(flank) > 245
    still = creases(texels, rest, rest)[texels.rows, texels.columns]
    assert still[:, 2].min() == 255


def test_rolls_of_the_forehead_are_broad(head: Head) -> None:
    drawn = head.drawn
    texels = Texels.of(drawn.uvs, drawn.triangles, drawn.vertices, 1024)
    rest, wrinkled = relief(
        texels, zones_of(Surface.of(drawn), STANDARD), drawn.reference, STANDARD
    )
    places, folds = texels.carried(drawn.reference), wrinkled - rest
    there = (np.abs(places[:, 0] - 6) < 0.6) & (places[:, 1] > 28) & (places[:, 1] < 64)
    there &= places[:, 2] > 60
    order = np.argsort(places[there, 1])
    y, height = places[there, 1][order], folds[there][order]
    steps = np.arange(28, 64, 0.5)
    profile = np.array([height[np.abs(y - step) < 0.4].mean() for step in steps])
    inner = profile[1:-1]
    floors = steps[1:-1][(inner < profile[:-2]) & (inner <= profile[2:]) & (inner < -0.05)]
    assert len(floors) >= 3
    assert 7 < np.diff(floors).min()  # mm from furrow to furrow
    assert np.diff(floors).max() < 12
    sloping = np.abs(np.gradient(profile, steps)) > 0.03
    assert sloping.mean() > 0.5  # most of the skin belongs to a roll, not to plain skin
