"""Who stands back: every thread of a process, and what it starts, also where it might go first."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from service.priority import BEHIND

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux has priorities so")
HOME = Path(__file__).parents[2]
STARTS = """
import os, subprocess, threading
from service.priority import stand_back_wholly, stay_back
go = threading.Event()
threading.Thread(target=go.wait).start()
stand_back_wholly()
stay_back()
print({os.getpriority(os.PRIO_PROCESS, int(task)) for task in os.listdir("/proc/self/task")})
print(subprocess.run(["nice", "-n", "-15", "nice"], stdout=-1, stderr=-3, text=True).stdout)
go.set()
"""


def test_what_a_process_starts_does_not_come_before_it_again() -> None:
    ended = subprocess.run(
        [sys.executable, "-c", STARTS],
        cwd=HOME,
        env={**os.environ, "PYTHONPATH": str(HOME)},
        stdout=subprocess.PIPE,
        text=True,
        timeout=60,
        check=True,
    )
    behind = min(os.getpriority(os.PRIO_PROCESS, 0) + BEHIND, 19)
    threads, started = ended.stdout.split("\n")[:2]
    assert threads == f"{{{behind}}}"
    assert int(started) == behind
