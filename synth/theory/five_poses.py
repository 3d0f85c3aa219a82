"""Burmester's dyads: all (at most four) that carry a body exactly through five poses.

Where the ground pivot is at infinity the moving pivot keeps to a straight guide; where the moving pivot is, a
guide in the body keeps to a ground pivot.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.theory.burmester import Displacements, Dyads
from grashof.synth.theory.conics import conic_intersections, nearest_real

FAR = 1e6  # lengths: a pivot farther away is at infinity
DEFICIENT = 1e-10  # independent share of four unit equations, below which they do not determine the dyads
NEARLY_REAL = 1e-5  # imaginary part of a root that a real dyad may still be found beside
EXACT = 1e-12  # radius error of a real dyad, as a share of the coordinates it is computed from
ROUNDING = 2e-16  # likewise: nothing is left to gain
SAME = 1e-6  # share of the coordinates by which two dyads differ


@dataclass(frozen=True, slots=True)
class Guides:
    """Dyads with one pivot at infinity: a joint that keeps to a straight guide; arrays (n,)."""

    pivot: ComplexArray  # length: the joint, a moving point, where it is at the first pose, or a ground point
    along: ComplexArray  # unit direction of the guide through the joint, either way, at the first pose
    in_body: BoolArray  # the guide is cut into the body, the joint fixed to the ground; otherwise the reverse

    def __len__(self) -> int:
        return len(self.pivot)


def five_pose_dyads(motion: Displacements, reach: float = FAR) -> Dyads:
    """All dyads, up to four, that carry a body exactly through five poses.

    In no particular order; one that the poses determine twice is there once. Pivots farther than `reach` from
    the origin are at infinity: see `five_pose_guides`. None where a family of dyads does it: two equal
    poses (a curve of them, see `trace_four_pose_curves`), pure translation, pure rotation. Not reliable where
    a family of guides does it (the motion of a trammel, all of whose circle is guided). The method is that of
    `five_pose_dyads_of_sets`. ValueError where there are not five poses.
    """
    batch = five_pose_dyads_of_sets(motion.rotation[None], motion.shift[None], reach)
    return Dyads(batch.moving[0], batch.ground[0])[np.isfinite(batch.moving[0])]


def five_pose_dyads_of_sets(rotation: ComplexArray, shift: ComplexArray, reach: float = FAR) -> Dyads:
    """All dyads, with pivots (m, 4), of many sets of five displacements from the first pose, (m, 5).

    NaN for dyads that are not real or have a pivot farther than `reach` from the origin, for all four of a
    set that does not determine them, and of one with numbers that are not finite. ValueError where the sets
    are not of five poses.

    |r_j z + s_j - c|^2 = |z - c|^2 is linear in w = conj(c) z, z, c and a number h = 1: four equations in
    seven real numbers leave a projective plane of them, in which w h = conj(c) z are two conics. They meet in
    four points, each a dyad (Burmester 1888; the linear form: McCarthy & Soh, *Geometric Design of Linkages*,
    2011, ch. 5), h = 0 for one that has a pivot at infinity. A root is real when Newton's method finds a real
    dyad beside it that meets the equations to rounding; so roots that are double but for rounding count as
    real, and once.
    """
    frames = _Frames.of(rotation, shift)
    return frames.outward(_exact(frames, frames.real_roots(), reach / frames.length))


def five_pose_guides(motion: Displacements, reach: float = FAR) -> Guides:
    """Joints that keep to a straight guide through five poses: dyads with one pivot at infinity.

    None for most poses; ValueError where there are not five. A pivot farther than `reach` from the origin is
    at infinity: the joint leaves its guide by no more than the sagitta of an arc of that radius.
    """
    frames = _Frames.of(motion.rotation[None], motion.shift[None])
    roots, limit = frames.real_roots()[0], reach / frames.length[0]
    _, moving, ground, unit = _parts(roots)
    roots = roots[np.maximum(np.abs(moving), np.abs(ground)) > limit * np.abs(unit)]
    w, moving, ground, _ = _parts(roots)
    in_body = np.abs(moving) > np.abs(ground)
    far = np.where(in_body, moving, ground)
    pivot, across = np.where(in_body, (w / far).conj(), w / far.conj()), far / np.abs(far)
    turned, shift = frames.rotation[0], frames.shift[0]
    in_ground = turned * pivot[:, None] + shift
    seen_from_body = turned.conj() * (pivot[:, None] - shift)
    chords = np.where(in_body[:, None], seen_from_body, in_ground) - pivot[:, None]
    off = np.abs((across.conj()[:, None] * chords).real).max(axis=1)
    straight = (np.abs(pivot) <= limit) & (off <= (1 + np.abs(pivot)) ** 2 / limit)
    outward = pivot * frames.length[0] + frames.origin[0]
    return Guides(outward[straight], 1j * across[straight], in_body[straight])


@dataclass(frozen=True, slots=True)
class _Frames:
    """Sets of displacements, each about the point that moves least and scaled by its displacement."""

    origin: ComplexArray  # (m,), length
    length: FloatArray  # (m,), length
    rotation: ComplexArray  # (m, 5)
    shift: ComplexArray  # (m, 5), in this origin and length

    @classmethod
    def of(cls, rotation: ComplexArray, shift: ComplexArray) -> _Frames:
        """The frames of displacements, shape (m, 5)."""
        if rotation.shape != shift.shape or rotation.ndim != 2 or rotation.shape[1] != 5:
            raise ValueError(
                f"rotation {rotation.shape} and shift {shift.shape}: five poses a set are needed"
            )
        finite = (np.isfinite(rotation) & np.isfinite(shift)).all(axis=1, keepdims=True)
        rotation, shift = np.where(finite, rotation, 1), np.where(finite, shift, 0)
        turn = rotation - 1
        # The small number keeps the origin near where turns are too small to locate it.
        origin = -(turn.conj() * shift).sum(axis=1) / ((np.abs(turn) ** 2).sum(axis=1) + 1e-4)
        about = shift + turn * origin[:, None]
        length = np.abs(about).max(axis=1) + 1e-3 * np.abs(shift).max(axis=1)
        length = np.where(length > 0, length, 1)
        return cls(origin, length, rotation, about / length[:, None])

    def outward(self, dyads: Dyads) -> Dyads:
        """Dyads (m, 4) of these frames in the frame of the poses."""
        scale, origin = self.length[:, None], self.origin[:, None]
        return Dyads(dyads.moving * scale + origin, dyads.ground * scale + origin)

    def real_roots(self) -> FloatArray:
        """Real solutions (m, 4, 7) in w, z, c (both coordinates) and h; NaN where there are none."""
        basis, settled = _plane(self._equations())
        w_x, w_y, z_x, z_y, c_x, c_y, unit = np.moveaxis(basis[settled], 1, 0)
        first = _form(w_x, unit) - _form(c_x, z_x) - _form(c_y, z_y)
        second = _form(w_y, unit) - _form(c_x, z_y) + _form(c_y, z_x)
        points, imaginary = nearest_real(conic_intersections(first, second))
        points[imaginary > NEARLY_REAL] = np.nan
        roots = np.full((len(basis), 4, 7), np.nan)
        roots[settled] = points @ basis[settled].transpose(0, 2, 1)
        return roots

    def _equations(self) -> FloatArray:
        """Coefficients (m, 4, 7), by w, z, c and h, of the equal distances: unit rows."""
        turned, shift = self.rotation[:, 1:], self.shift[:, 1:]
        by_w, by_moving, by_ground = turned - 1, -shift.conj() * turned, shift.conj()
        pairs = [part for by in (by_w, by_moving, by_ground) for part in (by.real, -by.imag)]
        rows = np.stack([*pairs, -0.5 * np.abs(shift) ** 2], axis=-1)
        norm = np.sqrt((rows**2).sum(axis=-1, keepdims=True))
        unit: FloatArray = rows / np.where(norm > 0, norm, 1)
        return unit


def _plane(equations: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Orthonormal bases (m, 7, 3) of their solutions, and whether (m,) these have no more dimensions."""
    q, r = np.linalg.qr(equations.transpose(0, 2, 1), mode="complete")
    settled: BoolArray = np.abs(r.diagonal(axis1=1, axis2=2)).min(axis=1) > DEFICIENT
    return q[:, :, 4:], settled


def _form(left: FloatArray, right: FloatArray) -> FloatArray:
    """Symmetric matrices (m, 3, 3) of products of linear forms (m, 3)."""
    product = left[:, :, None] * right[:, None, :]
    return 0.5 * (product + product.transpose(0, 2, 1))


def _parts(roots: FloatArray) -> tuple[ComplexArray, ComplexArray, ComplexArray, FloatArray]:
    """w, z, c and h of solutions (..., 7)."""
    w, moving, ground = (roots[..., k] + 1j * roots[..., k + 1] for k in (0, 2, 4))
    return w, moving, ground, roots[..., 6]


def _exact(frames: _Frames, roots: FloatArray, reach: FloatArray) -> Dyads:
    """Different exact dyads (m, 4) in their frames from roots (m, 4, 7), within a reach (m,)."""
    _, moving, ground, unit = _parts(roots)
    limit = reach[:, None] * np.abs(unit)
    chosen, slot = np.nonzero((limit > 0) & (np.abs(moving) <= limit) & (np.abs(ground) <= limit))
    h = unit[chosen, slot]
    start = Dyads(moving[chosen, slot] / h, ground[chosen, slot] / h)
    dyads, error = _polish(frames.rotation[chosen], frames.shift[chosen], start)
    good = error <= EXACT * (1 + np.abs(dyads.moving) + np.abs(dyads.ground))
    exact = Dyads(*(np.full(unit.shape, complex(np.nan, np.nan)) for _ in range(2)))
    exact.moving[chosen[good], slot[good]] = dyads.moving[good]
    exact.ground[chosen[good], slot[good]] = dyads.ground[good]
    return _each_once(exact)


def _polish(
    rotation: ComplexArray, shift: ComplexArray, dyads: Dyads, steps: int = 3
) -> tuple[Dyads, FloatArray]:
    """Dyads (k,), each of displacements of its own (k, 5), made exact; and their radius errors (k,).

    Newton's method, with only the steps that reduce the error; the dyads of a double root, where the
    equations are singular, move little.
    """
    turned, shift = rotation[:, 1:], shift[:, 1:]
    moving, ground = dyads.moving, dyads.ground
    residual, error, jacobian = _unequal(turned, shift, moving, ground)
    for _ in range(steps):
        if (error <= ROUNDING * (1 + np.abs(moving) + np.abs(ground))).all():
            break
        norm = np.sqrt((jacobian**2).sum(axis=1, keepdims=True))
        scaled = jacobian / np.where(norm > 0, norm, 1)
        transposed = scaled.transpose(0, 2, 1)
        normal = transposed @ scaled + _DAMPING
        step = np.linalg.solve(normal, transposed @ residual[..., None])[..., 0]
        step = step / np.where(norm > 0, norm, 1)[:, 0]
        tried = moving - (step[:, 0] + 1j * step[:, 1]), ground - (step[:, 2] + 1j * step[:, 3])
        after = _unequal(turned, shift, *tried)
        gain = after[1] < error
        moving, ground = (np.where(gain, new, old) for new, old in zip(tried, (moving, ground), strict=True))
        residual = np.where(gain[:, None], after[0], residual)
        error = np.where(gain, after[1], error)
        jacobian = np.where(gain[:, None, None], after[2], jacobian)
    return Dyads(moving, ground), error


_DAMPING = 1e-14 * np.eye(4)  # a singular system stays solvable


def _unequal(
    turned: ComplexArray, shift: ComplexArray, moving: ComplexArray, ground: ComplexArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Half differences of squared radii (k, 4), the radius error (k,), the Jacobian (k, 4, 4)."""
    chord = (turned - 1) * moving[:, None] + shift
    arm = (moving - ground)[:, None]
    residual = (chord.conj() * (arm + 0.5 * chord)).real
    by_moving = turned.conj() * (arm + chord) - arm
    jacobian = np.stack([by_moving.real, by_moving.imag, -chord.real, -chord.imag], axis=-1)
    radius = np.abs(arm[:, 0])
    error = np.abs(residual).max(axis=1) / np.where(radius > 0, radius, 1e-30)
    return residual, error, jacobian


def _each_once(dyads: Dyads) -> Dyads:
    """Dyads (m, 4) without duplicates."""
    same = np.tri(4, k=-1, dtype=np.bool_)  # of each with an earlier one
    for side in (dyads.moving, dyads.ground):
        gap = np.abs(side[:, :, None] - side[:, None, :])
        same = same & (gap <= SAME * (1 + np.abs(side[:, None, :])))
    again = same.any(axis=2)
    return Dyads(*(np.where(again, complex(np.nan, np.nan), side) for side in (dyads.moving, dyads.ground)))
