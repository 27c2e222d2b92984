"""Everything of one face that changes."""

from __future__ import annotations

from dataclasses import dataclass, field

from .arrays import FloatArray
from .dynamics import Skull, Workspace
from .lanes import Bank
from .mixing import Mixer


@dataclass
class FaceState:
    """Everything of one face that changes; what moves with it between simulators.

    Attributes:
        x, v: Positions, mm, and velocities, mm/s, of the nodes, shape (3, nodes); those of a face
            that has a seat are in its bank.
        signals: Activations, jaw, gaze and head as the face has them, shape (channels,).
        mixer: Its commands.
        tick: Ticks since it was added.
        still_ticks: How long it has been still.
        quiet_ticks: How long its tissue has been still, and all that moves tissue.
        resting: Whether that was so long that the tissue is not stepped; eyes and head may go on.
        asleep: Whether it has been still for so long that it is not stepped.
        since: Its simulator's clock when `tick` was last right, for one asleep.
        diverged: Whether it was put back to rest in the last tick.
        speed: How fast a node went in the last tick, at most along one axis, mm/s. Velocities do
            not tell: what two contacts hold between them has one that they take away every substep.
        lost: Whether it is farther from rest than any face, or no number at all.
        targets: Where the skull holds the ties, mm, shape (3, n); where it does at rest if None.
        skull, posed: The skull side of a face stepped alone, and the jaw and lids it was posed by.
        work: Scratch arrays of a face stepped alone.
        seat: Bank and lane of a face stepped with others.
        seen: Displacements of its surface from rest, mm, shape (s, 3).
    """

    x: FloatArray
    v: FloatArray
    signals: FloatArray
    mixer: Mixer
    tick: int = 0
    still_ticks: int = 0
    quiet_ticks: int = 0
    resting: bool = False
    asleep: bool = False
    since: int = 0
    diverged: bool = False
    speed: float = 0.0
    lost: bool = False
    targets: FloatArray | None = None
    skull: Skull | None = field(default=None, repr=False)
    posed: tuple[float, ...] | None = None
    work: Workspace | None = field(default=None, repr=False)
    seat: tuple[Bank, int] | None = field(default=None, repr=False)
    seen: FloatArray | None = field(default=None, repr=False)
