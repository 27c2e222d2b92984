"""How the face is shown: light, bright and dark pages, the turntable, pictures; and to whom."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
from PIL import Image
from playwright import sync_api as playwright_api
from viewer_page import height, settle, until

pytestmark = pytest.mark.browser
PAGE = "?idle=0&level=low&dpr=0.5"
expect = playwright_api.expect


@pytest.fixture
def desk(page: playwright_api.Page, url: str) -> playwright_api.Page:
    """A page as wide as on a desk that may use the clipboard, its face open and still."""
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.set_viewport_size({"width": 1200, "height": 800})
    page.goto(f"{url}/{PAGE}&draw=sketch")
    settle(page)
    return page


def picture(page: playwright_api.Page, folder: Path) -> Image.Image:
    """Return the picture that the page offers of its face."""
    menu = page.get_by_role("button", name="Light and stage")
    if menu.get_attribute("aria-expanded") == "false":
        menu.click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Save a picture").click()
    assert download.value.suggested_filename == "standard.png"
    download.value.save_as(folder / "face.png")
    with Image.open(folder / "face.png") as opened:
        return opened.convert("RGB")


def mean_light(image: Image.Image, box: tuple[float, float, float, float]) -> float:
    """Return how bright a part of an image is, 0 to 255; the box is in shares of its size."""
    wide, high = image.size
    part = image.crop(
        (int(box[0] * wide), int(box[1] * high), int(box[2] * wide), int(box[3] * high))
    ).convert("L")
    shades = part.histogram()
    return sum(shade * count for shade, count in enumerate(shades)) / sum(shades)


def test_light_theme_and_pictures(page: playwright_api.Page, url: str, tmp_path: Path) -> None:
    desk = page
    desk.set_viewport_size({"width": 1200, "height": 800})
    desk.goto(f"{url}/{PAGE}")
    settle(desk)
    corner, left_cheek, right_cheek = (
        (0, 0.3, 0.1, 0.5),
        (0.52, 0.45, 0.58, 0.6),
        (0.42, 0.45, 0.48, 0.6),
    )
    desk.get_by_role("button", name="Light and stage").click()
    desk.get_by_role("button", name="Dark", exact=True).click()
    studio = picture(desk, tmp_path)
    assert mean_light(studio, corner) < 90
    desk.get_by_role("button", name="Window", exact=True).click()
    window = picture(desk, tmp_path)
    # The window stands at its right: the other side of the face lies in shade.
    unlike = mean_light(window, right_cheek) - mean_light(window, left_cheek)
    assert unlike > mean_light(studio, right_cheek) - mean_light(studio, left_cheek) + 10
    desk.get_by_role("button", name="Light", exact=True).click()
    expect(desk.locator("html")).to_have_attribute("data-theme", "light")
    assert mean_light(picture(desk, tmp_path), corner) > 180
    desk.reload()
    settle(desk)
    expect(desk.locator("html")).to_have_attribute("data-theme", "light")


def test_the_turntable_goes_round_until_somebody_takes_the_camera(
    desk: playwright_api.Page,
) -> None:
    desk.get_by_role("button", name="Light and stage").click()
    turntable = desk.get_by_role("switch", name="Turntable")
    turntable.click()
    expect(turntable).to_be_checked()
    drawn = desk.evaluate("() => window.__viewer.framesDrawn")
    desk.wait_for_function("drawn => window.__viewer.framesDrawn > drawn + 3", arg=drawn)
    desk.keyboard.press("Escape")
    desk.locator("#face").press("ArrowLeft")
    desk.get_by_role("button", name="Light and stage").click()
    expect(turntable).not_to_be_checked()


def test_two_browsers_see_one_face_and_one_may_only_watch(
    desk: playwright_api.Page, browser: playwright_api.Browser, url: str
) -> None:
    desk.get_by_role("button", name="Share").click()
    desk.get_by_role("button", name="Copy link to watch").click()
    expect(desk.get_by_role("status").filter(has_text="on the clipboard")).to_be_visible()
    link = desk.evaluate("() => navigator.clipboard.readText()")
    assert "ticket=" in link
    guest = browser.new_page(viewport={"width": 320, "height": 240})
    try:
        guest.goto(f"{link}&level=low&dpr=0.5&draw=sketch")
        guest.wait_for_function("() => window.__viewer?.ready", timeout=120_000)
        rest = height(guest, "ch.L")
        expect(guest.locator("body")).to_have_class(re.compile("watching"))
        expect(desk.get_by_text("2 pages show this face")).to_be_visible(timeout=30_000)
        desk.keyboard.press("Escape")
        desk.get_by_role("slider", name="AU12").fill("1")
        guest.wait_for_function(
            "([name, top]) =>"
            " window.__viewer.drawnVertex(window.__viewer.landmarks[name])[1] > top",
            arg=["ch.L", rest + 2e-3],
            timeout=120_000,
        )
    finally:
        guest.close()
    desk.get_by_role("button", name=re.compile("^Share")).click()
    desk.get_by_role("button", name="Copy link to move it").click()
    expect(desk.get_by_text("A link to move this face is on the clipboard")).to_be_visible()
    session = desk.evaluate("() => window.__viewer.session")
    link = desk.evaluate("() => navigator.clipboard.readText()")
    assert link == f"{url}/?session={session}"


def test_what_the_page_did_is_told_as_a_call(desk: playwright_api.Page, url: str) -> None:
    desk.get_by_role("slider", name="AU12").fill("0.5")
    session = desk.evaluate("() => window.__viewer.session")
    desk.get_by_role("button", name="Share").click()
    call = desk.get_by_label("Call")
    expect(call).to_contain_text("curl -X PATCH")
    desk.get_by_role("button", name="Copy the call").click()
    expect(desk.get_by_text("The call is on the clipboard")).to_be_visible()
    words = shlex.split(desk.evaluate("() => navigator.clipboard.readText()"))
    assert words[3] == f"{url}/api/sessions/{session}/controls"
    body = json.loads(words[words.index("-d") + 1])
    assert body == {"action_units": {"AU12": 0.5}}
    desk.get_by_role("button", name="Python").click()
    program = call.text_content()
    assert program is not None
    # Run as it stands, with another value, it moves the face.
    exec(program.replace("0.5", "0.25"), {})
    smiles = {"AU12": 0.25}
    until(desk, url, lambda layers: layers["puppet"]["action_units"] == smiles)
