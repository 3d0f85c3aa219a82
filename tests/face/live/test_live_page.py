"""The live page in a real browser: what hands do to it, and what it shows then."""

from __future__ import annotations

import json
import os
import signal
import tomllib
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, Route

from grashof import load, synthesize, track
from grashof.analysis import solve_kinematics
from grashof.problems import Problem
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.values.linkages.mechanisms import linkage_of

State = dict[str, Any]


@pytest.fixture(scope="module")
def window(browser: Browser) -> Iterator[Page]:
    opened = browser.new_page(viewport={"width": 1440, "height": 900})
    yield opened
    opened.close()


@pytest.fixture
def page(window: Page, served: str) -> Iterator[Page]:
    """A fresh live page whose first search is done; nothing may have been complained of."""
    complaints: list[str] = []
    window.on("console", lambda message: complaints.append(f"{message.type}: {message.text}"))
    window.on("pageerror", lambda error: complaints.append(str(error)))
    window.goto("about:blank")
    window.goto(served)
    searched(window)
    yield window
    assert complaints == []


def state(page: Page) -> State:
    found: State = page.evaluate("window.grashof.state()")
    return found


def shown(page: Page, condition: str) -> State:
    """The page as soon as a condition holds for its state `s`."""
    there = "const s = window.grashof && window.grashof.state(); return s && s.listed"
    found: State = page.wait_for_function(
        f"() => {{ {there} && {condition} && s; }}", timeout=200_000
    ).json_value()
    return found


def searched(page: Page) -> State:
    """The page once its newest task is searched."""
    return shown(page, "s.listed.phase === 'found' && s.listed.version === s.version && !s.busy")


def problem_of(found: State) -> Problem:
    return problem_from(found["document"], "luggage")


def linkages(found: State) -> list[dict[str, Any]]:
    return [design["linkage"] for design in found["designs"]]


def keys(found: State) -> list[int]:
    return [design["key"] for design in found["designs"]]


def stated(designs: Any) -> list[dict[str, Any]]:
    return [{"mechanism": each.linkage.mechanism.word, **each.linkage.stated} for each in designs]


def place_of(page: Page, handle: str) -> tuple[float, float]:
    found = f"document.querySelector(`[data-handle='{handle}'] .reach`).getBoundingClientRect()"
    x, y = page.evaluate(f"() => {{ const r = {found}; return [r.x + r.width / 2, r.y + r.height / 2]; }}")
    return x, y


def drag(page: Page, handle: str, by: tuple[float, float], steps: int = 5) -> None:
    x, y = place_of(page, handle)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + by[0], y + by[1], steps=steps)
    page.mouse.up()


@pytest.mark.study
def test_forty_moves_show_what_the_library_gives(page: Page) -> None:
    """Each followed list is `track` of the last one, and in the end the list is that of a search."""
    page.evaluate(
        "addEventListener('keydown', () => { window.before = structuredClone(grashof.state()); }, true)"
    )
    page.locator("[data-handle='target-1']").focus()
    designs = list(synthesize(load("luggage")).top(50).candidates[:10])
    ways = ["ArrowUp", "ArrowLeft", "ArrowDown", "ArrowRight"]
    followed = 0
    for number in range(40):
        page.keyboard.press(ways[number // 3 % 4])
        found = shown(page, "s.listed.version === s.version && s.listed.phase !== 'searching'")
        before: State = page.evaluate("() => window.before")
        if before["listed"]["phase"] == "found":
            designs = list(synthesize(problem_of(before)).top(50).candidates[:10])
        moved = track(designs, problem_of(found))
        designs = [new if new.verdict.ok else old for new, old in zip(moved, designs, strict=True)]
        if found["listed"]["phase"] == "track" and linkages(found)[:10] == stated(designs):
            assert len(found["lost"]) == sum(not new.verdict.ok for new in moved)
            assert keys(found)[:10] == keys(before)[:10]
            followed += 1
        else:  # a search had found designs meanwhile, which the page had not shown yet
            designs = list(synthesize(problem_of(searched(page))).top(50).candidates[:10])
            assert linkages(state(page))[:10] == stated(designs)
    assert followed >= 10
    last = searched(page)
    assert linkages(last) == stated(synthesize(problem_of(last)).top(50).candidates)
    assert last["document"]["motion"]["poses"] == page.evaluate("grashof.state().document.motion.poses")


@pytest.mark.slow
def test_a_pose_is_dragged_by_its_place_and_by_its_angle(page: Page) -> None:
    before = state(page)["document"]["motion"]["poses"]
    drag(page, "target-2", (12, -20))
    after = searched(page)["document"]["motion"]["poses"]
    assert after[2][0] > before[2][0]
    assert after[2][1] > before[2][1]
    assert [after[k] for k in (0, 1, 3)] == [before[k] for k in (0, 1, 3)]
    drag(page, "angle-2", (0, 15))
    turned = searched(page)["document"]["motion"]["poses"]
    assert turned[2][2] < after[2][2] - 5
    assert turned[2][:2] == after[2][:2]
    page.keyboard.press("Control+z")
    assert searched(page)["document"]["motion"]["poses"] == after
    page.keyboard.press("Control+z")
    assert searched(page)["document"]["motion"]["poses"] == before
    page.keyboard.press("Control+Shift+z")
    assert searched(page)["document"]["motion"]["poses"] == after


def test_a_locked_target_stays(page: Page) -> None:
    page.locator("tr[data-target='1'] [data-do=lock]").click()
    before = state(page)["document"]
    drag(page, "target-1", (30, 30))
    page.locator("[data-handle='target-1']").focus()
    page.keyboard.press("Shift+ArrowLeft")
    page.keyboard.press("Delete")
    assert state(page)["document"] == before
    assert page.locator("tr[data-target='1'] [data-do=remove]").is_disabled()


@pytest.mark.slow
def test_numbers_limits_goals_and_kinds_are_those_of_the_file(page: Page) -> None:
    page.locator("tr[data-target='1'] [data-cell=x]").fill("3.4")
    page.locator("tr[data-target='1'] [data-cell=x]").press("Enter")
    page.locator("[name=objective]").select_option("compactness")
    page.locator("input[type=number][data-limit=size]").fill("13")
    page.locator("input[type=number][data-limit=size]").press("Enter")
    page.locator("[name=mechanism][value=slider-crank]").check()
    found = searched(page)
    document = found["document"]
    assert document["motion"]["poses"][1][0] == 3.4
    assert document["objective"] == {"maximise": "compactness"}
    assert document["requirements"]["size"] == [0, 13]
    assert document["mechanism"] == ["four-bar", "slider-crank"]
    assert linkages(found) == stated(synthesize(problem_of(found)).top(50).candidates)
    page.locator("input[type=number][data-limit=size]").fill("")
    page.locator("input[type=number][data-limit=size]").press("Enter")
    page.locator("tr[data-target='0'] [data-cell=x]").fill("none")
    page.locator("tr[data-target='0'] [data-cell=x]").press("Enter")
    again = searched(page)["document"]
    assert "size" not in again["requirements"]
    assert again["motion"]["poses"][0][0] == 5
    assert page.locator("tr[data-target='0'] [data-cell=x]").input_value() == "5"


@pytest.mark.slow
def test_areas_regions_and_targets_are_added_and_removed(page: Page) -> None:
    stage = page.locator("#stage").bounding_box()
    assert stage is not None
    page.locator("[data-mode='area']").click()
    page.mouse.click(stage["x"] + 120, stage["y"] + stage["height"] - 150)
    page.locator("[data-mode='region o2 o4']").click()
    page.mouse.click(stage["x"] + stage["width"] / 2, stage["y"] + stage["height"] / 2)
    page.locator("[data-mode='add']").click()
    page.mouse.click(stage["x"] + 80, stage["y"] + 200)
    page.locator("[data-mode='move']").click()
    document = state(page)["document"]
    assert len(document["requirements"]["keep_out"][0]) == 4
    assert document["requirements"]["o2"] == document["requirements"]["o4"]
    assert len(document["motion"]["poses"]) == 5
    drag(page, "area 1 2", (25, -10))
    assert state(page)["document"]["requirements"]["keep_out"] != document["requirements"]["keep_out"]
    page.locator("[data-handle='target-4']").focus()
    page.keyboard.press("Delete")
    page.locator("[data-handle^='O2, O4 region']").first.focus()
    page.keyboard.press("Delete")
    after = state(page)["document"]
    assert len(after["motion"]["poses"]) == 4
    assert "o2" not in after["requirements"]
    problem_from(after, "luggage")


@pytest.mark.slow
def test_a_path_is_drawn_by_hand(page: Page) -> None:
    assert page.locator("[data-mode=draw]").is_hidden()  # of poses there is no path to draw
    page.locator("[data-menu=open] summary").click()
    page.locator("[name=catalogue]").select_option("path-vertical-line")
    page.wait_for_function("() => window.grashof.state().document.kind === 'path'")
    searched(page)
    stage = page.locator("#stage").bounding_box()
    assert stage is not None
    page.locator("[data-mode='draw']").click()
    left, middle = stage["x"] + 150, stage["y"] + stage["height"] / 2
    page.mouse.move(left, middle - 56)
    page.mouse.down()
    for k in range(30):
        page.mouse.move(left + 10 * k, middle - (k - 15) ** 2 / 4)
    page.mouse.up()
    points = state(page)["document"]["path"]["points"]
    assert len(points) == 12
    steps = [((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5 for a, b in pairwise(points)]
    assert max(steps) < 1.1 * min(steps)


@pytest.mark.slow
def test_joints_move_the_linkage_and_the_wheel_brings_it_closer(page: Page) -> None:
    before = page.locator("#angles").inner_text()
    box = page.locator("[data-joint=b]").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 12, box["y"] + 12)
    page.mouse.down()
    page.mouse.move(box["x"] - 40, box["y"] + 20, steps=6)
    page.mouse.up()
    assert page.locator("#angles").inner_text() != before
    document = state(page)["document"]
    page.locator("#stage").focus()
    page.locator("#stage").hover()
    page.mouse.wheel(0, -300)
    assert state(page)["document"] == document


@pytest.mark.quick("list")
@pytest.mark.slow
@pytest.mark.parametrize("what", ["problem", "list", "report", "dxf", "svg", "png"])
def test_files_are_saved(page: Page, what: str, tmp_path: Path) -> None:
    page.locator("[data-menu=save] summary").click()
    with page.expect_download() as waiting:
        page.locator(f"[data-save={what}]").click()
    path = tmp_path / waiting.value.suggested_filename
    waiting.value.save_as(path)
    if what == "problem":
        read = load(str(path))
        assert [one.id for one in synthesize(read).candidates] == [
            one.id for one in synthesize(load("luggage")).candidates
        ]
        assert tomllib.loads(path.read_text())["kind"] == "motion"
    elif what == "dxf":
        import ezdxf

        assert len(list(ezdxf.readfile(path).modelspace())) > 10
    elif what == "png":
        assert path.read_bytes().startswith(b"\x89PNG")
    elif what == "svg":
        assert path.read_text().count("<path") > 10
        assert "class=" not in path.read_text()
    else:
        assert path.stat().st_size > 10_000


def behind(page: Page) -> list[float]:
    """Left, top, width and height of what lies behind the task, px."""
    script = "document.querySelector('.backdrop').firstElementChild.getBoundingClientRect()"
    found: list[float] = page.evaluate(f"(r => [r.x, r.y, r.width, r.height])({script})")
    return found


@pytest.mark.slow
def test_a_drawing_and_a_photo_lie_behind_scaled_by_two_points(page: Page, tmp_path: Path) -> None:
    import ezdxf
    from PIL import Image

    document = ezdxf.new()
    document.modelspace().add_line((0, 0), (4, 2))
    document.saveas(tmp_path / "plan.dxf")
    page.locator("[name=drawing]").set_input_files(tmp_path / "plan.dxf")
    page.wait_for_selector(".backdrop path", state="attached")
    grid = page.evaluate("document.querySelector('#stage').getBoundingClientRect().width")
    first = behind(page)
    assert 0 < first[2] < grid
    assert first[3] == pytest.approx(first[2] / 2, abs=2)
    left, bottom = first[0], first[1] + first[3]
    for x, y in ((left, bottom), (left + first[2], first[1])):
        page.mouse.click(x, y)
    page.locator("[name=distance]").fill(str(2 * 20**0.5))  # the line is to be twice as long
    page.locator("[data-distance] button").click()
    view = behind(page)
    assert view[2] / view[3] == pytest.approx(2, rel=0.05)
    Image.new("RGB", (40, 20), "red").save(tmp_path / "photo.png")
    page.locator("[name=photo]").set_input_files(tmp_path / "photo.png")
    page.wait_for_selector(".backdrop image", state="attached")
    _, _, width, height = behind(page)
    assert width == pytest.approx(2 * height, rel=0.01)
    (tmp_path / "broken.png").write_text("no picture")
    page.locator("[name=photo]").set_input_files(tmp_path / "broken.png")
    page.wait_for_function(
        "() => document.querySelector('[data-notice]').textContent.includes('not a picture')"
    )
    (tmp_path / "broken.dxf").write_text("no drawing")
    page.locator("[name=drawing]").set_input_files(tmp_path / "broken.dxf")
    page.wait_for_function("() => document.querySelector('[data-notice]').textContent.includes('not a DXF')")


def hold_searches(route: Route, waiting: list[Route]) -> None:
    """Searches wait until they are let go."""
    if route.request.post_data_json["what"] == "search":
        waiting.append(route)
    else:
        route.continue_()


@pytest.mark.study
def test_designs_are_compared_and_lost_ones_fade_with_what_they_miss(page: Page) -> None:
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
def test_what_a_search_has_not_found_yet_comes_back(page: Page) -> None:
    """While it goes on, the chosen and compared designs may be missing; its end decides."""
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
def test_without_a_design_the_closest_miss_is_shown_and_what_to_relax(page: Page) -> None:
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
        told = float(page.locator("#velocity output").inner_text().replace("−", "-"))
        assert told == pytest.approx(speed, rel=1e-3)
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


@pytest.mark.slow
@pytest.mark.parametrize("size", [(1440, 900), (1920, 1080), (390, 844)])
def test_it_fits_the_screen(page: Page, size: tuple[int, int]) -> None:
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.wait_for_timeout(200)
    wide = page.evaluate("document.documentElement.scrollWidth")
    assert wide <= size[0]
    if size[0] > 1000:
        box = page.locator(".listing tbody tr").nth(3).bounding_box()
        assert box is not None
        assert box["y"] + box["height"] < size[1]
    page.set_viewport_size({"width": 1440, "height": 900})
