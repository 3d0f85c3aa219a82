"""Four-bars as function generators: the output angle along a rotation of the driver, and its derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray

SHAPE = 4  # unknowns of a generator: the logarithms of r2, r3, r4, and the first driver angle


@dataclass(frozen=True, slots=True)
class Generators:
    """Four-bars on the ground O2 = 0, O4 = 1 with the driver angle at which they begin.

    The driver turns counter-clockwise from there.

    Parameters
    ----------
    shape : ndarray, shape (M, 4)
        Logarithms of r2, r3, r4, each over r1, and the first driver angle, rad.
    assembly : ndarray, shape (M,)
        Sign of sin(theta4 - theta3).

    Examples
    --------
    >>> one = Generators(np.array([[0.0, np.log(2), np.log(1.5), 0.3]]), np.array([1.0]))
    >>> one.lengths.round(9).tolist(), len(one)
    ([[1.0, 1.0, 2.0, 1.5]], 1)
    """

    shape: FloatArray
    assembly: FloatArray

    def __len__(self) -> int:
        return len(self.shape)

    def __getitem__(self, index: IntArray | BoolArray | slice) -> Generators:
        return Generators(self.shape[index], self.assembly[index])

    @property
    def finite(self) -> Generators:
        """Those whose numbers are finite."""
        return self[np.isfinite(self.shape.sum(axis=1))]

    @property
    def lengths(self) -> FloatArray:
        """r1, r2, r3, r4 over r1, shape (M, 4)."""
        return np.concatenate([np.ones((len(self), 1)), np.exp(self.shape[:, :3])], axis=1)

    @classmethod
    def of_pivots(cls, a: ComplexArray, b: ComplexArray) -> Generators:
        """Those with A and B at given places at the first driver angle, each of shape (M,)."""
        with np.errstate(divide="ignore"):
            sizes = np.log([np.abs(a), np.abs(b - a), np.abs(b - 1)])
        shape = np.stack([*sizes, np.angle(a)], axis=-1)
        return cls(shape, np.where(((b - a).conj() * (b - 1)).imag >= 0, 1.0, -1.0))

    @classmethod
    def joined(cls, several: list[Generators]) -> Generators:
        """All of several batches."""
        if not several:
            return cls(np.empty((0, SHAPE)), np.empty(0))
        shapes, signs = zip(*((each.shape, each.assembly) for each in several), strict=True)
        return cls(np.concatenate(shapes), np.concatenate(signs))


def output_angles(made: Generators, turned: FloatArray) -> FloatArray:
    """Output angle theta4, unwrapped along the rotation; NaN where the loop is open.

    Parameters
    ----------
    made : Generators
    turned : ndarray, shape (N,), rad
        Driver rotations from the first, growing; steps of the output are less than half a turn.

    Returns
    -------
    ndarray, shape (M, N), rad

    Notes
    -----
    In the triangle O4, A, B the angle at O4 follows from its sides (law of cosines); the assembly says
    on which side of O4A the link O4B lies.

    Examples
    --------
    A parallelogram turns its output as its driver:

    >>> one = Generators(np.array([[0.0, 0.0, 0.0, 1.0]]), np.array([1.0]))
    >>> output_angles(one, np.array([0.0, 0.5, 1.0])).round(9).tolist()
    [[1.0, 1.5, 2.0]]
    """
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        r2, r3, r4 = np.exp(made.shape[:, :3, None]).swapaxes(0, 1)
        seen = r2 * np.exp(1j * (made.shape[:, 3:] + turned)) - 1.0
        apart = np.abs(seen)
        cosine = (apart**2 + r4**2 - r3**2) / (2 * apart * r4)
        angle = np.angle(seen) - made.assembly[:, None] * np.arccos(cosine)
    unwrapped: FloatArray = np.unwrap(angle, axis=1)
    return unwrapped


def output_slopes(made: Generators, turned: FloatArray, theta4: FloatArray) -> FloatArray:
    """Derivatives of the output angle by the shape, shape (M, N, 4).

    Notes
    -----
    The loop r2 e2 + r3 e3 = 1 + r4 e4, differentiated and projected on e3, is linear in the rate of
    theta4.
    """
    r2, r3, r4 = np.exp(made.shape[:, :3, None]).swapaxes(0, 1)
    theta2 = made.shape[:, 3:] + turned
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        coupler = 1.0 + r4 * np.exp(1j * theta4) - r2 * np.exp(1j * theta2)
        along = (coupler / np.abs(coupler)).conj()
        driver, output = along * np.exp(1j * theta2), along * np.exp(1j * theta4)
        lever = -r4 * output.imag  # r4 sin(theta3 - theta4)
        slopes = [r2 * driver.real, np.broadcast_to(r3, theta2.shape), -r4 * output.real, -r2 * driver.imag]
        by_shape: FloatArray = np.stack(slopes, axis=-1) / lever[..., None]
    return by_shape


def closes(made: Generators, span: float) -> BoolArray:
    """Whether the loop stays closed, off dead positions, all over a rotation of the driver; shape (M,).

    Parameters
    ----------
    made : Generators
    span : float, rad
        The rotation from the first driver angle.
    """
    _, r3, r4 = np.exp(made.shape[:, :3]).T
    least, most = diagonals(made, span)
    closed: BoolArray = (least > np.abs(r3 - r4)) & (most < r3 + r4)
    return closed


def diagonals(made: Generators, span: float) -> tuple[FloatArray, FloatArray]:
    """Least and greatest distance A-O4 over a rotation from the first driver angle, each of shape (M,)."""
    r2, first = np.exp(made.shape[:, 0]), made.shape[:, 3]
    ends = np.abs(r2 * np.exp(1j * np.stack([first, first + span])) - 1.0)
    near, far = passes(first, span, 0.0), passes(first, span, np.pi)
    least = np.where(near, np.abs(1 - r2), ends.min(axis=0))
    return least, np.where(far, 1 + r2, ends.max(axis=0))


def passes(first: FloatArray, span: float, angle: float) -> BoolArray:
    """Whether a rotation from a first angle passes another one, whatever its whole turns."""
    inside: BoolArray = (angle - first) % (2 * np.pi) <= span
    return inside


def worst_cosine(made: Generators, span: float) -> FloatArray:
    """Greatest absolute cosine of the transmission angle over a rotation, shape (M,); above 1: open."""
    _, r3, r4 = np.exp(made.shape[:, :3]).T
    cosines = [(r3**2 + r4**2 - diagonal**2) / (2 * r3 * r4) for diagonal in diagonals(made, span)]
    worst: FloatArray = np.abs(cosines).max(axis=0)
    return worst
