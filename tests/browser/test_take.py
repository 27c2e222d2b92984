"""The timeline under the face: recorded, scrubbed, mended, played, and taken home."""

from __future__ import annotations

import json
import math
import re
import subprocess
from pathlib import Path

import pytest
from playwright import sync_api as playwright_api
from viewer_page import settle

pytestmark = pytest.mark.browser
PAGE = "?idle=0&level=low&dpr=0.5&draw=sketch"
STATIC = Path(__file__).parents[2] / "static"
VALIDATE = """
const { validateBytes } = require('gltf-validator');
validateBytes(new Uint8Array(require('fs').readFileSync(process.argv[1])))
  .then((report) => console.log(JSON.stringify(report)));
"""
expect = playwright_api.expect


@pytest.fixture
def desk(page: playwright_api.Page, url: str) -> playwright_api.Page:
    """A page as wide as on a desk, its face open and still."""
    page.set_viewport_size({"width": 1200, "height": 800})
    page.goto(f"{url}/{PAGE}")
    settle(page)
    return page


def timeline(page: playwright_api.Page) -> playwright_api.Locator:
    """Return the panel under the face."""
    return page.get_by_role("region", name="Timeline")


def control(page: playwright_api.Page, unit: str) -> playwright_api.Locator:
    """Return the slider of an action unit; its keys in the timeline are sliders too."""
    return page.locator("#controls").get_by_role("slider", name=re.compile(f"^{unit} "))


def pose_at(page: playwright_api.Page, time: float, **values: float) -> None:
    """Pose the face and keep that as keys at a time."""
    timeline(page).get_by_role("slider", name="Scrub").fill(str(time))
    for name, value in values.items():
        control(page, name).fill(str(value))
    timeline(page).get_by_role("button", name="Key", exact=True).click()


def test_what_the_controls_do_is_recorded_and_played(desk: playwright_api.Page) -> None:
    panel = timeline(desk)
    smile = control(desk, "AU12")
    panel.get_by_role("button", name="Record").click()
    desk.wait_for_timeout(200)
    for value in ("0.3", "0.6", "0.9"):
        smile.fill(value)
        desk.wait_for_timeout(150)
    desk.get_by_role("button", name="Fear").click()
    desk.wait_for_timeout(300)
    panel.get_by_role("button", name="Stop recording").click()
    expect(panel.get_by_text("AU12", exact=True)).to_be_visible()
    expect(panel.get_by_text("Fear").first).to_be_visible()
    scrub = panel.get_by_role("slider", name="Scrub")
    scrub.fill("0")
    expect(smile).to_have_value("0")
    neutral = desk.get_by_role("button", name="Neutral")
    expect(neutral).to_have_attribute("aria-pressed", "true")
    panel.get_by_role("button", name="Play").click()
    expect(panel.get_by_role("button", name="Pause")).to_be_visible()
    expect(panel.get_by_role("button", name="Play")).to_be_visible(timeout=30_000)
    expect(smile).to_have_value("0.9")
    expect(neutral).to_have_attribute("aria-pressed", "false")


def test_keys_are_made_dragged_and_taken_away(desk: playwright_api.Page) -> None:
    panel = timeline(desk)
    pose_at(desk, 0, AU4=0.2)
    pose_at(desk, 2, AU4=0.8)
    keys = panel.get_by_role("slider", name="AU4 at")
    expect(keys).to_have_count(2)
    scrub = panel.get_by_role("slider", name="Scrub")
    scrub.fill("1")
    expect(control(desk, "AU4")).to_have_value("0.5")
    box = keys.nth(1).bounding_box()
    assert box is not None
    desk.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    desk.mouse.down()
    desk.mouse.move(box["x"] + 60, box["y"] + 14, steps=4)
    desk.mouse.up()
    time, value = (
        keys.nth(1).get_attribute("aria-label"),
        keys.nth(1).get_attribute("aria-valuenow"),
    )
    assert time is not None
    assert float(time.split()[2]) > 2.1
    assert value is not None
    assert float(value) < 0.75
    keys.nth(1).press("ArrowUp")
    assert float(keys.nth(1).get_attribute("aria-valuenow") or 0) == pytest.approx(
        float(value) + 0.05, abs=0.01
    )
    keys.nth(1).press("Delete")
    expect(keys).to_have_count(1)
    panel.get_by_role("button", name="Undo in the timeline").click()
    expect(keys).to_have_count(2)


def test_a_take_goes_home_and_comes_back(desk: playwright_api.Page, tmp_path: Path) -> None:
    panel = timeline(desk)
    pose_at(desk, 0, AU12=0)
    pose_at(desk, 1, AU12=0.8)
    panel.get_by_role("slider", name="End").fill("1")
    panel.get_by_role("button", name="Trim").click()
    expect(panel.get_by_label("Length in seconds")).to_have_value("1")
    with desk.expect_download() as download:
        panel.get_by_role("button", name="JSON").click()
    clip = json.loads(Path(download.value.path()).read_text())
    assert clip["duration"] == 1
    assert clip["timeline"] == [{"time": 0, "fade": 1, "action_units": {"AU12": 0.8}}]
    choose_form(desk)
    with desk.expect_download(timeout=240_000) as download:
        panel.get_by_role("button", name="GLB", exact=True).click()
    assert download.value.suggested_filename == "standard.glb"
    download.value.save_as(tmp_path / "take.glb")
    assert faults(tmp_path / "take.glb") == 0
    assert len(names_of_targets(tmp_path / "take.glb")) == 52
    panel.get_by_role("button", name="Undo in the timeline").click()
    expect(panel.get_by_label("Length in seconds")).to_have_value("4")
    drop(desk, "smile.json", json.dumps(clip))
    expect(desk.get_by_text("smile.json is in the timeline")).to_be_visible()
    expect(panel.get_by_label("Length in seconds")).to_have_value("1")
    panel.get_by_role("slider", name="Scrub").fill("0.5")
    expect(control(desk, "AU12")).to_have_value("0.4")


def choose_form(desk: playwright_api.Page) -> None:
    """Have the GLB in ARKit's shapes, coarse and without textures."""
    timeline(desk).get_by_role("button", name="How the GLB is to be").click()
    menu = desk.get_by_role("group", name="How the GLB is to be")
    error = menu.get_by_label("Largest error, mm")
    expect(error).to_be_visible()
    menu.get_by_role("button", name="ARKit's").click()
    expect(error).to_have_count(0)
    menu.get_by_role("button", name="low").click()
    menu.get_by_role("switch", name="Textures").click()
    menu.get_by_label("Frames a second").fill("900")
    menu.get_by_label("Frames a second").press("Enter")
    expect(menu.get_by_label("Frames a second")).to_have_value("30")
    desk.keyboard.press("Escape")
    expect(menu).to_be_hidden()


def drop(page: playwright_api.Page, name: str, text: str) -> None:
    """Drop a file on the page."""
    page.evaluate(
        """([name, text]) => {
          const dropped = new DataTransfer();
          dropped.items.add(new File([text], name));
          window.dispatchEvent(new DragEvent('drop', {dataTransfer: dropped, cancelable: true}));
        }""",
        [name, text],
    )


def tracked(rows: int = 30) -> str:
    """Return a file of OpenFace 2 in which a smile comes and goes."""
    units = [f"AU{number:02}_r" for number in (1, 2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17)]
    units += [f"AU{number:02}_r" for number in (20, 23, 25, 26, 45)]
    present = [name.replace("_r", "_c") for name in units]
    head = ["frame", "face_id", "timestamp", "confidence", "success", *units, *present]
    lines = [",".join(head)]
    for row in range(rows):
        smile = 4 * math.sin(math.pi * row / rows)
        values = [f"{smile:.2f}" if name == "AU12_r" else "0" for name in units]
        lines.append(",".join([str(row + 1), "0", f"{row / 30:.3f}", "0.98", "1", *values]))
        lines[-1] += ",0" * len(present)
    return "\n".join(lines) + "\n"


def test_a_trackers_file_plays_on_the_face_with_its_report(desk: playwright_api.Page) -> None:
    panel = timeline(desk)
    drop(desk, "laugh.csv", "a,b\n1,2\n")
    expect(desk.get_by_role("alert")).to_contain_text("OpenFace 2", timeout=60_000)
    expect(panel.get_by_role("button", name="Open")).to_be_enabled()
    with desk.expect_file_chooser() as chooser:
        panel.get_by_role("button", name="Open").click()
    chooser.value.set_files(
        [{"name": "laugh.csv", "mimeType": "text/csv", "buffer": tracked().encode()}]
    )
    report = panel.get_by_role("list", name="How the file was read")
    expect(report).to_contain_text("all 30 rows count", timeout=120_000)
    expect(panel.get_by_text("AU12", exact=True)).to_be_visible()
    expect(panel.get_by_role("button", name="Play")).to_be_visible(timeout=30_000)
    panel.get_by_role("slider", name="Scrub").fill("0.5")
    assert float(control(desk, "AU12").input_value()) > 0.5
    report.get_by_role("button", name="Close the report").click()
    expect(report).to_have_count(0)


def names_of_targets(file: Path) -> list[str]:
    """Return the names of the skin's morph targets."""
    data = file.read_bytes()
    size = int.from_bytes(data[12:16], "little")
    meshes = json.loads(data[20 : 20 + size])["meshes"]
    return max((mesh.get("extras", {}).get("targetNames", []) for mesh in meshes), key=len)


def faults(file: Path) -> int:
    """Return how many errors Khronos' validator finds."""
    done = subprocess.run(
        ["node", "-e", VALIDATE, str(file)],
        cwd=STATIC,
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    return int(json.loads(done.stdout)["issues"]["numErrors"])
