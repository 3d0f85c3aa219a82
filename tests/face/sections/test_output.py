"""Mechanical advantage and dwell: against the motion itself, in every length unit and sense."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from section_facts import HEAVY, JACK, facts, in_both_units

from grashof.analysis import dwell, output_stroke, solve_kinematics
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, load_linkage_spec
from grashof.survey import report_on

KEY = "mechanical-advantage"


@pytest.mark.slow
def test_the_table_is_the_ratio_of_the_rates(sections: Any) -> None:
    found = sections(JACK)[KEY]
    table, motion = found.tables[KEY], report_on(JACK).tables["kinematics"]
    np.testing.assert_allclose(table["velocity_ratio"], motion["omega4"] / motion["omega2"], atol=1e-14)
    np.testing.assert_allclose(table["p_way"], motion["p_speed"] / motion["omega2"], rtol=1e-12)
    given = facts(found)
    toggles = sorted(np.degrees(output_stroke(JACK.linkage).theta2))
    assert [given[f"toggle_{n}_theta2_deg"] for n in (1, 2)] == pytest.approx(toggles, abs=1e-8)
    assert given["velocity_ratio_largest"] >= table["velocity_ratio"].max()
    assert given["mechanical_advantage_least"] <= table["torque_ratio"].abs().min()


@pytest.mark.slow
def test_what_holds_it_is_newtons_in_every_unit_and_follows_the_sense_of_p(sections: Any) -> None:
    given = DynamicsSpec(300, payload=40, speed_rpm=-12, gravity=(0, -9.8))
    metres, inches = (sections(spec)[KEY].tables[KEY] for spec in in_both_units(JACK.linkage, given))
    for name in ("holding_torque", "holding_moment_on_4", "holding_force_at_p", "holding_force_y"):
        np.testing.assert_allclose(inches[name], metres[name], rtol=1e-9, atol=1e-6)
    other = sections(replace(JACK, dynamics=replace(given, speed_rpm=12)))[KEY].tables[KEY]
    np.testing.assert_allclose(other["holding_force_at_p"], -metres["holding_force_at_p"])
    np.testing.assert_allclose(other["holding_force_x"], metres["holding_force_x"])
    np.testing.assert_allclose(other["holding_torque"], metres["holding_torque"])


@pytest.mark.slow
def test_without_weight_there_is_nothing_to_hold(sections: Any) -> None:
    floating = replace(JACK, dynamics=DynamicsSpec(300))
    for spec in (load_linkage_spec("lufkin-c912d"), floating):
        assert "holding_torque" not in sections(spec)[KEY].tables[KEY]


@pytest.mark.quick("linkage1")
@pytest.mark.parametrize(
    "linkage",
    [
        FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)),
        FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1), assembly=-1),
        FourBar((0, 0), (3, 0), 2, 3, 2, (1, 1)),
    ],
)
def test_a_driver_that_swings(sections: Any, linkage: FourBar) -> None:
    found = sections(LinkageSpec(linkage, "swings", length_unit="m", dynamics=HEAVY))[KEY]
    table = found.tables[KEY]
    assert len(table) % 361 == 0
    assert np.isfinite(table["holding_force_at_p"]).mean() > 0.98
    assert all(np.isfinite(fact.value) for fact in found.facts)
    for plot in found.plots:
        assert all(np.isfinite(values).any() for values in plot.series.values())


@pytest.mark.parametrize("linkage", [JACK.linkage, FourBar((0, 0), (4, 0), 3, 1, 3)])
def test_the_dwell_keeps_to_its_band(sections: Any, linkage: FourBar) -> None:
    found = sections(LinkageSpec(linkage, "it"), dwell_deg=3.0, speed_rpm=10.0)["dwell"]
    given = facts(found)
    mark = "" if len([key for key in given if key.endswith("_from_deg")]) == 1 else "_1"
    start, end = given[f"dwell{mark}_from_deg"], given[f"dwell{mark}_to_deg"]
    state = solve_kinematics(linkage, np.radians(np.linspace(start, end, 400)[1:-1]))
    assert np.ptp(np.unwrap(state.theta4)) <= np.radians(3.0) * (1 + 1e-9)
    assert given[f"dwell{mark}_seconds"] == pytest.approx((end - start) / 60)
    if linkage is JACK.linkage:
        full = dwell(linkage, lambda each: each.theta4, np.radians(3.0), period=2 * np.pi)
        assert given["dwell_deg"] == pytest.approx(np.degrees(full.duration))
