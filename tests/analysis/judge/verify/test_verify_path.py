"""The judge on paths: requirements of exact, approximate, closed and timed ones."""

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import solve_position, verify, worst_transmission, worst_transmission_cycle
from grashof.analysis.judge.planted import planted_path
from grashof.analysis.mechanism.extremes import diagonal, reach_box
from grashof.problems import FourBar, MotionTask, PathTask, Requirements, load

CRANK_ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=1, r4=3, coupler_point=(0.5, 1))


def defects(linkage: FourBar, task: PathTask, **wanted: object) -> list[str]:
    return [defect.requirement for defect in verify(linkage, task, Requirements(**wanted)).defects]  # type: ignore[arg-type]


def missed(task: PathTask, by: float) -> PathTask:
    """The same points with one of them off the curve."""
    points = task.points.copy()
    points[1] += by * task.size
    return PathTask(points, timing=task.timing, closed=task.closed)


@pytest.mark.parametrize(
    ("count", "timed", "exact"), [(9, False, True), (10, False, False), (5, True, True), (6, True, False)]
)
def test_only_exact_tasks_have_to_be_met(count: int, timed: bool, exact: bool) -> None:
    task, linkage = planted_path(np.random.default_rng(3), count, timed=timed)
    off = missed(task, 0.01)
    assert defects(linkage, off) == (["exact"] if exact else [])
    assert defects(linkage, off, exact=True) == ["exact"]
    assert defects(linkage, off, exact=False) == []


def test_motion_is_judged_by_the_same_rule() -> None:
    state = solve_position(CRANK_ROCKER, [0.0, 0.4, 0.8])
    angles = state.theta3 + np.array([0, 0.1, 0])
    task = MotionTask(state.p, angles)
    assert [d.requirement for d in verify(CRANK_ROCKER, task, Requirements()).defects] == ["exact"] * 2
    assert verify(CRANK_ROCKER, task, Requirements(exact=False)).ok


def test_points_out_of_order_are_not_met_in_order() -> None:
    points = solve_position(CRANK_ROCKER, [0, 2, 1, 3]).p
    assert defects(CRANK_ROCKER, PathTask(points)) == ["exact"]
    assert defects(CRANK_ROCKER, PathTask(points), order=False) == []
    verdict = verify(CRANK_ROCKER, PathTask(points), Requirements(order=False))
    assert not verdict.order_ok
    assert verify(CRANK_ROCKER, PathTask(points), Requirements()).order_ok


def test_points_of_both_assemblies_need_both() -> None:
    points = solve_position(CRANK_ROCKER, [0, 1, 2, 3], [1, 1, -1, -1]).p
    task = PathTask(points)
    assert defects(CRANK_ROCKER, task) == ["exact"]
    assert defects(CRANK_ROCKER, task, same_branch=False) == []
    verdict = verify(CRANK_ROCKER, task, Requirements(same_branch=False))
    assert verdict.assembly.tolist() == [1, 1, -1, -1]
    assert not verdict.circuit_ok


def test_the_motion_used_is_from_first_to_last_point() -> None:
    points = solve_position(CRANK_ROCKER, [0.5, 1, 2, 2.5]).p
    verdict = verify(CRANK_ROCKER, PathTask(points), Requirements())
    assert verdict.transmission_min_task == pytest.approx(worst_transmission(CRANK_ROCKER, 0.5, 2.5))
    assert verdict.size == pytest.approx(diagonal(reach_box(CRANK_ROCKER, 0.5, 2.5)))


def test_a_closed_path_uses_the_full_turn() -> None:
    points = solve_position(CRANK_ROCKER, [0.5, 1, 2, 2.5]).p
    verdict = verify(CRANK_ROCKER, PathTask(points, closed=True), Requirements())
    assert verdict.transmission_min_task == pytest.approx(worst_transmission_cycle(CRANK_ROCKER))
    assert verdict.size == pytest.approx(diagonal(reach_box(CRANK_ROCKER, 0, 2 * np.pi)))


@pytest.mark.parametrize("poses", [False, True])
def test_a_closed_task_needs_a_driver_that_turns(poses: bool) -> None:
    state = solve_position(ROCKER, [0.6, 0.7, 0.85])
    for closed in (False, True):
        path = PathTask(state.p, closed=closed)
        task = MotionTask(state.p, state.theta3, closed=closed) if poses else path
        verdict = verify(ROCKER, task, Requirements(rotatability="any"))  # type: ignore[arg-type]
        assert [defect.requirement for defect in verdict.defects] == ["rotatability"] * closed
        reason = f"a closed {task.kind} takes a full turn"
        assert all(reason in str(defect) for defect in verdict.defects)


def test_a_driver_that_does_not_cover_the_timing_is_refused_though_nothing_is_exact() -> None:
    task = PathTask.from_degrees([[0, 0], [1, 0], [0, 1]], timing_deg=[0, 150, 300])
    wanted = Requirements(rotatability="any", same_branch=False, exact=False)  # type: ignore[arg-type]
    verdict = verify(ROCKER, task, wanted)
    assert "rotatability" in [defect.requirement for defect in verdict.defects]
    assert "cannot be assembled" in str(verdict.defects[0])


@pytest.mark.parametrize("timed", [False, True])
def test_a_given_start_angle_is_where_the_first_point_is_met(timed: bool) -> None:
    theta2 = np.array([0.5, 1.0, 1.5, 2.2])
    task = PathTask(solve_position(CRANK_ROCKER, theta2).p, timing=theta2 - 0.5 if timed else None)
    right = float(np.degrees(0.5))
    assert defects(CRANK_ROCKER, task, theta2_start_deg=right) == []
    assert defects(CRANK_ROCKER, task, theta2_start_deg=right + 360) == []
    assert defects(CRANK_ROCKER, task, theta2_start_deg=right + 5) == ["exact"]


def test_hoekens_linkage_draws_the_straight_line_of_the_catalogue() -> None:
    problem = load("straight-line")
    # Norton, Design of Machinery, sec. 3.8: 180 deg of crank on a line of about four times r2.
    hoeken = FourBar((0, -100), (-50, -100), 25, 62.5, 62.5, coupler_point=(125, 0), assembly=-1)
    line = solve_position(hoeken, np.linspace(-np.pi / 2, np.pi / 2, 50)).p
    assert np.ptp(line[:, 1]) < 0.5
    middle = line.mean(axis=0)
    hoeken = replace(hoeken, o2=hoeken.o2 - middle, o4=hoeken.o4 - middle)
    verdict = verify(hoeken, problem.task, problem.requirements)
    assert verdict.ok, [str(defect) for defect in verdict.defects]
    assert verdict.error_max < 0.5
    assert len(problem.task) > 6  # more points than a coupler curve shares with a line


def test_a_link_to_the_arc_of_the_catalogue_dwells() -> None:
    problem = load("dwell")
    np.testing.assert_allclose(np.hypot(*problem.task.positions.T), 100, atol=1e-5)
    # Found by plain least squares from random starts; r3 = r4 makes its curve symmetric.
    o2 = np.array([80.5987, 271.1114])
    o4 = o2 + 87.7838 * np.array([np.cos(3.549), np.sin(3.549)])
    design = FourBar(o2, o4, 28.2688, 114.9751, 114.9751, coupler_point=(193.8476, -83.6564))
    verdict = verify(design, problem.task, problem.requirements)
    assert [defect.requirement for defect in verdict.defects if defect.miss > 1e-3] == []
    assert verdict.error_max < 0.1
    dwell = np.linspace(verdict.theta2[0], verdict.theta2[-1], 200)
    assert np.degrees(np.ptp(dwell)) == pytest.approx(120)
    assert np.abs(np.hypot(*solve_position(design, dwell).p.T) - 100).max() < 0.1
    assert np.abs(np.hypot(*solve_position(design, dwell[0] - dwell).p.T) - 100).max() > 1
