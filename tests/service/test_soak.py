"""The soak: its load on a real service, and what it makes of the figures."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path

import pytest
from conftest import settings_in
from typer.testing import CliRunner

import service.soak
from service.app import create_app
from service.cli import app as command_line
from service.metrics import Metrics
from service.server import running
from service.soak import _Soak, memory_trend, table, verdict
from service.soak_client import SoakRefused, read_counts
from service.timing import Times

GOOD = {"overrun_share": 0.0005, "memory_growth_mb": 3.0, "failures": []}


def test_a_short_soak_gives_every_figure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("_SETTLE_SECONDS", "_CHURN_SECONDS", "_TURN_SECONDS", "_SAMPLE_SECONDS"):
        monkeypatch.setattr(service.soak, name, 0.5)
    # One moving face fills this service, so that the capacity is soon found.
    settings = settings_in(tmp_path, capacity_share=1e-6)
    with running(create_app(settings), settings) as url:
        figures = asyncio.run(_Soak(url, 0.8, lambda _: None).run(4.0))
    json.dumps(figures, allow_nan=False)
    assert figures["capacity_faces"] == figures["moving_faces"] == 1
    assert figures["failures"] == []
    # Here it is closed and another opened every half second; one may still move beside it.
    assert 0.0 < figures["awake_faces_mean"] <= 3.0
    for name in ("ticks", "frames_sent", "commands", "sessions_closed", "sessions_refused"):
        assert figures[name] > 0, name
    for name in ("tick", "loop_delay", "command_to_tick", "round_trip"):
        assert 0 <= figures[f"{name}_p50_ms"] <= figures[f"{name}_p99_ms"]
    assert figures["round_trip_p50_ms"] > 0
    assert table(figures).row_count > 20


def test_good_figures_pass() -> None:
    assert verdict(GOOD) == []


@pytest.mark.parametrize(
    ("bad", "said"),
    [
        ({"overrun_share": 0.002}, "0.20% of ticks were late by more than half a tick"),
        ({"memory_growth_mb": 40.0}, "memory grew by 40 MB"),
        ({"failures": ["a command was answered with 500"]}, "1 requests failed, first: a command"),
    ],
)
def test_bad_figures_are_named(bad: dict[str, object], said: str) -> None:
    (sentence,) = verdict({**GOOD, **bad})
    assert sentence.startswith(said)


def test_memory_that_grows_is_seen_and_a_filling_cache_is_not() -> None:
    leak = [(float(second), 3e8 + 1e5 * second) for second in range(300)]
    slope, growth = memory_trend(leak)
    assert slope == pytest.approx(1e5)
    assert growth == pytest.approx(199e5, rel=0.01)
    filling = [(float(second), 3e8 + 1e6 * min(second, 90)) for second in range(300)]
    assert memory_trend(filling)[1] == pytest.approx(0.0, abs=1.0)
    clips = [(float(second), 3e8 + 1e8 * (second % 30 > 26)) for second in range(300)]
    assert memory_trend(clips)[1] == pytest.approx(0.0, abs=1.0)
    assert memory_trend([]) == (0.0, 0.0)


def test_what_the_service_counts_is_read_between_two_moments() -> None:
    metrics, times = Metrics(), Times()
    metrics.watch_times("test_seconds", "A test.", times)
    times.add(0.5)
    before = read_counts(metrics.text().decode())
    times.add(0.0015)
    metrics.frames_sent.inc(3)
    after = read_counts(metrics.text().decode())
    assert after.since(before, "risorius_frames_sent_total") == 3
    assert 0.001 < after.quantile(before, "risorius_test_seconds", 0.99) <= 0.002


def test_no_service_is_refused() -> None:
    with pytest.raises(SoakRefused, match="expected http://name:port"):
        _Soak("localhost:8000", 0.8, lambda _: None)


@pytest.mark.parametrize(("overruns", "code"), [(0.0, 0), (0.5, 1)])
def test_the_command_ends_by_the_verdict(
    monkeypatch: pytest.MonkeyPatch, overruns: float, code: int
) -> None:
    figures = {**GOOD, "overrun_share": overruns, "minutes": 1.0}
    monkeypatch.setattr(service.soak, "soak", lambda **_: figures)
    answer = CliRunner().invoke(command_line, ["soak", "--json"])
    assert answer.exit_code == code
    assert json.loads(answer.stdout) == figures
