"""The simulator: the engine's only state, a batch of faces of one rig, stepped tick by tick."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from .arrays import FloatArray, IntArray
from .assembly import Assembly, compile_rig
from .channels import GROUPS
from .dynamics import Pull, Skull, Workspace, add_basis_forces, advance, workspace
from .errors import InvalidValue, UnknownName
from .force_basis import ride_jaw
from .frame import Frame, Pose
from .lids import lids_meeting, lids_with_gaze, lids_with_skin
from .mixing import Mixer
from .rig import Model, Rig
from .skull import pose_held, pose_skull
from .timeline import TICKS_PER_SECOND, Keyframe

STILL_SPEED = 0.2
"""Speed under which the tissue counts as still, mm/s: 3 µm a tick, below the stream's grid."""
STILL_TICKS = 20
"""Ticks a face must have been still, and its commands too, before it sleeps."""
ARRIVED = 1.0e-4
"""Distance, activation or degrees, at which a lagging channel takes its command's value."""
FARTHEST_MM = 90.0
"""Displacement that no face reaches: beyond it the simulation has diverged."""


@dataclass
class FaceState:
    """Everything of one face that changes; what moves with it between simulators."""

    x: FloatArray
    v: FloatArray
    signals: FloatArray
    mixer: Mixer
    tick: int = 0
    still_ticks: int = 0
    asleep: bool = False
    diverged: bool = False
    posed: tuple[float, ...] | None = None
    skull: Skull | None = None
    work: Workspace | None = field(default=None, repr=False)


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
        self._faces: dict[str, FaceState] = {}
        self._still = np.zeros((3, self.assembly.tissue.node_count))
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
            state.posed, state.work = None, None
            state.asleep, state.still_ticks = False, 0
        self._faces[face] = state

    def branch(self, face: str, name: str) -> None:
        """Add a face called `name` that goes on from where `face` stands.

        Raises:
            UnknownName: If there is no such face.
            InvalidValue: If the name is taken.
        """
        state = self._face(face)
        copy = FaceState(
            state.x.copy(), state.v.copy(), state.signals.copy(), state.mixer, state.tick
        )
        self.add(name, state=copy)

    def remove(self, face: str) -> FaceState:
        """Take a face out and return its state.

        Raises:
            UnknownName: If there is no such face.
        """
        state = self._face(face)
        del self._faces[face]
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
        state.asleep, state.still_ticks = False, 0
        return state.tick

    def step(self) -> dict[str, Frame]:
        """Advance every face by one tick and return the frames of those that were awake."""
        for state in self._faces.values():
            if state.asleep and state.mixer.due(state.tick):
                state.asleep, state.still_ticks = False, 0
            elif state.asleep:
                state.tick += 1
        awake = {name: state for name, state in self._faces.items() if not state.asleep}
        if self._pool is not None and len(awake) > 1:
            list(self._pool.map(self._step_face, awake.values()))
        else:
            for state in awake.values():
                self._step_face(state)
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
        skull = state.skull
        if skull is None:
            rigid = self._rigid_signals(state)
            skull = pose_skull(self.rig, self.assembly.tissue, list(rigid[:3]), rigid[3:])
        return Snapshot(
            assembly=self.assembly,
            tick=state.tick,
            x=state.x.copy(),
            v=state.v.copy(),
            signals=state.signals.copy(),
            skull=skull,
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
        return self._faces[face]

    def _step_face(self, state: FaceState) -> None:
        state.diverged = False
        self._lag(state)
        carried = self._pose(state)
        skull, pull = self._forces(state)
        assembly = self.assembly
        if state.work is None:
            state.work = workspace(assembly.tissue.arrays)
        advance(
            state.x,
            state.v,
            assembly.substeps,
            1.0 / (TICKS_PER_SECOND * assembly.substeps),
            assembly.tableau,
            assembly.tissue.arrays,
            skull,
            pull,
            state.work,
        )
        if carried is not None:
            held, places = carried
            state.x[:, held], state.v[:, held] = places, 0.0
        state.tick += 1
        self._judge(state)

    def _lag(self, state: FaceState) -> None:
        """Let muscles, jaw, gaze and head follow the command, each with its own inertia."""
        command = state.mixer.at(state.tick)
        gap = command - state.signals
        state.signals = np.where(
            np.abs(gap) < ARRIVED, command, state.signals + self.assembly.smoothing * gap
        )

    def _pose(self, state: FaceState) -> tuple[IntArray, FloatArray] | None:
        """Turn the skull side with jaw and lids, and set out the held nodes, if those have moved.

        They travel evenly through the tick: moved at once, at a blink they would send a wave
        through the skin around the eye.

        Returns:
            The held nodes and where they are when the tick ends, None where nothing moves.
        """
        rigid = tuple(float(v) for v in self._rigid_signals(state))
        before, tissue = state.skull, self.assembly.tissue
        if rigid == state.posed and before is not None:
            state.skull = before._replace(travel=self._still)
            return None
        jaw, lids = rigid[:3], np.array(rigid[3:])
        skull = pose_skull(self.rig, tissue, jaw, lids)
        at = tissue.arrays.rest[:, -tissue.node_count :] if before is None else before.targets
        skull = skull._replace(travel=skull.targets - at)
        state.skull, state.posed = skull, rigid
        held, places = pose_held(self.rig, tissue, jaw, lids)
        state.v[:, held] = (places - state.x[:, held]) * TICKS_PER_SECOND
        return held, places

    def _rigid_signals(self, state: FaceState) -> FloatArray:
        """Return jaw pitch, yaw, degrees, thrust, mm, and the four lid angles, degrees, shape (7,).

        The lids' follow from where the skin stands now: no state of their own is kept.
        """
        m = self.rig.channels.muscle_count
        angles = np.einsum("m,msl->sl", state.signals[:m], self.assembly.lid_angles)
        pitch = float(state.signals[self.rig.channels.index("gaze", "pitch")])
        lids, p = self.assembly.tissue.lids, self.rig.parameters
        angles = lids_with_gaze(angles, pitch)
        angles = lids_with_skin(angles, lids, state.x, (p.upper_lid_skin, p.lower_lid_skin))
        angles = lids_meeting(angles, lids.opening)
        return np.concatenate([state.signals[m : m + 3], angles.ravel()])

    def _forces(self, state: FaceState) -> tuple[Skull, Pull]:
        assert state.skull is not None
        assembly, m = self.assembly, self.rig.channels.muscle_count
        activations = state.signals[:m]
        load = state.skull.load.copy()
        add_basis_forces(assembly.basis, assembly.tissue.arrays.grip, activations, load)
        skull, pull = state.skull._replace(load=load), assembly.pull
        if self.model.forces == "current":
            pull = self._moving_pull(activations, state.signals[m : m + 3])
        return skull, pull

    def _moving_pull(self, activations: FloatArray, jaw: FloatArray) -> Pull:
        """Return the active muscles for mode "current", their ends where the jaw has carried them.

        Args:
            activations: Shape (m,).
            jaw: Pitch and yaw, degrees, thrust, mm, shape (3,).
        """
        active, pull = activations != 0.0, self.assembly.pull
        moving = Pull(
            pull.kinds[active],
            pull.shape[active],
            pull.scale[active] * activations[active],
            pull.share[active],
        )
        if not jaw.any():
            return moving
        pitch, yaw, thrust = (float(value) for value in jaw)
        return ride_jaw(moving, self.assembly.rides[active], self.rig.jaw, (pitch, yaw, thrust))

    def _judge(self, state: FaceState) -> None:
        """Catch a face that diverged, and let one that rests fall asleep."""
        farthest = float(np.abs(state.x - self.assembly.tissue.arrays.rest).max())
        if not farthest < FARTHEST_MM:  # also true for NaN
            self._reset(state)
            return
        fastest = float(np.abs(state.v).max())
        if fastest < STILL_SPEED and not self._signals_move(state):
            state.still_ticks += 1
        else:
            state.still_ticks = 0
        if state.still_ticks >= STILL_TICKS:
            state.v[:] = 0.0
            state.asleep = True

    def _signals_move(self, state: FaceState) -> bool:
        if state.mixer.changing(state.tick):
            return True
        return bool((state.mixer.at(state.tick) != state.signals).any())

    def _reset(self, state: FaceState) -> None:
        """Put a face back to rest with its commands let go; the frame says so."""
        state.x[:] = self.assembly.tissue.arrays.rest
        state.v[:] = 0.0
        state.signals[:] = 0.0
        state.mixer = Mixer(self.rig)
        state.posed, state.skull = None, None
        state.still_ticks, state.diverged = 0, True

    def _frame(self, state: FaceState) -> Frame:
        signals, m = state.signals, self.rig.channels.muscle_count
        pose = self._posed(signals)
        return Frame(
            tick=state.tick,
            displacements=self._surface(state, pose),
            activations=signals[:m].copy(),
            pose=pose,
            asleep=state.asleep,
            diverged=state.diverged,
        )

    def _posed(self, signals: FloatArray) -> Pose:
        """Return the rigid parts of a face; vergence turns each eye by half of its angle."""
        axes = {
            (group, axis): float(signals[self.rig.channels.index(group, axis)])
            for group, names in GROUPS.items()
            for axis in names
        }
        yaw, pitch = axes["gaze", "yaw"], axes["gaze", "pitch"]
        inwards = axes["gaze", "vergence"] / 2.0
        return Pose(
            axes["jaw", "pitch"],
            axes["jaw", "yaw"],
            axes["jaw", "thrust"],
            gaze_left=(yaw - inwards, pitch),
            gaze_right=(yaw + inwards, pitch),
            head=(axes["head", "yaw"], axes["head", "pitch"], axes["head", "roll"]),
            head_thrust=axes["head", "thrust"],
            tongue_thrust=axes["tongue", "thrust"],
        )

    def _surface(self, state: FaceState, pose: Pose) -> FloatArray:
        """Return displacements of the sheet and of what follows it, mm, shape (s, 3)."""
        head, n = self.rig.head, self.assembly.tissue.node_count
        sheet = (state.x[:, :n] - self.assembly.tissue.arrays.rest[:, :n]).T
        followers = head.points[n:]
        ones = np.ones(len(followers))
        rigid = self.rig.jaw.move(followers, ones, pose.jaw_pitch, pose.jaw_yaw, pose.jaw_thrust)
        following = head.follow @ sheet + head.follow_jaw[:, None] * (rigid - followers)
        return np.concatenate([sheet, following])
