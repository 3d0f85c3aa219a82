"""Five poses: all dyads within limits are counted, each in a box of its own."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from proof_problems import planted, random_poses, rotation

from grashof import synthesize
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Problem, Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth import Claim, prove
from grashof.synth.proof.poses.five_poses import Certified, certified_poses
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.five_poses import five_pose_dyads

REACH = 50.0
WIDE: dict[str, Any] = {"link_length": (1e-6, REACH), "coupler_arms": (0.0, REACH), "rotatability": "any"}


def problem_of(seed: int) -> Problem:
    """Five poses at random, under limits that hardly bind."""
    return random_poses(seed, 5, low=-0.5, **WIDE)


def certified(problem: Problem) -> Certified:
    made = certified_poses(ScaledProblem.of(problem))
    assert made is not None
    return made


def off_circles(problem: Problem, z: ComplexArray, c: ComplexArray) -> FloatArray:
    """How far the five places of points are from one circle about each centre, sizes: by the poses alone."""
    scaled = ScaledProblem.of(problem)
    own = z * np.exp(-1j * scaled.turns[0])  # in the body's frame
    places = scaled.targets + own[:, None] * np.exp(1j * scaled.turns)
    radius: FloatArray = np.abs(places - (c + scaled.targets[0])[:, None])
    return np.ptp(radius, axis=1)


@pytest.mark.quick(*map(str, range(6)))
@pytest.mark.parametrize("seed", range(200))
def test_every_dyad_is_counted_once(seed: int) -> None:
    problem = problem_of(seed)
    made = certified(problem)
    assert (made.complete, made.why) == (True, "")
    assert np.all(off_circles(problem, made.moving, made.ground) < 1e-9)
    motion = ScaledProblem.of(problem).motion
    assert motion is not None
    known = five_pose_dyads(motion)
    arm = np.abs(known.moving - ScaledProblem.of(problem).targets[0])
    reach = REACH / problem.task.size
    within = (arm <= reach) & (np.abs(known.moving - known.ground) <= reach)
    assert made.within == within.sum()


def test_boxes_hold_one_zero_each() -> None:
    # Newton's method from anywhere in a box leads to its dyad.
    for seed in range(2):
        problem = problem_of(seed)
        made, rng = certified(problem), np.random.default_rng(seed)
        for k in range(len(made.moving)):
            for _ in range(20):
                z, c = (
                    point[k] + made.box[k] * complex(*rng.uniform(-1, 1, 2))
                    for point in (made.moving, made.ground)
                )
                z, c = newton(problem, complex(z), complex(c))
                assert abs(z - made.moving[k]) + abs(c - made.ground[k]) < 1e-8


def newton(problem: Problem, z: complex, c: complex) -> tuple[complex, complex]:
    """A zero of |z_j - c|^2 - |z - c|^2, by numerical derivatives."""
    scaled = ScaledProblem.of(problem)
    turn = np.exp(1j * (scaled.turns - scaled.turns[0]))
    move = scaled.targets - scaled.targets[0]

    def miss(x: FloatArray) -> FloatArray:
        places = turn * complex(x[0], x[1]) + move
        square: FloatArray = np.abs(places - complex(x[2], x[3])) ** 2
        return square[1:] - square[0]

    x = np.array([z.real, z.imag, c.real, c.imag])
    for _ in range(40):
        slopes = np.stack([(miss(x + step) - miss(x - step)) / 2e-6 for step in 1e-6 * np.eye(4)], axis=1)
        x = x - np.linalg.solve(slopes, miss(x))
    return complex(x[0], x[1]), complex(x[2], x[3])


def test_a_planted_linkage_is_listed_and_all_are_proven() -> None:
    task, linkage = planted_motion(np.random.default_rng(1), poses=5)
    problem = Problem(task=task, requirements=Requirements(rotatability="any"))  # type: ignore[arg-type]
    found = synthesize(problem)
    assert found.proof is not None
    assert (found.proof.claim, found.proof.complete) == (Claim.BEST, True)
    assert found.proof.upper == found.proof.lower
    assert found.proof.pieces[0] >= 2
    listed = [np.abs(one.linkage.o2 - linkage.o2).max() for one in found.candidates]
    assert min(listed) < 1e-6 * task.size


@pytest.mark.slow
def test_none_of_five_poses_is_proven() -> None:
    problem = problem_of(52)
    assert certified(problem).within == 0
    proof = prove(problem)
    assert (proof.claim, proof.complete, proof.lower) == (Claim.NONE, True, None)


def test_a_search_that_is_cut_short_proves_nothing() -> None:
    proof = synthesize(planted(1, 5, rotatability="any"), enough=1).proof
    assert proof is not None
    assert proof.claim is Claim.REFUSED
    assert proof.why == "the search was not exhaustive"


def test_equal_poses_and_rotations_are_refused() -> None:
    task = rotation(0.0, 0.4, 0.9, 1.7, 2.0)
    assert "plane of dyads" in certified(replace(problem_of(0), task=task)).why
