"""Peers: the same forces written with other tools, to measure the engine's kernels against."""

from .common import Integrator, Peer
from .every import every_peer
from .kernel_peer import KernelPeer
from .lanes_peer import LanesPeer
from .timing import compare

__all__ = ["Integrator", "KernelPeer", "LanesPeer", "Peer", "compare", "every_peer"]
