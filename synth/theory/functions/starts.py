"""Starts of least squares for function generators."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.theory.functions.fit import DesiredOutput
from grashof.synth.theory.functions.output import Generators

GRID = 40  # starts of driver and output each
COARSE, FEW = 12, 6  # the same, and `SUBSETS`, where many tasks are tried
ANYTHING = 20_000  # random linkages with a given driver angle; few of them close over the range
ROUND = 16  # driver angles of random linkages where it is free
SUBSETS = 30  # of as many pairs as can be met, through which exact linkages begin
_SAME = 1e-9  # rad


def function_starts(
    kind: type[Generators],
    desired: DesiredOutput,
    rng: np.random.Generator,
    first_driver: float | None = None,
    subsets: int = SUBSETS,
) -> Generators:
    """Linkages near the desired output, from which least squares begins.

    Exact ones through some of the pairs, and those of a linear equation on a grid of starts. With a given
    first driver angle, rad, only the latter, on a finer grid of the output, and random ones.

    Examples
    --------
    >>> from grashof.synth.theory.functions.four_bar import FourBars
    >>> turned = np.linspace(0, 1, 9)
    >>> desired = DesiredOutput(turned, np.sin(turned), np.ones(9))
    >>> len(function_starts(FourBars, desired, np.random.default_rng(0))) > 1600
    True
    """
    half = np.pi * (np.arange(GRID) + rng.random()) / GRID
    if first_driver is not None:
        fine = np.pi * (np.arange(GRID**2) + rng.random()) / GRID**2
        grid = kind.joined([
            on_grid(kind, desired, np.full(GRID**2, first), fine)
            for first in (first_driver, first_driver + np.pi)
        ])  # fmt: skip
        random = kind.anything(rng, ANYTHING, first_driver, float(desired.turned[-1]))
        found = kind.joined([grid, random.scaled_to(desired.turned, desired.output)])
        return _held(found, first_driver)
    driver, place = (
        each.ravel() for each in np.meshgrid(half, np.pi * (np.arange(GRID) + rng.random()) / GRID)
    )
    return kind.joined([_of_subsets(kind, desired, rng, subsets), on_grid(kind, desired, driver, place)])


def few_starts(kind: type[Generators], desired: DesiredOutput, rng: np.random.Generator) -> Generators:
    """The same from a coarse grid, and exact ones through a few sets of pairs."""
    half = np.pi * np.arange(COARSE) / COARSE
    shift = np.pi * rng.random(2) / COARSE
    driver, place = (each.ravel() for each in np.meshgrid(half + shift[0], half + shift[1]))
    return kind.joined([_of_subsets(kind, desired, rng, FEW), on_grid(kind, desired, driver, place)])


def anywhere(kind: type[Generators], desired: DesiredOutput, rng: np.random.Generator) -> Generators:
    """Random linkages from evenly distributed driver angles, in the size that suits the desired output."""
    firsts = 2 * np.pi * (np.arange(ROUND) + rng.random()) / ROUND
    span = float(desired.turned[-1])
    found = [kind.anything(rng, ANYTHING // ROUND, first, span) for first in firsts.tolist()]
    return kind.joined(found).scaled_to(desired.turned, desired.output).finite


def on_grid(
    kind: type[Generators], desired: DesiredOutput, driver: FloatArray, angle: FloatArray
) -> Generators:
    """Least squares at starts, each of shape (M,), that of the output by `Generators.place_of`."""
    output = desired.output - desired.output[0]
    return kind.at_starts(desired.turned, output, driver, kind.place_of(angle)).finite


def crank_starts(
    kind: type[Generators],
    desired: DesiredOutput,
    rng: np.random.Generator,
    count: int,
    first_driver: float | None = None,
    shortest: int = 0,
) -> Generators:
    """Random linkages whose driver turns fully, in the size that suits the desired output."""
    batch = kind.cranks(rng, count, first_driver, shortest)
    batch = batch.scaled_to(desired.turned, desired.output).finite
    return batch if first_driver is None else _held(batch, first_driver)


def _held(batch: Generators, first_driver: float) -> Generators:
    """Those that begin at a driver angle, and not half a turn from it."""
    return batch[np.abs(np.angle(np.exp(1j * (batch.first - first_driver)))) < _SAME]


def _of_subsets(
    kind: type[Generators], desired: DesiredOutput, rng: np.random.Generator, count: int
) -> Generators:
    total, exact = len(desired.turned), kind.EXACT
    if total < exact:
        return kind.joined([])
    chosen = np.sort(np.array([rng.choice(total, exact, replace=False) for _ in range(count)]), axis=1)
    turned, output = desired.turned[chosen], desired.output[chosen]
    batch, which = kind.through(turned - turned[:, :1], output - output[:, :1])
    batch = batch.begun(turned[which, 0])
    # With a defect the assembly at the first pair is not that at the others: both are tried.
    return kind.joined([batch, batch.other_assembly])
