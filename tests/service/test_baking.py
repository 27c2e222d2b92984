"""Textures baked in a process: the same files, and an end when they are not wanted any more."""

import signal
import subprocess
from typing import Any

import pytest

import engine.textures
from engine import Cancelled, builtin_rig
from service.baking import baked_apart


def test_a_process_that_ends_by_itself_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.baking._MODULE", "no_such_module")
    with pytest.raises(OSError, match="ended with 1"):
        baked_apart(builtin_rig("paper"))


def test_a_bake_that_nobody_wants_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[subprocess.Popen[bytes]] = []

    class Noted(subprocess.Popen[bytes]):
        def __init__(self, *args: Any, **options: Any) -> None:
            started.append(self)
            super().__init__(*args, **options)

    monkeypatch.setattr("service.baking.subprocess.Popen", Noted)
    with pytest.raises(Cancelled):
        baked_apart(builtin_rig("standard"), lambda: True)
    assert [process.returncode for process in started] == [-signal.SIGKILL]


def test_textures_are_baked_by_whom_the_caller_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine.textures, "cached_arrays", lambda kind, key, build: build())
    files = engine.textures.textures_of(
        builtin_rig("standard"), bake=lambda rig, cancelled: {"albedo.jpg": rig.name.encode()}
    )
    assert files == {"albedo.jpg": b"standard"}
