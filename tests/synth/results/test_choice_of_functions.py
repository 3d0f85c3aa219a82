"""Strengths of designs of a function, and relaxations that an empty list names."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import Design, verify
from grashof.analysis.judge.planted import planted_function
from grashof.problems import FunctionTask, Problem, Requirements
from grashof.synth import Candidate
from grashof.synth.results.choice import best_at

pytestmark = pytest.mark.usefixtures("small_search")


def test_errors_of_rounding_are_all_the_least() -> None:
    task, linkage, _ = planted_function(np.random.default_rng(1), 5)
    problem = Problem(task=task, requirements=Requirements(exact=False))
    verdict = verify(linkage, task, problem.requirements)

    def name(error: float, least: float) -> str:
        design = Candidate(linkage, replace(verdict, square=error**2 * len(task)), problem, 0, 0)
        assert abs(design.error(problem) - error) < 1e-12 * error
        return best_at(problem, design, least)

    assert name(3e-16, 1e-16) == name(5e-10, 1e-16) == "least error"
    assert name(2e-4, 1.9e-4) == name(2e-9, 1e-16) == "least error nearby"
    assert name(2e-4, 1.9999e-4) == "least error"


SIX = FunctionTask.from_degrees([0, 20, 45, 70, 90, 110], [0, 5, 12, 22, 27, 26])


def test_errors_are_angles_whatever_the_size() -> None:
    wanted = Requirements(r1=(200, 200), exact=False, transmission_min_deg=60)
    found = synthesize(Problem(task=SIX, requirements=wanted))
    least = min(one.error(found.problem) for one in found.candidates)
    assert found.least_error == pytest.approx(least, rel=1e-9)


def test_a_list_offers_more_transmission_for_more_error() -> None:
    best, *others = synthesize(Problem(task=SIX), effort=0.4).candidates
    assert best.best_at == "least error"
    transmission = [float(np.degrees(one.verdict.transmission_min_task)) for one in others]
    assert "transmission from 60 deg" in {one.best_at for one in others}
    assert all(any(level - 2 < each < level + 2 for each in transmission) for level in (30, 40, 50, 60))


FIVE = FunctionTask.from_degrees([0, 20, 45, 70, 90], [0, 12, 31, 55, 80])


@pytest.mark.quick("transmission_min_deg")
@pytest.mark.parametrize(
    ("task", "wanted", "key"),
    [
        (SIX, {"structural_error_max_deg": (0.0, 0.01)}, "structural_error_max_deg"),
        (FIVE, {"transmission_min_deg": 40.0}, "transmission_min_deg"),
        (FIVE, {"link_ratio_max": 1.5}, "link_ratio_max"),
    ],
    ids=["structural_error_max_deg", "transmission_min_deg", "link_ratio_max"],
)
def test_the_relaxation_that_is_named_would_do(task: FunctionTask, wanted: dict[str, Any], key: str) -> None:
    problem = Problem(task=task, requirements=Requirements(**wanted))
    found = synthesize(problem)
    assert not found.candidates
    assert f"{key} " in found.note
    said = found.note.split(f"{key} ")[1].removeprefix("up to ")
    value = float(said.split()[0])
    ranges = isinstance(wanted[key], tuple)
    looser = replace(problem.requirements, **{key: (0.0, value) if ranges else value})
    assert synthesize(replace(problem, requirements=looser)).best.verdict.ok


def long_coupler(design: Design) -> Any:
    return 20.0 - design.r3


def test_a_users_own_constraint_is_relaxed() -> None:
    found = synthesize(Problem(task=FIVE), constraints=[long_coupler], effort=0.2)
    assert not found.candidates
    allowed = float(found.note.split("constraint long_coupler up to ")[1].split()[0])
    assert found.nearest[0].linkage.r3 + allowed >= 20.0  # type: ignore[attr-defined]
