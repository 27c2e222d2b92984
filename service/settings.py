"""The settings of the service: one field, one RISORIUS_ variable, one sentence."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

from pydantic import Field, field_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

Names = Annotated[tuple[str, ...], NoDecode]


def _user_folder(variable: str, fallback: str) -> Path:
    base = os.environ.get(variable)
    return (Path(base) if base else Path.home() / fallback) / "risorius"


def _cache_folder() -> Path:
    return _user_folder("XDG_CACHE_HOME", ".cache")


def _data_folder() -> Path:
    return _user_folder("XDG_DATA_HOME", ".local/share")


def _cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _cores_for_faces() -> int:
    """Return how many cores live faces may have: all but one, for the event loop and its sockets.

    With two cores and two threads, one tick in fifty was late at two thirds of the load that one
    thread bears with one in two thousand: who holds the interpreter waited for a core.
    """
    return max(1, _cores() - 1)


class Settings(BaseSettings):
    """Everything that can be set, from the environment or by keyword."""

    model_config = SettingsConfigDict(env_prefix="RISORIUS_", extra="ignore", frozen=True)

    host: str = Field(default="127.0.0.1", description="Address to listen on.")
    port: int = Field(
        default=8000, ge=0, le=65535, description="Port to listen on; 0 takes a free one."
    )
    allowed_hosts: Names = Field(
        default=(), description="Host names answered besides localhost and `host`, comma separated."
    )
    allowed_origins: Names = Field(
        default=(),
        description="Origins of other web pages that may drive faces, as https://name:port, "
        "comma separated.",
    )
    api_keys: Names = Field(
        default=(), description="Keys beside those of `risorius keys`, comma separated."
    )
    make_key: bool = Field(
        default=False,
        description="Whether a start without any key makes one, and prints it this once.",
    )
    key_sessions: int = Field(
        default=128, ge=1, description="Most sessions that one key has open at once."
    )
    key_viewers: int = Field(
        default=512, ge=1, description="Most sockets open at once on the sessions of one key."
    )
    key_clip_seconds: float = Field(
        default=14_400.0,
        gt=0,
        allow_inf_nan=False,
        description="Most seconds of clips that one key asks for in an hour.",
    )
    key_upload_bytes: int = Field(
        default=1_000_000_000,
        ge=1,
        description="Most bytes that one key sends as bodies in an hour.",
    )
    data_dir: Path = Field(
        default_factory=_data_folder, description="Folder of the database and of rendered clips."
    )
    cache_dir: Path = Field(
        default_factory=_cache_folder,
        description="Folder of files that can be made again: compiled rigs and their GLB files.",
    )
    database_url: str = Field(
        default="",
        description="SQLAlchemy URL of the database; empty is a SQLite file in the data folder.",
    )
    viewer_dir: Path = Field(
        default=Path(__file__).parent / "viewer", description="Folder of the built viewer."
    )
    max_body_bytes: int = Field(
        default=4_000_000, ge=1024, description="Largest request body accepted, in bytes."
    )
    max_upload_bytes: int = Field(
        default=256_000_000, ge=1024, description="Largest tracker's file accepted, in bytes."
    )
    max_message_bytes: int = Field(
        default=65_536, ge=1024, description="Largest WebSocket message accepted, in bytes."
    )
    max_sessions: int = Field(default=256, ge=1, description="Most sessions open at once.")
    max_viewers: int = Field(default=64, ge=1, description="Most sockets open on one session.")
    max_rigs: int = Field(default=1000, ge=1, description="Most derived rigs kept.")
    max_cache_bytes: int = Field(
        default=1_000_000_000,
        ge=0,
        description="Most bytes of GLB files kept in the cache folder, and of pictures.",
    )
    max_clips: int = Field(default=1000, ge=1, description="Most clips kept, whatever their state.")
    max_queued_clips: int = Field(
        default=32, ge=1, description="Most clips waiting or being rendered."
    )
    max_clip_seconds: float = Field(
        default=120.0, gt=0, allow_inf_nan=False, description="Longest clip accepted, in seconds."
    )
    max_keyframes: int = Field(
        default=10_000, ge=1, description="Most keyframes accepted in one clip."
    )
    clip_days: float = Field(
        default=30.0,
        gt=0,
        allow_inf_nan=False,
        description="Days that a clip is kept once it has ended.",
    )
    max_queued_analyses: int = Field(
        default=16, ge=1, description="Most analyses and inverses waiting or being computed."
    )
    max_queued_expressions: int = Field(
        default=16, ge=1, description="Most expressions waiting or being made without a session."
    )
    session_idle_seconds: float = Field(
        default=21_600.0,
        gt=0,
        allow_inf_nan=False,
        description="A session without viewer or command is closed after this time.",
    )
    requests_per_second: float = Field(
        default=500.0,
        gt=0,
        allow_inf_nan=False,
        description="Requests and socket messages a second accepted from one client.",
    )
    capacity_share: float = Field(
        default=0.7,
        gt=0,
        allow_inf_nan=False,
        description="Share of a tick that faces that move may take, as measured, before new "
        "sessions are refused; 1000 refuses none.",
    )
    simulation_threads: int = Field(
        default_factory=_cores_for_faces,
        ge=1,
        description="Threads that live faces are spread over.",
    )
    render_processes: int = Field(
        default=1,
        ge=1,
        description="Clips rendered at the same time, each in a process of its own.",
    )

    @field_validator("allowed_hosts", "allowed_origins", "api_keys", mode="before")
    @classmethod
    def _split(cls, value: object) -> object:
        """Read a comma-separated list."""
        if isinstance(value, str):
            return tuple(part.strip() for part in value.split(",") if part.strip())
        return value

    @property
    def database(self) -> str:
        """The URL of the database."""
        return self.database_url or f"sqlite:///{self.data_dir / 'risorius.sqlite3'}"

    @property
    def clips_folder(self) -> Path:
        """Where the files of clips are, and trackers' files until their clips are done."""
        return self.data_dir / "clips"
