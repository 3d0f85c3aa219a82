"""Placing of a cylinder with a known triangle: its base within its box, its pivot on link 2."""

from __future__ import annotations

import math

import numpy as np

from grashof.problems import Cylinder, Linkage
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits
from grashof.problems.values.box import Box
from grashof.synth.theory.functions.by_cylinder import ByCylinder
from grashof.synth.theory.functions.triangle import opening

_AROUND = 720  # directions of the base that are tried
_NEAR = 1e-7  # share of the distance by which a corner may be off the circle, as equal limits may


def distances(o2: tuple[float, float], base: Box) -> Limits:
    """Least and greatest distance of a base in its box from O2."""
    sides = [(low - at, high - at) for at, (low, high) in zip(o2, (base.x, base.y), strict=True)]
    least = math.hypot(*(max(low, -high, 0.0) for low, high in sides))
    return least, math.hypot(*(max(-low, high) for low, high in sides))


def placed_cylinder(
    batch: ByCylinder, driver: int, linkage: Linkage, direction: float, base: Box
) -> Cylinder | None:
    """The cylinder of one generator on its linkage, O2 as that has it; None where no base suits.

    `direction` is that from which driver angles count, rad. Any base at its distance is possible, since the
    pivot turns with it; the best is the one whose arm points to A.
    """
    far, arm, length = (each.item() for each in batch.triangle)
    opened = driver * float(opening(np.array(far), np.array(arm), np.array(length)))
    theta2 = direction + driver * float(batch.first[0])
    o2 = complex(*np.asarray(linkage.o2))
    out = _within(base, o2, far, theta2 - opened)
    if out is None:
        return None
    pivot = arm * np.exp(1j * (np.angle(out) + opened - theta2))
    at = o2 + out
    return Cylinder("driver", (at.real, at.imag), (float(pivot.real), float(pivot.imag)))


def _within(base: Box, o2: complex, far: float, wish: float) -> complex | None:
    """The place at a distance from O2 within a box, less O2, whose direction is nearest to a wish."""
    x, y = (np.array(side) - at for side, at in zip((base.x, base.y), (o2.real, o2.imag), strict=True))
    circle: ComplexArray = far * np.exp(1j * (wish + np.linspace(0, 2 * np.pi, _AROUND, endpoint=False)))
    corners = [complex(a, b) for a in x[np.isfinite(x)] for b in y[np.isfinite(y)]]
    corners = [each for each in corners if abs(abs(each) - far) <= _NEAR * far]
    tried = np.concatenate([circle, _crossings(x, far), 1j * _crossings(y, far), corners])
    inside = (
        (tried.real >= x[0] - _NEAR * far) & (tried.real <= x[1] + _NEAR * far)
        & (tried.imag >= y[0] - _NEAR * far) & (tried.imag <= y[1] + _NEAR * far)
    )  # fmt: skip
    if not inside.any():
        return None
    tried = tried[inside]
    nearest = complex(tried[np.argmin(np.abs(np.angle(tried * np.exp(-1j * wish))))])
    return complex(np.clip(nearest.real, *x), np.clip(nearest.imag, *y))


def _crossings(sides: FloatArray, far: float) -> ComplexArray:
    """Where a circle about zero crosses lines at these distances, along the real axis."""
    near = sides[np.abs(sides) <= far]
    beside = np.sqrt(far**2 - near**2)
    return np.asarray(np.concatenate([near + 1j * beside, near - 1j * beside]))


def triangle_of(cylinder: Cylinder, linkage: Linkage, theta2: float) -> FloatArray | None:
    """Logarithms of base, arm and length of a cylinder on link 2 at a driver angle; None of any other."""
    out = complex(*cylinder.base) - complex(*np.asarray(linkage.o2))
    pivot = complex(*cylinder.point)
    if cylinder.link != 2 or not (abs(out) > 0 and abs(pivot) > 0):
        return None
    length = abs(pivot * np.exp(1j * theta2) - out)
    return np.log([abs(out), abs(pivot), length]) if length > 0 else None
