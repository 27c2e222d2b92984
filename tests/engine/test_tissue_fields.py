"""Tissue by region and by point: each edit acts where it is said to, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest

from engine import InvalidValue, Keyframe, UnknownName, settled
from engine.tissue import TissueParameters, assemble
from engine.tissue.fields import fields_of
from engine.tissue.layers import sheet_of
from engine.tissue.places import region_share


def edited(**changes):
    return TissueParameters().edited(changes)


def fields(head, **changes):
    return fields_of(head, sheet_of(head), edited(**changes))


def test_a_factor_of_one_changes_no_bit(standard_rig):
    head = standard_rig.head
    maps = {
        "region_thickness": {"cheek": 1.0},
        "region_pretension": {"face": 1.0},
        "region_laxity": {"lip": 0.0},
    }
    plain = assemble(head, TissueParameters(), literal_springs=False)
    same = assemble(head, edited(**maps), literal_springs=False)
    np.testing.assert_array_equal(plain.layers.nodes, same.layers.nodes)
    np.testing.assert_array_equal(plain.arrays.springs.rest, same.arrays.springs.rest)
    np.testing.assert_array_equal(plain.arrays.anchors.tangential, same.arrays.anchors.tangential)


def test_a_region_may_be_a_label_a_part_of_several_a_side_or_the_whole(standard_rig):
    sheet = sheet_of(standard_rig.head)
    cheek = region_share(sheet, "cheek")
    assert 0.0 < cheek.mean() < 0.5
    assert (region_share(sheet, "lip") >= region_share(sheet, "upper_lip") - 1e-12).all()
    assert region_share(sheet, "face").min() == 1.0
    left, right = region_share(sheet, "cheek.L"), region_share(sheet, "cheek.R")
    np.testing.assert_allclose(left + right, cheek)
    assert left[sheet.points[:, 0] < -1.0].max() == 0.0


@pytest.mark.parametrize(
    ("name", "value", "field", "expected"),
    [
        ("region_stiffness", 2.0, "stiffness", 2.0),
        ("region_thickness", 1.5, "skin", 1.5),
        ("region_thickness", 1.5, "ties", 1 / 1.5),
        ("region_pretension", 0.5, "pretension", 0.06),
        ("region_laxity", 1.0, "pretension", 0.072),
        ("region_laxity", 1.0, "slack", 0.65),
        ("region_laxity", 1.0, "ties", 0.65),
    ],
)
def test_a_region_edit_acts_inside_its_region_only(standard_rig, name, value, field, expected):
    head = standard_rig.head
    share = region_share(sheet_of(head), "cheek")
    plain, changed = fields(head), fields(head, **{name: {"cheek": value}})
    np.testing.assert_allclose(getattr(changed, field)[share == 1.0], expected)
    np.testing.assert_array_equal(
        getattr(changed, field)[share == 0.0], getattr(plain, field)[share == 0.0]
    )


def test_a_measured_depth_is_met_at_its_point_and_fades_around_it(standard_rig):
    head = standard_rig.head
    plain, measured = fields(head).depth, fields(head, tissue_depth={"C5_2.L": 20.0}).depth
    here = head.point("C5_2.L")
    assert measured[here] == pytest.approx(20.0)
    distance = np.linalg.norm(head.points[: head.sheet_count] - head.points[here], axis=1)
    ratio = measured / plain
    near, far = ratio[(distance > 0) & (distance < 15.0)], ratio[distance > 90.0]
    full = ratio[here] - 1.0
    assert (near - 1.0).min() > 0.5 * full
    assert (far - 1.0).max() < 0.06 * full
    both = fields(head, tissue_depth={"C5_2": 20.0}).depth
    np.testing.assert_allclose(both[head.mirror[: head.sheet_count]], both, atol=1e-6)


def test_a_map_by_node_is_taken_as_it_is(standard_rig):
    head = standard_rig.head
    depths = tuple(np.linspace(5.0, 15.0, head.sheet_count))
    rig = standard_rig.derive(tissue={"tissue_depth": list(depths)})
    np.testing.assert_array_equal(fields_of(head, sheet_of(head), rig.parameters).depth, depths)
    tissue = assemble(head, rig.parameters, literal_springs=False)
    np.testing.assert_array_equal(tissue.layers.depth, depths)


def test_thick_skin_follows_a_smile_less_and_lax_skin_more(standard_rig):
    smile = [Keyframe(action_units={"AU12": 1.0})]
    corner = standard_rig.head.point("M1_5.L")

    def way(**tissue):
        rig = standard_rig.derive(tissue=tissue)
        return float(np.linalg.norm(settled(rig, smile)[0].displacements[corner]))

    plain = way()
    assert way(skin_thickness={"M1_5": 3.0, "C5_2": 3.0}) < 0.93 * plain
    assert way(region_laxity={"cheek": 1.0, "perioral": 1.0}) > 1.05 * plain


def test_the_order_of_the_input_does_not_matter(standard_rig):
    one = standard_rig.derive(tissue={"region_laxity": {"cheek": 0.5, "chin": 0.2}})
    other = standard_rig.derive(tissue={"region_laxity": {"chin": 0.2}}).derive(
        tissue={"region_laxity": {"cheek": 0.5}}
    )
    assert one.id == other.id != standard_rig.id
    assert other.derive(tissue={"region_laxity": None}).id == standard_rig.derive().id


@pytest.mark.parametrize(
    ("tissue", "error", "message"),
    [
        ({"region_stiffness": {"chek": 2.0}}, UnknownName, "did you mean cheek"),
        ({"region_stiffness": {"cheek.U": 2.0}}, UnknownName, "region"),
        ({"region_laxity": {"cheek": 1.1}}, InvalidValue, "region_laxity.cheek"),
        ({"region_thickness": {"cheek": 9.0}}, InvalidValue, "between 0.4 and 2.5"),
        ({"region_pretension": {"cheek": 3.0}, "pretension": 0.3}, InvalidValue, "pretension"),
        ({"skin_thickness": {"M1_55": 2.0}}, UnknownName, "did you mean M1_5"),
        ({"skin_thickness": {"M1_5": 50.0}}, InvalidValue, "skin_thickness.M1_5"),
        ({"tissue_depth": [9.0, 9.0]}, InvalidValue, "2 entries"),
        ({"tissue_depth": 9.0}, InvalidValue, "array by node"),
        ({"region_laxity": [0.5]}, InvalidValue, "by region"),
        ({"region_laxity": {"cheek": "much"}}, InvalidValue, "number"),
    ],
)
def test_what_cannot_be_tissue_is_refused(standard_rig, tissue, error, message):
    with pytest.raises(error, match=message):
        standard_rig.derive(tissue=tissue)
