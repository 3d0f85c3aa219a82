"""How pages look in a real browser: on screens large and small, in the dark, on paper."""

from __future__ import annotations

import re
from itertools import combinations
from typing import TYPE_CHECKING

import pytest
from page_parts import MISSES, TITLE
from shown_pages import Open, box_of, state

if TYPE_CHECKING:
    from playwright.sync_api import Page


def open_all(page: Page) -> None:
    if page.locator("#open-all").count():
        page.locator("#open-all").click()


@pytest.mark.parametrize(("name", "width"), [("search", 360), ("swift", 1400)])
def test_numbers_of_the_axes_stand_apart(opened: Open, name: str, width: int) -> None:
    page = opened(name, size=(width, 900))
    boxes = [each.bounding_box() for each in page.locator("#stage .numbers text").all()]
    assert len(boxes) > 5
    for one, other in combinations([box for box in boxes if box], 2):
        gaps = (
            max(one[axis], other[axis]) - min(one[axis] + one[side], other[axis] + other[side])
            for axis, side in (("x", "width"), ("y", "height"))
        )
        assert max(gaps) > 0


def test_a_title_with_a_script_is_only_text(opened: Open) -> None:
    for name in ("search", "rocker"):
        page = opened(name)
        assert page.locator("h1").inner_text() == TITLE
        assert page.title() == TITLE


@pytest.mark.parametrize("name", ["search", "missed", "sections"])
def test_a_phone_has_no_sideways_scroll(opened: Open, name: str) -> None:
    page = opened(name, touch=True)
    open_all(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    assert page.locator("#stage .grid").count() == 1


@pytest.mark.parametrize("name", ["search", "missed", "sections"])
def test_no_window_has_sideways_scroll(opened: Open, name: str) -> None:
    page = opened(name, size=(800, 900))
    open_all(page)
    for width in (800, 1400):
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_dark_and_printed(opened: Open) -> None:
    page = opened("search", color_scheme="dark")
    paper = "getComputedStyle(document.body).backgroundColor"
    assert page.evaluate(paper) == "rgb(20, 25, 30)"
    page.emulate_media(media="print")
    assert page.evaluate(paper) == "rgb(255, 255, 255)"
    assert not page.locator("#player").is_visible()
    assert page.locator("#stage").is_visible()
    assert page.locator("table.designs").is_visible()


def test_what_is_missed_is_not_called_a_design(opened: Open) -> None:
    page = opened("missed")
    assert page.locator("#chosen").inner_text() == "Closest miss 1"
    assert page.locator("#misses").inner_text() == MISSES
    page = opened("nothing")
    assert state(page)["design"] is None
    assert page.locator("#stage .body").count() == 4


OVERLAPS = """
() => {
  const names = [...document.querySelectorAll("#stage .number, #stage .linkage text, #stage .ground text")];
  const boxes = names.map((node) => [node.textContent, node.getBoundingClientRect()]);
  return boxes.flatMap(([one, a], k) => boxes.slice(k + 1).filter(([, b]) =>
    Math.min(a.right, b.right) - Math.max(a.left, b.left) > 2 &&
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 5
  ).map(([other]) => `${one} on ${other}`));
}
"""


@pytest.mark.parametrize("name", ["search", "design"])
def test_names_of_joints_and_targets_do_not_cover_each_other(opened: Open, name: str) -> None:
    page = opened(name, size=(1440, 900))
    page.locator("#stage").focus()
    for _ in range(4):
        assert page.evaluate(OVERLAPS) == []
        for _ in range(10):
            page.keyboard.press("PageUp")


def test_the_analysis_of_a_design_shows_its_targets(opened: Open) -> None:
    page = opened("design")
    assert page.locator("#stage .number").all_text_contents() == ["1", "2", "3", "4"]
    assert page.locator("#stage .body:not(.live)").count() == 4
    assert page.locator("#stage .body.live").count() == 1
    assert page.locator("#stage .ghosts path").count() == 0
    page.check("#ghosts")
    assert page.locator("#stage .ghosts path").count() >= 4 * 3


@pytest.mark.parametrize("name", ["missed", "nothing"])
def test_a_page_without_designs_uses_its_width(opened: Open, name: str) -> None:
    page = opened(name, size=(1440, 900))
    drawing = box_of(page.locator("#stage"))
    beside = box_of(page.locator("#designs, .split > div").first)
    left, right = sorted((drawing, beside), key=lambda box: box["x"])
    assert left["x"] + left["width"] <= right["x"]
    assert right["x"] + right["width"] > 1400
    assert beside["height"] > 0.3 * drawing["height"]
    for heading in ("^Requirements$", "^Record of the search"):
        assert page.get_by_role("heading", name=re.compile(heading)).count() == 1


def test_what_would_do_is_listed_at_the_top(opened: Open) -> None:
    page = opened("relaxed", size=(1440, 900))
    assert page.locator("#note p").inner_text() == "No design; each of these alone would do:"
    ways = page.locator("#note li")
    assert ways.all_inner_texts() == ["order = false", "transmission_min_deg 13 instead of 60"]
    box = box_of(ways.last)
    assert box["y"] + box["height"] < 200


@pytest.mark.parametrize("name", ["swinging", "missed"])
def test_no_box_scrolls_within_the_page(opened: Open, name: str) -> None:
    page = opened(name, size=(1440, 900))
    inner = "[...document.querySelectorAll('main *')].filter((node) => "
    inner += (
        "/auto|scroll/.test(getComputedStyle(node).overflowY) && node.scrollHeight > node.clientHeight + 1)"
    )
    inner += ".map((node) => node.getAttribute('aria-label') || node.className)"
    for group in page.locator("#close-all").all():
        group.click()
    assert page.evaluate(inner) == []
