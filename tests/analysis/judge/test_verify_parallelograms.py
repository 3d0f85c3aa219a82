"""The judge on linkages with change points, where rounding must decide nothing."""

from typing import Any

import numpy as np
import pytest

from grashof.analysis import solve_position, verify
from grashof.analysis.mechanism.mobility import full_rotation, passes_change_point
from grashof.problems import FourBar, MotionTask, Requirements

ANY: dict[str, Any] = {"rotatability": "any", "link_length": (0, 1e3), "link_ratio_max": 1e4}


def drawn(seed: int) -> FourBar:
    """A parallelogram whose lengths are equal but for rounding, somewhere in the plane."""
    rng = np.random.default_rng(seed)
    o2, coupler, crank = rng.normal(size=3) * 30 + 1j * rng.normal(size=3)
    o4, a = o2 + coupler, o2 + crank
    b = a + coupler
    return FourBar(
        o2=(o2.real, o2.imag),
        o4=(o4.real, o4.imag),
        r2=abs(a - o2),
        r3=abs(b - a),
        r4=abs(b - o4),
        coupler_point=tuple(rng.normal(size=2) * 20),
        assembly=1,
        body_angle=0.3,
    )


def task_of(linkage: FourBar, from_ground: list[float], assembly: list[int]) -> MotionTask:
    """Poses at driver angles (deg) counted from the ground line, on given assemblies."""
    state = solve_position(linkage, linkage.theta1 + np.radians(from_ground), np.array(assembly))
    return MotionTask(state.p, state.theta3 + linkage.body_angle)


def kinds(linkage: FourBar, task: MotionTask, **wanted: Any) -> set[str]:
    verdict = verify(linkage, task, Requirements(**{**ANY, **wanted}))
    assert not verdict.full_rotation
    return {defect.requirement for defect in verdict.defects}


@pytest.mark.parametrize("seed", range(30))
def test_between_its_change_points_a_parallelogram_does_its_task(seed: int) -> None:
    linkage = drawn(seed)
    assert kinds(linkage, task_of(linkage, [20, 50, 90, 150], [1, 1, 1, 1])) == set()
    assert kinds(linkage, task_of(linkage, [150, 90, 20], [1, 1, 1])) == set()


@pytest.mark.parametrize("seed", range(30))
def test_past_a_change_point_lies_another_branch(seed: int) -> None:
    """The sine of theta4 - theta3 changes sign where a parallelogram goes on as one."""
    linkage = drawn(seed)
    on = task_of(linkage, [60, 120, 200], [1, 1, -1])
    assert "same_branch" in kinds(linkage, on)
    assert "same_branch" not in kinds(linkage, on, same_branch=False)


@pytest.mark.parametrize("seed", range(30))
def test_going_on_as_an_antiparallelogram_passes_a_change_point(seed: int) -> None:
    """One assembly sign, and yet a dead position on the way."""
    linkage = drawn(seed)
    assert {"same_branch", "order"} & kinds(linkage, task_of(linkage, [60, 120, 200], [1, 1, 1]))
    back = task_of(linkage, [30, 120, 60], [1, 1, 1])  # in order the other way round only
    assert {"same_branch", "order"} & kinds(linkage, back)


@pytest.mark.parametrize("seed", range(30))
def test_the_antiparallelogram_is_not_taken_for_the_parallelogram(seed: int) -> None:
    linkage = drawn(seed)
    crossed = task_of(linkage, [200, 230, 300], [1, 1, 1])
    assert kinds(linkage, crossed) == set()
    turned = task_of(linkage, [200, 230, 300], [-1, -1, -1])  # its parallelogram
    assert np.ptp(np.unwrap(turned.angles)) < 1e-9
    assert np.ptp(np.unwrap(crossed.angles)) > 0.01
    assert "same_branch" in kinds(linkage, turned)


def test_change_points_of_a_parallelogram_a_kite_and_others() -> None:
    parallelogram = FourBar(o2=(0, 0), o4=(3, 0), r2=2, r3=3, r4=2)
    assert not full_rotation(parallelogram)
    assert [passes_change_point(parallelogram, *ends) for ends in ((0.1, 3.1), (-0.1, 0.1), (6.2, 3.2))] == [
        False,
        True,
        False,
    ]
    stretched = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=3, r4=3)  # r1 + r2 = r3 + r4 alone
    assert [passes_change_point(stretched, *ends) for ends in ((-3, 3), (3, 3.3), (-4, -3))] == [
        False,
        True,
        True,
    ]
    usual = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    assert not passes_change_point(usual, 0, 7)
