"""Analyses of linkages with a slide and of six-bars: closed forms, published figures, sections of a kind."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from linkages_of_rows import SIX_BARS
from refusals import refusal
from section_facts import extremes, facts

from grashof.analysis import solve_position
from grashof.commands import analyse
from grashof.options import AnalyseOptions
from grashof.problems import (
    DynamicsSpec,
    LinkageSpec,
    SixBar,
    SliderCrank,
    load_linkage_spec,
)
from grashof.study.on_request import ON_REQUEST
from grashof.survey import Asked, LinkageReport, report_on

ENGINE, SHAPER = load_linkage_spec("engine"), load_linkage_spec("crank-shaper")
MASSES = DynamicsSpec(masses=(1, 2, 3), inertias=(100, 1000, 10), speed_rpm=60)


@pytest.fixture(scope="module")
def engine() -> LinkageReport:
    return report_on(replace(ENGINE, dynamics=MASSES))


@pytest.fixture(scope="module")
def shaper() -> LinkageReport:
    return report_on(replace(SHAPER, dynamics=MASSES))


def test_stroke_and_time_ratio_of_an_offset_slider_crank(engine: LinkageReport) -> None:
    """From the right triangles with the sides r3 + r2 and r3 - r2."""
    found = facts(engine)
    far, near = np.sqrt(160**2 - 20**2), np.sqrt(80**2 - 20**2)
    assert found["stroke"] == pytest.approx(far - near, rel=1e-12)
    alpha = np.arcsin(20 / 80) - np.arcsin(20 / 160)
    assert found["time_ratio"] == pytest.approx((np.pi + alpha) / (np.pi - alpha), rel=1e-12)
    assert found["transmission_min_deg"] == pytest.approx(np.degrees(np.arccos(60 / 120)), rel=1e-12)
    stretched = 360 - np.degrees(np.arcsin(1 / 8))
    assert found["toggle_stretched_theta2_deg"] == pytest.approx(stretched, rel=1e-12)
    assert not {"output_swing_deg", "toggle_stretched_theta4_deg", "double_points"} & set(found)


def test_quick_return(shaper: LinkageReport) -> None:
    """r2 / r1 = sin(swing / 2), and (180 + swing) / (180 - swing)."""
    found = facts(shaper)
    assert found["output_swing_deg"] == pytest.approx(60, rel=1e-12)
    assert found["time_ratio"] == pytest.approx(2, rel=1e-12)
    assert "stroke" not in found
    assert "stroke_chord" not in found


def test_travel_of_the_slider_and_its_rates(engine: LinkageReport) -> None:
    """x = r2 cos + sqrt(r3^2 - (r2 sin - offset)^2), and its derivatives, by the table alone."""
    table = engine.tables["kinematics"]
    theta2, omega = np.radians(table["theta2_deg"]), 2 * np.pi
    gap = 40 * np.sin(theta2) + 20
    root = np.sqrt(120**2 - gap**2)
    np.testing.assert_allclose(table["slide_travel"], 40 * np.cos(theta2) + root, rtol=1e-13)
    slope = -40 * np.sin(theta2) - gap * 40 * np.cos(theta2) / root
    np.testing.assert_allclose(table["slide_velocity"], omega * slope, atol=1e-10)
    bend = -40 * np.cos(theta2) - (1600 * np.cos(theta2) ** 2 - gap * 40 * np.sin(theta2)) / root
    bend -= gap**2 * 1600 * np.cos(theta2) ** 2 / root**3
    np.testing.assert_allclose(table["slide_acceleration"], omega**2 * bend, atol=1e-9)
    assert not {"theta4_deg", "omega4", "alpha4"} & set(table)


def test_travel_of_the_rod(shaper: LinkageReport) -> None:
    """The distance from A to O4, by the law of cosines."""
    table = shaper.tables["kinematics"]
    theta2 = np.radians(table["theta2_deg"])
    far = np.sqrt(300**2 + 150**2 + 2 * 300 * 150 * np.sin(theta2))
    np.testing.assert_allclose(table["slide_travel"], far, rtol=1e-13)
    np.testing.assert_allclose((table["theta4_deg"] - table["theta3_deg"]) % 360, 90, atol=1e-9)
    travel = extremes(shaper).loc["slide_travel", ["min", "max"]]
    assert travel.tolist() == pytest.approx([150, 450], rel=1e-12)


@pytest.mark.parametrize("report", ["engine", "shaper"])
def test_forces_in_the_slide(report: str, request: pytest.FixtureRequest) -> None:
    found: LinkageReport = request.getfixturevalue(report)
    table = found.tables["dynamics"]
    key = "f14" if report == "engine" else "f43"
    np.testing.assert_allclose(table[key], np.abs(table["slide_force"]), rtol=1e-9)  # no friction
    power = 2 * np.pi * table["torque"]
    np.testing.assert_allclose(table["power"], power, rtol=1e-12)


def test_a_driver_that_swings(tmp_path: object) -> None:
    spec = LinkageSpec(SliderCrank((5, 5), 90, 60, 20, 0.7, (30, 30), -1), "swings", length_unit="mm")
    found = facts(report_on(spec))
    assert {"driver_low_1_deg", "driver_high_2_deg", "stroke_1", "stroke_2"} <= set(found)
    assert found["transmission_min_deg"] == 0
    along = np.degrees(np.arcsin((20 - 60) / 90)), np.degrees(np.arcsin((20 + 60) / 90))
    turned = np.degrees(0.7)
    ends = {found[f"driver_{end}_{number}_deg"] % 360 for end in ("low", "high") for number in (1, 2)}
    wanted = {(turned + each) % 360 for each in along} | {(turned + 180 - each) % 360 for each in along}
    np.testing.assert_allclose(sorted(ends), sorted(wanted), atol=1e-9)


PRESS = LinkageSpec(SIX_BARS["press of a watt-2"], "press")


@pytest.mark.parametrize(
    ("spec", "asked", "line"),
    [
        (ENGINE, {"sections": ("newton-raphson",)}, "newton-raphson does not go with mechanism slider-crank"),
        (ENGINE, {"dwell_deg": 5.0}, "dwell_deg does not go with mechanism slider-crank; only four-bar"),
        (PRESS, {"sections": ("newton-raphson",)}, "newton-raphson does not go with mechanism watt-2"),
        (PRESS, {"dwell_deg": 1.0}, "dwell_deg does not go with a watt-2 whose link 6 slides"),
    ],
)
def test_options_of_other_kinds_are_refused_in_one_line(
    spec: LinkageSpec, asked: dict[str, Any], line: str
) -> None:
    message = refusal(report_on, spec, Asked(**asked))
    assert message.startswith(line)
    assert "\n" not in message
    assert "sections" not in asked or "; only four-bar has it" in message


@pytest.mark.slow
@pytest.mark.quick("crank-shaper")
@pytest.mark.parametrize("spec", [ENGINE, SHAPER], ids=lambda spec: spec.name)
def test_all_long_sections_at_once_are_those_that_the_kind_has(spec: LinkageSpec) -> None:
    over = {"at_deg": (0.0, 90.0), "seconds": 0.5, "step": 0.002}
    asked = Asked(sections=ON_REQUEST, tolerance=0.1, flywheel=0.05, **over)  # type: ignore[arg-type]
    found = {section.key: section for section in report_on(replace(spec, dynamics=MASSES), asked).sections}
    wanted = "over-time positions fits differences pin-forces equations tolerance flywheel"
    assert {*wanted.split()} <= set(found)
    assert "newton-raphson" not in found
    assert ("mechanical-advantage" in found) == (spec is SHAPER)
    assert facts(found["equations"])["equations_torque_difference"] < 1e-12
    shares = [fact.value for fact in found["differences"].facts if fact.key.endswith("order_4")]
    assert max(map(float, shares)) < 1e-4  # type: ignore[arg-type]


STOPPED = SIX_BARS["stephenson-3"].changed(r5=1.0)  # its second loop opens on the way


def every_fact(report: LinkageReport) -> dict[str, Any]:
    """By keys, those of sections, too."""
    return {key: fact for part in (report, *report.sections) for key, fact in facts(part).items()}


@pytest.fixture(scope="module")
def klann() -> LinkageReport:
    return report_on(load_linkage_spec("klann"))


def test_stride_and_lift_of_klanns_leg(klann: LinkageReport) -> None:
    """Figures of the patent, by the lengths between its numbered points."""
    table = extremes(klann)
    far = table["max"] - table["min"]
    assert far["p_x"] == pytest.approx(1.0087, abs=5e-5)
    assert far["p_y"] == pytest.approx(0.5273, abs=5e-5)


def test_the_dwell_of_a_six_bar() -> None:
    """Swing and dwell of the course project, within a tenth of a degree."""
    report = report_on(load_linkage_spec("dwell-six-bar"), Asked(dwell_deg=0.5))
    found = every_fact(report)
    assert found["output_swing_deg"] == pytest.approx(15.83, abs=5e-3)
    assert found["dwell_deg"] == pytest.approx(138.5, abs=0.1)
    assert found["dwell_high_theta6_deg"] - found["dwell_low_theta6_deg"] == pytest.approx(0.5, abs=1e-6)
    dwelling = np.linspace(found["dwell_from_deg"], found["dwell_to_deg"], 500)
    theta6 = solve_position(report.sweep.spec.linkage, np.radians(dwelling)).theta6
    assert np.ptp(np.degrees(theta6)) == pytest.approx(0.5, abs=1e-4)


def test_the_output_turns_back_where_it_is_least_and_most(klann: LinkageReport) -> None:
    found, table = every_fact(klann), extremes(klann)
    places = [found[f"turns_back_{number}_theta2_deg"] for number in range(1, 5)]
    assert "turns_back_5_theta2_deg" not in found
    assert places == sorted(places)
    for place in table.loc["theta6_deg", ["theta2_min_deg", "theta2_max_deg"]]:
        assert np.isclose(places, place, atol=1e-5).any()
    toggles = [found[f"toggle_{number}_theta2_deg"] for number in range(1, 5)]
    np.testing.assert_allclose(toggles, places, atol=1e-8)
    theta6 = np.degrees(np.unwrap(solve_position(klann.sweep.spec.linkage, np.radians(places)).theta6))
    shown = [found[f"turns_back_{number}_theta6_deg"] for number in range(1, 5)]
    np.testing.assert_allclose(np.diff(shown), np.diff(theta6), atol=1e-9)


@pytest.mark.quick("press of a watt-2")
@pytest.mark.parametrize("name", ["stephenson-3", "watt-1 on driver and coupler", "press of a watt-2"])
def test_tables_and_sections_cover_all_links(name: str) -> None:
    linkage = SIX_BARS[name]
    kind, slides = linkage.mechanism, bool(linkage.mechanism.slides)
    asked: dict[str, Any] = {"seconds": 1.0, "step": 0.25, "at_deg": (10, 200), "sections": ON_REQUEST}
    report = report_on(
        LinkageSpec(linkage, name), Asked(**asked, tolerance=0.01, dwell_deg=None if slides else 2.0)
    )
    kinematics = report.tables["kinematics"]
    state = solve_position(linkage, np.radians(kinematics["theta2_deg"].to_numpy()))
    for link in kind.links[2:]:
        if f"theta{link.number}_deg" in kinematics:
            gap = np.radians(kinematics[f"theta{link.number}_deg"]) - state.angles[link.number]
            np.testing.assert_allclose(np.exp(1j * gap), 1, atol=1e-12)
        else:
            assert link.name == "slider-2"
    for point in kind.moving:
        np.testing.assert_allclose(kinematics[[f"{point}_x", f"{point}_y"]], state.point(point), atol=1e-12)
    for loop, margin in zip(("", "_2"), state.margins, strict=True):
        mu = np.radians(kinematics[f"mu{loop}_deg"])
        np.testing.assert_allclose(np.sin(mu), np.abs(margin), atol=1e-12)
    sections = {section.key: section for section in report.sections}
    assert ("dwell" in sections) == (not slides)
    assert "newton-raphson" not in sections
    assert {f"jerk{link.number}" for link in kind.links[2:]} <= {*sections["hodographs"].tables["jerk"]}
    assert {f"g{number}_x" for number in range(2, 7)} <= {*sections["mass-centres"].tables["mass-centres"]}
    assert {f"p_{dimension}" for dimension in kind.dimensions} <= {*sections["tolerance"].tables["tolerance"]}
    (drawing,) = sections["positions"].plots
    corners = drawing.series["theta2 = 10 deg"]
    there = solve_position(linkage, np.radians(10))
    for point in kind.points:
        assert np.isclose(corners, there.point(point)).all(axis=1).any()


def test_a_driver_that_the_second_loop_stops() -> None:
    report = report_on(LinkageSpec(STOPPED, "stopped"))
    assert "shown is assembly +1 +1" in report.notes[0]
    found, table = every_fact(report), extremes(report)
    assert not found["full_rotation"]
    ends = np.radians([found["driver_low_deg"], found["driver_high_deg"]])
    np.testing.assert_allclose(solve_position(STOPPED, ends).margins[1], 0, atol=1e-6)
    assert np.isinf(table.loc["omega6", ["min", "max"]].to_numpy(dtype=float)).any()
    assert np.isfinite(table.loc["omega4", ["min", "max"]].to_numpy(dtype=float)).all()
    assert 0 in table.loc["mu_2_deg", ["min", "max"]].to_numpy() % 180
    assert table.loc["mu_deg", "min"] > 40


def test_links_that_turn_freely_are_refused() -> None:
    loose = SixBar((0, 0), (4, 0), 1, 4, 3, c=(4, 0), d=(3, 0), r5=4, r6=4, hosts=(3, 4))
    said = refusal(report_on, LinkageSpec(loose, "mine"))
    assert said.startswith("mine: C and D are one point at every driver angle")


def test_bars_that_are_dead_everywhere_but_for_rounding_are_refused_in_one_line(tmp_path: Path) -> None:
    file = tmp_path / "long.toml"
    dyad = "[dyad]\nhosts = [3, 1]\nc = [5, 1]\nd = [6, 2]\nr5 = 1e8\nr6 = 1e8\n"
    four = "o4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\ncoupler_point = [2, 1]\n"
    file.write_text(f'mechanism = "stephenson-3"\n{four}{dyad}')
    said = refusal(analyse, str(file), AnalyseOptions(out=tmp_path / "made"))
    assert "long: its lengths are too unlike to be analysed" in said
    assert not (tmp_path / "made").exists()
