"""Timed, closed and mixed tasks through the judge's one door."""

from typing import Any

import numpy as np
import pytest
from changed_tasks import freed, perturbed

from grashof.analysis import solve_position, verify
from grashof.analysis.judge.how_met import meet
from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion
from grashof.analysis.judge.planted import planted_motion, planted_path, random_full_crank
from grashof.problems import FourBar, MotionTask, PathTask, Requirements

LEAST = Requirements(exact=False)
TURN = 2 * np.pi
MIXED = slice(2, None, 3), slice(1, None, 3)  # full poses, points and angles in turn


def met(linkage: FourBar, task: Any, wanted: Requirements) -> tuple[Targets, TaskMotion]:
    """The targets as a single linkage meets them, and its motion."""
    return meet([linkage], linkage[None], task, wanted)[0]


def squares_at(linkage: FourBar, task: MotionTask, theta2: Any) -> Any:
    """Weighted squares at driver angles (..., N), by the definition."""
    state = solve_position(linkage, theta2)
    gap = np.nan_to_num(((state.p - task.positions) ** 2).sum(axis=-1))
    off = np.nan_to_num(np.angle(np.exp(1j * (state.theta3 + linkage.body_angle - task.angles))))
    return (task.weights * (gap + (task.angle_length * off) ** 2)).sum(axis=-1)


@pytest.mark.parametrize("poses", [2, 4, 12])
@pytest.mark.parametrize("mixed", [False, True])
def test_planted_timed_poses_are_met_in_time(poses: int, mixed: bool) -> None:
    for seed in range(3):
        task, linkage = planted_motion(np.random.default_rng([poses, seed]), poses, timed=True)
        task = freed(task, *MIXED, timing=task.timing) if mixed and poses > 2 else task
        for order in (True, False):
            targets, motion = met(linkage, task, Requirements(order=order))
            assert np.nanmax(targets.position_error) < 1e-9 * task.size
            assert np.nanmax(targets.angle_error) < 1e-9
            turned = motion.direction * (motion.theta2 - motion.theta2[0])
            np.testing.assert_allclose(turned, task.driver_turns, rtol=0, atol=1e-12)
            assert (targets.assembly == linkage.assembly).all()


@pytest.mark.parametrize("mixed", [False, True])
def test_no_other_first_angle_has_less_squares(mixed: bool) -> None:
    for seed in range(3):
        rng = np.random.default_rng([9, seed])
        task, linkage = planted_motion(rng, 7, timed=True)
        task = perturbed(task, rng, 0.1, weights=rng.uniform(0.5, 2, 7), timing=task.timing)
        task = freed(task, *MIXED, weights=task.weights, timing=task.timing) if mixed else task
        verdict = verify(linkage, task, LEAST)
        first = np.linspace(0, TURN, 4000)[:, None]
        around = [squares_at(linkage, task, first + sense * task.driver_turns).min() for sense in (1, -1)]
        assert verdict.square <= min(around) * (1 + 1e-9)
        assert verdict.square == pytest.approx(squares_at(linkage, task, verdict.theta2), rel=1e-9)


def test_timed_poses_are_met_from_a_given_angle_on() -> None:
    task, linkage = planted_motion(np.random.default_rng(4), 5, timed=True)
    _, motion = met(linkage, task, Requirements(theta2_start_deg=33.0))
    assert motion.theta2[0] == np.radians(33.0)


@pytest.mark.parametrize("timed", [False, True])
def test_closed_poses_take_a_full_turn(timed: bool) -> None:
    for seed in range(3):
        task, linkage = planted_motion(np.random.default_rng([3, seed]), 5, timed=timed)
        plain, closed = (
            verify(linkage, each, LEAST)
            for each in (task, MotionTask(task.positions, task.angles, timing=task.timing, closed=True))
        )
        assert closed.transmission_min_task == pytest.approx(closed.transmission_min_cycle, abs=1e-9)
        assert plain.transmission_min_task >= closed.transmission_min_task
        assert closed.size >= plain.size
        np.testing.assert_allclose(closed.theta2, plain.theta2)
        _, motion = met(linkage, MotionTask(task.positions, task.angles, closed=True), LEAST)
        assert motion.end - motion.start == pytest.approx(motion.direction * TURN)


def test_positions_alone_are_met_as_points() -> None:
    for seed in range(3):
        rng = np.random.default_rng([8, seed])
        path, linkage = planted_path(rng, 6)
        places = path.points + 0.1 * path.size * rng.normal(size=(6, 2))
        one = verify(linkage, PathTask(places), LEAST)
        other = verify(linkage, MotionTask(places, np.full(6, np.nan)), LEAST)
        np.testing.assert_allclose(other.theta2, one.theta2, rtol=0, atol=1e-9)
        assert other.square == pytest.approx(one.square, rel=1e-9)


def test_weights_of_points_move_where_they_are_met_together() -> None:
    """Two points out of order are met together: at the better place for the heavier one."""
    linkage = random_full_crank(np.random.default_rng(2))
    places = solve_position(linkage, [0.1, 1.4, 1.2, 2.5]).p
    errors = []
    for heavy in (1.0, 1e4):
        task = MotionTask(places, np.full(4, np.nan), weights=[1, heavy, 1, 1])
        targets, motion = met(linkage, task, LEAST)
        assert motion.in_order
        errors.append(targets.position_error)
    assert errors[1][1] < 1e-3 * errors[0][1]
    assert errors[1][2] > errors[0][2]


@pytest.mark.parametrize("theta2", [[4.0, 4.5, 5.0], [-4.0, -3.5, -3.0], [9.0, 9.4, 9.9], [2.9, 3.4, 4.0]])
@pytest.mark.parametrize("timed", [False, True])
def test_the_driver_starts_within_half_a_turn(theta2: list[float], timed: bool) -> None:
    crank = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
    angles = np.array(theta2)
    task = PathTask(solve_position(crank, angles).p, timing=angles - angles[0] if timed else None)
    _, motion = met(crank, task, Requirements())
    assert -np.pi < motion.start <= np.pi
    turns = (motion.theta2 - angles) / TURN
    assert turns == pytest.approx(np.full(3, np.round(turns[0])), abs=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_a_timed_target_with_a_wide_zone_moves_the_others_out_of_no_zone(seed: int) -> None:
    """One target is far from a planted path, within its zone; the others, on the path, have narrow zones."""
    rng = np.random.default_rng([63, seed])
    task, linkage = planted_path(rng, 7, timed=True)
    points, zones = task.points.copy(), np.full(7, 0.01 * task.size)
    points[3] += 0.25 * task.size * np.array([np.cos(seed), np.sin(seed)])
    zones[3] = 0.3 * task.size
    assert verify(linkage, PathTask(points, timing=task.timing, within=zones), Requirements()).ok


@pytest.mark.parametrize("timed", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_poses_are_met_where_angles_have_narrow_zones_and_positions_wide_ones(seed: int, timed: bool) -> None:
    rng = np.random.default_rng([64, seed])
    task, linkage = planted_motion(rng, 6, timed=timed)
    off = rng.normal(size=(6, 2))
    off *= 0.3 * task.size * rng.random((6, 1)) / np.linalg.norm(off, axis=1, keepdims=True)
    zones = {"within": np.full(6, 0.31 * task.size), "angle_within": np.full(6, 0.004)}
    asked = MotionTask(task.positions + off, task.angles, timing=task.timing, **zones)
    assert verify(linkage, asked, Requirements()).ok


@pytest.mark.parametrize("seed", range(12))
def test_a_timed_linkage_is_placed_within_its_zones_if_it_can_be(seed: int) -> None:
    """Found anew on a grid of first angles; least squares would miss one by 6 % of a zone, and up to half."""
    rng = np.random.default_rng([67, seed])
    task, linkage = planted_path(rng, int(rng.integers(4, 12)), timed=True)
    points = task.points + 0.05 * task.size * rng.normal(size=task.points.shape)
    first = np.linspace(0, TURN, 20_001)[:, None]
    gaps = [solve_position(linkage, first + sense * task.driver_turns).p - points for sense in (1, -1)]
    zone = 1.0001 * np.nanmin(np.linalg.norm(gaps, axis=-1).max(axis=-1))
    assert verify(linkage, PathTask(points, timing=task.timing, within=zone), Requirements()).ok
    least_squares = verify(linkage, PathTask(points, timing=task.timing), LEAST)
    assert least_squares.position_error.max() >= zone / 1.0002


@pytest.mark.parametrize("seed", range(12))
def test_each_pose_is_met_within_its_zones_if_it_can_be(seed: int) -> None:
    """Found anew on a grid of driver angles, in any order."""
    rng = np.random.default_rng([68, seed])
    task, linkage = planted_motion(rng, int(rng.integers(3, 10)))
    there, ratio = perturbed(task, rng, 0.05), [0.3, 1.0, 3.0][seed % 3]  # rad of a zone per size
    state = solve_position(linkage, np.linspace(0, TURN, 40_001)[:, None])
    gap = np.linalg.norm(state.p - there.positions, axis=-1) / task.size
    off = np.abs(np.angle(np.exp(1j * (state.theta3 + linkage.body_angle - there.angles)))) / ratio
    zone = 1.0002 * np.nanmin(np.fmax(gap, off), axis=0).max()
    zones = {"within": zone * task.size, "angle_within": zone * ratio}
    asked = MotionTask(there.positions, there.angles, **zones)
    assert not verify(linkage, asked, Requirements(order=False, same_branch=False)).defects
    ordered = verify(linkage, asked, Requirements())
    assert {each.requirement for each in ordered.defects} <= {"order", "within", "angle_within_deg"}
    if ordered.order_ok:
        assert (ordered.direction * np.diff(ordered.theta2) >= -1e-9).all()


def test_zones_that_are_alike_change_no_driver_angle() -> None:
    task, linkage = planted_motion(np.random.default_rng(65), 8)
    there = perturbed(task, np.random.default_rng(66), 0.05)
    zoned = MotionTask(there.positions, there.angles, within=0.4 * task.size)
    plain, with_zones = (met(linkage, each, LEAST)[0].theta2 for each in (there, zoned))
    np.testing.assert_allclose(plain, with_zones, atol=1e-9)
