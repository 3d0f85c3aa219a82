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


# Angles from the ground line in deg, assemblies, and of which requirements some are missed.
TASKS = {
    "between its change points": ([20, 50, 90, 150], [1, 1, 1, 1], set()),
    "between them, backwards": ([150, 90, 20], [1, 1, 1], set()),
    # The sine of theta4 - theta3 changes sign where a parallelogram goes on as one.
    "on another branch": ([60, 120, 200], [1, 1, -1], {"same_branch"}),
    # One assembly sign, and yet a dead position on the way.
    "on as an antiparallelogram": ([60, 120, 200], [1, 1, 1], {"same_branch", "order"}),
    "in order the other way round only": ([30, 120, 60], [1, 1, 1], {"same_branch", "order"}),
    "an antiparallelogram": ([200, 230, 300], [1, 1, 1], set()),
    "its parallelogram, not taken for it": ([200, 230, 300], [-1, -1, -1], {"same_branch"}),
}


@pytest.mark.parametrize("seed", range(4))
def test_branches_end_at_change_points(seed: int) -> None:
    linkage = drawn(seed)
    for name, (from_ground, assembly, some) in TASKS.items():
        found = kinds(linkage, task_of(linkage, from_ground, assembly))
        assert found & some if some else not found, name
    on = task_of(linkage, [60, 120, 200], [1, 1, -1])
    assert "same_branch" not in kinds(linkage, on, same_branch=False)
    crossed, turned = (task_of(linkage, [200, 230, 300], [sign] * 3) for sign in (1, -1))
    assert np.ptp(np.unwrap(turned.angles)) < 1e-9
    assert np.ptp(np.unwrap(crossed.angles)) > 0.01


@pytest.mark.parametrize(
    ("linkage", "ends", "passed"),
    [
        (FourBar((0, 0), (3, 0), 2, 3, 2), [(0.1, 3.1), (-0.1, 0.1), (6.2, 3.2)], [False, True, False]),
        # r1 + r2 = r3 + r4 alone
        (FourBar((0, 0), (4, 0), 2, 3, 3), [(-3, 3), (3, 3.3), (-4, -3)], [False, True, True]),
        (FourBar((0, 0), (100, 0), 40, 120, 80), [(0, 7)], [False]),
    ],
    ids=["parallelogram", "stretched", "none"],
)
def test_change_points(linkage: FourBar, ends: list[tuple[float, float]], passed: list[bool]) -> None:
    assert [passes_change_point(linkage, *each) for each in ends] == passed
    assert not (full_rotation(linkage) and any(passed))
