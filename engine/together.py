"""Faces stepped sixteen at a time in float32: the live ones, whose tissue is the fast kernel's."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

from .alone import skull_of, surface_of
from .arrays import FloatArray
from .assembly import Assembly
from .dynamics import Skull
from .face import FaceState
from .lag import lagged
from .lanes import WIDTH, Bank, plan_of

_MOVES_A_TICK = 4
"""Faces that change places in a tick at most, so that a bank which empties holds up none: a move
takes 0.3 ms, a seventh of a bank's own tick."""


class Together:
    """Steps faces of one rig and model in banks; a face has a seat in one while it is awake."""

    def __init__(self, assembly: Assembly, *, farthest: float) -> None:
        """Take a rig.

        Args:
            assembly: The rig and model, compiled; see `fits`.
            farthest: Displacement from which a face counts as lost, mm.
        """
        self._assembly, self._farthest = assembly, farthest
        self._plan = plan_of(assembly)
        self._seats: dict[Bank, list[FaceState | None]] = {}
        # The bank that was given up last: to lay out another takes two thirds of its tick.
        self._spare: Bank | None = None

    @staticmethod
    def fits(assembly: Assembly) -> bool:
        """Return whether the fast kernel has all the terms of a rig and model."""
        model, plate = assembly.model, assembly.tissue.arrays.plate
        return model.integrator == "verlet" and model.runs_together and len(plate.values) == 0

    def step(self, faces: Sequence[FaceState], pool: ThreadPoolExecutor | None) -> None:
        """Advance every face by a tick; those that have no seat take one."""
        self._close_up(len(faces))
        for face in faces:
            if face.seat is None:
                self._sit(face)
        banks = [bank for bank, seats in self._seats.items() if any(seats)]
        if pool is not None and len(banks) > 1:
            list(pool.map(self._step, banks))
        else:
            for bank in banks:
                self._step(bank)

    def settle(self, face: FaceState) -> None:
        """Bring positions and velocities of a face up to date."""
        if face.seat is not None:
            bank, lane = face.seat
            face.x, face.v, face.targets = bank.read(lane)

    def leave(self, face: FaceState) -> None:
        """Take a face that sleeps or goes from its seat."""
        if face.seat is None:
            return
        self.settle(face)
        bank, lane = face.seat
        face.signals = bank.signals[lane].copy()
        face.seat = None
        if face.seen is not None:
            face.seen = face.seen.copy()
        self._seats[bank][lane] = None
        bank.clear(lane)

    def displacements(self, face: FaceState, jaw: FloatArray) -> FloatArray:
        """Return the surface from rest, mm, shape (s, 3), with the jaw at pitch, yaw, thrust."""
        return surface_of(self._assembly, face.x, jaw) if face.seen is None else face.seen

    def skull(self, face: FaceState) -> Skull:
        """Return the skull side of a face as it stands."""
        return skull_of(self._assembly, face)

    def _sit(self, face: FaceState) -> None:
        """Give a face a seat in the fullest bank that has one, so that the others can empty."""
        bank = max(
            (b for b, seats in self._seats.items() if None in seats), key=self._taken, default=None
        )
        if bank is None:
            bank = self._spare or Bank(self._plan, farthest=self._farthest)
            self._spare = None
            self._seats[bank] = [None] * WIDTH
        seats = self._seats[bank]
        lane = seats.index(None)
        seats[lane], face.seat = face, (bank, lane)
        bank.seat(lane, face.x, face.v, face.targets)
        bank.signals[lane] = face.signals
        face.signals = bank.signals[lane]

    def _taken(self, bank: Bank) -> int:
        return sum(seat is not None for seat in self._seats[bank])

    def _close_up(self, count: int) -> None:
        """Empty a bank whose faces have room in the others, a few a tick, and give it up."""
        if len(self._seats) <= 1:
            return
        seated = sum(self._taken(bank) for bank in self._seats)
        if WIDTH * (len(self._seats) - 1) < max(count, seated):
            return
        emptiest = min(self._seats, key=self._taken)
        leaving = [face for face in self._seats[emptiest] if face is not None]
        for face in leaving[:_MOVES_A_TICK]:
            self.leave(face)
            self._sit(face)
        if not self._taken(emptiest):
            del self._seats[emptiest]
            self._spare = emptiest

    def _step(self, bank: Bank) -> None:
        seated = [(lane, face) for lane, face in enumerate(self._seats[bank]) if face is not None]
        commands = bank.signals.copy()
        for lane, face in seated:
            commands[lane] = face.mixer.at(face.tick)
        assembly = self._assembly
        bank.signals[:] = lagged(bank.signals, commands, assembly.smoothing, assembly.stride)
        seen = bank.step()
        speed, lost = bank.speed.tolist(), bank.lost.tolist()
        for lane, face in seated:
            face.seen, face.speed, face.lost = seen[lane], speed[lane], lost[lane] > 0.0
