"""Flywheels against the motion that they really make."""

import numpy as np
import pytest
from scipy.integrate import quad

from grashof.analysis import (
    Body,
    Loads,
    Masses,
    free_response,
    inverse_dynamics,
    size_flywheel,
    solve_kinematics,
    uniform_bars,
)
from grashof.problems import AssemblyError, FourBar, ProblemError

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


def test_bad_input_is_said() -> None:
    with pytest.raises(AssemblyError, match="turn fully"):
        size_flywheel(FourBar((0, 0), (4, 0), 2, 2, 3), BARS, 1.0, 0.1)
    for speed, share in ((0.0, 0.1), (1.0, 0.0), (1.0, float("nan"))):
        with pytest.raises(ProblemError, match="fluctuation"):
            size_flywheel(CRANK_ROCKER, BARS, speed, share)
