"""Verdicts on poses with free parts, weights and least squares, and on constraints of the user's own."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from changed_tasks import freed, perturbed

from grashof.analysis import Design, Verdict, verify
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import FourBar, MotionTask, Requirements

EXACT, LEAST = Requirements(exact=True), Requirements(exact=False)


def planted(seed: int, poses: int) -> tuple[MotionTask, FourBar]:
    """A task whose linkage meets the default requirements."""
    rng = np.random.default_rng([31, seed])
    while True:
        task, linkage = planted_motion(rng, poses)
        if verify(linkage, task, EXACT).ok:
            return task, linkage


@pytest.mark.quick("7-places0-angles0", "6-places1-angles1")
@pytest.mark.parametrize(
    ("poses", "places", "angles"),
    [(7, [], [1, 2, 4, 5]), (6, [1, 3], []), (5, [2], []), (4, [1, 2], [0]), (9, [], list(range(1, 9)))],
)
def test_a_design_of_the_full_task_does_it_with_parts_left_free(
    poses: int, places: list[int], angles: list[int]
) -> None:
    """An angle alone is met at several driver angles, on both assemblies: one way through them will do."""
    for seed in range(3):
        task, linkage = planted(seed, poses)
        free = freed(task, places, angles)
        size = free.size / task.size  # what is judged by the size may be less now
        wanted = Requirements(exact=True, link_length=(1e-3 * task.size, 1e3 * task.size))
        if size < 0.1:
            continue
        verdict = verify(linkage, free, replace(wanted, coupler_arms=(0, 1e3 * task.size)))
        assert verdict.defects == (), seed
        np.testing.assert_array_equal(np.isnan(verdict.position_error), ~free.has_position)
        np.testing.assert_array_equal(np.isnan(verdict.angle_error), ~free.has_angle)
        assert verdict.error_max < 1e-9 * task.size
        assert (verdict.assembly == linkage.assembly).all()


def test_square_and_errors_count_given_parts_by_weight() -> None:
    rng = np.random.default_rng(7)
    task, linkage = planted(0, 6)
    weights = np.array([1, 2, 0.5, 3, 1, 4.0])
    free = freed(perturbed(task, rng, 0.01), [1], [3], weights=weights, angle_length=1.7 * task.size)
    verdict = verify(linkage, free, LEAST)
    gap, turn = verdict.position_error, 1.7 * task.size * verdict.angle_error
    expected = sum(weights[k] * gap[k] ** 2 for k in (0, 2, 3, 4, 5))
    expected += sum(weights[k] * turn[k] ** 2 for k in (0, 1, 2, 4, 5))
    assert verdict.square == pytest.approx(expected, rel=1e-12)
    given = gap[[0, 2, 3, 4, 5]]
    assert verdict.error_max == given.max() > 0
    assert verdict.error_sse == pytest.approx((given**2).sum(), rel=1e-12)
    assert verdict.error_rms == pytest.approx(np.sqrt((given**2).mean()), rel=1e-12)


def test_a_wrong_part_is_not_exact_and_a_free_one_does_not_count() -> None:
    task, linkage = planted(2, 5)
    positions, angles = task.positions.copy(), task.angles.copy()
    angles[2] += 0.01
    off = MotionTask(positions, angles)
    assert [d.requirement for d in verify(linkage, off, EXACT).defects if d.requirement == "exact"]
    free = freed(off, [], [2])
    verdict = verify(linkage, free, EXACT)
    assert "exact" not in [defect.requirement for defect in verdict.defects]
    alone = freed(off, [2], [])  # an angle alone may be met elsewhere
    assert verify(linkage, alone, EXACT).error_max < 1e-9 * task.size


@pytest.mark.slow
def test_poses_out_of_order_are_a_defect_when_exact_and_cost_least_squares() -> None:
    checked = 0
    for seed in range(12):
        task, linkage = planted(seed, 5)
        visit = [0, 1, 3, 2, 4]
        swapped = MotionTask(task.positions[visit], task.angles[visit])
        exact, least = verify(linkage, swapped, EXACT), verify(linkage, swapped, LEAST)
        assert not exact.order_ok
        assert "order" in [defect.requirement for defect in exact.defects]
        assert exact.square < 1e-18 * task.size**2  # each pose by itself is met
        any_order = verify(linkage, swapped, replace(LEAST, order=False))
        assert any_order.square < 1e-18 * task.size**2
        if least.order_ok:
            assert "order" not in [defect.requirement for defect in least.defects]
            assert least.square > 1e-12 * task.size**2
            steps = least.direction * np.diff(least.theta2)
            assert (steps >= -1e-9).all()
            assert steps.sum() <= 2 * np.pi + 1e-9
            checked += 1
    assert checked >= 8


def seen(linkage: FourBar, task: MotionTask, wanted: Requirements) -> tuple[Design, Verdict]:
    """The design that a constraint sees, and the verdict."""
    shown: list[Design] = []

    def look(design: Design) -> float:
        shown.append(design)
        return -1.0

    verdict = verify(linkage, task, wanted, [look])
    (design,) = shown
    return design, verdict


def long_driver(design: Design) -> Any:
    return 2.0 * design.r2


def test_a_constraint_of_the_users_own_is_judged_by_its_value() -> None:
    task, linkage = planted(3, 4)
    r2 = float(linkage.r2)
    (own,) = verify(linkage, task, EXACT, [long_driver]).defects
    assert str(own) == f"constraints: long_driver is {2.0 * r2:.6g}, allowed: up to 0"
    assert own.found == own.miss == pytest.approx(2.0 * r2, rel=1e-12)
    assert verify(linkage, task, EXACT, [lambda design: design.r2 - r2]).ok  # zero is met
    assert verify(linkage, task, EXACT, [lambda design: design.r2 - r2 - 1e-10]).ok
    assert not verify(linkage, task, EXACT, [lambda design: design.r2 - r2 + 1e-6]).ok


def test_the_greatest_of_several_values_counts_and_nan_is_not_met() -> None:
    task, linkage = planted(4, 4)
    several = verify(linkage, task, EXACT, [lambda design: [-1.0, 0.25, -3.0]]).defects
    assert [(defect.what, defect.found) for defect in several] == [("<lambda>", 0.25)]
    assert not verify(linkage, task, EXACT, [lambda design: np.nan]).ok
    assert not verify(linkage, task, EXACT, [lambda design: [-1.0, np.nan]]).ok
    two = verify(linkage, task, EXACT, [lambda design: 1.0, long_driver, lambda design: 2.0]).defects
    assert [defect.found for defect in two if defect.what == "<lambda>"] == [1.0, 2.0]


def test_a_design_shows_all_places_at_the_targets() -> None:
    task, linkage = planted(5, 5)
    design, verdict = seen(linkage, task, EXACT)
    np.testing.assert_allclose(design.p, task.positions, atol=1e-9 * task.size)
    np.testing.assert_allclose(design.theta2, verdict.theta2)
    assert (design.r1, design.r2, design.r3, design.r4) == pytest.approx(linkage.lengths, rel=1e-12)
    turned = np.exp(1j * (task.angles - float(linkage.body_angle)))
    for k in range(5):
        coupler = complex(*(design.b[k] - design.a[k]))
        assert coupler == pytest.approx(float(linkage.r3) * turned[k], abs=1e-9 * task.size)
        assert np.hypot(*(design.a[k] - design.o2)) == pytest.approx(float(linkage.r2), rel=1e-9)
        assert np.hypot(*(design.b[k] - design.o4)) == pytest.approx(float(linkage.r4), rel=1e-9)


def test_a_design_is_seen_in_the_order_of_visit() -> None:
    task, linkage = planted(6, 5)
    visit = [3, 0, 4, 1, 2]
    mixed = MotionTask(task.positions[visit], task.angles[visit])
    design, _ = seen(linkage, mixed, replace(EXACT, order=False))
    steps = np.diff(np.array(design.theta2))
    assert (steps > 0).all() or (steps < 0).all()
    where = [int(np.argmin(np.hypot(*(task.positions - p).T))) for p in design.p]
    ring = [*range(5), *range(5)]
    around = ring + ring[::-1]
    assert any(around[k : k + 5] == where for k in range(len(around) - 4))


def test_ground_pivots_that_coincide_are_a_ratio_without_limit() -> None:
    task, _ = planted(7, 3)
    collapsed = FourBar(o2=(1, 2), o4=(1, 2), r2=1, r3=1.5, r4=1)
    defects = verify(collapsed, task, EXACT).defects
    assert [defect.found for defect in defects if defect.requirement == "link_ratio_max"] == [np.inf]
