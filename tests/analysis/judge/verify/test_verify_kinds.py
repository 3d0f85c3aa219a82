"""Verdicts on linkages of every kind: planted tasks are met, and errors are found."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof import problems
from grashof.analysis import (
    GrashofClass,
    driver_ranges,
    full_rotation,
    solve_kinematics,
    solve_position,
    verify,
)
from grashof.analysis.judge.design import Design
from grashof.analysis.judge.measures import PARTS, Values
from grashof.analysis.judge.planted import RANDOM, planted_motion, planted_path
from grashof.analysis.judge.tolerance import made_linkages, made_moves, robustness
from grashof.problems import InvertedSliderCrank, Manufacturing, MotionTask, PathTask, Problem, SliderCrank
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.quantities import Needs

ANY = problems.Requirements(
    exact=True, rotatability="any", link_length=(0.0, 1e9), coupler_arms=(0.0, 1e9), link_ratio_max=1e6
)
SWINGING = [GrashofClass.NON_GRASHOF, GrashofClass.SLIDER_ROCKER, GrashofClass.INVERTED_SLIDER_ROCKER]


@pytest.mark.parametrize("timed", [False, True], ids=["free", "timed"])
@pytest.mark.parametrize("mechanism", RANDOM)
def test_planted_tasks_are_met(mechanism, timed) -> None:
    for plant, targets in ((planted_motion, 4), (planted_path, 8)):
        task, linkage = plant(np.random.default_rng(0), targets, timed=timed, mechanism=mechanism)
        verdict = verify(linkage, task, ANY)
        assert verdict.ok, verdict.defects
        assert verdict.error_max < 1e-11 * task.size
        assert verdict.full_rotation
        assert (verdict.assembly == linkage.assembly).all()


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("mechanism", RANDOM)
def test_a_target_moved_away_is_missed_by_its_distance_at_most(mechanism, seed) -> None:
    task, linkage = planted_path(np.random.default_rng(seed), 6, mechanism=mechanism)
    moved = np.array(task.positions)
    moved[2] += 0.01 * task.size
    verdict = verify(linkage, PathTask(moved), ANY)
    assert [defect.requirement for defect in verdict.defects] == ["exact"]
    fine = solve_position(linkage, np.linspace(-np.pi, np.pi, 20001)).p
    gaps = np.hypot(*(moved[2] - fine).T)
    nearest = gaps.min()
    assert verdict.position_error[2] == pytest.approx(nearest, rel=1e-3)
    assert verdict.error_max < 0.01 * np.sqrt(2) * task.size * (1 + 1e-9)


@pytest.mark.parametrize("kind", SWINGING)
def test_drivers_that_swing_do_planted_tasks_in_either_sense(linkages, kind) -> None:
    @settings(max_examples=5)
    @given(linkages(kind), st.booleans(), st.booleans())
    def check(linkage, back, poses) -> None:
        low, high = driver_ranges(linkage)[0]
        theta2 = low + (high - low) * np.array([0.1, 0.3, 0.45, 0.7, 0.9])[:: -1 if back else 1]
        state = solve_position(linkage, theta2)
        angles = state.theta3 + linkage.body_angle
        task = MotionTask(state.p, angles) if poses else PathTask(state.p)
        if np.ptp(task.positions, axis=0).max() < 1e-3 * linkage.lengths.sum():
            return
        verdict = verify(linkage, task, ANY)
        assert verdict.circuit_ok
        assert verdict.branch_ok
        assert verdict.ok, verdict.defects
        if poses:
            assert verdict.direction == (-1 if back else 1)
        demanding = verify(linkage, task, replace(ANY, rotatability="full-crank"))
        assert "rotatability" in [defect.requirement for defect in demanding.defects]

    check()


@pytest.mark.parametrize("kind", SWINGING)
def test_both_assemblies_are_one_circuit_and_two_branches(linkages, kind) -> None:
    @settings(max_examples=4)
    @given(linkages(kind))
    def check(linkage) -> None:
        low, high = driver_ranges(linkage)[0]
        theta2 = low + (high - low) * np.array([0.2, 0.4, 0.6])
        state = solve_position(linkage, theta2, [1, 1, -1])
        task = MotionTask(state.p, state.theta3 + linkage.body_angle)
        verdict = verify(linkage, task, ANY)
        assert verdict.error_max < 1e-9 * max(task.size, 1)
        assert verdict.circuit_ok
        assert not verdict.branch_ok
        assert verdict.transmission_min_task == 0

    check()


@pytest.mark.parametrize("mechanism", RANDOM)
def test_the_two_assemblies_of_a_full_crank_are_two_circuits(mechanism) -> None:
    linkage = RANDOM[mechanism](np.random.default_rng(5))
    state = solve_position(linkage, [0.5, 1.5, 2.5], [1, 1, -1])
    task = MotionTask(state.p, state.theta3 + linkage.body_angle)
    verdict = verify(linkage, task, ANY)
    assert not verdict.circuit_ok
    assert verdict.error_max < 1e-9 * task.size


@pytest.mark.parametrize("mechanism", RANDOM)
def test_every_quantity_has_a_value_or_is_not_of_the_kind(mechanism) -> None:
    task, linkage = planted_path(np.random.default_rng(0), 6, mechanism=mechanism)
    problem = Problem(
        task=task, requirements=ANY, mechanism=mechanism, manufacturing=Manufacturing(1e-3 * task.size)
    )
    values = Values(linkage, verify(linkage, task, ANY, problem=problem), problem)
    for key, value in values.items():
        quantity = QUANTITIES[key]
        if mechanism not in quantity.kinds or not problem.states(quantity.needs):
            assert np.isnan(value), key
        elif quantity.needs in (Needs.NOTHING, Needs.MANUFACTURING) and key not in _MAY_LACK:
            assert np.isfinite(value), key
    for key in PARTS:
        if mechanism in QUANTITIES[key].kinds and QUANTITIES[key].needs is not Needs.CYLINDER:
            assert all(np.isfinite(part).all() for part in values.parts(key).values())


# Angle errors of points; link 4 of a double-crank or a turning block has no limit positions; forces.
_MAY_LACK = {
    "angle_error_max", "angle_error_rms", "body_angle", "time_ratio", "torque_peak", "torque_rms",
    "joint_force_peak",
}  # fmt: skip


@pytest.mark.parametrize("seed", range(2))
def test_the_stroke_is_the_way_of_the_slider(seed) -> None:
    rng = np.random.default_rng(seed)
    task, linkage = planted_path(rng, 5, mechanism="slider-crank")
    rocker = linkage.changed(r3=float(linkage.r2) * 0.9, offset=0.4 * linkage.r2)
    low, high = driver_ranges(rocker)[0]
    part = np.linspace(low + 0.05, high - 0.05, 5)
    swung = PathTask(solve_position(rocker, part).p)
    for each, done, ends in ((linkage, task, (0, 2 * np.pi)), (rocker, swung, part[[0, -1]])):
        values = Values(each, verify(each, done, ANY), Problem(task=done, mechanism="slider-crank"))
        travel = solve_kinematics(each, np.linspace(*ends, 20001)).slide.travel
        assert values["stroke"] == pytest.approx(np.ptp(travel), rel=1e-6)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("mechanism", RANDOM)
def test_swing_and_size_are_those_of_dense_positions(mechanism, seed) -> None:
    task, linkage = planted_path(np.random.default_rng(seed), 5, mechanism=mechanism)
    verdict = verify(linkage, task, ANY)
    state = solve_position(linkage, np.linspace(verdict.theta2[0], verdict.theta2[-1], 40001))
    pivots = [getattr(linkage, name)[None] for name in linkage.mechanism.ground]
    every = np.concatenate([state.a, state.b, state.p, *pivots])
    assert verdict.size == pytest.approx(np.hypot(*np.ptp(every, axis=0)), rel=1e-7)
    if mechanism == "inverted-slider-crank":
        values = Values(linkage, verdict, Problem(task=task, requirements=ANY, mechanism=mechanism))
        theta4 = np.unwrap(solve_position(linkage, np.linspace(0, 2 * np.pi, 20001)).theta4)
        assert values["output_swing"] == pytest.approx(np.ptp(theta4), rel=1e-6)


@pytest.mark.parametrize("mechanism", RANDOM)
def test_small_deviations_move_targets_as_exact_positions_do(mechanism) -> None:
    task, linkage = planted_path(np.random.default_rng(0), 5, mechanism=mechanism)
    verdict = verify(linkage, task, ANY)
    step = 1e-6 * task.size
    made = robustness(linkage, task, verdict, Manufacturing(step))
    assert made.moves.shape == (len(linkage.mechanism.dimensions),)
    others, possible = made_linkages(linkage, step * np.eye(len(linkage.mechanism.dimensions)))
    assert possible.all()
    there, here = (solve_position(each, verdict.theta2) for each in (others[:, None], linkage))
    assert made.moves == pytest.approx(
        np.hypot(*np.moveaxis(there.p - here.p, -1, 0)).max(axis=1) / step, rel=1e-3
    )
    assert abs(made.share_linear - made.share_made) < 0.01
    moves = made_moves(linkage, verdict.theta2, step)
    assert moves.point.max(axis=0) == pytest.approx(made.moves * step, rel=1e-9)
    turned = there.theta4 - here.theta4
    turned = (turned + np.pi) % (2 * np.pi) - np.pi
    assert np.allclose(moves.theta4, turned.T, rtol=1e-3, atol=1e-8)


@pytest.mark.quick("inverted-slider-crank")
@pytest.mark.parametrize("mechanism", RANDOM)
def test_parts_that_reach_into_an_area_are_named(mechanism) -> None:
    task, linkage = planted_path(np.random.default_rng(2), 5, mechanism=mechanism)
    verdict = verify(linkage, task, ANY)
    theta2 = verdict.theta2.mean()
    state, small = solve_position(linkage, theta2), 1e-3 * task.size
    square = small * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    points = ["o2", "o4", "a", "b", "p", "links"]
    places = {"A": state.a, "B": state.b, "P": state.p, "link AB": (state.a + state.b) / 2}
    for point, place in places.items():
        wanted = replace(ANY, keep_out=(place + square,), keep_out_for=points)
        found = verify(linkage, task, wanted).defects
        assert {defect.requirement for defect in found} == {"keep_out"}
        assert any(f"the depth of {point} inside" in str(defect) for defect in found)
    far = linkage.o2 + 1e3 * task.size + square
    assert verify(linkage, task, replace(ANY, keep_out=(far,), keep_out_for=points)).ok


@pytest.mark.parametrize("mechanism", RANDOM)
def test_a_closed_path_is_followed_all_around(mechanism) -> None:
    linkage = RANDOM[mechanism](np.random.default_rng(1))
    theta2 = np.linspace(0, 2 * np.pi, 13)[:-1]
    task = PathTask(solve_position(linkage, theta2).p, closed=True)
    wanted = replace(ANY, exact=False)
    problem = Problem(task=task, requirements=wanted, mechanism=mechanism)
    verdict = verify(linkage, task, wanted, problem=problem)
    assert verdict.ok, verdict.defects
    assert verdict.error_max < 1e-11 * task.size
    assert verdict.transmission_min_task == pytest.approx(verdict.transmission_min_cycle)
    values = Values(linkage, verdict, problem)
    assert 0 < values["hausdorff"] <= values["frechet"] * (1 + 1e-9)


def test_a_design_has_the_dimensions_of_its_kind() -> None:
    angles, signs = np.array([0.3, 0.5]), np.array([1, 1])
    slider = Design.of(SliderCrank(o2=(0, 0), r2=1, r3=3, offset=0.5), angles, signs)
    assert (slider.o4, slider.r1, slider.r4) == (None, None, None)
    assert (float(slider.r3), float(slider.offset), float(slider.slide_angle)) == (3, 0.5, 0)
    inverted = Design.of(InvertedSliderCrank(o2=(0, 0), o4=(0, -3), r2=1), angles, signs)
    assert (inverted.r3, inverted.r4, inverted.slide_angle) == (None, None, None)
    assert (float(inverted.r1), float(inverted.offset)) == (3, 0)
    four_bar = Design.of(problems.FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3), angles, signs)
    assert (four_bar.offset, four_bar.slide_angle) == (None, None)
    assert {each.mechanism for each in (slider, inverted, four_bar)} == set(RANDOM)


@pytest.mark.parametrize(
    ("linkage", "word"),
    [
        (SliderCrank((0, 0), 1, 3, 0.5, coupler_point=(1, 1)), "crank-rocker"),  # O4 lies at infinity
        (InvertedSliderCrank((0, 0), (3, 0), 1, coupler_point=(1, 1)), "crank-rocker"),
        (InvertedSliderCrank((0, 0), (1, 0), 3, coupler_point=(1, 1)), "double-crank"),
    ],
)
def test_a_block_swings_or_turns_and_a_slider_swings(linkage, word) -> None:
    task = PathTask(solve_position(linkage, [0.2, 0.8, 1.5, 2.0, 3.0]).p)
    assert full_rotation(linkage)
    assert verify(linkage, task, replace(ANY, rotatability=word)).ok
    (other,) = {"crank-rocker", "double-crank"} - {word}
    asked = verify(linkage, task, replace(ANY, rotatability=other))
    assert [defect.requirement for defect in asked.defects] == ["rotatability"]


@pytest.mark.parametrize(
    "linkage",
    [
        SliderCrank(o2=(0, 0), r2=2, r3=3, offset=1, coupler_point=(1, 0.5)),
        SliderCrank(o2=(0, 0), r2=2, r3=2, coupler_point=(1, 0.5)),
        InvertedSliderCrank(o2=(0, 0), o4=(3, 0), r2=2, offset=-1, coupler_point=(1, 0.5)),
    ],
)
def test_through_a_change_point_no_branch_is_kept(linkage) -> None:
    """There all joints come to lie in one line: a driver cannot decide where the rod goes from there."""
    change = float(linkage.theta1) + (np.pi if isinstance(linkage, SliderCrank) else 0.0)
    state = solve_position(linkage, change + np.array([-0.5, -0.2, 0.3, 0.6]))
    verdict = verify(linkage, MotionTask(state.p, state.theta3), ANY)
    assert verdict.grashof_class is GrashofClass.CHANGE_POINT
    assert not verdict.branch_ok
    state = solve_position(linkage, change + np.array([0.2, 0.3, 0.6, 0.8]))
    assert verify(linkage, MotionTask(state.p, state.theta3), ANY).ok
