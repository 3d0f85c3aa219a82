"""Linkages whose coupler passes points, as equations in joints and turns of the coupler.

Equations and unknowns are real and equal in number, so that where they have a zero, a real linkage passes all
points. They differ from those that such linkages are searched by (`grashof.synth.theory`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanism import DyadKind
from grashof.problems.values.linkages.mechanisms import closing_dyad

_ROUNDING = 32 * np.finfo(float).eps  # of the sum of the terms; no value takes more than ten operations
# The same of values, in extended precision where the machine has it; pairs of doubles are not relied on.
_FINE = 32 * max(float(np.finfo(np.longdouble).eps), 1e-19)


@dataclass(frozen=True, slots=True)
class Rows:
    """Equations at a place, and how they vary in a box about it."""

    value: FloatArray  # (n, E)
    rounding: FloatArray  # (n, E): error bound of the values
    slopes: FloatArray  # (n, E, K)
    spread: FloatArray  # (n, E, K): greatest difference of slopes in the box from these


@dataclass(frozen=True, slots=True)
class Turned:
    """Turns t = exp(i phi) of the coupler from the first of the points to the others."""

    less: ComplexArray  # (n, M): t - 1, as precise where t is near 1
    points: ComplexArray  # (M,), sizes, from the first
    radius: FloatArray  # (n, M), rad: greatest difference of phi


@dataclass(frozen=True, slots=True)
class Dyad:
    """The equations of a dyad at M points: by its own k unknowns and, last, by the turn at each."""

    value: FloatArray
    size: FloatArray  # sum of the absolute terms
    slopes: FloatArray  # (n, M, k + 1)
    spread: FloatArray


@dataclass(frozen=True, slots=True)
class PointEquations:
    """The equations of a kind of linkage that passes points."""

    points: ComplexArray  # (N,), sizes: the first at the origin; in extended precision, for values as precise
    kind: str  # of linkage

    def rows(self, unknowns: FloatArray, radius: FloatArray) -> Rows:
        """Equations at some places, and their variation in boxes about them, half as wide as `radius` (n, K).

        `unknowns` (n, K), sizes and rad, are O2 from the first point, A from the coupler point as it is
        there; of a four-bar the same of O4 and B, of a slider-crank B and the slide's direction, of an
        inverted one O4 and the rod's direction; then the coupler's turn from the first to each other point.
        E = K = 16 through nine points (four-bars), 14 through eight.
        """
        second, own = _SECOND[closing_dyad(self.kind)]
        points = self.points[1:]
        exact: FloatArray = np.asarray(unknowns, np.longdouble)
        half = exact[:, 4 + own :] / 2
        turned = Turned(2j * np.sin(half) * np.exp(1j * half), points, radius[:, 4 + own :])
        dyads = (
            _link(exact[:, :4], radius[:, :4], turned),
            second(exact[:, 4 : 4 + own], radius[:, 4 : 4 + own], turned),
        )
        value, size = (
            np.concatenate([getattr(x, name) for x in dyads], axis=1) for name in ("value", "size")
        )
        slopes, spread = (_joined(*(getattr(x, name) for x in dyads)) for name in ("slopes", "spread"))
        return Rows(*(np.asarray(part, np.float64) for part in (value, _FINE * size, slopes, spread)))


def _joined(crank: FloatArray, other: FloatArray) -> FloatArray:
    """Derivatives of two dyads (n, M, k + 1), each by its own unknowns and by the turns, as one matrix."""
    n, count, _ = crank.shape
    none, each = np.zeros, np.eye(count)
    own = crank.shape[2] - 1, other.shape[2] - 1
    upper = [crank[..., :-1], none((n, count, own[1])), crank[..., -1:] * each]
    lower = [none((n, count, own[0])), other[..., :-1], other[..., -1:] * each]
    return np.concatenate([np.concatenate(upper, axis=2), np.concatenate(lower, axis=2)], axis=1)


def _link(own: FloatArray, radius: FloatArray, turned: Turned) -> Dyad:
    """Equations of a joint at m, from the coupler point, that keeps its distance from a ground pivot o.

    (|q + t m - o|^2 - |m - o|^2) / 2 = |q|^2 / 2 - q.o + q.(t m) - o.((t - 1) m) with the point q.
    """
    q, less = turned.points, turned.less
    o, m = _complex(own[:, :2]), _complex(own[:, 2:])
    off_o, off_m = (np.hypot(*radius[:, i : i + 2].T)[:, None] for i in (0, 2))
    off_t = turned.radius
    moved, turn = less * m, less + 1
    far, near, arm, chord = np.abs(q - o), np.abs(q), np.abs(m), np.abs(less)
    value = _dot(q, q) / 2 - _dot(q, o) + _dot(q, turn * m) - _dot(o, moved)
    by_m = q * turn.conj() - o * less.conj()
    by_turn = -((q - o).conj() * turn * m).imag
    return Dyad(
        value,
        near**2 + near * (np.abs(o) + arm) + np.abs(o) * np.abs(moved),
        np.stack([*_parts(-(q + moved)), *_parts(by_m), by_turn], axis=-1),
        np.stack([
            *2 * [off_t * (arm + off_m) + chord * off_m + _ROUNDING * (near + np.abs(moved))],
            *2 * [off_t * (far + off_o) + chord * off_o + _ROUNDING * (near + np.abs(o) * chord)],
            far * (arm * off_t + off_m) + off_o * (arm + off_m) + _ROUNDING * (near + np.abs(o)) * arm,
        ], axis=-1),
    )  # fmt: skip


def _slide(own: FloatArray, radius: FloatArray, turned: Turned) -> Dyad:
    """Equations of a joint at m, from the coupler point, on a line: its path q + (t - 1) m is along it."""
    m, reach = _complex(own[:, :2]), np.hypot(*radius[:, :2].T)[:, None]
    return _line((m, reach), (own[:, 2:], radius[:, 2:]), turned, turned.less, turned.points, (m, reach), 1)


def _block(own: FloatArray, radius: FloatArray, turned: Turned) -> Dyad:
    """Equations of a ground pivot o that keeps its distance from a line of the coupler.

    As the coupler sees it, o goes by (conj(t) - 1) o - conj(t) q, along the line.
    """
    o, reach = _complex(own[:, :2]), np.hypot(*radius[:, :2].T)[:, None]
    less, lever = turned.less.conj(), (o - turned.points, reach)
    shift = -(less + 1) * turned.points
    return _line((o, reach), (own[:, 2:], radius[:, 2:]), turned, less, shift, lever, -1)


def _line(
    point: tuple[ComplexArray, FloatArray],
    angle: tuple[FloatArray, FloatArray],
    turned: Turned,
    less: ComplexArray,
    shift: ComplexArray,
    lever: tuple[ComplexArray, FloatArray],
    sense: int,
) -> Dyad:
    """Equations for way = (t - 1) x + shift along a line at an angle: its component across is zero.

    `point` is x and `angle` that of the line, each (n, 1) with its error bound; `less` and `shift` are
    (n, M) or (M,). Where `sense` is -1, t is conjugate. `lever`, of d way / dt = `sense` i t lever, comes
    with its error bound.
    """
    (x, off_x), (direction, off_angle), (arm, off_arm) = point, angle, lever
    across, off_t, chord = np.exp(-1j * direction), turned.radius, np.abs(less)
    way = across * (less * x + shift)
    size = np.abs(less * x) + np.abs(shift)
    by_x = 1j * (across * less).conj()
    slopes = [*_parts(by_x), -way.real, sense * (across * (less + 1) * arm).real]
    moved = off_t * (np.abs(arm) + off_arm) + chord * off_x
    spread = [
        *2 * [chord * off_angle + off_t + _ROUNDING * chord],
        off_angle * np.abs(way) + moved + _ROUNDING * size,
        (off_angle + off_t) * np.abs(arm) + off_arm + _ROUNDING * (np.abs(x) + np.abs(turned.points)),
    ]
    return Dyad(way.imag, size, np.stack(slopes, axis=-1), np.stack(spread, axis=-1))


_SECOND: dict[DyadKind, tuple[Callable[[FloatArray, FloatArray, Turned], Dyad], int]] = {
    DyadKind.RRR: (_link, 4),
    DyadKind.RRP: (_slide, 3),
    DyadKind.RPR: (_block, 3),
}


def enough_points(kind: str) -> int:
    """Number of points that determine linkages of a kind: as many equations as unknowns."""
    return 5 + _SECOND[closing_dyad(kind)][1]


def _complex(pairs: FloatArray) -> ComplexArray:
    """Points of shape (n, 2) as complex numbers, shape (n, 1)."""
    return pairs[:, :1] + 1j * pairs[:, 1:2]


def _parts(vector: ComplexArray) -> tuple[FloatArray, FloatArray]:
    return vector.real, vector.imag


def _dot(u: ComplexArray, v: ComplexArray) -> FloatArray:
    """Scalar product of plane vectors."""
    product: FloatArray = (u.conj() * v).real
    return product
