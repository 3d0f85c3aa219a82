"""Statics: the ratios of speeds, and what holds a linkage, against inverse dynamics and forces put on."""

from dataclasses import replace

import numpy as np
from loaded_linkages import JACK, LOADS, MASSES, ROCKER

from grashof.analysis import Friction, Loads, advantage, driver_ranges, holding, output_stroke
from grashof.problems import FourBar


def angles_of(linkage: FourBar) -> np.ndarray:
    """Driver angles clear of dead positions."""
    low, high = driver_ranges(linkage)[0]
    return low + (high - low) * np.linspace(0.013, 0.981, 24)


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
