"""The search of the inverse: Gauss-Newton steps on simulated faces, within bounds.

In a trust region (Nocedal and Wright, "Numerical Optimization", 2006, chapters 4 and 10), each step
a bounded linear problem (scipy's `lsq_linear`) with Tikhonov's regularisation. The first slopes are
the rig's response from rest; Broyden's rank-one updates follow the tissue's non-linearity, and
faces perturbed around the iterate, settled side by side, renew those that matter.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..frame import Frame
from ..simulator import Simulator
from .controls import Controls
from .goal import Goal
from .response import Response

PERTURBATION = 0.06
"""Share of its full scale by which a control is moved to see its slope."""
SETTLE_TICKS, PERTURBED_TICKS = 24, 16
"""Ticks that faces are given to settle after a step, and after a perturbation."""
STEP_FADE = 0.08
FIRST_REGION = 0.8
"""Radius of the first trust region, in full scales of any one control."""
RENEWED_AT = 2
"""Iteration before which slopes are first simulated anew."""
MOST_RENEWALS = 2
RENEWED_CONTROLS = 20
"""Controls whose slopes are simulated anew: those that act, or are about to, most."""
CONVERGED = 0.02
"""Relative gain of an iteration, with fresh slopes, at which the search ends."""
CLOSE_MM = 0.008
"""Root mean squared misfit at which it ends in any case."""


class Search:
    """The iterate, its face, and the slopes around it.

    Attributes:
        simulator: The faces that are tried.
        values: The iterate: controls in full scales, shape (c,).
        iterations: Steps taken.
        converged: Whether nothing was left to gain.
    """

    def __init__(
        self,
        goal: Goal,
        controls: Controls,
        response: Response,
        regularization: float,
        simulator: Simulator,
    ) -> None:
        self._goal = goal
        self._controls = controls
        self._effort = regularization
        self.simulator = simulator
        self._faces = 0
        self._region = FIRST_REGION
        self._slopes = goal.slopes(controls.fields(response))
        self._fresh = False
        self._renewals = 0
        self.iterations = 0
        self.converged = False
        self.values = np.clip(np.zeros(len(controls.lower)), controls.lower, controls.upper)
        self._face = self._new_face()
        simulator.add(self._face)
        self._misfit = goal.residuals(simulator.frame(self._face).displacements)

    def advance(self) -> bool:
        """Take one step and return whether the search is over."""
        step = self._step()
        if self.iterations == RENEWED_AT and not self._renewals:
            self._renew(step)
            step = self._step()
        self.iterations += 1
        if np.abs(step).max() < 1e-4:
            return self._stuck(step)
        shares = (1.0, 0.4)
        tried = self._tried([self.values + share * step for share in shares])
        costs = [
            self._cost(self.values + share * step, misfit)
            for share, (_, misfit) in zip(shares, tried, strict=True)
        ]
        best = int(np.argmin(costs))
        before = self._cost(self.values, self._misfit)
        moved = shares[best] * step
        self._update(moved, tried[best][1] - self._misfit)
        for index, (face, _) in enumerate(tried):
            if index != best or costs[best] >= before:
                self.simulator.remove(face)
        if costs[best] >= before:
            self._region *= 0.35
            return self._stuck(step)
        gain = 1.0 - costs[best] / before
        self._region = min(self._region * (1.6 if best == 0 else 0.7), 2.0)
        self.simulator.remove(self._face)
        self._face, self._misfit = tried[best]
        self.values = self.values + moved
        if self._is_close():
            self.converged = True
            return True
        if gain < CONVERGED:
            return self._stuck(step)
        self._fresh = False
        return False

    def _is_close(self) -> bool:
        return float(np.sqrt((self._misfit**2).mean())) < CLOSE_MM

    def _stuck(self, step: FloatArray) -> bool:
        """End where slopes are fresh; else renew them and go on."""
        if self._fresh or self._renewals == MOST_RENEWALS:
            self.converged = True
            return True
        self._renew(step)
        return False

    def _cost(self, values: FloatArray, misfit: FloatArray) -> float:
        return float(misfit @ misfit + self._effort**2 * (values @ values))

    def _step(self) -> FloatArray:
        """Solve the linear problem within the bounds and the trust region, shape (c,)."""
        from scipy.optimize import lsq_linear  # Here: a start does without.

        count = len(self.values)
        matrix = np.vstack([self._slopes, self._effort * np.eye(count)])
        right = -np.concatenate([self._misfit, self._effort * self.values])
        low = np.maximum(self._controls.lower - self.values, -self._region)
        high = np.minimum(self._controls.upper - self.values, self._region)
        # A variable on its bound has no room on one side; the solver wants a little.
        solution = lsq_linear(matrix, right, (low - 1e-12, high + 1e-12), method="bvls").x
        return np.asarray(np.clip(solution, low, high))

    def _tried(self, places: Sequence[FloatArray]) -> list[tuple[str, FloatArray]]:
        """Settle a face at each of `places`; return them with their misfits."""
        faces = []
        for values in places:
            face = self._new_face()
            self.simulator.branch(self._face, face)
            self.simulator.apply(face, self._controls.keyframe(values, STEP_FADE))
            faces.append(face)
        for _ in range(SETTLE_TICKS):
            self.simulator.step()
        return [(face, self._misfit_of(self.simulator.frame(face))) for face in faces]

    def _misfit_of(self, frame: Frame) -> FloatArray:
        misfit = self._goal.residuals(frame.displacements)
        return np.full_like(misfit, 1e6) if frame.diverged else misfit

    def _update(self, moved: FloatArray, change: FloatArray) -> None:
        """Broyden's update: the slopes now explain the step that was taken."""
        if np.abs(change).max() < 1e5:
            error = change - self._slopes @ moved
            self._slopes = self._slopes + np.outer(error, moved) / (moved @ moved)

    def _renew(self, step: FloatArray) -> None:
        """Simulate the slopes around the iterate: perturbed faces, settled side by side.

        Args:
            step: Where the search is about to go; tells which controls matter.
        """
        simulator, base = self.simulator, self._new_face()
        matters = np.maximum(np.abs(self.values), np.abs(self.values + step))
        chosen = np.argsort(-matters, kind="stable")[:RENEWED_CONTROLS]
        simulator.branch(self._face, base)
        nudged: list[tuple[int, float, str]] = []
        for index in (int(control) for control in chosen):
            value = self.values[index]
            nudge = (
                PERTURBATION
                if value + PERTURBATION <= self._controls.upper[index]
                else -PERTURBATION
            )
            values = self.values.copy()
            values[index] += nudge
            face = self._new_face()
            simulator.branch(self._face, face)
            simulator.apply(face, self._controls.keyframe(values, 0.0))
            nudged.append((index, nudge, face))
        for _ in range(PERTURBED_TICKS):
            simulator.step()
        here = self._misfit_of(simulator.frame(base))
        for index, nudge, face in nudged:
            self._slopes[:, index] = (self._misfit_of(simulator.frame(face)) - here) / nudge
            simulator.remove(face)
        simulator.remove(base)
        self._fresh = True
        self._renewals += 1

    def _new_face(self) -> str:
        self._faces += 1
        return str(self._faces)
