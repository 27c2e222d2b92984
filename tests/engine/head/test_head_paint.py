"""The skin's colours at its vertices: a person's own, those of the texture, at every level."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from measured_color import lab_of_linear
from scipy.spatial import cKDTree

from engine.arrays import FloatArray
from engine.head import Head, person_head
from engine.head.identity.people import people
from engine.head.recipe import STANDARD, Recipe
from engine.head.textures.albedo import vertex_colors
from engine.head.textures.zones import Surface, zones_of


def test_they_are_those_of_the_texture(head: Head) -> None:
    surface = Surface.of(head.drawn)
    recipe = replace(STANDARD, asymmetry=0.0)
    expected = vertex_colors(zones_of(surface, recipe), surface.places, recipe)
    np.testing.assert_allclose(head.drawn.colors, expected, atol=1e-6)


def test_everybody_has_their_own(head: Head) -> None:
    amara = person_head(people()["amara"].recipe)
    assert amara.drawn.colors.mean() < 0.5 * head.drawn.colors.mean()
    # Kept on disk with the person: the second one is read.
    again = person_head(people()["amara"].recipe)
    np.testing.assert_array_equal(again.drawn.colors, amara.drawn.colors)
    np.testing.assert_array_equal(again.drawn.hair, amara.drawn.hair)


@pytest.mark.parametrize("name", ["ingrid", "mei", "omar", "priya", "amara"])
def test_lips_are_rosier_and_darker_than_cheeks(head: Head, name: str) -> None:
    """Pink by their blood, not salmon by the yellow of skin, on light and on dark faces."""
    lips, cheek, _ = _lab_of_zones(head, people()[name].recipe)
    assert lips[0] < cheek[0] - 3
    assert lips[1] > cheek[1] + 3
    assert lips[2] < cheek[2] - 2


def test_upper_lids_are_browner_than_the_face_where_skin_is_dark(head: Head) -> None:
    _, cheek, lid = _lab_of_zones(head, people()["amara"].recipe)
    assert lid[0] < cheek[0] - 5
    _, cheek, lid = _lab_of_zones(head, people()["ingrid"].recipe)
    assert lid[0] > cheek[0] - 5


def _lab_of_zones(head: Head, recipe: Recipe) -> list[FloatArray]:
    """Return CIELAB of lips, cheeks and upper lids."""
    surface = Surface.of(head.drawn)
    zones = zones_of(surface, recipe)
    colors = vertex_colors(zones, surface.places, recipe)
    x, y, z = np.abs(surface.places[:, 0]), surface.places[:, 1], surface.places[:, 2]
    lips = (zones.lip > 3) & (zones.mouth < 0.02)
    cheek = (np.abs(x - 40) < 8) & (np.abs(y + 45) < 8) & (z > 30)
    lid = surface.inside("upper_eyelid") & (np.abs(x - 31) < 10)
    return [lab_of_linear(colors[zone].mean(axis=0)) for zone in (lips, cheek, lid)]


@pytest.mark.parametrize("other", ["low", "medium", "paper"])
def test_coarser_skins_are_painted_alike(heads: dict[str, Head], head: Head, other: str) -> None:
    coarse = heads[other].drawn
    places = coarse.vertices if coarse.reference is None else coarse.reference
    near = cKDTree(head.drawn.reference).query(places)[1]
    assert np.abs(coarse.colors - head.drawn.colors[near]).mean() < 0.03
    assert np.all((coarse.colors > 0) & (coarse.colors < 1))
