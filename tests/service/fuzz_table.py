"""A table of what was tried: each route with its examples, answers, faults and seconds."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


@dataclass
class Tried:
    """What became of one route, or of routes one after another.

    Attributes:
        examples: Requests sent.
        answers: How many had each hundred of statuses: {"2xx": 7, "4xx": 3}.
        faults: Checks that failed, and requests that had no answer.
        seconds: Taken by all of it, the making of examples included.
    """

    examples: int = 0
    answers: Counter[str] = field(default_factory=Counter)
    faults: int = 0
    seconds: float = 0.0

    def add(self, scenario: dict[str, Any]) -> None:
        """Count a scenario of schemathesis' report."""
        recorder = scenario["recorder"]
        for call in recorder.get("interactions", {}).values():
            self.examples += 1
            answer = call.get("response")
            self.answers[f"{answer['status_code'] // 100}xx" if answer else "none"] += 1
            self.faults += not answer
        checks = (check for made in recorder.get("checks", {}).values() for check in made)
        self.faults += sum(check["status"] == "failure" for check in checks)
        self.seconds += scenario["elapsed_time"]


def tried_in(lines: Iterable[str]) -> dict[str, Tried]:
    """Return what was tried by route, from the lines of schemathesis' report of events."""
    rows: dict[str, Tried] = {}
    for line in lines:
        ((kind, event),) = json.loads(line).items()
        if kind == "ScenarioFinished":
            route = event["recorder"].get("label") or event["phase"]
            rows.setdefault(route, Tried()).add(event)
    return rows


def table(report: Path) -> str:
    """Return what a report of events comes to, a line a route and one for all."""
    with report.open(encoding="utf-8") as lines:
        rows = tried_in(lines)
    total = Tried()
    for row in rows.values():
        total.examples += row.examples
        total.answers += row.answers
        total.faults += row.faults
        total.seconds += row.seconds
    width = max(map(len, rows), default=0)
    head = f"{'':{width}}  examples      2xx   others  faults  seconds"
    named = {**rows, "all": total}
    return "\n".join([head, *(_line(name, row, width) for name, row in named.items())])


def _line(name: str, row: Tried, width: int) -> str:
    good = row.answers["2xx"]
    others = row.examples - good
    return f"{name:{width}}  {row.examples:8}{good:9}{others:9}{row.faults:8}{row.seconds:9.1f}"
