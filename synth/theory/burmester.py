"""Dyads of two to four poses: points of a body that stay on a circle through them, and their centres.

A dyad is a moving point z, given where it is at the first pose (a circle point), and a ground
pivot c at equal distance from all its positions (a centre point). Points are complex numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray

STRAIGHT = 1e-6  # longest chord / radius: on a flatter circle, three positions lie on a straight line
NO_PIVOT = complex(np.nan, np.nan)
_ROUNDING = 1e-14  # share of the coordinates below which two positions are one
_NOT_TURNED = 1e-9  # of unit rotations
_NEAR = 0.5  # sizes: within this distance of the origin the lines that trace curves are evenly spaced


@dataclass(frozen=True, slots=True)
class Displacements:
    """Rigid displacements z -> rotation * z + shift from the first pose to every pose.

    Parameters
    ----------
    rotation, shift : ndarray of complex, shape (N,)
        Unit rotations and shifts in length; 1 and 0 for the first pose.
    first_turn : float, rad
        Angle of the body in the first pose.
    """

    rotation: ComplexArray
    shift: ComplexArray
    first_turn: float = 0.0

    @classmethod
    def from_poses(cls, positions: ComplexArray, angles: FloatArray) -> Displacements:
        """Displacements of poses at `positions`, shape (N,), turned by `angles`, shape (N,), rad."""
        rotation = np.exp(1j * (angles - angles[0]))
        return cls(rotation, positions - rotation * positions[0], float(angles[0]))

    def inverse(self) -> Displacements:
        """Displacements of the ground as the body sees it: circle and centre points change places."""
        rotation = self.rotation.conj()
        return Displacements(rotation, -rotation * self.shift)

    @property
    def translates(self) -> bool:
        """Whether all poses are pure translations of the first."""
        return bool(np.abs(self.rotation - 1).max() < _NOT_TURNED)

    def pole(self, slack: float) -> complex | None:
        """The point about which all poses are turned, if none moves it farther than `slack`."""
        if self.translates:
            return None
        widest = int(np.argmax(np.abs(self.rotation - 1)))
        pole = complex(self.shift[widest] / (1 - self.rotation[widest]))
        moved = np.abs(self.apply(np.array([pole]))[0] - pole).max()
        return pole if moved < slack else None

    def apply(self, points: ComplexArray) -> ComplexArray:
        """Positions of body `points`, shape (...), at every pose; shape (..., N)."""
        return points[..., None] * self.rotation + self.shift


@dataclass(frozen=True, slots=True)
class Dyads:
    """Moving points at the first pose and their ground pivots, both shape (n,), complex."""

    moving: ComplexArray
    ground: ComplexArray

    def __len__(self) -> int:
        return len(self.moving)

    def __getitem__(self, index: IntArray | BoolArray) -> Dyads:
        return Dyads(self.moving[index], self.ground[index])


def circle_dyads(motion: Displacements, moving: ComplexArray) -> Dyads:
    """Dyads of three poses with given moving pivots (n,): the ground pivot is the centre of their circle.

    Moving pivots are those at the first pose. NaN where the three positions lie on a straight line, or two of
    them on one point: then no circle, or many, would do; ValueError where there are not three poses. The
    circumcentre of 0, a and b is i (a |b|^2 - b |a|^2) / (2 Im(conj(a) b)).
    """
    if motion.rotation.shape != (3,):
        raise ValueError(f"{len(motion.rotation)} poses; a circle needs three")
    return Dyads(moving, _circumcentres(motion.apply(moving)))


def circle_dyads_of_ground(motion: Displacements, ground: ComplexArray) -> Dyads:
    """Dyads of three poses with given ground pivots (n,): the reverse of `circle_dyads`.

    The moving pivot is NaN where the ground pivot, as the body sees it, lies on a straight line at the three
    poses, or twice on one point; ValueError where there are not three poses.
    """
    dyads = circle_dyads(motion.inverse(), ground)
    return Dyads(dyads.ground, dyads.moving)


def bisector_dyads(motion: Displacements, moving: ComplexArray, offset: FloatArray) -> Dyads:
    """Dyads of two poses with given moving pivots (n,): the ground pivot lies on the bisector of the chord.

    Moving pivots are those at the first pose. The ground pivot lies `offset` (n,) left of the middle of the
    chord, seen from the first position to the second, or right where that is negative; NaN where the moving
    pivot does not move. ValueError where there are not two poses.
    """
    if motion.rotation.shape != (2,):
        raise ValueError(f"{len(motion.rotation)} poses; a bisector needs two")
    first, second = np.moveaxis(motion.apply(moving), -1, 0)
    chord = second - first
    length = np.abs(chord)
    moves = length > _ROUNDING * (np.abs(first) + np.abs(second))
    across = 1j * chord / np.where(moves, length, 1)
    return Dyads(moving, np.where(moves, 0.5 * (first + second) + offset * across, NO_PIVOT))


def bisector_dyads_of_ground(motion: Displacements, ground: ComplexArray, offset: FloatArray) -> Dyads:
    """Dyads of two poses with given ground pivots (n,): the reverse of `bisector_dyads`.

    `offset` (n,) is that of the moving pivot from the chord along which the body, held at the first pose,
    sees the ground pivot pass; NaN where the ground pivot is the pole of the motion. ValueError where there
    are not two poses.
    """
    dyads = bisector_dyads(motion.inverse(), ground, offset)
    return Dyads(dyads.ground, dyads.moving)


def _circumcentres(positions: ComplexArray) -> ComplexArray:
    """Centres (n,) of the circles through three positions (n, 3); NaN where these determine none."""
    first = positions[:, 0]
    a, b = positions[:, 1] - first, positions[:, 2] - first
    sides = np.abs(np.stack([a, b, b - a]))
    twice_area = (a.conj() * b).imag
    # Of a triangle, radius = product of the sides / (4 area).
    round_ = 2 * np.abs(twice_area) * sides.max(axis=0) > STRAIGHT * sides.prod(axis=0)
    apart = sides.min(axis=0) > _ROUNDING * np.abs(positions).max(axis=1)
    defined = round_ & apart
    centre = first + 0.5j * (a * np.abs(b) ** 2 - b * np.abs(a) ** 2) / np.where(defined, twice_area, 1)
    return np.where(defined, centre, NO_PIVOT)


def circle_points_on_lines(motion: Displacements, origin: ComplexArray, along: complex) -> ComplexArray:
    """Every circle point (k,) of four poses on the lines `along` through `origin` (m,); up to three a line.

    The centre c of the circle through the positions z_j of z satisfies Re(conj(c) (z_j - z_1))
    = (|z_j|^2 - |z_1|^2) / 2, both sides linear in z; three such equations in two unknowns require a
    vanishing determinant, a cubic on every line (Burmester 1888; McCarthy & Soh, *Geometric Design of
    Linkages*, 2011, ch. 5).
    """
    turned, shift = motion.rotation[1:], motion.shift[1:]
    at_origin = (turned - 1) * origin[:, None] + shift
    step = (turned - 1) * along * np.ones_like(origin[:, None])
    half = 0.5 * np.abs(shift) ** 2 + (shift.conj() * turned * origin[:, None]).real
    half_step = (shift.conj() * turned * along).real * np.ones(half.shape)
    constant = np.stack([at_origin.real, at_origin.imag, half], axis=-1)
    slope = np.stack([step.real, step.imag, half_step], axis=-1)
    line, root = _real_roots(_determinant_cubic(constant, slope))
    points: ComplexArray = origin[line] + root * along
    return points


def centre_points(motion: Displacements, moving: ComplexArray) -> ComplexArray:
    """Centre (n,) of the circle that best carries each moving point (n,) through N >= 3 poses.

    Least squares over the N - 1 bisector equations; infinite for points on a straight line.
    """
    positions = motion.apply(moving)
    chord = positions[:, 1:] - positions[:, :1]
    half = 0.5 * (np.abs(positions[:, 1:]) ** 2 - np.abs(positions[:, :1]) ** 2)
    xx, yy, xy = (chord.real**2).sum(1), (chord.imag**2).sum(1), (chord.real * chord.imag).sum(1)
    x, y = (chord.real * half).sum(1), (chord.imag * half).sum(1)
    with np.errstate(divide="ignore", invalid="ignore"):
        centre: ComplexArray = (yy * x - xy * y + 1j * (xx * y - xy * x)) / (xx * yy - xy**2)
    return centre


def polish(motion: Displacements, dyads: Dyads, steps: int = 4) -> Dyads:
    """Dyads moved by the least amount that makes them exact, by Newton's method.

    Each step is the minimum-norm solution of the linearised equations |z_j - c|^2 = |z_1 - c|^2 in
    the four coordinates of z and c.
    """
    moving, ground = dyads.moving.copy(), dyads.ground.copy()
    for _ in range(steps):
        arm = motion.apply(moving) - ground[:, None]
        residual = 0.5 * (np.abs(arm[:, 1:]) ** 2 - np.abs(arm[:, :1]) ** 2)
        by_moving = motion.rotation[1:].conj() * arm[:, 1:] - arm[:, :1]
        by_ground = arm[:, :1] - arm[:, 1:]
        jacobian = np.stack([by_moving.real, by_moving.imag, by_ground.real, by_ground.imag], axis=-1)
        step = (np.linalg.pinv(jacobian) @ residual[..., None])[..., 0]
        moving -= step[:, 0] + 1j * step[:, 1]
        ground -= step[:, 2] + 1j * step[:, 3]
    return Dyads(moving, ground)


def radius_error(motion: Displacements, dyads: Dyads) -> FloatArray:
    """Largest less smallest distance from the ground pivot over all poses, shape (n,), length."""
    radius: FloatArray = np.abs(motion.apply(dyads.moving) - dyads.ground[:, None])
    error: FloatArray = radius.max(axis=1) - radius.min(axis=1)
    return error


def trace_four_pose_curves(
    motion: Displacements, reach: float, lines: int, cell: float, phase: float = 0.5
) -> Dyads:
    """Dyads spread evenly over the circle-point and centre-point curves of four poses.

    Lines in both directions through both planes meet the curves in all their points; of points that
    fall into the same cell one is kept. Lines and cells are even in asinh of the coordinates: as
    fine as `cell` near the poses, a share `cell` of the distance farther out.

    Parameters
    ----------
    motion : Displacements
        Of four poses, scaled so that the task has size 1 and lies about the origin.
    reach : float, sizes
        Distance from the origin up to which the planes are searched.
    lines : int
        Lines in each direction and plane.
    cell : float
        Spacing.
    phase : float
        Where the lines lie in their spacing, 0 to 1.

    Returns
    -------
    Dyads
    """
    even = (np.arange(lines) + phase) / lines * 2 - 1
    offsets = _NEAR * np.sinh(even * np.arcsinh(reach / _NEAR))
    found = []
    for seen_from_body in (False, True):
        displacements = motion.inverse() if seen_from_body else motion
        points = np.concatenate([
            circle_points_on_lines(displacements, offsets.astype(np.complex128), 1j),
            circle_points_on_lines(displacements, 1j * offsets, 1.0),
        ])  # fmt: skip
        points = points[np.abs(points) <= reach]
        centres = centre_points(displacements, points)
        found.append(Dyads(centres, points) if seen_from_body else Dyads(points, centres))
    dyads = Dyads(*(np.concatenate([getattr(d, side) for d in found]) for side in ("moving", "ground")))
    dyads = dyads[np.isfinite(dyads.ground) & np.isfinite(dyads.moving)]
    return dyads[_one_per_cell(dyads, cell)]


def _one_per_cell(dyads: Dyads, cell: float) -> IntArray:
    coordinates = np.stack([dyads.moving.real, dyads.moving.imag, dyads.ground.real, dyads.ground.imag])
    cells = np.floor(np.arcsinh(coordinates / _NEAR) * (_NEAR / cell)).astype(np.int64)
    return np.sort(np.unique(cells, axis=1, return_index=True)[1])


def _determinant_cubic(constant: FloatArray, slope: FloatArray) -> FloatArray:
    """Coefficients, constant first, of det(constant + s * slope) for 3x3 matrices (..., 3, 3)."""
    p, q = np.moveaxis(constant, -2, 0), np.moveaxis(slope, -2, 0)

    def triple(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
        product: FloatArray = np.vecdot(a, np.cross(b, c))
        return product

    return np.stack([
        triple(p[0], p[1], p[2]),
        triple(q[0], p[1], p[2]) + triple(p[0], q[1], p[2]) + triple(p[0], p[1], q[2]),
        triple(q[0], q[1], p[2]) + triple(q[0], p[1], q[2]) + triple(p[0], q[1], q[2]),
        triple(q[0], q[1], q[2]),
    ], axis=-1)  # fmt: skip


def _real_roots(cubic: FloatArray) -> tuple[IntArray, FloatArray]:
    """Row numbers and real roots of cubics (m, 4), constant first, by companion matrices."""
    scale = np.abs(cubic).max(axis=1, keepdims=True)
    rows = np.flatnonzero(scale[:, 0] > 0)
    cubic = cubic[rows] / scale[rows]
    # With a leading coefficient near zero one root runs to infinity: solve for its inverse instead.
    invert = np.abs(cubic[:, 3]) < np.abs(cubic[:, 0])
    monic = np.where(invert[:, None], cubic[:, ::-1], cubic)
    lead = np.where(monic[:, 3] == 0, 1e-300, monic[:, 3])
    companion = np.zeros((len(rows), 3, 3))
    companion[:, 1, 0] = companion[:, 2, 1] = 1.0
    companion[:, :, 2] = -monic[:, :3] / lead[:, None]
    good: BoolArray = np.all(np.isfinite(companion), axis=(1, 2))
    roots = np.linalg.eigvals(np.where(good[:, None, None], companion, 0.0)).astype(np.complex128)
    real = good[:, None] & (np.abs(roots.imag) <= 1e-6 * (1e-3 + np.abs(roots.real)))
    values = roots.real
    with np.errstate(divide="ignore"):
        values = np.where(invert[:, None], 1.0 / values, values)
    real &= np.isfinite(values)
    line, column = np.nonzero(real)
    return rows[line], _newton(cubic[line], values[line, column])


def _newton(cubic: FloatArray, root: FloatArray) -> FloatArray:
    c0, c1, c2, c3 = cubic.T
    for _ in range(2):
        value = c0 + root * (c1 + root * (c2 + root * c3))
        slope = c1 + root * (2 * c2 + root * 3 * c3)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = value / slope
        root = np.where(np.isfinite(step) & (np.abs(step) < 0.1 * (1 + np.abs(root))), root - step, root)
    return root
