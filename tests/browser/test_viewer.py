"""The viewer in a browser: a slider is moved, and the face that is drawn smiles."""

from __future__ import annotations

import re
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

import pytest
from PIL import Image, ImageChops
from playwright import sync_api as playwright_api
from viewer_page import height, settle

from service.app import create_app
from service.server import running
from service.settings import Settings
from service.starting import service

pytestmark = pytest.mark.browser
START_SECONDS = 300.0
SKETCH = "?draw=sketch"
"""Of a page whose picture is not looked at."""
CORNERS = ("ch.L", "ch.R")


def switch_off_idle_life(page: playwright_api.Page, url: str) -> None:
    """See that a face that the page opened lives, and end that by the keyboard."""
    page.wait_for_function("() => window.__viewer?.ready")
    life = f"{url}/api/sessions/{page.evaluate('() => window.__viewer.session')}/idle"
    switch = page.get_by_role("switch", name="Idle life")
    playwright_api.expect(switch).to_be_checked()
    assert page.request.get(life).json()["idle"]["blinks"] == 1.0
    switch.press("Space")
    playwright_api.expect(switch).not_to_be_checked()
    settle(page)
    assert page.request.get(life).json() == {"idle": None}


def test_a_face_lives_and_a_slider_lifts_the_streamed_and_the_drawn_mouth_corners(
    page: playwright_api.Page, url: str
) -> None:
    page.goto(f"{url}/{SKETCH}")
    switch_off_idle_life(page, url)
    tick = settle(page)
    assert page.evaluate("() => window.__viewer.connected && window.__viewer.framesDrawn > 0")
    rest = {name: height(page, name) for name in CORNERS}
    session = page.evaluate("() => window.__viewer.session")
    moved = page.evaluate("() => window.__viewer.point('M1_5.L')[1]")
    slider = page.get_by_role("slider", name="AU12")
    slider.fill("1")
    settle(page, tick)
    held = page.request.get(f"{url}/api/sessions/{session}").json()["layers"]
    assert held["puppet"]["action_units"]["AU12"] == pytest.approx(1.0)
    assert page.evaluate("() => window.__viewer.point('M1_5.L')[1]") > moved + 2e-3
    for name in CORNERS:
        assert height(page, name) > rest[name] + 2e-3, name


def test_another_client_s_command_is_drawn_too(page: playwright_api.Page, url: str) -> None:
    session = page.request.post(f"{url}/api/sessions", data={}).json()["id"]
    page.goto(f"{url}/{SKETCH}&session={session}&bare=1&view=three-quarter")
    tick = settle(page)
    rest = height(page, "ch.L")
    answer = page.request.post(f"{url}/api/sessions/{session}/emotions", data={"label": "joy"})
    assert answer.ok
    settle(page, tick)
    assert height(page, "ch.L") > rest + 1e-3


def test_a_visitor_reads_what_is_being_done(page: playwright_api.Page, url: str) -> None:
    page.add_init_script(
        """window.__said = [];
        new MutationObserver(() => {
          const words = document.querySelector('#curtain span')?.textContent;
          if (words && !window.__said.includes(words)) window.__said.push(words);
        }).observe(document, {subtree: true, childList: true, characterData: true});"""
    )
    page.goto(f"{url}/{SKETCH}&idle=0")
    settle(page)
    said = page.evaluate("() => window.__said")
    assert said[0].startswith(("Connecting", "Preparing"))
    assert any(re.fullmatch(r"Fetching the face, [\d.]+ of [\d.]+ MB", words) for words in said)
    assert page.locator("#curtain span").count() == 0


def test_a_visitor_reads_what_a_starting_service_is_at(page: playwright_api.Page, url: str) -> None:
    starting = {"error": "not_ready", "message": "the service is compiling the simulation"}
    page.route("**/api/ready", lambda route: route.fulfill(status=503, json=starting))
    page.route("**/api/sessions", lambda _: None)  # A first session waits for the first rig.
    page.goto(f"{url}/{SKETCH}&idle=0")
    said = page.locator("#curtain span")
    playwright_api.expect(said).to_have_text("The service is starting: compiling the simulation")
    page.unroute_all(behavior="ignoreErrors")


def test_a_session_that_was_closed_is_opened_anew(page: playwright_api.Page, url: str) -> None:
    page.goto(f"{url}/{SKETCH}&idle=0")
    settle(page)
    session = page.evaluate("() => window.__viewer.session")
    page.request.delete(f"{url}/api/sessions/{session}")
    page.wait_for_function("id => window.__viewer.session !== id", arg=session)
    playwright_api.expect(page.locator(".status")).to_have_attribute("data-busy", "false")


def test_everybody_fits_under_the_stage(page: playwright_api.Page, url: str) -> None:
    page.goto(f"{url}/{SKETCH}&idle=0")
    settle(page)
    page.get_by_role("button", name="Sean").wait_for()
    for wide, high in ((1280, 800), (1600, 1000)):
        page.set_viewport_size({"width": wide, "height": high})
        page.evaluate("() => window.__viewer.render()")
        stage = page.locator("#stage").bounding_box()
        assert stage is not None
        boxes = [button.bounding_box() for button in page.locator("#people button").all()]
        assert len(boxes) == 15
        for before, box in pairwise(boxes):
            assert before is not None
            assert box is not None
            assert before["x"] + before["width"] <= box["x"]
            assert box["x"] + box["width"] <= stage["x"] + stage["width"]
            assert box["y"] + box["height"] <= high
        footer = page.locator("footer").bounding_box()
        assert footer is not None
        assert footer["y"] < high - 30


def test_panels_show_what_an_emotion_plays(page: playwright_api.Page, url: str) -> None:
    page.set_viewport_size({"width": 1000, "height": 700})
    page.goto(f"{url}/{SKETCH}&idle=0&dpr=0.5")
    tick = settle(page)
    page.get_by_role("button", name="Contempt").click()
    settle(page, tick)
    dimpler = page.get_by_role("slider", name="AU14")
    playwright_api.expect(dimpler).to_have_attribute(
        "aria-valuetext", "0.00, the face shows right E 1.00"
    )
    line = page.locator("label.slider").filter(has=dimpler)
    assert line.locator(".played").text_content() == "right E 1.00"
    share = "line => line.querySelector('i').offsetWidth / line.querySelector('input').offsetWidth"
    assert line.evaluate(share) > 0.8
    session = page.evaluate("() => window.__viewer.session")
    joy = {"label": "joy", "seed": 1}  # As another client says it, and another form of it.
    assert page.request.post(f"{url}/api/sessions/{session}/emotions", data=joy).ok
    happiness = page.get_by_role("button", name="Happiness")
    playwright_api.expect(happiness).to_have_attribute("aria-pressed", "true")


def test_the_paper_s_face_opens(page: playwright_api.Page, url: str, tmp_path: Path) -> None:
    page.goto(f"{url}/?rig=paper&bare=1")
    settle(page)
    rig = page.request.get(f"{url}/api/rigs/paper").json()["id"]
    assert page.evaluate("() => window.__viewer.rig") == rig
    page.screenshot(path=tmp_path / "paper.png")
    with Image.open(tmp_path / "paper.png") as picture:
        middle = picture.convert("RGB").crop((120, 60, 200, 180))
        shades = middle.getcolors(middle.width * middle.height)
    # A face has hundreds of shades; an empty page has one.
    assert shades is not None
    assert len(shades) > 100


def test_the_camera_goes_close_and_round(
    page: playwright_api.Page, url: str, tmp_path: Path
) -> None:
    page.goto(f"{url}/?bare=1&view=eye&level=low")
    settle(page)
    page.wait_for_function("() => window.__viewer.textured")
    pictures = []
    for view in ("eye", "mouth", "-50"):
        page.evaluate("view => window.__viewer.setView(view)", view)
        page.evaluate("() => window.__viewer.render()")
        page.screenshot(path=tmp_path / f"{view}.png")
        with Image.open(tmp_path / f"{view}.png") as picture:
            pictures.append(picture.convert("RGB"))
    # Skin fills a close-up to its corners; of the head, one sees what is behind it.
    backdrop = pictures[2].getpixel((4, 4))
    assert sum(backdrop) < 200
    assert sum(pictures[0].getpixel((60, 120))) > sum(backdrop) + 60
    for one, other in ((0, 1), (1, 2)):
        assert ImageChops.difference(pictures[one], pictures[other]).getbbox() is not None
    with pytest.raises(playwright_api.Error, match="There is no view"):
        page.evaluate("() => window.__viewer.setView('behind')")


@pytest.mark.usefixtures("browser")
def test_a_sheet_is_drawn(tmp_path: Path) -> None:
    output = tmp_path / "sheet.png"
    command = [sys.executable, "-m", "service", "sheet", "-o", str(output)]
    done = subprocess.run(
        [*command, "--size", "160", "--only", "rest,AU26,joy"],
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    with Image.open(output) as sheet:
        assert sheet.size == (480, 174)
        rest, jaw_drop = (sheet.crop((left, 0, left + 160, 160)) for left in (0, 160))
        assert ImageChops.difference(rest, jaw_drop).getbbox() is not None


def test_a_link_shows_its_face_and_a_key_opens_the_page(
    page: playwright_api.Page, tmp_path: Path
) -> None:
    settings = Settings(data_dir=tmp_path, api_keys=("a-key",))
    app = create_app(settings)
    with running(app, settings) as url:
        deadline = time.monotonic() + START_SECONDS
        while not app.state.parts.ready.is_set():
            assert time.monotonic() < deadline, app.state.parts.stage
            time.sleep(0.1)
        key = {"X-API-Key": "a-key"}
        session = page.request.post(f"{url}/api/sessions", data={}, headers=key).json()["id"]
        tickets = f"{url}/api/sessions/{session}/tickets"
        asked = {"role": "read"}
        link = page.request.post(tickets, data=asked, headers=key).json()["url"]
        refused: list[str] = []
        page.on("response", lambda got: refused.append(got.url) if got.status >= 400 else None)
        page.goto(f"{link}&bare=1&level=low&dpr=0.25")
        page.wait_for_function("() => window.__viewer?.ready && window.__viewer.textured")
        assert page.evaluate("() => window.__viewer.session") == session
        assert refused == []
        playwright_api.expect(page.locator("body")).to_have_class(re.compile("watching"))
        page.goto(f"{url}/{SKETCH}&level=low&dpr=0.25")
        page.get_by_label("This service asks for a key.").fill("a-key")
        page.locator("#curtain").get_by_role("button", name="Open").click()
        page.wait_for_function("() => window.__viewer.connected")
        playwright_api.expect(page.locator("#panels")).to_be_visible()


def test_a_viewer_comes_back_to_its_face_when_the_service_was_killed(
    page: playwright_api.Page, url: str, tmp_path: Path
) -> None:
    folder = {"RISORIUS_DATA_DIR": str(tmp_path)}
    with service(folder) as started:
        page.goto(f"{started.url}{SKETCH}&bare=1")
        rest = settle(page)
        session = page.evaluate("() => window.__viewer.session")
        before = [height(page, corner) for corner in CORNERS]
        controls = f"/api/sessions/{session}/controls"
        started.ask("PATCH", controls, {"action_units": {"AU12": 1}})
        settle(page, rest)
        smile = [height(page, corner) for corner in CORNERS]
        assert min(high - low for high, low in zip(smile, before, strict=True)) > 0.002
        started.process.kill()
        started.process.wait()
        page.wait_for_function("() => !window.__viewer.connected")
    with service(folder, port=int(started.url.rpartition(":")[2])) as again:
        page.wait_for_function("() => window.__viewer.connected")
        assert page.evaluate("() => window.__viewer.session") == session
        held = again.ask("GET", f"/api/sessions/{session}", None)["layers"]["puppet"]
        assert held["action_units"] == {"AU12": 1.0}
        # It is the same face to the page: what moves it now is drawn.
        again.ask("PATCH", controls, {"action_units": {"AU12": 0}})
        page.wait_for_function(
            "([name, top]) =>"
            " window.__viewer.drawnVertex(window.__viewer.landmarks[name])[1] < top",
            arg=[CORNERS[0], before[0] + 0.2 * (smile[0] - before[0])],
        )
