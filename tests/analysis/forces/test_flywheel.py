"""Flywheels and gears: energies by integrals of the torque, and the motion that a wheel really makes."""

from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest
from loaded_linkages import JACK, ROCKER, TURN, WEIGHT
from scipy.integrate import quad

from grashof import analysis
from grashof.analysis import flywheel_speed, inverse_dynamics, size_flywheel, solve_kinematics, uniform_bars
from grashof.problems import AssemblyError, FourBar, InvertedSliderCrank, Linkage, ProblemError, SliderCrank
from grashof.problems.values.arrays import FloatArray

CRANK_ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
BARS = uniform_bars(CRANK_ROCKER, 2.0)


def test_its_energy_is_the_work_between_slowest_and_fastest() -> None:
    wheel = size_flywheel(CRANK_ROCKER, BARS, 6.0, 0.02, WEIGHT)

    def surplus(theta2: float) -> float:
        state = solve_kinematics(CRANK_ROCKER, theta2, 6.0)
        return wheel.mean_torque - float(inverse_dynamics(state, BARS, WEIGHT).torque)

    work = quad(surplus, wheel.slowest, wheel.fastest, epsrel=1e-10)[0]
    assert work == pytest.approx(wheel.energy, rel=1e-7)
    assert wheel.inertia == pytest.approx(wheel.energy / (0.02 * 36), rel=1e-12)
    for angle in (wheel.slowest, wheel.fastest):
        assert surplus(angle) == pytest.approx(0, abs=1e-4 * wheel.energy)


@pytest.mark.slow
def test_energy_and_angles_near_a_change_point_with_a_load_that_jumps() -> None:
    """The load on link 4 is larger on its way up; the torque peaks within a thousandth of a radian."""
    linkage = FourBar((0, 0), (4, 0), 2, 4.5, 2.501, (2, 1))

    def pull(state: analysis.Kinematics) -> FloatArray:
        return np.stack([0 * state.omega4, np.where(state.omega4 > 0, -90.0, -30.0)], axis=-1)

    rod = analysis.AppliedForce(4, (2.5, 0.0), pull)
    bars, loads = uniform_bars(linkage, 0.1), analysis.Loads(gravity=(0, -9.81), forces=(rod,))
    toggles, speed = analysis.output_stroke(linkage).theta2.tolist(), -1.5
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


def test_bad_input_is_reported() -> None:
    with pytest.raises(AssemblyError, match="turn fully"):
        size_flywheel(ROCKER, BARS, 1.0, 0.1)
    for speed, share in ((0.0, 0.1), (1.0, 0.0), (1.0, float("nan"))):
        with pytest.raises(ProblemError, match="fluctuation"):
            size_flywheel(CRANK_ROCKER, BARS, speed, share)


LINKAGES = [JACK, SliderCrank((0, 0), 1, 3, 0.3, 0.4), InvertedSliderCrank((0, 0), (3, 0), 1.2, 0.3)]
JACK_BARS = uniform_bars(JACK, (312, 312, 314))
SPRUNG = analysis.Loads(gravity=(0, -9.81), springs=(analysis.Spring(1, (0, 6), 4, (2, 0), 9e3, 1.0),))


@pytest.mark.parametrize(
    ("linkage", "omega2", "fluctuation"),
    [(LINKAGES[0], TURN / 3, 0.05), (LINKAGES[1], -TURN / 3, 0.3), (LINKAGES[2], TURN / 3, 0.3)],
)
def test_the_speed_varies_by_the_fluctuation_about_its_mean(
    linkage: Linkage, omega2: float, fluctuation: float
) -> None:
    bars = uniform_bars(linkage, 312.0)
    wheel = size_flywheel(linkage, bars, omega2, fluctuation, SPRUNG)
    theta2 = np.linspace(0, TURN, 1001)
    speed = flywheel_speed(linkage, bars, omega2, wheel, theta2, SPRUNG)
    assert np.ptp(speed) == pytest.approx(fluctuation * abs(omega2), rel=1e-5)
    assert (speed.max() + speed.min()) / 2 == pytest.approx(omega2, rel=1e-5)
    assert speed[0] == pytest.approx(speed[-1], rel=1e-9)
    fastest = theta2[np.abs(speed).argmax()]
    assert np.abs(np.exp(1j * fastest) - np.exp(1j * wheel.fastest)) < 0.01


def test_a_heavy_wheel_really_turns_so() -> None:
    """Driven by the mean torque, with the wheel on the crank."""
    omega2, fluctuation = TURN / 3, 0.002
    wheel = size_flywheel(JACK, JACK_BARS, omega2, fluctuation, SPRUNG)
    crank = JACK_BARS.crank + analysis.Body(0.0, wheel.inertia)
    with_wheel = analysis.Masses(crank, JACK_BARS.coupler, JACK_BARS.output)
    start = float(flywheel_speed(JACK, JACK_BARS, omega2, wheel, np.array([0.0]), SPRUNG)[0])
    free = analysis.free_response(
        JACK, with_wheel, np.linspace(0, 3, 301), 0.0, start, torque=wheel.mean_torque, loads=SPRUNG
    )
    theta2 = np.minimum(free.state.theta2, TURN)
    expected = flywheel_speed(JACK, JACK_BARS, omega2, wheel, theta2, SPRUNG)
    turn = free.state.theta2 <= TURN
    assert turn.sum() > 290
    off = np.abs(free.state.omega2 - expected)[turn]
    assert off.max() < 0.02 * fluctuation * omega2


@pytest.mark.parametrize("omega2", [2.0, -2.0])
def test_power_into_the_gear_comes_out_but_for_its_losses(omega2: float) -> None:
    state = solve_kinematics(JACK, np.linspace(0, 6.28, 200), omega2)
    torque = inverse_dynamics(state, uniform_bars(JACK, 300.0), WEIGHT).torque
    motor = analysis.motor_torque(torque, omega2, 0.0, 25.0, 0.8) * 25 * omega2
    load = torque * omega2
    drives = load > 0
    assert drives.any()
    assert (~drives).any()
    np.testing.assert_allclose(load[drives], 0.8 * motor[drives])
    np.testing.assert_allclose(motor[~drives], 0.8 * load[~drives])
    assert (motor >= load - 1e-9 * np.abs(load).max()).all()
