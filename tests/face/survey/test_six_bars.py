"""Analyses of six-bars: published figures, and the second loop in every table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from six_bar_examples import SIX_BARS

from grashof.analysis import solve_position
from grashof.commands import analyse
from grashof.problems import LinkageSpec, ProblemError, SixBar, load, load_linkage_spec
from grashof.study.asked import ON_REQUEST
from grashof.survey import Asked, LinkageReport, report_on
from grashof.wording.verdict import judged_for

STOPPED = SIX_BARS["stephenson-3"].changed(r5=1.0)  # its second loop opens on the way


def facts(report: LinkageReport) -> dict[str, Any]:
    return {fact.key: fact.value for fact in report.facts} | {
        fact.key: fact.value for section in report.sections for fact in section.facts
    }


def extremes(report: LinkageReport) -> pd.DataFrame:
    return report.tables["extremes"].set_index("quantity")


def test_stride_and_lift_of_klanns_leg() -> None:
    """Figures of the patent, by the lengths between its numbered points."""
    table = extremes(report_on(load_linkage_spec("klann")))
    far = table["max"] - table["min"]
    assert far["p_x"] == pytest.approx(1.0087, abs=5e-5)
    assert far["p_y"] == pytest.approx(0.5273, abs=5e-5)


def test_the_dwell_of_a_six_bar() -> None:
    """Swing and dwell of the course project, within a tenth of a degree."""
    report = report_on(load_linkage_spec("dwell-six-bar"), Asked(dwell_deg=0.5))
    found = facts(report)
    assert found["output_swing_deg"] == pytest.approx(15.83, abs=5e-3)
    assert found["dwell_deg"] == pytest.approx(138.5, abs=0.1)
    assert found["dwell_high_theta6_deg"] - found["dwell_low_theta6_deg"] == pytest.approx(0.5, abs=1e-6)
    dwelling = np.linspace(found["dwell_from_deg"], found["dwell_to_deg"], 500)
    theta6 = solve_position(report.sweep.spec.linkage, np.radians(dwelling)).theta6
    assert np.ptp(np.degrees(theta6)) == pytest.approx(0.5, abs=1e-4)


@pytest.mark.parametrize("name", ["dwell-six-bar", "klann"])
def test_the_output_turns_back_where_it_is_least_and_most(name: str) -> None:
    report = report_on(load_linkage_spec(name))
    found, table = facts(report), extremes(report)
    places = [found[f"turns_back_{number}_theta2_deg"] for number in range(1, 5)]
    assert "turns_back_5_theta2_deg" not in found
    assert places == sorted(places)
    for place in table.loc["theta6_deg", ["theta2_min_deg", "theta2_max_deg"]]:
        assert np.isclose(places, place, atol=1e-5).any()
    toggles = [found[f"toggle_{number}_theta2_deg"] for number in range(1, 5)]
    np.testing.assert_allclose(toggles, places, atol=1e-8)
    theta6 = np.degrees(np.unwrap(solve_position(report.sweep.spec.linkage, np.radians(places)).theta6))
    shown = [found[f"turns_back_{number}_theta6_deg"] for number in range(1, 5)]
    np.testing.assert_allclose(np.diff(shown), np.diff(theta6), atol=1e-9)


@pytest.mark.quick("stephenson-3", "press of a watt-2")
@pytest.mark.parametrize("name", SIX_BARS)
def test_tables_and_sections_tell_of_all_links(name: str) -> None:
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
    found, table = facts(report), extremes(report)
    assert not found["full_rotation"]
    ends = np.radians([found["driver_low_deg"], found["driver_high_deg"]])
    np.testing.assert_allclose(solve_position(STOPPED, ends).margins[1], 0, atol=1e-6)
    assert np.isinf(table.loc["omega6", ["min", "max"]].to_numpy(dtype=float)).any()
    assert np.isfinite(table.loc["omega4", ["min", "max"]].to_numpy(dtype=float)).all()
    assert 0 in table.loc["mu_2_deg", ["min", "max"]].to_numpy() % 180
    assert table.loc["mu_deg", "min"] > 40


@pytest.mark.parametrize(
    ("asked", "why"),
    [
        ({"sections": ("newton-raphson",)}, "mechanism watt-2; only four-bar has it"),
        ({"dwell_deg": 1.0}, "a watt-2 whose link 6 slides"),
    ],
)
def test_what_a_press_has_not_is_refused(asked: dict[str, Any], why: str) -> None:
    press = LinkageSpec(SIX_BARS["press of a watt-2"], "press")
    with pytest.raises(ProblemError, match=f"does not go with {why}"):
        report_on(press, Asked(**asked))


def test_links_that_turn_freely_are_refused() -> None:
    loose = SixBar((0, 0), (4, 0), 1, 4, 3, c=(4, 0), d=(3, 0), r5=4, r6=4, hosts=(3, 4))
    with pytest.raises(ProblemError, match="mine: C and D are one point at every driver angle"):
        report_on(LinkageSpec(loose, "mine"))


def test_a_six_bar_is_not_judged_by_tasks_yet() -> None:
    spec = load_linkage_spec("klann")
    with pytest.raises(
        ProblemError, match="klann is a stephenson-3; only linkages of one loop can be judged"
    ):
        judged_for(load("luggage"), spec)


def test_bars_that_are_dead_everywhere_but_for_rounding_are_told_in_one_line(tmp_path: Path) -> None:
    file = tmp_path / "long.toml"
    dyad = "[dyad]\nhosts = [3, 1]\nc = [5, 1]\nd = [6, 2]\nr5 = 1e8\nr6 = 1e8\n"
    four = "o4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\ncoupler_point = [2, 1]\n"
    file.write_text(f'mechanism = "stephenson-3"\n{four}{dyad}')
    with pytest.raises(ProblemError, match="long: its lengths are too unlike to be analysed"):
        analyse(str(file), tmp_path / "made")
    assert not (tmp_path / "made").exists()
