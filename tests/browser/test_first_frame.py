"""The face is there before what is slow about it is."""

from __future__ import annotations

import pytest
from playwright import sync_api as playwright_api
from viewer_page import settle

from service.benching import measure
from service.benching.page_opening import MOMENTS
from service.benching.report import sections

pytestmark = pytest.mark.browser
COUNT = """
window.__made = {programs: 0, sizes: 0};
const { linkProgram } = WebGL2RenderingContext.prototype;
WebGL2RenderingContext.prototype.linkProgram = function (program) {
  window.__made.programs++;
  return linkProgram.call(this, program);
};
const { get, set } = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, 'width');
Object.defineProperty(HTMLCanvasElement.prototype, 'width', {
  get,
  set(wide) { window.__made.sizes++; set.call(this, wide); },
});
"""
"""Counts what keeps a page without a graphics processor busiest before its first picture."""


def test_the_parts_of_a_page_s_opening_are_measured() -> None:
    figures = measure(only=["page_opening"], quick=True)
    found = figures["page_opening"]
    if "unavailable" in found:
        pytest.skip(found["unavailable"])
    moments = found["milliseconds"]
    assert tuple(moments) == MOMENTS
    order = ("script", "session", "hello", "surface", "first-frame", "complete")
    assert [moments[name] for name in order] == sorted(moments[name] for name in order)
    assert found["processor_seconds"] > 0
    (section,) = sections(figures)
    assert [row[0] for row in section.rows] == list(MOMENTS)


def test_little_is_made_for_the_first_picture(page: playwright_api.Page, url: str) -> None:
    page.add_init_script(COUNT)
    # With pixels of its own, for the page would draw finer and coarser as the machine has time.
    page.goto(f"{url}/?idle=0&level=low&dpr=0.5&draw=sketch")
    settle(page)
    made = page.evaluate("() => window.__made")
    assert 1 <= made["sizes"] <= 2, "the picture has its size before it is drawn"
    assert 2 <= made["programs"] <= 3, "of the ground, of cards of hair, of all other surfaces"


def test_a_person_who_leaves_does_not_close_the_face_of_others(
    browser: playwright_api.Browser, page: playwright_api.Page, url: str
) -> None:
    page.goto(f"{url}/?idle=0&level=low&dpr=0.3&draw=sketch")
    settle(page)
    shared = page.evaluate("() => window.__viewer.session")
    guest = browser.new_page()
    guest.set_default_timeout(120_000)
    try:
        guest.goto(f"{url}/?session={shared}&bare=1&still=1&level=low&dpr=0.2&draw=sketch")
        guest.wait_for_function("() => window.__viewer?.connected")
        page.evaluate("() => document.querySelector('#people button:nth-of-type(2)').click()")
        page.wait_for_function("id => window.__viewer.session !== id", arg=shared)
        alone = page.evaluate("() => window.__viewer.session")
        page.evaluate("() => document.querySelector('#people button:nth-of-type(1)').click()")
        page.wait_for_function("id => window.__viewer.session !== id", arg=alone)
        # What nobody watches any more is closed; then what others watch has been spared, too.
        closed = "id => fetch(`api/sessions/${id}`).then((answer) => answer.status === 404)"
        page.wait_for_function(closed, arg=alone)
        assert page.request.get(f"{url}/api/sessions/{shared}").json()["viewers"] == 1
    finally:
        guest.close()
