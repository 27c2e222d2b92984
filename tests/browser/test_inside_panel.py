"""See inside, as a person would: a muscle moved, layers peeled, colours, ways, two moments."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest
from PIL import Image
from playwright import sync_api as playwright_api
from viewer_page import settle

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def opened(browser: playwright_api.Browser, url: str) -> playwright_api.Page:
    """One page for all of them, at its panel of the inside."""
    page = browser.new_page(viewport={"width": 900, "height": 640})
    page.set_default_timeout(120_000)
    page.goto(f"{url}/?idle=0&level=low&dpr=0.5&view=front&draw=sketch")
    settle(page)
    page.get_by_role("tab", name="Inside").click()
    return page


def point(page: playwright_api.Page, landmark: str) -> np.ndarray:
    """Return where a landmark is drawn, mm."""
    script = "name => window.__viewer.drawnVertex(window.__viewer.landmarks[name])"
    return np.array(page.evaluate(script, landmark))


def stage(page: playwright_api.Page) -> np.ndarray:
    """Return the picture of the stage, shape (height, width, 3)."""
    page.evaluate("() => window.__viewer.render()")
    with Image.open(io.BytesIO(page.locator("#face").screenshot())) as taken:
        return np.asarray(taken.convert("RGB")).astype(float)


def middle(picture: np.ndarray, left: float, right: float) -> np.ndarray:
    """Return the part of a picture between two shares of its width, at the height of the face."""
    high, wide, _ = picture.shape
    return picture[int(0.3 * high) : int(0.7 * high), int(left * wide) : int(right * wide)]


def play(page: playwright_api.Page, emotion: str) -> None:
    tick = page.evaluate("() => window.__viewer.tick")
    page.get_by_role("button", name=emotion, exact=True).click()
    settle(page, tick)


def until_rig_is_not(page: playwright_api.Page, rig: str) -> str:
    """Wait until an edit has moved the face to another rig, and that is shown; return its id."""
    page.wait_for_function("rig => window.__viewer.rig !== rig", arg=rig)
    return str(page.evaluate("() => window.__viewer.rig"))


def handles(page: playwright_api.Page) -> dict[str, np.ndarray]:
    """Return where the handles of the muscle in hand are drawn on the page, CSS pixels."""
    places = page.evaluate("() => window.__viewer.handles")
    return {name: np.array([place["x"], place["y"]]) for name, place in places.items()}


def until_edits_are_over(page: playwright_api.Page) -> None:
    """Wait until no edit has come for a while, and the face that they made is still."""
    rig = ""
    while rig != (rig := page.evaluate("() => window.__viewer.rig")):
        page.wait_for_timeout(2500)
    settle(page)


def test_a_muscle_follows_its_handle_and_the_face_the_muscle(opened: playwright_api.Page) -> None:
    page = opened
    page.get_by_role("combobox", name="Muscle in hand").select_option("zygomatic_major.L")
    resting = handles(page)
    tick = page.evaluate("() => window.__viewer.tick")
    page.get_by_role("slider", name="Contract").fill("1")
    settle(page, tick)
    drawn = handles(page)
    assert np.linalg.norm(drawn["insertion"] - resting["insertion"]) > 4, "with the skin"
    assert np.linalg.norm(drawn["attachment"] - resting["attachment"]) < 0.5, "on the bone"
    field = page.get_by_role("spinbutton", name="Insertion y")
    insertion = float(field.input_value())
    page.mouse.move(*drawn["insertion"])
    page.mouse.down()
    page.mouse.move(*drawn["insertion"])
    page.mouse.up()
    assert float(field.input_value()) == pytest.approx(insertion, abs=0.3), "as it is at rest"
    page.get_by_role("button", name="Undo edit").click()
    until_edits_are_over(page)
    before = {side: point(page, f"ch.{side}") for side in "LR"}
    rig = page.evaluate("() => window.__viewer.rig")
    at = page.evaluate("() => window.__viewer.handles.attachment")
    page.mouse.move(at["x"], at["y"])
    page.mouse.down()
    page.mouse.move(at["x"] + 3, at["y"] - 12, steps=2)
    page.mouse.move(at["x"] + 4, at["y"] - 24, steps=2)
    page.mouse.up()
    until_rig_is_not(page, rig)
    until_edits_are_over(page)
    moved = {side: np.linalg.norm(point(page, f"ch.{side}") - before[side]) for side in "LR"}
    assert moved["L"] > 0.5, moved
    assert moved["L"] > 4 * moved["R"], moved
    undo = page.get_by_role("button", name="Undo edit")
    while undo.is_enabled():
        rig = page.evaluate("() => window.__viewer.rig")
        undo.click()
        until_rig_is_not(page, rig)
    until_edits_are_over(page)
    assert np.linalg.norm(point(page, "ch.L") - before["L"]) < 0.2
    playwright_api.expect(page.get_by_role("button", name="Reset muscle")).to_be_disabled()


def test_bone_ends_ride_the_open_jaw_and_are_edited_at_rest(
    opened: playwright_api.Page, url: str
) -> None:
    page = opened
    page.get_by_role("combobox", name="Muscle in hand").select_option("depressor_anguli_oris.L")
    shut = handles(page)
    field = page.get_by_role("spinbutton", name="Attachment y")
    attachment = float(field.input_value())
    address = f"{url}/api/sessions/{page.evaluate('() => window.__viewer.session')}/controls"
    tick = page.evaluate("() => window.__viewer.tick")
    page.request.patch(address, data={"jaw": {"pitch": 24}, "fade": 0.1})
    settle(page, tick)
    drawn = handles(page)
    assert drawn["attachment"][1] - shut["attachment"][1] > 10, "down with the jaw"
    page.mouse.move(*drawn["attachment"])
    page.mouse.down()
    page.mouse.move(*drawn["attachment"])
    page.mouse.up()
    assert float(field.input_value()) == pytest.approx(attachment, abs=0.3), "as it is at rest"
    page.get_by_role("button", name="Undo edit").click()
    page.request.patch(address, data={"jaw": {"pitch": 0}, "fade": 0.1})
    until_edits_are_over(page)


def test_numbers_edit_a_muscle_and_a_new_unit_is_saved_with_it(
    opened: playwright_api.Page, url: str
) -> None:
    page = opened
    in_hand = page.get_by_role("combobox", name="Muscle in hand")
    muscles = page.request.get(f"{url}/api/rigs/standard").json()["muscles"]
    assert in_hand.locator("option").count() == 1 + sum(m["kind"] != "air" for m in muscles)
    in_hand.select_option("levator_palpebrae.L")
    lid = page.get_by_role("slider", name="Upper lid down")
    assert float(lid.input_value()) == pytest.approx(-11.5)
    assert handles(page) == {}
    in_hand.select_option("risorius.L")
    rig = page.evaluate("() => window.__viewer.rig")
    field = page.get_by_role("spinbutton", name="Attachment y")
    value = float(field.input_value()) + 4
    field.fill(str(value))
    field.press("Enter")
    rig = until_rig_is_not(page, rig)
    add = page.get_by_role("combobox", name="Add a muscle")
    add.select_option("risorius.L")
    add.select_option("frontalis_medial.L")
    tick = page.evaluate("() => window.__viewer.tick")
    page.get_by_role("slider", name="Try it").fill("1")
    settle(page, tick)
    merged = page.request.get(
        f"{url}/api/sessions/{page.evaluate('() => window.__viewer.session')}"
    ).json()["merged"]
    assert merged["muscles"]["frontalis_medial.L"] == 1
    page.get_by_label("Name of the unit").fill("AU102")
    page.get_by_label("Name of the rig").fill("Half a doubt")
    page.get_by_role("button", name="Save as a rig").click()
    rig = until_rig_is_not(page, rig)
    settle(page)
    saved = page.request.get(f"{url}/api/rigs/{rig}").json()
    units = {unit["name"]: unit["muscles"] for unit in saved["action_units"]}
    assert units["AU102"] == {"risorius.L": 1, "frontalis_medial.L": 1}
    assert saved["name"] == "Half a doubt"
    (risorius,) = (each for each in saved["muscles"] if each["name"] == "risorius.L")
    assert risorius["attachment"][1] == pytest.approx(value)
    page.get_by_role("combobox", name="Muscle in hand").select_option("")
    page.keyboard.press("m")


def test_skin_is_coloured_by_strain_and_points_leave_ways(opened: playwright_api.Page) -> None:
    page = opened
    page.get_by_role("button", name="Reset", exact=True).click()
    page.get_by_role("group", name="Colour by").get_by_role("button", name="Stretch").click()
    legend = page.locator("#legend output")
    at_rest = re.compile(r"up to 0\.\d %")
    playwright_api.expect(legend).to_have_text(at_rest, timeout=30_000)
    settle(page)
    face = middle(stage(page), 0.42, 0.58).mean(axis=(0, 1))
    assert face[2] > 1.3 * face[1], f"at rest it has the first colour of the ramp, not {face}"
    page.get_by_role("switch", name="Ways of points").click()
    play(page, "Happiness")
    playwright_api.expect(legend).to_have_text(re.compile(r"up to [1-9]\d\.\d %"))
    strained = middle(stage(page), 0.42, 0.58).mean(axis=(0, 1))
    assert strained[1] > face[1] + 8
    playwright_api.expect(page.locator(".times")).to_contain_text(" s ago")
    page.get_by_role("group", name="Colour by").get_by_role("button", name="Skin").click()
    with_ways = stage(page)
    page.get_by_role("switch", name="Ways of points").click()
    assert np.abs(with_ways - stage(page)).max() > 60


def test_layers_are_peeled_from_half_a_face(opened: playwright_api.Page) -> None:
    page = opened
    peel = page.get_by_role("group", name="Peel to")
    whole = stage(page)
    seen = [whole]
    for layer in ("Epidermis", "Dermis", "Hypodermis", "Bone"):
        with page.expect_response(re.compile("/layers$|tissue.glb")):
            peel.get_by_role("button", name=layer, exact=True).click()
        page.wait_for_timeout(400)
        seen.append(stage(page))
        # The face's own left is on the right of the picture.
        peeled = np.abs(middle(seen[-1], 0.54, 0.62) - middle(seen[-2], 0.54, 0.62)).mean()
        assert peeled > 4, layer
        assert np.abs(middle(seen[-1], 0.4, 0.48) - middle(whole, 0.4, 0.48)).mean() < 4, layer
    page.get_by_role("slider", name="Cut").fill("90")
    assert np.abs(middle(stage(page), 0.4, 0.62) - middle(whole, 0.4, 0.62)).mean() < 4
    peel.get_by_role("button", name="Skin").click()


def test_a_held_moment_and_the_papers_face_stand_beside(opened: playwright_api.Page) -> None:
    page = opened
    beside = page.get_by_role("group", name="Beside it")
    playwright_api.expect(beside.get_by_role("button", name="Held moment")).to_be_disabled()
    page.get_by_role("button", name="Hold this moment").click()
    play(page, "Surprise")
    with page.expect_response(re.compile(r"surface\.glb")):
        beside.get_by_role("button", name="Held moment").click()
    playwright_api.expect(page.locator("#legend")).to_contain_text("Held moment")
    page.wait_for_timeout(1500)
    both = stage(page)
    play(page, "Anger")
    later = stage(page)
    # Who is held stays as they were; who lives goes on.
    assert np.abs(middle(both, 0.0, 0.48) - middle(later, 0.0, 0.48)).mean() < 1.5
    assert np.abs(middle(both, 0.55, 0.95) - middle(later, 0.55, 0.95)).mean() > 2
    page.get_by_role("group", name="Colour by").get_by_role("button", name="Way in mm").click()
    playwright_api.expect(page.locator("#legend")).to_contain_text("since the held moment")
    page.get_by_role("group", name="Colour by").get_by_role("button", name="Skin").click()
    with page.expect_response(re.compile(r"surface\.glb")):
        beside.get_by_role("button", name="Paper\u2019s face").click()
    page.wait_for_timeout(3000)
    angry = stage(page)
    page.get_by_role("button", name="Neutral", exact=True).click()
    page.wait_for_timeout(4000)
    assert np.abs(middle(angry, 0.05, 0.45) - middle(stage(page), 0.05, 0.45)).mean() > 1
    beside.get_by_role("button", name="Nobody").click()
