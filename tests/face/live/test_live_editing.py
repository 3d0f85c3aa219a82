"""Regions, areas and paths edited by hand on the live page, which leaves a problem or shows its error."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from live_pages import drag, place_of, searched
from shown_pages import box_of, state, without_complaints

from grashof.page.designs import scene_of
from grashof.problems import ProblemError
from grashof.problems.files.on_disk import document_of
from grashof.problems.files.problem_schema import problem_from

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

PLACES = """
kind = "motion"
length_unit = "m"
[motion]
poses = [[5, 4, 10], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]]
body = [[0, 0], [1, 0], [1, 1], [0, 1]]
[requirements]
o2 = { inside = [[-1, -6], [6, -6], [5, -2], [1, -4]] }
o4 = { x = [6, 9] }
a_on_body = { x = [-3, 0], y = [-4, 0] }
b_on_body = { on = [[0, 0], [2, 1]] }
at = [{ targets = [1], b = { x = [3, 7], y = [1, 3] } }, { targets = [2, 3], instant_centre = [8, -2] }]
keep_out = [[[0, -1], [0, 0], [4, 0], [4, -1]]]
[search]
effort = 0.2
starts = 2
"""


def wanted(page: Page) -> dict[str, Any]:
    found: dict[str, Any] = state(page)["document"]["requirements"]
    return found


def warned(page: Page, line: str) -> None:
    """Wait for an error with this text; without a text, for no error."""
    shown = "document.querySelector('[data-warning]').textContent"
    page.wait_for_function(f"() => {f'{shown}.includes({line!r})' if line else f'!{shown}'}", timeout=200_000)


@pytest.fixture
def page(window: Page, served: str) -> Iterator[Page]:
    """A new page, whose search may continue; without errors."""
    with without_complaints(window):
        window.goto("about:blank")
        window.goto(served)
        window.wait_for_function("() => window.grashof && window.grashof.state().document.kind")
        yield window


@pytest.fixture
def places(page: Page) -> Page:
    """The problem with all its places in view."""
    file: Any = {"name": "places.toml", "mimeType": "application/toml", "buffer": PLACES.encode()}
    page.locator("[name=problem]").set_input_files(file)
    page.wait_for_function("() => window.grashof.state().document.requirements.b_on_body")
    page.locator("[data-view=out]").click()
    return page


@pytest.mark.slow
def test_every_place_is_drawn_as_python_draws_it_and_moved_in_its_own_frame(places: Page) -> None:
    scene = state(places)["scene"]
    drawn = scene_of(problem_from(document_of(PLACES, "x"), "x"))["regions"]
    assert [each["name"] for each in scene["regions"]] == [each["name"] for each in drawn]
    for mine, theirs in zip(scene["regions"], drawn, strict=True):
        assert mine.keys() == theirs.keys()
        for key in mine.keys() - {"name"}:
            np.testing.assert_allclose(
                np.array(mine[key], dtype=float), np.array(theirs[key], dtype=float), atol=1e-12
            )
    drag(places, "O4 region 0-", (-30, 40))
    side = wanted(places)["o4"]
    assert side["x"][0] < 6
    assert side == {"x": [side["x"][0], 9]}
    drag(places, "B region on the body 1", (20, 0))
    end = wanted(places)["b_on_body"]["on"]
    assert end[0] == [0, 0]
    # To the right on the drawing is to the right and downwards in the frame of a body turned by 10 deg.
    assert (end[1][1] - 1) / (end[1][0] - 2) == pytest.approx(-np.tan(np.radians(10)), abs=0.05)
    drag(places, "B region at target 1 11", (25, -10))
    low, high = wanted(places)["at"][0]["b"]["x"]
    assert low == 3
    assert high > 7
    drag(places, "instant centre region at targets 2, 3 0", (0, 20))
    assert wanted(places)["at"][1]["instant_centre"][1] < -2
    problem_from(state(places)["document"], "x")


@pytest.mark.slow
def test_corners_are_inserted_on_sides_and_removed_by_key_and_by_button(places: Page) -> None:
    before = wanted(places)["o2"]["inside"]
    drag(places, "O2 region + 1", (40, 0))
    grown = wanted(places)["o2"]["inside"]
    assert grown[:2] + grown[3:] == before
    assert grown[2][0] > 5.5
    places.keyboard.press("Control+z")  # the corner and its way in one step
    assert wanted(places)["o2"]["inside"] == before
    places.locator("[data-handle='area 1 + 2']").focus()
    places.keyboard.press("Enter")
    places.keyboard.press("ArrowUp")
    area = wanted(places)["keep_out"][0]
    assert area[3][0] == 4
    assert area[3][1] > -0.5
    places.locator("[data-remove]").click()  # what the keys would move
    assert wanted(places)["keep_out"][0] == area[:3] + area[4:]
    x, y = place_of(places, "O2 region 0")
    places.mouse.click(x, y)
    for count in (3, 3):
        places.locator("[data-remove]").click()
        assert len(wanted(places).get("o2", {"inside": "..."})["inside"]) == count
    assert "o2" not in wanted(places)  # a triangle goes as a whole
    assert places.locator("[data-remove]").is_disabled()


@pytest.mark.study
def test_a_crossed_polygon_shows_its_error_until_it_is_simple(places: Page) -> None:
    (x0, _), (x1, _) = place_of(places, "O2 region 0"), place_of(places, "O2 region 1")
    unit = (x1 - x0) / 7  # px
    drag(places, "O2 region 0", (8 * unit, -3 * unit))  # beyond the side from corner 2 to corner 3
    warned(places, "requirements.o2.inside crosses or touches itself")
    places.keyboard.press("Control+z")
    warned(places, "")
    searched(places)
    text = places.locator("[data-file]").text_content() or ""
    again = problem_from(document_of(text, "shown.toml"), "shown")
    assert again.requirements == problem_from(state(places)["document"], "x").requirements


@pytest.mark.slow
@pytest.mark.parametrize("shape", ["box", "polygon", "line", "point"])
def test_regions_of_every_shape_are_placed_by_a_click(page: Page, shape: str) -> None:
    stage = box_of(page.locator("#stage"))
    for joints in ("o4", "a_on_body"):
        page.locator("[data-mode=region]").click()
        page.locator("[name=joints]").select_option(joints)
        page.locator("[name=shape]").select_option(shape)
        page.mouse.click(stage["x"] + stage["width"] / 2, stage["y"] + stage["height"] / 2)
        region = wanted(page)[joints]
        keys = {"box": {"x", "y"}, "polygon": {"inside"}, "line": {"on"}}
        assert isinstance(region, list) if shape == "point" else set(region) == keys[shape]
    found = problem_from(state(page)["document"], "x").requirements
    assert found.o4 is not None
    assert found.a_on_body is not None
    assert page.locator("[data-when=region]").is_hidden()


@pytest.mark.slow
def test_hands_at_random_leave_a_problem_or_its_error(places: Page) -> None:
    """Handles are dragged, inserted and removed anywhere; the page shows what Python says of its file."""
    random, invalid = np.random.default_rng(4), 0
    stage = box_of(places.locator("#stage"))
    for step in range(24):
        names = places.evaluate(
            "[...document.querySelectorAll('[data-handle]')].map((e) => e.dataset.handle)"
        )
        kinds = ("O2 region", "area") if step % 2 else ("region",)
        handle = random.choice([name for name in names if any(kind in name for kind in kinds)])
        x, y = place_of(places, handle)
        to = [stage["x"] + stage["width"] * random.random(), stage["y"] + stage["height"] * random.random()]
        drag(places, handle, (to[0] - x, to[1] - y), steps=2)
        if step % 8 == 7:
            places.keyboard.press("Delete")
        try:
            problem_from(state(places)["document"], "task")
        except ProblemError as error:
            warned(places, str(error))
            invalid += 1
            places.keyboard.press("Control+z")
    assert 0 < invalid < 24
    places.keyboard.press("Control+Shift+z")
    places.keyboard.press("Control+z")
    warned(places, "")


def draw(page: Page, places: Any) -> None:
    (x, y), *others = places
    page.locator("[data-mode='draw']").click()
    stage = box_of(page.locator("#stage"))
    page.mouse.move(stage["x"] + x, stage["y"] + y)
    page.mouse.down()
    for u, v in others:
        page.mouse.move(stage["x"] + u, stage["y"] + v)
    page.mouse.up()


def legs(points: list[list[float]]) -> list[float]:
    return [float(np.hypot(b[0] - a[0], b[1] - a[1])) for a, b in pairwise(points)]


@pytest.mark.slow
def test_an_open_path_is_drawn_by_hand(page: Page) -> None:
    before = state(page)["document"]
    page.locator("[data-mode='draw']").click()
    page.locator("[name=count]").fill("9")
    draw(page, [(150 + 10 * k, 300 - (k - 15) ** 2 / 4) for k in range(31)])
    found = state(page)["document"]
    assert (found["kind"], found["path"]["closed"]) == ("path", False)  # of poses it makes a path
    assert len(found["path"]["points"]) == 9
    steps = legs(found["path"]["points"])
    assert max(steps) < 1.05 * min(steps)
    assert len(problem_from(found, "drawn").task) == 9
    page.keyboard.press("Control+z")
    assert state(page)["document"] == before


@pytest.mark.slow
def test_a_closed_path_is_drawn_by_hand(page: Page) -> None:
    page.locator("[data-menu=open] summary").click()
    page.locator("[name=catalogue]").select_option("path-vertical-line")
    page.wait_for_function("() => window.grashof.state().document.kind === 'path'")
    turn = np.linspace(0, 2 * np.pi - 0.15, 60)
    draw(page, np.column_stack([300 + 90 * np.cos(turn), 280 + 50 * np.sin(turn)]).tolist())
    found = state(page)["document"]["path"]
    points = found["points"]
    assert found["closed"] is True
    assert points[0] == points[-1]
    assert len(points) == 13
    steps = legs(points)
    assert max(steps) < 1.08 * min(steps)  # chords of an ellipse, the one that closes it among them
    assert page.locator("[name=closed]").is_checked()
    assert problem_from(state(page)["document"], "drawn").task.closed


@pytest.mark.slow
def test_a_finger_draws_a_path(browser: Browser, served: str) -> None:
    """The page neither scrolls below it nor takes a second finger for the first."""
    page = browser.new_page(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    try:
        page.goto(served)
        page.wait_for_function("() => window.grashof && window.grashof.state().document.kind")
        page.locator("[data-mode='draw']").tap()
        page.locator("#stage").scroll_into_view_if_needed()
        stage = box_of(page.locator("#stage"))
        hand = page.context.new_cdp_session(page)

        def touch(kind: str, *places: tuple[float, float]) -> None:
            at = [{"x": stage["x"] + x, "y": stage["y"] + y, "id": k} for k, (x, y) in enumerate(places)]
            hand.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})

        line = [(60 + 8 * k, 60 + 8 * k) for k in range(25)]
        touch("touchStart", line[0])
        for place in line[:12]:
            touch("touchMove", place)
        touch("touchStart", line[11], (200, 60))
        for place in line[12:]:
            touch("touchMove", place, (200, 60))
        touch("touchEnd")
        found = state(page)["document"]
        assert found["kind"] == "path"
        points = np.array(found["path"]["points"])
        assert len(points) == 12
        assert np.ptp(points @ [1, 1]) < 0.05 * np.ptp(points @ [1, -1])  # y runs upwards
    finally:
        page.close()


@pytest.mark.slow
def test_a_line_that_is_too_short_or_taken_away_changes_nothing(page: Page) -> None:
    before = state(page)["document"]
    draw(page, [(200, 200), (203, 200), (206, 200)])
    assert state(page)["document"] == before
    page.locator("[data-mode='draw']").click()
    stage = box_of(page.locator("#stage"))
    page.mouse.move(stage["x"] + 100, stage["y"] + 100)
    page.mouse.down()
    page.mouse.move(stage["x"] + 300, stage["y"] + 200, steps=20)
    cancelled = "new PointerEvent('pointercancel', { pointerId: 1, bubbles: true })"
    page.evaluate(f"document.querySelector('#stage').dispatchEvent({cancelled})")
    page.mouse.up()
    assert state(page)["document"] == before
