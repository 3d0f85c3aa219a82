"""Verdicts on many linkages at once: to the last bit those on each alone, in any order and company."""

import numpy as np
import pytest
from random_linkages import KINDS, ROWS, any_linkages, six_bars
from same_values import check_same

from grashof.analysis import Verdict, verify
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.analysis.judge.verify import Judge, Subject
from grashof.problems import FunctionTask, Linkage, MotionTask, Requirements, Task

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


def judged_alike(every: list[Linkage], task: Task, requirements: Requirements) -> list[Verdict]:
    """Verdicts together, which in either order are those of linkages alone."""
    judge = Judge(task, requirements)
    together = judge.verdicts([Subject(each) for each in every])
    reverse = judge.verdicts([Subject(each) for each in every[::-1]])[::-1]
    for linkage, one, other in zip(every, together, reverse, strict=True):
        check_same(one, verify(linkage, task, requirements))
        check_same(one, other)
    return together


@pytest.mark.parametrize("name", TASKS)
def test_a_verdict_does_not_depend_on_its_company(name: str) -> None:
    task, wanted = TASKS[name]
    judged_alike(linkages(), task, Requirements(transmission_min_deg=20, **wanted))


@pytest.mark.parametrize("norm", ["max", "rms"])
def test_nor_does_one_on_a_function(norm: str) -> None:
    """Of linkages that turn their last link; some do not cover the range."""
    task = FunctionTask.from_degrees([0, 40, 120, 200], [0, 9, 25, 47], sense="either", norm=norm)
    every = [each for each in linkages() if each.mechanism.loops[-1].pinned]
    requirements = Requirements(exact=False, transmission_min_deg=20)
    errors = [each.structural_error_max for each in judged_alike(every, task, requirements)]
    stuck = [each for each, error in zip(every, errors, strict=True) if not np.isfinite(error)]
    assert 0 < len(stuck) < len(every)
    judged_alike(stuck, task, requirements)
