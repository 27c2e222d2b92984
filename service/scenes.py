"""What the viewer is photographed at: how large, how bright, and what somebody does before."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Literal
from urllib.parse import urljoin

if TYPE_CHECKING:
    from playwright.sync_api import Page

DESK, PHONE, PORTRAIT = (1440, 900), (390, 844), (480, 600)
EMOTIONS = ("Happiness", "Sadness", "Surprise", "Fear", "Anger", "Disgust")
LAYERS = ("Epidermis", "Dermis", "Hypodermis", "Bone")
_SETTLING_MS = 2500
_BLANK = "/api/health"
"""A page of the service's origin that has no script."""
_CHAT = """<!doctype html><title>A chat</title>
<style>
  body {{ margin: 0; font: 16px/1.5 system-ui; background: {ground}; color: {ink} }}
  main {{ max-width: 43rem; margin: 1rem auto; display: grid; gap: 2rem;
    grid-template-columns: 16rem 1fr; align-items: center }}
  p {{ width: fit-content; padding: 0.8rem 1rem; border-radius: 1rem; background: {bubble};
    margin: 0 0 0.6rem }}
</style>
<main>
  <risorius-face emotion="{emotion}" idle="0" dpr="2"
    style="width: 16rem"></risorius-face>
  <div><p>You made it! I was beginning to wonder.</p><p>Shall we go through your list?</p></div>
</main>
<script type="module" src="/embed.js"></script>
"""
_PAPER = {"ground": "#fbfaf8", "ink": "#222", "bubble": "#ece7df"}
_NIGHT = {"ground": "#14181d", "ink": "#e6e6e6", "bubble": "#242b33"}


@dataclass(frozen=True)
class Scene:
    """One picture.

    Attributes:
        play: What somebody does on the page before the picture is taken.
        size: Of the page [CSS pixels].
        scheme: Whether the device prefers bright pages.
        address: Of the page, the viewer's or the one from which `play` leads to another.
    """

    play: Callable[[Page], None]
    size: tuple[int, int] = DESK
    scheme: Literal["dark", "light"] = "dark"
    address: str = "/?idle=0"


def _click(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=True).click()


def _feel(emotion: str, page: Page) -> None:
    """Play an emotion, and see the face begin."""
    tick = page.evaluate("() => window.__viewer.tick")
    _click(page, emotion)
    page.wait_for_function("tick => window.__viewer.tick > tick", arg=tick)


def _rest(page: Page) -> None:
    page.wait_for_function("() => window.__viewer.asleep")


def _wander(page: Page) -> None:
    """Lead the face over the plane of feelings."""
    _click(page, "Plane")
    page.get_by_role("slider", name="Valence").fill("0.4")
    page.get_by_role("slider", name="Arousal").fill("0.65")


def _animate(page: Page) -> None:
    """Make keys of a smile by hand."""
    panel, controls = page.get_by_role("region", name="Timeline"), page.locator("#controls")
    scrub = panel.get_by_role("slider", name="Scrub")
    for moment, smile, brow in ((0, 0, 0), (1, 0.9, 0.2), (2.5, 0.7, 0.8), (4, 0, 0)):
        scrub.fill(str(moment))
        controls.get_by_role("slider", name="AU12 Lip").fill(str(smile))
        controls.get_by_role("slider", name="AU2 Outer").fill(str(brow))
        panel.get_by_role("button", name="Key").click()
    scrub.fill("1.2")


def _inside(page: Page) -> None:
    page.get_by_role("tab", name="Inside").click()


def _muscles(page: Page) -> None:
    """Draw the muscles of anger."""
    _inside(page)
    _feel("Anger", page)
    page.keyboard.press("m")


def _edit(page: Page) -> None:
    """Take a muscle in hand."""
    _inside(page)
    page.get_by_role("combobox", name="Muscle in hand").select_option("zygomatic_major.L")
    page.get_by_role("slider", name="Contract").fill("0.8")


def _peel(layer: str, page: Page) -> None:
    _inside(page)
    _feel("Happiness", page)
    page.get_by_role("group", name="Peel to").get_by_role("button", name=layer, exact=True).click()


def _colour(measure: str, page: Page) -> None:
    _inside(page)
    _feel("Happiness", page)
    group = page.get_by_role("group", name="Colour by")
    group.get_by_role("button", name=measure, exact=True).click()


def _ways(page: Page) -> None:
    """Leave the ways of points from rest to surprise."""
    _inside(page)
    page.get_by_role("switch", name="Ways of points").click()
    _feel("Surprise", page)


def _beside(whom: str, page: Page) -> None:
    """Stand a held smile, or the paper's face, beside a live one."""
    _inside(page)
    _feel("Happiness", page)
    _rest(page)
    _click(page, "Hold this moment")
    group = page.get_by_role("group", name="Beside it")
    group.get_by_role("button", name=whom, exact=True).click()
    page.locator("#legend .left[aria-busy=false]").wait_for()
    _feel("Disgust", page)
    _rest(page)
    # Who stands beside comes to rest in its own time.
    page.wait_for_timeout(_SETTLING_MS)


def _chat(emotion: str, colours: Mapping[str, str], page: Page) -> None:
    """Put a face on a page of a chat."""
    html = _CHAT.format(emotion=emotion, **colours)
    address = urljoin(page.url, "/a-chat")
    page.route(address, lambda route: route.fulfill(content_type="text/html", body=html))
    page.goto(address)
    page.locator('risorius-face:is([state="ready"], [state="resting"])').wait_for()
    frame = next(frame for frame in page.frames if frame != page.main_frame)
    frame.wait_for_function("() => window.__viewer.textured && window.__viewer.asleep")


SCENES: Mapping[str, Scene] = {
    "viewer": Scene(_wander),
    "viewer-light": Scene(
        partial(_feel, "Happiness"), scheme="light", address="/?idle=0&rig=amara"
    ),
    "viewer-phone": Scene(partial(_feel, "Happiness"), PHONE, address="/?idle=0&rig=mei"),
    "viewer-phone-light": Scene(_wander, PHONE, "light"),
    "timeline": Scene(_animate, address="/?idle=0&rig=omar"),
    **{
        f"emotion-{emotion.lower()}": Scene(partial(_feel, emotion), address="/?idle=0&view=25")
        for emotion in EMOTIONS
    },
    "inside-muscles": Scene(_muscles),
    "inside-editor": Scene(_edit, address="/?idle=0&view=40"),
    **{
        f"inside-{layer.lower()}": Scene(partial(_peel, layer), address="/?idle=0&view=25")
        for layer in LAYERS
    },
    "inside-stretch": Scene(partial(_colour, "Stretch")),
    "inside-press": Scene(partial(_colour, "Press"), scheme="light"),
    "inside-way": Scene(partial(_colour, "Way in mm")),
    "inside-ways": Scene(_ways),
    "inside-held": Scene(partial(_beside, "Held moment")),
    "inside-paper": Scene(partial(_beside, "Paper\u2019s face")),
    "embed": Scene(partial(_chat, "joy", _NIGHT), (740, 360), address=_BLANK),
    "embed-light": Scene(partial(_chat, "amusement", _PAPER), (740, 360), "light", _BLANK),
}
"""Every picture by its name: the whole viewer, six emotions, each view of the inside, the embed."""
