"""Many small problems of least squares under inequalities at once, each from a point that meets them."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.synth.theory.functions.linear_programmes import least_linear, times

_STEPS = 80  # most of them; where they run out the point that was reached meets the inequalities, too
_DAMPING = 1e-13  # share of the squares: unknowns that nothing depends on stay
_RATE = 1e-12  # least rate at which an inequality is approached
_PRICE = 1e-13  # an inequality with a price above minus this is rightly held
_MISSED = 1e-10  # inequalities missed by less are not brought nearer


def least_square(
    matrix: FloatArray, side: FloatArray, rows: FloatArray, right: FloatArray, start: FloatArray
) -> FloatArray:
    """Unknowns (M, n) of least ``|matrix @ x - side|`` under ``rows @ x <= right``, from a point of each.

    `matrix` (M, m, n), `side` (M, m), `rows` (M, R, n), `right` (M, R); `start` (M, n) has to meet the
    inequalities, and every step keeps to them. A primal active set method (Nocedal & Wright, *Numerical
    Optimization*, 2006, sec. 16.5). Unknowns are to be of the order of 1.

    Examples
    --------
    >>> square, corner = np.eye(2)[None], np.array([[[1.0, 1.0], [1.0, 0.0]]])  # x + y <= 1, x <= 0.2
    >>> right, start = np.array([[1.0, 0.2]]), np.zeros((1, 2))
    >>> least_square(square, np.array([[2.0, 1.5]]), corner, right, start).round(9).tolist()
    [[0.2, 0.8]]
    """
    unknowns, turned = matrix.shape[2], matrix.swapaxes(1, 2)
    squares, pull = turned @ matrix, times(turned, side)
    scale = np.maximum(np.einsum("mkk->m", squares), 1e-300)
    squares, pull = squares / scale[:, None, None] + _DAMPING * np.eye(unknowns), pull / scale[:, None]
    size = np.linalg.norm(rows, axis=2)
    size[size == 0] = 1.0
    rows, right = rows / size[..., None], right / size
    found, there, going = start.copy(), start, np.arange(len(start))
    held = np.full(start.shape, -1)  # numbers of the inequalities that are held; -1 in free places
    for _ in range(_STEPS):
        if not going.size:
            break
        every, free = np.arange(len(going)), held < 0
        step, price = _held_step(squares, pull - times(squares, there), rows[every[:, None], held], free)
        rate, slack = times(rows, step), np.maximum(right - times(rows, there), 0.0)
        near = np.pad(rate > _RATE, [(0, 0), (0, 1)])
        np.put_along_axis(near, held, False, axis=1)
        far = np.full(rate.shape, np.inf)
        np.divide(slack, rate, out=far, where=near[:, :-1])
        nearest = far.argmin(axis=1)
        share = np.minimum(far[every, nearest], 1.0)
        there = there + share[:, None] * step
        found[going] = there
        stopped, least = share < 1, price.argmin(axis=1)
        place = np.where(stopped, free.argmax(axis=1), least)
        on = np.where(stopped, free.any(axis=1), price[every, least] < -_PRICE)
        held[every, place] = np.where(on, np.where(stopped, nearest, -1), held[every, place])
        going, there, held = going[on], there[on], held[on]
        squares, pull, rows, right = squares[on], pull[on], rows[on], right[on]
    return found


def _held_step(
    squares: FloatArray, pull: FloatArray, rows: FloatArray, free: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """The steps (M, n) to the least squares while rows (M, n, n) are held but in free places; the prices."""
    unknowns = pull.shape[1]
    rows = np.where(free[..., None], 0.0, rows)
    diagonal = np.where(free, 1.0, -_DAMPING)[..., None] * np.eye(unknowns)
    system = np.block([[squares, rows.swapaxes(1, 2)], [rows, diagonal]])
    side = np.concatenate([pull, np.zeros(pull.shape)], axis=1)
    found = np.linalg.solve(system, side[..., None])[..., 0]
    return found[:, :unknowns], np.where(free, 0.0, found[:, unknowns:])


def least_missed(rows: FloatArray, right: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unknowns (M, n) from -1 to 1 that miss ``rows @ x <= right`` by the least amount, and the amounts (M,).

    `rows` (M, R, n), `right` (M, R). The amounts are those by which the worst one is missed; unknowns are
    zero where none is missed by that.
    """
    found, missed = np.zeros((len(rows), rows.shape[2])), np.maximum(-right.min(axis=1, initial=0.0), 0.0)
    some = np.flatnonzero(missed > _MISSED)
    if not some.size:
        return found, missed
    (count, kept, unknowns), every = rows[some].shape, np.arange(len(some))
    near, short = rows[some] / missed[some, None, None], right[some] / missed[some, None]
    limits = np.concatenate([near, -np.ones((count, kept, 1))], axis=2)
    size = np.linalg.norm(limits, axis=2)
    sides = np.eye(unknowns + 1)[:-1]
    fixed = np.vstack([-np.eye(unknowns + 1)[-1:], sides, -sides])  # no amount below 0, unknowns in the box
    all_rows = np.concatenate(
        [limits / size[..., None], np.broadcast_to(fixed, (count, *fixed.shape))], axis=1
    )
    all_right = np.concatenate([short / size, np.zeros((count, 1)), np.ones((count, 2 * unknowns))], axis=1)
    ahead = near[every, short.argmin(axis=1)] <= 0  # a corner in which the worst one is met best
    corner = np.where(ahead, 1.0, -1.0)
    worst = np.append(times(near, corner) - short, np.zeros((count, 1)), axis=1).argmax(axis=1)
    basis = np.column_stack([kept + 1 + np.arange(unknowns) + unknowns * ~ahead, worst])
    there = least_linear(np.append(np.zeros(unknowns), 1.0), all_rows, all_right, basis)[:, :-1].clip(-1, 1)
    left = np.maximum((times(near, there) - short).max(axis=1), 0.0)
    nearer = left < 1
    found[some[nearer]] = there[nearer]
    missed[some[nearer]] *= left[nearer]
    return found, missed
