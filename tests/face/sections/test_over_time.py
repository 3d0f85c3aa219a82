"""Histories over time: the report's fifteen seconds, drivers that turn back, stop or swing."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from section_facts import JACK, ONE_RANGE, TWO_RANGES, facts

from grashof.analysis import Loads, inverse_dynamics, solve_kinematics, stated_masses, system_centre
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec
from grashof.problems.values.dynamics.load_specs import LoadSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.sections.over_time import sawtooth

PARALLELOGRAM = LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 1, (1, 1)), "parallelogram")


def test_the_fifteen_seconds_of_the_pumpjack(sections: Any) -> None:
    found = sections("pumpjack", seconds=15, start_deg=90)
    table = found["over-time"].tables["over-time"]
    assert table["time_s"].tolist() == pytest.approx([0.05 * k for k in range(301)], abs=1e-12)
    assert table["theta2_total_deg"].tolist() == pytest.approx([90 + 6 * k for k in range(301)], abs=1e-9)
    assert (table["theta2_total_deg"] % 360).tolist() == pytest.approx(table["theta2_deg"].tolist(), abs=1e-9)
    assert facts(found["over-time"]) == {"history_seconds": 15.0, "history_turns": 5.0}
    # Every value again from the library, and the largest those of the audit at these samples.
    assert JACK.dynamics is not None
    masses = stated_masses(JACK.linkage, JACK.dynamics)
    state = solve_kinematics(JACK.linkage, np.radians(table["theta2_total_deg"]), 2 * np.pi / 3)
    dynamics = inverse_dynamics(state, masses, Loads(gravity=JACK.dynamics.gravity))
    for key, expected in {
        "omega3": state.omega3, "alpha4": state.alpha4, "a_speed": state.a.speed,
        "p_x": state.p.position[:, 0], "b_acceleration": state.b.acceleration_magnitude,
        "torque": dynamics.torque, "power": dynamics.power, "theta3_deg": np.degrees(state.theta3),
    }.items():  # fmt: skip
        np.testing.assert_allclose(table[key], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
    for key, low, high in (
        ("omega3", -0.7125207844, 0.7247923544),
        ("omega4", -0.8627858579, 0.872934727),
        ("alpha3", -2.0133401425, 1.3226607009),
        ("b_speed", 0.0278650123, 2.6613702242),
        ("b_acceleration", 2.2697837716, 7.360698689),
    ):
        assert [table[key].min(), table[key].max()] == pytest.approx([low, high], abs=2e-10)
    centres = found["mass-centres"].tables["mass-centres-over-time"]
    np.testing.assert_allclose(
        centres[["g_x", "g_y"]], system_centre(masses, state).position, rtol=0, atol=1e-12
    )
    np.testing.assert_allclose(centres["g3_speed"], state.point(3, masses.of(3).centre).speed, atol=1e-12)
    plots = {plot.key: plot for section in found.values() for plot in section.plots}
    assert plots["p-place-over-time"].over == "time (s)"
    assert len(plots["p-place-over-time"].series["x"]) == 301
    drawn = plots["theta2-over-time"].series["theta2"]
    assert np.isnan(drawn).sum() == 5
    assert np.nanmin(drawn) == 0
    assert np.nanmax(drawn) == 360


@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_a_driver_that_swings_goes_through_its_range_and_stops(sections: Any, speed: float) -> None:
    section = sections(ONE_RANGE, seconds=15, step=0.01, speed_rpm=speed)["over-time"]
    table = section.tables["over-time"]
    limit = float(np.degrees(np.arccos((16 + 4 - 25) / 16)))
    ends = table["theta2_total_deg"].iloc[[0, -1]].to_numpy() * np.sign(speed)
    assert ends[0] == pytest.approx(-limit)
    assert limit - 1.2 < ends[1] < limit
    assert np.isnan(table["omega3"].iloc[0])  # at a dead position
    assert np.isfinite(table["omega3"].iloc[1:]).all()
    assert "before the dead position" in section.notes[0]
    assert "from -108.21 to 108.21 deg" in section.notes[0]


def test_a_start_lies_in_the_range_that_it_names(sections: Any) -> None:
    table = sections(TWO_RANGES, seconds=3, start_deg=-50 + 720)["over-time"].tables["over-time"]
    assert table["theta2_deg"].iloc[0] == pytest.approx(310)
    assert table["theta2_total_deg"].iloc[-1] < -28.9


@pytest.mark.parametrize(("speed", "first", "last"), [(1.0, 0.0, 180.0), (-1.0, 0.0, -180.0)])
def test_from_a_change_point_it_goes_ahead(sections: Any, speed: float, first: float, last: float) -> None:
    """Two ranges meet there: the history runs through the one that the driver enters."""
    rpm = speed * 30 / np.pi
    table = sections(PARALLELOGRAM, seconds=9, step=0.1, start_deg=first, speed_rpm=rpm)["over-time"].tables
    travelled = table["over-time"]["theta2_total_deg"].to_numpy()
    assert travelled[0] == pytest.approx(first)
    assert 0 <= abs(last - travelled[-1]) < 6


def test_a_driver_at_rest_stays(sections: Any) -> None:
    still = DynamicsSpec(mass_per_length=2.0, gravity=(0, -9.81), speed_rpm=0.0)
    spec = replace(JACK, dynamics=still)
    table = sections(spec, seconds=1, start_deg=30)["over-time"].tables["over-time"]
    assert table["theta2_total_deg"].unique() == pytest.approx([30])
    assert table["torque"].abs().min() > 0


CYCLOID = DynamicsSpec(mass_per_length=2.0, speed_rpm=20, motor=MotorSpec(profile="cycloid"))


@pytest.mark.slow
@pytest.mark.quick("-20.0")
@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_a_driver_that_stops_after_each_turn_goes_on_from_its_start(sections: Any, speed: float) -> None:
    """A cycloid of 3 s: theta2 = 2 pi (u - sin(2 pi u) / (2 pi)), u the share of the time."""
    spec = replace(JACK, dynamics=CYCLOID)
    found = sections(spec, seconds=9, step=0.01, start_deg=180, speed_rpm=speed, sections=("differences",))
    table = found["over-time"].tables["over-time"]
    share = 0.5 + table["time_s"].to_numpy() / 3
    expected = 360 * (share - np.sin(2 * np.pi * share) / (2 * np.pi)) * np.sign(speed)
    travelled = table["theta2_total_deg"].to_numpy()
    np.testing.assert_allclose(travelled - travelled[0], expected - expected[0], rtol=0, atol=1e-9)
    assert table["omega2"].abs().max() == pytest.approx(2 * 2 * np.pi / 3, rel=1e-4)
    # Its accelerations are those of its own motion: differences over time agree.
    shares = found["differences"].tables["differences-deviations"].set_index(["derivative", "order"])["share"]
    assert shares.loc[2, 4].max() < 1e-4
    over_angle = sections(spec, sections=("differences",), speed_rpm=speed)["differences"].tables
    assert over_angle["differences-deviations"].set_index("order").loc[4, "share"].max() < 0.02


def test_a_swinging_driver_that_starts_and_stops_ends_where_it_stops(sections: Any) -> None:
    section = sections(replace(ONE_RANGE, dynamics=CYCLOID), seconds=9, step=0.01)["over-time"]
    table = section.tables["over-time"]
    limit = 108.2099568
    assert table["theta2_total_deg"].iloc[[0, -1]].tolist() == pytest.approx([-limit, limit], abs=1e-3)
    assert table["time_s"].iloc[-1] == pytest.approx(2 * limit / 120, abs=0.01)
    assert "the history ends after" in section.notes[0]


def test_each_range_is_swept_by_a_law_of_its_own(sections: Any) -> None:
    """A cycloid is twice as fast as its mean, 120 deg/s, in the middle of a range."""
    study = sections(replace(TWO_RANGES, length_unit="m", dynamics=CYCLOID)).study
    for low, high in study.sweep.ranges:
        theta2 = np.array([low, (low + high) / 2, high])
        np.testing.assert_allclose(study.sweep.state(theta2[1:2]).omega2, 2 * 2 * np.pi / 3)
        duration = np.degrees(high - low) / 120
        np.testing.assert_allclose(study.sweep.time(theta2), [0, duration / 2, duration], atol=1e-6)


@pytest.mark.slow
def test_loads_over_time_begin_anew_with_each_turn(sections: Any) -> None:
    push = LoadSpec(link=4, at=(1.0, 0.0), over="time", values=((0, 100, 0), (1.5, 900, 0), (3, 100, 0)))
    given = DynamicsSpec(mass_per_length=2.0, speed_rpm=20, loads=(push,))
    spec = replace(JACK, dynamics=given)
    table = sections(spec, seconds=9, step=0.1)["over-time"].tables["over-time"]
    torque = table["torque"].to_numpy()
    assert np.isfinite(torque).all()
    np.testing.assert_allclose(torque[30:60], torque[:30], rtol=1e-9, atol=1e-6)
    shifted = sections(spec, seconds=3, step=0.1, start_deg=90)["over-time"].tables["over-time"]["torque"]
    at_90 = sections(spec, at_deg=(90, 450))["positions"].tables["positions"]["torque"]
    assert at_90.tolist() == pytest.approx([shifted.iloc[0]] * 2)


def test_a_sawtooth_that_falls_and_one_that_is_too_coarse() -> None:
    time = np.array([0.0, 1.0, 2.0, 3.0])
    places, angle = sawtooth(time, np.array([30.0, -30.0, -90.0, -1000.0]))
    assert places.tolist()[:5] == [0, 0.5, 0.5, 0.5, 1]
    np.testing.assert_array_equal(angle[:6], [30, 0, np.nan, 360, 330, 270])
    assert np.isnan(angle[6:9]).all()
    assert angle[-1] == 80
