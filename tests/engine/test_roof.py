"""The sweep's arithmetic is what its text says, and the core's peak is above it."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Model
from engine.assembly import compile_rig
from engine.lanes import plan_of, roof
from engine.lanes import sweep as text
from engine.lanes.network import Network

PARTS = (
    "add_at",
    "add_node",
    "add_elements",
    "add_fat",
    "add_to_column",
    "tie",
    "node_sum",
    "sweep",
)
INVERSE_ROOT = 5


class Counted:
    """A value that counts what is done with it; what is added to a fresh product is one with it."""

    done = 0

    def __init__(self, product=False):
        self.product = product

    def __add__(self, other):
        Counted.done += not (self.product or other.product)
        return Counted()

    __sub__ = __add__

    def __mul__(self, other):
        Counted.done += 1
        return Counted(product=True)


def value(*_):
    return Counted()


def operation(count):
    def operate(*_):
        Counted.done += count
        return Counted()

    return operate


@pytest.fixture
def interpreted(monkeypatch):
    """The sweep as Python, with values that count."""
    for name in PARTS:
        monkeypatch.setattr(text, name, getattr(text, name).py_func)
    add_at = text.add_at
    for name in ("load", "splat"):
        monkeypatch.setattr(text, name, value)
        monkeypatch.setitem(add_at.__globals__, name, value)
    for name in ("greater", "lesser"):
        monkeypatch.setattr(text, name, operation(1))
    monkeypatch.setattr(text, "inverse_root", operation(INVERSE_ROOT))
    monkeypatch.setattr(text, "store", lambda *_: None)
    monkeypatch.setitem(add_at.__globals__, "store", lambda *_: None)


def counted(springs, elements, fat):
    """Return the instructions of a column with that many springs, elements and fat."""
    numbers, places = np.ones(200, np.float32), np.zeros(200, np.int32)
    starts = {
        "spring_start": np.array([0, springs, springs, springs]),
        "element_start": np.array([0, elements, elements]),
        "fat_start": np.array([0, fat]),
        "tangential": numbers[:1],
    }
    net = Network(
        **{
            name: starts.get(name, places if "Index" in str(kind) else numbers)
            for name, kind in Network.__annotations__.items()
        }
    )
    Counted.done = 0
    text.sweep(text.Faces(*[numbers] * 9), net, 0.0, 0.0, 0.0, 0.0)
    return Counted.done


def test_the_sweep_is_as_long_as_it_is_said_to_be(interpreted):
    bare = counted(0, 0, 0)
    assert bare == roof.COLUMN_INSTRUCTIONS
    assert counted(3, 0, 0) - bare == 3 * roof.SPRING_INSTRUCTIONS
    assert counted(0, 1, 0) - bare == roof.FIRST_ELEMENT_INSTRUCTIONS
    assert counted(0, 3, 0) - counted(0, 1, 0) == 2 * roof.ELEMENT_INSTRUCTIONS
    assert counted(0, 0, 2) - bare == 2 * roof.FAT_INSTRUCTIONS


def test_the_sweep_stays_under_the_roof_and_not_far(standard_rig):
    """A half is what a quiet machine shows; a busy one, less."""
    model = Model.for_rig(standard_rig, integrator="verlet")
    found = roof.roof_of(plan_of(compile_rig(standard_rig, model)))
    assert 0.1 < found.share < 1.0
