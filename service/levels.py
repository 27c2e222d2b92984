"""The table of a head's levels: what each is made of, weighs, and costs to make."""

from __future__ import annotations

import multiprocessing
import os
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from typing import Any, TypeVar

from engine import LEVELS, Recipe, Rig, rig_from_recipe, surface_to_glb, textures_of

from .benching import machine
from .tables import markdown_table

Stage = Callable[[str], None]
_MEGABYTE = 1e6
T = TypeVar("T")


def measure_levels(show: Stage) -> dict[str, Any]:
    """Return the figures of each level, and what the textures weigh and cost.

    Each level is made in a process and an empty cache of its own, so that none profits from another
    one; kernels are compiled before. Seconds are those of the processor.

    Args:
        show: Told what is being measured.
    """
    show("the compiling of kernels")
    _alone(_level, next(iter(LEVELS)))
    rows = []
    for level in LEVELS:
        show(f"level {level}")
        rows.append(_alone(_level, level))
    show("textures")
    return {"machine": machine(), "levels": rows, "textures": _alone(_textures, "high")}


def _alone(measure: Callable[[str], T], level: str) -> T:
    """Return what is measured in a fresh process, with a cache folder that nothing is in."""
    spawn = multiprocessing.get_context("spawn")
    with (
        tempfile.TemporaryDirectory(prefix="risorius-levels-") as folder,
        ProcessPoolExecutor(1, spawn, _use_cache, (folder,)) as pool,
    ):
        return pool.submit(measure, level).result()


def _use_cache(folder: str) -> None:
    os.environ["RISORIUS_CACHE_DIR"] = folder


def _level(level: str) -> dict[str, Any]:
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


def _textures(level: str) -> dict[str, Any]:
    rig = rig_from_recipe(Recipe(), level=level)
    files, baked = _timed(lambda: textures_of(rig))
    _, cached = _timed(lambda: textures_of(rig))
    sizes = {name: len(data) for name, data in files.items()}
    return {"bytes": sizes, "baked_s": baked, "cached_s": cached}


def _sizes(rig: Rig) -> dict[str, int]:
    drawn, parts = rig.head.drawn, rig.head.parts
    return {
        "skin_vertices": len(drawn.vertices),
        "skin_triangles": len(drawn.triangles),
        "part_vertices": sum(len(part.vertices) for part in parts),
        "part_triangles": sum(len(part.triangles) for part in parts),
    }


def _timed(make: Callable[[], T]) -> tuple[T, float]:
    # Of the processor: what else a machine does changes it little.
    start = time.process_time()
    made = make()
    return made, round(time.process_time() - start, 2)


def markdown(figures: dict[str, Any]) -> str:
    """Return the figures as two Markdown tables, under the machine's name."""
    here = figures["machine"]
    head = (
        "level",
        "skin vertices",
        "skin triangles",
        "vertices with parts",
        "triangles with parts",
        "surface.glb, MB",
        "first, s",
        "a person, s",
        "cached, s",
    )
    levels = [
        (
            row["level"],
            f"{row['skin_vertices']:,}",
            f"{row['skin_triangles']:,}",
            f"{row['skin_vertices'] + row['part_vertices']:,}",
            f"{row['skin_triangles'] + row['part_triangles']:,}",
            f"{row['surface_glb_bytes'] / _MEGABYTE:.1f}",
            f"{row['first_s']:.1f}",
            f"{row['person_s']:.2f}",
            f"{row['cached_s']:.2f}",
        )
        for row in figures["levels"]
    ]
    textures = figures["textures"]
    baked, cached = textures["baked_s"], textures["cached_s"]
    sizes = [
        *textures["bytes"].items(),
        (f"all, baked in {baked:.1f} s, cached {cached:.2f} s", sum(textures["bytes"].values())),
    ]
    return "\n".join(
        [
            f"Measured on {here['processor']} ({here['cores']} cores), Python {here['python']}; "
            "seconds are the processor's.",
            "",
            *markdown_table(head, levels),
            "",
            *markdown_table(("texture", "kB"), ((n, f"{s / 1000:.0f}") for n, s in sizes)),
        ]
    )
