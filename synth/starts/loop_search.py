"""Search for linkages whose coupler curve comes near given points: many at once, in NumPy.

Linkages, feasible by construction, are their proportions and driver angles at the points; place, size, turn
and coupler point are linear, P_i = z0 + z1 exp(i theta2_i) + z2 exp(i theta3_i), and solved for exactly
(variable projection, Golub & Pereyra 1973, with Kaufman's Jacobian). Levenberg-Marquardt improves the rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from grashof.problems import Rotatability
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.quantities.driver_motion import meeting_order
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Configurations, Screened, judge, violations_apart
from grashof.synth.starts.closed_loop import (
    PROPORTIONS,
    Batch,
    Leading,
    Loop,
    SearchTargets,
    body_turns,
    by_angles,
    by_body_turns,
    by_theta3_of,
)
from grashof.synth.starts.limit_residuals import Placement, oversteps
from grashof.synth.starts.torque_residuals import torque_residuals
from grashof.synth.theory.stopping import raise_if_overdue, stop_requested

# Consecutive steps that reduce the error by less than this share end the work on a linkage.
LOOK, STALL = 5, 1e-3
HEAVY = 1e4  # damping under which no step is worth trying
AHEAD, BENT = 0.1, 0.75  # share of a step at which its bend is measured; greatest share of a correction
DETOUR = (0.1, 1.5)  # driver rotation of a detour, as a share of all others
PULL = 0.03  # sizes of error that overstepping a limit by one unit counts as, where fit comes first

# Cost (n,), residuals (n, R), and their derivative by the unknowns (n, R, M), of a batch.
Model: TypeAlias = Callable[["Batch"], tuple[FloatArray, FloatArray, FloatArray]]


@dataclass(frozen=True, slots=True)
class Placed:
    """Linkages of a batch where they fit the points best, in the frame of the points."""

    error: FloatArray  # (n,), sizes^2, weighted sum of squared distances; infinite where no loop closes
    o2: ComplexArray  # (n,), as o4
    o4: ComplexArray
    a: ComplexArray  # (n, N), as b and p
    b: ComplexArray
    p: ComplexArray
    theta2: FloatArray  # (n, N), rad
    body_angle: FloatArray  # (n,), rad, from the coupler to the body; zero for a path

    def __getitem__(self, index: BoolArray | IntArray) -> Placed:
        return Placed(*(getattr(self, name)[index] for name in self.__slots__))

    def at_first(self, count: int) -> Placed:
        """The same at the first `count` points alone."""
        passed = {name: getattr(self, name)[:, :count] for name in ("a", "b", "p", "theta2")}
        return replace(self, **passed)


def draw(target: SearchTargets, count: int, rng: np.random.Generator, astray: float = 0.0) -> Batch:
    """Random linkages, feasible by construction; gaps between driver angles follow the points."""
    n = len(target.points)
    rotatability = target.wanted.rotatability
    proportions = target.kind.drawn(rng, count, anything=rotatability is Rotatability.ANY)
    columns = [proportions, rng.uniform(-np.pi, np.pi, (count, 1))]
    if not target.timed and target.wanted.order:
        gaps = drawn_gaps(target, count, rng)
        if astray:  # on that share P makes a detour between two targets
            rows, at = np.flatnonzero(rng.random(count) < astray), rng.integers(n - 1, size=count)
            share = rng.uniform(*DETOUR, count)
            gaps[rows, at[rows]] = np.log(share * np.exp(gaps).sum(axis=1))[rows]
        gaps -= np.log(np.exp(gaps).sum(axis=1, keepdims=True))
        low = 0.3 if rotatability is Rotatability.ANY else 0.03
        columns += [gaps, np.log(rng.uniform(low, 4, (count, 1)))]
    elif not target.timed:
        columns.append(rng.uniform(-np.pi, np.pi, (count, n - 1)))
    longer = {Rotatability.CRANK_ROCKER: 0.0, Rotatability.DOUBLE_CRANK: 1.0}.get(rotatability, 0.4)
    signs = rng.choice([-1.0, 1.0], (count, 1 if target.wanted.same_branch else n))
    if target.kind.dyad.one_assembly:
        signs = np.ones_like(signs)
    return Batch(
        unknowns=np.concatenate(columns, axis=1),
        longer_driver=rng.random(count) < longer,
        assembly=np.broadcast_to(signs, (count, n)),
        direction=rng.choice([-1.0, 1.0], count),
    )


def drawn_gaps(target: SearchTargets, count: int, rng: np.random.Generator) -> FloatArray:
    """Logarithms of random gaps between driver angles that follow the points, (count, N - 1)."""
    steps = target.steps
    gaps: FloatArray = np.log(steps / steps.sum()) * rng.uniform(0.3, 1, (count, 1))
    gaps += rng.normal(0, 0.4, (count, len(steps)))
    return gaps


def place(target: SearchTargets, batch: Batch) -> Placed:
    """The linkages of a batch, placed where they fit the points best."""
    loop = Loop.of(target, batch)
    z, _, _, error = project(target, loop)
    return _standing(target, loop, z, error)


def _standing(target: SearchTargets, loop: Loop, z: ComplexArray, error: FloatArray) -> Placed:
    """Linkages placed by given z0, z1, z2 (n, 3); `error` is that of the points alone."""
    z0, z1, z2 = z.T
    ground = z1 / loop.r2
    a = z0[:, None] + z1[:, None] * loop.e2
    o4, b = target.kind.placed(z0, ground, a, (loop.e3, loop.e4), loop.r4)
    turned, in_loop = body_turns(target, loop)
    return Placed(
        error=error + (turned**2).sum(axis=1),
        o2=z0,
        o4=o4,
        a=a,
        b=b,
        p=z0[:, None] + z1[:, None] * loop.e2 + z2[:, None] * loop.e3,
        theta2=loop.theta2 + np.angle(z1)[:, None],
        body_angle=in_loop - np.angle(z1) if target.has_angles else in_loop,
    )


def judged(scaled: ScaledProblem, target: SearchTargets, placed: Placed, direction: FloatArray) -> Screened:
    """Placed linkages and the violations of each."""
    a, b, theta2 = placed.a, placed.b, placed.theta2
    if scaled.problem.task.returns:
        a, b = (np.concatenate([points, points[:, :1]], axis=1) for points in (a, b))
        theta2 = np.concatenate([theta2, theta2[:, :1] + TURN * direction[:, None]], axis=1)
    visit = np.broadcast_to(np.arange(theta2.shape[1]), theta2.shape)
    if not target.wanted.order:
        visit, theta2, direction = meeting_order(theta2)
    p = placed.p[:, 0]
    found = Configurations(placed.o2, placed.o4, a, b, visit, theta2, direction, scaled.kind)
    violations = violations_apart(found, p, placed.p, scaled.wanted)
    error = np.sqrt(placed.error / len(scaled.targets))
    return fully_screened(scaled, judge(found, p, error, violations, scaled.wanted, placed.body_angle))


def improve(
    model: Model,
    batch: Batch,
    steps: int,
    tolerance: float,
    until: int = 1,
    missed: Callable[[Batch], FloatArray] | None = None,
) -> tuple[Batch, FloatArray]:
    """Levenberg-Marquardt on every linkage of a batch, and the errors (n,) in sizes squared.

    At most `steps`; stops as soon as `until` linkages have no greater error than `tolerance`, in sizes
    squared. For models see `fitting` and `WithinLimits`. With `missed`, the residuals alone, steps are
    bent along the valley (geodesic acceleration, Transtrum & Sethna 2012), which pays where it is narrow.
    """
    raise_if_overdue()
    result = replace(batch, unknowns=batch.unknowns.copy())
    error, residual, jacobian = model(batch)
    damping, marked, least = np.full(len(batch), 1e-2), error, error.copy()
    rows = np.arange(len(batch))
    for number in range(1, steps + 1):
        step = _step(residual, jacobian, damping)
        if missed is not None:
            step = _bent(batch, step, residual, jacobian, damping, missed)
        tried = replace(batch, unknowns=batch.unknowns + step)
        new_error, new_residual, new_jacobian = model(tried)
        better = new_error < error
        batch = replace(batch, unknowns=np.where(better[:, None], tried.unknowns, batch.unknowns))
        error = np.where(better, new_error, error)
        residual = np.where(better[:, None], new_residual, residual)
        new_jacobian[~better] = jacobian[~better]
        jacobian = new_jacobian
        damping = np.clip(np.where(better, damping * 0.3, damping * 5), 1e-14, 1e6)
        result.unknowns[rows], least[rows] = batch.unknowns, error
        if np.count_nonzero(least <= tolerance) >= until or stop_requested():
            break
        if number % LOOK == 0:
            untried = (error == marked) & (damping < HEAVY)  # all too far: shorter steps may do
            going = (error < (1 - STALL) * marked) | untried
            if not going.any():
                break
            rows, batch, damping, marked = rows[going], batch[going], damping[going], error[going]
            error, residual, jacobian = error[going], residual[going], jacobian[going]
    return result, least


def _step(residual: FloatArray, jacobian: FloatArray, damping: FloatArray) -> FloatArray:
    """Damped Gauss-Newton step of every linkage, (n, M); none where the numbers are not finite."""
    transposed = np.swapaxes(jacobian, 1, 2)
    normal, slope = transposed @ jacobian, (transposed @ residual[..., None])[..., 0]
    one = np.eye(normal.shape[1])
    diagonal = np.einsum("sii->si", normal)
    ridge = damping[:, None] * (diagonal + 1e-12 * diagonal.max(axis=1, keepdims=True) + 1e-300)
    normal = normal + ridge[..., None] * one
    sound = np.isfinite(normal).all(axis=(1, 2)) & np.isfinite(slope).all(axis=1)
    normal[~sound], slope[~sound] = one, 0.0
    step: FloatArray = np.clip(-np.linalg.solve(normal, slope[..., None])[..., 0], -1.5, 1.5)
    return step


def _bent(
    batch: Batch,
    step: FloatArray,
    residual: FloatArray,
    jacobian: FloatArray,
    damping: FloatArray,
    missed: Callable[[Batch], FloatArray],
) -> FloatArray:
    """Steps with their second-order correction, where that is shorter by `BENT`."""
    beside = missed(replace(batch, unknowns=batch.unknowns + AHEAD * step))
    bend = 2 / AHEAD * ((beside - residual) / AHEAD - (jacobian @ step[..., None])[..., 0])
    second = _step(bend, jacobian, damping) / 2
    scale = np.sqrt(np.einsum("srm,srm->sm", jacobian, jacobian))
    far, near = (np.linalg.norm(scale * each, axis=1) for each in (second, step))
    bent: FloatArray = step + np.where((far < BENT * near)[:, None], second, 0.0)
    return bent


def project(
    target: SearchTargets, at: Leading
) -> tuple[ComplexArray, ComplexArray, ComplexArray, FloatArray]:
    """Best z0, z1, z2 (n, 3), the QR factors of what they span (n, N, 3) and (n, 3, 3), and the error."""
    root = np.sqrt(target.weights)
    basis = np.stack([np.ones_like(at.along), at.origin, at.along], axis=-1) * root[:, None]
    q, r = np.linalg.qr(np.where(at.closes[:, None, None], basis, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.swapaxes(q.conj(), 1, 2) @ (target.points * root)
        z = back_substituted(r, share)
        residual = target.points * root - (q @ share[..., None])[..., 0]
        error = (np.abs(residual) ** 2).sum(axis=1)
    sound = at.closes & np.isfinite(error) & np.isfinite(z).all(axis=1)
    return z, q, r, np.where(sound, error, np.inf)


def back_substituted(r: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Solution of r x = right for upper triangular r (n, 3, 3); right (n, 3) or (n, 3, M)."""
    r = r if right.ndim == 2 else r[..., None]
    z2 = right[:, 2] / r[:, 2, 2]
    z1 = (right[:, 1] - r[:, 1, 2] * z2) / r[:, 1, 1]
    z0 = (right[:, 0] - r[:, 0, 1] * z1 - r[:, 0, 2] * z2) / r[:, 0, 0]
    return np.stack([z0, z1, z2], axis=1)


def fitting(target: SearchTargets) -> Model:
    """The error of linkages that are placed best, with a light pull towards the limits."""

    def model(batch: Batch) -> tuple[FloatArray, FloatArray, FloatArray]:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            loop = Loop.of(target, batch)
            z, q, r, error = project(target, loop)
            by_theta2 = by_angles(target, batch)
            by_theta3 = by_theta3_of(loop, by_theta2)
            residual, by_p = missed_places(target, loop, z, by_theta2, by_theta3)
            slope = by_p[:, 0] + 1j * by_p[:, 1]
            share = np.swapaxes(q.conj(), 1, 2) @ slope
            slope -= q @ share
            by_p[:, 0], by_p[:, 1] = slope.real, slope.imag
            at = Placement(target, loop, by_theta2, by_theta3, z, -back_substituted(r, share))
            return _joined(target, at, residual, by_p, PULL, error)

    return model


@dataclass(frozen=True, slots=True)
class WithinLimits:
    """The error, also in torque, under limits, of batches with places among the unknowns (`with_places`).

    Overstepping a limit by one unit counts as an error of `weight`, in sizes.
    """

    target: SearchTargets
    weight: float

    def __call__(self, batch: Batch) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Squared errors (n,), misses (n, R) and their derivatives (n, R, M)."""
        target = self.target
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            loop, z = _loop_and_places(target, batch)
            n, width = batch.unknowns.shape
            by_theta2 = by_angles(target, batch, places=PLACES)
            by_theta3 = by_theta3_of(loop, by_theta2)
            by_z = np.zeros((n, 3, width), dtype=np.complex128)
            for k in range(3):
                by_z[:, k, width - PLACES + 2 * k], by_z[:, k, width - PLACES + 2 * k + 1] = 1, 1j
            residual, by_p = missed_places(target, loop, z, by_theta2, by_theta3)
            root = np.sqrt(target.weights)
            for k, spanned in enumerate((np.ones_like(loop.e2), loop.e2, loop.e3)):
                for own, each in enumerate((root * spanned, 1j * root * spanned), width - PLACES + 2 * k):
                    by_p[:, 0, :, own], by_p[:, 1, :, own] = each.real, each.imag
            at = Placement(target, loop, by_theta2, by_theta3, z, by_z)
            error = _squared(loop, residual)
            cost, missed, by_unknowns = _joined(target, at, residual, by_p, self.weight, error)
            if target.torque is None:
                return cost, missed, by_unknowns
            misses, by_misses = torque_residuals(target, at, batch)
            return (
                cost + (misses**2).sum(axis=1),
                np.concatenate([missed, misses], axis=1),
                np.concatenate([by_unknowns, by_misses], axis=1),
            )

    def errors(self, batch: Batch) -> FloatArray:
        """Squared errors alone."""
        return _squared(*self._misses(batch))

    def missed(self, batch: Batch) -> FloatArray:
        """The misses alone."""
        return self._misses(batch)[1]

    def _misses(self, batch: Batch) -> tuple[Loop, FloatArray]:
        target = self.target
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            loop, z = _loop_and_places(target, batch)
            none = np.zeros((*loop.theta2.shape, PROPORTIONS))  # derivatives that nobody asks for
            by_z = np.zeros((len(z), 3, PROPORTIONS), dtype=np.complex128)
            at = Placement(target, loop, none, none, z, by_z)
            residual, (turned, _) = _to_points(target, loop, z), body_turns(target, loop)
            over, misses = oversteps(target, at)[0], torque_residuals(target, at, batch)[0]
            parts = [residual.real, residual.imag, turned, self.weight * over, misses]
            return loop, np.concatenate(parts, axis=1)


PLACES = 6  # unknowns that place a linkage: real and imaginary parts of z0, z1, z2


def with_places(target: SearchTargets, batch: Batch) -> Batch:
    """A batch with z0, z1, z2 as six more unknowns, where the linkages fit the points best."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        z, _, _, error = project(target, Loop.of(target, batch))
    sound = np.isfinite(error)
    parts = np.stack([z.real, z.imag], axis=-1).reshape(len(batch), PLACES)
    return replace(batch, unknowns=np.concatenate([batch.unknowns, parts], axis=1))[sound]


def standing(target: SearchTargets, batch: Batch) -> Placed:
    """The linkages of a batch with places, as placed."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        loop, z = _loop_and_places(target, batch)
        return _standing(target, loop, z, _squared(loop, _to_points(target, loop, z)))


def _to_points(target: SearchTargets, loop: Loop, z: ComplexArray) -> ComplexArray:
    """From P to the points, weighted (n, N)."""
    root = np.sqrt(target.weights)
    return (target.points - z[:, :1] - z[:, 1:2] * loop.e2 - z[:, 2:] * loop.e3) * root


def _squared(loop: Loop, missed: FloatArray | ComplexArray) -> FloatArray:
    """Sum of squares (n,); infinite where a loop does not close."""
    return np.where(loop.closes, (np.abs(missed) ** 2).sum(axis=1), np.inf)


def _loop_and_places(target: SearchTargets, batch: Batch) -> tuple[Loop, ComplexArray]:
    loop = Loop.of(target, replace(batch, unknowns=batch.unknowns[:, :-PLACES]))
    parts = batch.unknowns[:, -PLACES:].reshape(len(batch), 3, 2)
    return loop, parts[..., 0] + 1j * parts[..., 1]


def missed_places(
    target: SearchTargets, loop: Loop, z: ComplexArray, by_theta2: FloatArray, by_theta3: FloatArray
) -> tuple[ComplexArray, FloatArray]:
    """From P to the points, weighted (n, N), and the derivative of P with z held (n, 2, N, M): x, then y."""
    root = np.sqrt(target.weights)
    turned2, turned3 = z[:, 1:2] * loop.e2, z[:, 2:] * loop.e3
    slope = np.empty((len(z), 2, *by_theta2.shape[1:]))
    ahead2, ahead3 = 1j * root * turned2, 1j * root * turned3
    for axis, (by2, by3) in enumerate(((ahead2.real, ahead3.real), (ahead2.imag, ahead3.imag))):
        np.multiply(by2[..., None], by_theta2, out=slope[:, axis])
        slope[:, axis] += by3[..., None] * by_theta3
    return _to_points(target, loop, z), slope


def _joined(
    target: SearchTargets,
    at: Placement,
    residual: ComplexArray,
    by_p: FloatArray,
    weight: float,
    error: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Points, turns of the body and limits as one model; `by_p` is the derivative of P, (n, 2, N, M)."""
    over, by_over = oversteps(target, at)
    turned, _ = body_turns(target, at.loop)
    both = np.concatenate([residual.real, residual.imag, turned, weight * over], axis=1)
    by_turned = by_body_turns(target, at.by_theta3)
    many, unknowns = 2 * residual.shape[1], by_p.shape[3]
    jacobian = np.empty((*both.shape, unknowns))
    np.negative(by_p.reshape(len(both), many, unknowns), out=jacobian[:, :many])
    jacobian[:, many : many + turned.shape[1]] = by_turned
    np.multiply(weight, by_over, out=jacobian[:, many + turned.shape[1] :])
    cost: FloatArray = error + (turned**2).sum(axis=1) + weight**2 * (over**2).sum(axis=1)
    return cost, both, jacobian
