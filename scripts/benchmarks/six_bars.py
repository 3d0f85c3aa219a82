"""Six-bars: planted tasks, closed curves beside four-bars, functions, Klann's leg, and five smooth poses.

Times are those of the processor, imports apart, of whole searches with the judge; a line ends with "!" where
fewer tasks are solved, or errors are greater, than stated. Smooth poses are a cubic spline of position and
angle through three random ones, turning by 60 to 90 deg; that line ends with "!" where fewer than nine sets
of ten have six-bars, the median number is below 100, the median time above 2 s, or the judge rejects one.
"""

from collections.abc import Callable, Iterator
from functools import partial
from time import process_time
from typing import Any

import numpy as np
from measuring import Case, timed
from scipy.interpolate import CubicSpline

from grashof import load, synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import planted_function, planted_motion, planted_path
from grashof.problems import (
    FunctionTask,
    MotionTask,
    PathTask,
    Problem,
    Requirements,
    Rotatability,
    SixBar,
    Task,
    load_linkage,
)  # fmt: skip
from grashof.problems.values.tasks.closed_curve import even_places
from grashof.synth.designs.candidate import Candidate
from grashof.synth.quantities.frame import Frame
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import attempt
from grashof.synth.starts.six_bars.finder import SixBars
from grashof.synth.theory.six_bars.five_poses import six_bars_through

CURVE = 48  # points of closed curves
FOOT = 30  # foot points of Klann's leg
DEG = float(np.degrees(1.0))
WORDS = "watt-1", "stephenson-1", "stephenson-3"
JUDGED = 20  # of a set, from the best to the worst


def rms(one: Candidate) -> float:
    """Error of positions, sizes."""
    return one.verdict.error_rms / one.problem.task.size


def both(one: Candidate) -> float:
    """Error of positions and angles together, sizes."""
    return float(np.sqrt(one.verdict.square / len(one.problem.task))) / one.problem.task.size


def at_pairs(one: Candidate) -> float:
    """Greatest error at the pairs of a function, rad."""
    return float(np.abs(one.verdict.output_error).max())


def solved(
    draw: Callable[[np.random.Generator], tuple[Any, ...]],
    error: Callable[[Candidate], float],
    limits: dict[float, int],
    most: float,
    count: int,
    seed: int,
) -> Iterator[str]:
    """Errors that a search reaches within `most` seconds a task, and how many of twenty are to reach them."""
    least, times, strictest = [], [], min(limits)
    for number in range(seed, seed + count):
        task = draw(np.random.default_rng([7, number]))[0]
        wide: dict[str, Any] = dict.fromkeys(
            ("link_length", "coupler_arms") if task.in_plane else (), (0.0, 1e3)
        )
        wanted = Requirements(exact=False, **wide)
        scaled = ScaledProblem.of(Problem(task=task, mechanism="stephenson-3", requirements=wanted))
        finder, rng, best, begun = SixBars(scaled), np.random.default_rng(number), np.inf, process_time()
        while best > strictest and process_time() - begun < most:
            found = finder.round(0, 1, rng, 1)
            for each in found.starts[:1] if found is not None else ():
                done = attempt(scaled, each, 0)
                best = min(best, error(done.candidate) if done.verified and done.candidate else np.inf)
        least.append(best)
        times.append(process_time() - begun)
    reached = {limit: sum(error <= limit for error in least) for limit in limits}
    sound = all(reached[limit] * 20 >= wanted * count for limit, wanted in limits.items())
    said = ", ".join(f"{number} within {limit:g}" for limit, number in reached.items())
    yield f"of {count}: {said}; median {np.median(times):.2f} s{'' if sound else ' !'}"


def even(corners: np.ndarray[Any, Any]) -> PathTask:
    """Even points on a closed polygon, of rms radius 1."""
    ring = np.append(corners, corners[0])
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(ring)))])
    at = np.arange(CURVE) * along[-1] / CURVE
    z = np.interp(at, along, ring.real) + 1j * np.interp(at, along, ring.imag)
    z = (z - z.mean()) / np.sqrt((np.abs(z - z.mean()) ** 2).mean())
    return PathTask(np.stack([z.real, z.imag], axis=1), closed=True)


def gait() -> PathTask:
    """The gait of the catalogue by its closed spline."""
    x, y = even_places(PathTask(load("path-gait").task.positions, closed=True).once_round, 2000).T
    return even(x + 1j * y)


TURN = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
HALF = np.linspace(0, np.pi, 1000)
# Curves, and how many times smaller than a four-bar's the error is to be.
CURVES: dict[str, tuple[Callable[[], PathTask], float]] = {
    "eight": (lambda: even(np.cos(TURN) + 0.5j * np.sin(2 * TURN)), 100),
    "triangle": (lambda: even(np.exp(1j * (np.pi / 2 + np.arange(3) * 2 * np.pi / 3))), 4),
    "square": (lambda: even(np.array([1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j])), 2.5),
    "foot": (lambda: even(np.append(np.cos(HALF) + 0.6j * np.sin(HALF), [-1, 1])), 2.5),
    "gait": (gait, 2.2),
}


def least(task: Task, mechanism: str | list[str], seed: int, **wanted: Any) -> tuple[float, float]:
    """The least error of a list, and the processor time of its search."""
    problem = Problem(task=task, mechanism=mechanism, requirements=Requirements(**wanted))
    result, seconds = timed(partial(synthesize, problem, seed=seed), process_time)
    if task.has_output.any():
        return min(
            (abs(one.verdict.structural_error_max) * DEG for one in result.candidates), default=np.inf
        ), seconds
    return min((one.verdict.error_rms for one in result.candidates), default=np.inf), seconds


def closed_curve(name: str, count: int, seed: int) -> Iterator[str]:
    """Errors of a four-bar and of a six-bar with 25 deg in all loops."""
    make, times = CURVES[name]
    asked: dict[str, Any] = {"transmission_min_deg": 25, "transmission_over": "cycle", "exact": False}
    found = []
    for number in range(seed, seed + count):
        four = least(make(), "four-bar", number, **asked)
        six = {word: least(make(), word, number, **asked) for word in ("stephenson-3", "stephenson-1")}
        word, best = min(six.items(), key=lambda each: each[1][0])
        found.append(four[0] / best[0])
        taken = ", ".join(f"{each[1]:.1f}" for each in (four, *six.values()))
        yield f"four-bar {four[0]:.5f}, {word} {best[0]:.5f}; {taken} s"
    median = float(np.median(found))
    yield f"median {median:.1f} times smaller, wanted {times:g}{'' if median >= times else ' !'}"


def function(
    law: str, x: tuple[float, float], power: float | None, most: float, count: int, seed: int
) -> Iterator[str]:
    """The greatest structural error of a Stephenson III over ranges of 90 deg."""
    ranges: dict[str, Any] = {"x": x, "input_range_deg": 90, "output_range_deg": 90, "exponent": power}
    task = FunctionTask.from_degrees(law=law, **ranges)
    for number in range(seed, seed + count):
        error, seconds = least(task, "stephenson-3", number, transmission_min_deg=30)
        yield f"{error:.6f} deg, wanted {most:g}; {seconds:.1f} s{'' if error <= most else ' !'}"


def klann(count: int, seed: int) -> Iterator[str]:
    """Klann's leg from foot points alone."""
    leg = load_linkage("klann")
    p = solve_position(leg, np.linspace(0, 2 * np.pi, FOOT, endpoint=False)).p
    task = PathTask(p, closed=True)
    for number in range(seed, seed + count):
        error, seconds = least(task, "stephenson-3", number)
        share = error / task.size
        yield f"rms {share:.2g} of the size, wanted 1e-3; {seconds:.1f} s{'' if share < 1e-3 else ' !'}"


def _planted(points: int) -> Callable[[np.random.Generator], tuple[Any, ...]]:
    return partial(planted_path, points=points, mechanism="stephenson-3")


def smooth_poses(rng: np.random.Generator) -> MotionTask:
    """A set of poses."""
    turn = np.radians(rng.uniform(60, 90)) * rng.choice([-1, 1])
    angles = [0, rng.uniform(0.3, 0.7) * turn, turn]
    spline = CubicSpline([0, 0.5, 1], np.column_stack([rng.uniform(-1, 1, (3, 2)), angles]))
    poses = spline(np.linspace(0, 1, 5))
    return MotionTask(poses[:, :2], poses[:, 2])


def through_smooth_poses(required: Requirements, chains: int, count: int, seed: int) -> Iterator[str]:
    """Numbers of six-bars of `count` sets, the best transmission angles, and times."""
    numbers, times, best, judged, rejected = [], [], [], 0, 0
    for number in range(seed, seed + count):
        rng = np.random.default_rng(number)
        task = smooth_poses(rng)
        frame, rows = Frame.of(task), [row for word in WORDS for row in task.rows(word)]
        asked = frame.inward(task.positions), task.angles, frame.requirements(required.for_task(task))
        found, seconds = timed(partial(six_bars_through, *asked, rows, rng, chains), process_time)
        numbers.append(len(found))
        times.append(seconds)
        verdicts = [
            verify(_placed(each, frame), task, required) for each in found[:: -(-len(found) // JUDGED) or 1]
        ]
        judged, rejected = judged + len(verdicts), rejected + sum(not each.ok for each in verdicts)
        best += [np.degrees(each.transmission_min_task) for each in verdicts[:1]]
    share, median = np.mean(np.array(numbers) > 0), np.median(numbers)
    sound = share >= 0.9 and median >= 100 and np.median(times) <= 2 and not rejected
    yield (
        f"{np.count_nonzero(numbers)} of {count} sets, {min(numbers)} to {max(numbers)} six-bars, "
        f"median {median:g}; "
        f"best mu median {np.median(best):.1f} deg; judge: {judged - rejected} of {judged}; "
        f"median {np.median(times):.2f} s{'' if sound else ' !'}"
    )


def _placed(found: SixBar, frame: Frame) -> SixBar:
    """A find where the poses are."""
    origin = np.array([frame.origin.real, frame.origin.imag])
    return found.scaled(frame.scale, -origin / frame.scale)


def _of_smooth_poses(rotatability: Rotatability, mu: float, chains: int) -> Case:
    required = Requirements(rotatability=rotatability, transmission_min_deg=mu)
    name = f"smooth poses, {rotatability}, mu from {mu:g} deg, {chains} chains"
    return Case(name, 10, partial(through_smooth_poses, required, chains))


CASES = [
    *(
        Case(f"path of {n} points", 20, partial(solved, _planted(n), rms, {1e-10: 20}, 10.0))
        for n in (9, 12)
    ),
    Case("path of 15 points", 20, partial(solved, _planted(15), rms, {1e-6: 15, 1e-4: 20}, 10.0)),
    Case(
        "eight poses", 10,
        partial(solved, partial(planted_motion, poses=8, mechanism="stephenson-3"), both, {1e-6: 20}, 10.0),
    ),
    *(
        Case(
            f"{pairs} pairs", 15,
            partial(
                solved, partial(planted_function, pairs=pairs, full=True, mechanism="stephenson-3"), at_pairs,
                {limit: 18}, 4.0,
            ),
        )
        for pairs, limit in ((8, 1e-7), (11, 1e-4 / DEG))
    ),
    *(Case(f"curve {name}", 3, partial(closed_curve, name)) for name in CURVES),
    Case("function log10", 3, partial(function, "log10", (1.0, 10.0), None, 0.002)),
    Case("function square", 3, partial(function, "power", (0.0, 1.0), 2.0, 0.0005)),
    Case("function sin", 3, partial(function, "sin", (0.0, 90.0), None, 0.0005)),
    Case("Klann's leg", 3, klann),
    _of_smooth_poses(Rotatability.FULL_CRANK, 0, 2000),
    _of_smooth_poses(Rotatability.FULL_CRANK, 20, 8000),
    _of_smooth_poses(Rotatability.ANY, 0, 2000),
]  # fmt: skip
