"""One lip of a unit: T and B of what FACS scores by lips."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import (
    LANDMARKS_68,
    LIPS,
    PARTED,
    Keyframe,
    Rig,
    UnknownName,
    builtin_rig,
    facs_codes,
    hold_units,
    part_name,
    settled,
    whole_of,
)

UPPER, LOWER = (50, 51, 52, 61, 62, 63), (56, 57, 58, 65, 66, 67)
"""Middle of each lip, by number of the landmark."""
SHARE = st.floats(0.1, 1.0)


@given(st.sampled_from(PARTED), SHARE)
def test_both_parts_are_the_unit(unit, intensity):
    rig = builtin_rig("standard")
    parts = sum(rig.contraction({part_name(unit, lip): intensity}) for lip in LIPS)
    _, most = rig._limits
    assert np.allclose(np.minimum(parts, most), rig.contraction({unit: intensity}))
    both = rig.contraction({part_name(unit, lip): intensity for lip in LIPS})
    assert np.allclose(both, rig.contraction({unit: intensity}))


def test_each_part_moves_its_own_lip_more_than_the_other_part_does(standard_rig: Rig):
    names = [part_name(unit, lip) for unit in PARTED for lip in LIPS]
    frames = settled(standard_rig, [Keyframe(action_units={n: 1.0}, fade=0.15) for n in names])
    rows = [
        [standard_rig.head.point(LANDMARKS_68[number]) for number in lip] for lip in (UPPER, LOWER)
    ]
    upper, lower = (
        [float(np.linalg.norm(frame.displacements[row].mean(axis=0))) for frame in frames]
        for row in rows
    )
    share = {name: up / low for name, up, low in zip(names, upper, lower, strict=True)}
    for unit in PARTED:
        top, bottom = (share[part_name(unit, lip)] for lip in LIPS)
        assert top > 1.4 * bottom, unit


def test_parts_are_of_codes_that_facs_scores_by_lips(standard_rig: Rig):
    for unit in PARTED:
        assert set(LIPS) <= set(facs_codes()[unit].sides)
        part, side = standard_rig.resolve_unit(f"t{unit[2:]}")
        assert (part.name, side) == (f"T{unit[2:]}", "")
        assert whole_of(part.name) == unit
        assert part.title.endswith("top lip")
    for key in ("T12", "B23", "T99"):
        with pytest.raises(UnknownName):
            standard_rig.resolve_unit(key)
    assert [whole_of(name) for name in ("AU28", "T12", "Twirl", "L28", "")] == [""] * 5


@pytest.mark.parametrize(
    ("held", "named", "after"),
    [
        ({"AU28": 0.6}, {"T28": 0.2}, {"T28": 0.2, "B28": 0.6}),
        ({"AU28": 0.6}, {"B28": 0.0}, {"T28": 0.6}),
        ({"T28": 0.2, "B28": 0.6}, {"AU28": 0.3}, {"AU28": 0.3}),
        ({"T28": 0.2, "B28": 0.6}, {"28": 0.0}, {}),
        ({"T28": 0.2}, {"B28": 0.2}, {"AU28": 0.2}),
        ({}, {"T28": 0.2, "AU28": 0.5}, {"T28": 0.2, "B28": 0.5}),
        ({"L28": 0.2}, {"T28": 0.3, "B28": 0.3}, {"L28": 0.2, "T28": 0.3, "B28": 0.3}),
        ({"AU12": 0.6}, {"T28": 0.2}, {"AU12": 0.6, "T28": 0.2}),
    ],
)
def test_a_lip_is_held_beside_the_other_as_a_side_is(standard_rig, held, named, after):
    hold_units(standard_rig, held, named)
    assert held == after


def test_a_rigs_own_unit_of_that_name_is_no_part(standard_rig: Rig):
    rig = standard_rig.derive(action_units={"T28": {"muscles": {"mentalis": 1.0}}})
    held = {"AU28": 0.5}
    hold_units(rig, held, {"T28": 0.2})
    assert held == {"AU28": 0.5, "T28": 0.2}
