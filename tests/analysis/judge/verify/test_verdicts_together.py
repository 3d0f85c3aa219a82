"""Verdicts on many linkages at once: to the last bit those on each alone, in any order and company."""

import numpy as np
import pytest
from random_linkages import KINDS, ROWS, any_linkages, six_bars
from same_values import check_same

from grashof.analysis import verify
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.analysis.judge.verify import Judge, Subject
from grashof.problems import Linkage, MotionTask, Requirements

POSES, POSED = planted_motion(np.random.default_rng(1), poses=4)
POINTS, LED = planted_path(np.random.default_rng(2), points=6)
FREE = MotionTask(POSES.positions, np.where(np.arange(4) % 2, np.nan, POSES.angles), angle_length=1.0)
TASKS = {
    "poses": (POSES, {}),
    "poses free in part": (FREE, {"exact": False, "order": False}),
    "closed": (MotionTask(POSES.positions, POSES.angles, closed=True), {"exact": False}),
    "points": (POINTS, {"exact": False}),
}


def linkages() -> list[Linkage]:
    """Linkages of all kinds, of one loop and two; some meet a task, some cannot be assembled."""
    rng = np.random.default_rng(3)
    found: list[Linkage] = [POSED, LED, *(POSED.changed(r3=POSED.r3 * (1 + by)) for by in (1e-9, 1e-6, 0.3))]
    for kind in KINDS:
        batch = any_linkages(kind, 4, rng)
        found += [batch[k] for k in range(4)]
    found += [six_bars(row, 1, rng)[0] for row in list(ROWS)[:2]]
    order = rng.permutation(len(found))
    return [found[k] for k in order]


@pytest.mark.parametrize("name", TASKS)
def test_a_verdict_does_not_depend_on_its_company(name: str) -> None:
    task, wanted = TASKS[name]
    requirements = Requirements(transmission_min_deg=20, **wanted)
    every = linkages()
    judge = Judge(task, requirements)
    together = judge.verdicts([Subject(each) for each in every])
    reverse = judge.verdicts([Subject(each) for each in every[::-1]])[::-1]
    for linkage, one, other in zip(every, together, reverse, strict=True):
        check_same(one, verify(linkage, task, requirements))
        check_same(one, other)
