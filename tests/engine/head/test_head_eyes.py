"""The eyes: their sizes, their map, the wet forms round them, and where they look."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.head import Head, Part, person_head
from engine.head.parts import eye_texture
from engine.head.parts.iris import (
    IRIS_RADIUS,
    IRISES,
    PUPIL_RADIUS,
    SIZE,
    colors_at,
    eye_colors,
    eye_uvs,
)
from engine.head.recipe import EYE_COLORS, Recipe

TRIANGLES_OF_AN_EYE = 2_600


def part(head: Head, name: str) -> Part:
    """Return the part called `name`."""
    return next(candidate for candidate in head.parts if candidate.name == name)


def test_sizes_are_those_of_an_eye(head: Head) -> None:
    assert 2 * IRIS_RADIUS == pytest.approx(11.7)
    assert 2 * PUPIL_RADIUS == pytest.approx(3.5)
    cornea = part(head, "cornea.L").vertices - head.eyes[0].center
    ball = part(head, "eye.L").vertices - head.eyes[0].center
    on_axis = np.hypot(ball[:, 0], ball[:, 1])
    pupil_edge = ball[(on_axis > PUPIL_RADIUS) & (on_axis < 2)][:, 2].max()
    chamber = cornea[:, 2].max() - pupil_edge
    assert chamber == pytest.approx(3.0, abs=0.2)


def test_an_eye_is_within_its_budget(head: Head) -> None:
    count = sum(len(part(head, name).triangles) for name in ("eye.L", "cornea.L"))
    assert count <= TRIANGLES_OF_AN_EYE


def test_lids_clear_the_cornea(head: Head) -> None:
    """What the lids feel of the cornea is never inside the drawn one."""
    for side, eye in zip("LR", head.eyes, strict=True):
        offsets = part(head, f"cornea.{side}").vertices - eye.center
        felt = head.drawn.lids
        shell = np.linalg.norm(offsets, axis=1)
        nothing = np.zeros(len(offsets))
        least = type(felt)(nothing, nothing, nothing).least_radius(offsets, nothing + eye.radius)
        assert (shell <= least + 0.02).all()


@pytest.mark.parametrize("name", ["eye", "cornea"])
def test_uvs_lie_on_the_map_and_mirror(head: Head, name: str) -> None:
    left, right = part(head, f"{name}.L").uvs, part(head, f"{name}.R").uvs
    assert left is not None
    assert right is not None
    assert left.min() >= 0
    assert left.max() <= 1
    np.testing.assert_allclose(right, np.column_stack([1 - left[:, 0], left[:, 1]]))


def test_the_map_is_azimuthal() -> None:
    front, up, left = eye_uvs(np.array([[0.0, 0, 1], [0, 1, 0], [1, 0, 0]]))
    np.testing.assert_allclose(front, [0.5, 0.5])
    np.testing.assert_allclose(up, [0.5, 0.0], atol=1e-12)
    np.testing.assert_allclose(left, [1.0, 0.5], atol=1e-12)


def test_the_same_person_has_the_same_eyes() -> None:
    first, second = eye_texture(Recipe(seed=4)), eye_texture(Recipe(seed=4))
    assert first.shape == (512, 512, 3)
    assert first.dtype == np.uint8
    np.testing.assert_array_equal(first, second)
    assert (first != eye_texture(Recipe(seed=5))).mean() > 0.2


def test_eye_colors_differ_and_the_sclera_is_never_white() -> None:
    assert set(IRISES) == set(EYE_COLORS)
    across, down = np.meshgrid(np.arange(512) - 255.5, np.arange(512) - 255.5)
    radius = np.hypot(across, down)
    iris = (radius > 62) & (radius < 92)
    means = []
    for color in EYE_COLORS:
        texture = eye_texture(Recipe(eye_color=color)).astype(float)
        assert texture[radius < 35].max() < 30
        assert texture.max() < 225
        means.append(texture[iris].mean(axis=0))
    blue, dark = means[EYE_COLORS.index("blue")], means[EYE_COLORS.index("dark_brown")]
    assert blue[2] > blue[0]
    assert dark[0] > dark[2]
    for first in range(len(means)):
        for second in range(first):
            assert np.linalg.norm(means[first] - means[second]) > 8


@pytest.mark.parametrize("yaw", [-30, 0, 30])
@pytest.mark.parametrize("side", "LR")
def test_a_turned_eye_shows_neither_its_back_nor_the_flesh_on_its_iris(
    head: Head, side: str, yaw: float
) -> None:
    eye = head.eyes["LR".index(side)]
    turn = Rotation.from_euler("y", yaw, degrees=True)
    axis = turn.apply([0.0, 0.0, 1.0])
    flesh = part(head, f"caruncle.{side}").vertices - eye.center
    direction = flesh / np.linalg.norm(flesh, axis=1, keepdims=True)
    off_axis = np.degrees(np.arccos((direction @ axis).clip(-1, 1)))
    height = np.linalg.norm(flesh, axis=1) - eye.radius
    assert height[off_axis < 22].max(initial=-1) < 0.3
    # The rear edge of the ball stays behind the plane of the lids' corners.
    ball = turn.apply(part(head, f"eye.{side}").vertices - eye.center)
    rear = np.linalg.norm(part(head, f"eye.{side}").vertices - eye.center, axis=1) > 11.9
    behind = (part(head, f"eye.{side}").vertices - eye.center)[:, 2] < -6
    assert ball[rear & behind][:, 2].max() < 3


def test_the_tear_line_lies_between_lid_and_ball(head: Head) -> None:
    strip = part(head, "tear_line")
    assert strip.roots is not None
    centers = np.where(strip.vertices[:, :1] > 0, head.eyes[0].center, head.eyes[1].center)
    height = np.linalg.norm(strip.vertices - centers, axis=1) - head.eyes[0].radius
    assert height.min() > -0.01
    assert np.linalg.norm(strip.vertices - head.drawn.vertices[strip.roots], axis=1).max() < 2


def test_a_persons_eyes_have_their_colour_before_any_map_is_there() -> None:
    shown = {}
    for color in ("blue", "brown"):
        ball = part(person_head(Recipe(eye_color=color), "low"), "eye.L")
        assert ball.uvs is not None
        across = np.hypot(*(ball.uvs - 0.5).T)
        ring = (across > 0.14) & (across < 0.2)
        shown[color] = ball.colors[ring].mean(axis=0)
    assert shown["blue"][2] > shown["blue"][0]
    assert shown["brown"][0] > 1.5 * shown["brown"][2]


def test_the_outer_corners_flesh_leaves_the_ball_smoothly(head: Head) -> None:
    """Where it comes out of the ball it lies nearly along it, so that no edge shows."""
    eye = head.eyes[0]
    flesh = part(head, "caruncle.L")
    offset = flesh.vertices - eye.center
    height = np.linalg.norm(offset, axis=1) - eye.radius
    outer = (offset[:, 0] > 8) & (np.abs(offset[:, 1]) < 3)
    leaving = outer & (height > -0.15) & (height < 0.3)
    assert leaving.any()
    along = np.einsum("ij,ij->i", flesh.normals, offset) / np.linalg.norm(offset, axis=1)
    assert along[leaving].min() > np.cos(np.radians(42))


@pytest.mark.parametrize("color", ["blue", "dark_brown"])
def test_single_pixels_are_those_of_the_map(color: str) -> None:
    recipe = Recipe(eye_color=color, seed=4)
    rows, columns = np.random.default_rng(0).integers(0, SIZE, (2, 3, 50))
    found = colors_at(recipe, rows, columns)
    np.testing.assert_allclose(found, eye_colors(recipe)[rows, columns], atol=1e-12)
