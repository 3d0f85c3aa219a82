"""Statics: ratios of speeds, what holds a linkage, and equilibrium positions with their small swings."""

from dataclasses import replace

import numpy as np
import pytest
from loaded_linkages import JACK, LOADS, MASSES, ROCKER, SPRUNG, TURN, WEIGHT

from grashof import analysis
from grashof.analysis import WEIGHTLESS, Loads, advantage, driver_ranges, equilibria, holding, uniform_bars
from grashof.problems import FourBar


def angles_of(linkage: FourBar) -> np.ndarray:
    """Driver angles clear of dead positions."""
    low, high = driver_ranges(linkage)[0]
    return low + (high - low) * np.linspace(0.013, 0.981, 24)


def test_the_advantage_has_no_limit_at_toggles_and_is_zero_in_dead_positions() -> None:
    toggles = advantage(JACK, analysis.output_stroke(JACK).theta2)
    np.testing.assert_allclose(toggles.velocity_ratio, 0, atol=1e-14)
    assert np.abs(toggles.torque_ratio).min() > 1e13
    dead = advantage(ROCKER, driver_ranges(ROCKER)[0])
    np.testing.assert_allclose(dead.torque_ratio, 0, atol=1e-7)
    np.testing.assert_allclose(dead.force_ratio, 0, atol=1e-7)


def test_a_force_at_p_holds_a_linkage_in_a_dead_position_where_no_torque_does() -> None:
    ends = driver_ranges(ROCKER)[0]
    held = holding(ROCKER, ends, MASSES, LOADS)
    assert np.abs(held.torque).min() > 1e6
    inside = holding(ROCKER, ends + np.array([1e-10, -1e-10]), MASSES, LOADS)
    np.testing.assert_allclose(held.force, inside.force, rtol=1e-4)
    np.testing.assert_allclose(held.moment, inside.moment, rtol=1e-4)


def test_friction_is_left_out_and_nothing_is_held_by_nothing() -> None:
    rubbing = replace(LOADS, friction=analysis.Friction(1.0, 2.0, 0.1))
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


def ends(linkage: FourBar) -> tuple[float, float]:
    low, high = driver_ranges(linkage)[0]
    return (0.0, TURN) if linkage is JACK else (float(low), float(high))


@pytest.mark.parametrize("linkage", [JACK, ROCKER])
@pytest.mark.parametrize("loads", [WEIGHT, SPRUNG])
def test_the_energy_is_stationary_and_least_where_it_is_stable(linkage: FourBar, loads: Loads) -> None:
    masses = uniform_bars(linkage, 2.0, payload=3.0)
    found = equilibria(linkage, masses, loads, *ends(linkage), closed=linkage is JACK)
    assert found.theta2.size
    low, high = ends(linkage)
    theta2 = np.linspace(low + 1e-3, high - 1e-3, 5001)
    energy = analysis.mechanical_energy(analysis.solve_kinematics(linkage, theta2, 0.0), masses, loads)
    slope = np.diff(energy)
    turning = np.flatnonzero(slope[:-1] * slope[1:] < 0) + 1
    np.testing.assert_allclose(found.theta2, theta2[turning], atol=2 * (theta2[1] - theta2[0]))
    least = slope[turning] > 0
    np.testing.assert_array_equal(found.stiffness > 0, least)
    np.testing.assert_array_equal(np.isfinite(found.frequency), least)


@pytest.mark.parametrize(("linkage", "loads"), [(JACK, SPRUNG), (ROCKER, WEIGHT)])
def test_small_swings_have_the_natural_frequency(linkage: FourBar, loads: Loads) -> None:
    masses = uniform_bars(linkage, 2.0, payload=3.0)
    found = equilibria(linkage, masses, loads, *ends(linkage), closed=linkage is JACK)
    stable = np.flatnonzero(found.stiffness > 0)
    assert stable.size
    for k in stable:
        middle, frequency = float(found.theta2[k]), float(found.frequency[k])
        time = np.linspace(0, 2.2 / frequency, 221)
        swing = analysis.free_response(linkage, masses, time, middle + 1e-3, 0.0, loads=loads)
        speed = swing.state.omega2
        back = np.flatnonzero((speed[:-1] > 0) & (speed[1:] <= 0))
        through = time[back] + speed[back] / (speed[back] - speed[back + 1]) * (time[1] - time[0])
        period = float(np.diff(through).mean())
        assert 1 / period == pytest.approx(frequency, rel=1e-5)


def test_a_moment_shifts_it_and_a_strong_one_leaves_none() -> None:
    rod = analysis.Masses(analysis.Body(2.0, 0.3, (0.5, 0.0)), WEIGHTLESS.coupler, WEIGHTLESS.output)
    turned = replace(WEIGHT, moments=(analysis.AppliedMoment(2, 2.0),))
    found = equilibria(JACK, rod, turned, 0.0, TURN, closed=True)
    angle = np.arccos(2.0 / 9.81)  # m g a cos(theta2) = M
    np.testing.assert_allclose(found.theta2, [angle, TURN - angle], rtol=1e-12)
    stiffness = 9.81 * np.sin(angle)
    np.testing.assert_allclose(found.stiffness, [-stiffness, stiffness], rtol=1e-9)
    np.testing.assert_allclose(found.inertia, 0.3 + 2 * 0.25, rtol=1e-12)
    strong = replace(WEIGHT, moments=(analysis.AppliedMoment(2, 20.0),))
    assert equilibria(JACK, rod, strong, 0.0, TURN, closed=True).theta2.size == 0


def test_a_balanced_linkage_rests_everywhere() -> None:
    bars = analysis.balance_force(JACK, uniform_bars(JACK, 2.0)).masses
    found = equilibria(JACK, bars, WEIGHT, 0.0, TURN, closed=True)
    assert found.everywhere
    assert found.theta2.size == 0
    assert equilibria(JACK, bars, Loads(), 0.0, TURN, closed=True).everywhere


def test_an_equilibrium_at_the_start_of_the_turn_counts_once() -> None:
    rod = analysis.Masses(analysis.Body(2.0, 0.3, (0.5, 0.0)), WEIGHTLESS.coupler, WEIGHTLESS.output)
    for gravity in ((9.81, 0.0), (-9.81, 0.0)):
        found = equilibria(JACK, rod, Loads(gravity=gravity), 0.0, TURN, closed=True)
        assert found.theta2.size == 2
