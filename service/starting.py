"""What a start costs: seconds and memory, against a process that only imports the libraries.

Everything is measured in processes of its own, in turns, so that what else a machine does falls on
all of them; ratios are of medians. Linux only: memory is what the kernel says of a process.
"""

from __future__ import annotations

import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .tables import markdown_table

Stage = Callable[[str], None]
LIBRARIES = "import numba, trimesh, fastapi, pydantic"
"""The baseline: what any service on these libraries starts with."""
ENGINE_LIBRARIES = "import numba, trimesh"
ENGINE = "import engine"
FEW, MANY = 10, 40
"""Faces that are awake when memory is read."""
_LONGEST_SECONDS = 300.0
_PAUSE = 0.01
_BYTECODE = "PYTHONDONTWRITEBYTECODE"
"""Libraries come with their bytecode; the first start writes ours, unless this forbids it."""
_MEGABYTE = 1024.0


class StartFailed(Exception):
    """A process ended, or was not ready in time; the message is its last words."""


def start_figures(show: Stage, *, rounds: int = 3, cold: bool = True) -> dict[str, Any]:
    """Return what starting costs.

    Args:
        show: Told what is being measured.
        rounds: How often each is started; medians count.
        cold: Whether to start once with empty caches too, which takes a minute.

    Raises:
        StartFailed: The service does not start.
    """
    show("imports")
    for code in (LIBRARIES, ENGINE_LIBRARIES, ENGINE):
        imported(code)  # Once for the system's own cache of files.
    figures: dict[str, Any] = {"imports": import_figures(rounds)}
    show("a start")
    with service():
        pass  # Fills the caches.
    seconds: dict[str, list[float]] = {"baseline": [], "answers": [], "ready": []}
    baseline_mb = 0.0
    for _ in range(rounds):
        taken, baseline_mb = imported(LIBRARIES)
        seconds["baseline"].append(taken)
        with service() as started:
            seconds["answers"].append(started.answers)
            seconds["ready"].append(started.ready)
    warm = {name: statistics.median(values) for name, values in seconds.items()}
    figures["warm"] = _rounded(warm) | {"ratio": round(warm["ready"] / warm["baseline"], 2)}
    if cold:
        show("a start with empty caches")
        baseline, _ = imported(LIBRARIES)
        with tempfile.TemporaryDirectory(prefix="risorius-cold-") as folder:
            caches = ("NUMBA_CACHE_DIR", "RISORIUS_CACHE_DIR", "XDG_CACHE_HOME")
            with service({name: f"{folder}/{name}" for name in caches}) as started:
                times = {"baseline": baseline, "answers": started.answers, "ready": started.ready}
        figures["cold"] = _rounded(times) | {"ratio": round(started.ready / baseline, 2)}
    show("memory")
    figures["memory"] = {"baseline_mb": round(baseline_mb, 1), **memory_figures(baseline_mb)}
    return figures


def import_figures(rounds: int) -> dict[str, Any]:
    """Return the seconds that importing the engine takes, against its libraries."""
    pairs = [(imported(ENGINE_LIBRARIES)[0], imported(ENGINE)[0]) for _ in range(rounds)]
    libraries, engine = (min(times) for times in zip(*pairs, strict=True))
    return {
        "libraries": round(libraries, 2),
        "engine": round(engine, 2),
        "ratio": round(engine / libraries, 2),
    }


def memory_figures(baseline_mb: float) -> dict[str, Any]:
    """Return what the service holds with a few awake faces over the baseline, and a face more."""
    with service() as started:
        faces: list[str] = []

        def awake(count: int, intensity: float) -> float:
            while len(faces) < count:
                faces.append(started.ask("POST", "/api/sessions", {"rig": "standard"})["id"])
            for face in faces:
                path = f"/api/sessions/{face}/controls"
                started.ask("PUT", path, {"action_units": {"AU12": intensity}})
            time.sleep(0.2)
            return resident(started.process.pid)

        # Baked in the background, if nobody has: that is no face's memory.
        started.wait_for("/api/rigs/standard/textures/albedo.jpg")
        idle = resident(started.process.pid)
        few = awake(FEW, 0.5)
        many = awake(MANY, 1.0)
    return {
        "ready_mb": round(idle - baseline_mb, 1),
        f"faces_{FEW}_mb": round(few - baseline_mb, 1),
        "further_face_mb": round((many - few) / (MANY - FEW), 2),
    }


def imported(code: str) -> tuple[float, float]:
    """Return the seconds that a process takes to run `code`, and the memory it holds then, MB."""
    script = f"{code}\nprint('done', flush=True)\ninput()"
    began = time.perf_counter()
    with subprocess.Popen(
        [sys.executable, "-c", script],
        env=_environment(),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        if process.stdout.readline() != "done\n":
            raise StartFailed(f"{code} failed")
        seconds = time.perf_counter() - began
        memory = resident(process.pid)
        process.communicate("\n")
    return seconds, memory


def resident(process: int) -> float:
    """Return the memory that a process holds, MB."""
    status = Path(f"/proc/{process}/status").read_text(encoding="utf-8")
    found = re.search(r"VmRSS:\s+(\d+) kB", status)
    if found is None:
        raise StartFailed(f"process {process} has ended")
    return int(found[1]) / _MEGABYTE


class Started:
    """A service in a process of its own.

    Attributes:
        process: Which.
        url: Where it is.
        answers: Seconds until it answered at all.
        ready: Seconds until a face could be opened.
    """

    def __init__(self, process: subprocess.Popen[str], began: float) -> None:
        """Wait until it is ready.

        Raises:
            StartFailed: It is not, in time.
        """
        self.process = process
        self.url = self._said(r"http://\S+")
        self.answers = self._answered("/api/health", began)
        self.ready = self._answered("/api/ready", began)

    def ask(self, method: str, path: str, body: object) -> Any:
        """Return the answer to a request."""
        request = urllib.request.Request(
            self.url + path,
            json.dumps(body).encode(),
            {"Content-Type": "application/json"},
            method=method,
        )
        with urllib.request.urlopen(request, timeout=60.0) as answer:
            return json.load(answer)

    def wait_for(self, path: str) -> None:
        """Read what may take long to be made."""
        with urllib.request.urlopen(self.url + path, timeout=_LONGEST_SECONDS) as answer:
            answer.read()

    def _said(self, pattern: str) -> str:
        assert self.process.stderr is not None
        said = ""
        for line in self.process.stderr:
            said += line
            found = re.search(pattern, line)
            if found:
                return found[0]
        raise StartFailed(said or "the service ended without a word")

    def _answered(self, path: str, began: float) -> float:
        while time.perf_counter() - began < _LONGEST_SECONDS:
            try:
                with urllib.request.urlopen(self.url + path, timeout=60.0):
                    return time.perf_counter() - began
            except urllib.error.HTTPError as error:
                error.close()
            if self.process.poll() is not None:
                break
            time.sleep(_PAUSE)
        raise StartFailed(f"{path} was not answered")


@contextmanager
def service(environment: dict[str, str] | None = None, *, port: int = 0) -> Iterator[Started]:
    """Start a service, with an empty database unless told another; it ends with the block."""
    with tempfile.TemporaryDirectory(prefix="risorius-start-") as folder:
        own = {"RISORIUS_DATA_DIR": folder, "RISORIUS_API_KEYS": "", "RISORIUS_DATABASE_URL": ""}
        began = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, "-m", "service", "serve", "--host", "127.0.0.1", "--port", str(port)],
            env=_environment() | own | (environment or {}),
            stderr=subprocess.PIPE,
            text=True,
        )
        try:
            yield Started(process, began)
        finally:
            process.terminate()
            process.communicate()


def _environment() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name != _BYTECODE}


def _rounded(seconds: dict[str, float]) -> dict[str, float]:
    return {name: round(value, 2) for name, value in seconds.items()}


def start_markdown(figures: dict[str, Any]) -> str:
    """Return the figures as a Markdown table."""
    imports, memory = figures["imports"], figures["memory"]
    rows = [("import engine", _s(imports["libraries"]), _s(imports["engine"]), imports["ratio"])]
    for name in ("warm", "cold"):
        if name in figures:
            row = figures[name]
            title = f"service ready, {name} caches"
            rows.append((title, _s(row["baseline"]), _s(row["ready"]), row["ratio"]))
    base = f"{memory['baseline_mb']:.0f} MB"
    few = memory[f"faces_{FEW}_mb"]
    rows.append(("service ready", base, f"+{memory['ready_mb']:.0f} MB", ""))
    rows.append((f"{FEW} faces awake", base, f"+{few:.0f} MB", ""))
    rows.append(("each further face", "", f"+{memory['further_face_mb']:.2f} MB", ""))
    return "\n".join(markdown_table(("figure", "libraries alone", "Risorius", "ratio"), rows))


def _s(seconds: float) -> str:
    return f"{seconds:.2f} s"
