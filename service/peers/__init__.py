"""Peers: the same forces written with other tools, to measure the engine's kernel against."""

from .common import Integrator, Peer
from .every import every_peer
from .kernel_peer import KernelPeer
from .timing import compare

__all__ = ["Integrator", "KernelPeer", "Peer", "compare", "every_peer"]
