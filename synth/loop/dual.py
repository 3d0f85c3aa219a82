"""Numbers with their derivatives by the unknowns of a search, for functions written with NumPy."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from grashof.problems.values.arrays import FloatArray


def _operator(ufunc: np.ufunc) -> tuple[Callable[[Dual, Any], Any], Callable[[Dual, Any], Any]]:
    """An operator and its reflection, without the detour by NumPy's dispatch."""

    def forward(self: Dual, other: Any) -> Any:
        return _of(ufunc, self, other) if isinstance(other, _NUMBERS) else NotImplemented

    def reflected(self: Dual, other: Any) -> Any:
        return _of(ufunc, other, self) if isinstance(other, _NUMBERS) else NotImplemented

    return forward, reflected


class Dual:
    """Values (n, K) and their slopes (n, K, M) by M unknowns; K may be 1 in either where it is broadcast.

    Forward differentiation (Griewank & Walther, *Evaluating Derivatives*, 2008, chapter 3). Slopes may be
    functions, called when needed: those of limits that are kept are not.

    >>> x = Dual(np.array([[3.0]]), np.array([[[1.0, 0.0]]]))
    >>> y = Dual(np.array([[4.0]]), np.array([[[0.0, 1.0]]]))
    >>> np.hypot(x, 2 * y - 4).slope.tolist()
    [[[0.6, 1.6]]]
    """

    __slots__ = ("_slope", "value")

    def __init__(self, value: FloatArray, slope: FloatArray | Callable[[], FloatArray]) -> None:
        self.value, self._slope = value, slope

    @property
    def slope(self) -> FloatArray:
        """Derivatives by the unknowns."""
        if callable(self._slope):
            self._slope = self._slope()
        return self._slope

    def column(self, k: int) -> Dual:
        """One column, as one."""
        return Dual(self.value[:, [k]], lambda: self.slope[:, [k]])

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **others: Any) -> Any:
        if method != "__call__" or others or ufunc not in _SLOPES:
            return NotImplemented
        return _of(ufunc, *inputs)

    __add__, __radd__ = _operator(np.add)
    __sub__, __rsub__ = _operator(np.subtract)
    __mul__, __rmul__ = _operator(np.multiply)
    __truediv__, __rtruediv__ = _operator(np.true_divide)
    __pow__, __mod__ = _operator(np.power)[0], _operator(np.remainder)[0]
    __ge__, __le__ = _operator(np.greater_equal)[0], _operator(np.less_equal)[0]
    __lt__, __gt__ = _operator(np.less)

    def __neg__(self) -> Dual:
        return _of(np.negative, self)

    def __abs__(self) -> Dual:
        return _of(np.absolute, self)


_NUMBERS = (Dual, float, int, np.ndarray, np.generic)


def _of(ufunc: np.ufunc, *inputs: Any) -> Dual:
    """The function of numbers of which one or both have derivatives."""
    values = [each.value if isinstance(each, Dual) else each for each in inputs]
    value = ufunc(*values)

    def slope() -> FloatArray:
        slopes = [
            each.slope if by_it is ONE else np.asarray(by_it)[..., None] * each.slope
            for each, by_it in zip(inputs, _SLOPES[ufunc](value, *values), strict=True)
            if isinstance(each, Dual)
        ]
        total: FloatArray = slopes[0] if len(slopes) == 1 else slopes[0] + slopes[1]
        return total

    return Dual(value, slope)


ONE = 1.0  # its product with a slope is that slope
# Derivatives of functions by each argument, from their value and arguments.
_SLOPES: dict[np.ufunc, Callable[..., tuple[Any, ...]]] = {
    np.add: lambda f, x, y: (ONE, ONE),
    np.subtract: lambda f, x, y: (ONE, -1.0),
    np.multiply: lambda f, x, y: (y, x),
    np.true_divide: lambda f, x, y: (1 / y, -f / y),
    np.negative: lambda f, x: (-1.0,),
    np.power: lambda f, x, y: (y * x ** (y - 1), 0.0),  # exponents are numbers
    np.square: lambda f, x: (2 * x,),
    np.sqrt: lambda f, x: (0.5 / f,),
    np.absolute: lambda f, x: (np.sign(x),),
    np.exp: lambda f, x: (f,),
    np.log: lambda f, x: (1 / x,),
    np.sin: lambda f, x: (np.cos(x),),
    np.cos: lambda f, x: (-np.sin(x),),
    np.arccos: lambda f, x: (-1 / np.sqrt(np.maximum(1 - x**2, 1e-12)),),
    np.arctan2: lambda f, y, x: (x / (x**2 + y**2), -y / (x**2 + y**2)),
    np.hypot: lambda f, x, y: (x / f, y / f),
    np.remainder: lambda f, x, y: (ONE, 0.0),  # by numbers
    np.sign: lambda f, x: (0.0,),
    **dict.fromkeys((np.greater_equal, np.less_equal, np.less), lambda f, x, y: (0.0, 0.0)),
    np.maximum: lambda f, x, y: (np.where(x >= y, 1.0, 0.0), np.where(x >= y, 0.0, 1.0)),
    np.minimum: lambda f, x, y: (np.where(x <= y, 1.0, 0.0), np.where(x <= y, 0.0, 1.0)),
}
