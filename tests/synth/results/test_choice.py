"""Zones and the error factor: every listed design keeps them, recomputed from the linkage alone."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import verify
from grashof.problems import DynamicsSpec, FourBar, MotionTask, Objective, PathTask, Problem, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Candidate, Result

pytestmark = pytest.mark.usefixtures("small_search")

POSES = [[0, 0, 0], [30, 10, 10], [60, 15, 25], [90, 10, 40], [120, -5, 60], [130, -30, 80]]
POINTS = [pose[:2] for pose in POSES]
TURN = np.linspace(0, 2 * np.pi, 12, endpoint=False)
OVAL = np.stack([100 * np.cos(TURN), 50 * np.sin(TURN)], axis=1)
FREE = [[0, 0, 0], {"x": 30, "y": 10}, {"angle": 30}, [60, 15, 50], {"x": 80, "y": 0}, [90, -10, 70]]
STEPS = 10_000  # of the driver in a turn


def missed(linkage: FourBar, theta2: FloatArray, problem: Problem, target: int) -> FloatArray:
    """Shares of its zone that a target is missed by at driver angles; infinite where nothing closes."""
    o2, o4, task = complex(*linkage.o2), complex(*linkage.o4), problem.task
    a = o2 + float(linkage.r2) * np.exp(1j * theta2)
    far = np.abs(o4 - a)
    cosine = (float(linkage.r3) ** 2 + far**2 - float(linkage.r4) ** 2) / (2 * float(linkage.r3) * far)
    theta3 = np.angle(o4 - a) + int(linkage.assembly) * np.arccos(np.clip(cosine, -1, 1))
    p = a + complex(*linkage.coupler_point) * np.exp(1j * theta3)
    assert problem.zones is not None
    place, turn = problem.zones[:, target]
    share = np.where(np.abs(cosine) <= 1, 0.0, np.inf)
    if not np.isnan(task.positions[target, 0]):
        share = np.maximum(share, np.abs(p - complex(*task.positions[target])) / place)
    if isinstance(task, MotionTask) and task.has_angle[target]:
        off = np.angle(np.exp(1j * (theta3 + float(linkage.body_angle) - task.angles[target])))
        share = np.maximum(share, np.abs(off) / turn)
    return share


def check_zones(problem: Problem, design: Candidate) -> None:
    verdict = design.verdict
    assert verify(design.linkage, problem.task, problem.requirements).ok
    for target, theta2 in enumerate(verdict.theta2):
        grid = theta2 + np.linspace(-np.pi, np.pi, STEPS)
        near = theta2 + np.linspace(-1e-3, 1e-3, 2001)
        at_the_judges = missed(design.linkage, np.array([theta2]), problem, target)
        assert at_the_judges[0] <= 1 + 1e-6
        anywhere = min(missed(design.linkage, each, problem, target).min() for each in (grid, near))
        assert anywhere <= 1 + 1e-6
    if problem.requirements.order:
        steps = verdict.direction * np.diff(verdict.theta2)
        assert (steps >= -1e-9).all()
        assert steps.sum() <= 2 * np.pi + 1e-9


MASSES = DynamicsSpec(mass_per_length=1e-3, gravity=(0, -9.81), speed_rpm=30)
ZONED: dict[str, dict[str, Any]] = {
    "poses": {"task": MotionTask.from_degrees(POSES, within=6)},
    "a zone each": {"task": MotionTask.from_degrees(POSES, within=[1, 2, 3, 4, 5, 6], angle_within_deg=3)},
    "angles alone": {"task": MotionTask.from_degrees(POSES, angle_within_deg=2)},
    "free parts": {"task": MotionTask.from_degrees(FREE, within=4)},
    "timed": {"task": PathTask.from_degrees(POINTS, timing_deg=[0, 30, 60, 90, 120, 150], within=8)},
    "closed": {"task": PathTask(OVAL, closed=True, within=6)},
    "any order": {
        "task": MotionTask.from_degrees(POSES, within=6),
        "requirements": Requirements(order=False),
    },
    "any rotatability": {
        "task": MotionTask.from_degrees(POSES, within=6),
        "requirements": Requirements(rotatability="any"),  # type: ignore[arg-type]
    },
    "a tolerance": {
        "task": MotionTask.from_degrees(POSES),
        "requirements": Requirements(exact=True, tolerance=0.05),
    },
    "torque": {
        "task": MotionTask.from_degrees(POSES, within=6),
        "objective": Objective(0, 0, 1),
        "dynamics": MASSES,
        "length_unit": "mm",
    },
    "tiny": {"task": MotionTask.from_degrees([[x * 1e-11, y * 1e-11, t] for x, y, t in POSES], within=6e-11)},
    "far away": {"task": MotionTask.from_degrees([[x + 1e6, y, t] for x, y, t in POSES], within=6)},
}


@pytest.mark.slow
@pytest.mark.quick("a zone each")
@pytest.mark.parametrize("name", ZONED)
def test_every_design_keeps_its_zones_and_the_objective_uses_them(
    name: str, least_error: Callable[..., Result]
) -> None:
    problem = Problem(**ZONED[name])
    result = synthesize(problem, effort=0.2)
    assert len(result) > 0
    for design in result.candidates:
        check_zones(problem, design)
    values = [design.objective(problem) for design in result.candidates]
    assert values[0] >= max(values) - 0.011 * abs(max(values))  # what nobody would build gives way
    squares = least_error(problem.without_zones(), effort=0.2)
    if verify(squares.best.linkage, problem.task, problem.requirements).ok:
        assert values[0] >= squares.best.objective(problem) - 1e-9


@pytest.mark.slow
def test_the_error_factor_bounds_the_error() -> None:
    task = MotionTask.from_degrees(POSES)
    best = []  # with less effort rounding decides which of few starts is followed
    for factor in (1.0, 1.5, 1e6):
        result = synthesize(Problem(task=task, requirements=Requirements(error_factor=factor)), effort=0.5)
        assert result.most_error == factor * result.least_error
        for design in result.candidates:
            assert np.sqrt(design.verdict.square / 6) <= result.most_error * (1 + 1e-6)
        best.append(result.best.objective(result.problem))
    assert best[0] < best[1] < best[2]
