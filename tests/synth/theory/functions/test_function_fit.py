import numpy as np
import pytest

from grashof.analysis.judge.planted import planted_function
from grashof.synth.quantities.kinds import KINDS
from grashof.synth.theory.functions.fit import DesiredOutput, fitted
from grashof.synth.theory.functions.four_bar import FourBars
from grashof.synth.theory.functions.limits import ShapeLimits
from grashof.synth.theory.functions.starts import crank_starts, function_starts

EVERY = pytest.mark.parametrize("mechanism", list(KINDS))


def solved(rng: np.random.Generator, pairs: int, mechanism: str, *, full: bool) -> bool:
    task, _, _ = planted_function(rng, pairs, full=full, mechanism=mechanism)
    kind = KINDS[mechanism].generators["output"]
    wanted = DesiredOutput(task.inputs, task.outputs / task.output_unit, np.ones(pairs))
    count = kind.joined([]).lengths.shape[1]
    caps = np.full((count, count), np.log(20.0 if mechanism == "four-bar" else 1e3))
    limits = ShapeLimits(float(task.inputs[-1]), caps=caps, margin=1e-3 if full else None)
    starts = [function_starts(kind, wanted, rng)] + ([crank_starts(kind, wanted, rng, 4000)] if full else [])
    for each in starts:
        made, square = fitted(wanted, each, limits.of)
        if ((square < 1e-14) & (limits.of(made).value.min(axis=1) > -1e-6)).any():
            return True
    return False


@pytest.mark.slow
@pytest.mark.quick("8-False-inverted-slider-crank")
@EVERY
@pytest.mark.parametrize("full", [False, True])
@pytest.mark.parametrize("pairs", [6, 8, 12, 24])
def test_planted_functions_are_found(mechanism: str, pairs: int, full: bool) -> None:
    rng = np.random.default_rng([pairs, full])
    assert sum(solved(rng, pairs, mechanism, full=full) for _ in range(8)) == 8


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
    slopes = limits.of(FourBars(shape, np.ones(100))).slope
    for k in range(4):
        moved = np.zeros(4)
        moved[k] = step
        ahead, behind = (limits.of(FourBars(shape + sign * moved, np.ones(100))).value for sign in (1, -1))
        assert np.abs((ahead - behind) / (2 * step) - slopes[..., k]).max() < 1e-6


@EVERY
def test_a_held_start_stays(mechanism: str) -> None:
    rng = np.random.default_rng(3)
    task, _, first = planted_function(rng, 8, mechanism=mechanism)
    kind = KINDS[mechanism].generators["output"]
    wanted = DesiredOutput(task.inputs, task.outputs / task.output_unit, np.ones(8))
    made, square = fitted(wanted, function_starts(kind, wanted, rng, first), held=True)
    assert np.abs(np.exp(1j * (made.first - first)) - 1).max() < 1e-9
    assert square[0] < 1e-14
