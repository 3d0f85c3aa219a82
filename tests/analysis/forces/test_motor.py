"""The motor behind its gear: power balances, whichever side drives."""

import numpy as np
import pytest

from grashof.analysis import Loads, inverse_dynamics, motor_torque, solve_kinematics, uniform_bars
from grashof.problems import FourBar

JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)


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
