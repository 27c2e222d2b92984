"""The inverse: which muscles, and what jaw, bring a face's landmarks where they are wanted."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..rig import Model, Rig
from ..settling import Progress
from ..simulator import Simulator
from ..timeline import TICKS_PER_SECOND
from .controls import Controls, controls_of
from .goal import Goal, check_number, goal_of
from .response import Response, response_of
from .search import Search

REGULARIZATION_MM = 0.8
"""Default weight of effort over the root of the number of targets: full activation of one muscle
costs as much as this misfit of one of them. Few landmarks are moved by few muscles so."""
MOST_ITERATIONS = 30
LEAST = 0.001
"""Activation and intensity under which a control is left out of the answer."""


@dataclass(frozen=True)
class Reached:
    """One landmark: where it was wanted, and where it is.

    Attributes:
        name: As it was asked for.
        target: Displacement from rest, mm; NaN where an axis was left open.
        reached: The same as simulated, mm.
        residual: Distance left on the axes that were asked for, mm.
    """

    name: str
    target: tuple[float, float, float]
    reached: tuple[float, float, float]
    residual: float


@dataclass(frozen=True)
class Inverse:
    """The controls that bring landmarks nearest to where they were wanted.

    Attributes:
        rig: Id of the rig.
        activations: Of each muscle that acts, up to 1.5, as a keyframe's `muscles` takes them.
        action_units: Intensity of each unit, where units were searched; empty otherwise.
        jaw: Pitch and yaw, degrees, thrust, mm.
        landmarks: Target, reached place and residual of each.
        rms: Root of the weighted mean squared residual, mm.
        iterations: Gauss-Newton steps taken.
        converged: Whether it ended because nothing was left to gain.
    """

    rig: str
    activations: Mapping[str, float]
    action_units: Mapping[str, float]
    jaw: Mapping[str, float]
    landmarks: tuple[Reached, ...]
    rms: float
    iterations: int
    converged: bool

    def to_json(self) -> dict[str, object]:
        """Return it as plain data, rounded for reading."""
        return {
            "rig": self.rig,
            "activations": {name: round(v, 4) for name, v in self.activations.items()},
            "action_units": {name: round(v, 4) for name, v in self.action_units.items()},
            "jaw": {axis: round(v, 3) for axis, v in self.jaw.items()},
            "landmarks": [
                {
                    "name": mark.name,
                    "target": [None if math.isnan(v) else round(v, 3) for v in mark.target],
                    "reached": [round(v, 3) for v in mark.reached],
                    "residual_mm": round(mark.residual, 3),
                }
                for mark in self.landmarks
            ],
            "rms_mm": round(self.rms, 4),
            "iterations": self.iterations,
            "converged": self.converged,
        }


@dataclass(frozen=True, eq=False)
class Question:
    """What is asked of the inverse, checked.

    Attributes:
        goal: Where landmarks are wanted.
        controls: What may be moved.
        regularization: Misfit of one landmark, mm, that a full activation is worth.
        iterations: Most Gauss-Newton steps.
    """

    goal: Goal
    controls: Controls
    regularization: float
    iterations: int


def question_of(
    rig: Rig,
    targets: Mapping[str, Sequence[float | None]],
    *,
    weights: Mapping[str, float] | None = None,
    muscles: Sequence[str] | None = None,
    units: Sequence[str] | None = None,
    jaw: bool = True,
    regularization: float | None = None,
    iterations: int = 12,
) -> Question:
    """Return what is asked, checked before anything is simulated; see `invert`.

    Raises:
        UnknownName: For a landmark, muscle or unit that the rig does not have.
        InvalidValue: For targets, weights or settings that cannot be used.
    """
    goal = goal_of(rig, targets, weights or {})
    controls = controls_of(rig, muscles, units, jaw=jaw)
    if regularization is None:
        regularization = REGULARIZATION_MM / math.sqrt(len(targets))
    check_number("regularization", regularization, 0.0, 100.0)
    check_number("iterations", iterations, 1, MOST_ITERATIONS)
    return Question(goal, controls, regularization, iterations)


def invert(
    rig: Rig,
    targets: Mapping[str, Sequence[float | None]],
    *,
    weights: Mapping[str, float] | None = None,
    muscles: Sequence[str] | None = None,
    units: Sequence[str] | None = None,
    jaw: bool = True,
    regularization: float | None = None,
    iterations: int = 12,
    model: Model | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Inverse:
    """Return the controls that bring landmarks nearest to their targets, as simulated.

    Args:
        rig: Whose face.
        targets: Displacement from rest by landmark (see `named_point`), mm, head frame; None
            leaves an axis open, as a camera leaves depth.
        weights: Of landmarks, 1 where not named.
        muscles: Those that may be used, with or without side; all but air if None.
        units: Action units to search in place of muscles ("AU12", "L12").
        jaw: Whether the jaw may move, but for what the units themselves move of it.
        regularization: Misfit of one landmark, mm, that one muscle's full activation is worth;
            `REGULARIZATION_MM` over the root of the number of targets if None.
        iterations: Most Gauss-Newton steps.
        model: Forms of the physics; the rig's own, as live faces run them, if None.
        threads: Faces stepped at a time; None takes one a core.
        progress: Told the share of the work done, 0 to 1; may raise to stop it.

    Raises:
        UnknownName: For a landmark, muscle or unit that the rig does not have.
        InvalidValue: For targets, weights or settings that cannot be used.
    """
    question = question_of(
        rig,
        targets,
        weights=weights,
        muscles=muscles,
        units=units,
        jaw=jaw,
        regularization=regularization,
        iterations=iterations,
    )
    slow = progress or _tell_nobody
    response = response_of(rig, model, threads=threads, progress=lambda share: slow(0.5 * share))
    return search_for(
        rig,
        question,
        response,
        model=model,
        threads=threads,
        progress=lambda share: slow(0.5 + 0.5 * share),
    )


def search_for(
    rig: Rig,
    question: Question,
    response: Response,
    *,
    model: Model | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Inverse:
    """Return the answer to a question, from how the rig's surface answers each muscle.

    Args:
        rig: Whose face.
        question: From `question_of`.
        response: From `response_of`, of the same rig and model.
        model: Forms of the physics; the rig's own, as live faces run them, if None.
        threads: Faces stepped at a time; None takes one a core.
        progress: Told the share of the search done, 0 to 1; may raise to stop it.
    """
    slow = progress or _tell_nobody
    simulator = Simulator(rig, model=model or rig.model.live, threads=threads)
    search = Search(question.goal, question.controls, response, question.regularization, simulator)
    for step in range(question.iterations):
        slow(step / question.iterations)
        if search.advance():
            break
    return _answer(rig, question.goal, question.controls, search)


def _answer(rig: Rig, goal: Goal, controls: Controls, search: Search) -> Inverse:
    """Play the controls on a face at rest, as a client will, and say where its landmarks come."""
    simulator = search.simulator
    simulator.add("answer")
    simulator.apply("answer", controls.keyframe(search.values, 0.15))
    for _ in range(TICKS_PER_SECOND):
        simulator.step()
    frame = simulator.frame("answer")
    reached = frame.displacements[goal.points]
    misfit = np.where(goal.known, reached - goal.wanted, 0.0)
    distance = np.linalg.norm(misfit, axis=1)
    units = search.values[: len(controls.units)] if controls.units else ()
    return Inverse(
        rig=rig.id,
        activations={
            name: float(value)
            for name, value in zip(rig.muscle_names, frame.activations, strict=True)
            if abs(value) > LEAST
        },
        action_units={k: float(v) for k, v in zip(controls.units, units, strict=True) if v > LEAST},
        jaw={
            "pitch": frame.pose.jaw_pitch,
            "yaw": frame.pose.jaw_yaw,
            "thrust": frame.pose.jaw_thrust,
        },
        landmarks=tuple(
            Reached(name, _triple(want), _triple(got), float(left))
            for name, want, got, left in zip(
                goal.names, goal.wanted, reached, distance, strict=True
            )
        ),
        rms=float(np.sqrt((goal.weights * distance**2).sum() / goal.weights.sum())),
        iterations=search.iterations,
        converged=search.converged,
    )


def _triple(values: FloatArray) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _tell_nobody(_share: float) -> None:
    """Take no interest in progress."""
