"""The skin's colours at its vertices: a person's own, those of the texture, at every level."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine.head import Head, person_head
from engine.head.identity.people import people
from engine.head.recipe import STANDARD
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


@pytest.mark.parametrize("other", ["low", "medium", "paper"])
def test_coarser_skins_are_painted_alike(heads: dict[str, Head], head: Head, other: str) -> None:
    coarse = heads[other].drawn
    places = coarse.vertices if coarse.reference is None else coarse.reference
    near = cKDTree(head.drawn.reference).query(places)[1]
    assert np.abs(coarse.colors - head.drawn.colors[near]).mean() < 0.03
    assert np.all((coarse.colors > 0) & (coarse.colors < 1))
