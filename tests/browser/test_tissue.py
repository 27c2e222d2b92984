"""Tissue of a region and of another age, changed in the panel on a living face."""

from __future__ import annotations

import pytest
from playwright import sync_api as playwright_api
from viewer_page import held, settle

pytestmark = pytest.mark.browser
expect = playwright_api.expect


def tissue_of(page: playwright_api.Page, url: str) -> dict[str, object]:
    """Return the tissue's numbers of the face that the page shows."""
    rig = held(page, url)["rig"]
    tissue: dict[str, object] = page.request.get(f"{url}/api/rigs/{rig}").json()["tissue"]
    return tissue


def test_tissue_of_a_region_and_of_another_age(page: playwright_api.Page, url: str) -> None:
    page.set_viewport_size({"width": 1200, "height": 800})
    page.goto(f"{url}/?idle=0&level=low&dpr=0.5&draw=sketch")
    settle(page)
    rig = held(page, url)["rig"]
    page.get_by_role("tab", name="Tissue").click()
    region = page.get_by_role("region", name="One region")
    region.get_by_label("Region").select_option("nasolabial")
    region.get_by_label("Side").select_option("Its left")
    region.get_by_role("slider", name="Laxity").fill("0.8")
    page.wait_for_function("rig => window.__viewer.rig !== rig", arg=rig)
    assert tissue_of(page, url)["region_laxity"] == {"nasolabial.L": 0.8}
    edited = held(page, url)["rig"]
    page.get_by_role("button", name="Restore the tissue").click()
    page.wait_for_function("rig => window.__viewer.rig !== rig", arg=edited)
    expect(region.get_by_role("slider", name="Laxity")).to_have_value("0")
    session = page.evaluate("() => window.__viewer.session")
    page.get_by_role("button", name="Old", exact=True).click()
    page.wait_for_function("session => window.__viewer.session !== session", arg=session)
    settle(page)
    assert tissue_of(page, url)["muscle_strength"] < 1.0  # type: ignore[operator]
    # A sketch is all that was asked for: nobody fetched maps.
    fetched = page.evaluate("() => performance.getEntriesByType('resource').map((e) => e.name)")
    assert any("surface.glb" in name for name in fetched)
    assert not any("/textures/" in name for name in fetched)
