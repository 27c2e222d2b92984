"""How a clip came about: all that it takes to play it again, as its file carries it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from .clip import Clip
from .errors import EngineError, InvalidTrack
from .rig import Model
from .sources import ENGINE_HASH
from .timeline import Timeline
from .version import version

Origin = Mapping[str, Any]
"""Where a rig comes from: "root", a rig with a name, and "steps", the changes that lead from it."""

_NOWHERE: Origin = {"root": None, "steps": []}


@dataclass(frozen=True)
class Performance:
    """What a clip plays, and who.

    Attributes:
        version: Of Risorius that made it.
        engine: Hash of the engine that made it: the same one makes the same bits.
        rig: Its "id", "name" and "recipe", and where it comes from: "root" and "steps".
        level: Of detail.
        model: Forms of the physics.
        fps: Frames a second.
        start: Seconds of the timeline that the clip leaves out.
        timeline: What is played, idle life included.
        seed: Of what was drawn by chance, if anything was.
        file: How the file was asked for.
    """

    version: str
    engine: str
    rig: Mapping[str, Any]
    level: str
    model: Model
    fps: int
    start: float
    timeline: Timeline
    seed: int | None = None
    file: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        clip: Clip,
        *,
        origin: Origin | None = None,
        seed: int | None = None,
        file: Mapping[str, Any] | None = None,
    ) -> Performance | None:
        """Return how a clip came about; None of one that was put together from frames.

        Args:
            clip: What was recorded.
            origin: Where its rig comes from.
            seed: Of its idle life.
            file: How the file is asked for.
        """
        if clip.timeline is None or clip.model is None:
            return None
        recipe = clip.rig.recipe.to_json() if clip.rig.recipe else None
        rig = {"id": clip.rig.id, "name": clip.rig.name, "recipe": recipe}
        return cls(
            version=version(),
            engine=ENGINE_HASH,
            rig={**rig, **_NOWHERE, **(origin or {})},
            level=clip.rig.level,
            model=clip.model,
            fps=clip.fps,
            start=clip.start,
            timeline=clip.timeline,
            seed=seed,
            file=dict(file or {}),
        )

    def to_json(self) -> dict[str, Any]:
        """Return it as `from_json` reads it."""
        return {
            "version": self.version,
            "engine": self.engine,
            "rig": dict(self.rig),
            "level": self.level,
            "model": asdict(self.model),
            "fps": self.fps,
            "start": self.start,
            "seed": self.seed,
            "file": dict(self.file),
            **self.timeline.to_json(),
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Performance:
        """Read what `to_json` wrote.

        Raises:
            InvalidTrack: If it cannot be read, with what is wrong.
        """
        try:
            return cls(
                version=str(data["version"]),
                engine=str(data["engine"]),
                rig={"recipe": None, **_NOWHERE, **data["rig"]},
                level=str(data["level"]),
                model=Model(**data["model"]),
                fps=int(data["fps"]),
                start=float(data["start"]),
                timeline=Timeline.from_json(data),
                seed=None if data.get("seed") is None else int(data["seed"]),
                file=dict(data.get("file", {})),
            )
        except InvalidTrack:
            raise
        except (EngineError, KeyError, TypeError, ValueError) as error:
            raise InvalidTrack(f"its performance cannot be read: {error}") from error
