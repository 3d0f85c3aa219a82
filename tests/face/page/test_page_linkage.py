"""The linkage of a page in a real browser: picked, dragged, driven, compared, with mouse and keyboard."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from page_parts import ROCKER
from shown_pages import Open, box_of, state, wait_until

from grashof.analysis import driver_ranges, solve_position, transmission_angle
from grashof.analysis.mechanism.transmission import quality
from grashof.problems import FourBar
from grashof.synth import Result

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

# Points of the scatter plot that a click in their middle meets.
UNCOVERED = """
[...document.querySelectorAll(".point")].filter((node) => {
  const { x, y, width, height } = node.getBoundingClientRect();
  return document.elementFromPoint(x + width / 2, y + height / 2) === node;
}).map((node) => Number(node.dataset.index))
"""


def centre(place: Locator) -> tuple[float, float]:
    box = box_of(place)
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def drag_driver(page: Page, turns: np.ndarray) -> Iterator[tuple[float, dict[str, Any]]]:
    """Take the driver near A and lead it around O2; the angle of the mouse, and the state of the page."""
    o2, a = (centre(page.locator(f"#stage .joint.{name}")) for name in ("o2", "a"))
    radius = 0.8 * np.hypot(a[0] - o2[0], a[1] - o2[1])
    begun = float(np.arctan2(o2[1] - a[1], a[0] - o2[0]))
    for count, turn in enumerate(turns):
        angle = begun + turn
        page.mouse.move(o2[0] + radius * np.cos(angle), o2[1] - radius * np.sin(angle))
        if count == 0:
            page.mouse.down()
        else:
            yield angle, state(page)
    page.mouse.up()


def assert_closed(linkage: FourBar, shown: dict[str, Any]) -> None:
    o2, o4, a, b, p = (np.array(shown[name]) for name in ("o2", "o4", "a", "b", "p"))
    lengths = [np.hypot(*gap) for gap in (o4 - o2, a - o2, b - a, b - o4)]
    np.testing.assert_allclose(lengths, linkage.lengths, rtol=0, atol=1e-6)
    expected = solve_position(linkage, shown["theta2"])
    for name, point in (("a", a), ("b", b), ("p", p)):
        np.testing.assert_allclose(point, getattr(expected, name), rtol=0, atol=1e-6)
    assert np.cos(shown["theta3"] - expected.theta3) == pytest.approx(1)
    assert np.cos(shown["theta4"] - expected.theta4) == pytest.approx(1)


def test_the_linkage_closes_wherever_it_is_dragged(opened: Open, few: Result) -> None:
    page = opened("search")
    linkage = few.best.linkage
    assert state(page)["theta2"] == pytest.approx(few.best.verdict.theta2[0])
    seen = []
    for angle, shown in drag_driver(page, np.linspace(0, 4.5 * np.pi, 41)):
        assert_closed(linkage, shown)
        assert np.cos(shown["theta2"] - angle) > np.cos(0.02)
        assert shown["mu"] == pytest.approx(float(quality(transmission_angle(linkage, shown["theta2"]))))
        seen.append(shown["theta2"])
    assert len(seen) == 40
    assert np.ptp(seen) > 6


def test_a_driver_that_cannot_turn_stays_between_its_limits(opened: Open) -> None:
    page = opened("rocker")
    low, high = driver_ranges(ROCKER)[0]
    there = np.linspace(0, 3, 8)
    seen = []
    for _, shown in drag_driver(page, np.concatenate([there, there[::-1], -there, -there[::-1]])):
        assert_closed(ROCKER, shown)
        seen.append(shown["theta2"])
    assert (min(seen), max(seen)) == pytest.approx((low, high))
    middle = (low + high) / 2
    assert seen[-1] == pytest.approx(middle, abs=0.03)  # it comes back where the mouse left it
    page.locator("#player [data-play]").click()
    wait_until(page, f"Math.abs(grashof.state().theta2 - {middle}) > 0.1")
    assert_closed(ROCKER, state(page))


def test_the_path_of_p_is_smooth_where_p_runs_fast(opened: Open) -> None:
    path = opened("swift").locator("#stage .trace").get_attribute("d")
    assert path is not None
    points = np.array([pair.split() for pair in path[1:].split("L")], dtype=float)
    steps = np.diff(points, axis=0) @ [1, 1j]
    assert np.abs(steps).max() < 0.011 * np.ptp(points, axis=0).max()
    seen = np.abs(steps) > 2  # px: shorter ones are rounded
    turns = np.degrees(np.abs(np.angle(steps[1:] / steps[:-1])))
    assert turns[seen[1:] & seen[:-1]].max() < 6


def test_the_curves_of_all_joints_are_drawn_where_they_are_known(opened: Open, few: Result) -> None:
    page = opened("search", size=(1300, 1000))
    assert few.loci is not None
    assert page.locator("#stage .locus").count() == 0
    page.locator("#loci").check()
    drawn = page.locator("#stage .locus").evaluate_all(
        "(paths) => paths.map((path) => (path.getAttribute('d').match(/M/g) || []).length)"
    )
    assert sum(drawn) == 2 * len(few.loci.transmission)
    assert page.locator("#stage .locus.ground.shade-4").count() == 1
    page.locator("#loci").uncheck()
    assert page.locator("#stage .locus").count() == 0


def test_a_point_of_the_scatter_plot_picks_its_design(opened: Open, few: Result) -> None:
    page = opened("search", size=(1300, 1000))
    page.locator("#scatter").scroll_into_view_if_needed()
    uncovered = page.evaluate(UNCOVERED)
    assert len(uncovered) >= 3
    for index in uncovered[-2:]:
        page.locator(f".point[data-index='{index}']").click()
        chosen = few.candidates[index]
        shown = state(page)
        assert shown["design"] == chosen.id
        assert_closed(chosen.linkage, shown)
        assert chosen.id in page.locator("#about").inner_text()
        assert page.locator("tr.chosen").get_attribute("data-index") == str(index)
    page.locator(".point[tabindex='0']").focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    sizes = [(candidate.verdict.size, candidate.id) for candidate in few.candidates]
    order = [name for _, name in sorted(sizes)]
    assert state(page)["design"] == order[(order.index(chosen.id) + 1) % len(order)]


def test_designs_move_together_side_by_side(opened: Open, few: Result) -> None:
    page = opened("search")
    for index in (0, 3):
        page.locator("input[data-compare]").nth(index).check()
    chosen = [few.candidates[0], few.candidates[3]]
    assert [each["design"] for each in state(page)["compared"]] == [each.id for each in chosen]
    assert page.locator("#compare article").count() == 2
    slider = page.locator("#compare input[type=range]")
    for target in range(4):
        slider.fill(str(target / 3))
        for each, candidate in zip(state(page)["compared"], chosen, strict=True):
            assert each["theta2"] % (2 * np.pi) == pytest.approx(
                candidate.verdict.theta2[target] % (2 * np.pi)
            )
            assert each["p"] == pytest.approx(few.problem.task.positions[target].tolist(), abs=1e-6)
    page.locator("#compare [data-remove]").first.click()
    assert [each["design"] for each in state(page)["compared"]] == [chosen[1].id]
    assert not page.locator("input[data-compare]").nth(0).is_checked()


def test_the_keyboard_is_enough(opened: Open, few: Result) -> None:
    page = opened("search")
    page.locator("#stage").focus()
    before = state(page)["theta2"]
    page.keyboard.press("ArrowRight")
    assert state(page)["theta2"] - before == pytest.approx(np.radians(1))
    page.keyboard.press("Shift+ArrowLeft")
    assert state(page)["theta2"] - before == pytest.approx(np.radians(-9))
    page.keyboard.press("Space")
    assert state(page)["playing"]
    wait_until(page, f"grashof.state().theta2 > {before}")
    page.keyboard.press("Space")
    assert not state(page)["playing"]
    page.locator("[data-pick]").nth(4).focus()
    page.keyboard.press("Enter")
    assert state(page)["design"] == few.candidates[4].id
    unreachable = page.evaluate(
        "[...document.querySelectorAll('button, select, input')].filter((node) => node.tabIndex < 0).length"
    )
    assert unreachable == 0


def test_arrows_turn_the_driver_wherever_nothing_else_needs_them(opened: Open) -> None:
    page = opened("search")
    turned = [state(page)["theta2"]]
    for key in ("ArrowRight", "Shift+ArrowRight", "ArrowLeft", "Alt+ArrowRight", "ArrowDown"):
        page.keyboard.press(key)
        turned.append(state(page)["theta2"])
    np.testing.assert_allclose(np.degrees(np.diff(turned)), [1, 10, -1, 0, 0], atol=1e-9)
    for needs_them in ("[name=text]", "#player [data-pace]", "#designs .scroll"):
        page.locator(needs_them).focus()
        page.keyboard.press("ArrowRight")
        assert state(page)["theta2"] == turned[-1]


def test_it_runs_only_on_request(opened: Open) -> None:
    page = opened("search", reduced_motion="reduce")
    before = state(page)
    page.wait_for_timeout(150)
    assert state(page) == before
    page.check("#only-task")
    page.locator("#player [data-play]").click()
    wait_until(page, f"grashof.state().theta2 !== {before['theta2']}")
