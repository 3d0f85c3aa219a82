"""The pages in a real browser, as a user has them: from the disk, with mouse and keyboard."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Locator, Page, sync_playwright

from grashof.analysis import driver_ranges, solve_position, transmission_angle
from grashof.analysis.four_bar.transmission import quality
from grashof.page import analysis_page, search_page
from grashof.problems import FourBar, LinkageSpec
from grashof.survey import report_on
from grashof.synth import Result

RECORD: dict[str, Any] = {"versions": {"grashof": "0"}, "settings": {"seed": 0}}
TITLE = "<script>document.title = 'caught'</script>"
ROCKER = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))
# Its driver just turns; in one degree P moves a fifth of its whole way.
NEARLY_DEAD = FourBar((0, 0), (1.38, 0), 1.43, 1.7, 1.74, (1, 1))
# Points of the scatter plot that a click in their middle meets.
UNCOVERED = """
[...document.querySelectorAll(".point")].filter((node) => {
  const { x, y, width, height } = node.getBoundingClientRect();
  return document.elementFromPoint(x + width / 2, y + height / 2) === node;
}).map((node) => Number(node.dataset.index))
"""
# As long as a search may say it, and a word that is too long for any line.
MISSES = "transmission_min_deg: the worst transmission angle over the turn in deg is 13.4955, allowed is "
MISSES += f"from 60; constraints: {'a_long_name_' * 20} is 3, allowed is up to 0"
Open = Callable[..., Page]
AS_USUAL: dict[str, Any] = {"media": "screen", "color_scheme": "light", "reduced_motion": "no-preference"}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    found = [shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome")]
    path = next((name for name in found if name), None)
    if path is None:
        pytest.skip("no Chromium on this machine: the page is not tested in a browser")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture(scope="module")
def folder(few: Result, alike: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The pages of searches, with families and without, in vain, and of a driver that cannot turn fully."""
    path = tmp_path_factory.mktemp("pages")
    named = replace(few, problem=replace(few.problem, title=TITLE))
    frame = few.to_frame()
    missed = replace(few, candidates=(), nearest=few.candidates[:1], note=f"no design: {MISSES}")
    pages = {
        "search": search_page(named, frame, RECORD, "kind"),
        "alike": search_page(alike, alike.to_frame(), RECORD),
        "missed": search_page(missed, frame.iloc[:1].assign(misses=MISSES), RECORD),
        "nothing": search_page(replace(missed, nearest=()), frame.iloc[:0], RECORD),
        "rocker": analysis_page(report_on(LinkageSpec(ROCKER, "rocker", title=TITLE)), RECORD),
        "swift": analysis_page(report_on(LinkageSpec(NEARLY_DEAD, "swift")), RECORD),
    }
    for name, page in pages.items():
        (path / f"{name}.html").write_text(page, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def window(browser: Browser) -> Page:
    """One for all tests: to open another takes longer than most of them."""
    return browser.new_page()


@pytest.fixture(scope="module")
def telephone(browser: Browser) -> Page:
    return browser.new_page(viewport={"width": 360, "height": 740}, has_touch=True, is_mobile=True)


@pytest.fixture
def opened(window: Page, telephone: Page, folder: Path) -> Iterator[Open]:
    """Opens a page; at the end nothing may have been complained of or asked for over a network."""
    complaints: list[str] = []
    asked: list[str] = []
    addresses: list[str] = []
    listeners: dict[Any, Callable[[Any], None]] = {
        "console": lambda message: complaints.append(f"{message.type}: {message.text}"),
        "pageerror": lambda error: complaints.append(str(error)),
        "request": lambda request: asked.append(request.url),
    }
    for shown in (window, telephone):
        for event, listener in listeners.items():
            shown.on(event, listener)

    def open_page(name: str, size: tuple[int, int] = (1280, 720), touch: bool = False, **media: Any) -> Page:
        page = telephone if touch else window
        if not touch:
            page.set_viewport_size({"width": size[0], "height": size[1]})
            page.mouse.move(0, 0)
            page.emulate_media(**AS_USUAL | media)
        addresses.append((folder / f"{name}.html").as_uri())
        page.goto(addresses[-1])
        return page

    yield open_page
    for shown in (window, telephone):
        for event, listener in listeners.items():
            shown.remove_listener(event, listener)
    assert complaints == []
    assert asked == addresses


def state(page: Page) -> dict[str, Any]:
    found: dict[str, Any] = page.evaluate("grashof.state()")
    return found


def wait_until(page: Page, condition: str) -> None:
    """As `page.wait_for_function`, which the page's own security policy forbids."""
    for _ in range(200):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(20)
    pytest.fail(f"never true: {condition}")


def centre(place: Locator) -> tuple[float, float]:
    box = place.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def drag_driver(page: Page, turns: np.ndarray) -> Iterator[tuple[float, dict[str, Any]]]:
    """Take the driver near A and lead it around O2; where the mouse is, and what the page then says."""
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
    for angle, shown in drag_driver(page, np.linspace(0, 4.5 * np.pi, 101)):
        assert_closed(linkage, shown)
        assert np.cos(shown["theta2"] - angle) > np.cos(0.02)
        assert shown["mu"] == pytest.approx(float(quality(transmission_angle(linkage, shown["theta2"]))))
        seen.append(shown["theta2"])
    assert len(seen) == 100
    assert np.ptp(seen) > 6


def test_a_driver_that_cannot_turn_stays_between_its_limits(opened: Open) -> None:
    page = opened("rocker")
    low, high = driver_ranges(ROCKER)[0]
    there = np.linspace(0, 3, 26)
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


def test_columns_are_sorted(opened: Open, few: Result) -> None:
    page, frame = opened("search"), few.to_frame()
    for key, first in (("size", True), ("transmission_min_task_deg", False), ("id", True), ("rank", True)):
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
    sizes = frame["size"].round(2)  # as the table shows them
    angles = frame["transmission_min_task_deg"].round(1)
    size, transmission = sorted(sizes)[len(frame) // 2], sorted(angles)[len(frame) // 2]
    assert (frame["size"] > size).any()
    page.fill("[name=size]", f"{size:.2f}")
    assert set(state(page)["listed"]) == set(frame.loc[sizes <= size, "id"])
    page.fill("[name=transmission]", f"{transmission:.1f}")
    both = (sizes <= size) & (angles >= transmission)
    assert set(state(page)["listed"]) == set(frame.loc[both, "id"])
    assert page.locator("form output").inner_text() == f"{both.sum()} of {len(frame)}"
    assert page.locator(".point:not(.filtered)").count() == both.sum()
    page.locator("button[type=reset]").click()
    wait_until(page, f"grashof.state().listed.length === {len(frame)}")
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
        for row in page.locator("tr[data-index]").all():
            page.fill(f"[name={name}]", row.locator("th, td").nth(column).inner_text())
            assert row.is_visible()
            assert not nothing.is_visible()
        page.fill(f"[name={name}]", "")
    page.fill("[name=transmission]", "89")
    assert state(page)["listed"] == []
    assert nothing.is_visible()


def test_a_point_of_the_scatter_plot_picks_its_design(opened: Open, few: Result) -> None:
    page = opened("search", size=(1300, 1000))
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


def test_it_runs_only_when_asked_to(opened: Open) -> None:
    page = opened("search", reduced_motion="reduce")
    before = state(page)
    page.wait_for_timeout(150)
    assert state(page) == before
    page.check("#only-task")
    page.locator("#player [data-play]").click()
    wait_until(page, f"grashof.state().theta2 !== {before['theta2']}")


def test_a_title_with_a_script_is_only_text(opened: Open) -> None:
    for name in ("search", "rocker"):
        page = opened(name)
        assert page.locator("h1").inner_text() == TITLE
        assert page.title() == TITLE


@pytest.mark.parametrize("name", ["search", "missed", "nothing", "rocker"])
def test_a_phone_has_no_sideways_scroll(opened: Open, name: str) -> None:
    page = opened(name, touch=True)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    assert page.locator("#stage .grid").count() == 1


@pytest.mark.parametrize("width", [800, 1400])
@pytest.mark.parametrize("name", ["search", "missed", "nothing"])
def test_no_window_has_sideways_scroll(opened: Open, name: str, width: int) -> None:
    page = opened(name, size=(width, 900))
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
