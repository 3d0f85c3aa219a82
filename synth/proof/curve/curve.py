"""The circle-point curve of four poses as a polynomial, with its exact Taylor series, and the poles.

The origin is the guided point at the first pose, lengths are in sizes, points are complex. A point z of
the body at the first pose is at ``rotation[j] * z + shift[j]`` at pose j.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray
from grashof.synth.theory.burmester import Displacements

PLANE = 1e-9  # of its terms: below it a polynomial vanishes, and every point is a circle point
_POSES = 4
_PARALLEL = 1e-4  # between unit rotations: poles of such poses are far away
_ROUNDING = 64 * np.finfo(float).eps  # of the magnitude of a sum of some thirty terms


@dataclass(frozen=True, slots=True)
class Taylor:
    """The polynomial about some points q, in a frame turned by a direction t: f(q + t (x + iy)), arrays (n,).

    f = 2 Re(cubic w) |w|^2 + 2 Re(square w^2) + both |w|^2 + 2 Re(linear w) + value with w = x + iy.
    """

    cubic: ComplexArray
    square: ComplexArray
    both: FloatArray
    linear: ComplexArray
    value: FloatArray  # at the point
    error: FloatArray  # bound of the rounding error of `value`

    @property
    def along_twice(self) -> FloatArray:
        """Coefficient of x^2."""
        return self.both + 2 * self.square.real

    def turned(self, direction: ComplexArray) -> Taylor:
        """The same in a frame turned by unit numbers, shape (n,)."""
        return Taylor(
            self.cubic * direction, self.square * direction**2, self.both, self.linear * direction,
            self.value, self.error,
        )  # fmt: skip

    def beyond_linear(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Greatest sum of the terms of second and third order where ``|w.real| <= x``, ``|w.imag| <= y``."""
        return np.abs(self.along_twice) * x * x + self.beyond_parabola(x, y)

    def beyond_parabola(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """The same without that of x^2."""
        across: FloatArray = np.abs(self.both - 2 * self.square.real) * y * y
        mixed = 4 * np.abs(self.square.imag) * x * y
        third = 2 * (np.abs(self.cubic.real) * x + np.abs(self.cubic.imag) * y) * (x * x + y * y)
        return across + mixed + third


@dataclass(frozen=True, slots=True)
class Curve:
    """Circle points of four poses: where a cubic vanishes."""

    # `rotation` and `shift`, (4,), are displacements from the first pose, 1 and 0 for itself
    rotation: ComplexArray
    shift: ComplexArray
    # `cubic` to `constant`: of the polynomial about the origin, see `Taylor`; its largest coefficient is 1
    cubic: complex
    square: complex
    both: float
    linear: complex
    constant: float
    degenerate: bool  # whether the polynomial vanishes: every point of the plane is a circle point

    @classmethod
    def of(cls, motion: Displacements, point: complex) -> Curve:
        """The curve of four displacements of the body, seen from a point of it at the first pose.

        For three poses every point is a circle point. z_j - z = alpha_j z + d_j with alpha_j = rho_j - 1, and
        (|z_j|^2 - |z|^2) / 2 = |d_j|^2 / 2 + Re(conj(d_j) rho_j z): three equations Re(conj(c) (z_j - z)) =
        (|z_j|^2 - |z|^2) / 2 require the determinant of these columns to vanish, which is i/2 times that of
        [z_j - z, its conjugate, half the difference of squares] (Burmester 1888; McCarthy & Soh, *Geometric
        Design of Linkages*, ch. 5).
        """
        rotation = motion.rotation
        shift = motion.apply(np.array([point]))[0] - point
        if len(rotation) < _POSES:
            return cls(rotation, shift, 0j, 0j, 0.0, 0j, 0.0, degenerate=True)
        alpha, d, half = rotation[1:] - 1, shift[1:], 0.5 * np.abs(shift[1:]) ** 2
        beta = 0.5 * d.conj() * rotation[1:]
        columns = alpha, alpha.conj(), d, d.conj(), beta, beta.conj(), half + 0j
        names = "a", "A", "d", "D", "b", "B", "e"
        column = dict(zip(names, columns, strict=True))

        def det(chosen: str) -> complex:
            return 0.5j * complex(np.linalg.det(np.stack([column[name] for name in chosen], axis=1)))

        terms = (
            det("aAb"),
            det("aDb"),
            (det("aAe") + det("aDB") + det("dAb")).real,
            det("aDe") + det("dDb"),
            det("dDe").real,
        )
        sizes = [float(np.prod([np.abs(column[name]).max() for name in name3]))
                 for name3 in ("aAb", "aDb", "aAe", "aDe", "dDb", "dDe")]  # fmt: skip
        largest = max(abs(term) for term in terms)
        degenerate = largest <= PLANE * max(sizes)
        scale = 1.0 if degenerate else largest
        cubic, square, both, linear, constant = (term / scale for term in terms)
        return cls(rotation, shift, cubic, square, float(both.real), linear, float(constant.real), degenerate)

    def about(self, q: ComplexArray) -> Taylor:
        """The polynomial about points, shape (n,), in the frame of the plane."""
        square_q = (q * q.conj()).real
        along = 2 * (self.cubic * q).real
        value = along * square_q + 2 * (self.square * q * q).real + self.both * square_q
        value += 2 * (self.linear * q).real + self.constant
        size = np.abs(q)
        magnitude = ((2 * abs(self.cubic) * size + 2 * abs(self.square) + abs(self.both)) * size) * size
        magnitude += 2 * abs(self.linear) * size + abs(self.constant)
        return Taylor(
            cubic=np.broadcast_to(np.complex128(self.cubic), q.shape),
            square=self.square + self.cubic * q.conj(),
            both=self.both + 2 * along,
            linear=self.linear
            + along * q.conj()
            + self.cubic * square_q
            + 2 * self.square * q
            + self.both * q.conj(),
            value=value,
            error=_ROUNDING * (1.0 + magnitude),
        )

    def onto(self, points: ComplexArray, steps: int = 3) -> ComplexArray:
        """Points moved to the curve along the gradient, by Newton's method."""
        for _ in range(steps):
            taylor = self.about(points)
            slope = taylor.linear
            with np.errstate(divide="ignore", invalid="ignore"):
                step = taylor.value * slope.conj() / (2 * np.abs(slope) ** 2)
            points = np.where(np.isfinite(step), points - step, points)
        return points


def poles(motion: Displacements) -> tuple[IntArray, ComplexArray]:
    """Pairs of poses, shape (n, 2), and the points in one place at both, where they are at the first.

    >>> motion = Displacements.from_poses(np.array([1, 1j, -1]), np.radians([0, 90, 90]))
    >>> pairs, places = poles(motion)
    >>> pairs.tolist(), bool(np.allclose(places, [0, -1j]))
    ([[0, 1], [0, 2]], True)
    """
    pairs, places = [], []
    for i, j in combinations(range(len(motion.rotation)), 2):
        turn, move = motion.rotation[j] - motion.rotation[i], motion.shift[j] - motion.shift[i]
        if abs(turn) > _PARALLEL:
            pairs.append((i, j))
            places.append(-move / turn)
    return np.array(pairs, dtype=np.int64).reshape(-1, 2), np.array(places, dtype=np.complex128)
