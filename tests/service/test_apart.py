"""Processes of the service's own code beside it: each can be run, and ends with its owner."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

import service
from service.apart import bound, environment

MODULES = sorted(path.stem for path in Path(service.__file__).parent.glob("*_process.py"))


@pytest.mark.parametrize("module", MODULES)
def test_each_can_be_run_by_its_name(module: str) -> None:
    assert callable(importlib.import_module(f"service.{module}").main)
    assert bound(module)[-2:] == (str(os.getpid()), module)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ends a process with its owner")
def test_one_whose_owner_has_ended_already_does_not_begin() -> None:
    *command, _owner, _module = bound("nothing")
    env = environment()
    for owner, ended in ((1, 0), (os.getpid(), 1)):  # There is no such module to be run.
        done = subprocess.run([*command, str(owner), "nothing"], env=env, capture_output=True)
        assert done.returncode == ended, done.stderr
