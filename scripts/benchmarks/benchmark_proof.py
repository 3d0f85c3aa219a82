"""How many tasks of four poses have their best design proven, or that there is none, and in what time.

python scripts/benchmarks/benchmark_proof.py               # 200 tasks, planted, random, with practical limits
python scripts/benchmarks/benchmark_proof.py --compare 60  # of random ones also a long search
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from time import process_time

import numpy as np

from grashof import load, synthesize
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, FunctionTask, MotionTask, Problem, Requirements, StrokeTask
from grashof.synth import Claim, Proof
from grashof.synth.proof.claims.bounds import Proving
from grashof.synth.proof.claims.proof import proof_of
from grashof.synth.proof.functions.few_pairs import bounds_of_pairs
from grashof.synth.proof.functions.five_pairs import certified_functions
from grashof.synth.proof.poses.five_poses import certified_poses
from grashof.synth.proof.provers import bounds_of
from grashof.synth.quantities.scaled_problem import ScaledProblem

EACH = 50
_OVER = ("task", "cycle")
EFFORT = 10
_ROUNDING = 1e-6  # deg


def planted(number: int) -> Problem:
    """Poses of a linkage drawn at random, default limits."""
    task, _ = planted_motion(np.random.default_rng(number), poses=4)
    return Problem(task=task, requirements=Requirements(transmission_over=_OVER[number % 2]))  # type: ignore[arg-type]


def random(number: int) -> Problem:
    """Poses drawn at random, default limits; every other one with any rotatability."""
    rng = np.random.default_rng(1000 + number)
    poses = np.column_stack([rng.uniform(0, 1, (4, 2)), rng.uniform(-60, 60, 4)])
    rotatability = ("full-crank", "any")[number % 2]
    return Problem(
        task=MotionTask.from_degrees(poses),
        requirements=Requirements(rotatability=rotatability),  # type: ignore[arg-type]
    )


def practical(number: int) -> Problem:
    """The luggage task with other limits of lengths and arms."""
    rng = np.random.default_rng(2000 + number)
    lengths = (float(rng.uniform(0.2, 2)), float(rng.uniform(4, 14)))
    problem = load("luggage")
    wanted = replace(
        problem.requirements,
        link_length=lengths,
        coupler_arms=lengths,
        transmission_min_deg=0.0,
        transmission_over=_OVER[number % 2],  # type: ignore[arg-type]
    )
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


GROUPS = {"planted": planted, "random": random, "practical": practical, "boxes": boxed}


def tasks(each: int) -> Iterator[tuple[str, Problem]]:
    """Tasks of each group, with their names."""
    for name, made in GROUPS.items():
        for number in range(each):
            yield f"{name} {number}", made(number)


def proven(problem: Problem) -> tuple[Proof, float]:
    """What is proven within the usual budget, and the processor time that it takes, s."""
    scaled, since = ScaledProblem.of(problem), process_time()
    bounds = bounds_of(scaled, Proving())
    if bounds is None:
        raise ValueError("a task without proofs")
    lower = float(np.degrees(bounds.lower)) or None
    return proof_of(problem, bounds, lower, Proving().gap), process_time() - since


def compared(number: int) -> tuple[float, Proof]:
    """The best of a search with ten times the effort, deg, and what is proven of the same task."""
    problem = random(2 * number + 1)
    found = synthesize(problem, effort=EFFORT, enough=500, starts=500)
    best = max((one.values["transmission_min_task"] for one in found.candidates), default=0.0)
    return float(np.degrees(best)), proven(problem)[0]


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
    """Whether the best four-bar through four random pairs is proven, or that there is none."""
    made = bounds_of_pairs(ScaledProblem.of(random_function(number, 4)), Proving())
    return made is not None and made.closed


def three_pairs(number: int) -> bool:
    """Whether the best of a list through three random pairs is proven, or that there is none."""
    proof = synthesize(random_function(number, 3)).proof
    return proof is not None and proof.claim in (Claim.BEST, Claim.NONE)


def stroke(number: int) -> bool:
    """Whether the best crank-rocker of a random swing and time ratio is proven, or that there is none."""
    rng = np.random.default_rng(6000 + number)
    task = StrokeTask(swing=np.radians(rng.uniform(20, 120)), time_ratio=rng.uniform(1, 1.6))
    made = bounds_of(ScaledProblem.of(Problem(task=task)), Proving())
    return made is not None and made.closed


def others(count: int) -> None:
    """Print how many of other tasks are decided, and in what time."""
    for decided in (five_poses, five_pairs, four_pairs, three_pairs, stroke):
        done, times = 0, []
        for number in range(count):
            since = process_time()
            done += decided(number)
            times.append(process_time() - since)
        name = decided.__name__.replace("_", " ")
        print(f"{name}: {done} of {count} decided; median {np.median(times):.2f} s, most {max(times):.2f} s")


def main(argv: Sequence[str] | None = None) -> int:
    """Print what is proven of each group of tasks; return 0 unless a search is better than a bound."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--each", type=int, default=EACH, help="tasks of each of the four groups")
    parser.add_argument(
        "--compare", type=int, default=0, help="tasks that are also searched, with ten times the effort"
    )
    parser.add_argument(
        "--others", type=int, default=0, help="sets of five poses, of five, four and three pairs, and strokes"
    )
    options = parser.parse_args(argv)
    if options.others:
        others(options.others)
        return 0
    above = 0
    for number in range(options.compare):
        best, proof = compared(number)
        upper = 90.0 if proof.upper is None else proof.upper
        above += best > upper + _ROUNDING
        print(f"random {2 * number + 1}: search {best:.4f} deg; {proof.claim} {upper:.4f} deg", flush=True)
    if options.compare:
        print(f"searches above the bound: {above} of {options.compare}")
        return int(above > 0)
    claims, times, open_ = Counter[tuple[str, Claim]](), [], []
    for name, problem in tasks(options.each):
        proof, seconds = proven(problem)
        claims[name.split()[0], proof.claim] += 1
        times.append(seconds)
        if proof.claim not in (Claim.BEST, Claim.NONE):
            open_.append(
                f"{name}: {proof.claim} {proof.lower} to {proof.upper} deg, {proof.pairs} pairs; {proof.why}"
            )
    for (group, claim), count in sorted(claims.items()):
        print(f"{group:10} {claim:8} {count}")
    print(*open_, sep="\n")
    most = f"median {np.median(times):.2f} s, 95 % {np.quantile(times, 0.95):.2f} s, most {max(times):.2f} s"
    print(f"{len(times) - len(open_)} of {len(times)} decided; processor time {most}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
