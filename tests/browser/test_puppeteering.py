"""Somebody moves a face in the page: the plane of feelings, FACS, search, undoing, keys."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright import sync_api as playwright_api
from viewer_page import settle, until

pytestmark = pytest.mark.browser
PAGE = "?idle=0&level=low&dpr=0.5&draw=sketch"
"""A face at rest, drawn as cheaply as it goes: what counts here are the panels."""
expect = playwright_api.expect


@pytest.fixture
def desk(page: playwright_api.Page, url: str) -> playwright_api.Page:
    """A page as wide as on a desk, its face open and still."""
    page.set_viewport_size({"width": 1200, "height": 800})
    page.goto(f"{url}/{PAGE}")
    settle(page)
    return page


def mostly(layers: dict[str, Any]) -> str:
    """Return the recipe that is most of what a point among feelings plays."""
    played = layers.get("emotion", {}).get("emotion", {"found": "", "parts": []})
    parts = played["parts"] if played["found"] == "coordinates" else []
    return str(max(parts, key=lambda part: part["weight"], default={"recipe": ""})["recipe"])


def test_a_face_is_led_through_feelings(desk: playwright_api.Page, url: str) -> None:
    desk.get_by_role("button", name="Plane").click()
    plane = desk.locator(".plane")
    expect(plane.get_by_text("happiness")).to_be_visible()
    box = plane.bounding_box()
    assert box is not None
    desk.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    desk.mouse.down()
    for share in (0.7, 0.9):
        desk.mouse.move(box["x"] + share * box["width"], box["y"] + 0.25 * box["height"])
    desk.mouse.up()
    valence, arousal = (desk.get_by_role("slider", name=name) for name in ("Valence", "Arousal"))
    expect(valence).to_have_attribute("aria-valuetext", re.compile("^0.80, near happiness"))
    expect(arousal).to_have_value("0.5")
    until(desk, url, lambda layers: mostly(layers) == "happiness")
    for _ in range(3):
        valence.press("Shift+ArrowLeft")
    expect(valence).to_have_value("0.2")
    valence.press("Delete")
    expect(desk.get_by_role("button", name="Neutral")).to_have_attribute("aria-pressed", "true")
    until(desk, url, lambda layers: "emotion" not in layers)


def test_facs_is_written_and_follows_the_sliders(desk: playwright_api.Page, url: str) -> None:
    facs = desk.get_by_role("textbox", name="FACS")
    facs.fill("1c + L12D+26")
    facs.press("Enter")
    expect(facs).to_have_value("1C+L12D+26C")
    expect(desk.get_by_role("slider", name="L12")).to_have_value("0.8")
    layers = until(desk, url, lambda layers: "puppet" in layers)
    assert layers["puppet"]["action_units"] == pytest.approx({"AU1": 0.6, "L12": 0.8, "AU26": 0.6})
    desk.get_by_role("slider", name="AU1 Inner").fill("0.37")
    expect(facs).to_have_value("1:0.37+L12D+26C")
    facs.fill("12C+99")
    facs.press("Enter")
    expect(desk.get_by_role("alert")).to_contain_text("FACS has no code 99")
    expect(facs).to_have_attribute("aria-invalid", "true")
    facs.press("Escape")
    expect(facs).to_have_value("1:0.37+L12D+26C")
    facs.fill("12C+99")
    facs.press("Enter")
    expect(desk.get_by_role("alert")).to_be_visible()
    desk.get_by_role("slider", name="AU1 Inner").fill("0.6")
    expect(facs).to_have_value("1C+L12D+26C")
    expect(facs).to_have_attribute("aria-invalid", "false")
    facs.fill("")
    facs.press("Enter")
    expect(desk.get_by_role("slider", name="AU26")).to_have_value("0")
    until(desk, url, lambda layers: layers == {})


def test_units_are_found_by_number_name_and_muscle(desk: playwright_api.Page) -> None:
    search = desk.get_by_role("searchbox", name="Find an action unit")
    units = desk.locator("#controls").get_by_role("slider")
    for sought, found in (("12", ["AU12"]), ("inner brow", ["AU1"]), ("zygomatic major", ["AU12"])):
        search.fill(sought)
        expect(units).to_have_count(len(found))
        expect(units.first).to_have_attribute("aria-label", re.compile(f"^{found[0]} "))
    search.fill("no such thing")
    expect(desk.get_by_text("No action unit has that")).to_be_visible()


def test_what_was_done_is_undone_by_button_and_by_key(desk: playwright_api.Page, url: str) -> None:
    undo = desk.get_by_role("button", name="Undo", exact=True)
    expect(undo).to_be_disabled()
    smile, emotion = (
        desk.get_by_role("slider", name="AU12"),
        desk.get_by_role("slider", name="AU4 Brow"),
    )
    smile.fill("0.8")
    desk.get_by_role("button", name="Fear").click()
    emotion.fill("0.5")
    undo.click()
    expect(emotion).to_have_value("0")
    desk.keyboard.press("Control+z")
    neutral = desk.get_by_role("button", name="Neutral")
    expect(neutral).to_have_attribute("aria-pressed", "true")
    expect(smile).to_have_value("0.8")
    desk.keyboard.press("Control+z")
    expect(smile).to_have_value("0")
    expect(undo).to_be_disabled()
    desk.keyboard.press("Control+Shift+z")
    expect(smile).to_have_value("0.8")
    layers = until(desk, url, lambda layers: set(layers) == {"puppet"})
    assert layers["puppet"]["action_units"] == pytest.approx({"AU12": 0.8})
    smile.dblclick()
    until(desk, url, lambda layers: layers == {})


def test_keys_alone_will_do(desk: playwright_api.Page, url: str) -> None:
    desk.keyboard.press("?")
    keys = desk.get_by_role("dialog", name="Keys")
    expect(keys.get_by_text("Happiness")).to_be_visible()
    desk.keyboard.press("Escape")
    expect(keys).to_be_hidden()
    desk.keyboard.press("1")
    happiness = desk.get_by_role("button", name="Happiness")
    expect(happiness).to_have_attribute("aria-pressed", "true")
    desk.keyboard.press("f")
    expect(desk.get_by_role("textbox", name="FACS")).to_be_focused()
    # What is written in a field is no command.
    desk.keyboard.type("0")
    expect(happiness).to_have_attribute("aria-pressed", "true")
    desk.keyboard.press("Escape")
    desk.locator("#face").focus()
    drawn = desk.evaluate("() => window.__viewer.framesDrawn")
    desk.keyboard.press("ArrowRight")
    desk.wait_for_function("drawn => window.__viewer.framesDrawn > drawn", arg=drawn)
    desk.keyboard.press("v")
    view = desk.get_by_role("button", name="three-quarter")
    expect(view).to_have_attribute("aria-pressed", "true")
    desk.keyboard.press("0")
    until(desk, url, lambda layers: layers == {})


def test_the_eyes_are_led_on_a_plane(desk: playwright_api.Page, url: str) -> None:
    desk.get_by_role("tab", name="Pose").click()
    plane = desk.locator(".gaze .plane")
    box = plane.bounding_box()
    assert box is not None
    desk.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    desk.mouse.down()
    desk.mouse.move(box["x"] + 0.75 * box["width"], box["y"] + 0.25 * box["height"], steps=3)
    desk.mouse.up()
    left, up = (desk.get_by_role("slider", name=name) for name in ("Gaze to its left", "Gaze up"))
    expect(left).to_have_attribute("aria-valuetext", re.compile("^2[1-4]°"))
    up.press("ArrowDown")
    layers = until(desk, url, lambda layers: "puppet" in layers)
    assert layers["puppet"]["gaze"]["yaw"] == pytest.approx(22.5, abs=1.5)
    until(desk, url, lambda layers: 15 <= layers["puppet"]["gaze"]["pitch"] <= 18)
    up.press("Delete")
    until(desk, url, lambda layers: layers == {})
