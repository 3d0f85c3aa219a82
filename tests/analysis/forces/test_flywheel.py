"""Flywheels against the motion that they really make."""

from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import quad

from grashof.analysis import (
    AppliedForce,
    Body,
    Kinematics,
    Loads,
    Masses,
    free_response,
    inverse_dynamics,
    output_stroke,
    size_flywheel,
    solve_kinematics,
    uniform_bars,
)
from grashof.problems import AssemblyError, FourBar, ProblemError
from grashof.problems.values.arrays import FloatArray

CRANK_ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
BARS = uniform_bars(CRANK_ROCKER, 2.0)
LOADS = Loads(gravity=(0, -9.81))


def test_with_the_flywheel_the_speed_keeps_within_the_share() -> None:
    wheel = size_flywheel(CRANK_ROCKER, BARS, 6.0, 0.02, LOADS)
    assert wheel.mean_torque == pytest.approx(0, abs=1e-9)
    heavy = Masses(BARS.crank + Body(1e-9, wheel.inertia, BARS.crank.centre), BARS.coupler, BARS.output)
    free = free_response(
        CRANK_ROCKER, heavy, np.linspace(0, 1.1, 400), wheel.slowest, 5.94, wheel.mean_torque, LOADS
    )
    speed = free.state.omega2
    assert np.ptp(speed) / 6.0 == pytest.approx(0.02, rel=0.1)
    fastest = free.state.theta2[np.argmax(speed)] % (2 * np.pi)
    assert fastest == pytest.approx(wheel.fastest % (2 * np.pi), abs=0.1)


def test_its_energy_is_the_work_between_slowest_and_fastest() -> None:
    wheel = size_flywheel(CRANK_ROCKER, BARS, 6.0, 0.02, LOADS)

    def surplus(theta2: float) -> float:
        state = solve_kinematics(CRANK_ROCKER, theta2, 6.0)
        return wheel.mean_torque - float(inverse_dynamics(state, BARS, LOADS).torque)

    work = quad(surplus, wheel.slowest, wheel.fastest, epsrel=1e-10)[0]
    assert work == pytest.approx(wheel.energy, rel=1e-7)
    assert wheel.inertia == pytest.approx(wheel.energy / (0.02 * 36), rel=1e-12)
    for angle in (wheel.slowest, wheel.fastest):
        assert surplus(angle) == pytest.approx(0, abs=1e-4 * wheel.energy)


@pytest.mark.slow
def test_energy_and_angles_near_a_change_point_with_a_load_that_jumps() -> None:
    """The load on link 4 is larger on its way up; the torque peaks within a thousandth of a radian."""
    linkage = FourBar((0, 0), (4, 0), 2, 4.5, 2.501, (2, 1))

    def pull(state: Kinematics) -> FloatArray:
        return np.stack([0 * state.omega4, np.where(state.omega4 > 0, -90.0, -30.0)], axis=-1)

    rod = AppliedForce(4, (2.5, 0.0), pull)
    bars, loads = uniform_bars(linkage, 0.1), Loads(gravity=(0, -9.81), forces=(rod,))
    toggles, speed = output_stroke(linkage).theta2.tolist(), -1.5
    closer = np.concatenate([sign * 4.0 ** -np.arange(1, 13) for sign in (-1, 1)])
    inside = np.concatenate([toggles, [np.pi], closer, np.pi + closer, 2 * np.pi + closer])
    wheel = size_flywheel(linkage, bars, speed, 0.05, loads)

    def torque(theta2: npt.ArrayLike) -> FloatArray:
        return inverse_dynamics(solve_kinematics(linkage, theta2, speed), bars, loads).torque

    def work(start: float, end: float) -> float:
        points = np.sort(inside[(inside > start) & (inside < end)])
        ends = pairwise([start, *points, end])
        return sum(quad(torque, low, high, epsabs=1e-9, limit=200)[0] for low, high in ends)

    mean = work(0.0, 2 * np.pi) / (2 * np.pi)
    assert wheel.mean_torque == pytest.approx(mean, rel=1e-9)
    start, end = sorted((wheel.slowest, wheel.fastest))
    gained = abs(mean * (end - start) - work(start, end))
    assert wheel.energy == pytest.approx(gained, rel=1e-9)
    near = np.logspace(-7, -1, 5000)
    theta2 = np.unique(np.concatenate([np.linspace(0, 2 * np.pi, 20_001), near, 2 * np.pi - near]))
    values = mean - torque(theta2)
    energy = np.concatenate([[0.0], np.cumsum((values[1:] + values[:-1]) / 2 * np.diff(theta2))])
    assert np.ptp(energy) == pytest.approx(wheel.energy, rel=1e-4)


def test_an_even_torque_needs_no_flywheel() -> None:
    wheel = size_flywheel(CRANK_ROCKER, BARS, 1e-9, 0.02)
    assert wheel.energy == pytest.approx(0, abs=1e-15)


def test_bad_input_is_reported() -> None:
    with pytest.raises(AssemblyError, match="turn fully"):
        size_flywheel(FourBar((0, 0), (4, 0), 2, 2, 3), BARS, 1.0, 0.1)
    for speed, share in ((0.0, 0.1), (1.0, 0.0), (1.0, float("nan"))):
        with pytest.raises(ProblemError, match="fluctuation"):
            size_flywheel(CRANK_ROCKER, BARS, speed, share)
