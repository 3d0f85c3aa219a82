"""The list of a page in a real browser: sorted, filtered, folded into families."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pandas as pd
import pytest
from shown_pages import Open, state

from grashof.synth import Result
from grashof.synth.designs.table import NAMES

if TYPE_CHECKING:
    pass


def test_columns_are_sorted(opened: Open, few: Result) -> None:
    page, frame = opened("search"), few.to_frame()
    for key, first in (("transmission_min_task_deg", False), ("id", True)):
        header = page.locator(f"th[data-key={key}]")
        for ascending in (first, not first):
            header.locator("button").click()
            assert header.get_attribute("aria-sort") == ("ascending" if ascending else "descending")
            listed = [few.candidates[row].id for row in frame.sort_values(key, ascending=ascending).index]
            assert state(page)["listed"] == listed
            assert page.locator("tbody td code").all_inner_texts() == listed
    assert page.locator("th[aria-sort=none]").count() > 5


def test_designs_are_filtered(opened: Open, few: Result) -> None:
    page, frame = opened("search"), few.to_frame()
    sizes = frame["size"].round(3)  # as the table shows them
    angles = frame["transmission_min_task_deg"].round(1)
    size, transmission = sorted(sizes)[len(frame) // 2], sorted(angles)[len(frame) // 2]
    assert (frame["size"] > size).any()
    page.fill("[name=size]", f"{size:.3f}")
    assert set(state(page)["listed"]) == set(frame.loc[sizes <= size, "id"])
    page.fill("[name=transmission]", f"{transmission:.1f}")
    both = (sizes <= size) & (angles >= transmission)
    assert set(state(page)["listed"]) == set(frame.loc[both, "id"])
    assert page.locator("form output").inner_text() == f"{both.sum()} of {len(frame)}"
    assert page.locator(".point:not(.filtered)").count() == both.sum()
    page.locator("button[type=reset]").click()
    expect = pytest.importorskip("playwright.sync_api").expect
    expect(page.locator("form output")).to_have_text(f"{len(frame)} of {len(frame)}")
    page.check("[name=pareto]")
    assert set(state(page)["listed"]) == set(frame.loc[frame["pareto"], "id"])
    page.uncheck("[name=pareto]")
    page.fill("[name=text]", frame["id"][3])
    assert state(page)["listed"] == [frame["id"][3]]


def test_one_design_of_each_family_is_listed_until_it_is_opened(opened: Open, alike: Result) -> None:
    page, ids = opened("alike"), [each.id for each in alike.candidates]
    assert state(page)["listed"] == ids[:5]
    buttons = page.locator("[data-alike]:visible")
    assert buttons.all_inner_texts() == ["2 like this", "1 like this"]
    assert page.locator("form output").inner_text() == "8 of 8 in 5 families"
    assert page.locator(".point:not(.filtered)").count() == 8
    buttons.first.click()
    assert buttons.first.get_attribute("aria-expanded") == "true"
    assert state(page)["design"] == ids[0]
    assert state(page)["listed"] == [ids[k] for k in (0, 5, 6, 1, 2, 3, 4)]
    assert page.locator("tbody tr:visible td code").all_inner_texts() == state(page)["listed"]
    assert page.locator("tr.member:visible").count() == 2
    buttons.first.focus()
    page.keyboard.press("Enter")
    assert state(page)["listed"] == ids[:5]
    page.uncheck("[name=fold]")
    assert state(page)["listed"] == ids
    assert buttons.count() == 0


def test_members_stay_with_the_best_of_their_family_however_sorted(opened: Open, alike: Result) -> None:
    page, frame = opened("alike"), alike.to_frame()
    page.locator("[data-alike]:visible").first.click()
    page.locator("th[data-key=size] button").click()
    best = frame[:5].sort_values("size")["id"].tolist()
    members = frame.iloc[[5, 6]].sort_values("size")["id"].tolist()
    place = best.index(frame["id"][0]) + 1
    assert state(page)["listed"] == [*best[:place], *members, *best[place:]]
    page.uncheck("[name=fold]")
    assert state(page)["listed"] == frame.sort_values("size")["id"].tolist()


def test_the_best_that_passes_the_filter_stands_for_its_family(opened: Open, alike: Result) -> None:
    page, ids = opened("alike"), [each.id for each in alike.candidates]
    page.fill("[name=text]", ids[6])
    assert state(page)["listed"] == [ids[6]]
    assert page.locator("[data-alike]:visible").count() == 0
    page.fill("[name=text]", "least error")
    assert state(page)["listed"] == [ids[0]]
    page.fill("[name=text]", "")
    page.fill("[name=size]", str(alike.to_frame()["size"].max() - 0.01))
    shown, sizes = set(state(page)["listed"]), alike.to_frame()["size"].round(2)
    passing = alike.to_frame()[sizes <= sizes.max() - 0.01]
    assert shown == set(passing.groupby("family", sort=False)["id"].first())


def test_a_design_picked_in_the_plot_opens_its_family(opened: Open, alike: Result) -> None:
    page, ids = opened("alike", size=(1300, 1000)), [e.id for e in alike.candidates]
    page.locator(".point[data-index='7']").focus()
    page.keyboard.press("Enter")
    assert state(page)["design"] == ids[7]
    assert state(page)["listed"] == [*ids[:2], ids[7], *ids[2:5]]
    assert page.locator("tr.chosen").is_visible()


def test_a_filter_compares_with_the_numbers_shown(opened: Open, few: Result) -> None:
    page = opened("search")
    nothing = page.get_by_text("no design matches")
    for name, key in (("transmission", "transmission_min_task_deg"), ("size", "size")):
        column = page.locator("table.designs thead th").evaluate_all(
            "(heads, key) => heads.findIndex((head) => head.dataset.key === key)", key
        )
        for row in page.locator("tr[data-index]").all()[:3]:
            page.fill(f"[name={name}]", row.locator("th, td").nth(column).inner_text())
            assert row.is_visible()
            assert not nothing.is_visible()
        page.fill(f"[name={name}]", "")
    page.fill("[name=transmission]", "89")
    assert state(page)["listed"] == []
    assert nothing.is_visible()


def test_all_values_have_names_in_words_and_sensible_digits(opened: Open, few: Result) -> None:
    page, frame = opened("search"), few.to_frame()
    page.evaluate("document.querySelector('#figures').open = true")
    lines = page.locator("#figures dl div")
    example = {
        line.get_attribute("title").partition(":")[0]: (  # type: ignore[union-attr]
            line.locator("dt").inner_text(),
            line.locator("dd").inner_text(),
        )
        for line in lines.all()
    }
    filled = [key for key in frame if not pd.isna(frame.loc[0, key])]
    assert list(example) == filled
    assert {key: name for key, (name, _) in example.items()} == {key: NAMES[str(key)] for key in filled}
    texts = {key: value.replace("−", "-") for key, (_, value) in example.items()}
    lengths = ["o2_x", "o2_y", "o4_x", "o4_y", "r1", "r2", "r3", "r4", "p_u", "p_v", "size"]
    assert {len(texts[key].split()[0].partition(".")[2]) for key in lengths} == {3}
    for key in lengths:
        assert float(texts[key].split()[0]) == pytest.approx(frame.loc[0, key], abs=6e-4)
    assert len(texts["theta2_start_deg"].split()[0].partition(".")[2]) == 2
    for key in ("error_max", "error_rms", "error_sse", "angle_error_max_deg"):
        assert texts[key].startswith("≈ 0 " if frame.loc[0, key] else "0 ")  # by the processor's rounding
    for value in texts.values():
        assert not re.search(r"-0(\.0*)?( |$)|\d{7}|e-1", value)


def test_error_against_size_comes_first_where_errors_differ(
    opened: Open, few: Result, inexact: Result
) -> None:
    axes = "['y', 'x'].map((axis) => document.querySelector(`[data-axis=${axis}]`).value)"
    assert opened("search").evaluate(axes) == ["transmission_min_task_deg", "size"]
    page, frame = opened("inexact"), inexact.to_frame()
    assert frame["error"].max() > 1.1 * frame["error"].min()
    assert page.evaluate(axes) == ["error", "size"]
    heights = page.evaluate(
        "Object.fromEntries([...document.querySelectorAll('.point')].map("
        "(point) => [point.dataset.index, Number(point.getAttribute('cy'))]))"
    )
    order = sorted(range(len(frame)), key=lambda row: -heights[str(row)])
    assert frame["error"].iloc[order].is_monotonic_increasing
