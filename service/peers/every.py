"""Every peer there is, installed or not."""

from __future__ import annotations

from .common import Peer
from .numpy_peer import NumpyPeer
from .scipy_peer import ScipyPeer
from .taichi_peer import TaichiPeer
from .warp_peer import WarpPeer


def every_peer() -> tuple[Peer, ...]:
    """Return one of each peer, not yet prepared; ask each whether it is unavailable."""
    return NumpyPeer(), ScipyPeer(), TaichiPeer(), WarpPeer()
