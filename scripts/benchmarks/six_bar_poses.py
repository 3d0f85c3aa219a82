"""Six-bars through five smooth poses: how many there are in random sets, and whether the judge agrees.

A set is a cubic spline of position and angle through three random poses, turning by 60 to 90 deg. Times are
those of the processor for the finds alone; a case fails where fewer than nine sets of ten have any, the
median number is below 100, the median time above 2 s, or the judge rejects one.
"""

from collections.abc import Iterator
from functools import partial
from time import process_time

import numpy as np
from measuring import Case, timed
from scipy.interpolate import CubicSpline

from grashof.analysis import verify
from grashof.problems import MotionTask, Requirements, Rotatability, SixBar
from grashof.synth.quantities.frame import Frame
from grashof.synth.theory.six_bars.five_poses import six_bars_through

WORDS = "watt-1", "stephenson-1", "stephenson-3"
JUDGED = 20  # of a set, from the best to the worst


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


def _case(rotatability: Rotatability, mu: float, chains: int) -> Case:
    required = Requirements(rotatability=rotatability, transmission_min_deg=mu)
    name = f"{rotatability}, mu from {mu:g} deg, {chains} chains"
    return Case(name, 10, partial(through_smooth_poses, required, chains))


CASES = [
    _case(Rotatability.FULL_CRANK, 0, 2000),
    _case(Rotatability.FULL_CRANK, 20, 8000),
    _case(Rotatability.ANY, 0, 2000),
]
