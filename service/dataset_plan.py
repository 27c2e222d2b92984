"""What a data set shows: who does what in each of its clips, drawn by its seed.

A clip's draws depend on the seed and the clip's number alone, so that it is the same whatever was
made before it, beside it, or in another call.
"""

from __future__ import annotations

import hashlib
import random
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, TypeVar

from engine import ENGINE_HASH, Rig, broken_rules, lexicon, people, version

from .bodies import EmotionCommand
from .deriving import Steps
from .emotions import play_emotion
from .facs import written

Each = TypeVar("Each")
REST_SECONDS = (0.1, 0.4)
"""Before the expression begins."""
FADE_SECONDS = (0.15, 0.8)
"""Over which it is taken up; smiles take half a second."""
HOLD_SECONDS = (0.3, 1.2)
FADE_OUT_SECONDS = (0.2, 0.8)
TAIL_SECONDS = 0.3
"""After it has let go, until the clip ends: the tissue settles."""
EMOTION_INTENSITY = (0.3, 1.0)
UNIT_INTENSITY = (0.2, 1.0)
"""The letters A to E, and all between them."""
EMOTION_SHARE = 0.5
"""Of the clips; the others mix action units."""
MOST_UNITS = 5
_RIGID = ("gaze", "head")
"""Regions whose units move no tissue: they are not mixed."""
_TURNS = 32
"""Forms of an emotion that are drawn from, as often as they come in a round."""
_SEEDS = 2**32


@dataclass(frozen=True)
class DatasetPlan:
    """All that the clips of a data set follow from.

    Attributes:
        seed: Of every draw.
        people: Named rigs; empty for the people that come along.
        strangers: How many people are drawn besides, by the seed.
        fps: Frames a second.
        level: Of detail.
        textures: Whether files embed the maps of skin and eyes.
        idle: Whether faces blink, look and sway by themselves.
    """

    seed: int
    people: tuple[str, ...] = ()
    strangers: int = 0
    fps: int = 30
    level: str = "medium"
    textures: bool = False
    idle: bool = False

    def to_json(self) -> dict[str, Any]:
        """Return what two calls must agree on to make one data set."""
        return {
            "version": version(),
            "engine": ENGINE_HASH,
            **asdict(self),
            "people": list(self.cast),
        }

    @property
    def cast(self) -> tuple[str, ...]:
        """The named people who are in it."""
        return self.people or tuple(people())

    def person(self, number: int) -> Person:
        """Return who is in a clip."""
        index = Draws(self.seed, number, "person").below(len(self.cast) + self.strangers)
        if index < len(self.cast):
            return Person(self.cast[index], ())
        drawn = Draws(self.seed, index - len(self.cast), "stranger").below(_SEEDS)
        return Person("standard", ({"recipe": {"sample": drawn}},))

    def shown(self, number: int, rig: Rig) -> Shown:
        """Return what is done in a clip."""
        draws = Draws(self.seed, number, "expression")
        timing = {
            "fade": draws.between(*FADE_SECONDS),
            "hold": draws.between(*HOLD_SECONDS),
            "fade_out": draws.between(*FADE_OUT_SECONDS),
        }
        start = draws.between(*REST_SECONDS)
        if draws.share() < EMOTION_SHARE:
            asked, shown = _emotion(draws, rig, timing)
        else:
            units = _mix(draws, rig)
            asked, shown = {"action_units": units, **timing}, {"action_units": units}
        clip: dict[str, Any] = {
            "fps": self.fps,
            "level": self.level,
            "textures": self.textures,
            "timeline": [{"time": start, **asked}],
            "duration": round(start + sum(timing.values()) + TAIL_SECONDS, 2),
        }
        if self.idle:
            clip["idle"] = {"seed": Draws(self.seed, number, "life").below(_SEEDS)}
        label = {"emotion": None, "intensity": None, "variant": None, **shown}
        label["facs"] = written(shown["action_units"])
        return Shown(clip, {**label, "onset": start, **timing, "duration": clip["duration"]})


@dataclass(frozen=True)
class Person:
    """Who performs: a named rig, and what was changed in it."""

    root: str
    steps: Steps


@dataclass(frozen=True)
class Shown:
    """What is done in a clip.

    Attributes:
        clip: The body of `POST /api/clips`, without the rig.
        label: What its line in the manifest says of it.
    """

    clip: Mapping[str, Any]
    label: Mapping[str, Any]


class Draws:
    """Numbers that follow from a seed, a number and what they are for, and nothing else."""

    def __init__(self, seed: int, number: int, what: str) -> None:
        digest = hashlib.sha256(f"{seed} {number} {what}".encode()).digest()
        self._random = random.Random(int.from_bytes(digest, "little"))

    def share(self) -> float:
        """Return a number from 0 to 1."""
        return self._random.random()

    def below(self, most: int) -> int:
        """Return a whole number from 0 to below `most`."""
        return int(self.share() * most)

    def between(self, least: float, most: float) -> float:
        """Return a number in hundredths."""
        return round(least + (most - least) * self.share(), 2)

    def some(self, among: Sequence[Each], count: int) -> list[Each]:
        """Return `count` different ones, in their order among all."""
        ranked = sorted(range(len(among)), key=lambda _: self.share())
        return [among[index] for index in sorted(ranked[:count])]


def _emotion(
    draws: Draws, rig: Rig, timing: Mapping[str, float]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return an emotion as a keyframe asks for it, and what it shows."""
    names = tuple(lexicon().recipes)
    name, intensity = names[draws.below(len(names))], draws.between(*EMOTION_INTENSITY)
    command: dict[str, Any] = {
        "label": name,
        "intensity": intensity,
        "seed": draws.below(_TURNS),
        "fade_in": timing["fade"],
        "hold": timing["hold"],
        "fade_out": timing["fade_out"],
    }
    played = play_emotion(EmotionCommand.model_validate(command), rig, Counter())
    variant = played.resolved.parts[0].variant if played.resolved.parts else None
    units = {key: round(value, 4) for key, value in played.action_units.items()}
    shown = {"emotion": name, "intensity": intensity, "variant": variant, "action_units": units}
    return {"emotion": command}, shown


def _mix(draws: Draws, rig: Rig) -> dict[str, float]:
    """Return action units that FACS lets be scored together."""
    names = [name for name, unit in rig.action_units.items() if unit.region not in _RIGID]
    while True:
        chosen = draws.some(names, 1 + draws.below(MOST_UNITS))
        units = {name: draws.between(*UNIT_INTENSITY) for name in chosen}
        if not broken_rules(units):
            return units
