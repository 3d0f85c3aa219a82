"""Many linear programmes at once against a solver of one."""

import numpy as np
from scipy.optimize import linprog

from grashof.synth.theory.functions.linear_programmes import least_linear


def test_each_programme_is_solved_as_alone() -> None:
    """Chebyshev fits in a box, degenerate ones among them: rows twice, and columns of zero."""
    rng = np.random.default_rng(2)
    count, samples, unknowns = 40, 25, 4
    slopes, errors = rng.normal(size=(count, samples, unknowns)), rng.normal(size=(count, samples))
    slopes[::3, 5], errors[::3, 5] = slopes[::3, 4], errors[::3, 4]
    slopes[::5, :, -1] = 0.0
    one = np.ones((count, samples, 1))
    box = np.zeros((count, 2 * unknowns, unknowns + 1))
    box[..., :-1] = np.vstack([np.eye(unknowns), -np.eye(unknowns)])
    rows = np.concatenate([np.dstack([slopes, -one]), np.dstack([-slopes, -one]), box], axis=1)
    size = 10.0 ** rng.uniform(-2, 0, (count, 1)) * np.ones((count, 2 * unknowns))
    right = np.concatenate([-errors, errors, size], axis=1)
    corner = slopes @ size[:, unknowns:, None]
    worst = np.abs(errors + corner[..., 0]).argmax(axis=1)
    above = (errors + corner[..., 0])[np.arange(count), worst] > 0
    basis = np.column_stack([
        np.broadcast_to(2 * samples + np.arange(unknowns), (count, unknowns)),
        np.where(above, worst, samples + worst),
    ])  # fmt: skip
    cost = np.append(np.zeros(unknowns), 1.0)
    found = least_linear(cost, rows, right, basis)
    assert ((rows @ found[..., None])[..., 0] - right).max() < 1e-9
    for k in range(count):
        alone = linprog(cost, rows[k], right[k], bounds=[(None, None)] * (unknowns + 1))
        assert abs(found[k] @ cost - alone.fun) < 1e-9
