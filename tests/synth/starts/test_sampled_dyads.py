"""Dyads of few whole poses where places, or the direction of the ground, are stated."""

from typing import Any

import numpy as np
import pytest

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, FourBar, Problem, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.exact_poses import FewPoses


def point(place: FloatArray) -> Box:
    """The box without width at a place."""
    x, y = place.tolist()
    return Box((x, x), (y, y))


def on_body(linkage: FourBar) -> dict[str, Box]:
    """Where A and B are, seen from the coupler point by the body."""
    arm, turned = complex(*linkage.coupler_point), np.exp(-1j * float(linkage.body_angle))
    a, b = -arm * turned, (float(linkage.r3) - arm) * turned
    return {"a_on_body": point(np.array([a.real, a.imag])), "b_on_body": point(np.array([b.real, b.imag]))}


STATED: dict[str, Any] = {
    "4, o2": lambda linkage: {"o2": point(linkage.o2)},
    "4, o4": lambda linkage: {"o4": point(linkage.o4)},
    "4, joints": on_body,
    "3, joints": on_body,
    "2, joints and direction": lambda linkage: {
        **on_body(linkage),
        "ground_angle_deg": float(np.degrees(linkage.theta1)),
    },
}


@pytest.mark.quick("4, o2-0", "2, joints and direction-2")
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("stated", STATED)
def test_what_is_stated_is_met_by_theory_before_any_solve(stated: str, seed: int) -> None:
    """Some pair of dyads meets it in the first round, checked at the poses by its own numbers."""
    task, linkage = planted_motion(np.random.default_rng([seed, 7]), int(stated[0]))
    wanted = Requirements(rotatability="any", order=False, same_branch=False, **STATED[stated](linkage))
    scaled = ScaledProblem.of(Problem(task=task, requirements=wanted))
    made = FewPoses(scaled).round(0, 5, np.random.default_rng(0), 1)
    assert made is not None
    assert made.counts["feasible finds"] > 0
    start = made.starts[0]
    design = scaled.linkages(start.points, np.array(start.assembly))
    assert isinstance(design, FourBar)
    if "o2" in stated:
        np.testing.assert_allclose(design.o2, linkage.o2, atol=1e-9 * task.size)
    if "o4" in stated:
        np.testing.assert_allclose(design.o4, linkage.o4, atol=1e-9 * task.size)
    if "joints" in stated:
        mine, its = on_body(design), on_body(linkage)
        for name, box in its.items():
            np.testing.assert_allclose([mine[name].x, mine[name].y], [box.x, box.y], atol=1e-8 * task.size)
    if "direction" in stated:
        assert abs(np.sin(float(design.theta1 - linkage.theta1))) < 1e-8
    turn = np.linspace(-np.pi, np.pi, 20_001)
    for assembly in (1, -1):
        state = solve_position(design.changed(assembly=assembly), turn)
        off = np.hypot(*(state.p - task.positions[-1]).T)
        if np.nanmin(off) < 2e-3 * task.size:
            break
    assert np.nanmin(off) < 2e-3 * task.size


def test_joints_that_no_dyad_has_leave_near_misses_and_a_true_reason() -> None:
    """Far from the body circle points are missing; O2 beside its curve is as far away as without them."""
    task, linkage = planted_motion(np.random.default_rng([0, 7]), 4)
    far = Box((50 * task.size, 51 * task.size), (0.0, 1.0))
    beside = {"o2": point(linkage.o2 + 0.3)}
    plain, boxed = (
        FewPoses(ScaledProblem.of(Problem(task=task, requirements=Requirements(**beside, **more))))
        for more in ({}, {"a_on_body": far, "b_on_body": far})
    )
    reasons = [each.obstacle(np.random.default_rng(0), {}) for each in (plain, boxed)]
    assert reasons[0] == reasons[1]
    assert "inf" not in reasons[0]
    assert len(boxed.near(np.random.default_rng(0))) > 100
