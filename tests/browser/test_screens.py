"""Pictures of the viewer by one command."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image
from typer.testing import CliRunner

from service.cli import app
from service.scenes import SCENES, Scene
from service.screens import photograph


@pytest.mark.browser
def test_a_scene_is_photographed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small = Scene(SCENES["embed"].play, (420, 300), address=SCENES["embed"].address)
    monkeypatch.setitem(SCENES, "embed", small)  # type: ignore[arg-type]
    told: list[str] = []
    count = photograph(tmp_path, ("embed",), show=lambda name, _share: told.append(name))
    assert (count, told) == (1, ["embed"])
    with Image.open(tmp_path / "embed.png") as picture:
        assert picture.size == (420, 300)
        face = picture.convert("RGB").crop((40, 40, 200, 220))
        red, _, blue = face.resize((1, 1), Image.Resampling.BOX).getpixel((0, 0))  # type: ignore[misc]
    assert red > blue + 10, "skin is redder than the page"


def test_a_scene_that_there_is_not_is_refused(tmp_path: Path) -> None:
    ended = CliRunner().invoke(app, ["screens", "-o", str(tmp_path), "--only", "inside-bones"])
    assert ended.exit_code == 2
    assert "inside-bone" in ended.stderr
    assert not list(tmp_path.iterdir())
