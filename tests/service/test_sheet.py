"""Contact sheets: which poses they have, and how pictures are laid out."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from PIL import Image

from engine import builtin_rig, lexicon, parse_facs, people
from service.sheet import Plan, SheetRefused, _fitting, _frame_of, _slug, draw_sheet, poses_of, tile
from service.sheet_sets import SETS

RIG = {
    "action_units": [{"name": "AU1", "title": "Inner brow raiser"}],
    "emotions": [{"name": "happiness", "recipe": "6D+12E", "synonyms": ["joy"]}],
}


def png(color: tuple[int, int, int]) -> bytes:
    buffer = io.BytesIO()
    Image.new("RGB", (50, 40), color).save(buffer, "PNG")
    return buffer.getvalue()


def test_a_sheet_has_rest_units_and_emotions() -> None:
    poses = poses_of(RIG, ())
    assert [pose.label for pose in poses] == ["rest", "AU1 Inner brow raiser", "happiness 6D+12E"]
    assert poses[1].controls == {"action_units": {"AU1": 1.0}}
    assert poses[2].emotion == "happiness"


def test_a_sheet_has_only_what_is_asked() -> None:
    poses = poses_of(RIG, ("joy", "1C+L12D"))
    assert poses[0].emotion == "happiness"
    assert poses[1].controls == {"facs": "1C+L12D"}


@pytest.mark.parametrize("name", SETS)
def test_a_set_is_of_what_the_rig_can_show(name: str) -> None:
    rig = builtin_rig("standard")
    assert len(set(SETS[name])) == len(SETS[name])
    for pose in SETS[name]:
        if pose.partition("@")[0] not in ("rest", *rig.emotions, *lexicon().recipes):
            assert all(rig.resolve_unit(term.key) for term in parse_facs(pose))


def test_a_sheet_shows_weak_emotions() -> None:
    (pose,) = poses_of(RIG, ("joy@0.4",))
    assert (pose.label, pose.emotion, pose.intensity) == ("happiness 0.4", "happiness", 0.4)


def test_a_sheet_shows_labels_of_any_vocabulary() -> None:
    pose, weak = poses_of(RIG, ("bored", "annoyance@0.5"))
    assert pose.emotion == "bored"
    assert pose.label.startswith("bored 15A")
    assert weak.intensity == 0.5


@pytest.mark.parametrize("name", ["joy@", "joy@2", "joy@nan", "AU1@0.5", "6C+12D@0.5"])
def test_a_sheet_refuses_an_intensity_without_sense(name: str) -> None:
    with pytest.raises(SheetRefused, match=r"such as happiness@0\.4"):
        poses_of(RIG, (name,))


def test_pictures_are_laid_out_in_rows() -> None:
    colors = [(255, 0, 0), (0, 255, 0), (0, 0, 255)]
    sheet = tile([("name", png(color)) for color in colors], columns=2, size=100)
    assert sheet.size == (200, 2 * 114)
    assert sheet.getpixel((50, 50)) == colors[0]
    assert sheet.getpixel((150, 50)) == colors[1]
    assert sheet.getpixel((50, 164)) == colors[2]


def test_few_pictures_make_a_narrow_sheet() -> None:
    assert tile([("one", png((1, 2, 3)))], columns=8, size=64).width == 64


def test_a_long_label_is_set_smaller_and_not_cut() -> None:
    short, long = _fitting("rest", 40, 300), _fitting("fear 1E+2C+4C+5E+20D+25C+26A", 40, 300)
    assert short.getlength("rest") > long.getlength("rest")
    assert long.getlength("fear 1E+2C+4C+5E+20D+25C+26A") <= 300


def test_a_sheet_refuses_what_it_cannot_write(tmp_path: Path) -> None:
    plan = Plan(rigs=("standard",), views=("front",), only=(), size=64)
    with pytest.raises(SheetRefused, match=r"no file of \.png"):
        draw_sheet(tmp_path / "sheet.txt", plan, columns=1, show=lambda *_: None)
    with pytest.raises(SheetRefused, match="does not exist"):
        draw_sheet(tmp_path / "none" / "a.png", plan, columns=1, show=lambda *_: None)


def test_a_picture_in_a_folder_is_named_after_its_label() -> None:
    assert _slug("fear 1E+2C") == "fear-1e-2c"
    assert _slug("rest -25") != _slug("rest 25")


def test_a_head_s_picture_is_cut_to_its_face_and_a_close_up_is_whole() -> None:
    assert _frame_of(402.0, True) == {"x": 0.0, "y": 0.0, "width": 402.0, "height": 402.0}
    face = _frame_of(402.0, False)
    assert face["width"] == face["height"] == pytest.approx(300.0)
    assert face["x"] == pytest.approx(51.0)


def test_the_people_s_pictures_show_the_page_behind_them() -> None:
    folder = Path(__file__).parents[2] / "static" / "public" / "people"
    names = {*people(), "standard", "paper"}
    assert {file.stem for file in folder.iterdir()} == names
    for name in names:
        with Image.open(folder / f"{name}.png") as taken:
            alpha = taken.convert("RGBA").getchannel("A")
        assert alpha.getpixel((0, alpha.height // 2)) == 0, name
        assert alpha.getpixel((alpha.width // 2, alpha.height // 2)) > 240, name
