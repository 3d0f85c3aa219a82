"""Many small linear programmes at once, each from a vertex that is known to be feasible."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray, IntArray

_PIVOTS = 80  # most of them; where they run out the vertex that was reached is feasible, too
_DUAL = 1e-9  # a constraint with a price above minus this is rightly held
_PIVOT = 1e-9  # least rate at which a constraint is approached


def least_linear(cost: FloatArray, rows: FloatArray, right: FloatArray, basis: IntArray) -> FloatArray:
    """Unknowns (M, n) that minimise ``cost @ x`` under ``rows @ x <= right``, from a vertex of each.

    `cost` (n,), `rows` (M, R, n), `right` (M, R); `basis` (M, n) are the constraints that meet in the vertex,
    which has to be feasible. The simplex method over active sets (Best & Ritter, *Linear Programming*, 1985):
    with few unknowns and many rows, a vertex is n rows and the inverse of their matrix. Of the constraints
    that may be left the one with the steepest edge is; the programmes must be bounded. Unknowns and rows are
    to be of the order of 1.

    Examples
    --------
    >>> square = np.vstack([np.eye(2), -np.eye(2)])[None]
    >>> corner = np.vstack([square[0], [1.0, 1.0]])[None]  # x + y <= 1 as well
    >>> least_linear(np.array([-1.0, -2.0]), corner, np.ones((1, 5)), np.array([[2, 3]])).round(9).tolist()
    [[0.0, 1.0]]
    """
    every = np.arange(len(rows))
    inverse = np.asarray(np.linalg.inv(rows[every[:, None], basis]), dtype=np.float64)
    slack = right - times(rows, times(inverse, right[every[:, None], basis]))
    found = np.empty((len(rows), len(cost)))
    going, basis = every, basis.copy()
    for _ in range(_PIVOTS):
        size = np.sqrt(np.einsum("mij,mij->mj", inverse, inverse))
        price = -(cost @ inverse) / size
        leaving = price.argmin(axis=1)
        done = price[every, leaving] >= -_DUAL
        if done.any():
            found[going[done]] = times(inverse[done], right[every[done][:, None], basis[done]])
            go_on = ~done
            going, rows, right, slack = going[go_on], rows[go_on], right[go_on], slack[go_on]
            inverse, basis, size, leaving = inverse[go_on], basis[go_on], size[go_on], leaving[go_on]
            every = np.arange(len(going))
        if not going.size:
            return found
        way = -inverse[every, :, leaving]
        rate = times(rows, way)
        with np.errstate(divide="ignore", invalid="ignore"):
            near = rate > _PIVOT * size[every, leaving, None]
            far = np.where(near, np.maximum(slack, 0.0) / rate, np.inf)
            far[every[:, None], basis] = np.inf
            entering = far.argmin(axis=1)
            slack = slack - far[every, entering, None] * rate
        share = (rows[every, entering][:, None] @ inverse)[:, 0]
        pivot = share[every, leaving]
        share[every, leaving] -= 1.0
        inverse = inverse + way[:, :, None] * (share / pivot[:, None])[:, None]
        basis[every, leaving] = entering
    found[going] = times(inverse, right[every[:, None], basis])
    return found


def times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    """Products (M, R) of matrices (M, R, n) and vectors (M, n)."""
    product: FloatArray = (matrices @ vectors[..., None])[..., 0]
    return product
