"""Statics: the ratios of speeds, and what holds a linkage, against inverse dynamics and forces put on."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    Body,
    Friction,
    GrashofClass,
    Joint,
    Loads,
    Masses,
    Spring,
    TorsionSpring,
    advantage,
    driver_ranges,
    holding,
    inverse_dynamics,
    output_stroke,
    solve_kinematics,
)
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar

CHECKED = settings(max_examples=25)
TURN = 2 * np.pi
JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762, coupler_point=(1.7, 0.7))
ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3, coupler_point=(1, 1), assembly=-1)
MASSES = Masses(Body(2, 0.3, (0.4, 0.1)), Body(3, 0.5, (1.0, -0.3)), Body(1.5, 0.2, (0.7, 0.2)))
LOADS = Loads(
    gravity=(1.0, -9.81),
    forces=(AppliedForce(3, (0.3, 0.4), (5.0, -7.0)), AppliedForce(4, (1, 0), (0.0, 8.0), turning=True)),
    moments=(AppliedMoment(2, 3.0), AppliedMoment(4, lambda state: np.sin(state.theta2))),
    springs=(Spring(1, (2, 0), 4, (1, 0.2), 20, 1.0, damping=4.0), Spring(2, (0.5, 0), 4, (1, 0), 10, 0.5)),
    torsion_springs=(TorsionSpring(Joint.B, 5.0, 1.0), TorsionSpring(Joint.A, 2.0, -1.0)),
)
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]


def angles_of(linkage: FourBar) -> np.ndarray:
    """Driver angles that are no dead positions."""
    low, high = driver_ranges(linkage)[0]
    return low + (high - low) * np.linspace(0.013, 0.981, 24)


@given(data=st.data())
@CHECKED
def test_ratios_are_those_of_the_velocities(four_bars: Drawer, data: st.DataObject) -> None:
    linkage = data.draw(four_bars(data.draw(st.sampled_from(sorted(FOUR_BAR_CLASSES)))))
    theta2 = angles_of(linkage)
    state = solve_kinematics(linkage, theta2, -3.0)
    known = np.abs(np.sin(state.theta4 - state.theta3)) > 1e-6
    found = advantage(linkage, theta2)
    np.testing.assert_allclose(found.velocity_ratio[known], state.omega4[known] / -3.0, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(found.way[known], state.p.speed[known] / 3.0, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(found.force_ratio, linkage.r2 / found.way, rtol=1e-9)
    np.testing.assert_allclose(found.torque_ratio * found.velocity_ratio, 1.0, rtol=1e-9)


def test_the_advantage_has_no_limit_at_toggles_and_is_zero_in_dead_positions() -> None:
    toggles = advantage(JACK, output_stroke(JACK).theta2)
    np.testing.assert_allclose(toggles.velocity_ratio, 0, atol=1e-14)
    assert np.abs(toggles.torque_ratio).min() > 1e13
    dead = advantage(ROCKER, driver_ranges(ROCKER)[0])
    np.testing.assert_allclose(dead.torque_ratio, 0, atol=1e-7)
    np.testing.assert_allclose(dead.force_ratio, 0, atol=1e-7)


def test_the_force_ratio_of_a_point_on_the_output_is_the_torque_ratio_over_its_arm() -> None:
    at_b = replace(JACK, coupler_point=(JACK.r3, 0.0))
    found = advantage(at_b, angles_of(JACK))
    expected = np.abs(found.torque_ratio) * JACK.r2 / JACK.r4
    np.testing.assert_allclose(found.force_ratio, expected, rtol=1e-12)
    at_a = advantage(replace(JACK, coupler_point=(0.0, 0.0)), angles_of(JACK))
    np.testing.assert_allclose(at_a.force_ratio, 1.0, rtol=1e-12)


@pytest.mark.parametrize("linkage", [JACK, ROCKER, replace(JACK, assembly=-1)])
def test_what_holds_a_linkage_leaves_nothing_for_the_drive(linkage: FourBar) -> None:
    theta2 = angles_of(linkage)
    rest = solve_kinematics(linkage, theta2, 0.0)
    held = holding(linkage, theta2, MASSES, LOADS)
    alone = inverse_dynamics(rest, MASSES, LOADS).torque
    scale = np.abs(alone).max()
    np.testing.assert_allclose(held.torque, alone, rtol=1e-9, atol=1e-12 * scale)
    moment = replace(LOADS, moments=(*LOADS.moments, AppliedMoment(4, held.moment)))
    assert np.abs(inverse_dynamics(rest, MASSES, moment).torque).max() < 1e-11 * scale
    at_p = AppliedForce(3, tuple(linkage.coupler_point), held.force[:, None] * held.direction)
    force = replace(LOADS, forces=(*LOADS.forces, at_p))
    assert np.abs(inverse_dynamics(rest, MASSES, force).torque).max() < 1e-11 * scale


def test_a_force_at_p_holds_a_linkage_in_a_dead_position_where_no_torque_does() -> None:
    ends = driver_ranges(ROCKER)[0]
    held = holding(ROCKER, ends, MASSES, LOADS)
    assert np.abs(held.torque).min() > 1e6
    inside = holding(ROCKER, ends + np.array([1e-10, -1e-10]), MASSES, LOADS)
    np.testing.assert_allclose(held.force, inside.force, rtol=1e-4)
    np.testing.assert_allclose(held.moment, inside.moment, rtol=1e-4)


def test_friction_is_left_out_and_nothing_is_held_by_nothing() -> None:
    rubbing = replace(LOADS, friction=Friction(1.0, 2.0, 0.1))
    theta2 = angles_of(JACK)
    smooth, rough = (holding(JACK, theta2, MASSES, loads).torque for loads in (LOADS, rubbing))
    np.testing.assert_array_equal(smooth, rough)
    np.testing.assert_array_equal(holding(JACK, theta2, MASSES, Loads()).force, 0)


def test_batches_and_angles_that_cannot_be() -> None:
    batch = FourBar(o2=(0, 0), o4=(4, 1), r2=[[1.0], [0.8]], r3=4, r4=3)
    theta2 = np.linspace(0, 6, 5)
    held = holding(batch, theta2, MASSES, LOADS)
    for row, linkage in enumerate((batch[0], batch[1])):
        single = holding(linkage, theta2, MASSES, LOADS)
        np.testing.assert_allclose(held.force[row], np.ravel(single.force), rtol=1e-12)
    assert np.isnan(advantage(ROCKER, np.pi).velocity_ratio)
    assert np.isnan(holding(ROCKER, np.pi, MASSES, LOADS).force)
