"""Dyads of three poses with two of their four coordinates given: enclosures of the other two."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.proof.curve.pieces import WIDER
from grashof.synth.proof.forms.forms import Span, farthest
from grashof.synth.theory.burmester import Displacements

_PAIRS = np.array([(0, 1), (0, 2), (1, 2)])  # of poses
_MOST_SHIFT = 0.9  # of the matrix relative to itself, up to which its inverse is bounded


@dataclass(frozen=True, slots=True)
class Steps:
    """Steps of a dyad: of its moving pivot and of its ground pivot, shape (k, n) or what goes with it."""

    z: ComplexArray
    c: ComplexArray


@dataclass(frozen=True, slots=True)
class At:
    """Equations F = k - Re(conj(c) a) = 0, (k, n), at dyads: c is as far from two places of z."""

    alpha: ComplexArray  # derivative of `chord` by z
    facing: ComplexArray  # derivative of k is Re(facing dz)
    chord: ComplexArray  # a = alpha z + d, from one place to the other
    tilted: ComplexArray  # derivative of F is Re(tilted dz)
    value: FloatArray
    reach: FloatArray  # magnitude of the terms whose difference is `chord`, apart from z

    @classmethod
    def of(cls, motion: Displacements, z: ComplexArray, c: ComplexArray, rows: IntArray | None = None) -> At:
        """At dyads of three poses; of all three pairs of places, or of some, each shape (k, n)."""
        which = np.arange(3)[:, None] if rows is None else rows
        rho, d = motion.rotation[_PAIRS][which], motion.shift[_PAIRS][which]
        facings, squares = d.conj() * rho, np.abs(d) ** 2 / 2
        alpha, facing = rho[..., 1] - rho[..., 0], facings[..., 1] - facings[..., 0]
        chord = alpha * z + d[..., 1] - d[..., 0]
        value = squares[..., 1] - squares[..., 0] + (facing * z).real - (c.conj() * chord).real
        return cls(alpha, facing, chord, facing - c.conj() * alpha, value, np.abs(d).sum(axis=-1))

    def off(self, far_z: FloatArray, far_c: FloatArray) -> FloatArray:
        """Bound of the rounding error of F for z and c of these magnitudes."""
        off: FloatArray = WIDER * (self.reach + far_z) * (self.reach + 2 * far_c)
        return off

    def along(self, z: ComplexArray, c: ComplexArray) -> FloatArray:
        """Derivatives along a step."""
        along: FloatArray = (self.tilted * z).real - (c.conj() * self.chord).real
        return along

    def bent(self, z: ComplexArray, c: ComplexArray) -> FloatArray:
        """The contribution of the product of the steps of z and c."""
        bent: FloatArray = -(c.conj() * self.alpha * z).real
        return bent


@dataclass(frozen=True, slots=True)
class _Matrix:
    """Derivatives of both equations along two directions, shape (n,) each, and its inverse."""

    first: FloatArray  # shape (2, n): of both equations along the first direction
    second: FloatArray

    @classmethod
    def of(cls, at: At, bound: Steps) -> _Matrix:
        return cls(at.along(bound.z[0], bound.c[0]), at.along(bound.z[1], bound.c[1]))

    @property
    def det(self) -> FloatArray:
        det: FloatArray = self.first[0] * self.second[1] - self.second[0] * self.first[1]
        return det

    def solved(self, right: FloatArray) -> FloatArray:
        """Shares of both directions, shape (2, n)."""
        p = self.second[1] * right[0] - self.second[0] * right[1]
        q = self.first[0] * right[1] - self.first[1] * right[0]
        return np.stack([p, q]) / self.det

    def most(self, right: FloatArray) -> FloatArray:
        """Upper bound of the norm of both shares where each right-hand side is at most this large."""
        by_first = np.hypot(self.second[1], self.first[1]) * right[0]
        by_second = np.hypot(self.second[0], self.first[0]) * right[1]
        most: FloatArray = (by_first + by_second) / np.abs(self.det)
        return most


def enclosed(
    motion: Displacements,
    start: tuple[ComplexArray, ComplexArray],
    free: Steps,
    bound: Steps,
    off: FloatArray | float = 0.0,
    newton: int = 1,
) -> tuple[Span, Span, BoolArray]:
    """Moving and ground pivots of all dyads in rectangles of two coordinates, as forms of these.

    Of three poses: z and c, and where they are bounded, (n,); elsewhere they hold nothing. `start` holds z
    and c (n,) in the middle of a rectangle, the other two coordinates approximate; `free` (2, n) leads from
    there to the ends of a rectangle, one of z, or of c, along one axis of the other's plane. `bound` (2, n)
    are unit directions of the other two coordinates, zero in the pivot that they do not move, and `off` (n,)
    is how far these can be from `start`: it counts where they are of both pivots. Of the `newton` steps to
    the dyad in the middle one is enough where they are those of one pivot.

    As of pieces of a curve (see `centres_of`): both equations are bilinear in z and c, so that the remainder
    after the linear terms is a quadratic form of both parameters; over the norm of the inverse matrix it
    bounds the disc.
    """
    z, c = start
    begun = z, c
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        rows = _closest(motion, z, c, bound)
        for _ in range(newton):
            at = At.of(motion, z, c, rows)
            z, c = _moved(z, c, bound, -_Matrix.of(at, bound).solved(at.value))
        at = At.of(motion, z, c, rows)
        matrix = _Matrix.of(at, bound)
        shares = [-matrix.solved(at.along(free.z[k], free.c[k])) for k in (0, 1)]
        ends = [_moved(free.z[k], free.c[k], bound, shares[k]) for k in (0, 1)]
        steps = Steps(np.stack([z_step for z_step, _ in ends]), np.stack([c_step for _, c_step in ends]))
        squares = [at.bent(*end) for end in ends]
        z, c = _moved(z, c, bound, -matrix.solved(at.value + (squares[0] + squares[1]) / 2))
        at = At.of(motion, z, c, rows)
        matrix = _Matrix.of(at, bound)
        mixed = at.bent(ends[0][0], ends[1][1]) + at.bent(ends[1][0], ends[0][1])
        far_z, far_c = farthest(steps.z), farthest(steps.c)
        miss = np.abs(at.value + (squares[0] + squares[1]) / 2) + np.abs(mixed)
        miss = miss + sum(np.abs(at.along(*end)) for end in ends) + sum(np.abs(each) for each in squares) / 2
        miss = miss + at.off(np.abs(z) + far_z, np.abs(c) + far_c)
        moves_z, moves_c = (np.abs(each).max(axis=0) for each in (bound.z, bound.c))
        away = (
            off
            + np.abs(z - begun[0])
            + np.abs(c - begun[1])
            + sum(np.abs(each).sum(axis=0) for each in shares)
        )
        shift = np.abs(at.alpha) * (far_z * moves_c + far_c * moves_z + moves_z * moves_c * away / 2)
        loose = matrix.most(shift)
        rest = np.where(loose < _MOST_SHIFT, matrix.most(miss) / (1 - loose), np.inf) * (1 + WIDER)
        rest = rest + WIDER * (np.abs(z) + np.abs(c) + far_z + far_c)
    known = np.isfinite(rest) & np.isfinite(far_z) & np.isfinite(far_c)
    return (
        Span(z, steps.z, np.where(moves_z > 0, rest, WIDER * (np.abs(z) + far_z))),
        Span(c, steps.c, np.where(moves_c > 0, rest, WIDER * (np.abs(c) + far_c))),
        known,
    )


def _closest(motion: Displacements, z: ComplexArray, c: ComplexArray, bound: Steps) -> IntArray:
    """Two of three pairs of places, shape (2, n): about a pole only its own and another bound a dyad well."""
    at = At.of(motion, z, c)
    steep = sum(np.abs(at.along(bound.z[k], bound.c[k])) for k in (0, 1))
    return np.argsort(steep, axis=0)[:2]


def _moved(
    z: ComplexArray, c: ComplexArray, bound: Steps, shares: FloatArray
) -> tuple[ComplexArray, ComplexArray]:
    """Dyads, or steps, moved by shares of two directions."""
    return z + shares[0] * bound.z[0] + shares[1] * bound.z[1], c + shares[0] * bound.c[0] + shares[
        1
    ] * bound.c[1]
