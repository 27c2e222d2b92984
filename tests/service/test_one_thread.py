"""Matrix products of the service, and of what it starts, have one thread each."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from service.apart import environment

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux lists threads so")
HOME = Path(__file__).parents[2]
COUNT = """
import os, numpy
numpy.ones((600, 600)) @ numpy.ones((600, 600))
print(len(os.listdir("/proc/self/task")))
"""


def threads(code: str, variables: dict[str, str]) -> int:
    asked = [sys.executable, "-c", code]
    ended = subprocess.run(
        asked, cwd=HOME, env=variables, capture_output=True, text=True, timeout=60, check=True
    )
    return int(ended.stdout)


def bare() -> dict[str, str]:
    """The environment of somebody who says nothing of threads."""
    return {name: each for name, each in os.environ.items() if not name.endswith("_THREADS")}


@pytest.mark.skipif(os.cpu_count() == 1, reason="one core has one thread anyway")
def test_products_have_one_thread_and_more_if_somebody_says_so() -> None:
    assert threads(f"import service\n{COUNT}", bare()) == 1
    assert threads(f"import service\n{COUNT}", {**bare(), "OPENBLAS_NUM_THREADS": "2"}) == 2


def test_what_is_started_has_one_thread_too() -> None:
    assert threads(COUNT, environment()) == 1
