"""The page of a sweep in a real browser."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from command_runs import BASE
from page_parts import RECORD
from shown_pages import state, without_complaints

from grashof.sweep import Sweep, load_study, sweep
from grashof.sweep.page import sweep_page

if TYPE_CHECKING:
    from playwright.sync_api import Page

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
    with without_complaints(window):
        window.set_viewport_size({"width": 1280, "height": 720})
        window.goto(done[1].as_uri())
        yield window


@pytest.mark.slow
def test_a_click_shows_the_best_design(shown: Page, done: tuple[Sweep, Path]) -> None:
    assert shown.locator("h1").inner_text() == "<b>Bold</b>"
    assert shown.locator("tbody .thumb path").count() > 3
    shown.locator("#combinations tbody tr").nth(4).click()
    assert state(shown)["chosen"] == 4
    assert shown.locator("#chosen").inner_text() == "Combination 5"
    design = done[0].results[4]["drawing"]
    assert shown.locator("#angles").inner_text().startswith("θ2 ")
    driver = float(shown.locator("#angles").inner_text().split()[1].rstrip(",").replace("−", "-"))
    assert driver == pytest.approx(180 / 3.141592653589793 * design["theta2"][0], abs=0.01)


def test_it_opens_on_the_best_and_a_cell_picks_its_combination(shown: Page, done: tuple[Sweep, Path]) -> None:
    frame = done[0].to_frame().drop_duplicates("combination").set_index("combination")
    values = frame["transmission_min_task_deg"]
    assert state(shown)["chosen"] + 1 == values.idxmax()
    cells = shown.locator("#tradeoff .cell")
    assert cells.count() == 6
    texts = {
        int(cell.get_attribute("data-index") or 0) + 1: cell.locator("text").text_content()
        for cell in cells.all()
    }
    for number, value in values.items():
        assert texts[number] == ("none" if np.isnan(value) else f"{value:.4g}")
    boxes = {number: shown.locator(f".cell[data-index='{number - 1}']").bounding_box() for number in texts}
    assert boxes[1]["x"] < boxes[3]["x"] < boxes[5]["x"]  # the first key to the right, the second one up
    assert boxes[2]["y"] < boxes[1]["y"]
    names = shown.locator("#tradeoff .axis").all_text_contents()
    assert names == ["path.points[1].y", "transmission_min_deg"]
    shown.locator(".cell[data-index='1']").click()
    assert state(shown)["chosen"] == 1
    shown.locator(".cell[data-index='1']").focus()
    for key in ("ArrowDown", "ArrowRight", "Enter"):
        shown.keyboard.press(key)
    assert state(shown)["chosen"] == 2
    shown.locator("#tradeoff select").select_option("size")
    sizes = frame["size"]
    strength = {
        number: float(
            shown.locator(f".cell[data-index='{number - 1}'] path").get_attribute("fill-opacity") or 0
        )
        for number in (1, 3, 5)
    }
    assert max(strength, key=strength.__getitem__) == sizes.idxmin()  # the smallest is the strongest


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


def test_no_sideways_scroll(shown: Page) -> None:
    for width in (360, 800):
        shown.set_viewport_size({"width": width, "height": 800})
        assert shown.evaluate("document.documentElement.scrollWidth") <= width


def test_one_that_was_interrupted_before_it_varied_a_key_is_shown(
    window: Page, done: tuple[Sweep, Path]
) -> None:
    few = replace(done[0], results={0: done[0].results[0]})
    page = done[1].with_name("few.html")
    page.write_text(sweep_page(few, few.to_frame(), RECORD), encoding="utf-8")
    with without_complaints(window):
        window.goto(page.as_uri())
        assert state(window)["chosen"] == 0
        assert window.locator("#tradeoff .point").count() == 1
