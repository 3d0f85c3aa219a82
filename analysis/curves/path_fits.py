"""Curves through the samples of a path, and fits of paths: y over x, and x and y over the driver angle."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import scipy

from grashof.analysis.curves.fit import PolynomialFit, fit_polynomial, furthest, samples, turns_back
from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.checks import finite_number
from grashof.problems.values.value_bases import ReadOnly


@dataclass(frozen=True, slots=True, eq=False)
class NewtonPolynomial(ReadOnly):
    """The polynomial through given values, in Newton's form, evaluated by a call.

    Parameters
    ----------
    nodes : ndarray, shape (N,)
    coefficients : ndarray, shape (N,) or (N, K)
        Divided differences f[t0], f[t0, t1], ...: factors of 1, t - t0, (t - t0)(t - t1), ...
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
        All different, in any order.
    values : array_like, shape (N,) or (N, K)

    Returns
    -------
    NewtonPolynomial

    Raises
    ------
    ProblemError
        Two equal nodes, shapes that do not match, or numbers that are not finite.

    Notes
    -----
    f[ti..tj] = (f[ti+1..tj] - f[ti..tj-1]) / (tj - ti). Between the nodes the polynomial may deviate far from
    the path: see `greatest_error`.

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
        Of a closed curve, such as a turn of the driver, with the first sample not repeated; by default the
        curve is open, with not-a-knot ends.

    Returns
    -------
    scipy.interpolate.CubicSpline
        Evaluated by a call, whose second argument is the order of the derivative.

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


DEGREES, NEWTON_DEGREES = (1, 2, 3, 4), (2, 3, 4)
_BETWEEN = 20  # steps of the path from point to point, for errors
_EQUAL = 1e-9  # share of the size of a path within which places coincide
Y_OF_X, OF_THETA2 = "y over x", "x and y over theta2"


@dataclass(frozen=True, slots=True, eq=False)
class FittedPath:
    """A path and the points on it to fit.

    Parameters
    ----------
    key, label : str
    theta2 : ndarray, shape (N,), rad
        Driver angles of the points, in equal steps.
    points : ndarray, shape (N, 2)
    fine, path : ndarray, shape (M,) and (M, 2)
        Driver angles and points of the path, 20 steps from point to point.
    """

    key: str
    label: str
    theta2: FloatArray
    points: FloatArray
    fine: FloatArray
    path: FloatArray

    @staticmethod
    def angles(start: float, end: float, count: int) -> tuple[FloatArray, FloatArray]:
        """Driver angles of `count` points, and the fine ones of the path."""
        return np.linspace(start, end, count), np.linspace(start, end, _BETWEEN * (count - 1) + 1)

    @property
    def turns_back(self) -> bool:
        """Whether x turns back along the path, so that y is not a function of x."""
        return turns_back(self.path[:, 0])

    @property
    def fits(self) -> list[PathFit]:
        """All fits of this path, by least squares and through neighbouring points."""
        ways = (_regression, DEGREES), (_interpolation, NEWTON_DEGREES)
        return [fit(self, of, n) for fit, degrees in ways for of in (Y_OF_X, OF_THETA2) for n in degrees]

    def parts(self, of: str) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Parameter and values at the points and on the path."""
        if of == Y_OF_X:
            return self.points[:, 0], self.points[:, 1], self.path[:, 0], self.path[:, 1]
        return self.theta2, self.points, self.fine, self.path


@dataclass(frozen=True, slots=True, eq=False)
class PathFit:
    """A fit of a path.

    Parameters
    ----------
    of : str
        `Y_OF_X` or `OF_THETA2`.
    newton : bool
        Whether it interpolates through neighbouring points, or fits all by least squares.
    degree : int
    pieces : tuple
        The polynomial of least squares; or Newton's, each through `degree` + 1 points and used from its first
        point to the next, the last up to the end of the path. None where two points have the same x.
    r2 : float
        NaN for interpolation.
    error_points, error_path : float, length
        Greatest distance from the points, and from the path, at equal parameters; NaN without polynomials.
    line : ndarray, shape (M, 2)
        The fit as drawn.
    """

    of: str
    newton: bool
    degree: int
    pieces: tuple[PolynomialFit | NewtonPolynomial | None, ...]
    r2: float
    error_points: float
    error_path: float
    line: FloatArray


def _regression(path: FittedPath, of: str, degree: int) -> PathFit:
    places, values, fine, true = path.parts(of)
    if _different(path, of, places) <= degree:
        return PathFit(of, False, degree, (None,), np.nan, np.nan, np.nan, np.full((1, 2), np.nan))
    fit = fit_polynomial(places, values, degree)
    grid = np.linspace(fine.min(), fine.max(), len(fine))
    line = np.stack([grid, fit(grid)], axis=-1) if of == Y_OF_X else fit(fine)
    return PathFit(of, False, degree, (fit,), fit.r2, fit.error_max, furthest(fit(fine) - true), line)


def _interpolation(path: FittedPath, of: str, degree: int) -> PathFit:
    places, values, fine, true = path.parts(of)
    pieces, lines, errors = list[NewtonPolynomial | None](), list[FloatArray](), list[float]()
    last = len(places) - 1 - degree
    for first in range(last + 1):
        nodes = slice(first, first + degree + 1)
        if _different(path, of, places[nodes]) <= degree:
            pieces.append(None)
            continue
        piece = newton_interpolation(places[nodes], values[nodes])
        until = first + 1 if first < last else len(places) - 1
        used = slice(_BETWEEN * first, _BETWEEN * until + 1)
        errors.append(furthest(piece(fine[used]) - true[used]))
        if of == Y_OF_X:
            ways = pairwise(places[first : until + 1])
            x = np.concatenate([np.linspace(*way, _BETWEEN) for way in ways])
            lines.append(np.stack([x, piece(x)], axis=-1))
        else:
            lines.append(piece(fine[used]))
        pieces.append(piece)
    line = np.concatenate(lines) if lines else np.full((1, 2), np.nan)
    error_points = 0.0 if lines else np.nan
    return PathFit(of, True, degree, tuple(pieces), np.nan, error_points, max(errors, default=np.nan), line)


def _different(path: FittedPath, of: str, places: FloatArray) -> int:
    """Number of places that differ by more than rounding."""
    size = np.ptp(path.path, axis=0).max() if of == Y_OF_X else np.ptp(path.fine)
    return 1 + int((np.diff(np.sort(places)) > _EQUAL * size).sum())
