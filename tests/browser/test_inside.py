"""The muscles drawn over the face, and layers that cover the flesh in the mouth."""

from __future__ import annotations

import io
import re
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from playwright import sync_api as playwright_api
from viewer_page import settle

pytestmark = pytest.mark.browser

NOTICEABLE = 12
"""Of 255: less is a pixel that is drawn alike."""


@pytest.fixture(scope="module")
def opened(browser: playwright_api.Browser, url: str) -> playwright_api.Page:
    """One page for all of them, with the face in its own materials."""
    page = browser.new_page(viewport={"width": 1200, "height": 800})
    page.set_default_timeout(120_000)
    page.goto(f"{url}/?idle=0&level=low&dpr=0.5&view=front")
    # A first sketch, as software draws it, has other colours.
    page.wait_for_function("() => window.__viewer?.textured")
    settle(page)
    return page


def middle(page: playwright_api.Page) -> NDArray[Any]:
    """Return the middle of the face as it is drawn, (h, w, 3), 0 to 255."""
    page.evaluate("() => window.__viewer.render()")
    with Image.open(io.BytesIO(page.locator("#face").screenshot())) as taken:
        wide, high = taken.size
        box = (int(0.4 * wide), int(0.3 * high), int(0.6 * wide), int(0.75 * high))
        return np.asarray(taken.convert("RGB").crop(box), dtype=float)


def switch(page: playwright_api.Page, *, shown: bool) -> None:
    """Show or hide the muscles by their key, so that no menu covers the face."""
    page.keyboard.press("m")
    control = page.get_by_role("switch", name="Muscles", include_hidden=True)
    expected = playwright_api.expect(control)
    if shown:
        expected.to_be_checked()
    else:
        expected.not_to_be_checked()


def brought_by_muscles(page: playwright_api.Page) -> tuple[float, NDArray[Any]]:
    """Show and hide the muscles; return their share of the picture, and their colour."""
    bare = middle(page)
    switch(page, shown=True)
    page.wait_for_timeout(600)  # They take up their glow by and by.
    over = middle(page)
    switch(page, shown=False)
    page.wait_for_timeout(100)
    assert np.abs(middle(page) - bare).max() < NOTICEABLE
    changed = np.abs(over - bare).max(axis=2) > NOTICEABLE
    return float(changed.mean()), over[changed].mean(axis=0)


def test_gums_do_not_come_through_the_hypodermis(opened: playwright_api.Page) -> None:
    page = opened
    page.get_by_role("tab", name="Inside").click()
    peel = page.get_by_role("group", name="Peel to")
    with page.expect_response(re.compile("/layers$")):
        peel.get_by_role("button", name="Hypodermis", exact=True).click()
    page.get_by_role("slider", name="Cut").fill("-90")
    page.wait_for_timeout(400)
    page.evaluate("() => window.__viewer.render()")
    with Image.open(io.BytesIO(page.locator("#face").screenshot())) as taken:
        picture = np.asarray(taken.convert("RGB"), dtype=float)
    high, wide, _ = picture.shape
    # Below the chin lies the skin of the neck.
    mouth = picture[int(0.55 * high) : int(0.72 * high), int(0.4 * wide) : int(0.6 * wide)]
    red, green, blue = np.moveaxis(mouth, 2, 0)
    flesh = float(((red > green + 25) & (red > blue + 10)).mean())
    peel.get_by_role("button", name="Skin").click()
    assert flesh < 0.0005, flesh


def over_the_face(page: playwright_api.Page) -> NDArray[Any]:
    """Return what is drawn of forehead, nose and cheek, three-quarter, (h, w, 3), 0 to 255."""
    page.evaluate("() => window.__viewer.render()")
    with Image.open(io.BytesIO(page.locator("#face").screenshot())) as taken:
        wide, high = taken.size
        box = (int(0.34 * wide), int(0.3 * high), int(0.6 * wide), int(0.58 * high))
        return np.asarray(taken.convert("RGB").crop(box), dtype=float)


def test_nothing_behind_the_head_is_seen_through_it_where_it_is_peeled(
    opened: playwright_api.Page, url: str
) -> None:
    page = opened
    controls = f"{url}/api/sessions/{page.evaluate('() => window.__viewer.session')}/controls"
    tick = page.evaluate("() => window.__viewer.tick")
    assert page.request.put(controls, data={"jaw": {"pitch": 28}}).ok
    settle(page, tick)
    page.get_by_role("tab", name="Inside").click()
    peel = page.get_by_role("group", name="Peel to")
    with page.expect_response(re.compile("/layers$")):
        peel.get_by_role("button", name="Bone", exact=True).click()
    page.get_by_role("slider", name="Cut").fill("0")
    page.evaluate("() => window.__viewer.setView(35)")
    page.wait_for_timeout(1500)
    page.evaluate("() => window.__viewer.setGround('dark')")
    dark = over_the_face(page)
    page.evaluate("() => window.__viewer.setGround('light')")
    light = over_the_face(page)
    page.evaluate("() => window.__viewer.setView('front')")
    peel.get_by_role("button", name="Skin").click()
    tick = page.evaluate("() => window.__viewer.tick")
    assert page.request.put(controls, data={}).ok
    settle(page, tick)
    seen = float((np.abs(light - dark).max(axis=2) > NOTICEABLE).mean())
    assert seen == 0.0, seen


def test_muscles_are_seen_and_glow_as_they_contract(opened: playwright_api.Page) -> None:
    page = opened
    page.get_by_role("button", name="Light and stage").click()
    page.get_by_role("switch", name="Muscles").click()
    playwright_api.expect(page.get_by_role("switch", name="Muscles")).to_be_checked()
    page.keyboard.press("Escape")
    switch(page, shown=False)
    share, slack = brought_by_muscles(page)
    assert share > 0.2
    assert slack[0] > 1.3 * slack[1:].max()
    tick = page.evaluate("() => window.__viewer.tick")
    page.get_by_role("button", name="Happiness").click()
    settle(page, tick)
    share, contracted = brought_by_muscles(page)
    assert share > 0.2
    assert contracted[0] > slack[0] + 5.0


def test_the_muscle_in_hand_is_seen_apart_before_it_contracts(opened: playwright_api.Page) -> None:
    page = opened
    page.get_by_role("button", name="Neutral").click()
    page.get_by_role("tab", name="Inside").click()
    in_hand = page.get_by_role("combobox", name="Muscle in hand")
    blue: dict[str, float] = {}
    for name in ("", "orbicularis_oris"):
        in_hand.select_option(name)
        page.wait_for_timeout(600)
        picture = middle(page)
        blue[name] = float((picture[..., 2] > picture[..., 0] + 40.0).mean())
    in_hand.select_option("")
    switch(page, shown=False)
    assert blue[""] < 0.001
    # Its outline alone is less than a hundredth of the picture.
    assert blue["orbicularis_oris"] > 0.015, blue
