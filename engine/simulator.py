"""The simulator: the engine's only state, a batch of faces of one rig, stepped tick by tick."""

from __future__ import annotations

import heapq
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from .alone import Alone
from .arrays import FloatArray
from .assembly import Assembly, compile_rig
from .calm import calmed
from .channels import GROUPS
from .dynamics import Skull
from .errors import InvalidValue, UnknownName
from .face import FaceState
from .frame import Frame, Pose
from .lag import lagged
from .mixing import Mixer
from .rig import Model, Rig
from .timeline import TICKS_PER_SECOND, Keyframe
from .together import Together

STILL_SPEED = 0.2
"""Speed under which the tissue counts as still, mm/s: 3 µm a tick, below the stream's grid."""
STILL_TICKS = 20
"""Ticks a face must have been still, and its commands too, before it sleeps; and its tissue alone,
where eyes or head go on."""
LOOSE = (("gaze", "yaw"), ("gaze", "vergence"), *(("head", axis) for axis in GROUPS["head"]))
"""Axes that move no tissue: a head turns as a whole, and lids follow the gaze up and down only."""
FARTHEST_MM = 90.0
"""Displacement that no face reaches: beyond it the simulation has diverged."""


@dataclass(frozen=True, eq=False)
class Snapshot:
    """A face at one moment with all of its tissue, for those who look into it.

    Attributes:
        assembly: The rig and model that it is simulated with.
        tick: When.
        x: Node positions, mm, shape (3, nodes).
        v: Node velocities, mm/s, shape (3, nodes).
        signals: Activations, jaw, gaze and head as the face has them, shape (channels,).
        skull: The skull side as jaw and lids stand; its load is the dead load alone.
        frame: The face as viewers see it.
    """

    assembly: Assembly
    tick: int
    x: FloatArray
    v: FloatArray
    signals: FloatArray
    skull: Skull
    frame: Frame


class Simulator:
    """Steps any number of faces of one rig and model; each as if it were alone.

    Example:
        >>> simulator = Simulator(builtin_rig("standard"))
        >>> simulator.add("a")
        >>> simulator.apply("a", Keyframe(action_units={"AU12": 1.0}))
        >>> frames = simulator.step()

    A face's motion depends on its own commands alone, bit for bit: not on its neighbours, on
    threads, or on when the simulator was made.
    """

    TICKS_PER_SECOND = TICKS_PER_SECOND

    def __init__(
        self,
        rig: Rig,
        *,
        model: Model | None = None,
        substeps: int | None = None,
        threads: int | None = None,
    ) -> None:
        """Compile `rig`.

        Args:
            rig: The rig of all faces.
            model: Forms of the physics; the rig's own if None.
            substeps: Integration steps a tick; None takes the least that is stable.
            threads: Faces stepped at a time; None takes one a core.

        Raises:
            InvalidValue: If `substeps` is fewer than stability asks for.
        """
        self.rig = rig
        self.model = model or rig.model
        self.assembly: Assembly = compile_rig(rig, self.model, substeps)
        together = Together.fits(self.assembly)
        if together and substeps is None:
            self.assembly = calmed(self.assembly)
        self._tight = np.ones(rig.channels.count, bool)
        self._tight[[rig.channels.index(*axis) for axis in LOOSE]] = False
        self._faces: dict[str, FaceState] = {}
        self._awake: dict[str, FaceState] = {}
        self._clock = 0
        # When sleepers' holds are over, by the clock: nobody looks at them until then.
        self._alarms: list[tuple[int, str]] = []
        kind = Together if together else Alone
        self._stepper: Alone | Together = kind(self.assembly, farthest=FARTHEST_MM)
        count = threads or os.cpu_count() or 1
        self._pool = ThreadPoolExecutor(count) if count > 1 else None

    @property
    def faces(self) -> tuple[str, ...]:
        """Names of the faces, in order of arrival."""
        return tuple(self._faces)

    def add(self, face: str, *, state: FaceState | None = None) -> None:
        """Add a face at rest, or one that another simulator let go.

        Raises:
            InvalidValue: If the name is taken, or the state is of another head.
        """
        if face in self._faces:
            raise InvalidValue(f"there is a face named {face!r} already")
        if state is None:
            rest = self.assembly.tissue.arrays.rest
            state = FaceState(
                rest.copy(), np.zeros_like(rest), np.zeros(self.rig.channels.count), Mixer(self.rig)
            )
        else:
            if state.x.shape != self.assembly.tissue.arrays.rest.shape:
                raise InvalidValue("the state belongs to a head with another number of nodes")
            state.mixer = state.mixer.moved_to(self.rig, state.tick)
            state.resting, state.quiet_ticks = False, 0
        self._faces[face] = state
        self._wake(face, state)

    def branch(self, face: str, name: str) -> None:
        """Add a face called `name` that goes on from where `face` stands.

        Raises:
            UnknownName: If there is no such face.
            InvalidValue: If the name is taken.
        """
        state = self._face(face)
        self._stepper.settle(state)
        copy = replace(
            state,
            x=state.x.copy(),
            v=state.v.copy(),
            signals=state.signals.copy(),
            skull=None,
            posed=None,
            work=None,
            seat=None,
        )
        self.add(name, state=copy)

    def remove(self, face: str) -> FaceState:
        """Take a face out and return its state.

        Raises:
            UnknownName: If there is no such face.
        """
        state = self._face(face)
        self._stepper.leave(state)
        del self._faces[face]
        self._awake.pop(face, None)
        return state

    def apply(self, face: str, keyframe: Keyframe) -> int:
        """Give a command that takes effect at the next step, and return that tick.

        Raises:
            UnknownName: For a face, unit, muscle or emotion that is not there.
            InvalidValue: For a number outside its range.
        """
        state = self._face(face)
        self.rig.check(keyframe)
        state.mixer.apply(keyframe, state.tick)
        self._wake(face, state)
        return state.tick

    def step(self) -> dict[str, Frame]:
        """Advance every face by one tick and return the frames of those that were awake."""
        self._ring()
        awake = dict(self._awake)
        moving = [state for state in awake.values() if not self._rests(state)]
        self._stepper.step(moving, self._pool)
        self._clock += 1
        for name, state in awake.items():
            self._judge(name, state)
        return {name: self._frame(state) for name, state in awake.items()}

    def frame(self, face: str) -> Frame:
        """Return a face as it stands.

        Raises:
            UnknownName: If there is no such face.
        """
        return self._frame(self._face(face))

    def snapshot(self, face: str) -> Snapshot:
        """Return a face as it stands, its tissue copied.

        Raises:
            UnknownName: If there is no such face.
        """
        state = self._face(face)
        self._stepper.settle(state)
        return Snapshot(
            assembly=self.assembly,
            tick=state.tick,
            x=state.x.copy(),
            v=state.v.copy(),
            signals=state.signals.copy(),
            skull=self._stepper.skull(state),
            frame=self._frame(state),
        )

    def report(self, face: str) -> dict[str, object]:
        """Return what each layer of a face holds, and the merged command, as plain data.

        Raises:
            UnknownName: If there is no such face.
        """
        state = self._face(face)
        return state.mixer.report(state.tick)

    def _face(self, face: str) -> FaceState:
        if face not in self._faces:
            raise UnknownName("face", face, self._faces)
        state = self._faces[face]
        if state.asleep:
            state.tick += self._clock - state.since
            state.since = self._clock
        return state

    def _wake(self, face: str, state: FaceState) -> None:
        state.asleep, state.still_ticks = False, 0
        self._awake[face] = state

    def _sleep(self, face: str, state: FaceState) -> None:
        self._rest(state)
        state.asleep, state.since = True, self._clock
        del self._awake[face]
        alarm = state.mixer.alarm()
        if alarm is not None:
            heapq.heappush(self._alarms, (self._clock + alarm - state.tick, face))

    def _rest(self, state: FaceState) -> None:
        self._stepper.leave(state)
        state.v[:], state.speed = 0.0, 0.0
        state.resting = True

    def _rests(self, state: FaceState) -> bool:
        """Move eyes and head of a face whose tissue rests, and wake that when it is to move."""
        if state.resting:
            state.resting = not self._tissue_called(state)
            if state.resting:
                command = state.mixer.at(state.tick)
                smoothing, stride = self.assembly.smoothing, self.assembly.stride
                state.signals = lagged(state.signals, command, smoothing, stride)
        return state.resting

    def _tissue_called(self, state: FaceState) -> bool:
        """Return whether what moves tissue is not where it is asked to be."""
        command = state.mixer.at(state.tick)
        return bool(((command != state.signals) & self._tight).any())

    def _arrived(self, state: FaceState) -> bool:
        """Return whether everything is where it is asked to be, and stays."""
        command, changing = state.mixer.at(state.tick), state.mixer.changing(state.tick)
        return not changing and bool((command == state.signals).all())

    def _ring(self) -> None:
        """Wake the sleepers whose hold is over; a face may have gone or woken since."""
        while self._alarms and self._alarms[0][0] <= self._clock:
            _, face = heapq.heappop(self._alarms)
            if face in self._faces and self._faces[face].asleep:
                state = self._face(face)
                if state.mixer.due(state.tick):
                    self._wake(face, state)

    def _judge(self, face: str, state: FaceState) -> None:
        """Catch a face that diverged, and let one that rests fall asleep."""
        state.tick += 1
        state.diverged = state.lost
        if state.lost:
            self._reset(state)
            return
        # What takes time is asked last: most faces that are awake move.
        quiet = state.speed < STILL_SPEED and not self._tissue_called(state)
        state.quiet_ticks = state.quiet_ticks + 1 if quiet else 0
        state.still_ticks = state.still_ticks + 1 if quiet and self._arrived(state) else 0
        if state.still_ticks >= STILL_TICKS:
            self._sleep(face, state)
        elif state.quiet_ticks >= STILL_TICKS and not state.resting:
            self._rest(state)

    def _reset(self, state: FaceState) -> None:
        """Put a face back to rest with its commands let go; the frame says so."""
        self._stepper.leave(state)
        state.x[:] = self.assembly.tissue.arrays.rest
        state.v[:], state.signals[:] = 0.0, 0.0
        state.mixer = Mixer(self.rig)
        state.targets, state.seen, state.still_ticks = None, None, 0
        state.resting, state.quiet_ticks = False, 0

    def _frame(self, state: FaceState) -> Frame:
        signals, m = state.signals, self.rig.channels.muscle_count
        pose = self._posed(signals)
        return Frame(
            tick=state.tick,
            displacements=self._stepper.displacements(state, signals[m : m + 3]),
            activations=signals[:m].copy(),
            pose=pose,
            asleep=state.asleep,
            diverged=state.diverged,
        )

    def _posed(self, signals: FloatArray) -> Pose:
        """Return the rigid parts of a face; vergence turns each eye by half of its angle."""
        # In the order of `GROUPS`.
        jaw_pitch, jaw_yaw, jaw_thrust, *others = signals[self.rig.channels.muscle_count :].tolist()
        gaze_yaw, gaze_pitch, vergence, *others = others
        head_yaw, head_pitch, head_roll, head_thrust, tongue_thrust = others
        inwards = vergence / 2.0
        return Pose(
            jaw_pitch,
            jaw_yaw,
            jaw_thrust,
            gaze_left=(gaze_yaw - inwards, gaze_pitch),
            gaze_right=(gaze_yaw + inwards, gaze_pitch),
            head=(head_yaw, head_pitch, head_roll),
            head_thrust=head_thrust,
            tongue_thrust=tongue_thrust,
        )
