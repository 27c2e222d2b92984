"""Gaps of the machine: seen where a process is stopped, and of the length that it was."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time

import pytest

from service import gaps
from service.gaps import gaps_seen


def test_a_process_that_is_stopped_for_a_while_sees_a_gap(monkeypatch: pytest.MonkeyPatch) -> None:
    start = subprocess.Popen

    def stopped_for_a_while(*args: object, **options: object) -> subprocess.Popen[str]:
        process = start(*args, **options)  # type: ignore[call-overload]

        def stop() -> None:
            time.sleep(1.0)
            os.kill(process.pid, signal.SIGSTOP)
            time.sleep(0.5)
            os.kill(process.pid, signal.SIGCONT)

        threading.Thread(target=stop).start()
        return process  # type: ignore[no-any-return]

    monkeypatch.setattr(gaps.subprocess, "Popen", stopped_for_a_while)
    seen = gaps_seen(2.0, least=0.3, cores=1)
    assert seen
    assert 0.4 < seen[-1] < 1.5


def test_a_process_that_fails_is_told() -> None:
    with pytest.raises(OSError, match="ended by itself"):
        gaps_seen(float("nan"), least="none", cores=1)  # type: ignore[arg-type]
