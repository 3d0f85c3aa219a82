"""Proofs: tasks whose best design, or the absence of any, is proven; processor time after imports."""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from time import process_time

import numpy as np
from measuring import Case, spread, timed

from grashof import load, synthesize
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import (
    Box,
    FunctionTask,
    MotionTask,
    Problem,
    Requirements,
    Rotatability,
    StrokeTask,
    TransmissionOver,
)
from grashof.synth import Claim, Proof
from grashof.synth.proof.claims.bounds import Proving
from grashof.synth.proof.claims.proof import proof_of
from grashof.synth.proof.functions.few_pairs import bounds_of_pairs
from grashof.synth.proof.functions.five_pairs import certified_functions
from grashof.synth.proof.poses.five_poses import certified_poses
from grashof.synth.proof.provers import bounds_of
from grashof.synth.quantities.scaled_problem import ScaledProblem

_OVER = (TransmissionOver.TASK, TransmissionOver.CYCLE)
_ROUNDING = 1e-6  # deg


def planted(number: int) -> Problem:
    """Poses of a linkage drawn at random, default limits."""
    task, _ = planted_motion(np.random.default_rng(number), poses=4)
    return Problem(task=task, requirements=Requirements(transmission_over=_OVER[number % 2]))


def random(number: int) -> Problem:
    """Poses drawn at random, default limits; every other one with any rotatability."""
    rng = np.random.default_rng(1000 + number)
    poses = np.column_stack([rng.uniform(0, 1, (4, 2)), rng.uniform(-60, 60, 4)])
    rotatability = (Rotatability.FULL_CRANK, Rotatability.ANY)[number % 2]
    return Problem(task=MotionTask.from_degrees(poses), requirements=Requirements(rotatability=rotatability))


def practical(number: int) -> Problem:
    """The luggage task with other limits of lengths and arms."""
    rng = np.random.default_rng(2000 + number)
    lengths = (float(rng.uniform(0.2, 2)), float(rng.uniform(4, 14)))
    problem = load("luggage")
    wanted = replace(
        problem.requirements, link_length=lengths, coupler_arms=lengths, transmission_min_deg=0.0,
        transmission_over=_OVER[number % 2],
    )  # fmt: skip
    return replace(problem, requirements=wanted)


def boxed(number: int) -> Problem:
    """A planted task with boxes, a fifth of a size to one size wide, about its ground pivots or near them."""
    rng = np.random.default_rng(3000 + number)
    task, linkage = planted_motion(rng, poses=4)
    boxes = {}
    for name in ("o2", "o4"):
        middle = getattr(linkage, name) + task.size * rng.uniform(-0.3, 0.3, 2)
        half = task.size * rng.uniform(0.1, 0.5)
        boxes[name] = Box(*((float(x) - half, float(x) + half) for x in middle))
    size = float(task.size)
    wanted = Requirements(link_length=(0.1 * size, 3 * size), o2=boxes["o2"], o4=boxes["o4"])
    return Problem(task=task, requirements=wanted)


def proven(problem: Problem) -> Proof:
    """The proof of four poses within the usual budget."""
    bounds = bounds_of(ScaledProblem.of(problem), Proving())
    if bounds is None:
        raise ValueError("a task without proofs")
    lower = float(np.degrees(bounds.lower)) or None
    return proof_of(problem, bounds, lower, Proving().gap)


def five_poses(number: int) -> bool:
    """Whether all dyads of five random poses within 50 sizes are counted."""
    rng = np.random.default_rng(4000 + number)
    poses = np.column_stack([rng.uniform(-0.5, 0.5, (5, 2)), rng.uniform(-180, 180, 5)])
    task = MotionTask.from_degrees(poses)
    reach = 50.0 * task.size
    wanted = Requirements(link_length=(1e-6, reach), coupler_arms=(0.0, reach))
    made = certified_poses(ScaledProblem.of(Problem(task=task, requirements=wanted)))
    return made is not None and made.complete


def random_function(number: int, count: int) -> Problem:
    """A function of random pairs, in either sense."""
    rng = np.random.default_rng(5000 + number)
    turned, output = np.sort(rng.uniform(0, 120, count)), np.sort(rng.uniform(0, 90, count))
    output *= rng.choice([-1, 1])
    return Problem(task=FunctionTask.from_degrees(turned - turned[0], output - output[0]))


def five_pairs(number: int) -> bool:
    """Whether all four-bars through five random pairs are known."""
    made = certified_functions(ScaledProblem.of(random_function(number, 5)))
    return made is not None and made.complete


def four_pairs(number: int) -> bool:
    """Whether the best four-bar through four random pairs, or its absence, is proven."""
    made = bounds_of_pairs(ScaledProblem.of(random_function(number, 4)), Proving())
    return made is not None and made.closed


def three_pairs(number: int) -> bool:
    """Whether the best of a list through three random pairs, or its absence, is proven."""
    proof = synthesize(random_function(number, 3)).proof
    return proof is not None and proof.claim in (Claim.BEST, Claim.NONE)


def stroke(number: int) -> bool:
    """Whether the best crank-rocker of a random swing and time ratio, or its absence, is proven."""
    rng = np.random.default_rng(6000 + number)
    task = StrokeTask(swing=np.radians(rng.uniform(20, 120)), time_ratio=rng.uniform(1, 1.6))
    made = bounds_of(ScaledProblem.of(Problem(task=task)), Proving())
    return made is not None and made.closed


def of_poses(draw: Callable[[int], Problem], count: int, seed: int) -> Iterator[str]:
    """Claims proven for four poses; tasks that stay open, each with its reason."""
    claims, seconds = Counter[Claim](), []
    for number in range(seed, seed + count):
        proof, took = timed(lambda: proven(draw(number)), process_time)  # noqa: B023
        claims[proof.claim] += 1
        seconds.append(took)
        if proof.claim not in (Claim.BEST, Claim.NONE):
            yield (
                f"task {number}: {proof.claim} {proof.lower} to {proof.upper} deg, {proof.pairs} pairs; "
                f"{proof.why}"
            )
    yield f"{', '.join(f'{claim} {each}' for claim, each in sorted(claims.items()))}; {spread(seconds)}"


def compared(count: int, seed: int) -> Iterator[str]:
    """Searches of random tasks of any rotatability with ten times the effort, against the bounds."""
    for number in range(2 * seed + 1, 2 * (seed + count), 2):
        found = synthesize(random(number), effort=10, enough=500, starts=500).candidates
        best = np.degrees(max((one.values["transmission_min_task"] for one in found), default=0.0))
        proof = proven(random(number))
        upper = 90.0 if proof.upper is None else proof.upper
        above = " !" * bool(best > upper + _ROUNDING)
        yield f"task {number}: search {best:.4f} deg; {proof.claim} {upper:.4f} deg{above}"


def decided(decide: Callable[[int], bool], count: int, seed: int) -> Iterator[str]:
    """Number of tasks decided, and the time taken."""
    runs = [timed(partial(decide, number), process_time) for number in range(seed, seed + count)]
    yield f"{sum(done for done, _ in runs)} of {count} decided; {spread([took for _, took in runs])}"


CASES = [
    *(Case(f"four poses, {draw.__name__}", 50, partial(of_poses, draw))
      for draw in (planted, random, practical, boxed)),
    Case("searches against bounds", 60, compared),
    *(Case(decide.__name__.replace("_", " "), 200, partial(decided, decide))
      for decide in (five_poses, five_pairs, four_pairs, three_pairs, stroke)),
]  # fmt: skip
