"""The live page in a real browser: what hands do to it, and what it shows then."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from live_pages import drag, linkages, problem_of, searched, stated
from shown_pages import box_of, state

from grashof import load, synthesize
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml

if TYPE_CHECKING:
    from playwright.sync_api import Page


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


@pytest.mark.slow
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
    stage = box_of(page.locator("#stage"))
    page.locator("[data-mode='area']").click()
    page.mouse.click(stage["x"] + 120, stage["y"] + stage["height"] - 150)
    page.locator("[data-mode='region']").click()
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
def test_joints_move_the_linkage_and_the_wheel_brings_it_closer(page: Page) -> None:
    before = page.locator("#angles").inner_text()
    box = box_of(page.locator("[data-joint=b]"))
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
        assert problem_toml(load(str(path))) == problem_toml(load("luggage"))
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
        "() => document.querySelector('[data-warning]').textContent.includes('not a picture')"
    )
    (tmp_path / "broken.dxf").write_text("no drawing")
    page.locator("[name=drawing]").set_input_files(tmp_path / "broken.dxf")
    page.wait_for_function("() => document.querySelector('[data-warning]').textContent.includes('not a DXF')")


@pytest.mark.slow
@pytest.mark.parametrize("size", [(1440, 900), (1920, 1080), (390, 844)])
def test_it_fits_the_screen(page: Page, size: tuple[int, int]) -> None:
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.wait_for_timeout(200)
    wide = page.evaluate("document.documentElement.scrollWidth")
    assert wide <= size[0]
    if size[0] > 1000:
        box = box_of(page.locator(".listing tbody tr").nth(3))
        assert box["y"] + box["height"] < size[1]
    page.set_viewport_size({"width": 1440, "height": 900})
