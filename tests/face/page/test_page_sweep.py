"""The page of a sweep in a real browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page

from grashof.sweep import Sweep, load_study, sweep

BASE = """\
kind = "path"
[path]
points = [[0, 0], [1, 1], [2, 0]]
[search]
starts = 1
enough = 1
effort = 0.2
"""
STUDY = """\
title = "<b>Bold</b>"
problem = "base.toml"
[vary]
"path.points[1].y" = [0.5, 1, 2]
"requirements.transmission_min_deg" = [20, 95]
"""


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> tuple[Sweep, Path]:
    folder = tmp_path_factory.mktemp("sweep")
    (folder / "base.toml").write_text(BASE, encoding="utf-8")
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    return sweep(load_study(folder / "study.toml"), out=folder / "out"), folder / "out" / "sweep.html"


@pytest.fixture
def shown(window: Page, done: tuple[Sweep, Path]) -> Iterator[Page]:
    """The page, opened; at the end nothing may have been complained of."""
    complaints: list[str] = []
    listeners: dict[Any, Any] = {
        "console": lambda message: complaints.append(message.text),
        "pageerror": lambda error: complaints.append(str(error)),
    }
    for event, listener in listeners.items():
        window.on(event, listener)
    window.set_viewport_size({"width": 1280, "height": 720})
    window.goto(done[1].as_uri())
    yield window
    for event, listener in listeners.items():
        window.remove_listener(event, listener)
    assert complaints == []


def state(page: Page) -> dict[str, Any]:
    found: dict[str, Any] = page.evaluate("grashof.state()")
    return found


@pytest.mark.slow
def test_a_click_shows_the_best_design(shown: Page, done: tuple[Sweep, Path]) -> None:
    assert shown.locator("h1").inner_text() == "<b>Bold</b>"
    assert shown.locator("img.picture").evaluate("image => image.naturalWidth") > 500
    assert shown.locator("tbody .thumb path").count() > 3
    assert state(shown)["chosen"] == 0
    shown.locator("#combinations tbody tr").nth(4).click()
    assert state(shown)["chosen"] == 4
    assert shown.locator("#chosen").inner_text() == "Combination 5"
    design = done[0].results[4]["drawing"]
    assert shown.locator("#angles").inner_text().startswith("θ2 ")
    driver = float(shown.locator("#angles").inner_text().split()[1].rstrip(",").replace("−", "-"))
    assert driver == pytest.approx(180 / 3.141592653589793 * design["theta2"][0], abs=0.01)


def test_one_without_a_design_states_why(shown: Page) -> None:
    note = "requirements.transmission_min_deg is 95; it must be from 0 to 90"
    row = shown.locator("#combinations tbody tr").nth(1)
    assert note in row.inner_text()
    row.click()
    assert shown.locator("#note").inner_text() == note
    assert not shown.locator("#stage").is_visible()
    shown.locator("#combinations tbody tr").nth(0).click()
    assert shown.locator("#stage").is_visible()
    assert not shown.locator("#note").is_visible()


def test_sorted_and_filtered(shown: Page, done: tuple[Sweep, Path]) -> None:
    frame = done[0].to_frame()
    header = shown.locator("#combinations th[title=size] button")
    header.click()
    by_size = frame.sort_values("size", kind="stable")["combination"].tolist()
    assert [index + 1 for index in state(shown)["listed"]] == by_size
    shown.check("[name=found]")
    assert len(state(shown)["listed"]) == 3
    shown.uncheck("[name=found]")
    shown.fill("[name=text]", "invalid")
    assert sorted(state(shown)["listed"]) == [1, 3, 5]


@pytest.mark.parametrize("width", [360, 800])
def test_no_sideways_scroll(shown: Page, width: int) -> None:
    shown.set_viewport_size({"width": width, "height": 800})
    assert shown.evaluate("document.documentElement.scrollWidth") <= width
