"""Moves of inexact linkages: against linkages that are made so."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from loaded_linkages import JACK

from grashof.analysis import driver_ranges, made_moves, solve_position
from grashof.analysis.judge.tolerance import made_linkages
from grashof.problems import FourBar


def inside(linkage: FourBar) -> np.ndarray:
    low, high = driver_ranges(linkage)[0]
    return low + (high - low) * np.linspace(0.07, 0.91, 15)


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
