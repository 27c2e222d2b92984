"""The figures as tables: for a terminal, and for Markdown."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rich.console import Group
from rich.table import Table

from ..tables import markdown_table
from .section import Row, Section
from .stream import stream_section
from .viewers import viewers_section


def about(figures: dict[str, Any]) -> str:
    """Return in one line what was measured where."""
    machine = figures["machine"]
    load, nice = figures["load_average"], figures["niceness"]
    behind = f", standing back behind it (nice {nice})" if nice else ""
    versions = ", ".join(f"{name} {machine[name]}" for name in ("numpy", "numba", "scipy"))
    return (
        f"{machine['processor']}, {machine['cores']} cores; {machine['system']}; Python "
        f"{machine['python']}, {versions}; load average at the start "
        f"{load[0] if load else 'unknown'}{behind}; risorius {figures['risorius']}, source "
        f"{figures['source'] or 'unknown'}, {figures['date']}; rig {figures['rig']['name']}"
        f"{'; measured shortly (--quick)' if figures['quick'] else ''}."
    )


def sections(figures: dict[str, Any]) -> list[Section]:
    """Return every table whose figures were measured."""
    return [table(figures[name]) for name, table in _TABLES.items() if name in figures]


def terminal(figures: dict[str, Any]) -> Group:
    """Return the tables for people at a terminal."""
    return Group(about(figures), *(_printed(section) for section in sections(figures)))


def markdown(figures: dict[str, Any]) -> str:
    """Return the tables for a document, each under a heading."""
    blocks = []
    for section in sections(figures):
        blocks += [f"## {section.title}", ""]
        blocks += [section.note, ""] if section.note else []
        blocks += [*markdown_table(section.head, section.rows), ""]
    return "\n".join(blocks)


def _printed(section: Section) -> Table:
    table = Table(title=section.title, title_justify="left", caption=section.note or None)
    table.caption_justify = "left"
    table.add_column(section.head[0])
    for name in section.head[1:]:
        table.add_column(name, justify="right")
    for row in section.rows:
        table.add_row(*(str(cell) for cell in row))
    return table


def _peers(contest: dict[str, Any]) -> Section:
    faces = [str(count) for count in contest["faces"]]
    rows: list[Row] = []
    for peer in contest["peers"]:
        name = f"{peer['name']}, {peer['version']}" if peer["version"] else peer["name"]
        if "unavailable" in peer:
            rows.append((name, "not installed", *[""] * (3 * len(faces) - 1)))
            continue
        took, ratio = peer["us"], peer["ratio"]
        cells = (
            (f"{took[n]['force']:.1f}", f"{took[n]['verlet']:.1f}", f"{ratio[n]:.1f}")
            for n in faces
        )
        rows.append((name, *(cell for three in cells for cell in three)))
    head = (f"{n}: {what}" for n in faces for what in ("forces", "step", "ratio"))
    return Section(
        "The kernels beside their peers",
        "µs of one thread a face and force evaluation, for 1, 16 and 64 faces: the forces alone, "
        "and a step of position Verlet with them. All compute the same forces of the same moving "
        "faces, without contact; a test holds each to the reference. The peers are in float32 "
        "with faces side by side, as fast as we could write them. The lanes are the kernel of "
        "live faces: sixteen a bank, always stepped whole, so that one face alone costs what "
        "sixteen do, and is slower than the kernel for one. Their forces are measured with a step "
        "that goes nowhere, since they do both in one pass. Ratios are of steps: how many times "
        "the lanes' time it takes.",
        ("kernel", *head),
        tuple(rows),
    )


def _integrators(rows: list[dict[str, Any]]) -> Section:
    return Section(
        "Integrators",
        "A tick is 1/60 s; substeps are the fewest that are stable on this rig. Faces are stepped "
        "with all that belongs to it (commands mixed, jaw, lids, muscles, contact).",
        ("integrator", "kernel", "substeps a tick", "ms a face and tick", "µs a substep"),
        tuple(
            (
                row["integrator"],
                f"{row['kernel']}, {row['precision']}",
                row["substeps"],
                f"{row['face_tick_ms']:.3f}",
                f"{row['substep_us']:.1f}",
            )
            for row in rows
        ),
    )


def _crowds(rows: list[dict[str, Any]]) -> Section:
    return Section(
        "Faces awake",
        "µs of one thread a face and tick, through the public simulator with the model of live "
        "faces. Each face takes up a new random mix of two to five action units every 15 ticks, "
        "in 0.2 s; commanding and stepping are both counted, frames included. Faces a core at "
        "60 Hz are (1/60 s) / (time a face and tick): beyond what real time leaves room for, the "
        "figure is of throughput. A bank is stepped whole, so that few faces cost what sixteen do.",
        ("faces", "commanding", "stepping", "both", "faces a core at 60 Hz"),
        tuple(
            (
                row["faces"],
                f"{row['commanding_us']:.1f}",
                f"{row['stepping_us']:.0f}",
                f"{row['face_tick_us']:.0f}",
                f"{row['faces_per_core_60hz']:.0f}",
            )
            for row in rows
        ),
    )


def _meshes(rows: list[dict[str, Any]]) -> Section:
    return Section(
        "Finer meshes",
        "The skin of the rig taken as a mesh from a file would be, each triangle split into 1, 4, "
        "9 and 16: three layers of nodes under it, the muscles at the same places, no lids, lips "
        "or teeth to meet. Sixteen faces in lanes, in the same motion.",
        (
            "triangles",
            "nodes",
            "substeps a tick",
            "µs a face and tick",
            "ns a triangle and substep",
            "faces a core at 60 Hz",
        ),
        tuple(
            (
                f"{row['triangles']:,}",
                f"{row['nodes']:,}",
                row["substeps"],
                f"{row['face_tick_us']:.0f}",
                f"{row['ns_per_triangle_substep']:.1f}",
                f"{row['faces_per_core_60hz']:.1f}",
            )
            for row in rows
        ),
    )


def _latency(rows: list[dict[str, Any]]) -> Section:
    return Section(
        "From a command to its frame",
        "ms of the clock through the service's runner at 60 Hz, all faces in motion on one "
        "simulation thread: until a command is answered with its tick, and until the first frame "
        "that shows it is handed out. Commands come at any time within a tick, so that half a "
        "tick (8.3 ms) is waiting. Late ticks ended more than half a tick after their time: a "
        "machine on which more wants to run than it has cores (see the load above) has them.",
        ("faces", "answered", "p99", "frame", "p99", "late ticks", "thread busy"),
        tuple(
            (
                row["faces"],
                f"{row['answered_median_ms']:.1f}",
                f"{row['answered_p99_ms']:.1f}",
                f"{row['seen_median_ms']:.1f}",
                f"{row['seen_p99_ms']:.1f}",
                f"{row['late_ticks']} of {row['ticks']}",
                f"{row['busy_percent']:.0f} %",
            )
            for row in rows
        ),
    )


def _named(title: str, note: str, values: dict[str, Any]) -> Section:
    rows = tuple(
        (name.replace("_", " "), f"{value:,g}" if isinstance(value, int | float) else value)
        for name, value in values.items()
    )
    return Section(title, note, ("figure", "value"), rows)


def _emotion_to_frame(values: dict[str, Any]) -> Section:
    return Section(
        "From an emotion to its first frame",
        "ms of the clock from just before an emotion is sent by POST to a service in a process of "
        "its own, on the same machine, until its answer, and until the first binary frame has come "
        "over the socket of that face, at rest until then, whose surface is another one. Beside it "
        f"{values['others']} other sessions move; {values['awake_median']:g} faces were awake at "
        f"the median, and {values['late_ticks']} of {values['ticks']} ticks late. Emotions come at "
        "any time within a tick of 16.7 ms. The last column is how many ticks of motion it took "
        "until the stream's grid of 20 µm showed any: an onset begins slowly.",
        ("emotions", "number", "answered", "p99", "frame", "p99", "in ticks", "of motion"),
        tuple(
            (
                row["way"],
                row["emotions"],
                f"{row['answered_median_ms']:.1f}",
                f"{row['answered_p99_ms']:.1f}",
                f"{row['frame_median_ms']:.1f}",
                f"{row['frame_p99_ms']:.1f}",
                f"{row['frame_median_ticks']:.2f}",
                f"{row['moved_median_ticks']:g}",
            )
            for row in values["ways"]
        ),
    )


def _page_opening(values: dict[str, Any]) -> Section:
    title = "From navigation to the face"
    if "unavailable" in values:
        return Section(title, values["unavailable"], ("until", "ms"), ())
    return Section(
        title,
        "ms of the clock from navigation, in a Chromium without graphics processor and without "
        f"cache, medians of {values['pages']} pages of 1280 x 800; the service is warm, on the "
        "same machine. `script` runs, the `stage` is built, the `session` is open, its `hello` "
        "has come, its `surface` is read, the `first-frame` is drawn, the face is told to be "
        "`complete`. Until the first frame, browser and service compute for "
        f"{values['processor_seconds']:g} s.",
        ("until", "ms"),
        tuple(values["milliseconds"].items()),
    )


def _beside_clips(values: dict[str, Any]) -> Section:
    return Section(
        "Live faces beside clips",
        f"{values['others']} sessions that move, in a service in a process of its own, by turns "
        f"without clips and beside {values['clips']} that are being rendered, each in a process "
        "of its own that stands back. Late ticks ended more than half a tick after their time; "
        "ms of the clock, the 99th percentile of a turn, the median of them.",
        ("faces", "late ticks", "a tick takes, p99", "it is late, p99", "event loop late, p99"),
        tuple(
            (
                row["way"],
                f"{row['late_ticks']} of {row['ticks']}",
                f"{row['tick_p99_ms']:.1f}",
                f"{row['lateness_p99_ms']:.1f}",
                f"{row['loop_delay_p99_ms']:.1f}",
            )
            for row in values["ways"]
        ),
    )


def _output(values: dict[str, Any]) -> Section:
    return _named(
        "Clips and frames",
        "Seconds of animation a second of the processor: a clip runs the reference, midpoint "
        "Runge-Kutta in float64, and is then written as GLB at level high without textures. The "
        "frame is a smile.",
        values,
    )


def _clips(rows: list[dict[str, Any]]) -> Section:
    return Section(
        "What clips cost and weigh",
        "Seconds of the processor beyond the start, all threads together, of a clip at 30 frames a "
        "second as it is by default: level medium, quantised, position Verlet; a new mix of two to "
        "five action units every 2.5 s. Targets are those of the skin; the error is the largest of "
        "any vertex, or of ARKit's shapes the rms and the largest distance of the skin.",
        (
            "form",
            "clip, s",
            "targets",
            "error, mm",
            "simulated",
            "fitted",
            "written",
            "a second of clip",
            "MB",
            "MB with textures",
        ),
        tuple(
            (
                row["form"],
                f"{row['seconds']:g}",
                row["targets"],
                _error(row["error_mm"]),
                f"{row['simulation_seconds']:.2f}",
                f"{row['fit_seconds']:.2f}",
                f"{row['write_seconds']:.2f}",
                f"{row['seconds_a_second']:.3f}",
                f"{row['bytes'] / 1e6:.2f}",
                f"{row['bytes_with_textures'] / 1e6:.2f}",
            )
            for row in rows
        ),
    )


def _error(error: Any) -> str:
    if isinstance(error, dict):
        return f"{error['rms']:.2f}, {error['max']:.1f}"
    return f"{error:.3f}"


def _roof(values: dict[str, Any]) -> Section:
    return _named(
        "The roof of the machine",
        "What one core can do, as multiply-adds of sixteen float32 numbers without a wait; a "
        "sweep of sixteen faces, in arithmetic instructions; and the share of instructions "
        "that the core could have started in that time. The least of many samples.",
        values,
    )


_TABLES: dict[str, Callable[[Any], Section]] = {
    "peers": _peers,
    "integrators": _integrators,
    "crowds": _crowds,
    "meshes": _meshes,
    "latency": _latency,
    "emotion_to_frame": _emotion_to_frame,
    "page_opening": _page_opening,
    "beside_clips": _beside_clips,
    "output": _output,
    "stream": stream_section,
    "viewers": viewers_section,
    "clips": _clips,
    "roof": _roof,
}
