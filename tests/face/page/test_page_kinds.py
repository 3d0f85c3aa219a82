"""How the page moves each kind of linkage: its own JavaScript against the positions of the analysis."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from linkages_of_rows import SIX_BARS
from page_parts import RECORD

from grashof.analysis import driver_ranges, solve_kinematics, solve_position, transmission_angle
from grashof.analysis.cylinder.lengths import cylinder_state
from grashof.analysis.mechanism.position import places
from grashof.analysis.mechanism.transmission import quality
from grashof.page.analysis import analysis_page
from grashof.page.designs import linkage_data
from grashof.page.render import script_of
from grashof.problems import Cylinder, FourBar, InvertedSliderCrank, Linkage, LinkageSpec, SliderCrank
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import LOOP_POINTS
from grashof.survey import report_on

if TYPE_CHECKING:
    from playwright.sync_api import Page

ONE_LOOP: dict[str, Linkage] = {
    "four-bar": FourBar((0, 0.5), (4, 0), 1, 4, 3, (2, 1.5), -1),
    "engine": SliderCrank((1, 2), 1, 3, -0.5, 0.6, (1, 0.7)),
    "behind": SliderCrank((1, 2), 1, 3, 0.5, 3.6, (1, -0.7), -1),
    "slider, swinging driver": SliderCrank((0, 0), 3, 2, 0.5, 0.6, (1, 1.5), -1),
    "crank-shaper": InvertedSliderCrank((0, 0), (2, 1), 1, -0.3, (3, 0.5)),
    "whitworth": InvertedSliderCrank((0, 0), (1, 0), 2, 0.4, (3, 1), -1),
    "inverted, swinging driver": InvertedSliderCrank((0, 0), (2, 0.5), 1.5, 1.0, (-1, -0.8)),
    "change point": InvertedSliderCrank((0, 0), (1, 0), 1, 0, (2, 1)),
}
LINKAGES: dict[str, Linkage] = ONE_LOOP | SIX_BARS


def evaluated(window: Page, formula: str, linkage: Linkage, theta2: FloatArray, more: Any = None) -> Any:
    """The values of a formula of the pages' scripts for a `linkage` at every `angle`."""
    scripts = script_of(("kinds.js", "linkage.js"))
    every = f"([linkage, angles, more]) => {{ {scripts} return angles.map((angle) => {formula}); }}"
    window.goto("about:blank")
    return window.evaluate(every, [linkage_data(linkage), theta2.tolist(), more])


def positions(window: Page, linkage: Linkage, theta2: FloatArray) -> list[dict[str, Any]]:
    """Where the scripts of the pages have a linkage."""
    found: list[dict[str, Any]] = evaluated(window, "positionOf(linkage, angle)", linkage, theta2)
    return found


@pytest.fixture(scope="module")
def page_of(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The page of a linkage without sections, made when it is first opened."""
    folder = tmp_path_factory.mktemp("kinds")

    def path_of(name: str, **stated: Any) -> Path:
        path = folder / f"{list(LINKAGES).index(name)}{'-'.join(stated)}.html"
        if not path.exists():
            report = report_on(LinkageSpec(LINKAGES[name], name, length_unit="mm", **stated))
            path.write_text(analysis_page(replace(report, sections=()), RECORD), encoding="utf-8")
        return path

    return path_of


@pytest.fixture
def shown(window: Page, page_of: Callable[[str], Path]) -> Callable[[str], Page]:
    def show(name: str) -> Page:
        window.goto(page_of(name).as_uri())
        return window

    return show


@pytest.mark.parametrize("name", LINKAGES)
def test_positions_are_those_of_the_analysis(window: Page, name: str) -> None:
    linkage = LINKAGES[name]
    ranges = [(low, high) for low, high in driver_ranges(linkage).tolist() if np.isfinite(low)]
    # All of the travel, and close to dead positions.
    near = np.array([1e-6, 1e-3])
    theta2 = np.concatenate(
        [
            np.concatenate([low + near * (high - low), np.linspace(low, high, 90)[1:-1], high - near])
            for low, high in ranges
        ]
    )
    found = positions(window, linkage, theta2)
    state = solve_position(linkage, theta2)
    for key in linkage.mechanism.points:
        np.testing.assert_allclose([each[key] for each in found], state.point(key), atol=1e-9)
    for link, angle in state.angles.items():
        gap = np.array([each[f"theta{link}"] for each in found]) - angle
        np.testing.assert_allclose(np.angle(np.exp(1j * gap)), 0, atol=1e-9)
    loops = range(1, len(linkage.mechanism.dyads) + 1)
    mu = np.min([quality(transmission_angle(linkage, theta2, loop)) for loop in loops], axis=0)
    np.testing.assert_allclose([each["mu"] for each in found], mu, atol=1e-6)
    guided = solve_kinematics(linkage, theta2).frame_angle(linkage.mechanism.carries) + linkage.body_angle
    turned = np.array([each["guided"] for each in found]) - guided
    np.testing.assert_allclose(np.angle(np.exp(1j * turned)), 0, atol=1e-9)
    if linkage.mechanism.slides:
        travel = state.travel
        np.testing.assert_allclose([each["slide"] for each in found], travel, atol=1e-9)


@pytest.mark.parametrize("name", ONE_LOOP)
def test_the_loop_stays_closed_in_dead_positions_and_past_them(window: Page, name: str) -> None:
    linkage = LINKAGES[name]
    ends = driver_ranges(linkage)[np.isfinite(driver_ranges(linkage)).all(axis=1)].ravel()
    theta2 = np.concatenate([ends - 1e-15, ends, ends + 1e-15])
    found = positions(window, linkage, theta2)
    for each in found:
        numbers = [*each["a"], *each["b"], *each["p"], each["theta3"], each["theta4"], each["mu"]]
        assert np.isfinite(np.array(numbers, dtype=float)).all()
        arm = complex(*linkage.coupler_point)
        reach = complex(*each["p"]) - complex(*each["a"])
        assert abs(reach) == pytest.approx(abs(arm), rel=1e-9)


@pytest.mark.quick("behind", "whitworth")
@pytest.mark.parametrize("name", ["behind", "whitworth", "engine", "press of a stephenson-3"])
def test_the_drawing_follows_the_driver(shown: Callable[[str], Page], name: str) -> None:
    linkage, page = LINKAGES[name], shown(name)
    kind = linkage.mechanism
    ((_, block),) = kind.slides
    pin = LOOP_POINTS[block // 2 - 2][2]
    drawn = "document.querySelector('#stage .linkage .block').getAttribute('d')"
    before = page.evaluate(drawn)
    assert before.count("L") == 3
    assert before.endswith("Z")
    for _ in range(5):
        page.keyboard.press("Shift+ArrowRight")
    after = page.evaluate(drawn)
    assert "NaN" not in after
    assert after != before
    at = f"document.querySelector('#stage .joint.{pin}')"
    place = [float(page.evaluate(f"{at}.getAttribute('c{axis}')")) for axis in "xy"]
    corners = np.array([pair.split() for pair in after.strip("MZ").split("L")], dtype=float)
    np.testing.assert_allclose(corners.mean(axis=0), place, atol=0.02)
    guides = page.locator("#stage .ground .guide").count()
    assert guides == (1 in kind.slides[0])
    link, words = kind.links[block - 1], page.locator(".legend").inner_text()
    assert f"{link.name} {'-'.join(link.labels)}" in words
    assert "slide" in page.locator("#angles").inner_text()


@pytest.mark.parametrize("name", ONE_LOOP)
@pytest.mark.parametrize("on", ["driver", "coupler", "output"])
def test_cylinders_are_where_the_analysis_has_them(window: Page, name: str, on: str) -> None:
    linkage, jack = LINKAGES[name], Cylinder(on, (-2.0, 1.5), (0.8, -0.3))
    low, high = driver_ranges(linkage)[0]
    theta2 = np.linspace(low, high, 20)[1:-1]
    formula = "cylinderAt(linkage, more, positionOf(linkage, angle))"
    found = evaluated(window, formula, linkage, theta2, {**jack.stated, "closed": 1.0})
    state = solve_position(linkage, theta2)
    there = cylinder_state(jack, linkage, state).pivot
    np.testing.assert_allclose([each["pivot"] for each in found], there, atol=1e-9)
    first, _, second = zip(*(each["bracket"] for each in found), strict=True)
    joints = linkage.mechanism.links[jack.link - 1].points
    at = places(linkage, state)
    np.testing.assert_allclose(first, at[joints[0]], atol=1e-9)
    np.testing.assert_allclose(second, at[joints[:2][-1]], atol=1e-9)


@pytest.mark.parametrize("name", ["stephenson-3", "press of a watt-2"])
def test_six_bars_play_with_all_their_links(shown: Callable[[str], Page], name: str) -> None:
    linkage, page = LINKAGES[name], shown(name)
    links = linkage.mechanism.links[1:]
    legend = page.locator(".legend").first.inner_text()
    assert all(f"{link.name} {'-'.join(link.labels)}" in legend for link in links)
    assert all(f"θ{link.number} " in page.locator("#angles").inner_text() for link in links)
    seen = []
    for key in ("ArrowLeft", *["Shift+ArrowRight"] * 2):
        page.keyboard.press(key)
        state = page.evaluate("grashof.state()")
        there = solve_position(linkage, state["theta2"])
        points = linkage.mechanism.points
        dots = [page.locator(f"#stage .joint.{point}") for point in points]
        drawn = np.array([[float(dot.get_attribute(f"c{axis}") or "nan") for axis in "xy"] for dot in dots])
        true = np.array([there.point(point) for point in points]) * [1, -1]
        # One scale for all: distances on the screen are those of the linkage.
        apart, truly = drawn - drawn[0], true - true[0]
        scale = np.abs(apart).max() / np.abs(truly).max()
        np.testing.assert_allclose(apart, scale * truly, atol=0.03)
        seen.append(state["theta2"])
    assert len(set(seen)) == 3


def test_the_rod_of_a_cylinder_is_not_that_of_the_linkage(window: Page, page_of: Callable[..., Path]) -> None:
    jack = Cylinder("coupler", (-2.0, 1.5), (0.8, -0.3))
    window.goto(page_of("crank-shaper", cylinder=jack).as_uri())
    drawn = [
        window.evaluate(f"document.querySelector('#stage .linkage {style}').getAttribute('d')")
        for style in (".piston", ".ram", ".coupler.rod", ".bracket.coupler")
    ]
    assert len(set(drawn)) == 4
    assert "cylinder" in window.locator(".legend").first.inner_text()
    assert drawn[0].split("L")[0] == "M" + drawn[1].split("L")[1]  # it comes out of the body


def test_the_page_states_its_kind(page_of: Callable[[str], Path]) -> None:
    text = page_of("engine").read_text(encoding="utf-8")
    assert "slider-crank, r2 1, r3 3, offset -0.5 mm" in text
    data = json.loads(text.split('id="data">')[1].split("</script>")[0])
    assert data["designs"][0]["linkage"]["mechanism"] == "slider-crank"


@pytest.mark.parametrize("name", ["stephenson-3", "press of a stephenson-3", "watt-2 on the output"])
def test_the_output_of_a_six_bar_has_no_jumps(window: Page, name: str) -> None:
    linkage, theta2 = SIX_BARS[name], np.linspace(0, 2 * np.pi, 37)
    outputs = "outputsOf(angles.map((each) => positionOf(linkage, each)))"
    found = np.array(evaluated(window, outputs, linkage, theta2)[0])
    state = solve_position(linkage, theta2)
    expected = state.travel if linkage.mechanism.slides else np.degrees(np.unwrap(state.theta6))
    np.testing.assert_allclose(found - found[0], expected - expected[0], atol=1e-9)
    assert np.ptp(found) > 0.1
