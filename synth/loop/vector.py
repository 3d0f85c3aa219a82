"""Plane vectors of arrays, numbers with derivatives, or symbols."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np


@dataclass(frozen=True, slots=True)
class Vector:
    """A plane vector; x and y are scalars, arrays, `Dual` or symbols.

    >>> (2 * Vector(3, 4) - Vector(1, 0).left).cross(Vector(1, 1))
    -1
    """

    __array_ufunc__: ClassVar[None] = None  # arrays leave products to `__rmul__`

    x: Any
    y: Any

    def __add__(self, other: Vector) -> Vector:
        return Vector(self.x + other.x, self.y + other.y)

    def __sub__(self, other: Vector) -> Vector:
        return Vector(self.x - other.x, self.y - other.y)

    def __neg__(self) -> Vector:
        return Vector(-self.x, -self.y)

    def __rmul__(self, factor: Any) -> Vector:
        return Vector(factor * self.x, factor * self.y)

    def __truediv__(self, divisor: Any) -> Vector:
        return Vector(self.x / divisor, self.y / divisor)

    def dot(self, other: Vector) -> Any:
        """Scalar product."""
        return self.x * other.x + self.y * other.y

    def cross(self, other: Vector) -> Any:
        """Component of the vector product across the plane."""
        return self.x * other.y - self.y * other.x

    def angle_to(self, other: Vector) -> Any:
        """From this vector to another, within half a turn, rad."""
        return np.arctan2(self.cross(other), self.dot(other))

    def turned(self, angle: Any) -> Vector:
        """Turned by an angle, counter-clockwise."""
        turned: Vector = np.cos(angle) * self + np.sin(angle) * self.left
        return turned

    @property
    def square(self) -> Any:
        """Square of the length."""
        return self.x**2 + self.y**2

    @property
    def left(self) -> Vector:
        """Turned by 90 deg, counter-clockwise."""
        return Vector(-self.y, self.x)
