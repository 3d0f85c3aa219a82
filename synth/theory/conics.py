"""Where two conics meet: all four points of the projective plane, real or not."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray

SAME = 1e-6  # sine of the angle between two points (as vectors): below it they are one
CONVERGED = 1e-9  # length of a step of Newton's method on unit vectors
TINY = 1e-15  # replaces a coefficient that vanishes


def conic_intersections(first: FloatArray, second: FloatArray) -> ComplexArray:
    """The four points (m, 4, 3) common to each pair of conics p^T Q p = 0, Q symmetric, (m, 3, 3).

    Unit vectors; points where the conics touch are there as often as they count, near each other to the
    square root of rounding. Without meaning where the conics share a line or are one.

    Of the pencil of conics that the two span, one has no x^2 and so gives x as a quotient of polynomials in
    y; another then requires a root of a quartic in y. Newton's method on the two conics makes the points
    exact. Coordinates are turned first, by a fixed rotation, so that no special place (y = infinity, two
    points with one y) is likely; where four different points are not found, by another.
    """
    points = np.empty((len(first), 4, 3), np.complex128)
    pending = np.arange(len(first))
    for turn in _TURNS:
        one, other = (turn.T @ conic[pending] @ turn for conic in (first, second))
        found, settled = _newton(one, other, _by_quartic(one, other))
        points[pending] = found @ turn.T
        pending = pending[~(settled & _different(found))]
        if not len(pending):
            break
    return points


def nearest_real(points: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Real points (..., 3) next to complex unit vectors (..., 3), and the distance of those from real, (...).

    The latter is the norm of the imaginary part after the common phase that makes it least, 0 to sqrt(1/2).

    >>> nearest_real(np.array([[0.6j, 0.8j, 0.0], [0.6, 0.8j, 0.0]]))[1].round(12)
    array([0. , 0.6])
    """
    phase = np.exp(-0.5j * np.angle((points * points).sum(axis=-1)))
    turned = points * phase[..., None]
    imaginary: FloatArray = np.sqrt((turned.imag**2).sum(axis=-1))
    return turned.real, imaginary


def _rotation(first: float, second: float, third: float) -> FloatArray:
    """Turns about z, x and z again, in rad."""

    def about_z(angle: float) -> FloatArray:
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])

    cycle = np.roll(np.eye(3), 1, axis=0)
    turned: FloatArray = about_z(first) @ cycle @ about_z(second) @ cycle.T @ about_z(third)
    return turned


_TURNS = (_rotation(0.7, 1.1, 2.3), _rotation(2.9, 0.8, 0.4), _rotation(1.7, 1.9, 5.2))


def _by_quartic(first: FloatArray, second: FloatArray) -> ComplexArray:
    """The common points (m, 4, 3), to the accuracy of the roots of a quartic."""
    xx1, xx2 = first[:, 0, 0], second[:, 0, 0]
    xx = np.hypot(xx1, xx2)
    share1, share2 = (
        np.where(xx > 0, part / np.where(xx > 0, xx, 1), 1)[:, None, None] for part in (xx1, xx2)
    )
    square, linear = share1 * first + share2 * second, share1 * second - share2 * first  # in x^2; in x
    slope, rest = _in_y(linear)
    square_slope, square_rest = _in_y(square)
    quartic = (
        xx[:, None] * _product(rest, rest)
        - _product(_product(square_slope, slope), rest)
        + _product(_product(slope, slope), square_rest)
    )
    y = _roots(quartic)
    divisor = slope[:, :1] + y * slope[:, 1:]
    divisor = np.where(np.abs(divisor) < TINY, TINY, divisor)
    x = -(rest[:, :1] + y * (rest[:, 1:2] + y * rest[:, 2:])) / divisor
    points = np.stack([x, y, np.ones_like(x)], axis=-1)
    return points / _norm(points)[..., None]


def _in_y(conic: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coefficients in y of x (linear) and of x^0 (quadratic), constant first, at points (x, y, 1)."""
    with_x = np.stack([2 * conic[:, 0, 2], 2 * conic[:, 0, 1]], axis=-1)
    without = np.stack([conic[:, 2, 2], 2 * conic[:, 1, 2], conic[:, 1, 1]], axis=-1)
    return with_x, without


def _product(left: FloatArray, right: FloatArray) -> FloatArray:
    """Products of polynomials, constant first, shape (m, degree + 1)."""
    product = np.zeros((len(left), left.shape[1] + right.shape[1] - 1))
    for power in range(left.shape[1]):
        product[:, power : power + right.shape[1]] += left[:, power : power + 1] * right
    return product


def _roots(quartic: FloatArray) -> ComplexArray:
    """Roots (m, 4) of quartics (m, 5), constant first, by companion matrices."""
    scale = np.abs(quartic).max(axis=1, keepdims=True)
    quartic = quartic / np.where(scale > 0, scale, 1)
    lead = np.where(np.abs(quartic[:, 4:]) < TINY, TINY, quartic[:, 4:])
    companion = np.zeros((len(quartic), 4, 4))
    companion[:, [1, 2, 3], [0, 1, 2]] = 1.0
    companion[:, :, 3] = -quartic[:, :4] / lead
    return np.linalg.eigvals(companion).astype(np.complex128)


def _newton(
    first: FloatArray, second: FloatArray, points: ComplexArray, steps: int = 3
) -> tuple[ComplexArray, BoolArray]:
    """Points made exact, each step at a right angle to the point; and which sets (m,) have converged."""
    size = np.full(points.shape[:2], np.inf)
    for _ in range(steps):
        gradient1, gradient2 = points @ first, points @ second  # half of it
        value1, value2 = ((gradient * points).sum(axis=-1) / 2 for gradient in (gradient1, gradient2))
        conjugate = points.conj()
        determinant = (conjugate * _cross(gradient1, gradient2)).sum(axis=-1)
        singular = np.abs(determinant) < 1e-30
        step = value1[..., None] * _cross(gradient2, conjugate) + value2[..., None] * _cross(
            conjugate, gradient1
        )
        step = step / np.where(singular, np.inf, determinant)[..., None]
        size = np.where(singular, 1.0, _norm(step))
        points = points - step
        points = points / _norm(points)[..., None]
        if (size < CONVERGED).all():  # the next step would be its square
            break
    converged: BoolArray = np.all(size < CONVERGED, axis=1)
    return points, converged


def _different(points: ComplexArray) -> BoolArray:
    """Which sets (m,) have four points that all differ."""
    sine = _norm(_cross(points[:, _PAIRS[0]], points[:, _PAIRS[1]]))
    apart: BoolArray = np.all(sine > SAME, axis=1)
    return apart


_PAIRS = np.triu_indices(4, 1)


def _cross(a: ComplexArray, b: ComplexArray) -> ComplexArray:
    """Cross product over the last axis; several times as fast as `numpy.cross` on many vectors."""
    product = np.empty_like(a)
    for x, (y, z) in enumerate(((1, 2), (2, 0), (0, 1))):
        product[..., x] = a[..., y] * b[..., z] - a[..., z] * b[..., y]
    return product


def _norm(vectors: ComplexArray) -> FloatArray:
    norm: FloatArray = np.sqrt((vectors.real**2 + vectors.imag**2).sum(axis=-1))
    return norm
