"""Gaps of the machine: seen where a process is stopped, and of the length that it was."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time
from pathlib import Path

import pytest

from service import gaps
from service.gaps import gaps_seen, stolen_seconds


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


def test_stolen_time_is_read_in_seconds_where_it_is_told(tmp_path: Path) -> None:
    stat = tmp_path / "stat"
    stat.write_text("cpu  255216 104655 35341 128701 682 0 800 250 0 0\ncpu0 1 2 3\n")
    assert stolen_seconds(stat) == 250 / os.sysconf("SC_CLK_TCK")
    for text in ("", "cpu  1 2 3", "intr 1 2 3 4 5 6 7 8", "cpu 1 2 3 4 5 6 7 many"):
        stat.write_text(text)
        assert stolen_seconds(stat) is None
    assert stolen_seconds(tmp_path / "none") is None
