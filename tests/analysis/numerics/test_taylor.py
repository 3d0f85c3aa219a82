"""Derivatives of functions of time, compared with those worked out by hand and between functions."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import BSpline, CubicSpline, make_interp_spline

from grashof.analysis.numerics.taylor import derivatives
from grashof.problems import ProblemError

TIME = np.linspace(0.3, 2.1, 13)


@pytest.mark.parametrize(
    ("function", "same"),
    [
        (lambda t: np.sin(3 * t), [lambda t: math.sin(3 * t), lambda t: 3 * math.cos(3 * t),
                                   lambda t: -9 * math.sin(3 * t), lambda t: -27 * math.cos(3 * t)]),
        (lambda t: np.exp(-t) / t, [lambda t: math.exp(-t) / t,
                                    lambda t: -math.exp(-t) * (1 / t + 1 / t**2),
                                    lambda t: math.exp(-t) * (1 / t + 2 / t**2 + 2 / t**3),
                                    lambda t: -math.exp(-t) * (1 / t + 3 / t**2 + 6 / t**3 + 6 / t**4)]),
        (lambda t: np.sqrt(t), [lambda t: t**0.5, lambda t: t**-0.5 / 2, lambda t: -(t**-1.5) / 4,
                                lambda t: 3 * t**-2.5 / 8]),
        (lambda t: 2**t, [lambda t, n=n: 2**t * math.log(2) ** n for n in range(4)]),
        (lambda t: np.arctan(2 * t), [
            lambda t: math.atan(2 * t), lambda t: 2 / (1 + 4 * t**2),
            lambda t: -16 * t / (1 + 4 * t**2) ** 2,
            lambda t: (192 * t**2 - 16) / (1 + 4 * t**2) ** 3]),
    ],
)  # fmt: skip
def test_derivatives_worked_out_by_hand(function: Any, same: list[Callable[[float], float]]) -> None:
    for found, expected in zip(derivatives(function, TIME), same, strict=True):
        np.testing.assert_allclose(found, [expected(t) for t in TIME], rtol=1e-13)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (lambda t: t**3, lambda t: t * t * t),
        (lambda t: t**-2.0, lambda t: 1 / np.square(t)),
        (lambda t: np.tan(t / 2), lambda t: (1 - np.cos(t)) / np.sin(t)),
        (lambda t: np.tanh(t), lambda t: np.sinh(t) / np.cosh(t)),
        (lambda t: np.log(t**2), lambda t: 2 * np.log(t)),
        (lambda t: t**t, lambda t: np.exp(t * np.log(t))),
        (lambda t: np.radians(40 * t), lambda t: np.deg2rad(t) * 40),
        (lambda t: abs(-t) - +t, lambda t: 0 * t),
        (
            lambda t: np.where(t < 1, t**2, 2 * t - 1),
            lambda t: np.minimum(t, 1) ** 2 + 2 * np.maximum(t - 1, 0),
        ),
        (lambda t: np.where(t >= 9, 5.0, (t + 7) % 7), lambda t: 0 + t),
        (lambda t: 1 - (1 - t), lambda t: 2 / (2 / t)),
    ],
)  # fmt: skip
def test_two_ways_to_write_a_function(one: Any, other: Any) -> None:
    for first, second in zip(derivatives(one, TIME), derivatives(other, TIME), strict=True):
        np.testing.assert_allclose(first, second, rtol=1e-12, atol=1e-12)


def test_powers_at_zero_are_finite() -> None:
    assert [float(value) for value in derivatives(lambda t: t**2 + t**3, 0.0)] == [0, 0, 2, 6]


def test_constants_splines_and_polynomials() -> None:
    assert [float(value) for value in derivatives(lambda t: 4.0, 1.0)] == [4, 0, 0, 0]
    knots = np.linspace(0, 3, 9)
    quintic: BSpline = make_interp_spline(knots, np.sin(knots), k=5)
    for curve in (CubicSpline(knots, np.sin(knots)), quintic):
        for order, found in enumerate(derivatives(curve, TIME)):
            np.testing.assert_allclose(found, curve(TIME, order), rtol=1e-13, atol=1e-13)
    cube = np.polynomial.Polynomial([1, 2, 3, 4])
    np.testing.assert_allclose(derivatives(cube, 2.0), [49, 62, 54, 24])


def test_other_functions_are_refused() -> None:
    for function in (
        lambda t: math.sin(t),
        lambda t: np.arctan2(t, 1),
        lambda t: np.interp(t, [0, 1], [0, 2]),
    ):
        with pytest.raises(ProblemError, match="cannot be differentiated"):
            derivatives(function, TIME)
