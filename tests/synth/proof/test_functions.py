"""Functions: every four-bar through five pairs is known; of four pairs the best transmission angle is."""

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import solve_position, verify
from grashof.problems import FourBar, FunctionTask, Problem, Requirements
from grashof.synth import Claim
from grashof.synth.proof.bounds import Proving
from grashof.synth.proof.four_pairs import bounds_of_pairs
from grashof.synth.proof.functions import certified_functions
from grashof.synth.starts.function_aims import FunctionAims
from grashof.synth.starts.function_search import exact_functions


def function(turned: np.ndarray, output: np.ndarray) -> Problem:
    task = FunctionTask.from_degrees(np.degrees(turned), np.degrees(output))
    return Problem(task=task, requirements=Requirements(link_ratio_max=50.0))


def random_function(seed: int) -> Problem:
    rng = np.random.default_rng(seed)
    turned, output = np.sort(rng.uniform(0, 2.5, 5)), np.sort(rng.uniform(0, 2.0, 5)) * rng.choice([-1, 1])
    return function(turned - turned[0], output - output[0])


@pytest.mark.parametrize("seed", range(8))
def test_every_coupler_of_random_functions_is_known(seed: int) -> None:
    made = certified_functions(FunctionAims.of(random_function(seed)))
    assert made is not None
    assert (made.complete, made.why) == (True, "")
    assert 1 <= made.within <= 3


@pytest.mark.study
@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8, 100))
def test_every_coupler_of_many_functions_is_known(seed: int) -> None:
    test_every_coupler_of_random_functions_is_known(seed)


def test_a_planted_function_is_listed_and_all_are_proven() -> None:
    linkage = FourBar(o2=(0, 0), o4=(1, 0), r2=0.4, r3=1.1, r4=0.8, assembly=1)
    theta2 = np.radians([20.0, 45.0, 70.0, 95.0, 120.0])
    theta4 = np.unwrap(solve_position(linkage, theta2, 1).theta4)
    found = synthesize(function(theta2 - theta2[0], theta4 - theta4[0]))
    assert found.proof is not None
    assert (found.proof.claim, found.proof.complete) == (Claim.BEST, True)
    ratios = [one.linkage.lengths / one.linkage.lengths[0] for one in found.candidates]
    assert min(float(np.abs(each - [1, 0.4, 1.1, 0.8]).max()) for each in ratios) < 1e-6


def test_other_functions_have_no_proof() -> None:
    turned = np.radians([0.0, 45.0, 90.0])
    assert synthesize(function(turned, 0.5 * turned**1.3), enough=3).proof is None


def four_pairs(seed: int) -> Problem:
    rng = np.random.default_rng(seed)
    turned, output = np.sort(rng.uniform(0, 120, 4)), np.sort(rng.uniform(0, 90, 4)) * rng.choice([-1, 1])
    return Problem(task=FunctionTask.from_degrees(turned - turned[0], output - output[0]))


@pytest.mark.parametrize("seed", [0, 1, 6, 9])
def test_the_best_of_four_pairs_or_none_is_proven(seed: int) -> None:
    found = synthesize(four_pairs(seed))
    assert found.proof is not None
    assert found.proof.claim in (Claim.BEST, Claim.NONE)
    assert (found.proof.claim is Claim.NONE) == (not found.candidates)
    more = synthesize(four_pairs(seed), effort=3, seed=1)
    best = max((one.values["transmission_min_task"] for one in more.candidates), default=0.0)
    assert found.proof.upper is not None
    assert np.degrees(best) <= found.proof.upper + 1e-6


@pytest.mark.study
@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10, 110))
def test_the_best_of_many_four_pairs_or_none_is_proven(seed: int) -> None:
    found = synthesize(four_pairs(seed))
    assert found.proof is not None
    assert found.proof.claim in (Claim.BEST, Claim.NONE)


@pytest.mark.parametrize("over", ["task", "cycle"])
@pytest.mark.parametrize("rotatability", ["any", "full-crank", "crank-rocker"])
def test_no_generator_of_four_pairs_is_above_its_bound(over: str, rotatability: str) -> None:
    # Every generator that a sweep finds lies in a piece that is left, with its own angle as the threshold.
    wanted = Requirements(rotatability=rotatability, transmission_over=over)  # type: ignore[arg-type]
    if (over, rotatability) == ("cycle", "any"):
        return
    for seed in (0, 6):
        problem = Problem(task=four_pairs(seed).task, requirements=wanted)
        aims = FunctionAims.of(problem)
        made = bounds_of_pairs(aims, Proving())
        assert made is not None
        bounds = made[0]
        found = exact_functions(aims, np.random.default_rng(seed), 40, 0.5)
        for one in found:
            linkage = aims.linkage(one.made, one.driver)
            verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
            if verdict.ok and bounds.closed:
                value = verdict.transmission_min_cycle if over == "cycle" else verdict.transmission_min_task
                assert value <= bounds.upper + 1e-8


def test_coinciding_poles_are_said_to_be_open() -> None:
    problem = Problem(task=FunctionTask.from_degrees([0, 30, 60, 90], [0, 20, 35, 45]))
    proof = synthesize(problem, enough=5).proof
    assert proof is not None
    assert proof.claim is Claim.BOUND
    assert "centre is open" in proof.why
