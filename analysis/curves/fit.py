"""Least-squares polynomials of a path: y over x, or both coordinates over the driver angle."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev, legendre

from grashof.analysis.mechanism.even_motion import with_edges
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.quadrature import gauss_legendre
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.checks import finite_rows, whole_number
from grashof.problems.values.value_bases import ReadOnly

_FEWEST, _MOST = 8, 512  # panels over a motion
_SETTLED = 1e-13
_EQUAL = 1e-14  # share of their size by which values differ by rounding


class NotAFunctionWarning(UserWarning):
    """y is requested as a function of x on a path along which x turns back."""


@dataclass(frozen=True, slots=True, eq=False)
class PolynomialFit(ReadOnly):
    """A polynomial fitted to samples, in one coordinate or several; call it to evaluate it.

    Parameters
    ----------
    low, high : float
        Range of the parameter at the samples.
    coefficients : ndarray, shape (degree + 1,) or (degree + 1, K)
        Of the Chebyshev polynomials in the parameter scaled to [-1, 1].
    r2 : float
        1 - (sum of squared errors) / (sum of squared distances from the mean), all coordinates together,
        hence independent of the frame; NaN when all values are equal.
    r2_each : ndarray, shape () or (K,)
        The same for each coordinate.
    error_max : float
        Greatest distance from a sample.
    """

    low: float
    high: float
    coefficients: FloatArray
    r2: float
    r2_each: FloatArray
    error_max: float

    @property
    def degree(self) -> int:
        """Degree of the polynomial."""
        return len(self.coefficients) - 1

    @property
    def powers(self) -> FloatArray:
        """Coefficients of 1, t, t^2 ... of the parameter itself, shape of `coefficients`."""
        span = self.high - self.low
        shift, scale, count = -(self.low + self.high) / span, 2 / span, self.degree + 1
        # Rows: Chebyshev polynomials of shift + scale t in powers of t, by recurrence.
        basis = np.zeros((count, count))
        basis[0, 0], basis[1, :2] = 1, (shift, scale)
        for k in range(1, self.degree):
            basis[k + 1] = 2 * shift * basis[k] - basis[k - 1]
            basis[k + 1, 1:] += 2 * scale * basis[k, :-1]
        return np.tensordot(basis, self.coefficients, axes=(0, 0))

    def __call__(self, parameter: npt.ArrayLike) -> FloatArray:
        """Value at any parameter, shape (...) or (..., K)."""
        scaled = _scaled(np.asarray(parameter, dtype=np.float64), self.low, self.high)
        value = np.asarray(chebyshev.chebval(scaled, self.coefficients), dtype=np.float64)
        return np.moveaxis(value, 0, -1) if self.coefficients.ndim > 1 else value


def fit_polynomial(parameter: npt.ArrayLike, values: npt.ArrayLike, degree: int) -> PolynomialFit:
    """Least-squares polynomial of values against a parameter.

    Parameters
    ----------
    parameter : array_like, shape (N,)
        Such as the driver angle.
    values : array_like, shape (N,) or (N, K)
        One coordinate or several.
    degree : int
        From 1; more than `degree` different parameters are needed.

    Returns
    -------
    PolynomialFit

    Raises
    ------
    ProblemError
        Shapes that do not match, numbers that are not finite, or too few samples for the degree.

    Examples
    --------
    >>> t = np.linspace(0, 2, 9)
    >>> fit = fit_polynomial(t, np.stack([1 + t, t**2], axis=-1), degree=2)
    >>> (fit.powers.round(12) + 0.0).tolist(), round(fit.r2, 12)
    ([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 1.0)
    """
    t, y = samples(parameter, values)
    degree = whole_number(degree, 1, "degree")
    if np.unique(t).size <= degree:
        raise ProblemError(
            f"there are {np.unique(t).size} different parameters; degree {degree} needs {degree + 1} or more"
        )
    low, high = float(t.min()), float(t.max())
    basis = chebyshev.chebvander(_scaled(t, low, high), degree)
    coefficients = np.linalg.lstsq(basis, y, rcond=None)[0]
    miss = (y - basis @ coefficients).reshape(len(t), -1)
    wrong, spread = (miss**2).sum(axis=0), ((y - y.mean(axis=0)) ** 2).reshape(len(t), -1).sum(axis=0)
    return PolynomialFit(
        low=low,
        high=high,
        coefficients=frozen_array(coefficients),
        r2=float(_r2(wrong.sum(), spread.sum(), np.abs(y).max())),
        r2_each=frozen_array(_r2(wrong, spread, np.abs(y).max()).reshape(y.shape[1:])),
        error_max=furthest(miss),
    )


def regression(points: npt.ArrayLike, degree: int) -> PolynomialFit:
    """Least-squares polynomial y(x) through the points of a path.

    Parameters
    ----------
    points : array_like, shape (N, 2), length
        In sequence along the path.
    degree : int

    Returns
    -------
    PolynomialFit
        Of y, with x as the parameter.

    Warns
    -----
    NotAFunctionWarning
        When x turns back along the path, so that several y belong to one x; use `fit_polynomial` against the
        driver angle instead.

    Examples
    --------
    >>> regression([[0, 1], [1, 3], [2, 5], [3, 7]], degree=1).powers.round(12).tolist()
    [1.0, 2.0]
    """
    path = finite_rows(points, 2, "points", "a point [x, y]")
    if turns_back(path[:, 0]):
        warnings.warn(
            "x turns back along the path, so y is not a function of x; fit x and y against the driver angle",
            NotAFunctionWarning,
            stacklevel=2,
        )
    return fit_polynomial(path[:, 0], path[:, 1], degree)


def turns_back(x: FloatArray) -> bool:
    """Whether x (N,) neither rises nor falls throughout a path, so that y is not a function of it."""
    step = np.diff(x)
    return not (np.all(step > 0) or np.all(step < 0))


def greatest_error(
    curve: Callable[[FloatArray], FloatArray], parameter: npt.ArrayLike, values: npt.ArrayLike
) -> float:
    """Greatest distance of a fitted or interpolating curve from given values.

    Parameters
    ----------
    curve : callable
        A `PolynomialFit`, `NewtonPolynomial`, spline or other function of the parameter.
    parameter : array_like, shape (N,)
    values : array_like, shape (N,) or (N, K)
        Exact values.

    Returns
    -------
    float

    Examples
    --------
    >>> greatest_error(lambda t: t**2, [0, 1, 2], [0, 1, 3])
    1.0
    """
    t, y = samples(parameter, values)
    return furthest(np.asarray(curve(t)) - y)


def furthest(miss: FloatArray) -> float:
    """Greatest length of differences, shape (N,) or (N, K)."""
    return float(np.sqrt((miss.reshape(len(miss), -1) ** 2).sum(axis=-1).max()))


def coupler_fit_r2(
    linkage: Linkage, theta2_start: npt.ArrayLike, theta2_end: npt.ArrayLike, degree: int = 4
) -> FloatArray:
    """R2 of the least-squares polynomial in the driver angle for the path of P over a motion.

    Parameters
    ----------
    linkage : Linkage
        One or a batch.
    theta2_start, theta2_end : array_like, shape (...), rad
        Ends of the motion, in either order; they broadcast against the linkages.
    degree : int
        From 1 to 30.

    Returns
    -------
    ndarray, shape (...)
        1 - (mean squared distance from the fit) / (mean squared distance from the mean point); NaN where P
        does not move or the linkage does not close throughout.

    Notes
    -----
    The limit of `fit_polynomial` for ever smaller equal steps of the driver: Gauss-Legendre sums over an
    `even_motion`, with the panels doubled until the result settles.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
    >>> coupler_fit_r2(crank_rocker, [0, 0], [1, 2 * np.pi]).round(6).tolist()
    [1.0, 0.996347]
    """
    degree = whole_number(degree, 1, "degree")
    if degree > 30:
        raise ProblemError(f"degree is {degree}; it must be from 1 to 30")
    members = np.arange(linkage.theta1.size).reshape(linkage.shape)
    ends = (np.asarray(end, dtype=np.float64) for end in (theta2_start, theta2_end))
    given = np.broadcast_arrays(*ends, members)
    start, end, member = (each.ravel() for each in given)
    return _settled_r2(degree, linkage.flat[member], start, end).reshape(given[0].shape)[()]


def samples(parameter: npt.ArrayLike, values: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Parameter, shape (N,), and values, shape (N,) or (N, K), checked."""
    try:
        t, y = np.asarray(parameter, dtype=np.float64), np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ProblemError(
            "parameter and values are not all numbers; they must be arrays of numbers"
        ) from None
    if t.ndim != 1 or y.ndim not in (1, 2) or len(t) != len(y) or len(t) == 0:
        raise ProblemError(
            f"parameter and values have shapes {t.shape} and {y.shape}; they must be (N,) with (N,) or (N, K)"
        )
    if not (np.isfinite(t).all() and np.isfinite(y).all()):
        raise ProblemError("parameter or values hold NaN or infinity; all numbers must be finite")
    return t, y


def _settled_r2(degree: int, linkage: Linkage, start: FloatArray, end: FloatArray) -> FloatArray:
    """R2 of linkages (n,) between driver angles (n,); each to the last bit as of it alone."""
    found, before = np.full(start.shape, np.nan), np.full(start.shape, np.inf)
    panels, left = _FEWEST, np.flatnonzero(start != end)
    while left.size:
        found[left] = _r2_by_panels(linkage[left], start[left], end[left], panels, degree)
        unsettled = np.abs(found[left] - before[left]) > _SETTLED
        before[left] = found[left]
        left = left[unsettled] if panels < _MOST else left[:0]
        panels *= 2
    return found


def _r2_by_panels(
    linkage: Linkage, start: FloatArray, end: FloatArray, panels: int, degree: int
) -> FloatArray:
    found = np.empty(start.shape)
    for rows, motion, edges in with_edges(linkage, start, end, panels):
        share, weight = gauss_legendre(edges)
        theta2, counts = motion.theta2(share), weight * np.abs(motion.rate(share))
        root = np.sqrt(counts / counts.sum(axis=-1, keepdims=True))[..., None]
        p = solve_position(linkage[rows, None], theta2).p
        middle = p[:, [p.shape[1] // 2]]
        scaled = _scaled(theta2, start[rows, None], end[rows, None])
        basis = np.linalg.qr(root * legendre.legvander(scaled, degree))[0]
        p = root * (p - middle)
        spread, wrong = (_squares(p - fit @ (fit.swapaxes(-1, -2) @ p)) for fit in (root, basis))
        found[rows] = _r2(wrong, spread, np.abs(middle).max(axis=(-1, -2)))
    return found


def _squares(rows: FloatArray) -> FloatArray:
    return np.asarray((rows**2).reshape(len(rows), -1).sum(axis=-1))


def _scaled(parameter: FloatArray, low: float | FloatArray, high: float | FloatArray) -> FloatArray:
    return (2 * parameter - low - high) / (high - low)


def _r2(wrong: npt.ArrayLike, spread: npt.ArrayLike, reach: npt.ArrayLike) -> FloatArray:
    """R2; NaN where the values of this greatest size differ by no more than their rounding."""
    moves = np.greater(spread, np.square(np.multiply(_EQUAL, reach)))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(moves, 1 - np.divide(wrong, spread), np.nan)
