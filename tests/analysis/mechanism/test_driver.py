"""Driver motions: what solve_kinematics does with a function of time."""

import numpy as np
from scipy.interpolate import CubicSpline

from grashof.analysis import driver_motion, solve_kinematics
from grashof.problems import FourBar

LINKAGE = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(1, 1))


def test_rates_are_those_of_the_function_in_time() -> None:
    time = np.linspace(0, 3, 4001)
    motion = driver_motion(lambda t: 2 * t + 0.3 * np.sin(4 * t), time)
    state = solve_kinematics(LINKAGE, *motion)
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


def test_splines_drive_too() -> None:
    knots = np.linspace(0, 2, 21)
    spline = CubicSpline(knots, knots**2)
    motion = driver_motion(spline, 0.5)
    np.testing.assert_allclose(motion, [0.25, 1, 2, 0], atol=1e-9)
