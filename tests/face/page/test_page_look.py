"""How pages look in a real browser: on screens large and small, in the dark, on paper."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from typing import Any

import pytest
from playwright.sync_api import Page

Open = Callable[..., Page]


def state(page: Page) -> dict[str, Any]:
    found: dict[str, Any] = page.evaluate("grashof.state()")
    return found


def open_all(page: Page) -> None:
    if page.locator("#open-all").count():
        page.locator("#open-all").click()


@pytest.mark.parametrize("width", [360, 1400])
@pytest.mark.parametrize("name", ["search", "missed", "rocker", "swift"])
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


def test_a_title_with_a_script_is_only_text(opened: Open, title: str) -> None:
    for name in ("search", "rocker"):
        page = opened(name)
        assert page.locator("h1").inner_text() == title
        assert page.title() == title


@pytest.mark.parametrize("name", ["search", "missed", "nothing", "rocker", "sections"])
def test_a_phone_has_no_sideways_scroll(opened: Open, name: str) -> None:
    page = opened(name, touch=True)
    open_all(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    assert page.locator("#stage .grid").count() == 1


@pytest.mark.parametrize("width", [800, 1400])
@pytest.mark.parametrize("name", ["search", "missed", "nothing", "sections"])
def test_no_window_has_sideways_scroll(opened: Open, name: str, width: int) -> None:
    page = opened(name, size=(width, 900))
    open_all(page)
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


def test_what_is_missed_is_not_called_a_design(opened: Open, misses: str) -> None:
    page = opened("missed")
    assert page.locator("#chosen").inner_text() == "Closest miss 1"
    assert page.locator("#misses").inner_text() == misses
    page = opened("nothing")
    assert state(page)["design"] is None
    assert page.locator("#stage .body").count() == 4
