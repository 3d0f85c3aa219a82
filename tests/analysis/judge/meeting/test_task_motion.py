"""The driver's motion through its angles at the targets: in order up to rounding, no further."""

import numpy as np
import pytest

from grashof.analysis.judge.meeting.task_motion import TaskMotion, task_motion
from grashof.problems import FourBar

CRANK = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=3.5, r4=2.5)
GROUND = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)  # swings 108 deg either way about the ground
BACK = FourBar(o2=(0, 0), o4=(1, 0), r2=1.5, r3=4, r4=2)  # swings about theta1 + pi
RANGES = FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=1, r4=3)  # a Grashof double-rocker
FOLDING = FourBar(o2=(0, 0), o4=(2, 0), r2=1, r3=3, r4=2)  # folds at theta1, a change point
TINY = 1e-11  # deg

IN_ORDER = [  # angles in deg, where it begins, how far it turns
    (CRANK, [10, 100, 200], 10, 190),
    (CRANK, [200, 100, 10], 200, -190),
    (CRANK, [300, 350, 20, 40], 300, 100),
    (CRANK, [20, 350, 300], 20, -80),
    (CRANK, [-170, 170, 90], -170, -100),
    (CRANK, [0, 50], 0, 50),
    (CRANK, [50, 0], 50, -50),
    (CRANK, [0, 190], 0, -170),
    (CRANK, [0, 90, 180, 270, 0], 0, 360),
    (CRANK, [0, -90, -180, -270, 0], 0, -360),
    (CRANK, [0, 120, 120, 240], 0, 240),
    (CRANK, [0, 100, 50], 0, -310),
    # Rounding does not add a turn.
    (CRANK, [0, 100, 100 - TINY, 200], 0, 200),
    (CRANK, [0, 90, 180, 270, -TINY], 0, 360),
    (CRANK, [0, 90, 180, 270, TINY], 0, 360),
    (GROUND, [-100, 0, 100], -100, 200),
    (GROUND, [100, 0, 300, 260], 100, -200),
    (BACK, [170, -170, -150], 170, 40),
    (BACK, [-150, 170], 210, -40),
    (RANGES, [-60, -70], -60, -10),
    (FOLDING, [170, 180, -170], 170, 20),
    (FOLDING, [-170, -180, 170], -170, -20),
    (FOLDING, [-20, 30], -20, 50),
]


def through(linkage: FourBar, degrees: list[float], ordered: bool = True) -> TaskMotion:
    way = task_motion(linkage, np.radians(degrees), ordered)
    assert np.exp(1j * way.theta2) == pytest.approx(np.exp(1j * np.radians(degrees)), abs=1e-12)
    return way


@pytest.mark.parametrize(("linkage", "degrees", "start", "turned"), IN_ORDER)
def test_targets_met_in_sequence(linkage: FourBar, degrees: list[float], start: float, turned: float) -> None:
    way = through(linkage, degrees)
    assert way.in_order
    assert np.degrees([way.start, way.end]) == pytest.approx([start, start + turned], rel=1e-9, abs=1e-9)
    assert way.direction == np.sign(turned)
    assert (way.theta2[0], way.theta2[-1]) == pytest.approx((way.start, way.end), abs=1e-9)
    assert (way.direction * np.diff(way.theta2) >= -1e-9).all()  # counted on


@pytest.mark.parametrize("degrees", [[0, 90, 45, 200], [0, 10, 350, 340], [0, 90, 180, 270, 10]])
def test_a_crank_that_takes_more_than_a_turn_is_out_of_order(degrees: list[float]) -> None:
    way = through(CRANK, degrees)
    assert (way.in_order, np.degrees(way.start)) == (False, pytest.approx(degrees[0]))
    assert abs(np.degrees(way.end - way.start)) > 360


@pytest.mark.parametrize(
    ("degrees", "span"),
    [
        ([0, 100, 50], 100),
        ([350, 20, 10], 30),
        ([350, 20, 5], 30),
        ([0, 190], 170),
        ([0, 120, 240], 240),
        ([10, 200, 350, 0], 170),
    ],
)
def test_without_order_the_shortest_arc_is_used(degrees: list[float], span: float) -> None:
    way = through(CRANK, degrees, ordered=False)
    assert np.degrees(way.end - way.start) == pytest.approx(span)
    assert (way.theta2.min(), way.theta2.max()) == pytest.approx((way.start, way.end), abs=1e-9)


@pytest.mark.parametrize("degrees", [[0.0, 60.0, 30.0], [0.0, 60.0, 0.0], [-20.0, 80.0, -60.0]])
def test_a_rocker_that_turns_back_is_out_of_order(degrees: list[float]) -> None:
    way = through(GROUND, degrees)
    assert not way.in_order
    assert np.degrees([way.start, way.end]) == pytest.approx([min(degrees), max(degrees)])
    assert np.degrees(way.theta2) == pytest.approx(degrees)


@pytest.mark.parametrize("linkage", [GROUND, CRANK])
@pytest.mark.parametrize(("back", "in_order"), [(1e-12, True), (1e-6, False), (0.01, False)])
def test_a_step_back_is_out_of_order_unless_it_is_rounding(
    linkage: FourBar, back: float, in_order: bool
) -> None:
    steps = np.array([0.2, 0.4, 0.4 - back, 0.6])
    for theta2 in (steps, -steps):
        found = task_motion(linkage, theta2, True)
        assert found.in_order is in_order
        if in_order:
            assert found.direction == np.sign(theta2[0])
            assert (found.start, found.end) == pytest.approx((theta2[0], theta2[-1]))


def test_a_closed_motion_continues_to_a_turn() -> None:
    there = task_motion(GROUND, np.array([-0.3, 0.1, 0.5]), True)
    assert there.closed().end == pytest.approx(-0.3 + 2 * np.pi)
