"""Faces stepped one by one in float64, in any form of the physics: the reference."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from .arrays import FloatArray, IntArray
from .assembly import Assembly
from .dynamics import Pull, Skull, add_basis_forces, advance, workspace
from .face import FaceState
from .force_basis import ride_jaw
from .lag import lagged
from .lids import stand_lids
from .skull import pose_held, pose_skull
from .timeline import TICKS_PER_SECOND
from .top_speed import ALONG_AN_AXIS, held_back


class Alone:
    """Steps faces of one rig and model, each with kernel calls of its own."""

    def __init__(self, assembly: Assembly, *, farthest: float) -> None:
        """Take a rig.

        Args:
            assembly: The rig and model, compiled.
            farthest: Displacement from which a face counts as lost, mm.
        """
        self._assembly, self._farthest = assembly, farthest
        self._still = np.zeros((3, assembly.tissue.node_count))

    def step(self, faces: Sequence[FaceState], pool: ThreadPoolExecutor | None) -> None:
        """Advance every face by a tick."""
        if pool is not None and len(faces) > 1:
            list(pool.map(self._step, faces))
        else:
            for face in faces:
                self._step(face)

    def settle(self, face: FaceState) -> None:
        """Bring what others read of a face up to date."""
        if face.skull is not None:
            face.targets = face.skull.targets

    def leave(self, face: FaceState) -> None:
        """Let a face go to sleep or to another simulator."""
        self.settle(face)
        face.skull, face.posed, face.work = None, None, None

    def displacements(self, face: FaceState, jaw: FloatArray) -> FloatArray:
        """Return the surface from rest, mm, shape (s, 3), with the jaw at pitch, yaw, thrust."""
        return surface_of(self._assembly, face.x, jaw)

    def skull(self, face: FaceState) -> Skull:
        """Return the skull side of a face as it stands."""
        return face.skull or skull_of(self._assembly, face)

    def _step(self, state: FaceState) -> None:
        command = state.mixer.at(state.tick)
        assembly = self._assembly
        state.signals = lagged(state.signals, command, assembly.smoothing, assembly.stride)
        carried = self._pose(state)
        skull, pull = self._forces(state)
        before = state.x.copy()
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
        farthest = float(np.abs(state.x - before).max())
        if farthest > ALONG_AN_AXIS:
            state.x, state.v = held_back(state.x, state.v, before)
            farthest = float(np.abs(state.x - before).max())
        state.speed = farthest * TICKS_PER_SECOND
        gone = float(np.abs(state.x - assembly.tissue.arrays.rest).max())
        state.lost = not gone < self._farthest  # also true for NaN

    def _pose(self, state: FaceState) -> tuple[IntArray, FloatArray] | None:
        """Turn the skull side with jaw and lids, and set out the held nodes, if those have moved.

        They travel evenly through the tick: moved at once, at a blink they would send a wave
        through the skin around the eye.

        Returns:
            The held nodes and where they are when the tick ends, None where nothing moves.
        """
        rigid = tuple(float(v) for v in rigid_signals(self._assembly, state))
        before, tissue = state.skull, self._assembly.tissue
        if rigid == state.posed and before is not None:
            state.skull = before._replace(travel=self._still)
            return None
        jaw, lids = rigid[:3], np.array(rigid[3:])
        skull = pose_skull(self._assembly.rig, tissue, jaw, lids)
        at = state.targets if before is None else before.targets
        if at is None:
            at = tissue.arrays.rest[:, -tissue.node_count :]
        skull = skull._replace(travel=skull.targets - at)
        state.skull, state.posed = skull, rigid
        held, places = pose_held(self._assembly.rig, tissue, jaw, lids)
        state.v[:, held] = (places - state.x[:, held]) * TICKS_PER_SECOND
        return held, places

    def _forces(self, state: FaceState) -> tuple[Skull, Pull]:
        assert state.skull is not None
        assembly, m = self._assembly, self._assembly.rig.channels.muscle_count
        activations = state.signals[:m]
        load = state.skull.load.copy()
        add_basis_forces(assembly.basis, assembly.tissue.arrays.grip, activations, load)
        skull, pull = state.skull._replace(load=load), assembly.pull
        if self._assembly.model.forces == "current":
            pull = self._moving_pull(activations, state.signals[m : m + 3])
        return skull, pull

    def _moving_pull(self, activations: FloatArray, jaw: FloatArray) -> Pull:
        """Return the active muscles for mode "current", their ends where the jaw has carried them.

        Args:
            activations: Shape (m,).
            jaw: Pitch and yaw, degrees, thrust, mm, shape (3,).
        """
        active, pull = activations != 0.0, self._assembly.pull
        moving = Pull(
            pull.kinds[active],
            pull.shape[active],
            pull.scale[active] * activations[active],
            pull.share[active],
        )
        if not jaw.any():
            return moving
        pitch, yaw, thrust = (float(value) for value in jaw)
        return ride_jaw(
            moving, self._assembly.rides[active], self._assembly.rig.jaw, (pitch, yaw, thrust)
        )


def rigid_signals(assembly: Assembly, face: FaceState) -> FloatArray:
    """Return jaw pitch, yaw, degrees, thrust, mm, and the four lid angles, degrees, shape (7,).

    The lids' follow from where the skin stands now: no state of their own is kept.
    """
    channels = assembly.rig.channels
    m = channels.muscle_count
    own = np.einsum("m,msl->sl", face.signals[:m], assembly.lid_angles)
    pitch = float(face.signals[channels.index("gaze", "pitch")])
    lids = assembly.tissue.lids
    skin = lids.skin_angles(face.x)
    angles = stand_lids(own, pitch, skin, assembly.lid_shares, lids.opening)
    return np.concatenate([face.signals[m : m + 3], angles.ravel()])


def skull_of(assembly: Assembly, face: FaceState) -> Skull:
    """Return the skull side with jaw and lids as they stand now."""
    rigid = rigid_signals(assembly, face)
    return pose_skull(assembly.rig, assembly.tissue, list(rigid[:3]), rigid[3:])


def surface_of(assembly: Assembly, x: FloatArray, jaw: FloatArray) -> FloatArray:
    """Return displacements of the sheet and of what follows it, mm, shape (s, 3).

    Args:
        assembly: The rig.
        x: Positions, mm, shape (3, nodes).
        jaw: Pitch and yaw, degrees, thrust, mm, shape (3,).
    """
    head, n = assembly.rig.head, assembly.tissue.node_count
    sheet = (x[:, :n] - assembly.tissue.arrays.rest[:, :n]).T
    followers = head.points[n:]
    pitch, yaw, thrust = (float(value) for value in jaw)
    rigid = assembly.rig.jaw.move(followers, np.ones(len(followers)), pitch, yaw, thrust)
    following = head.follow @ sheet + head.follow_jaw[:, None] * (rigid - followers)
    return np.concatenate([sheet, following])
