"""Functions of five pairs: every four-bar through them is known."""

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import solve_position
from grashof.problems import FourBar, FunctionTask, Problem, Requirements
from grashof.synth import Claim
from grashof.synth.proof.functions.five_pairs import certified_functions
from grashof.synth.quantities.scaled_problem import ScaledProblem


def function(turned: np.ndarray, output: np.ndarray) -> Problem:
    task = FunctionTask.from_degrees(np.degrees(turned), np.degrees(output))
    return Problem(task=task, requirements=Requirements(link_ratio_max=50.0))


def random_function(seed: int) -> Problem:
    rng = np.random.default_rng(seed)
    turned, output = np.sort(rng.uniform(0, 2.5, 5)), np.sort(rng.uniform(0, 2.0, 5)) * rng.choice([-1, 1])
    return function(turned - turned[0], output - output[0])


MORE = [pytest.param(seed, marks=pytest.mark.study) for seed in range(8, 100)]


@pytest.mark.parametrize("seed", [*range(8), *MORE])
def test_every_coupler_of_random_functions_is_known(seed: int) -> None:
    made = certified_functions(ScaledProblem.of(random_function(seed)))
    assert made is not None
    assert (made.complete, made.why) == (True, "")
    assert 1 <= made.within <= 3


def test_a_planted_function_is_listed_and_all_are_proven() -> None:
    linkage = FourBar(o2=(0, 0), o4=(1, 0), r2=0.4, r3=1.1, r4=0.8, assembly=1)
    theta2 = np.radians([20.0, 45.0, 70.0, 95.0, 120.0])
    theta4 = np.unwrap(solve_position(linkage, theta2, 1).theta4)
    found = synthesize(function(theta2 - theta2[0], theta4 - theta4[0]))
    assert found.proof is not None
    assert (found.proof.claim, found.proof.complete) == (Claim.BEST, True)
    ratios = [one.linkage.lengths / one.linkage.lengths[0] for one in found.candidates]
    assert min(float(np.abs(each - [1, 0.4, 1.1, 0.8]).max()) for each in ratios) < 1e-6
