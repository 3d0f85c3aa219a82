"""Dwells: the least band of a list over several seeds, beside what a search of 2 s has to reach.

Times are those of the processor, imports apart; a case fails where the median band exceeds its limit, or a
list has fewer than ten designs.
"""

from collections.abc import Iterator
from functools import partial
from time import process_time

import numpy as np
from measuring import Case, timed

from grashof import synthesize
from grashof.problems import DwellTask, Problem, Requirements

# Dwell, swing (0: a slide), transmission angle, deg; link ratio; least band, deg or as a share of the stroke.
LIMITS = (
    (60, 30, 40, 10, 0.002),
    (90, 45, 40, 10, 0.008),
    (90, 90, 30, 10, 0.02),
    (120, 60, 30, 10, 0.04),
    (180, 30, 30, 12, 0.2),
    (90, 0, 40, 10, 2e-4),
)
ENOUGH = 30  # designs: about two rounds


def problem_of(dwell: float, swing: float, mu: float, ratio: float) -> Problem:
    """The dwell of a swing, or of a slide with unit stroke."""
    way = {"swing_deg": swing} if swing else {"stroke": 1.0}
    wanted = Requirements(transmission_min_deg=mu, link_ratio_max=ratio)
    return Problem(task=DwellTask.from_degrees(dwell_deg=dwell, **way), requirements=wanted)


def least_bands(row: tuple[float, ...], count: int, seed: int) -> Iterator[str]:
    """Least bands, numbers of designs and times of `count` seeds."""
    *stated, most = row
    problem = problem_of(*stated)
    bands, found, times = [], [], []
    for number in range(seed, seed + count):
        result, seconds = timed(partial(synthesize, problem, seed=number, enough=ENOUGH), process_time)
        dwells = [one.verdict.dwell for one in result.candidates]
        scale = np.degrees(1.0) if row[1] else 1.0
        bands.append(min((scale * each.band for each in dwells if each is not None), default=np.inf))
        found.append(len(dwells))
        times.append(seconds)
    median = float(np.median(bands))
    sound = median <= most and min(found) >= 10
    yield (
        f"band median {median:.2g}, most {max(bands):.2g}, allowed {most:g}; designs from {min(found)}; "
        f"median {np.median(times):.2f} s{'' if sound else ' !'}"
    )


CASES = [
    Case("{:g} deg, {}, mu {:g}".format(row[0], f"swing {row[1]:g}" if row[1] else "slide", row[2]), 10,
         partial(least_bands, row))
    for row in LIMITS
]  # fmt: skip
