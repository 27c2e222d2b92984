"""Many frames at once: drawn as `DrawnFace` draws them one by one."""

from __future__ import annotations

import numpy as np
import pytest
from recorded import standard_clip
from small_face import small_head

from engine.gltf.drawn import DrawnFace
from engine.gltf.frames import FrameDrawer
from engine.head.head import Head


def drawn_one_by_one(face: DrawnFace, displacements: np.ndarray) -> np.ndarray:
    rest = face.rest_positions()
    return np.stack([face.positions(one) - rest for one in displacements])


def small_motion() -> tuple[Head, np.ndarray]:
    head = small_head()
    random = np.random.default_rng(8)
    # Deep enough to press lids into the eyes.
    return head, random.normal(0, 6, (5, *head.points.shape)).astype(np.float32)


def real_motion() -> tuple[Head, np.ndarray]:
    clip = standard_clip()
    return clip.rig.at_level("low").head, clip.displacements[::5]


@pytest.mark.parametrize("motion", [small_motion, real_motion])
def test_frames_at_once_are_those_one_by_one(motion: object) -> None:
    head, displacements = motion()  # type: ignore[operator]
    face = DrawnFace.of(head)
    drawer = FrameDrawer(face, face.strands)
    np.testing.assert_allclose(drawer.rest, face.rest_positions(), atol=1e-5)
    moved = drawer.moves(displacements)
    np.testing.assert_allclose(moved, drawn_one_by_one(face, displacements), atol=2e-4)
    turned = np.stack([face.normal_change(face.skin(one)) for one in displacements])
    np.testing.assert_allclose(drawer.turns(displacements), turned, atol=1e-5)


def test_a_frame_does_not_depend_on_its_neighbours() -> None:
    head, displacements = small_motion()
    face = DrawnFace.of(head)
    drawer, alone = FrameDrawer(face, face.strands), FrameDrawer(face, face.strands[:1])
    whole = drawer.moves(displacements)
    for index in range(len(displacements)):
        one = drawer.moves(displacements[index : index + 1])
        np.testing.assert_array_equal(one[0], whole[index])
    skin, strands = alone.pieces
    np.testing.assert_array_equal(alone.moves(displacements)[:, skin], whole[:, drawer.pieces[0]])
    np.testing.assert_array_equal(
        alone.moves(displacements)[:, strands], whole[:, drawer.pieces[1]]
    )
