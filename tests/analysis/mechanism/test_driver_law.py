"""The driver from rest to rest: rates as derivatives, time as the inverse of the angle."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.analysis import DriverLaw, driver_motion, solve_kinematics
from grashof.problems import FourBar
from grashof.problems.values.dynamics.motor import MotorSpec

PROFILES = {
    "constant": MotorSpec(),
    "trapezoid": MotorSpec("trapezoid", 0.2),
    "triangle": MotorSpec("trapezoid", 0.5),
    "cycloid": MotorSpec("cycloid"),
    "measured": MotorSpec(values=((1.0, 10), (2.0, 40), (2.5, 90), (4.0, 100))),
}


@pytest.mark.parametrize(("start", "rotation"), [(0.3, 2.0), (-1.0, -2 * np.pi)])
@pytest.mark.parametrize("kind", PROFILES)
def test_rates_are_derivatives_and_the_inverse_is_one(kind: str, start: float, rotation: float) -> None:
    law = DriverLaw(start, rotation, np.copysign(1.7, rotation), PROFILES[kind])
    time = np.linspace(0.013, 0.987, 60) * law.duration
    smooth = np.abs(law.corners * law.duration - time[:, None]).min(axis=1) > 1e-3
    h = 1e-5
    before, now, after = (law.at_time(time + step) for step in (-h, 0.0, h))
    np.testing.assert_allclose((after.theta2 - before.theta2) / (2 * h), now.omega2, rtol=1e-6, atol=1e-6)
    slope = (after.omega2 - before.omega2) / (2 * h)
    np.testing.assert_allclose(slope[smooth], now.alpha2[smooth], rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(law.time_at(now.theta2), time, rtol=1e-9, atol=1e-12)
    again = law.at_angle(now.theta2)
    np.testing.assert_allclose(again.omega2, now.omega2, rtol=1e-7)
    np.testing.assert_allclose(again.alpha2[smooth], now.alpha2[smooth], rtol=1e-6, atol=1e-9)
    ends = law.at_time([0.0, law.duration])
    np.testing.assert_allclose(ends.theta2, [start, start + rotation], atol=1e-12)
    if kind not in ("constant", "measured"):
        np.testing.assert_allclose(ends.omega2, 0, atol=1e-12)
    if kind != "measured":
        assert law.duration == pytest.approx(abs(rotation) / 1.7)
    assert law.holds(now.theta2).all()
    assert not law.holds([start - 0.1 * rotation, start + 1.1 * rotation]).any()


@given(st.floats(0.01, 0.5), st.floats(0, 1))
def test_a_trapezoid_is_the_integral_of_its_speed(ramp: float, share: float) -> None:
    law = DriverLaw(0.0, 1.0, 1.0, MotorSpec("trapezoid", ramp))
    grid = np.unique(np.concatenate([np.linspace(0, share, 2001), law.corners[law.corners <= share]]))
    added = np.trapezoid(law.at_time(grid).omega2, grid)  # straight pieces: exact
    assert float(law.at_time(share).theta2) == pytest.approx(added, abs=1e-12)


def test_each_turn_repeats_the_first() -> None:
    law = DriverLaw(0.0, 2 * np.pi, 1.0, PROFILES["cycloid"])
    once, twice = (law.at_angle(np.array([1.0, 5.0]) + turn) for turn in (0.0, 2 * np.pi))
    np.testing.assert_allclose(once.omega2, twice.omega2, rtol=1e-12)


def test_the_speed_of_a_linkage_that_starts_and_stops() -> None:
    linkage = FourBar((0, 0), (4, 0), 1, 4, 3, (1, 1))
    law = DriverLaw(0.0, 2 * np.pi, 2.0, PROFILES["cycloid"])
    theta2 = np.array([0.5, np.pi])
    state, steady = law.state(linkage, theta2), solve_kinematics(linkage, theta2)
    np.testing.assert_allclose(state.omega4, steady.omega4 * law.at_angle(theta2).omega2, rtol=1e-12)
    assert float(law.at_angle(np.pi).omega2) == pytest.approx(4.0)  # twice the mean halfway


def test_zero_speed_takes_forever() -> None:
    law = DriverLaw(0.0, 1.0, 0.0)
    assert np.isinf(law.duration)
    assert np.isnan(law.time_at(0.5))
    assert float(law.at_angle(0.5).omega2) == 0


def test_rates_are_those_of_the_function_in_time() -> None:
    time = np.linspace(0, 3, 4001)
    motion = driver_motion(lambda t: 2 * t + 0.3 * np.sin(4 * t), time)
    state = solve_kinematics(FourBar((0, 0), (4, 0), 1, 4, 3, (1, 1)), *motion)
    np.testing.assert_array_equal(state.omega2, motion.omega2)
    inner, step = slice(2, -2), time[1]
    for values, rates in (
        (np.unwrap(state.theta4), state.omega4),
        (state.omega4, state.alpha4),
        (state.alpha4, state.jerk4),
        (state.p.position[:, 0], state.p.velocity[:, 0]),
        (state.p.velocity[:, 1], state.p.acceleration[:, 1]),
        (state.p.acceleration[:, 0], state.p.jerk[:, 0]),
    ):
        slope = np.gradient(np.gradient(values, step), step), np.gradient(rates, step)
        np.testing.assert_allclose(slope[0][inner], slope[1][inner], atol=2e-4 * np.abs(slope[1]).max())
