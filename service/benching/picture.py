"""The figures at a glance: what a face costs among others, and the kernels beside their peers."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from .svg import Drawing

WIDTH, HEIGHT = 940, 380
_BARS_AT = "16"
"""Number of faces whose peers are drawn: one full bank."""


class Panel(NamedTuple):
    """A part of the picture: its edges, pixels."""

    left: float
    top: float
    right: float
    bottom: float


class Scale(NamedTuple):
    """A logarithmic axis from `low` to `high` along pixels."""

    low: float
    high: float
    first: float
    last: float

    def at(self, value: float) -> float:
        """Return the pixel of a value."""
        share = math.log(value / self.low) / math.log(self.high / self.low)
        return self.first + share * (self.last - self.first)


def picture(figures: dict[str, Any]) -> str:
    """Return the figures as an SVG file."""
    drawing = Drawing(WIDTH, HEIGHT, "Cost of a face by number of faces, and kernels and peers")
    _draw_crowds(drawing, figures, Panel(70, 74, 440, 318))
    _draw_peers(drawing, figures["peers"], Panel(610, 74, 820, 318))
    machine = figures["machine"]
    drawing.text(
        22,
        HEIGHT - 16,
        f"{machine['processor']}, {machine['cores']} cores, one thread; {figures['date']}",
        "quiet",
    )
    return drawing.written()


def _draw_crowds(drawing: Drawing, figures: dict[str, Any], panel: Panel) -> None:
    crowds = figures["crowds"]
    drawing.text(22, 30, "µs a face and tick, by faces awake", "ink title")
    drawing.text(22, 50, "lower is better; both axes logarithmic", "quiet")
    alone = next(row for row in figures["integrators"] if row["integrator"] == "rk2")
    reference = 1000 * alone["face_tick_ms"]
    values = [row[name] for row in crowds for name in ("face_tick_us", "commanding_us")]
    low = 10.0 ** math.floor(math.log10(min(values)))
    high = 10.0 ** math.ceil(math.log10(max(*values, reference)))
    x = Scale(crowds[0]["faces"], crowds[-1]["faces"], panel.left + 28, panel.right - 12)
    y = Scale(low, high, panel.bottom, panel.top)
    for power in range(round(math.log10(high / low)) + 1):
        value = low * 10.0**power
        drawing.line([(panel.left, y.at(value)), (panel.right, y.at(value))], "grid")
        drawing.text(panel.left - 8, y.at(value) + 4, f"{value:,.0f}", "quiet", at="end")
    for row in crowds:
        drawing.text(x.at(row["faces"]), panel.bottom + 18, str(row["faces"]), "quiet", at="middle")
    drawing.line(
        [(panel.left, panel.top), (panel.left, panel.bottom), (panel.right, panel.bottom)], "axis"
    )
    drawing.text(panel.right + 12, panel.bottom + 18, "faces", "quiet")
    drawing.line([(panel.left, y.at(reference)), (panel.right, y.at(reference))], "other-line")
    drawing.text(
        panel.right, y.at(reference) + 16, "one by one, Runge-Kutta, float64", "quiet", at="end"
    )
    for name, kind, label in (
        ("face_tick_us", "ours", "all of it"),
        ("commanding_us", "second", "of it, commanding"),
    ):
        places = [(x.at(row["faces"]), y.at(row[name])) for row in crowds]
        drawing.line(places, f"{kind}-line")
        for (px, py), row in zip(places, crowds, strict=True):
            drawing.dot(px, py, kind)
            drawing.text(px, py - 10, f"{row[name]:,.0f}", "ink", at="middle")
        drawing.text(panel.right, places[-1][1] - 38, label, kind, at="end")


def _draw_peers(drawing: Drawing, contest: dict[str, Any], panel: Panel) -> None:
    drawing.text(480, 30, f"µs a face and step, {_BARS_AT} faces side by side", "ink title")
    drawing.text(480, 50, "the same forces and Verlet step on one thread; lower is better", "quiet")
    able = [row for row in contest["peers"] if "us" in row]
    able.sort(key=lambda row: float(row["us"][_BARS_AT]["verlet"]))
    most = able[-1]["us"][_BARS_AT]["verlet"]
    pitch = (panel.bottom - panel.top) / max(len(contest["peers"]), 1)
    drawing.line([(panel.left, panel.top), (panel.left, panel.bottom)], "axis")
    for index, row in enumerate(able):
        top = panel.top + index * pitch
        took, ratio = row["us"][_BARS_AT]["verlet"], row["ratio"][_BARS_AT]
        ours = row["name"] == contest["ratio_to"]
        middle = top + pitch / 2
        length = (panel.right - panel.left) * took / most
        drawing.bar(panel.left, middle - 11, length, 22, "ours" if ours else "other")
        drawing.text(panel.left - 10, middle + 4, row["name"], "ink", at="end")
        words = f"{took:,.0f}" if ours else f"{took:,.0f}  ({ratio:.1f} times)"
        drawing.text(panel.left + length + 8, middle + 4, words, "ink")
    for index, row in enumerate(row for row in contest["peers"] if "us" not in row):
        middle = panel.top + (len(able) + index + 0.5) * pitch
        drawing.text(panel.left - 10, middle + 4, row["name"], "ink", at="end")
        drawing.text(panel.left + 8, middle + 4, "not installed", "quiet")
