"""The groups of an analysis in a real browser: folded, drawn when seen, marks, ranges."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from shown_pages import Open, box_of, state, wait_until

from grashof.survey import LinkageReport

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page


def plot(page: Page, title: str) -> Locator:
    """A plot in sight, by its title without its unit."""
    found = page.locator("figure.plot").filter(has=page.get_by_label(f"Save {title} as SVG", exact=True))
    found.scroll_into_view_if_needed()
    found.locator("> svg .grid").wait_for(state="attached")
    return found


def open_group(page: Page, title: str) -> None:
    page.locator("summary").filter(has_text=title).click()


def texts(found: Locator) -> list[str]:
    return [text.replace("−", "-") for text in found.all_text_contents()]


def readings(figure: Locator) -> list[str]:
    return texts(figure.locator("output"))


def dots(figure: Locator) -> list[tuple[float, float]]:
    return [
        (float(dot.get_attribute("cx") or "nan"), float(dot.get_attribute("cy") or "nan"))
        for dot in figure.locator("circle.dot:not([visibility=hidden])").all()
    ]


@pytest.mark.slow
def test_groups_are_drawn_when_they_are_opened_and_seen(opened: Open) -> None:
    page = opened("sections", size=(1440, 900))
    wait_until(page, "grashof.state().groups[0].drawn === 5")
    first, *others = state(page)["groups"]
    assert (first["open"], first["made"]) == (True, 5)
    assert {(group["open"], group["made"]) for group in others} == {(False, 0)}
    page.locator("#open-all").click()
    wait_until(page, "grashof.state().groups.every((group) => group.open)")
    page.locator(".group summary").nth(1).evaluate("(node) => node.scrollIntoView()")
    wait_until(page, "grashof.state().groups[1].drawn === 3")
    assert [group["made"] for group in state(page)["groups"]] == [5, 3, 7, 9, 14, 3, 0, 5]
    assert state(page)["groups"][-1]["drawn"] == 0  # far below
    page.locator(".group").last.scroll_into_view_if_needed()
    wait_until(page, "grashof.state().groups.at(-1).drawn > 0")
    page.locator("#close-all").click()
    wait_until(page, "grashof.state().groups.every((group) => !group.open)")


def test_the_keyboard_folds_and_unfolds(opened: Open) -> None:
    page = opened("sections")
    theta2 = state(page)["theta2"]
    second = page.locator(".group summary").nth(1)
    second.focus()
    for key, expected in (("Enter", True), ("Space", False), ("Space", True)):
        page.keyboard.press(key)
        wait_until(page, f"grashof.state().groups[1].open === {str(expected).lower()}")
    wait_until(page, "grashof.state().groups[1].made === 3")
    assert not state(page)["playing"]
    assert state(page)["theta2"] == theta2
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.getAttribute('aria-label')") == (
        "Save torque factor of the output arm as SVG"
    )
    names = page.locator(".save button").evaluate_all("nodes => nodes.map((node) => node.ariaLabel)")
    assert len(set(names)) == len(names) == 2 * (5 + 3)


def test_marks_follow_the_linkage(opened: Open, example: LinkageReport) -> None:
    page = opened("sections", size=(1440, 900))
    page.locator("#stage").focus()
    for _ in range(7):
        page.keyboard.press("ArrowRight")
    assert np.degrees(state(page)["theta2"]) == pytest.approx(67)
    row = example.tables["kinematics"].set_index("theta2_deg").loc[67]
    shown = [float(text) for text in readings(plot(page, "angles"))]
    assert shown == pytest.approx(row[["theta3_deg", "theta4_deg", "mu_deg"]].tolist(), rel=1e-3)
    open_group(page, "Other axes")
    track = plot(page, "track")
    across, up = (float(value) for value in readings(track)[0].split(", "))
    angle = np.radians(67)
    assert (across, up) == pytest.approx((3 * np.cos(angle), 2 * np.sin(angle)), rel=1e-3)
    motor = plot(page, "motor")
    assert float(readings(motor)[0]) == pytest.approx(np.sin(2 * angle), rel=1e-3)
    assert len(dots(motor)) == 1


def test_in_a_gap_nothing_is_read_and_no_dot_is_seen(opened: Open) -> None:
    page = opened("sections", size=(1440, 900))
    open_group(page, "=1+1")
    gaps = plot(page, "with gaps")
    page.locator("#stage").focus()
    assert readings(gaps) == ["0.866", "–"]
    assert len(dots(gaps)) == 1
    for _ in range(4):
        page.keyboard.press("Shift+ArrowRight")
    assert np.degrees(state(page)["theta2"]) == pytest.approx(100)
    assert readings(gaps) == ["–", "–"]
    assert dots(gaps) == []
    # Angles that hardly vary have numbers at their axis.
    numbers = [
        float(each) for each in texts(plot(page, "small angle").locator(".grid text[text-anchor=end]"))
    ]
    assert len(numbers) >= 3
    assert 20 - 2e-6 < min(numbers) < 20 < max(numbers) < 20 + 2e-6
    assert len(set(numbers)) == len(numbers)


def test_tracks_have_equal_scales_and_a_click_turns_the_driver_to_its_place(opened: Open) -> None:
    page = opened("sections", size=(1440, 900))
    open_group(page, "Other axes")
    track = plot(page, "track")
    size = "node => [node.getBBox().width, node.getBBox().height]"
    width, height = track.locator("> svg > path.curve").evaluate(size)
    assert width / height == pytest.approx(3 / 2, abs=0.01)
    path = box_of(track.locator("> svg > path.curve"))
    page.mouse.click(path["x"] + path["width"] / 2, path["y"])  # the highest point
    assert np.degrees(state(page)["theta2"]) == pytest.approx(90, abs=3)
    (dot,) = dots(track)
    frame = box_of(track.locator("> svg"))
    assert (frame["x"] + dot[0], frame["y"] + dot[1]) == pytest.approx(
        (path["x"] + path["width"] / 2, path["y"]), abs=3
    )


def test_over_time_the_mouse_reads_the_values_at_its_place(opened: Open) -> None:
    page = opened("sections", size=(1440, 900))
    open_group(page, "Other axes")
    run = plot(page, "run-out")
    assert readings(run) == ["", ""]
    assert "time (s)" in texts(run.locator("> svg text"))
    curve = box_of(run.locator("> svg > path.curve").first)
    before = state(page)["theta2"]
    page.mouse.move(curve["x"] + curve["width"] / 4, curve["y"] + curve["height"] / 2)
    fast, slow = (float(text) for text in readings(run))
    assert slow == pytest.approx(3, abs=0.05)
    assert fast == pytest.approx(10 * slow, rel=1e-3)
    assert state(page)["theta2"] == before
    # More than eight lines all look different.
    look = "({ stroke, strokeDasharray }) => `${stroke} ${strokeDasharray}`"
    lines = plot(page, "sag").locator("> svg > path.curve")
    looks = lines.evaluate_all(f"nodes => nodes.map((node) => getComputedStyle(node)).map({look})")
    assert len(set(looks)) == len(looks) == 12


def test_each_range_has_its_own_window(opened: Open, swinging: LinkageReport) -> None:
    page = opened("swinging", size=(1440, 900))
    for number, (low, high) in enumerate(swinging.sweep.ranges):
        page.locator("#range").select_option(str(number))
        angles = plot(page, "angles")
        numbers = texts(angles.locator(".grid text[text-anchor=middle]"))
        shown = [float(each) for each in numbers]
        assert len(shown) > 1
        assert np.degrees(low) <= min(shown) < max(shown) <= np.degrees(high)
        # The middle of the range.
        rows = swinging.tables["kinematics"]
        rows = rows[rows["range"] == number + 1]
        expected = np.interp(np.degrees(low + high) / 2, rows["theta2_deg"], rows["mu_deg"])
        assert float(readings(angles)[2]) == pytest.approx(expected, rel=1e-3)
        assert len(dots(angles)) == 3
        # At the very end of the range the mark is still there.
        page.locator("#stage").focus()
        page.keyboard.press("End")
        assert len(dots(angles)) == 3


def test_rates_of_a_driver_that_swings_are_cut_off(opened: Open) -> None:
    figure = plot(opened("swinging", size=(1440, 900)), "angular velocity")
    numbers = texts(figure.locator(".grid text[text-anchor=end]"))
    assert max(abs(float(each)) for each in numbers) < 100
    frame = box_of(figure.locator("> svg"))
    for path in figure.locator("> svg > path.curve").all():
        box = box_of(path)
        assert box["y"] >= frame["y"]
        assert box["y"] + box["height"] <= frame["y"] + frame["height"]
