"""Pin forces, hodographs, centrodes, energies and dwell: their figures against the motion itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from section_facts import facts, in_both_units

from grashof.analysis import dwell, mechanical_energy, solve_kinematics
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, ProblemError, load_linkage_spec
from grashof.problems.values.dynamics.load_specs import DamperSpec, FrictionSpec, LoadSpec, Place, SpringSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.study.study import LinkageStudy
from grashof.survey import Asked, Section, report_on

Sections = Callable[..., dict[str, Section]]
LOADED = DynamicsSpec(
    300.0,
    speed_rpm=-10,
    gravity=(0, -9.81),
    loads=(LoadSpec(4, at=(-4, 0), values=((0, 0, -9e3), (90, 0, -2e4), (200, 0, -1e4), (360, 0, -9e3))),),
    springs=(SpringSpec((Place(1, (0, 2)), Place(4, (1, 0))), 500.0, 1.2),),
    dampers=(DamperSpec((Place(1, (0, 2)), Place(4, (1, 0))), 30.0),),
    friction=FrictionSpec(coulomb=0.1, pin_radius=0.05, viscous=2.0),
    motor=MotorSpec(profile="trapezoid"),
)
JACK = load_linkage_spec("pumpjack")


@pytest.mark.slow
def test_pin_forces_turned_back_are_those_of_the_table(sections: Sections) -> None:
    found, dynamics = sections(JACK)["pin-forces"], report_on(JACK).tables["dynamics"]
    table, motion = found.tables["pin-forces"], report_on(JACK).tables["kinematics"]
    for joint, link, force, sign in (
        ("o2", 2, "f12", 1), ("a", 2, "f32", 1), ("a", 3, "f32", -1), ("b", 3, "f43", 1), ("b", 4, "f43", -1),
        ("o4", 4, "f14", 1),
    ):  # fmt: skip
        turn = np.exp(1j * np.radians(motion["theta2_deg" if link == 2 else f"theta{link}_deg"]))
        there = (table[f"{joint}_on_{link}_u"] + 1j * table[f"{joint}_on_{link}_v"]) * turn
        expected = sign * (dynamics[f"{force}_x"] + 1j * dynamics[f"{force}_y"])
        np.testing.assert_allclose(there, expected, rtol=1e-9, atol=1e-6)
    track = found.plots[0].series["A"]
    np.testing.assert_allclose(track[:, 0], -dynamics["f32_x"], rtol=1e-12)


def test_the_jerk_is_the_rate_of_the_acceleration(sections: Sections) -> None:
    table, linkage = sections(JACK)["hodographs"].tables["jerk"], JACK.linkage
    omega, step = 20 * np.pi / 30, 1e-4
    theta2 = np.radians(table["theta2_deg"])
    ahead, behind = (solve_kinematics(linkage, theta2 + s, omega) for s in (step, -step))
    rate = (ahead.p.acceleration - behind.p.acceleration) * omega / (2 * step)
    np.testing.assert_allclose(table[["p_jerk_x", "p_jerk_y"]], rate, atol=1e-5)
    np.testing.assert_allclose(table["jerk4"], (ahead.alpha4 - behind.alpha4) * omega / (2 * step), atol=1e-5)


def test_circles_at_the_angles_asked_for(sections: Sections) -> None:
    found = sections(JACK, at_deg=(45.0, 90.0))["coupler-plane"]
    table = found.tables["coupler-circles"]
    assert table["theta2_deg"].tolist() == [45, 90]
    circle = next(plot for plot in found.plots if plot.key == "inflection-circle")
    for angle, row in zip((45, 90), table.to_dict("records"), strict=True):
        arc = circle.series[f"inflection circle, {angle}°"]
        arc = arc[np.isfinite(arc[:, 0])]
        radius = np.hypot(*(arc - [row["inflection_x"], row["inflection_y"]]).T)
        np.testing.assert_allclose(radius, row["inflection_diameter"] / 2, rtol=1e-9)
    rocker = LinkageSpec(FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1)), "rocker")
    with pytest.raises(ProblemError, match="at_deg is 180; the driver moves from"):
        dict(sections(rocker, at_deg=(0.5, 180.0)))


@pytest.mark.slow
def test_the_energy_table_adds_up(sections: Sections) -> None:
    table = sections(JACK)["energies"].tables["energies"]
    np.testing.assert_allclose(table["energy"], table["kinetic"] + table["weights"] + table["springs"])
    spread = np.fft.fft(table["energy"].to_numpy()[:-1])
    number = np.fft.fftfreq(360, 1 / 360)
    rate = np.fft.ifft(1j * number * spread).real * 20 * np.pi / 30
    np.testing.assert_allclose(table["drive_power"].to_numpy()[:-1], rate, atol=1e-6)
    heavy = DynamicsSpec(300.0, speed_rpm=20, gravity=(0, -9.8))
    metres, inches = (
        sections(spec)["energies"].tables["energies"] for spec in in_both_units(JACK.linkage, heavy)
    )
    np.testing.assert_allclose(inches["energy"], metres["energy"], rtol=1e-9)
    np.testing.assert_allclose(inches["drive_power"], metres["drive_power"], rtol=1e-9, atol=1e-6)


@pytest.mark.slow
def test_the_powers_of_loads_springs_and_friction_are_the_rate_of_the_energy(sections: Sections) -> None:
    spec = replace(JACK, dynamics=LOADED)
    table = sections(spec)["energies"].tables["energies"].iloc[5:-5]
    study = LinkageStudy.of(spec, Asked())
    time, step = study.sweep.time(np.radians(table["theta2_deg"].to_numpy())), 1e-3
    law = study.sweep.laws[0]
    total = [
        mechanical_energy(
            solve_kinematics(spec.linkage, *law.at_time(time + k * step)), study.masses, study.loads
        )
        for k in (-2, -1, 1, 2)
    ]
    rate = (total[0] - 8 * total[1] + 8 * total[2] - total[3]) / (12 * step)
    given = table["drive_power"] + table["load_power"] + table["friction_power"]
    corner = np.min(np.abs(time[:, None] - law.duration * law.corners), axis=1) < 3 * step
    np.testing.assert_allclose(given[~corner], rate[~corner], atol=1e-6 * np.abs(rate).max())
    assert (table["friction_power"] < 0).all()


@pytest.mark.parametrize("linkage", [JACK.linkage, FourBar((0, 0), (4, 0), 3, 1, 3)])
def test_the_dwell_keeps_to_its_band(sections: Sections, linkage: FourBar) -> None:
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


def test_a_band_that_is_none_is_refused(sections: Sections) -> None:
    for band in (0.0, -1.0, 400.0, np.nan):
        with pytest.raises(ProblemError, match="dwell_deg is"):
            dict(sections(JACK, dwell_deg=band))


def test_what_is_constant_is_largest_nowhere(sections: Sections) -> None:
    """P is A: its jerk has one size all around."""
    assert [*facts(sections(load_linkage_spec("lufkin-c912d"))["hodographs"])] == ["p_jerk_largest"]
