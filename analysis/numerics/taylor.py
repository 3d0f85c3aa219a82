"""Functions of time differentiated exactly: arithmetic with truncated Taylor series."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray

_ORDER = 3
_FACTORIALS = (1.0, 1.0, 2.0, 6.0)


def derivatives(function: Callable[[Any], Any], time: npt.ArrayLike) -> tuple[FloatArray, ...]:
    """A function of time (...) and its first three derivatives, to rounding, by truncated Taylor series.

    Forward automatic differentiation (Griewank & Walther, *Evaluating Derivatives*, ch. 13) of arithmetic,
    NumPy functions and ``np.where``, or of a SciPy spline or NumPy polynomial; ProblemError for others.

    >>> [float(value) for value in derivatives(lambda t: t**3 - np.cos(2 * t), 0.0)]
    [-1.0, 0.0, 4.0, 6.0]
    """
    at = np.asarray(time, dtype=np.float64)
    for name in ("derivative", "deriv"):  # SciPy's splines, NumPy's polynomials
        if hasattr(function, name):
            return tuple(
                np.asarray(getattr(function, name)(order)(at) if order else function(at), dtype=np.float64)[
                    ()
                ]
                for order in range(_ORDER + 1)
            )
    try:
        series = function(Taylor([at, 1.0]))
    except (TypeError, ValueError, AttributeError) as error:
        raise ProblemError(
            f"a function of time cannot be differentiated: {error}; it must consist of arithmetic, "
            "NumPy functions, splines and polynomials"
        ) from error
    terms = series.terms if isinstance(series, Taylor) else Taylor([series]).terms
    return tuple(
        np.broadcast_to(term * factorial, at.shape).astype(np.float64)[()]
        for term, factorial in zip(terms, _FACTORIALS, strict=True)
    )


class Taylor(NDArrayOperatorsMixin):
    """Taylor coefficients in time from order 0 (else zero), for arithmetic and NumPy's functions."""

    __slots__ = ("terms",)

    def __init__(self, terms: Sequence[npt.ArrayLike]) -> None:
        given = [np.asarray(term, dtype=np.float64) for term in terms]
        self.terms: list[FloatArray] = given + [np.zeros(())] * (_ORDER + 1 - len(given))

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        if method != "__call__" or options:
            return NotImplemented
        if ufunc in _COMPARISONS:
            return ufunc(*(value.terms[0] if isinstance(value, Taylor) else value for value in inputs))
        rule = _RULES.get(ufunc)
        if rule is None:
            raise TypeError(f"no rule for np.{ufunc.__name__}")
        return rule(*(value if isinstance(value, Taylor) else Taylor([value]) for value in inputs))

    def __array_function__(
        self, function: Callable[..., Any], types: Any, args: tuple[Any, ...], options: dict[str, Any]
    ) -> Any:
        if function is not np.where or len(args) != 3 or options:
            raise TypeError(f"no rule for np.{function.__name__}")
        chosen, *both = args
        return _where(chosen, *(value if isinstance(value, Taylor) else Taylor([value]) for value in both))


def _where(chosen: npt.ArrayLike, x: Taylor, y: Taylor) -> Taylor:
    return Taylor([np.where(chosen, *pair) for pair in zip(x.terms, y.terms, strict=True)])


def _product(x: Taylor, y: Taylor) -> Taylor:
    return Taylor([sum(x.terms[j] * y.terms[k - j] for j in range(k + 1)) for k in range(_ORDER + 1)])


def _quotient(x: Taylor, y: Taylor) -> Taylor:
    terms: list[FloatArray] = []
    for k in range(_ORDER + 1):
        known = sum((terms[j] * y.terms[k - j] for j in range(k)), np.zeros(()))
        terms.append((x.terms[k] - known) / y.terms[0])
    return Taylor(terms)


def _composed(slopes: Callable[[FloatArray], Sequence[npt.ArrayLike]]) -> Callable[[Taylor], Taylor]:
    """Rule for f(x) from f and its first three derivatives at the constant term (Faa di Bruno)."""

    def rule(x: Taylor) -> Taylor:
        f, f1, f2, f3 = map(np.asarray, slopes(x.terms[0]))
        _, a, b, c = x.terms
        return Taylor([f, f1 * a, f1 * b + f2 * a * a / 2, f1 * c + f2 * a * b + f3 * a**3 / 6])

    return rule


def _power(x: Taylor, y: Taylor) -> Taylor:
    exponent = y.terms[0]
    if any(np.any(term != 0) for term in y.terms[1:]):
        return _RULES[np.exp](_product(y, _RULES[np.log](x)))

    def slopes(value: FloatArray) -> list[FloatArray]:
        found, factor = [], np.ones(())
        for order in range(_ORDER + 1):
            # A zero factor must not meet the pole of a negative power.
            power = np.where(factor == 0, 1.0, exponent - order)
            found.append(factor * value**power)
            factor = factor * (exponent - order)
        return found

    return _composed(slopes)(x)


def _logistic_slopes(t: FloatArray) -> tuple[FloatArray, ...]:
    return t, 1 - t**2, -2 * t * (1 - t**2), (6 * t**2 - 2) * (1 - t**2)


_COMPARISONS = frozenset(
    {np.less, np.less_equal, np.greater, np.greater_equal, np.equal, np.not_equal, np.sign, np.floor}
)
_RULES: dict[np.ufunc, Callable[..., Taylor]] = {
    np.add: lambda x, y: Taylor([a + b for a, b in zip(x.terms, y.terms, strict=True)]),
    np.subtract: lambda x, y: Taylor([a - b for a, b in zip(x.terms, y.terms, strict=True)]),
    np.multiply: _product,
    np.divide: _quotient,
    np.power: _power,
    np.square: lambda x: _product(x, x),
    np.negative: lambda x: Taylor([-term for term in x.terms]),
    np.positive: lambda x: x,
    np.absolute: lambda x: Taylor([np.sign(x.terms[0]) * term for term in x.terms]),
    np.remainder: lambda x, y: Taylor([np.remainder(x.terms[0], y.terms[0]), *x.terms[1:]]),
    np.minimum: lambda x, y: _where(x.terms[0] <= y.terms[0], x, y),
    np.maximum: lambda x, y: _where(x.terms[0] >= y.terms[0], x, y),
    np.sin: _composed(lambda x: (np.sin(x), np.cos(x), -np.sin(x), -np.cos(x))),
    np.cos: _composed(lambda x: (np.cos(x), -np.sin(x), -np.cos(x), np.sin(x))),
    np.tan: lambda x: _quotient(_RULES[np.sin](x), _RULES[np.cos](x)),
    np.exp: _composed(lambda x: [np.exp(x)] * 4),
    np.log: _composed(lambda x: (np.log(x), 1 / x, -1 / x**2, 2 / x**3)),
    np.sqrt: lambda x: _power(x, Taylor([0.5])),
    np.sinh: _composed(lambda x: (np.sinh(x), np.cosh(x), np.sinh(x), np.cosh(x))),
    np.cosh: _composed(lambda x: (np.cosh(x), np.sinh(x), np.cosh(x), np.sinh(x))),
    np.tanh: _composed(lambda x: _logistic_slopes(np.tanh(x))),
    np.arctan: _composed(
        lambda x: (
            np.arctan(x),
            1 / (1 + x**2),
            -2 * x / (1 + x**2) ** 2,
            (6 * x**2 - 2) / (1 + x**2) ** 3,
        )
    ),
    np.deg2rad: lambda x: Taylor([np.deg2rad(term) for term in x.terms]),
    np.radians: lambda x: Taylor([np.radians(term) for term in x.terms]),
}
