"""Starts of least squares for function generators."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.theory.function_fit import Wanted
from grashof.synth.theory.function_output import Generators, closes
from grashof.synth.theory.function_points import through_five_pairs, through_three_pairs

GRID = 40  # start angles of driver and output each, over half a turn
ANYTHING = 20_000  # random four-bars with a given driver angle, of which few close over the range
_SAME = 1e-9  # rad
SUBSETS = 30  # of five pairs, through which exact four-bars begin


def function_starts(
    wanted: Wanted, rng: np.random.Generator, first_driver: float | None = None, subsets: int = SUBSETS
) -> Generators:
    """Four-bars near what is wanted, from which least squares begins.

    Exact ones through five of the pairs, and Freudenstein's least squares on a grid of start angles. With
    a given first driver angle, rad, only the latter, on a finer grid of the output.

    Examples
    --------
    >>> turned = np.linspace(0, 1, 9)
    >>> starts = function_starts(Wanted(turned, np.sin(turned), np.ones(9)), np.random.default_rng(0))
    >>> len(starts) > 1600
    True
    """
    half = np.pi * (np.arange(GRID) + rng.random()) / GRID
    if first_driver is not None:
        fine = np.pi * (np.arange(GRID**2) + rng.random()) / GRID**2
        grid = Generators.joined(
            [on_grid(wanted, np.full(GRID**2, first), fine) for first in (first_driver, first_driver + np.pi)]
        )
        held = grid[np.abs(np.angle(np.exp(1j * (grid.shape[:, 3] - first_driver)))) < _SAME]
        return Generators.joined([held, anything(rng, ANYTHING, first_driver, float(wanted.turned[-1]))])
    driver, output = (
        each.ravel() for each in np.meshgrid(half, np.pi * (np.arange(GRID) + rng.random()) / GRID)
    )
    return Generators.joined([_of_subsets(wanted, rng, subsets), on_grid(wanted, driver, output)])


def on_grid(wanted: Wanted, driver: FloatArray, output: FloatArray) -> Generators:
    """Least squares of Freudenstein's equation at start angles, each of shape (M,), that close."""
    made = through_three_pairs(wanted.turned, wanted.output - wanted.output[0], driver, output)
    return made.finite


def _of_subsets(wanted: Wanted, rng: np.random.Generator, count: int) -> Generators:
    total = len(wanted.turned)
    if total < 5:
        return Generators.joined([])
    chosen = np.sort(np.array([rng.choice(total, 5, replace=False) for _ in range(count)]), axis=1)
    turned, output = wanted.turned[chosen], wanted.output[chosen]
    made, which = through_five_pairs(turned - turned[:, :1], output - output[:, :1])
    shape = made.shape.copy()
    shape[:, 3] -= turned[which, 0]
    # With a defect the assembly at the first pair is not that at the others: both are tried.
    return Generators.joined([Generators(shape, sign * made.assembly) for sign in (1.0, -1.0)])


def full_cranks(
    rng: np.random.Generator, count: int, first_driver: float | None = None, shortest: int = 0
) -> Generators:
    """Random four-bars whose driver turns fully, on both assemblies.

    With r1 = 1, r3 + r4 = 1 + r2 + exp(b) and r3 - r4 = abs(1 - r2) tanh(c), r2 below or above 1, any b and c
    give a full crank, and there is none besides.

    Parameters
    ----------
    rng : Generator
    count : int
    first_driver : float, rad, optional
    shortest : int
        As in `ShapeLimits`.

    Examples
    --------
    >>> r1, r2, r3, r4 = full_cranks(np.random.default_rng(0), 100).lengths.T
    >>> bool((r3 + r4 > r1 + r2).all() and (abs(r1 - r2) > abs(r3 - r4)).all())
    True
    """
    crank = 1 / (1 + np.exp(-rng.normal(0, 1.5, count)))
    longer = rng.random(count) < 0.5 if not shortest else np.full(count, shortest < 0)
    r2 = np.where(longer, 1 / crank, crank)
    total, difference = (
        1 + r2 + np.exp(rng.normal(-1, 1.5, count)),
        np.abs(1 - r2) * np.tanh(rng.normal(0, 1, count)),
    )
    first = rng.uniform(-np.pi, np.pi, count) if first_driver is None else np.full(count, first_driver)
    lengths = np.stack([r2, (total + difference) / 2, (total - difference) / 2], axis=-1)
    return Generators(np.column_stack([np.log(lengths), first]), rng.choice([-1.0, 1.0], count))


def anything(rng: np.random.Generator, count: int, first_driver: float, span: float) -> Generators:
    """Random four-bars that close over a rotation from a given driver angle, lengths from 0.05 to 20.

    Examples
    --------
    >>> made = anything(np.random.default_rng(0), 1000, 0.5, 1.0)
    >>> bool(closes(made, 1.0).all() and (made.shape[:, 3] == 0.5).all())
    True
    """
    shape = np.column_stack([np.log(20) * rng.uniform(-1, 1, (count, 3)), np.full(count, first_driver)])
    made = Generators(shape, rng.choice([-1.0, 1.0], count))
    return made[closes(made, span)]
