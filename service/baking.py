"""Textures baked in a process, which live faces do not feel: it holds no interpreter of theirs."""

from __future__ import annotations

import pickle
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from engine import Cancelled, Rig

from .apart import bound, environment
from .bystanders import Bystanders

_MODULE = "bake_process"
_LOOK_SECONDS = 0.1


def baked_apart(
    rig: Rig,
    cancelled: Callable[[], bool] | None = None,
    *,
    bystanders: Bystanders | None = None,
) -> dict[str, bytes]:
    """Return a rig's textures by file name, as `bake_textures` does.

    Args:
        rig: Whose textures.
        cancelled: Asked again and again whether to stop.
        bystanders: Where it is meanwhile.

    Raises:
        Cancelled: `cancelled` said so.
        OSError: If no process can be started, or it ended by itself.
    """
    with (
        subprocess.Popen(
            bound(_MODULE),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=environment(),
        ) as process,
        _among(bystanders or Bystanders(), process.pid),
    ):
        assert process.stdin is not None
        with suppress(BrokenPipeError), process.stdin:  # It has ended, which is seen below.
            pickle.dump(rig, process.stdin)
        process.stdin = None  # `communicate` would look after it.
        answer: bytes | None = None
        while answer is None:
            try:
                answer, _ = process.communicate(timeout=_LOOK_SECONDS)
            except subprocess.TimeoutExpired:
                if cancelled is not None and cancelled():
                    process.kill()
                    raise Cancelled("the bake was stopped") from None
    if process.returncode != 0:
        raise OSError(f"the process that baked textures ended with {process.returncode}")
    files: dict[str, bytes] = pickle.loads(answer)
    return files


@contextmanager
def _among(bystanders: Bystanders, process: int) -> Iterator[None]:
    bystanders.add(process)
    try:
        yield
    finally:
        bystanders.remove(process)
