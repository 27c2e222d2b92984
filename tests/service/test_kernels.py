"""Kernels are compiled beside a first start, once, by a process that ends with the service."""

from __future__ import annotations

import asyncio
import time
from pathlib import Path

import pytest

import engine
from service import kernels
from service.kernels import compile_sweep


@pytest.fixture
def never_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernels, "kernels_are_kept", lambda: False)


def test_a_process_compiles_what_is_not_kept(
    never_compiled: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    done = tmp_path / "done"
    script = f"import engine; open({str(done)!r}, 'w').write(engine.__file__)"
    monkeypatch.setattr(kernels, "_SCRIPT", script)
    asyncio.run(compile_sweep())
    assert done.read_text() == engine.__file__


def test_what_is_kept_takes_no_process(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    done = tmp_path / "done"
    monkeypatch.setattr(kernels, "_SCRIPT", f"open({str(done)!r}, 'w')")
    monkeypatch.setattr(kernels, "kernels_are_kept", lambda: True)
    asyncio.run(compile_sweep())
    assert not done.exists()


def test_where_no_process_can_be_had_a_start_goes_on(
    never_compiled: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kernels.sys, "executable", "/nowhere/python")
    asyncio.run(compile_sweep())


def test_a_service_that_stops_takes_the_process_along(
    never_compiled: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    mark = tmp_path / "alive"
    loop = f"import time\nwhile True: open({str(mark)!r}, 'w').write('.'); time.sleep(0.02)"
    monkeypatch.setattr(kernels, "_SCRIPT", loop)

    async def stopped() -> None:
        task = asyncio.create_task(compile_sweep())
        while not mark.exists():
            await asyncio.sleep(0.02)
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)

    asyncio.run(stopped())
    mark.unlink()
    time.sleep(0.2)
    assert not mark.exists()
