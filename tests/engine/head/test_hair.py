"""Hair by recipe: where it is rooted, what it keeps clear of, what it costs, how it is coloured."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import BoolArray
from engine.head import Head
from engine.head.hair_color import NATURAL, brow_color, hair_color, strand_colors
from engine.head.hairline import hair_mask, recession, scalp_cover
from engine.head.head import Part
from engine.head.parts.brows import brows_part
from engine.head.parts.cards import on_forehead
from engine.head.parts.hair import HEM, HEM_RAGGED, hair_parts
from engine.head.parts.scalp import EAR_CENTER, EAR_RADII, Scalp
from engine.head.parts.strand_texture import HEIGHT, LANES, WIDTH, hair_texture
from engine.head.recipe import HAIR_COLORS, HAIR_STYLES, STANDARD, Recipe

BUDGET = {"bald": 0, "bob": 36_000, "curly": 36_000}
"""Triangles of cards and single hairs by style; others may have 25,000."""


def grown(head: Head, recipe: Recipe) -> list[Part]:
    return hair_parts(head.drawn, recipe)


def first_pairs(part: Part) -> BoolArray:
    """Return which vertices of cards are those of their roots: where the texture begins anew."""
    assert part.uvs is not None
    down = part.uvs[::2, 1]
    return np.repeat(down < np.roll(down, 1), 2)


@pytest.fixture(scope="module")
def parts(head: Head) -> dict[str, list[Part]]:
    return {style: grown(head, Recipe(hair_style=style)) for style in HAIR_STYLES}


@pytest.mark.parametrize("style", HAIR_STYLES)
def test_a_style_keeps_its_budget(parts: dict[str, list[Part]], style: str) -> None:
    assert sum(len(part.triangles) for part in parts[style]) <= BUDGET.get(style, 25_000)
    cards = sum(len(part.triangles) for part in parts[style] if part.uvs is not None)
    if style != "bald":
        assert cards > 5_000


@pytest.mark.parametrize("style", HAIR_STYLES)
def test_hair_moves_with_the_skull_but_for_its_first_rows(
    parts: dict[str, list[Part]], head: Head, style: str
) -> None:
    for part in parts[style]:
        rides = part.name in ("hairline", "baby_hairs")
        assert (part.follows, part.roots is not None) == ("skin" if rides else "skull", rides)
        if part.roots is not None:
            assert np.linalg.norm(part.vertices[0] - head.drawn.vertices[part.roots[0]]) < 6


def test_what_moves_with_the_skull_lies_under_hair(
    parts: dict[str, list[Part]], head: Head
) -> None:
    """Where the forehead moves, only hair that hides the skin stays where it was."""
    hair = next(part for part in parts["crop"] if part.name == "hair")
    assert hair.uvs is not None
    roots = hair.vertices[hair.uvs[:, 1] == 0].reshape(-1, 2, 3).mean(axis=1)
    moving = roots[on_forehead(roots)]
    assert (hair_mask(moving, STANDARD) > 0.85).all()


@pytest.mark.parametrize("style", [style for style in HAIR_STYLES if style != "bald"])
def test_cards_are_rooted_where_hair_grows(
    parts: dict[str, list[Part]], head: Head, style: str
) -> None:
    recipe = Recipe(hair_style=style)
    part = next(part for part in parts[style] if part.name == "hair")
    assert part.uvs is not None
    roots = part.vertices[first_pairs(part)].reshape(-1, 2, 3).mean(axis=1)
    height, _ = Scalp(head.drawn, recipe).height(roots)
    assert np.abs(height).max() < 2.5
    assert (hair_mask(roots, recipe) > 0.2).mean() > 0.97


@pytest.mark.parametrize("style", [style for style in HAIR_STYLES if style != "bald"])
def test_cards_keep_out_of_skull_and_face(
    parts: dict[str, list[Part]], head: Head, style: str
) -> None:
    part = next(part for part in parts[style] if part.name == "hair")
    assert part.uvs is not None
    free = part.vertices[part.uvs[:, 1] > 0.3]
    height, _ = Scalp(head.drawn, Recipe(hair_style=style)).height(free)
    assert np.percentile(height, 0.5) > -2.0
    face = (np.abs(free[:, 0]) < 40) & (free[:, 1] < 45) & (free[:, 2] > 50)
    assert not face.any()


def test_the_same_recipe_grows_the_same_hair(head: Head) -> None:
    first, second = grown(head, STANDARD), grown(head, STANDARD)
    other = grown(head, replace(STANDARD, seed=3))
    np.testing.assert_array_equal(first[0].vertices, second[0].vertices)
    assert first[0].vertices.shape != other[0].vertices.shape


def test_bald_heads_keep_a_shadow(head: Head) -> None:
    recipe = Recipe(hair_style="bald")
    assert grown(head, recipe) == []
    crown = head.drawn.vertices[head.drawn.vertices[:, 1] > 105]
    assert 0.2 < scalp_cover(crown, recipe).mean() < 0.5


def test_hair_cut_to_millimetres_still_hides_the_scalp() -> None:
    crown = np.array([[0.0, 105.0, 0.0], [10.0, 110.0, -20.0]])
    assert scalp_cover(crown, Recipe(hair_style="buzz")).min() > 0.9


def test_the_hairline_goes_back_with_age_in_men_only() -> None:
    assert recession(Recipe(sex=1.0, age=70)) > recession(Recipe(sex=1.0, age=25)) + 0.2
    assert recession(Recipe(sex=0.0, age=70)) == 0
    assert recession(Recipe(hair_style="receding")) > 0.5
    temple = np.array([[45.0, 77.0, 64.0]])
    assert hair_mask(temple, Recipe(hair_style="receding"))[0] < 0.05


def test_the_texture_is_small_and_has_empty_edges() -> None:
    from io import BytesIO

    from PIL import Image

    png = hair_texture()
    assert len(png) <= 120_000
    pixels = np.asarray(Image.open(BytesIO(png)))
    assert pixels.shape == (HEIGHT, WIDTH, 2)
    wide = WIDTH // len(LANES)
    assert pixels[:, ::wide, 1].max() == 0
    solid = [pixels[:, k * wide : (k + 1) * wide, 1].mean() for k in range(8)]
    assert solid == sorted(solid, reverse=True)


@pytest.mark.parametrize("name", HAIR_COLORS)
def test_no_hair_is_black_or_blinding(name: str) -> None:
    colors = strand_colors(Recipe(hair_color=name), 4000, np.random.default_rng(1))
    assert colors.min() > 0.003
    assert np.percentile(colors, 99) < 1
    np.testing.assert_allclose(colors.mean(axis=0), NATURAL[name], rtol=0.12)


def test_greying_mixes_single_hairs() -> None:
    recipe = Recipe(hair_color="dark_brown", grayness=0.4)
    colors = strand_colors(recipe, 4000, np.random.default_rng(1)).mean(axis=1)
    assert (colors > 0.2).mean() == pytest.approx(0.4, abs=0.04)
    assert hair_color(recipe).mean() > 2 * hair_color(Recipe(hair_color="dark_brown")).mean()


def test_a_few_grey_hairs_leave_black_hair_black() -> None:
    noise = np.random.default_rng(2)
    recipe = Recipe(hair_color="black", grayness=0.09)
    clumps = strand_colors(recipe, 4_000, noise, spread=0.04)
    assert clumps.mean() < 2.2 * np.mean(NATURAL["black"])
    white = strand_colors(replace(recipe, grayness=1.0), 4_000, noise, spread=0.15)
    assert white.mean() > 0.35


def test_fair_people_have_darker_brows() -> None:
    blond = Recipe(hair_color="blond")
    assert brow_color(blond).mean() < 0.6 * hair_color(blond).mean()


def test_brows_are_of_their_sex(head: Head) -> None:
    man, woman = (brows_part(head.drawn, Recipe(sex=sex)) for sex in (1.0, 0.0))
    left = [brow.vertices[brow.vertices[:, 0] > 30] for brow in (man, woman)]
    assert left[0][:, 1].mean() < left[1][:, 1].mean() - 1
    assert np.ptp(left[0][:, 1]) > np.ptp(left[1][:, 1])


def test_what_rides_the_skin_is_light(head: Head) -> None:
    hair = [part for part in head.parts if part.material == "hair"]
    riding = {part.name: len(part.vertices) for part in hair if part.follows == "skin"}
    assert set(riding) == {"brows", "lashes", "hairline", "baby_hairs"}
    assert sum(riding.values()) <= 14_000


def test_hanging_hair_goes_over_the_ears(parts: dict[str, list[Part]]) -> None:
    bob = next(part for part in parts["bob"] if part.name == "hair")
    assert bob.uvs is not None
    free = bob.vertices[bob.uvs[:, 1] > 0.4]
    away = (np.abs(free * [1, 0, 0]) + free * [0, 1, 1] - EAR_CENTER) / (0.8 * EAR_RADII)
    inside = np.linalg.norm(away, axis=1) < 1
    assert inside.mean() < 0.01


def test_long_hair_shows_no_scalp_beside_its_parting(
    parts: dict[str, list[Part]],
) -> None:
    bob = next(part for part in parts["bob"] if part.name == "hair")
    assert bob.uvs is not None
    roots = first_pairs(bob)
    full = hair_mask(bob.vertices[roots], Recipe(hair_style="bob")) > 0.999
    sparse = LANES[0].stagger
    assert (bob.uvs[roots, 1][full] >= sparse).mean() > 0.95


def test_long_hair_leaves_the_forehead_bare(parts: dict[str, list[Part]]) -> None:
    recipe = Recipe(hair_style="bob")
    for part in parts["bob"]:
        if part.uvs is not None:
            middles = part.vertices.reshape(-1, 2, 3).mean(axis=1)
            middles = middles[~first_pairs(part)[::2]]
            ahead = middles[on_forehead(middles)]
            assert (hair_mask(ahead, recipe) > 0.1).all(), part.name


def test_a_bob_is_cut_at_one_height(parts: dict[str, list[Part]]) -> None:
    """Nothing hangs below the hem, which slants by 6 mm and is a bit ragged; much comes to it."""
    bob = next(part for part in parts["bob"] if part.name == "hair")
    tips = np.roll(first_pairs(bob), -2)
    low = bob.vertices[tips].reshape(-1, 2, 3).mean(axis=1)[:, 1]
    assert low.min() > HEM - 6 - 5 * HEM_RAGGED
    assert (low < HEM + 3 * HEM_RAGGED).mean() > 0.3


def test_the_scalps_shade_has_no_steps_between_neighbouring_vertices() -> None:
    """Columns of the forehead stand five millimetres apart; between them the shade is linear."""
    row = np.array([[x, 80.0, 80.0] for x in np.arange(-45.0, 46.0, 5.0)])
    steps = [
        np.abs(np.diff(scalp_cover(row, Recipe(hair_style="buzz", seed=seed)))).max()
        for seed in range(100, 104)
    ]
    assert max(steps) < 0.25
