"""The peers do the engine's work: the same forces, the same motion, or a plain reason why not."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest

from engine import InvalidValue, builtin_rig
from engine.arrays import FloatArray
from service.peers import Integrator, KernelPeer, LanesPeer, Peer, compare, every_peer
from service.peers.timing import Moving, moving_face

STEPS = 20
PEERS = {peer.name: peer for peer in (LanesPeer(), *every_peer())}


@pytest.fixture(scope="module")
def moving() -> Moving:
    """A face of the standard rig in motion."""
    return moving_face(builtin_rig("standard"))


@pytest.fixture(params=PEERS)
def peer(request: pytest.FixtureRequest) -> Peer:
    """Each peer that can run here."""
    found = PEERS[request.param]
    if found.unavailable is not None:
        pytest.skip(found.unavailable)
    return found


def rms(array: FloatArray) -> float:
    return float(np.sqrt(np.mean(array**2)))


def prepared(peer: Peer, moving: Moving, faces: int) -> tuple[FloatArray, FloatArray]:
    x, v = moving.crowd(faces)
    peer.prepare(moving.tissue, moving.skull, faces)
    peer.place(x, v)
    return x, v


@pytest.mark.parametrize("faces", [1, 3, 17])
def test_forces_are_the_kernel_s(peer: Peer, moving: Moving, faces: int) -> None:
    kernel = KernelPeer()
    prepared(kernel, moving, faces)
    x, _ = prepared(peer, moving, faces)
    expected = kernel.force(x)
    assert rms(peer.force(x) - expected) < 1e-4 * rms(expected)


@pytest.mark.parametrize("integrator", ["rk2", "verlet"])
def test_motion_is_the_kernel_s(peer: Peer, moving: Moving, integrator: Integrator) -> None:
    if integrator not in peer.integrators:
        pytest.skip(f"{peer.name} has no {integrator}")
    kernel = KernelPeer()
    x, v = prepared(kernel, moving, 3)
    prepared(peer, moving, 3)
    # In two calls, with a look at the forces between them: neither may leave a trace.
    for steps in (STEPS // 2, STEPS - STEPS // 2):
        for one in (kernel, peer):
            one.evaluate(1)
            one.force(x)
            one.substeps(steps, moving.dt, integrator)
    (to, speed), (expected, expected_speed) = peer.where(), kernel.where()
    assert rms(to - expected) < 1e-4 * rms(expected - x)
    assert rms(speed - expected_speed) < 1e-4 * rms(expected_speed - v)


@pytest.mark.parametrize("integrator", ["rk2", "verlet"])
def test_fixed_nodes_do_not_move(peer: Peer, moving: Moving, integrator: Integrator) -> None:
    if integrator not in peer.integrators:
        pytest.skip(f"{peer.name} has no {integrator}")
    x, v = prepared(peer, moving, 3)
    peer.place(x, v + 10.0)
    peer.substeps(2, moving.dt, integrator)
    fixed = moving.tissue.inverse_mass == 0.0
    assert fixed.any()
    assert np.abs(peer.where()[0] - x)[:, :, fixed].max() < 1e-5


def test_both_integrators_go_the_same_way(moving: Moving) -> None:
    ends = []
    for integrator in ("rk2", "verlet"):
        kernel = KernelPeer()
        x, _ = prepared(kernel, moving, 1)
        kernel.substeps(STEPS, moving.dt, integrator)
        ends.append(kernel.where()[0])
    assert rms(ends[1] - ends[0]) < 0.01 * rms(ends[0] - x)


def test_a_tissue_with_other_terms_is_refused(peer: Peer, moving: Moving) -> None:
    springs = moving.tissue.springs._replace(literal=True)
    with pytest.raises(InvalidValue, match="continuous springs"):
        peer.prepare(moving.tissue._replace(springs=springs), moving.skull, 1)
    with pytest.raises(InvalidValue, match="at least one face"):
        peer.prepare(moving.tissue, moving.skull, 0)


def test_what_is_not_installed_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    compiled = [peer for peer in every_peer() if peer.name in ("taichi", "warp")]
    rows = compare(builtin_rig("standard"), (1,), peers=compiled)
    for row in rows:
        assert "is not installed: pip install 'risorius[bench]'" in row["unavailable"]


def test_every_figure_is_measured() -> None:
    peers = [KernelPeer(), *(peer for peer in every_peer() if peer.name in ("numpy", "scipy"))]
    rows = compare(builtin_rig("standard"), (1, 2), peers=peers, repeats=1, seconds=0.001)
    assert [row["name"] for row in rows] == ["alone (float64)", "numpy", "scipy"]
    for row in rows:
        assert row["version"]
        assert set(row["seconds"]) == {"1", "2"}
        for took in row["seconds"].values():
            assert set(took) == {"force", "rk2", "verlet"}
            assert min(took.values()) > 0.0
