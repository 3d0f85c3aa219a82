"""Measure motion generation for any number of poses: planted tasks, noisy ones, three poses.

Prints one line a case. Times are wall-clock on this machine, after imports; run it on a quiet one.
"""

import argparse
import sys
from collections.abc import Sequence
from time import perf_counter

import numpy as np

from grashof import synthesize
from grashof.analysis import verify, worst_transmission_cycle
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import FourBar, MotionTask, Problem, Requirements, TransmissionOver
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import attempt

NOISE = 0.01  # of the size in position, rad in angle


def planted_task(seed: Sequence[int], poses: int) -> tuple[MotionTask, FourBar]:
    """A task whose planted linkage meets the default requirements itself."""
    rng = np.random.default_rng(list(seed))
    while True:
        task, linkage = planted_motion(rng, poses)
        if verify(linkage, task, Requirements(exact=True)).ok:
            return task, linkage


def planted(poses: int, count: int) -> None:
    """Exact tasks: time to the first verified design."""
    seconds, solved, any_margin = [], 0, 0
    for number in range(count):
        task, _ = planted_task([4, poses, number], poses)
        begun = perf_counter()
        result = synthesize(Problem(task=task, requirements=Requirements(exact=True)), enough=1)
        seconds.append(perf_counter() - begun)
        solved += len(result) > 0
        as_drawn, linkage = planted_motion(np.random.default_rng([4, poses, number]), poses)
        any_margin += not verify(linkage, as_drawn, Requirements(exact=True)).ok
    print(
        f"planted, {poses} poses: {solved} of {count} solved, median {np.median(seconds):.3f} s, "
        f"95th percentile {np.percentile(seconds, 95):.3f} s "
        f"({any_margin} linkages drawn missed the default requirements themselves and were drawn anew)"
    )


def noisy(poses: int, count: int) -> None:
    """Least squares of planted tasks with noise, against the planted linkage polished by the programme."""
    seconds, good = [], 0
    for number in range(count):
        rng = np.random.default_rng([5, poses, number])
        task, linkage = planted_motion(rng, poses)
        task = MotionTask(
            task.positions + rng.normal(0, NOISE * task.size, task.positions.shape),
            task.angles + rng.normal(0, NOISE, poses),
        )
        problem = Problem(task=task, requirements=Requirements(exact=False))
        begun = perf_counter()
        result = synthesize(problem)
        seconds.append(perf_counter() - begun)
        scaled, verdict = ScaledProblem.of(problem), verify(linkage, task, problem.requirements)
        polished = attempt(scaled, Start.of_linkage(scaled, linkage, verdict), 0).candidate
        theirs = [found.square for found in (verdict, polished and polished.verdict) if found and found.ok]
        ours = min((each.verdict.square for each in result.candidates), default=np.inf)
        good += ours <= min(theirs, default=np.inf) * (1 + 1e-6)
    print(
        f"noisy, {poses} poses: no worse than the planted linkage polished in {good} of {count}, "
        f"median {np.median(seconds):.2f} s"
    )


def random_three_pose_linkages(task: MotionTask, count: int, rng: np.random.Generator) -> FloatArray:
    """Worst transmission over the turn (rad) of plain random linkages that meet three poses; 0 if they fail.

    Moving pivots are drawn about the first pose, ground pivots are the centres of their circles.
    """
    turned = np.exp(1j * (task.angles - task.angles[0]))
    places = task.positions @ np.array([1, 1j])
    joints = []
    for _ in range(2):
        offset = task.size * np.exp(rng.uniform(-3, 2, count) + 1j * rng.uniform(-np.pi, np.pi, count))
        joints.append(places[:, None] + turned[:, None] * offset)
    grounds = [_centre(*joint) for joint in joints]
    (a, b), (o2, o4) = joints, grounds
    r2, r3, r4 = np.abs(a[0] - o2), np.abs(b[0] - a[0]), np.abs(b[0] - o4)
    r1 = np.abs(o4 - o2)
    wanted = Requirements(exact=True).resolved(task.size)
    low, high = np.array(wanted.link_lengths).T
    lengths = np.stack([r1, r2, r3, r4], axis=-1)
    good = ((lengths >= low) & (lengths <= high)).all(axis=-1)
    good &= lengths.max(axis=-1) <= wanted.link_ratio_max * lengths.min(axis=-1)
    margin = np.minimum(r3 + r4 - r1 - r2, np.abs(r1 - r2) - np.abs(r3 - r4)) / lengths.sum(axis=-1)
    good &= margin >= wanted.rotatability_margin
    sine = ((b - a).conj() * (b - o4)).imag
    good &= (sine > 0).all(axis=0) | (sine < 0).all(axis=0)
    step = np.angle((a[1:] - o2) / (a[:-1] - o2)) % (2 * np.pi)
    good &= (step.sum(axis=0) <= 2 * np.pi) | ((2 * np.pi - step).sum(axis=0) <= 2 * np.pi)
    rows = np.flatnonzero(good)
    linkages = FourBar(
        np.stack([o2.real, o2.imag], -1)[rows], np.stack([o4.real, o4.imag], -1)[rows],
        r2[rows], r3[rows], r4[rows], np.zeros((len(rows), 2)),
    )  # fmt: skip
    worst = np.zeros(count)
    worst[rows] = worst_transmission_cycle(linkages)
    return worst


def _centre(first: ComplexArray, second: ComplexArray, third: ComplexArray) -> ComplexArray:
    p, q = second - first, third - first
    cross = 2 * (p.conj() * q).imag
    centre: ComplexArray = first + 1j * (p * np.abs(q) ** 2 - q * np.abs(p) ** 2) / cross
    return centre


def three_poses(count: int, samples: int) -> None:
    """Best worst transmission over the turn, against the best of plain random samples."""
    behind, seconds, gain = 0, [], []
    for number in range(count):
        rng = np.random.default_rng([7, number])
        task, _ = planted_motion(rng, 3)
        wanted = Requirements(exact=True, transmission_over=TransmissionOver.CYCLE)
        begun = perf_counter()
        result = synthesize(Problem(task=task, requirements=wanted))
        seconds.append(perf_counter() - begun)
        ours = max((each.verdict.transmission_min_cycle for each in result.candidates), default=0.0)
        theirs = float(random_three_pose_linkages(task, samples, rng).max())
        behind += ours < theirs - 1e-9
        gain.append(np.degrees(ours - theirs))
    print(
        f"three poses: behind the best of {samples} samples on {behind} of {count}, median lead "
        f"{np.median(gain):.1f} deg, least {min(gain):.2f} deg, median {np.median(seconds):.2f} s"
    )


def main(argv: Sequence[str] | None = None) -> int:
    """Run all measurements."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100, help="tasks of each kind")
    parser.add_argument("--sets", type=int, default=30, help="sets of three poses")
    parser.add_argument("--samples", type=int, default=1_000_000, help="random linkages for each of them")
    options = parser.parse_args(argv)
    for poses in (4, 6):  # imports and the first build of the programmes
        synthesize(Problem(task=planted_task([0], poses)[0]), enough=1)
    for poses in (3, 4, 5, 6, 8, 12, 40):
        planted(poses, options.count)
    for poses in (6, 8, 12, 40):
        noisy(poses, options.count)
    three_poses(options.sets, options.samples)
    return 0


if __name__ == "__main__":
    sys.exit(main())
