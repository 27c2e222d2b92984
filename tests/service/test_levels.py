"""The table of levels: it names what was measured."""

from __future__ import annotations

from pathlib import Path

from engine import LEVELS
from engine.head import standard_head
from service.levels import markdown

PAGE = Path(__file__).parents[2] / "docs" / "levels.md"


def test_levels_and_textures_are_rows() -> None:
    level = {
        "level": "low",
        "skin_vertices": 1200,
        "skin_triangles": 2400,
        "part_vertices": 10,
        "part_triangles": 100,
        "surface_glb_bytes": 2_500_000,
        "first_s": 1.0,
        "person_s": 0.5,
        "cached_s": 0.1,
    }
    files = {"albedo.jpg": 900_000, "orm.jpg": 100_000}
    textures = {"bytes": files, "baked_s": 9.0, "cached_s": 0.02}
    machine = {"processor": "Abacus 7", "cores": 2, "python": "3.11.7"}
    table = markdown({"machine": machine, "levels": [level], "textures": textures})
    assert table.startswith("Measured on Abacus 7 (2 cores), Python 3.11.7;")
    assert "| low | 1,200 | 2,400 | 1,210 | 2,500 | 2.5 | 1.0 | 0.50 | 0.10 |" in table
    assert "| all, baked in 9.0 s, cached 0.02 s | 1000 |" in table


def test_the_page_says_how_fine_each_level_is() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for level in LEVELS:
        drawn = standard_head(level).drawn
        assert f"| {level} | {len(drawn.vertices):,} | {len(drawn.triangles):,} |" in page
