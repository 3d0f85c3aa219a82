"""The judge on lengths, arms, boxes and angles: each limit by itself, and limits are inclusive."""

from typing import Any

import numpy as np
import pytest

from grashof.analysis import Defect, Verdict, solve_position, verify
from grashof.problems import Box, FourBar, MotionTask, Requirements

# In general position, so that no two limits are missed at once.
LINKAGE = FourBar(
    o2=(0.5, -1), o4=(4.2, 0.3), r2=1.1, r3=3.2, r4=2.6, coupler_point=(1.5, 0.8), body_angle=0.3
)
DEGREES = (20.0, 60.0, 110.0, 150.0)
STATE = solve_position(LINKAGE, np.radians(DEGREES))
TASK = MotionTask(STATE.p, STATE.theta3 + 0.3)
LENGTHS = dict(zip(("r1", "r2", "r3", "r4"), map(float, LINKAGE.lengths), strict=True))
ARMS = {"A-P": float(np.hypot(1.5, 0.8)), "B-P": float(np.hypot(1.7, 0.8))}
NEAR = 1e-6


def judged(**keys: Any) -> Verdict:
    return verify(LINKAGE, TASK, Requirements(**keys))


def only(verdict: Verdict, key: str, what: str, found: float) -> Defect:
    """The one defect there is; its message names the key, the quantity and the value found."""
    assert [(defect.requirement, defect.what) for defect in verdict.defects] == [(key, what)]
    defect = verdict.defects[0]
    assert defect.found == pytest.approx(found, rel=1e-9)
    assert str(defect) == f"{key}: {what} is {found:.6g}, allowed: {defect.allowed}"
    assert defect.miss > 0
    return defect


@pytest.mark.parametrize("name", ["r1", "r2", "r3", "r4"])
def test_limits_of_each_link(name: str) -> None:
    length = LENGTHS[name]
    for limits in ((length, length), (0.1, length), (length, 50.0)):
        assert judged(**{name: limits}).ok
    defect = only(judged(**{name: (0.1, length - NEAR)}), name, name, length)
    assert defect.allowed == f"0.1 to {length - NEAR:.6g}"
    assert defect.miss == pytest.approx(NEAR / TASK.size, rel=1e-6)
    defect = only(judged(**{name: (length + NEAR, 50.0)}), name, name, length)
    assert defect.allowed == f"{length + NEAR:.6g} to 50"
    assert defect.miss == pytest.approx(NEAR / TASK.size, rel=1e-6)


def test_limits_of_all_links_and_single_ones() -> None:
    shortest, longest = min(LENGTHS.values()), max(LENGTHS.values())
    assert judged(link_length=(shortest, longest)).ok
    only(judged(link_length=(shortest, longest - NEAR)), "link_length", "r1", longest)
    only(judged(link_length=(shortest + NEAR, longest)), "link_length", "r2", shortest)
    assert judged(link_length=(shortest + NEAR, longest), r2=(1.0, 1.2)).ok
    both = judged(link_length=(2.0, 3.0), r3=(3.3, 4.0))
    assert [(defect.requirement, defect.what) for defect in both.defects] == [
        ("link_length", "r1"),
        ("link_length", "r2"),
        ("r3", "r3"),
    ]


def test_default_lengths_exclude_only_the_absurd() -> None:
    small = verify(LINKAGE, MotionTask(STATE.p[:2], STATE.theta3[:2] + 0.3), Requirements())
    assert small.ok
    state = solve_position(LINKAGE, np.radians([20.0, 21.0, 21.5]))
    tiny = MotionTask(state.p, state.theta3 + 0.3)
    assert 20 * tiny.size < LENGTHS["r2"]
    found = verify(LINKAGE, tiny, Requirements(coupler_arms=(0, 10)))
    assert {(defect.requirement, defect.what) for defect in found.defects} == {
        ("link_length", name) for name in LENGTHS
    }


def test_ratio_of_the_links() -> None:
    ratio = max(LENGTHS.values()) / min(LENGTHS.values())
    assert judged(link_ratio_max=ratio).ok
    defect = only(
        judged(link_ratio_max=ratio - NEAR), "link_ratio_max", "the ratio of longest to shortest link", ratio
    )
    assert defect.allowed == f"up to {ratio - NEAR:g}"
    assert defect.miss == pytest.approx(NEAR / ratio, rel=1e-5)


def test_coupler_arms() -> None:
    short, long = ARMS["A-P"], ARMS["B-P"]
    assert short < long
    assert judged(coupler_arms=(short, long)).ok
    only(judged(coupler_arms=(short + NEAR, long)), "coupler_arms", "A-P", short)
    only(judged(coupler_arms=(short, long - NEAR)), "coupler_arms", "B-P", long)


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("name", ["o2", "o4", "a", "b"])
def test_boxes_of_the_pivots(name: str, axis: str) -> None:
    points = {"o2": LINKAGE.o2[None], "o4": LINKAGE.o4[None], "a": STATE.a, "b": STATE.b}[name]
    values = points[:, "xy".index(axis)]
    low, high = float(values.min()), float(values.max())
    assert judged(**{name: Box(**{axis: (low, high)})}).ok
    what = f"{name}.{axis}"
    defect = only(judged(**{name: Box(**{axis: (low + NEAR, np.inf)})}), name, what, low)
    assert defect.allowed == f"from {low + NEAR:.6g}"
    assert defect.miss == pytest.approx(NEAR / TASK.size, rel=1e-6)
    defect = only(judged(**{name: Box(**{axis: (-np.inf, high - NEAR)})}), name, what, high)
    assert defect.allowed == f"up to {high - NEAR:.6g}"
    wide = judged(**{name: Box(**{axis: (high + 1, high + 2)})})
    assert {(found.requirement, found.what) for found in wide.defects} == {(name, what)}
    assert all(found.allowed == f"{high + 1:.6g} to {high + 2:.6g}" for found in wide.defects)


@pytest.mark.parametrize(
    ("key", "what", "angle"),
    [
        ("ground_angle_deg", "direction of O2O4", float(np.degrees(np.arctan2(1.3, 3.7)))),
        ("theta2_start_deg", "driver angle at the first target", DEGREES[0]),
    ],
)
def test_required_angles(key: str, what: str, angle: float) -> None:
    for turns in (-360, 0, 360):
        assert judged(**{key: angle + turns}).ok
    for wrong in (angle + 1e-3, angle - 1e-3, angle + 180):
        defect = only(judged(**{key: wrong}), key, f"the {what} in deg", angle)
        assert defect.allowed == f"{wrong:g}"
        assert defect.miss == pytest.approx(np.radians(abs(wrong - angle)), rel=1e-6)
