"""Moves of inexact linkages: against linkages that are made so."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, driver_ranges, made_moves, output_sensitivity, solve_position
from grashof.analysis.judge.tolerance import made_linkages
from grashof.problems import FourBar

Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762, coupler_point=(1.7, 0.7))


def inside(linkage: FourBar) -> np.ndarray:
    low, high = driver_ranges(linkage)[0]
    return low + (high - low) * np.linspace(0.07, 0.91, 15)


@given(data=st.data())
@settings(max_examples=10)
def test_slopes_are_those_of_made_linkages(four_bars: Drawer, data: st.DataObject) -> None:
    linkage = data.draw(four_bars(data.draw(st.sampled_from([*_SURE]))))
    theta2, step = inside(linkage), 1e-6 * float(linkage.r1)
    found = output_sensitivity(linkage, theta2)
    moves = made_moves(linkage, theta2, step)
    for k in range(6):
        errors = np.zeros((2, 6))
        errors[:, k] = step, -step
        made, _ = made_linkages(linkage, errors)
        states = solve_position(made[:, None], theta2)
        turned = (states.theta4[0] - states.theta4[1] + np.pi) % (2 * np.pi) - np.pi
        scale = 1e-4 * np.abs(found).max()
        np.testing.assert_allclose(found[:, k], turned / (2 * step), atol=scale)
        way = np.hypot(*np.moveaxis((states.p[0] - states.p[1]) / 2, -1, 0))
        np.testing.assert_allclose(moves.point[:, k], way, atol=1e-4 * moves.point.max())


_SURE = (GrashofClass.CRANK_ROCKER, GrashofClass.DOUBLE_CRANK, GrashofClass.NON_GRASHOF)


def test_the_worst_is_the_worst_of_all_made_linkages() -> None:
    theta2, tolerance = inside(JACK), 1e-5
    moves = made_moves(JACK, theta2, tolerance)
    corners = tolerance * np.array(list(product((1.0, -1.0), repeat=6)))
    rng = np.random.default_rng(3)
    errors = np.concatenate([corners, rng.uniform(-tolerance, tolerance, (2000, 6))])
    made, _ = made_linkages(JACK, errors)
    states, nominal = solve_position(made[:, None], theta2), solve_position(JACK, theta2)
    way = np.hypot(*np.moveaxis(states.p - nominal.p, -1, 0))
    np.testing.assert_allclose(moves.point_worst, way.max(axis=0), rtol=1e-3)
    np.testing.assert_allclose(
        moves.theta4_worst, np.abs(states.theta4 - nominal.theta4).max(axis=0), rtol=1e-3
    )


def test_the_rms_is_that_of_independent_deviations() -> None:
    theta2, deviation = inside(JACK), 1e-5
    moves = made_moves(JACK, theta2, deviation)
    made, _ = made_linkages(JACK, np.random.default_rng(5).normal(0, deviation, (20_000, 6)))
    states, nominal = solve_position(made[:, None], theta2), solve_position(JACK, theta2)
    square = ((states.p - nominal.p) ** 2).sum(axis=-1).mean(axis=0)
    np.testing.assert_allclose(moves.point_rms, np.sqrt(square), rtol=0.03)
    turned = ((states.theta4 - nominal.theta4) ** 2).mean(axis=0)
    np.testing.assert_allclose(moves.theta4_rms, np.sqrt(turned), rtol=0.03)


def test_a_point_on_the_crank_knows_the_crank_alone() -> None:
    at_a = made_moves(replace(JACK, coupler_point=(0.0, 0.0)), [0.3, 2.0], 0.1)
    np.testing.assert_allclose(at_a.point, np.array([[0, 0.1, 0, 0, 0.1, 0.1]] * 2), atol=1e-15)
    assert np.isnan(made_moves(FourBar((0, 0), (4, 0), 2, 2, 3), np.pi, 0.1).point_worst)
    assert made_moves(JACK, 1.0, 0.2).point_rms == pytest.approx(2 * made_moves(JACK, 1.0, 0.1).point_rms)
