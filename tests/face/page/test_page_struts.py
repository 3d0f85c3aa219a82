"""Struts that a hand moves on a page: the effort and lengths of the scripts are those of the judge."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from linkages_of_rows import SIX_BARS
from page_parts import Parts, placed_lid
from shown_pages import Open, box_of, state, wait_until

from grashof.analysis.cylinder.travel import travel
from grashof.analysis.effort.case import EffortCase
from grashof.analysis.effort.deviation import excess
from grashof.analysis.judge.effort_of_file import effort_of_file
from grashof.analysis.judge.effort_travel import effort_of_design
from grashof.page.render import text_of
from grashof.page.struts import effort_data, strut_data
from grashof.problems import Box, DynamicsSpec, FourBar, InvertedSliderCrank, Linkage, SliderCrank
from grashof.problems.values.dynamics.effort import EffortSpec
from grashof.problems.values.dynamics.struts import EffortPlace, PartSize, PartSpec
from grashof.synth import Result

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2.5, r4=3, coupler_point=(1, 1), body_angle=0.4)
ENGINE = SliderCrank((0, 0), 2, 5, 0.4, 0.3, (1, 1))
SHAPER = InvertedSliderCrank((0, 0), (4, 0.3), 1.5, 0.3, (2, 1))
LINKAGES = [ROCKER, ENGINE, SHAPER, *SIX_BARS.values()]
GAS = PartSize("", 9.0, 8.0, 300.0, 420.0, friction=20.0)
PULL = PartSize("", 12.0, 11.0, 80.0, 5.0, friction=3.0)
COIL = PartSize("", moment=0.05, turn_deg=170.0, friction=0.002)

# Of the first curve in the group of the effort, at the mark.
READING = "[...document.querySelectorAll('h3')].find((each) => each.textContent === 'Effort')"
READING += ".closest('details').querySelector('figure output')"


def at(link: int | str, u: float, v: float) -> EffortPlace:
    return EffortPlace(link, Box((u, u), (v, v)))


def case_of(linkage: Linkage, ends: tuple[float, float], last: int, **wanted: Any) -> EffortCase:
    """A gas strut, and a spring at a link of the last dyad or, of the four-bar, a torsion spring."""
    parts = [PartSpec("gas", (at(1, -3, -2.5), at("body", 0.5, 0.8)), (GAS,), count=2)]
    if linkage is ROCKER:
        parts.append(PartSpec("torsion", (1, 4), (COIL,), free_angle_deg=(30.0, 30.0)))
    else:
        parts.append(PartSpec("tension", (at(2, 0.3, -0.2), at(last, 0.4, -0.7)), (PULL,)))
    spec = EffortSpec(on=at(3, 1.4, 0.9), temperatures_c=(-10.0, 40.0), parts=tuple(parts), **wanted)
    count = len(linkage.mechanism.links) - 1
    masses = tuple(np.arange(1.0, count + 1))
    loads = DynamicsSpec(masses=masses, inertias=(0.0,) * count, gravity=(1.0, -9.81), effort=spec)
    moved = travel(linkage, np.array(ends), np.full(2, int(linkage.assembly)), ends)
    assert moved is not None
    return EffortCase(linkage, loads, 1e-2, moved)


def with_ends(case: EffortCase, struts: list[dict[str, Any]]) -> EffortCase:
    """A case with the ends that the scripts have."""
    rows, parts = iter(struts), list(case.spec.parts)
    for number, part in enumerate(parts):
        if part.places:
            first, second = (at(end["link"], *end["at"]) for end in next(rows)["ends"])
            parts[number] = replace(part, between=(first, second))
    effort = replace(case.spec, parts=tuple(parts))
    return replace(case, dynamics=replace(case.dynamics, effort=effort))


def places_at(case: EffortCase, angles: np.ndarray) -> np.ndarray:
    """Places of rotations from the start of the travel, by halving it."""
    low, high = np.full(len(angles), case.travel.start), np.full(len(angles), case.travel.end)
    for _ in range(60):
        middle = (low + high) / 2
        before = case.angle_deg(middle) < angles
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return high


def assert_same(shown: dict[str, Any], case: EffortCase, digits: float = 1e-9) -> None:
    """The curves of the scripts are those of the judge at the same places, and so is the greatest excess."""
    angles = shown["curves"]["effort"]["places"]
    known = case.at(places_at(case, np.array(angles)))
    np.testing.assert_allclose(known.angle_deg, angles, atol=digits)
    np.testing.assert_allclose(shown["friction"], known.friction, rtol=digits, atol=digits)
    scale = np.abs(known.effort).max()
    series = {line["label"]: np.array(line["values"], float) for line in shown["curves"]["effort"]["series"]}
    for temperature, effort in zip(case.spec.temperatures_c, known.effort, strict=True):
        np.testing.assert_allclose(series[f"at {temperature:g} °C"], effort, rtol=0, atol=digits * scale)
    np.testing.assert_allclose(series["without struts and springs"], known.without, atol=digits * scale)
    lengths = [line["values"] for line in shown["curves"]["effort-lengths"]["series"]]
    straight = [
        each.length for part, each in zip(case.spec.parts, known.parts, strict=True) if not part.turns
    ]
    np.testing.assert_allclose(lengths, straight, rtol=digits)
    over = -np.inf
    for demand in case.spec.demands:
        inside = (known.angle_deg >= demand.start - 1e-9) & (known.angle_deg <= demand.end + 1e-9)
        over = max(over, float(excess(demand, known)[..., inside].max()))
    assert shown["excess"] == pytest.approx(over, abs=digits * scale)


@pytest.fixture(scope="module")
def blank(browser: Browser) -> Page:
    return browser.new_page()


@pytest.mark.parametrize("way", [1, -1], ids=["on", "back"])
@pytest.mark.parametrize("linkage", LINKAGES, ids=lambda each: each.mechanism.word)
def test_the_scripts_have_the_effort_of_the_judge(blank: Page, linkage: Linkage, way: int) -> None:
    """At random ends on every kind of linkage, with friction, two temperatures and every kind of limit."""
    low, high = (0.5, 1.2) if linkage is ROCKER else (1.5, 2.4)
    wanted: dict[str, Any] = {"wanted": ((0.0, 30.0), (4.0, 10.0), (9.0, -5.0)), "over": "driver"}
    wanted |= {"stays_deg": (6.0, 12.0), "closes_below_deg": 5.0}
    ends = (low, high) if way > 0 else (high, low)
    case = case_of(linkage, ends, len(linkage.mechanism.links), **wanted)
    effort = effort_data(case)["effort"]
    struts = strut_data(linkage, case.spec)["struts"]
    rng = np.random.default_rng(3)
    for strut in struts:
        for end in strut["ends"]:
            end["at"] = (np.array(end["at"]) + rng.uniform(-0.5, 0.5, 2)).tolist()
    script = f"([effort, struts]) => {{ {text_of('effort.js')}; return effortPlots(effort, struts, 'cm'); }}"
    shown = blank.evaluate(script, [effort, struts])
    assert_same(shown, with_ends(case, struts))


def end_of_strut(page: Page, number: int) -> Locator:
    return page.locator(".strut-end circle:not(.reach)").nth(number)


def drag(page: Page, number: int, by: tuple[float, float]) -> None:
    box = box_of(end_of_strut(page, number))
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for share in (0.5, 1.0):
        page.mouse.move(x + share * by[0], y + share * by[1])
    page.mouse.up()


def test_a_dragged_end_moves_its_strut_and_the_curves(opened: Open) -> None:
    page = opened("lid")
    case = effort_of_file(placed_lid())
    assert case is not None
    before = state(page)["byHand"]
    assert before["struts"] == [[{"link": 1, "at": [10, -50]}, {"link": 2, "at": [120, 20]}]]
    assert_same(before, case)
    end_of_strut(page, 1).scroll_into_view_if_needed()
    theta2 = state(page)["theta2"]
    drag(page, 1, (18, -12))
    shown = state(page)
    assert shown["theta2"] == theta2  # neither the driver nor the view
    after = shown["byHand"]
    (strut,) = after["struts"]
    assert strut[0] == {"link": 1, "at": [10, -50]}
    assert np.hypot(strut[1]["at"][0] - 120, strut[1]["at"][1] - 20) > 3
    assert_same(after, with_ends(case, [{"ends": strut}]))
    text = page.locator("#struts").inner_text()
    assert f"{{ link = 2, at = [{strut[1]['at'][0]:g}, {strut[1]['at'][1]:g}] }}" in text
    page.locator("[data-back]").click()
    assert state(page)["byHand"] == before


def test_the_plots_of_an_analysis_follow_with_the_same_lines(opened: Open, page_path: Any) -> None:
    page = opened("lid")
    given = Parts(page_path("lid").read_text(encoding="utf-8")).plot("effort")
    curves = state(page)["byHand"]["curves"]
    assert [line["label"] for line in curves["effort"]["series"]] == [
        line["label"] for line in given["series"]
    ]
    group = page.locator("details.group", has=page.locator("h3", has_text="Effort"))
    assert not group.evaluate("(node) => node.open")
    end_of_strut(page, 0).scroll_into_view_if_needed()
    page.locator(".strut-end").first.focus()
    page.keyboard.press("Shift+ArrowDown")
    moved = state(page)["byHand"]["struts"][0][0]["at"]
    assert moved[1] < -50
    assert moved[0] == 10
    assert group.evaluate("(node) => node.open")
    figure = group.locator("figure").first
    figure.scroll_into_view_if_needed()
    wait_until(page, f"{READING}.textContent !== ''")
    reading = page.evaluate(f"{READING}.textContent").replace("\u2212", "-")
    series = state(page)["byHand"]["curves"]["effort"]
    theta2 = np.degrees(state(page)["theta2"])
    expected = np.interp(theta2, series["angles"], series["series"][0]["values"])
    assert float(reading) == pytest.approx(expected, rel=2e-3)


def test_without_an_effort_nothing_is_offered(opened: Open) -> None:
    page = opened("search")
    assert not page.locator("#struts").is_visible()
    assert page.locator(".strut-end").count() == 0
    assert state(page)["byHand"] is None


@pytest.mark.slow
def test_the_struts_of_listed_designs_are_moved_each_for_itself(opened: Open, flaps: Result) -> None:
    page = opened("flaps", size=(1300, 1000))
    cases = [effort_of_design(each.linkage, flaps.problem, each.verdict) for each in flaps.candidates[:2]]
    moved = []
    for index, case in enumerate(cases):
        assert case is not None
        page.locator("[data-pick]").nth(index).click()
        assert_same(state(page)["byHand"], case)
        end_of_strut(page, 1).scroll_into_view_if_needed()
        drag(page, 1, (6, 9))
        shown = state(page)["byHand"]
        moved.append(shown["struts"])
        assert_same(shown, with_ends(case, [{"ends": ends} for ends in shown["struts"]]))
    page.locator("[data-pick]").first.click()
    assert state(page)["byHand"]["struts"] == moved[0] != moved[1]


def test_a_strut_that_is_too_short_or_too_long_is_told(opened: Open) -> None:
    page = opened("lid")
    end_of_strut(page, 0).scroll_into_view_if_needed()
    assert "too" not in page.locator("#struts li").inner_text()
    drag(page, 0, (0, 120))
    assert "too long" in page.locator("#struts li").inner_text()
