"""The speed with a flywheel: its fluctuation, and the motion that the wheel really makes."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from grashof.analysis import (
    Body,
    Loads,
    Masses,
    Spring,
    flywheel_speed,
    free_response,
    inverse_dynamics,
    motor_torque,
    size_flywheel,
    solve_kinematics,
    uniform_bars,
)
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank

TURN = 2 * np.pi
JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
LINKAGES = [JACK, SliderCrank((0, 0), 1, 3, 0.3, 0.4), InvertedSliderCrank((0, 0), (3, 0), 1.2, 0.3)]
BARS = uniform_bars(JACK, (312, 312, 314))
LOADS = Loads(gravity=(0, -9.81), springs=(Spring(1, (0, 6), 4, (2, 0), 9e3, 1.0),))


@pytest.mark.parametrize(
    ("linkage", "omega2", "fluctuation"),
    [(LINKAGES[0], TURN / 3, 0.05), (LINKAGES[1], -TURN / 3, 0.3), (LINKAGES[2], TURN / 3, 0.3)],
)
def test_the_speed_varies_by_the_fluctuation_about_its_mean(
    linkage: Linkage, omega2: float, fluctuation: float
) -> None:
    bars = uniform_bars(linkage, 312.0)
    wheel = size_flywheel(linkage, bars, omega2, fluctuation, LOADS)
    theta2 = np.linspace(0, TURN, 1001)
    speed = flywheel_speed(linkage, bars, omega2, wheel, theta2, LOADS)
    assert np.ptp(speed) == pytest.approx(fluctuation * abs(omega2), rel=1e-5)
    assert (speed.max() + speed.min()) / 2 == pytest.approx(omega2, rel=1e-5)
    assert speed[0] == pytest.approx(speed[-1], rel=1e-9)
    fastest = theta2[np.abs(speed).argmax()]
    assert np.abs(np.exp(1j * fastest) - np.exp(1j * wheel.fastest)) < 0.01


@pytest.mark.parametrize("linkage", LINKAGES)
def test_energy_of_the_wheel_is_the_integral_of_the_torque(linkage: Linkage) -> None:
    bars = uniform_bars(linkage, 312.0)
    wheel = size_flywheel(linkage, bars, 2.0, 0.1, LOADS)
    theta2 = np.linspace(0, TURN, 721)
    speed = flywheel_speed(linkage, bars, 2.0, wheel, theta2, LOADS)
    torque = inverse_dynamics(solve_kinematics(linkage, theta2, 2.0), bars, LOADS).torque
    gained = CubicSpline(theta2, wheel.mean_torque - torque).antiderivative()(theta2)
    energy = wheel.inertia * speed**2 / 2
    np.testing.assert_allclose(energy - energy[0], gained, atol=1e-6 * np.ptp(gained))


def test_a_heavy_wheel_really_turns_so() -> None:
    """Driven by the mean torque, with the wheel on the crank."""
    omega2, fluctuation = TURN / 3, 0.002
    wheel = size_flywheel(JACK, BARS, omega2, fluctuation, LOADS)
    crank = BARS.crank + Body(0.0, wheel.inertia)
    with_wheel = Masses(crank, BARS.coupler, BARS.output)
    start = float(flywheel_speed(JACK, BARS, omega2, wheel, np.array([0.0]), LOADS)[0])
    free = free_response(
        JACK, with_wheel, np.linspace(0, 3, 301), 0.0, start, torque=wheel.mean_torque, loads=LOADS
    )
    theta2 = np.minimum(free.state.theta2, TURN)
    expected = flywheel_speed(JACK, BARS, omega2, wheel, theta2, LOADS)
    turn = free.state.theta2 <= TURN
    assert turn.sum() > 290
    off = np.abs(free.state.omega2 - expected)[turn]
    assert off.max() < 0.02 * fluctuation * omega2


@pytest.mark.parametrize("omega2", [2.0, -2.0])
def test_power_into_the_gear_comes_out_but_for_its_losses(omega2: float) -> None:
    state = solve_kinematics(JACK, np.linspace(0, 6.28, 200), omega2)
    torque = inverse_dynamics(state, uniform_bars(JACK, 300.0), Loads(gravity=(0, -9.81))).torque
    motor = motor_torque(torque, omega2, 0.0, 25.0, 0.8) * 25 * omega2
    load = torque * omega2
    drives = load > 0
    assert drives.any()
    assert (~drives).any()
    np.testing.assert_allclose(load[drives], 0.8 * motor[drives])
    np.testing.assert_allclose(motor[~drives], 0.8 * load[~drives])
    assert (motor >= load - 1e-9 * np.abs(load).max()).all()


def test_the_rotor_takes_its_share() -> None:
    """Its kinetic energy changes by the power that is left of the motor's."""
    ratio, inertia, alpha2 = 30.0, 0.05, 4.0
    time = np.linspace(0, 1, 101)
    omega2 = 1 + alpha2 * time
    torque = 50 + 10 * np.sin(7 * time)
    motor = motor_torque(torque, omega2, alpha2, ratio, 1.0, inertia)
    rate = np.gradient(inertia * (ratio * omega2) ** 2 / 2, time, edge_order=2)
    np.testing.assert_allclose(motor * ratio * omega2 - torque * omega2, rate, rtol=1e-9)


def test_without_gear_or_rotor_it_is_the_drive() -> None:
    torque = np.array([3.0, -4.0, 0.0])
    np.testing.assert_array_equal(motor_torque(torque, 1.0, 9.0, 1.0), torque)
