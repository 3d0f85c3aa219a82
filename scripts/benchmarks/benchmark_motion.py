"""Measure motion generation: times after imports, best designs, planted problems, five-pose dyads.

Prints one line a case. Times are wall-clock medians on this machine; run it on a quiet one.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np

from grashof import load, synthesize
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, Problem, Requirements, Rotatability, TransmissionOver
from grashof.synth import Progress
from grashof.synth.theory.burmester import Displacements
from grashof.synth.theory.five_poses import five_pose_dyads, five_pose_dyads_of_sets

UPPER = Box(y=(0, np.inf))


def cycle(limit: float) -> Requirements:
    """Full crank, judged over the turn, links from 0.3 and coupler arms from 0 up to a limit."""
    return Requirements(
        transmission_over=TransmissionOver.CYCLE, link_length=(0.3, limit), coupler_arms=(0, limit)
    )


# What is asked, the worst transmission angle wanted in deg, and the requirements.
RECORDS = (
    ("full-crank, cycle, limit 5", 13.4, cycle(5)),
    ("full-crank, cycle, limit 8", 22.6, cycle(8)),
    ("full-crank, cycle, limit 12", 30.1, cycle(12)),
    ("full-crank, cycle, limit 8, O2 and O4 at y >= 0", 15.7, replace(cycle(8), o2=UPPER, o4=UPPER)),
    (
        "any, task, limit 5",
        23.7,
        replace(cycle(5), rotatability=Rotatability.ANY, transmission_over=TransmissionOver.TASK),
    ),
)


def luggage_time(workers: int, runs: int) -> None:
    """Time of the shipped luggage problem, with this many workers."""
    problem, seconds = load("luggage"), []
    for _ in range(runs):
        begun = perf_counter()
        result = synthesize(problem, workers=workers)
        seconds.append(perf_counter() - begun)
    worst = max(candidate.verdict.error_max for candidate in result.candidates) / problem.task.size
    print(
        f"luggage, {workers} workers: {len(result)} designs, largest error {worst:.1e} sizes, "
        f"median {np.median(seconds):.2f} s, range {min(seconds):.2f} to {max(seconds):.2f} s"
    )


def luggage_records() -> None:
    """Best worst-case transmission angle found under various limits."""
    problem = load("luggage")
    for name, least, wanted in RECORDS:
        begun = perf_counter()
        result = synthesize(replace(problem, requirements=wanted))
        seconds = perf_counter() - begun
        best = np.degrees(max(each.values["transmission"] for each in result.candidates))
        print(f"luggage, {name}: {best:.3f} deg (wanted {least}), {len(result)} designs, {seconds:.2f} s")


def luggage_keep_out() -> None:
    """Ground pivots kept out of the staircase as a solid that ends at x = 9, and of one that goes on."""
    problem = load("luggage")
    for name, (right, bottom) in {"ends at x = 9": (9, -9), "goes on": (30, -30)}.items():
        solid = np.array([[0, bottom], [0, 0], [5, 0], [5, 4], [right, 4], [right, bottom]])
        for limit, rotatability in ((8, Rotatability.ANY), (12, Rotatability.FULL_CRANK)):
            wanted = replace(
                cycle(limit),
                rotatability=rotatability,
                transmission_over=TransmissionOver.TASK,
                keep_out=(solid,),
            )
            begun = perf_counter()
            result = synthesize(replace(problem, requirements=wanted))
            seconds = perf_counter() - begun
            found = result.note
            if result.candidates:
                best = np.degrees(max(each.verdict.transmission_min_task for each in result.candidates))
                found = f"{best:.3f} deg, {len(result)} designs"
            print(
                f"luggage, stairs kept out ({name}), {rotatability}, limit {limit}: {found}, {seconds:.2f} s"
            )


def planted(count: int, seed: int) -> None:
    """Random four-pose tasks of random full-crank four-bars, under default requirements."""
    seconds: list[float] = []
    designs: list[int] = []
    first: list[float] = []
    for number in range(count):
        task, _ = planted_motion(np.random.default_rng([seed, number]), poses=4)
        reached: list[float] = []
        begun = perf_counter()

        def note(step: Progress, begun: float = begun, reached: list[float] = reached) -> None:
            if step.verified and not reached:
                reached.append(perf_counter() - begun)

        result = synthesize(Problem(task=task), progress=note)
        seconds.append(perf_counter() - begun)
        designs.append(len(result))
        first += reached
    solved = int(np.count_nonzero(designs))
    print(
        f"planted: {solved} of {count} solved, median {np.median(designs):.0f} designs, "
        f"median {np.median(seconds):.2f} s, 95th percentile {np.percentile(seconds, 95):.2f} s, "
        f"first batch of designs after {np.median(first):.2f} s (median)"
    )


def five_poses(sets: int, seed: int) -> None:
    """All dyads of random sets of five poses, in one batch and one by one."""
    rng = np.random.default_rng(seed)
    positions = rng.normal(size=(sets, 5, 2)) @ np.array([1, 1j])
    angles = rng.uniform(-np.pi, np.pi, (sets, 5))
    motions = [Displacements.from_poses(*poses) for poses in zip(positions, angles, strict=True)]
    rotation, shift = (np.array([getattr(one, part) for one in motions]) for part in ("rotation", "shift"))
    begun = perf_counter()
    dyads = five_pose_dyads_of_sets(rotation, shift)
    batch = perf_counter() - begun
    begun = perf_counter()
    for motion in motions:
        five_pose_dyads(motion)
    single = perf_counter() - begun
    radii = np.abs(dyads.moving[..., None] * rotation[:, None] + shift[:, None] - dyads.ground[..., None])
    share = np.bincount(np.isfinite(dyads.moving).sum(axis=1), minlength=5) / sets
    print(
        f"five poses, {sets} random sets: {batch / sets * 1e6:.0f} us a set in one batch, "
        f"{single / sets * 1e6:.0f} us one by one, largest error {np.nanmax(np.ptp(radii, axis=-1)):.1e}, "
        f"0, 2 and 4 dyads in {share[0]:.1%}, {share[2]:.1%} and {share[4]:.1%}"
    )


def main(argv: Sequence[str] | None = None) -> int:
    """Run all measurements."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--planted", type=int, default=100, help="number of planted problems")
    parser.add_argument("--runs", type=int, default=5, help="repetitions of the timed case")
    parser.add_argument("--sets", type=int, default=3000, help="random sets of five poses")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(argv)
    synthesize(load("luggage"), enough=1)  # imports and the first build of the programme
    for workers in (1, 2):
        luggage_time(workers, options.runs)
    luggage_records()
    luggage_keep_out()
    planted(options.planted, options.seed)
    five_poses(options.sets, options.seed)
    return 0


if __name__ == "__main__":
    sys.exit(main())
