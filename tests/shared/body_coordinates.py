"""An independent judge of linkages: bodies, pins and slots between them, and one driver.

A moving link is a body with three coordinates: the position of its frame's origin and its direction. The
constraints between the bodies are one vector, `gap`, from which all else follows: its Jacobian and the rates
by Taylor series, positions by Newton's method along the motion, forces as multipliers. It shares no formula
with the package, and only `body_plans` uses its value types.

A plan is a batch of K linkages of one kind. Positions have the shape (..., K, 3n) for n moving bodies,
points and forces (..., K, 2); links are numbered as in the package, 1 is the ground.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import factorial
from typing import Any

import numpy as np
from body_plans import Array, Complexes, Plan, complex_of

CONVERGED = 1e-12  # correction of Newton's method, in rad or sizes of the linkage
NEAR = 0.05  # share of a step that the first correction has to stay below
MOST_STEP = 0.1  # rad, of the driver
MOST_MOVE = 0.5  # of any body, in rad or sizes of the linkage: near a dead position tangents lead far away
LEAST_STEP = 1e-7  # rad; a driver that cannot move by it is in a dead position
MOST_FALL = np.log(4.0)  # of the determinant's logarithm in a step


# --- Series: the first axis of an array is the power of the time or step that a coefficient belongs to.


def _unit(angle: Array) -> Complexes:
    """Series of e^(i angle)."""
    found = np.zeros(angle.shape, dtype=complex)
    found[0] = np.exp(1j * angle[0])
    for k in range(1, len(angle)):
        found[k] = 1j / k * sum(j * angle[j] * found[k - j] for j in range(1, k + 1))
    return found


def _product(first: Any, second: Any) -> Any:
    return np.stack([sum(first[j] * second[k - j] for j in range(k + 1)) for k in range(len(first))])


def _frames(q: Array) -> tuple[Complexes, Complexes, Array]:
    """Series of origin, direction and angle of each body, the ground first; shape (orders, ..., K, n + 1)."""
    bodies = q.reshape(*q.shape[:-1], q.shape[-1] // 3, 3)
    bodies = np.concatenate([np.zeros_like(bodies[..., :1, :]), bodies], axis=-2)
    return bodies[..., 0] + 1j * bodies[..., 1], _unit(bodies[..., 2]), bodies[..., 2]


def gap(plan: Plan, q: Array, theta: Any) -> Array:
    """Series of the residuals of the constraints, the driver's last; shape (orders, ..., K, 3n).

    `q` and `theta`, the driver's angle, are series, too.
    """
    origin, unit, angle = _frames(q)
    body = np.array(plan.bodies) - 1
    z = origin[..., body] + plan.at * unit[..., body]
    first, second = np.array([pin[1:] for pin in plan.pins]).T
    apart = z[..., first] - z[..., second]
    rows = [apart.real, apart.imag]
    for _, point, line, number in plan.slots:
        along = unit[..., body[line]] * np.exp(1j * plan.angles[:, number])
        rows.append(_product(along.conj(), z[..., point] - z[..., line]).imag[..., None])
    for _, one, other, number in plan.turned:
        turn = angle[..., one - 1] - angle[..., other - 1]
        turn[0] -= plan.angles[:, number]
        rows.append(turn[..., None])
    driver = angle[..., 1].copy()
    driver -= theta
    return np.concatenate([*rows, driver[..., None]], axis=-1)


def jacobian(plan: Plan, q: Array) -> Array:
    """Derivatives of the gap by the coordinates, shape (..., K, 3n, 3n)."""
    origin, unit, _ = (part[0] for part in _frames(q[None]))
    body = np.array(plan.bodies) - 1
    arm, count, rows = plan.at * unit[..., body], len(plan.pins), np.arange(len(plan.pins))
    z = origin[..., body] + arm
    found = np.zeros((*q.shape, q.shape[-1] + 3))  # by the coordinates of the ground, too
    for end, sign in ((1, 1.0), (2, -1.0)):
        points = np.array([pin[end] for pin in plan.pins])
        columns = 3 * body[points]
        found[..., rows, columns] += sign
        found[..., count + rows, columns + 1] += sign
        found[..., rows, columns + 2] -= sign * arm[..., points].imag
        found[..., count + rows, columns + 2] += sign * arm[..., points].real
    for row, (_, point, line, number) in enumerate(plan.slots, 2 * count):
        back = (unit[..., body[line]] * np.exp(1j * plan.angles[:, number])).conj()
        for place, sign in ((point, 1.0), (line, -1.0)):
            for k, move in enumerate((1, 1j, 1j * arm[..., place])):
                found[..., row, 3 * body[place] + k] += sign * (back * move).imag
        found[..., row, 3 * body[line] + 2] -= (back * (z[..., point] - z[..., line])).real
    for row, (_, one, other, _) in enumerate(plan.turned, 2 * count + len(plan.slots)):
        found[..., row, 3 * one - 1] += 1
        found[..., row, 3 * other - 1] -= 1
    found[..., -1, 5] = 1
    return found[..., 3:]


def margins(plan: Plan, q: Array) -> Array:
    """Distance of each loop from a dead position, with the sign of its assembly; shape (..., K, loops).

    For three pins twice the triangle's area over the two links' lengths, positive where the joint lies left
    of the line from the first end to the second; with a slide the distance of the joint along it over the
    length of the rod, or over the distance from the block's pivot.
    """
    origin, unit, _ = _frames(q[None])
    body = np.array(plan.bodies) - 1
    z, found = (origin[..., body] + plan.at * unit[..., body])[0], []
    for slot, tail, tip, joint in plan.sides:
        way, line = z[..., joint] - z[..., tail], z[..., tip] - z[..., tail]
        if slot < 0:
            found.append((line.conj() * way).imag / np.abs(way * (way - line)))
        else:
            _, _, through, number = plan.slots[slot]
            along = unit[0][..., body[through]] * np.exp(1j * plan.angles[:, number])
            found.append((along.conj() * way).real / np.abs(line))
    return np.stack(found, axis=-1)


def _solve(matrix: Array, right: Array) -> Array:
    """Solutions of a batch of equations; NaN where they have none."""
    try:
        return np.linalg.solve(matrix, right[..., None])[..., 0]
    except np.linalg.LinAlgError:
        singular = (_determinant(matrix)[0] == 0)[..., None]
        safe = np.where(singular[..., None], np.eye(matrix.shape[-1]), matrix)
        return np.where(singular, np.nan, np.linalg.solve(safe, right[..., None])[..., 0])


@np.errstate(invalid="ignore", divide="ignore")
def _determinant(matrix: Array) -> tuple[Array, Array]:
    """Sign and logarithm."""
    sign, log = np.linalg.slogdet(matrix)
    return sign, log


# --- Positions


def _length(plan: Plan, change: Array) -> Array:
    """Greatest change of a coordinate, in rad or sizes of the linkage; shape (K,)."""
    parts = np.abs(change).reshape(*change.shape[:-1], -1, 3)
    return np.maximum(parts[..., 2], parts[..., :2].max(axis=-1) / plan.size[:, None]).max(axis=-1)


def newton(plan: Plan, q: Array, theta: Array, most: int, turn: float = np.inf) -> tuple[Array, Array]:
    """Positions from guesses, NaN without convergence, and the sizes of the first corrections.

    No correction turns a body by more than `turn`. Shapes (K, 3n) and (K,).
    """
    q, first, lost = q.copy(), np.full(len(q), np.nan), np.ones(len(q), dtype=bool)
    on = np.arange(len(q))
    for count in range(most):
        sub = plan.taken(on)
        change = -_solve(jacobian(sub, q[on]), gap(sub, q[on][None], theta[on][None])[0])
        size, most_turned = _length(sub, change), np.abs(change[:, 2::3]).max(axis=-1)
        q[on] += change * np.minimum(1, turn / np.maximum(most_turned, 1e-300))[:, None]
        if count == 0:
            first = size
        lost[on[size < CONVERGED]] = False
        on = on[size >= CONVERGED]  # not where it is NaN
        if not len(on):
            break
    q[lost] = np.nan
    return q, first


def start(plan: Plan, theta: Any, seed: int = 0, guesses: int = 200) -> Array:
    """Positions at driver angles on the plan's assemblies, from random guesses; NaN where all fail.

    Shape (K, 3n).
    """
    rng = np.random.default_rng(seed)
    count, width = len(plan.size), 3 * plan.moving
    theta = np.broadcast_to(np.asarray(theta, dtype=float), (count,))
    found, on = np.full((count, width), np.nan), np.arange(count)
    for _ in range(guesses):
        sub = plan.taken(on)
        q, _ = newton(sub, rng.uniform(-np.pi, np.pi, (len(on), width)), theta[on], 20, turn=1.5)
        met = (np.sign(margins(sub, q)) == sub.signs).all(axis=-1)
        found[on[met]] = q[met]
        on = on[~met]
        if not len(on):
            break
    return found


@dataclass
class _Trace:
    """A batch of motions: the positions passed by each, the last one, and the dead position ahead."""

    passed: list[tuple[Array, Array, Array]]  # motion, driver angle, position
    q: Array
    dead: Array  # (K,), NaN where the end was reached


@np.errstate(invalid="ignore", divide="ignore")
def _advance(plan: Plan, q: Array, here: Array, there: Array) -> _Trace:
    """Follow motions from driver angles to others, or to dead positions.

    A tangent predicts, Newton's method corrects. A step is accepted if the first correction is small relative
    to it and the determinant keeps its sign and a quarter of its size; it is halved otherwise. Near a dead
    position the square of the determinant is linear in the driver angle, so the last two steps give its zero.
    """
    q, here, step = q.copy(), here.copy(), np.clip(there - here, -MOST_STEP, MOST_STEP)
    passed = [(np.arange(len(q)), here.copy(), q.copy())]
    matrix = jacobian(plan, q)
    sign, log = _determinant(matrix)
    before, log_before, dead = here.copy(), log.copy(), np.where(sign == 0, here, np.nan)
    driver = np.eye(q.shape[-1])[-1]
    going = np.isfinite(q).all(axis=-1) & (step != 0) & (sign != 0)
    while going.any():
        on = np.flatnonzero(going)
        sub, rest = plan.taken(on), there[on] - here[on]
        last = np.abs(step[on]) >= np.abs(rest)
        way, aim = np.where(last, rest, step[on]), np.where(last, there[on], here[on] + step[on])
        move = _solve(matrix[on], np.broadcast_to(driver, q[on].shape)) * way[:, None]
        met, first = newton(sub, q[on] + move, aim, 8)
        met_matrix = jacobian(sub, met)
        met_sign, met_log = _determinant(met_matrix)
        far = _length(sub, move)
        share = first / (NEAR * far + CONVERGED)
        good = (share < 1) & (far < MOST_MOVE) & (met_sign == sign[on]) & (met_log > log[on] - MOST_FALL)
        yes, no = on[good], on[~good]
        before[yes], log_before[yes] = here[yes], log[yes]
        q[yes], here[yes], log[yes], matrix[yes] = met[good], aim[good], met_log[good], met_matrix[good]
        passed.append((yes, aim[good], met[good]))
        step[yes], step[no] = way[good] * np.clip(0.8 / share[good], 0.5, 2), way[~good] / 2
        step = np.clip(step, -MOST_STEP, MOST_STEP)
        going[yes] = here[yes] != there[yes]
        stopped = on[going[on] & (np.abs(step[on]) < LEAST_STEP)]
        going[stopped] = False
        left = np.exp(2 * (log[stopped] - log_before[stopped]))
        dead[stopped] = here[stopped] + (here - before)[stopped] * left / np.where(left < 1, 1 - left, np.inf)
    return _Trace(passed, q, dead)


def follow(plan: Plan, q: Array, theta: Any, thetas: Any) -> Array:
    """Positions at driver angles in any order, by motions from positions at `theta`.

    NaN beyond dead positions. `thetas` has the shape (N,) or (N, K), the result (N, K, 3n).
    """
    thetas = np.asarray(thetas, dtype=float)
    thetas = np.broadcast_to(thetas if thetas.ndim == 2 else thetas[:, None], (len(thetas), len(q)))
    theta = np.broadcast_to(np.asarray(theta, dtype=float), (len(q),))
    way = _both_ways(plan, q, theta, thetas.min(axis=0), thetas.max(axis=0))
    which, angles, places = (np.concatenate(parts) for parts in zip(*way.passed, strict=True))
    nearest = np.empty(thetas.shape, dtype=int)  # of the positions passed on the way to each
    for k in range(len(q)):
        own = np.flatnonzero(which % len(q) == k)
        gone, aim = angles[own] - theta[k], thetas[:, k, None] - theta[k]
        on_the_way = (gone * aim >= 0) & (np.abs(gone) <= np.abs(aim))
        nearest[:, k] = own[np.where(on_the_way, np.abs(gone), -1).argmax(axis=1)]
    lanes = np.broadcast_to(np.arange(len(q)), thetas.shape).ravel()
    nearest = nearest.ravel()
    way = _advance(plan.taken(lanes), places[nearest], angles[nearest], thetas.ravel())
    return np.where(np.isnan(way.dead)[:, None], way.q, np.nan).reshape(*thetas.shape, -1)


def reach(plan: Plan, q: Array, theta: Any) -> Array:
    """Dead positions at the ends of the driver's motion, low and high, infinite if it turns; shape (2, K)."""
    theta = np.broadcast_to(np.asarray(theta, dtype=float), (len(q),))
    dead = _both_ways(plan, q, theta, theta - 2 * np.pi, theta + 2 * np.pi).dead.reshape(2, -1)
    turns = np.isnan(dead) & np.isfinite(q).all(axis=-1)
    return np.where(turns, [[-np.inf], [np.inf]], dead)


def _both_ways(plan: Plan, q: Array, theta: Array, low: Array, high: Array) -> _Trace:
    """Motions of a batch from `theta` to lower driver angles, then the same to higher ones."""
    twice = np.tile(np.arange(len(q)), 2)
    ends = np.concatenate([np.minimum(low, theta), np.maximum(high, theta)])
    return _advance(plan.taken(twice), q[twice], theta[twice], ends)


def circuit(plan: Plan, q: Array, most_step: float = 0.1, most: int = 3000) -> tuple[Array, Any]:
    """The circuit of each linkage of a batch from a position, through dead positions.

    Without a driver: a tangent predicts, Newton's method corrects at right angles to it, until the motion
    returns to its start. Positions of shape (N, K, 3n), NaN after that, and whether it returned.
    """
    scale = np.ones((len(q), q.shape[-1]))
    scale[:, 0::3] = scale[:, 1::3] = plan.size[:, None]
    way = np.linalg.svd(jacobian(plan, q)[:, :-1] * scale[:, None])[2][:, -1]
    first, here, begin = way.copy(), q.copy(), q.copy()
    step, back, passed = np.full(len(q), 1e-3), np.zeros(len(q), dtype=bool), [q.copy()]
    for _ in range(most):
        on = np.flatnonzero(~back)
        if not len(on):
            break
        sub, to = plan.taken(on), here[on] + scale[on] * way[on] * step[on, None]
        fits = np.ones(len(on), dtype=bool)
        for count in range(5):
            matrix = jacobian(sub, to) * scale[on, None]
            matrix[:, -1] = way[on]
            missed = gap(sub, to[None], np.zeros((1, len(on))))[0]
            missed[:, -1] = 0
            change = -_solve(matrix, missed)
            moved = np.linalg.norm(change, axis=-1)
            if count == 0:
                fits = moved < 0.1 * step[on] + CONVERGED
            to = to + scale[on] * change
        ahead = _solve(matrix, np.broadcast_to(np.eye(q.shape[-1])[-1], to.shape))
        ahead /= np.linalg.norm(ahead, axis=-1)[:, None]
        good = fits & (moved < CONVERGED) & ((ahead * way[on]).sum(axis=-1) > 0.98)
        yes, no = on[good], on[~good]
        here[yes], way[yes] = to[good], ahead[good]
        away = (here[yes] - begin[yes]) / scale[yes]
        away[:, 2::3] = (away[:, 2::3] + np.pi) % (2 * np.pi) - np.pi
        near = np.linalg.norm(away, axis=-1) < step[yes]
        back[yes] = near & ((way[yes] * first[yes]).sum(axis=-1) > 0.9) & (len(passed) > 20)
        step[yes] = np.minimum(1.5 * step[yes], most_step)
        step[no] /= 2
        latest = np.full_like(q, np.nan)
        latest[yes] = here[yes]
        passed.append(latest)
    return np.array(passed), back


# --- Rates and forces


def rates(plan: Plan, q: Array, omega: Any = 1.0, alpha: Any = 0.0, jerk: Any = 0.0) -> Array:
    """Coordinates and their first three derivatives by time, shape (4, ..., K, 3n)."""
    matrix, series, driver = jacobian(plan, q), np.zeros((4, *q.shape)), np.zeros((4, *q.shape[:-1]))
    series[0], driver[0] = q, q[..., 2]
    for k, rate in enumerate((omega, alpha, jerk), 1):
        driver[k] = np.asarray(rate) / factorial(k)
        series[k] = -_solve(matrix, gap(plan, series[: k + 1], driver[: k + 1])[k])
    return series * _factorials(q.ndim)


def _factorials(axes: int) -> Array:
    """Factors from coefficients of a series to derivatives."""
    return np.array([1.0, 1, 2, 6]).reshape(-1, *([1] * axes))


def carried(motion: Array, link: int, at: Any) -> Array:
    """A point of a link and its first three derivatives, from `rates`; shape (4, ..., K, 2)."""
    origin, unit, _ = _frames(motion / _factorials(motion.ndim - 1))
    place = origin[..., link - 1] + complex_of(at) * unit[..., link - 1]
    place = place * _factorials(motion.ndim - 2)
    return np.stack([place.real, place.imag], axis=-1)


def forces(
    plan: Plan,
    motion: Array,
    masses: Mapping[int, tuple[Any, Any, Any]],
    loads: Sequence[tuple[int, Any, Any, Any]] = (),
    gravity: Any = (0.0, 0.0),
) -> dict[str, Array]:
    """Forces in all joints and the driver's torque, as the multipliers of M a = Q + J^T multipliers.

    Parameters
    ----------
    masses : by link: mass, inertia about the centre, the centre's place in the link's frame
    loads : link, place in its frame, force in global axes (..., 2), moment

    Returns
    -------
    dict
        Of a pin the force on its first body, shape (..., K, 2); of a slide the force across it on what it
        guides, to the left of its direction, and the moment; "torque". All of shape (..., K) but pins.
    """
    need = np.zeros(motion.shape[1:])
    for link, (mass, inertia, centre) in masses.items():
        push = np.asarray(mass)[..., None] * (carried(motion, link, centre)[2] - np.asarray(gravity))
        _act(need, motion, link, centre, push, inertia * motion[2, ..., 3 * link - 4])
    for link, at, force, moment in loads:
        _act(need, motion, link, at, -np.asarray(force, dtype=float), -np.asarray(moment, dtype=float))
    by = _solve(np.swapaxes(jacobian(plan, motion[0]), -1, -2), need)
    count = len(plan.pins)
    found = {name: by[..., [k, count + k]] for k, (name, _, _) in enumerate(plan.pins)}
    others = [name for name, *_ in (*plan.slots, *plan.turned)]
    return found | {name: by[..., 2 * count + k] for k, name in enumerate([*others, "torque"])}


def _act(need: Array, motion: Array, link: int, at: Any, force: Array, moment: Any) -> None:
    """Add a force at a point of a link, and a moment, to the generalised forces."""
    arm, first = complex_of(at) * np.exp(1j * motion[0, ..., 3 * link - 4]), 3 * link - 6
    need[..., first] += force[..., 0]
    need[..., first + 1] += force[..., 1]
    need[..., first + 2] += moment + (arm.conj() * (force[..., 0] + 1j * force[..., 1])).imag
