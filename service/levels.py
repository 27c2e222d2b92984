"""The table of a head's levels: what each is made of, weighs, and costs to make."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, TypeVar

from engine import LEVELS, Recipe, Rig, rig_from_recipe, surface_to_glb, textures_of

Stage = Callable[[str], None]
_MEGABYTE = 1e6
T = TypeVar("T")


def measure_levels(show: Stage) -> dict[str, Any]:
    """Return the figures of each level, and what the textures weigh and cost.

    Everything is made in an empty cache of its own. The first row's "first" holds the compiling of
    whatever kernels have not been compiled on this machine.

    Args:
        show: Told what is being measured.
    """
    with _empty_cache():
        rows = [_level(level, show) for level in LEVELS]
        show("textures")
        rig = rig_from_recipe(Recipe())
        textures, seconds = _timed(lambda: textures_of(rig))
        _, cached = _timed(lambda: textures_of(rig))
    files = {name: len(data) for name, data in textures.items()}
    return {"levels": rows, "textures": {"bytes": files, "baked_s": seconds, "cached_s": cached}}


def _level(level: str, show: Stage) -> dict[str, Any]:
    show(f"level {level}")
    recipe = Recipe()
    rig, first = _timed(lambda: rig_from_recipe(recipe, level=level))
    stranger = replace(recipe, age=41.0, nose_width=0.7)
    _, person = _timed(lambda: rig_from_recipe(stranger, level=level))
    _, cached = _timed(lambda: rig_from_recipe(stranger, level=level))
    return {
        "level": level,
        **_sizes(rig),
        "surface_glb_bytes": len(surface_to_glb(rig)),
        "first_s": first,
        "person_s": person,
        "cached_s": cached,
    }


def _sizes(rig: Rig) -> dict[str, int]:
    drawn, parts = rig.head.drawn, rig.head.parts
    return {
        "skin_vertices": len(drawn.vertices),
        "skin_triangles": len(drawn.triangles),
        "part_vertices": sum(len(part.vertices) for part in parts),
        "part_triangles": sum(len(part.triangles) for part in parts),
    }


def _timed(make: Callable[[], T]) -> tuple[T, float]:
    start = time.perf_counter()
    made = make()
    return made, round(time.perf_counter() - start, 2)


@contextmanager
def _empty_cache() -> Iterator[None]:
    """Point the engine at a cache folder that nothing is in."""
    name = "RISORIUS_CACHE_DIR"
    before = os.environ.get(name)
    with tempfile.TemporaryDirectory(prefix="risorius-levels-") as folder:
        os.environ[name] = folder
        try:
            yield
        finally:
            if before is None:
                del os.environ[name]
            else:
                os.environ[name] = before


def markdown(figures: dict[str, Any]) -> str:
    """Return the figures as two Markdown tables."""
    lines = [
        "| level | skin vertices | triangles | with parts | surface.glb, MB "
        "| first, s | a person, s | cached, s |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for row in figures["levels"]:
        whole = row["skin_triangles"] + row["part_triangles"]
        lines.append(
            f"| {row['level']} | {row['skin_vertices']:,} | {row['skin_triangles']:,} | {whole:,} "
            f"| {row['surface_glb_bytes'] / _MEGABYTE:.1f} | {row['first_s']:.1f} "
            f"| {row['person_s']:.2f} | {row['cached_s']:.2f} |"
        )
    textures = figures["textures"]
    lines += ["", "| texture | kB |", "|---|---|"]
    for name, size in textures["bytes"].items():
        lines.append(f"| {name} | {size / 1000:.0f} |")
    total = sum(textures["bytes"].values()) / 1000
    baked, cached = textures["baked_s"], textures["cached_s"]
    lines.append(f"| all, baked in {baked:.1f} s, cached {cached:.2f} s | {total:.0f} |")
    return "\n".join(lines)
