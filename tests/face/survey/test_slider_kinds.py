"""Analyses of linkages with a slide: closed forms of strokes, travel and rates; sections that a kind has."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from section_facts import facts

from grashof.problems import DynamicsSpec, LinkageSpec, ProblemError, SliderCrank, load_linkage_spec
from grashof.study.asked import ON_REQUEST
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
    assert found["toggle_stretched_theta2_deg"] == pytest.approx(
        360 - np.degrees(np.arcsin(1 / 8)), rel=1e-12
    )
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
    extremes = shaper.tables["extremes"].set_index("quantity")
    assert extremes.loc["slide_travel", ["min", "max"]].tolist() == pytest.approx([150, 450], rel=1e-12)


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


@pytest.mark.parametrize(
    ("name", "asked"),
    [("newton-raphson", {"sections": ("newton-raphson",)}), ("dwell_deg", {"dwell_deg": 5.0})],
)
def test_sections_that_a_kind_has_not_are_refused_in_one_line(name: str, asked: dict[str, Any]) -> None:
    with pytest.raises(ProblemError) as refused:
        report_on(replace(ENGINE, dynamics=MASSES), Asked(**asked))
    assert str(refused.value).startswith(f"{name} does not go with mechanism slider-crank; only four-bar")
    assert "\n" not in str(refused.value)


@pytest.mark.slow
@pytest.mark.quick("crank-shaper")
@pytest.mark.parametrize("spec", [ENGINE, SHAPER], ids=lambda spec: spec.name)
def test_all_long_sections_at_once_are_those_that_the_kind_has(spec: LinkageSpec) -> None:
    asked = Asked(
        sections=ON_REQUEST, tolerance=0.1, at_deg=(0.0, 90.0), seconds=0.5, step=0.002, flywheel=0.05
    )
    found = {section.key: section for section in report_on(replace(spec, dynamics=MASSES), asked).sections}
    wanted = "over-time positions fits differences pin-forces equations tolerance flywheel"
    assert {*wanted.split()} <= set(found)
    assert "newton-raphson" not in found
    assert ("mechanical-advantage" in found) == (spec is SHAPER)
    assert facts(found["equations"])["equations_torque_difference"] < 1e-12
    shares = [fact.value for fact in found["differences"].facts if fact.key.endswith("order_4")]
    assert max(map(float, shares)) < 1e-4  # type: ignore[arg-type]
