"""Sixteen numbers in a register: every operation against numpy."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from engine.lanes import vector
from engine.lanes.vector import WIDTH, aligned

greater, lesser, sine_cosine = vector.greater, vector.lesser, vector.sine_cosine
load, store, splat, pick = vector._load, vector._store, vector._splat, vector._pick
inverse_root, floor, lookup = vector._inverse_root, vector._floor, vector._lookup


@numba.njit(error_model="numpy")
def operate(a, b, table, out):
    x, y = load(a, 0), load(b, 0)
    store(out, 0, x + y)
    store(out, WIDTH, x - y)
    store(out, 2 * WIDTH, x * y)
    store(out, 3 * WIDTH, x / y)
    store(out, 4 * WIDTH, greater(x, y))
    store(out, 5 * WIDTH, lesser(x, y))
    store(out, 6 * WIDTH, pick(x, y, splat(np.float32(1.0)), splat(np.float32(2.0))))
    store(out, 7 * WIDTH, inverse_root(y))
    store(out, 8 * WIDTH, floor(x))
    store(out, 9 * WIDTH, lookup(table, y))
    sine, cosine = sine_cosine(x * splat(np.float32(0.2)))
    store(out, 10 * WIDTH, sine)
    store(out, 11 * WIDTH, cosine)


def operated(a, b, table):
    out = aligned(12 * WIDTH)
    operate(a.astype(np.float32), b.astype(np.float32), table.astype(np.float32), out)
    return out.reshape(12, WIDTH).astype(float)


def test_every_operation_is_numpys():
    rng = np.random.default_rng(1)
    for _ in range(50):
        a = rng.uniform(-4.5, 4.5, WIDTH).astype(np.float32).astype(float)
        b = rng.uniform(0.01, 8.9, WIDTH).astype(np.float32).astype(float)
        table = rng.normal(size=10).astype(np.float32).astype(float)
        expected = [
            a + b,
            a - b,
            a * b,
            a / b,
            np.maximum(a, b),
            np.minimum(a, b),
            np.where(a > b, 1.0, 2.0),
            1.0 / np.sqrt(b),
            np.floor(a),
            table[b.astype(int)],
            np.sin(0.2 * a),
            np.cos(0.2 * a),
        ]
        assert operated(a, b, table) == pytest.approx(np.array(expected), rel=3e-7, abs=2e-7)


def test_a_nan_stays_in_its_lane():
    a, b = np.ones(WIDTH), np.full(WIDTH, 2.0)
    whole = operated(a, b, np.zeros(10))
    a[3] = np.nan
    broken = operated(a, b, np.zeros(10))
    others = np.arange(WIDTH) != 3
    assert np.array_equal(broken[:, others], whole[:, others])
    assert np.isnan(broken[:4, 3]).all()


def test_arrays_begin_on_a_line_of_the_cache():
    assert all(aligned(count).ctypes.data % 64 == 0 for count in (1, 16, 100, 4001))
