"""Measure path generation: published cases, planted problems, closed curves; times after imports.

Prints one line a case. Times are wall-clock on this machine; run it on a quiet one.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from time import perf_counter, process_time

import numpy as np
from scipy.optimize import least_squares

from grashof import load, synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import planted_path
from grashof.problems import FourBar, PathTask, Problem, Requirements, Rotatability
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth import Result


def timed(run: Callable[[], Result]) -> tuple[Result, float]:
    """A result and the time it took, s."""
    begun = perf_counter()
    result = run()
    return result, perf_counter() - begun


def published(seeds: int) -> None:
    """The published cases: designs or error, and time."""
    for name in ("path-vertical-line", "path-18-timed", "path-ellipse"):
        problem = load(name)
        exact = problem.requirements.is_exact(problem.task)
        enough, seconds, lines = (None if exact else 1), [], []
        for seed in range(seeds):
            result, time = timed(lambda: synthesize(problem, enough=enough, seed=seed))  # noqa: B023
            seconds.append(time)
            best = min((each.verdict for each in result.candidates), key=lambda each: each.square)
            angle = np.degrees(best.transmission_min_task)
            lines.append(f"{len(result)} designs, SSE {best.error_sse:.7g}, mu {angle:.1f} deg")
        print(f"{name}: median {np.median(seconds):.2f} s, max {max(seconds):.2f} s; {lines[0]}; {lines[-1]}")


def planted(points: int, count: int, is_timed: bool) -> None:
    """Random tasks of random full-crank four-bars: until the first design."""
    seconds, errors = [], []
    for number in range(count):
        task, _ = planted_path(np.random.default_rng([2, number]), points, timed=is_timed)
        problem = Problem(task=task)
        result, time = timed(lambda: synthesize(problem, enough=1))  # noqa: B023
        seconds.append(time)
        found = result.candidates
        errors.append(found[0].verdict.error_max / task.size if found else np.inf)
    kind = "timed" if is_timed else "free"
    good = int(np.count_nonzero(np.array(errors) <= 1e-6))
    print(
        f"planted, {points} {kind} points: {good} of {count} to 1e-6 sizes, "
        f"median {np.median(seconds):.3f} s, "
        f"95th percentile {np.percentile(seconds, 95):.3f} s, longest {max(seconds):.2f} s"
    )


def interpolated(seeds: int) -> None:
    """All linkages through nine points near a circle, in any order: triplets among the designs."""
    problem, size = load("nine-points"), load("nine-points").task.size
    for seed in range(seeds):
        result, time = timed(lambda: synthesize(problem, enough=200, seed=seed))  # noqa: B023
        triplets: list[ComplexArray] = []
        for candidate in result.candidates:
            linkage = candidate.linkage
            o2, o4 = complex(*linkage.o2), complex(*linkage.o4)
            o6 = o2 + (o4 - o2) * complex(*linkage.coupler_point) / linkage.r3
            pivots = np.array([o2 + o4 + o6, o2 * o4 + o4 * o6 + o6 * o2])
            if all(np.abs(pivots - other).max() > 1e-4 * size for other in triplets):
                triplets.append(pivots)
        print(f"near-circle nine points: {len(result)} designs, {len(triplets)} triplets in {time:.1f} s")


def fourier_curve(rng: np.random.Generator, points: int) -> PathTask:
    """A smooth closed curve of three harmonics, in `points` points."""
    angle = np.linspace(0, 2 * np.pi, points, endpoint=False)
    curve = np.exp(1j * angle)
    for k in (-1, 2, -2, 3, -3):
        weight = 0.4 / abs(k) ** 1.5
        curve = curve + weight * complex(*rng.normal(size=2)) * np.exp(1j * k * angle)
    return PathTask(np.stack([curve.real, curve.imag], axis=-1), closed=True)


def scipy_best(task: PathTask, wanted: Requirements, rng: np.random.Generator, starts: int) -> float:
    """Best rms error in sizes that plain scipy least squares reaches, of results the judge accepts.

    Full cranks by construction (r1 = 1, then scaled), all driver angles free, from random starts with
    the angles in order: what a programmer would write who knows the problem.
    """
    size = task.size
    points = (task.points - task.points.mean(axis=0)) / size
    count = len(points)

    def linkage(x: FloatArray) -> FourBar:
        r2 = 1 / (1 + np.exp(-x[0]))
        total, difference = 1 + r2 + np.exp(x[1]), (1 - r2) * np.tanh(x[2])
        scale, direction, o2 = np.exp(x[3]), x[4], x[5:7]
        o4 = o2 + scale * np.array([np.cos(direction), np.sin(direction)])
        r3, r4 = (total + difference) / 2, (total - difference) / 2
        return FourBar(o2, o4, scale * r2, scale * r3, scale * r4, scale * x[7:9], sign)

    def residual(x: FloatArray) -> FloatArray:
        gaps: FloatArray = (solve_position(linkage(x), x[9:]).p - points).ravel()
        return gaps

    best = np.inf
    for _ in range(starts):
        sign, sense = rng.choice([-1, 1], 2)
        angles = rng.uniform(-np.pi, np.pi) + sense * np.linspace(0, 2 * np.pi, count, endpoint=False)
        x0 = np.concatenate([rng.normal(0, 1, 4), rng.uniform(-np.pi, np.pi, 1), rng.normal(0, 1, 4), angles])
        found = linkage(least_squares(residual, x0, max_nfev=200).x)
        placed = FourBar(
            found.o2 * size + task.points.mean(axis=0),
            found.o4 * size + task.points.mean(axis=0),
            found.r2 * size,
            found.r3 * size,
            found.r4 * size,
            found.coupler_point * size,
            sign,
        )
        verdict = verify(placed, task, wanted)
        if verdict.ok:
            best = min(best, verdict.error_rms / size)
    return best


def closed_curves(count: int, starts: int) -> None:
    """Curves that no four-bar traces, against scipy from many starts: same judge, times of the processor."""
    wanted = Requirements(rotatability=Rotatability.CRANK_ROCKER)
    times, ratios, worse = [], [], 0
    for number in range(count):
        task = fourier_curve(np.random.default_rng([3, number]), 24)
        begun = process_time()
        result = synthesize(Problem(task=task, requirements=wanted))
        times.append(process_time() - begun)
        ours = min((each.verdict.error_rms for each in result.candidates), default=np.inf) / task.size
        line = f"closed curve {number}: rms error {ours:.6f} sizes in {times[-1]:.2f} s"
        if starts:
            begun = process_time()
            theirs = scipy_best(task, wanted, np.random.default_rng(number), starts)
            ratios.append((process_time() - begun) / times[-1])
            worse += ours > theirs * (1 + 1e-6)
            line += f"; scipy ({starts} starts) {theirs:.6f}, {ratios[-1]:.0f} times as long"
        print(line, flush=True)
    print(f"closed curves: median {np.median(times):.2f} s, longest {max(times):.2f} s")
    if ratios:
        fastest = f"median {np.median(ratios):.0f} times as fast, at least {min(ratios):.0f} times"
        print(f"worse than scipy on {worse} of {count}; {fastest}")


def main(argv: Sequence[str] | None = None) -> int:
    """Run all measurements."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--nine", type=int, default=200, help="planted nine-point problems")
    parser.add_argument("--timed", type=int, default=100, help="planted timed problems of each kind")
    parser.add_argument("--closed", type=int, default=30, help="closed curves")
    parser.add_argument(
        "--scipy", type=int, default=60, help="starts of the scipy comparison; 0 leaves it out"
    )
    parser.add_argument("--seeds", type=int, default=5, help="seeds of the published cases")
    options = parser.parse_args(argv)
    for points in (9, 6):  # imports and the first build of the programmes
        synthesize(Problem(task=planted_path(np.random.default_rng(0), points)[0]), enough=1)
    published(options.seeds)
    if options.nine:
        planted(9, options.nine, is_timed=False)
    for points in (6, 12, 24) if options.timed else ():
        planted(points, options.timed, is_timed=True)
    interpolated(min(options.seeds, 2))
    if options.closed:
        closed_curves(options.closed, options.scipy)
    return 0


if __name__ == "__main__":
    sys.exit(main())
