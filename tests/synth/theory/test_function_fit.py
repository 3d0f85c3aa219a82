import numpy as np
import pytest

from grashof.analysis.judge.planted import planted_function
from grashof.problems.values.arrays import FloatArray
from grashof.synth.theory.function_fit import Wanted, fitted
from grashof.synth.theory.function_limits import ShapeLimits
from grashof.synth.theory.function_output import Generators
from grashof.synth.theory.function_starts import full_cranks, function_starts


def planted(
    rng: np.random.Generator, pairs: int, *, full: bool = False
) -> tuple[Generators, FloatArray, FloatArray]:
    task, linkage, start = planted_function(rng, pairs, full=full)
    shape = np.append(np.log(linkage.lengths[1:]), start)
    return Generators(shape[None], linkage.assembly[None]), task.inputs, task.outputs


def solved(rng: np.random.Generator, pairs: int, *, full: bool) -> bool:
    _, turned, output = planted(rng, pairs, full=full)
    wanted = Wanted(turned, output, np.ones(pairs))
    limits = ShapeLimits(float(turned[-1]), margin=1e-3 if full else None)
    starts = [function_starts(wanted, rng)] + ([full_cranks(rng, 4000)] if full else [])
    for each in starts:
        made, square = fitted(wanted, each, limits.of)
        if ((square < 1e-14) & (limits.of(made)[0].min(axis=1) > -1e-6)).any():
            return True
    return False


@pytest.mark.parametrize("full", [False, True])
@pytest.mark.parametrize("pairs", [6, 8, 12, 24])
def test_planted_functions_are_found(pairs: int, full: bool) -> None:
    rng = np.random.default_rng([pairs, full])
    assert sum(solved(rng, pairs, full=full) for _ in range(8)) == 8


@pytest.mark.slow
@pytest.mark.parametrize("full", [False, True])
@pytest.mark.parametrize("pairs", [6, 8, 12, 24])
def test_99_of_100_planted_functions_are_found(pairs: int, full: bool) -> None:
    rng = np.random.default_rng([7, pairs, full])
    assert sum(solved(rng, pairs, full=full) for _ in range(100)) >= 99


@pytest.mark.parametrize(
    "limits",
    [
        ShapeLimits(1.0, transmission=0.5),
        ShapeLimits(2.5, transmission=0.5, over_cycle=True, margin=0.01),
        ShapeLimits(1.0, margin=0.01, shortest=1),
        ShapeLimits(1.0, shortest=-1),
    ],
)
def test_slopes_of_limits_are_those_of_differences(limits: ShapeLimits) -> None:
    shape, step = np.random.default_rng(0).normal(size=(100, 4)), 1e-6
    slopes = limits.of(Generators(shape, np.ones(100)))[1]
    for k in range(4):
        moved = np.zeros(4)
        moved[k] = step
        ahead, behind = (limits.of(Generators(shape + sign * moved, np.ones(100)))[0] for sign in (1, -1))
        assert np.abs((ahead - behind) / (2 * step) - slopes[..., k]).max() < 1e-6


def test_a_held_start_stays() -> None:
    rng = np.random.default_rng(3)
    there, turned, output = planted(rng, 8)
    first = float(there.shape[0, 3])
    wanted = Wanted(turned, output, np.ones(8))
    made, square = fitted(wanted, function_starts(wanted, rng, first), held=True)
    assert np.abs(np.exp(1j * (made.shape[:, 3] - first)) - 1).max() < 1e-9
    assert square[0] < 1e-14
