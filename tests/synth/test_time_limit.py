"""A time limit ends every search soon: long tasks of least squares, and targets to be met."""

from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from time import process_time
from typing import Any

import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import FunctionTask, MotionTask, PathTask, Problem, Requirements
from grashof.synth import Progress
from grashof.synth.starts.functions.finder import Functions

LIMIT, SOON = 1.0, 2.0  # s; of processor time after the limit
NOISE = 0.005  # of the size


def poses(count: int, **wanted: object) -> Problem:
    rng = np.random.default_rng(count)
    task, _ = planted_motion(rng, count)
    places = task.positions + rng.normal(0, NOISE * task.size, (count, 2))
    noisy = MotionTask(places, task.angles + rng.normal(0, NOISE, count))
    return Problem(task=noisy, requirements=Requirements(exact=False, **wanted))


def points(count: int, *, timed: bool = False, **wanted: object) -> Problem:
    rng = np.random.default_rng(count)
    task, _ = planted_path(rng, count, timed=timed)
    noisy = PathTask(task.points + rng.normal(0, NOISE * task.size, (count, 2)), timing=task.timing)
    return Problem(task=noisy, requirements=Requirements(exact=False, **wanted))


def closed(count: int) -> Problem:
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    places = np.stack([2 * np.cos(angle), np.sin(angle + 0.3 * np.cos(angle))], axis=1)
    return Problem(task=PathTask(places, closed=True), requirements=Requirements(exact=False))


def zones(count: int) -> Problem:
    problem = points(count)
    return Problem(task=replace(problem.task, within=4 * NOISE * problem.task.size))


def met(count: int) -> Problem:
    return Problem(
        task=planted_path(np.random.default_rng(1), count)[0], requirements=Requirements(exact=True)
    )


LIMITED = {"transmission_min_deg": 40.0, "link_ratio_max": 4.0}
TASKS: dict[str, Callable[[], Problem]] = {
    "poses": lambda: poses(1000),
    "poses in any order": lambda: poses(200, order=False),
    "points": lambda: points(2000),
    "points in any order": lambda: points(300, order=False),
    "limited points": lambda: points(1000, **LIMITED),
    "bounded points": lambda: points(500, error_factor=1.5),
    "points in zones": lambda: zones(300),
    "timed points": lambda: points(2000, timed=True),
    "limited timed points": lambda: points(400, timed=True, **LIMITED),
    "closed": lambda: closed(1000),
    "points met": lambda: met(200),
    "nine points": lambda: load("nine-points"),
}


@pytest.mark.slow
@pytest.mark.quick("points in any order")
@pytest.mark.parametrize("task", TASKS)
def test_a_search_ends_soon_after_its_time_limit(task: str) -> None:
    problem, begun = TASKS[task](), process_time()
    result = synthesize(problem, time_limit=LIMIT)
    assert process_time() - begun < LIMIT + SOON
    assert len(result) or "stopped" in result.note or result.complete


class Polled:
    """A search's `stop`: counts its calls."""

    def __init__(self) -> None:
        self.times = 0

    def __call__(self) -> bool:
        self.times += 1
        return False


@pytest.mark.slow
def test_picking_many_starts_asks_whether_to_stop() -> None:
    """2000 designs wanted: they were picked for 6.6 s on end."""
    few, many = Polled(), Polled()
    for stop, enough in ((few, 4), (many, 300)):
        synthesize(load("luggage"), starts=4, enough=enough, stop=stop)
    assert many.times > few.times + 250


@pytest.mark.study
def test_fitting_functions_asks_whether_to_stop() -> None:
    """15 pairs and the greatest error: 5.7 s went by between two questions."""
    task = FunctionTask.from_degrees(
        law="power", exponent=2.3, x=[0.1, 1], input_range_deg=150, output_range=70, pairs=6, norm="max"
    )
    polled = Polled()
    synthesize(Problem(task=task, mechanism="slider-crank"), stop=lambda: polled() or polled.times > 300)
    assert polled.times > 300  # long before its end


@pytest.mark.slow
def test_a_stopped_search_for_functions_lists_its_designs() -> None:
    told: list[Progress] = []
    part = synthesize(load("function-log10"), stop=lambda: bool(told), progress=told.append)
    assert not part.complete
    assert len(part) >= 1
    assert part.ended == "the search ended after 1 of 200 solves: it was stopped"


@pytest.mark.parametrize("method", ["quick_pass", "round", "onward"])
def test_a_search_for_functions_may_be_stopped_anywhere(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """At once, without a second's grace: what was found until then is listed, and no more is lost."""
    monkeypatch.setattr(import_module("grashof.synth.theory.stopping"), "GRACE", 0.0)
    real, begun = getattr(Functions, method), list[str]()

    def watched(self: Functions, *given: Any) -> Any:
        begun.append(method)
        return real(self, *given)

    monkeypatch.setattr(Functions, method, watched)
    task = FunctionTask.from_degrees([0, 15, 30, 45, 60, 75], [0, 12, 22, 30, 36, 40])
    part = synthesize(Problem(task=task), stop=lambda: bool(begun))
    assert not part.complete
    assert part.ended.endswith("it was stopped") or not part.candidates
    assert (len(part) > 0) is (method != "quick_pass")
