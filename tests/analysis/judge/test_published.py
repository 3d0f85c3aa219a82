"""Every published design gives the error that it is published with, and the judge's is never greater."""

import numpy as np
import pytest

from grashof.analysis import solve_position, verify
from grashof.analysis.judge.how_met import meet
from grashof.problems import PathTask, Requirements, catalogue, load
from grashof.problems.files.published import ErrorDefinition, PublishedDesign, published

DESIGNS = [design for name in catalogue() for design in published(name)]
NAMES = [f"{design.problem}: {design.method}" for design in DESIGNS]


def recomputed(design: PublishedDesign, task: PathTask) -> float:
    if design.error_definition is ErrorDefinition.PRINTED_ANGLES:
        assert design.theta2 is not None
        gap = solve_position(design.linkage, design.theta2).p - task.points
        return float((gap**2).sum())
    if design.error_definition is ErrorDefinition.BEST_START:
        start = np.linspace(0, 2 * np.pi, 18001)
        assert task.timing is not None
        by_start = np.zeros(len(start))
        for turn, point in zip(task.timing, task.points, strict=True):
            by_start += ((solve_position(design.linkage, start + turn).p - point) ** 2).sum(axis=-1)
        return float(by_start.min())
    curve = solve_position(design.linkage, np.linspace(0, 2 * np.pi, 40001)).p
    return float(sum(((curve - point) ** 2).sum(axis=-1).min() for point in task.points))


@pytest.mark.parametrize("design", DESIGNS, ids=NAMES)
def test_a_published_design_reproduces(design: PublishedDesign) -> None:
    task = load(design.problem).task
    assert isinstance(task, PathTask)
    printed = design.error_definition is ErrorDefinition.PRINTED_ANGLES
    # Printed with so few digits that an exact design is none: its error is then that of the digits.
    tolerance = 1e-6 if printed and design.error > 1e-9 else 0.05
    assert recomputed(design, task) == pytest.approx(design.error, rel=tolerance)
    assert design.source
    assert 1990 < design.year < 2030


@pytest.mark.parametrize("design", DESIGNS, ids=NAMES)
def test_the_judge_finds_no_greater_error_in_order(design: PublishedDesign) -> None:
    problem = load(design.problem)
    verdict = verify(design.linkage, problem.task, problem.requirements)
    assert verdict.error_sse <= design.error * (1 + 1e-4)
    assert verdict.order_ok
    assert verdict.circuit_ok
    assert verdict.branch_ok
    [(targets, _)] = meet([design.linkage], design.linkage[None], problem.task, Requirements(order=False))
    assert (targets.position_error**2).sum() <= verdict.error_sse * (1 + 1e-9)


def test_published_designs_are_of_problems_there_are_and_best_first() -> None:
    assert len(DESIGNS) == 31
    for name in catalogue():
        errors = [design.error for design in published(name)]
        assert errors == sorted(errors)
    assert published("no such problem") == ()
