"""The designs of the live page in a real browser: followed, searched, compared, lost and found again."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from live_pages import keys, linkages, problem_of, searched, shown, stated
from shown_pages import state

from grashof import load, synthesize, track
from grashof.analysis import solve_kinematics
from grashof.problems.values.linkages.mechanisms import linkage_of

if TYPE_CHECKING:
    from playwright.sync_api import Page, Route


def hold_searches(route: Route, waiting: list[Route]) -> None:
    """Searches wait until they are let go."""
    if route.request.post_data_json["what"] == "search":
        waiting.append(route)
    else:
        route.continue_()


@pytest.mark.study
def test_designs_follow_and_are_compared_and_lost_ones_fade_with_their_defects(page: Page) -> None:
    designs = synthesize(load("luggage")).top(50).candidates[:10]
    first = state(page)
    for row in (0, 2):
        page.locator(".listing tbody input").nth(row).check()
    assert page.locator("#compare article").count() == 2
    compared = state(page)["compared"]
    waiting: list[Route] = []
    page.route("**/ask", lambda route: hold_searches(route, waiting))
    page.locator("[data-handle='target-1']").focus()
    page.keyboard.press("ArrowUp")
    found = shown(page, "s.listed.version === s.version && s.busy === 'search'")
    assert found["listed"]["phase"] == "track"
    assert linkages(found)[:10] == stated(track(designs, problem_of(found)))
    assert linkages(found)[10:] == linkages(first)[10:]
    assert keys(found) == keys(first)
    assert found["compared"] == compared
    waiting[0].continue_()
    page.unroute("**/ask")
    searched(page)
    page.locator("[data-handle='target-3']").focus()
    page.keyboard.press("ArrowUp")
    for _ in range(40):
        page.keyboard.press("Shift+ArrowUp")
        found = shown(page, "s.listed.version === s.version")
        if found["lost"]:
            break
    assert found["lost"]
    assert found["lost"][0]["why"]


@pytest.mark.study
def test_designs_not_found_yet_return(page: Page) -> None:
    """During the search, the chosen and compared designs may be missing; its end decides."""
    for row in (0, 2):
        page.locator(".listing tbody input").nth(row).check()
    page.locator(".listing tbody tr").nth(2).click()
    before = state(page)
    lists: list[Any] = []

    def first_of_two(route: Route) -> None:
        """The list of a search that has found a design so far, and then no more."""
        if route.request.post_data_json["what"] == "search":
            lines = [json.loads(line) for line in route.fetch().text().splitlines()]
            lists.extend(line for line in lines if line["kind"] == "list")
            short = {**lists[-1], "phase": "searching", "designs": lists[-1]["designs"][1:2]}
            route.fulfill(body=json.dumps(short) + "\n")
        else:
            route.continue_()

    def ask_for(transmission: str) -> None:
        limit = page.locator("input[type=number][data-limit=transmission_min_deg]")
        limit.fill(transmission)
        limit.press("Enter")

    page.route("**/ask", first_of_two)
    ask_for("15.001")
    partial = shown(page, "s.listed.version === s.version && s.listed.phase === 'searching'")
    assert keys(partial) == keys(before)[1:2] == [partial["chosen"]]
    assert page.locator("#compare article").count() == 0
    page.unroute("**/ask")
    ask_for("15")
    found = searched(page)
    assert keys(found) == keys(before)
    assert (found["chosen"], found["compared"]) == (before["chosen"], before["compared"])
    assert page.locator("#compare article").count() == 2


def solver_pids(server: int) -> list[int]:
    """Processes of the solvers: children of the server that were spawned."""
    listed = Path(f"/proc/{server}/task/{server}/children").read_text().split()
    return [int(each) for each in listed if b"spawn_main" in Path(f"/proc/{each}/cmdline").read_bytes()]


@pytest.mark.slow
def test_a_killed_solver_is_replaced_in_mid_work(page: Page, server: tuple[str, int]) -> None:
    before = solver_pids(server[1])
    assert len(before) >= 2
    page.locator("[data-handle='target-1']").focus()
    page.keyboard.press("ArrowUp")
    page.wait_for_function("() => window.grashof.state().busy === 'search'")
    for pid in before:
        os.kill(pid, signal.SIGKILL)
    found = searched(page)
    assert linkages(found) == stated(synthesize(problem_of(found)).top(50).candidates)
    assert not set(solver_pids(server[1])) & set(before)


@pytest.mark.study
def test_without_a_design_the_closest_miss_is_shown_with_a_relaxation(page: Page) -> None:
    page.locator("input[type=number][data-limit=transmission_min_deg]").fill("60")
    page.locator("input[type=number][data-limit=transmission_min_deg]").press("Enter")
    found = searched(page)
    assert found["designs"]
    assert "Closest misses" in page.locator("[data-headline]").inner_text()
    assert "transmission_min_deg" in page.locator("[data-notice]").inner_text()


@pytest.mark.study
@pytest.mark.parametrize("kind", ["four-bar", "slider-crank", "inverted-slider-crank"])
def test_the_velocity_of_p_is_that_of_the_analysis(page: Page, kind: str) -> None:
    page.locator("[data-menu=open] summary").click()
    page.locator("[name=catalogue]").select_option("path-gait")
    shown(page, "s.document.kind === 'path'")
    page.locator("[name=rotatability]").select_option("full-crank")  # only a four-bar is a crank-rocker
    page.locator(f"[name=mechanism][value={kind}]").check()
    for other in {"four-bar", "slider-crank", "inverted-slider-crank"} - {kind}:
        page.locator(f"[name=mechanism][value={other}]").uncheck()
    found = searched(page)
    given = next(one["linkage"] for one in found["designs"] if one["key"] == found["chosen"])
    assert given.pop("mechanism") == kind
    linkage = linkage_of(kind, given)
    for _ in range(5):
        theta2 = state(page)["theta2"]
        speed = float(solve_kinematics(linkage, theta2, omega2=1.0).p.speed)
        shown_speed = float(page.locator("#velocity output").inner_text().replace("−", "-"))
        assert shown_speed == pytest.approx(speed, rel=1e-3)
        page.locator("#player input[type=range]").focus()
        for _ in range(4):
            page.keyboard.press("PageUp")


@pytest.mark.quick("quick-return-slide")
@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["function-log10", "quick-return-slide", pytest.param("lifting-arm", marks=pytest.mark.study)]
)
def test_tasks_without_points_and_with_cylinders_are_searched(page: Page, name: str) -> None:
    page.locator("[data-menu=open] summary").click()
    page.locator("[name=catalogue]").select_option(name)
    found = shown(page, f"s.listed.phase === 'found' && !s.busy && s.document.title === {load(name).title!r}")
    assert linkages(found) == stated(synthesize(load(name)).top(50).candidates)
