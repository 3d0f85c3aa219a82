"""Functions for a linkage to generate: named laws, and samples of any other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from grashof.problems.values.arrays import FloatArray, Limits, frozen_array
from grashof.problems.values.checks import finite_number, limits, number_within, positive_number
from grashof.problems.values.errors import ProblemError, shown
from grashof.problems.values.text import hint
from grashof.problems.values.value_bases import ReadOnly, set_fields

LAWS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "log10": np.log10,
    "ln": np.log,
    "exp": np.exp,
    "sin": lambda x: np.sin(np.radians(x)),
    "cos": lambda x: np.cos(np.radians(x)),
    "tan": lambda x: np.tan(np.radians(x)),
    "sqrt": np.sqrt,
    "reciprocal": np.reciprocal,
    "power": np.positive,  # of the exponent given besides
}  # x of sin, cos and tan in degrees
SAMPLED = "sampled"  # a law without a name, such as a callable
RANGE = (0.1, 360.0)  # deg, of input and output
SAMPLES = 1025  # of a callable, over its range
_DENSE = 2049  # places at which a law is evaluated


@dataclass(frozen=True, slots=True, eq=False)
class FunctionLaw(ReadOnly):
    """y = f(x) over a range of x, as rotations of a driver and an output, or the travel of a slide.

    The driver turns in proportion to x over `input_range`, the output moves in proportion to y: over
    `output_range` from the least to the greatest y, and forward where the last y is greater than the
    first in the law's own sense, be it rising or falling: only a law that turns back turns its output back.

    Parameters
    ----------
    name : str
        One of `LAWS`, or "sampled".
    x : tuple of float
        First and last x; of sin, cos and tan in degrees.
    input_range : float, rad
    output_range : float, rad or length
    exponent : float, optional
        Of "power".
    samples : ndarray, shape (K,), optional
        Of "sampled": y at K Chebyshev-Lobatto points of the range.
    travels : bool
        The output is the travel of a slide.

    Raises
    ------
    ProblemError
        An unknown law, a range without extent or beyond a turn, a law undefined or constant on it.

    Examples
    --------
    >>> law = FunctionLaw("log10", (1.0, 2.0), np.radians(60), np.radians(90))
    >>> np.degrees(law.output(np.radians([0.0, 30.0, 60.0]))).round(6).tolist()
    [0.0, 52.646625, 90.0]
    """

    name: str
    x: Limits
    input_range: float
    output_range: float
    exponent: float | None = None
    samples: FloatArray | None = None
    travels: bool = False

    def __post_init__(self) -> None:
        if self.name != SAMPLED and self.name not in LAWS:
            laws = hint(str(self.name), list(LAWS), f"the laws are {', '.join(LAWS)}")
            raise ProblemError(f"function.law {shown(self.name)} is unknown; {laws}")
        low, high = limits(self.x, "function.x")
        if low == high:
            raise ProblemError(f"function.x is [{low:g}, {high:g}]; the two must differ")
        set_fields(self, x=(low, high))
        if self.travels:
            positive_number(self.output_range, "function.output_range")
        for name in ("input_range", *(() if self.travels else ("output_range",))):
            where = f"function.{name}_deg"
            given = np.degrees(finite_number(getattr(self, name), where))
            number_within(round(float(given), 9), *RANGE, where)
        if (self.exponent is None) == (self.name == "power"):
            missing = 'is missing; law = "power" needs it'
            said = missing if self.name == "power" else 'goes with law = "power" only'
            raise ProblemError(f"function.exponent {said}")
        if (self.samples is None) == (self.name == SAMPLED) or (
            self.samples is not None and np.size(self.samples) < 4
        ):
            raise ProblemError('function.sampled goes with law = "sampled", which needs four or more of them')
        if self.exponent is not None:
            number_within(self.exponent, -100.0, 100.0, "function.exponent")
        if self.samples is not None:
            set_fields(self, samples=frozen_array(self.samples))
        self._refuse_undefined()

    @classmethod
    def of_callable(
        cls,
        function: Callable[[FloatArray], FloatArray],
        x: Limits,
        input_range: float,
        output_range: float,
        *,
        travels: bool = False,
    ) -> FunctionLaw:
        """A law sampled densely from a function of x, so that it can be written and sent to processes."""
        low, high = limits(x, "function.x")
        places = low + (high - low) * _lobatto(SAMPLES)
        with np.errstate(all="ignore"):
            values = np.array([float(function(place)) for place in places])
        return cls(SAMPLED, (low, high), input_range, output_range, samples=values, travels=travels)

    def _refuse_undefined(self) -> None:
        low, high = self.x
        places = np.linspace(low, high, _DENSE)
        values = self.value(places)
        bad = ~np.isfinite(values)
        if self.name == "tan":
            bad |= np.floor((places + 90) / 180) != np.floor((low + 90) / 180)
        if self.name in ("reciprocal", "power") and low <= 0 <= high and (self.exponent or -1.0) < 0:
            bad |= True
            values, places = values[[0]], np.zeros(1)
            bad = bad[[0]]
        if bad.any():
            raise ProblemError(
                f"function.law {self.name} has no value at x = {places[np.argmax(bad)]:.6g}; "
                f"function.x is [{low:g}, {high:g}]"
            )
        spread = float(np.ptp(values))
        if spread <= 1e-12 * max(1e-300, float(np.abs(values).max())):
            raise ProblemError(f"function.law {self.name} is constant from x = {low:g} to {high:g}")

    def value(self, x: FloatArray) -> FloatArray:
        """Y at x; NaN or infinite where the law has none."""
        with np.errstate(all="ignore"):
            if self.samples is not None:
                return _interpolated(self.x, self.samples, x)
            if self.exponent is not None:
                return np.asarray(x, dtype=np.float64) ** self.exponent
            return LAWS[self.name](np.asarray(x, dtype=np.float64))

    def output(self, turned: FloatArray) -> FloatArray:
        """Output for driver rotations, both from the first x, rad or length."""
        low, high = self.x
        values = self.value(low + (high - low) * np.asarray(turned) / self.input_range)
        begins, forward, spread = _extent(self)
        rotated: FloatArray = forward * self.output_range * (values - begins) / spread
        return rotated


@lru_cache(maxsize=16)
def _extent(law: FunctionLaw) -> tuple[float, float, float]:
    """The first value of a law, the sign of its change in forward direction, and the extent of its values."""
    low, high = law.x
    first, last = law.value(np.array([low, high])).tolist()
    dense = law.value(np.linspace(low, high, _DENSE))
    forward = float(np.sign(last - first) or np.sign(dense[np.argmax(np.abs(dense - first))] - first))
    # A monotone law spans its ends exactly; samples of another one are a little within its extremes.
    return first, forward, max(abs(last - first), float(np.ptp(dense)))


def chebyshev_spacing(count: int) -> FloatArray:
    """Chebyshev's places of `count` precision points, as shares of the range: 0.067, 0.5, 0.933."""
    return 0.5 - 0.5 * np.cos((2 * np.arange(1, count + 1) - 1) * np.pi / (2 * count))


def _interpolated(over: Limits, samples: FloatArray, x: FloatArray) -> FloatArray:
    """The cubic spline through samples at Chebyshev-Lobatto points; NaN beside those that have no value."""
    from scipy.interpolate import CubicSpline  # here: few problems need it

    places = over[0] + (over[1] - over[0]) * _lobatto(len(samples))
    if not np.isfinite(samples).all():
        return np.where(np.isfinite(np.interp(x, places, samples)), 0.0, np.nan)
    found: FloatArray = CubicSpline(places, samples)(x)
    return found


def _lobatto(count: int) -> FloatArray:
    """Chebyshev-Lobatto points from 0 to 1."""
    return 0.5 - 0.5 * np.cos(np.pi * np.arange(count) / (count - 1))


def lobatto_with_weights(count: int) -> tuple[FloatArray, FloatArray]:
    """An odd number of Chebyshev-Lobatto points from 0 to 1, and their quadrature weights, of mean 1.

    Clenshaw & Curtis (1960): exact for polynomials of degree below `count`.
    """
    last = count - 1
    order = np.arange(0, last + 1, 2)
    factor = np.full(len(order), 2.0)
    factor[0], factor[-1] = 1.0, 1.0 if last % 2 == 0 else 2.0
    terms = np.cos(np.pi * np.outer(np.arange(count), order) / last) * factor / (1 - order**2)
    weights = terms.sum(axis=1) / last
    weights[[0, -1]] /= 2
    return _lobatto(count), weights * count
