"""Six-bars as the judge meets them: planted tasks, dense scans, and curves as polylines."""

from typing import Any

import numpy as np
import pytest
from body_coordinates import reach, start
from body_plans import plan_of
from linkages_of_rows import SIX_BARS
from random_linkages import six_bars

from grashof.analysis import driver_ranges, solve_position, verify
from grashof.analysis.curves.coupler_curve import closed_length
from grashof.analysis.judge.planted import random_six_bar
from grashof.problems import FunctionTask, MotionTask, PathTask, Requirements, SixBar, Task
from grashof.problems.values.tasks.closed_curve import spline_length

HOSTS = ((3, 1), (2, 4), (2, 3), (3, 4))
EXACT, LOOSE = Requirements(exact=True), Requirements(exact=False)
TURN = np.linspace(0, 2 * np.pi, 20001)


def planted(hosts: tuple[int, int], count: int = 7, sense: int = 1) -> tuple[SixBar, np.ndarray[Any, Any]]:
    rng = np.random.default_rng([33, *hosts])
    linkage = random_six_bar(rng, hosts).changed(body_angle=0.7).scaled(40.0, np.array([3.0, -2.0]))
    return linkage, rng.uniform(-3, 3) + sense * np.cumsum(rng.uniform(0.3, 0.8, count))


def tasks(linkage: SixBar, theta2: np.ndarray[Any, Any]) -> dict[str, Task]:
    state, turned = solve_position(linkage, theta2), theta2 - theta2[0]
    moved = np.unwrap(state.theta6)
    angle = np.unwrap(state.angles[linkage.mechanism.carries]) + 0.7
    return {
        "path": PathTask(state.p),
        "timed path": PathTask(state.p, timing=turned),
        "closed path": PathTask(state.p, closed=True, length_ratio_max=1e6),
        "motion": MotionTask(state.p, angle),
        "timed motion": MotionTask(state.p, angle, timing=turned),
        "function": FunctionTask(np.abs(turned), np.sign(turned[-1]) * (moved - moved[0])),
    }


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("hosts", HOSTS)
def test_planted_tasks_are_met(hosts: tuple[int, int], sense: int) -> None:
    linkage, theta2 = planted(hosts, sense=sense)
    for name, task in tasks(linkage, theta2).items():
        wide = {"link_length": (0, 1e4), "link_ratio_max": 1e3}
        arms = {} if name == "function" else {"coupler_arms": (0, 1e4)}
        verdict = verify(linkage, task, Requirements(exact=True, **wide, **arms))
        assert verdict.ok, (name, verdict.defects)
        assert np.nan_to_num(verdict.error_max) < 1e-12 * task.size
        assert np.nanmax(verdict.angle_error, initial=0.0) < 1e-12
        assert np.abs(verdict.output_error).max(initial=0.0) < 1e-9


@pytest.mark.parametrize("hosts", HOSTS)
def test_no_place_of_the_curve_is_nearer_to_a_point(hosts: tuple[int, int]) -> None:
    linkage, theta2 = planted(hosts)
    p = solve_position(linkage, theta2).p
    task = PathTask(p + np.random.default_rng(0).normal(0, 0.02 * np.ptp(p), p.shape))
    verdict = verify(linkage, task, Requirements(exact=False, order=False))
    curve = solve_position(linkage, TURN).p
    nearest = np.linalg.norm(curve - task.positions[:, None], axis=-1).min(axis=1)
    assert (verdict.position_error <= nearest * (1 + 1e-9)).all()
    assert verdict.position_error == pytest.approx(nearest, rel=1e-3, abs=1e-4 * task.size)


def test_targets_out_of_order_are_a_defect() -> None:
    linkage, theta2 = planted((3, 1))
    task = PathTask(solve_position(linkage, theta2[[0, 2, 1, 3, 5, 4, 6]]).p)
    verdict = verify(linkage, task, EXACT)
    assert {each.requirement for each in verdict.defects} & {"exact", "order"}


@pytest.mark.parametrize("name", ["watt-2 on the driver", "stephenson-3"])
def test_a_loop_that_does_not_lead_p_must_close(name: str) -> None:
    """P is finite where it is open: the linkage cannot be assembled."""
    whole = SIX_BARS[name].changed(point_link=3)
    theta2 = np.array([0.2, 0.5, 0.9, 1.4])
    task = PathTask(solve_position(whole, theta2).p, timing=theta2 - theta2[0])
    assert verify(whole, task, LOOSE).error_max < 1e-12
    broken = whole.changed(r5=30.0)
    assert np.isnan(solve_position(broken, theta2).p).all()
    verdict = verify(broken, task, Requirements(exact=False, same_branch=False))
    assert not verdict.ok
    assert np.isinf(verdict.position_error).all()


@pytest.mark.parametrize("hosts", [(2, 1), (4, 1)])
def test_timed_points_of_a_watt_2(hosts: tuple[int, int]) -> None:
    """P does not depend on the assembly of a loop that does not lead it."""
    linkage, theta2 = planted(hosts)
    task = PathTask(solve_position(linkage, theta2).p, timing=theta2 - theta2[0])
    for same_branch in (True, False):
        verdict = verify(linkage, task, Requirements(exact=False, same_branch=same_branch))
        assert verdict.error_max < 1e-12 * task.size


@pytest.mark.parametrize("hosts", HOSTS)
def test_the_length_of_a_curve(hosts: tuple[int, int]) -> None:
    linkage, _ = planted(hosts)
    steps = np.diff(solve_position(linkage, TURN).p, axis=0)
    chords = np.hypot(*steps.T).sum()
    assert closed_length(linkage) == pytest.approx(chords, rel=1e-6)


def test_a_curve_that_strays_between_the_points_is_a_defect() -> None:
    linkage, _ = planted((3, 1))
    few = PathTask(solve_position(linkage, TURN[:-1:5000]).p, closed=True)
    (defect,) = (
        each for each in verify(linkage, few, LOOSE).defects if each.requirement == "length_ratio_max"
    )
    ratio = closed_length(linkage) / spline_length(few.points)
    assert (defect.found, defect.allowed) == (pytest.approx(ratio), "up to 1.02")
    many = PathTask(solve_position(linkage, TURN[:-1:200]).p, closed=True)
    verdict = verify(linkage, many, LOOSE)
    assert "length_ratio_max" not in {each.requirement for each in verdict.defects}
    assert verdict.length_ratio == pytest.approx(1.0, abs=1e-5)


def test_arms_lead_to_the_joints_of_the_link_of_p() -> None:
    for linkage in SIX_BARS.values():
        task = PathTask(solve_position(linkage, np.array([0.1, 0.4, 0.8])).p)
        state = solve_position(linkage, 0.3)
        link = linkage.mechanism.links[linkage.mechanism.carries - 1]
        joints = [state.point(name) for name in link.points if name in ("o2", "a", "b", "c", "d", "e", "o4")][
            :2
        ]
        most = max(float(np.hypot(*(state.p - joint))) for joint in joints)
        least = verify(linkage, task, Requirements(exact=False, coupler_arms=(most * 1.01, 1e3)))
        assert "coupler_arms" in {each.requirement for each in least.defects}
        held = verify(linkage, task, Requirements(exact=False, coupler_arms=(0, most * 1.01)))
        assert "coupler_arms" not in {each.requirement for each in held.defects}


def stopped(hosts: tuple[int, int]) -> tuple[SixBar, float, float]:
    """A six-bar whose first loop turns, and whose second one stops the driver; the ends of its range, rad."""
    some = six_bars(f"pins {hosts[0]} {hosts[1]}", 60, np.random.default_rng(6), turning=False)
    for k in range(60):
        linkage = some[k].changed(point_link=5)
        low, high = max(driver_ranges(linkage).tolist(), key=lambda ends: float(np.nan_to_num(np.ptp(ends))))
        if 1.1 * np.pi < high - low < 1.9 * np.pi:
            return linkage, low, high
    raise ValueError(f"no six-bar with hosts {hosts} and such a range")


def poses_at(linkage: SixBar, theta2: np.ndarray[Any, Any], timed: bool = False) -> MotionTask:
    state = solve_position(linkage, theta2)
    timing = theta2 - theta2[0] if timed else None
    return MotionTask(state.p, np.unwrap(state.theta5), timing=timing)


def without_sizes(**given: Any) -> Requirements:
    return Requirements(exact=True, link_length=(0, 1e4), link_ratio_max=1e4, coupler_arms=(0, 1e4), **given)


@pytest.mark.quick("hosts0", "hosts2")
@pytest.mark.parametrize("hosts", HOSTS)
def test_a_driver_that_the_second_loop_stops_does_not_turn_fully(hosts: tuple[int, int]) -> None:
    linkage, low, high = stopped(hosts)
    theta2 = low + (high - low) * np.array([0.05, 0.4, 0.6, 0.95])
    plan = plan_of(linkage)
    ends = reach(plan, start(plan, theta2[0]), theta2[0])[:, 0]
    assert ends == pytest.approx([low, high], abs=1e-5)
    for timed in (False, True):
        task = poses_at(linkage, theta2, timed)
        (defect,) = verify(linkage, task, without_sizes()).defects
        assert defect.requirement == "rotatability"
        assert defect.found == pytest.approx(np.degrees(high - low))
        verdict = verify(linkage, task, without_sizes(rotatability="any"))
        assert verdict.ok, verdict.defects
        assert np.ptp(verdict.theta2) == pytest.approx(theta2[-1] - theta2[0])


@pytest.mark.quick("hosts1", "hosts3")
@pytest.mark.parametrize("hosts", HOSTS)
def test_a_motion_does_not_pass_where_the_second_loop_is_open(hosts: tuple[int, int]) -> None:
    """Two poses are joined the longer way round; three out of order are not met, though they would be."""
    linkage, low, high = stopped(hosts)
    wanted = without_sizes(rotatability="any")
    theta2 = low + (high - low) * np.array([0.03, 0.97])
    verdict = verify(linkage, poses_at(linkage, theta2), wanted)
    assert verdict.ok, verdict.defects
    assert np.ptp(verdict.theta2) == pytest.approx(theta2[1] - theta2[0])
    assert verdict.transmission_min_task > 0
    mixed = verify(linkage, poses_at(linkage, low + (high - low) * np.array([0.3, 0.9, 0.1])), wanted)
    assert {each.requirement for each in mixed.defects} & {"exact", "order"}


def test_change_points_of_the_second_loop_are_excluded_as_the_margin_demands() -> None:
    parallel = {
        "o2": (0, 0),
        "o4": (4, 0),
        "r2": 1,
        "r3": 3.5,
        "r4": 3,
        "hosts": (2, 1),
        "coupler_point": (1, 1),
    }
    linkage = SixBar(**parallel, c=(1, 0), d=(-4, 0), r5=4, r6=1)
    task = PathTask(solve_position(linkage, np.array([0.5, 1.0, 1.5])).p, timing=[0, 0.5, 1.0])
    (defect,) = verify(linkage, task, without_sizes()).defects
    assert (defect.requirement, defect.allowed) == ("rotatability", "0 (full-crank)")
    assert verify(linkage, task, without_sizes(rotatability_margin=0)).ok
