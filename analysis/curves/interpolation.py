"""Curves through all the samples of a path: Newton's divided differences and splines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from grashof.analysis.curves.fit import samples
from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.checks import finite_number
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.value_bases import ReadOnly


@dataclass(frozen=True, slots=True, eq=False)
class NewtonPolynomial(ReadOnly):
    """The polynomial through given values, in Newton's form; call it to evaluate it.

    Parameters
    ----------
    nodes : ndarray, shape (N,)
    coefficients : ndarray, shape (N,) or (N, K)
        Divided differences f[t0], f[t0, t1], ...: factors of 1, (t - t0), (t - t0)(t - t1), ...
    """

    nodes: FloatArray
    coefficients: FloatArray

    def __call__(self, parameter: npt.ArrayLike) -> FloatArray:
        """Value at any parameter, shape (...) or (..., K)."""
        t = np.asarray(parameter, dtype=np.float64)
        several = self.coefficients.ndim > 1
        value = np.broadcast_to(self.coefficients[-1], (*t.shape, *self.coefficients.shape[1:]))
        for node, coefficient in zip(self.nodes[-2::-1], self.coefficients[-2::-1], strict=True):
            factor = (t - node)[..., None] if several else t - node
            value = value * factor + coefficient
        return np.array(value)


def newton_interpolation(nodes: npt.ArrayLike, values: npt.ArrayLike) -> NewtonPolynomial:
    """Polynomial of degree N - 1 through N values, by divided differences.

    Parameters
    ----------
    nodes : array_like, shape (N,)
        All different; in any sequence.
    values : array_like, shape (N,) or (N, K)

    Returns
    -------
    NewtonPolynomial

    Raises
    ------
    ProblemError
        Two equal nodes, shapes that do not fit, or numbers that are not finite.

    Notes
    -----
    f[ti..tj] = (f[ti+1..tj] - f[ti..tj-1]) / (tj - ti). Between the nodes such a polynomial may
    run far away from a path, the more so with x as the parameter, where nodes crowd at the turning
    points of the path: see `greatest_error`.

    Examples
    --------
    >>> cubic = newton_interpolation([0, 1, 2, 4], [1, 2, 9, 65])
    >>> cubic.coefficients.tolist(), float(cubic(3))
    ([1.0, 1.0, 3.0, 1.0], 28.0)
    """
    t, y = samples(nodes, values)
    if np.unique(t).size < t.size:
        raise ProblemError("two nodes are equal; an interpolating polynomial needs different ones")
    differences = np.array(y)
    for order in range(1, len(t)):
        reach = (t[order:] - t[:-order]).reshape(-1, *([1] * (y.ndim - 1)))
        differences[order:] = (differences[order:] - differences[order - 1 : -1]) / reach
    return NewtonPolynomial(frozen_array(t), frozen_array(differences))


def spline(
    parameter: npt.ArrayLike, values: npt.ArrayLike, period: float | None = None
) -> scipy.interpolate.CubicSpline:
    """Interpolating cubic spline, twice continuously differentiable.

    Parameters
    ----------
    parameter : array_like, shape (N,)
        Increasing, such as the driver angle.
    values : array_like, shape (N,) or (N, K)
    period : float, optional
        Of a closed curve (a turn of the driver): the samples are those of one period, the first one
        not repeated. Without it the curve is open, with not-a-knot ends.

    Returns
    -------
    scipy.interpolate.CubicSpline
        Call it to evaluate it; its second argument asks for derivatives.

    Raises
    ------
    ProblemError
        A parameter that does not increase or exceeds the period; fewer than two samples.

    Examples
    --------
    >>> theta2 = np.arange(24) * np.pi / 12
    >>> circle = spline(theta2, np.stack([np.cos(theta2), np.sin(theta2)], axis=-1), period=2 * np.pi)
    >>> circle(2 * np.pi + 0.1).round(4).tolist()
    [0.995, 0.0998]
    """
    t, y = samples(parameter, values)
    if len(t) < 2 or not np.all(np.diff(t) > 0):
        raise ProblemError(
            "the parameter does not increase from sample to sample; a spline needs two or more"
        )
    if period is None:
        return scipy.interpolate.CubicSpline(t, y, bc_type="not-a-knot")
    period = finite_number(period, "period")
    if len(t) < 3 or not t[-1] - t[0] < period:
        raise ProblemError(
            f"the {len(t)} samples span {t[-1] - t[0]:.6g}; a closed curve of period {period:.6g} needs "
            "three or more within one period, the first not repeated"
        )
    return scipy.interpolate.CubicSpline(
        np.append(t, t[0] + period), np.append(y, y[:1], axis=0), bc_type="periodic"
    )
