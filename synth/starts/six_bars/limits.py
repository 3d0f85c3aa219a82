"""Six-bars of a search as the formulas of limited quantities see them, with derivatives."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from grashof.problems.values.arrays import ComplexArray
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.formulas import View
from grashof.synth.starts.six_bars.carried import Along, Carried, Columns, Placing
from grashof.synth.starts.six_bars.shapes import Shapes


class SixBarView(View):
    """Six-bars of a batch where they stand, or of length 1 on the real axis without a place.

    O4 = O2 + g, all lengths of the shape are times |g|, and P is z2 along its link from the origin of that.
    """

    def __init__(
        self, shapes: Shapes, at: Carried, placing: Placing | None, columns: Columns | None = None
    ) -> None:
        self._at, self._columns, row = at, columns or at.unknowns, shapes.mechanism
        self.o2, self._ground, self.ap = self._places(placing)
        self.r1 = np.hypot(self._ground.x, self._ground.y)
        for name in row.lengths[1:]:
            setattr(self, name, self.r1 * self._number(at.made.given[name]))
        self.o4, self.theta1 = self.o2 + self._ground, np.arctan2(self._ground.y, self._ground.x)
        bar = row.loops[-1].bars[row.carries - row.loops[-1].links[0]]
        self.bp = self.ap - self._number(at.made.given[bar]) * self._ground
        theta2 = Dual(at.unknowns.theta2, lambda: self._columns.by_angle)
        first, last = theta2.column(0), theta2.column(-1)
        self.theta2_start, self.direction = self.theta1 + first, at.direction[:, None]
        self.driver_turn = np.abs(last - first)

    def _places(self, placing: Placing | None) -> tuple[Vector, ...]:
        """O2, g and z2."""
        if placing is not None:
            return _vectors(placing.z, lambda: placing.by_z)
        count, width = len(self._at.direction), self._columns.count
        z = np.tile(np.array([0j, 1, 0]), (count, 1))
        return _vectors(z, lambda: np.zeros((count, 3, width), dtype=np.complex128))

    def _number(self, each: Dual) -> Dual:
        """A dimension with derivatives by all unknowns."""
        return Dual(each.value, lambda: self._columns.slope(each.slope))

    @cached_property
    def a(self) -> Vector:  # type: ignore[override]
        """A at every target."""
        return self._standing(self._at.a)

    @cached_property
    def b(self) -> Vector:  # type: ignore[override]
        """B at every target."""
        return self._standing(self._at.b)

    def _standing(self, of_shape: Along) -> Vector:
        """A point of the shape where the linkage stands."""
        x = Dual(of_shape.value.real, lambda: of_shape.by(self._columns).real)
        y = Dual(of_shape.value.imag, lambda: of_shape.by(self._columns).imag)
        placed: Vector = self.o2 + x * self._ground + y * self._ground.left
        return placed


def _vectors(z: ComplexArray, by_z: Callable[[], ComplexArray]) -> tuple[Vector, ...]:
    """Columns of complex numbers (n, K) with derivatives (n, K, M), as vectors (n, 1)."""

    def vector(k: int) -> Vector:
        x = Dual(z[:, [k]].real, lambda: by_z()[:, [k]].real)
        return Vector(x, Dual(z[:, [k]].imag, lambda: by_z()[:, [k]].imag))

    return tuple(map(vector, range(z.shape[1])))
