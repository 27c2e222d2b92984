"""What each tool answers, as typed results."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, Field


class EmotionLine(BaseModel):
    """An emotion that can be set."""

    label: str
    facs: str = Field(description="The units it plays at intensity 1.")
    also: list[str] = Field(default=[], description="Other words for it.")
    source: str = Field(description="Where the face comes from.")


class UnitLine(BaseModel):
    """An action unit that can be set."""

    unit: str = Field(examples=["AU12"])
    title: str
    shows: str = Field(description="What is seen.")


class PersonLine(BaseModel):
    """A face that can be opened."""

    rig: str
    title: str


class Expressions(BaseModel):
    """What faces can show, and whose."""

    emotions: list[EmotionLine]
    action_units: list[UnitLine]
    people: list[PersonLine]


class OpenedFace(BaseModel):
    """A face that is open."""

    session_id: str = Field(description="Give it to every other tool.")
    viewer_url: str = Field(description="Web page that shows the face live: tell the user.")
    stream_url: str = Field(description="WebSocket of its frames, for programs.")
    rig: str = Field(description="Name of the rig, or its id.")
    owner: str = Field(description="The name under which your commands are held.")


class EmotionSet(BaseModel):
    """An emotion that a face is taking on."""

    recipe: str = Field(description="The FACS string it plays, at intensity 1.")
    action_units: dict[str, float] = Field(description="What it plays, at the intensity asked for.")
    source: str = Field(description="Where this face comes from.")
    label: str | None = Field(description="The label that was found, if one was given.")
    found: str = Field(
        description="How: label, synonym or inflection of a word; scores; or coordinates."
    )
    tick: int = Field(description="When it takes effect, in 1/60 s of the face's own time.")
    owner: str
    warnings: list[str] = Field(description="What is obeyed in part only, and why.")


class UnitsSet(BaseModel):
    """Action units that a face is taking on."""

    facs: str = Field(description="All that you hold of this face now, as FACS.")
    action_units: dict[str, float]
    scale: Literal["linear", "banded"]
    tick: int = Field(description="When it takes effect, in 1/60 s of the face's own time.")
    owner: str
    warnings: list[str] = Field(
        description="Units that clash, are absent, or move nothing; tell the user if it matters."
    )


class WriterState(BaseModel):
    """What one client holds in a layer."""

    owner: str
    facs: str
    emotion: str | None = Field(description="The emotion that it plays, or what it mixes.")
    expires_in: float | None = Field(description="Seconds until it lets go; null if it stays.")


class LayerState(BaseModel):
    """One layer of a face, the later ones over the earlier."""

    layer: Literal["idle", "mood", "emotion", "speech", "puppet"]
    facs: str
    weight: float = Field(description="How much of what lies beneath it overrides, 0 to 1.")
    writers: list[WriterState] = Field(description="The last one is on top.")


class FaceNow(BaseModel):
    """A face as it is commanded now."""

    session_id: str
    viewer_url: str = Field(description="Web page that shows the face live, for the user.")
    rig: str
    facs: str = Field(description="What all layers make together; 0 is rest.")
    action_units: dict[str, float]
    pose: dict[str, dict[str, float]] = Field(
        description="jaw, gaze, head, tongue where they are commanded: degrees, mm of thrust."
    )
    layers: list[LayerState] = Field(description="Those that are held, the lowest first.")
    writers: dict[str, list[str]] = Field(
        description="For each thing that is held the layers that hold it, the lowest first."
    )
    asleep: bool = Field(description="Whether it has come to rest where it is.")
    viewers: int = Field(description="How many watch it.")
    tick: int


class ExportedClip(BaseModel):
    """A clip: done, or on its way."""

    clip_id: str
    status: Literal["queued", "running", "done", "failed", "cancelled"]
    progress: float = Field(description="0 to 1.")
    url: str = Field(
        description="The animated GLB file, once it is done. Give it to the user; where the "
        "service has keys, a download carries one too."
    )
    csv_url: str = Field(description="Ground truth of each frame: units, muscles, 68 landmarks.")
    duration: float | None = Field(description="Seconds; null until it is done.")
    frames: int | None
    bytes: int | None
    warnings: list[str]
    next_step: str | None = Field(description="What to do if it is not done.")
