"""Where a linkage comes nearest to poses, and the way of the driver between them."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass
from grashof.analysis.judge.planted import planted_motion
from grashof.analysis.judge.poses import nearest_to_poses
from grashof.analysis.judge.task_motion import task_motion
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar, MotionTask

CHECKED = settings(max_examples=25)
TURN = 2 * np.pi
Brute = Callable[..., tuple[npt.NDArray[np.complex128], ...]]
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
CRANK_ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=3.5, r4=2.5)
ABOUT_GROUND = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)  # swings 108 deg either way
ABOUT_BACK = FourBar(o2=(0, 0), o4=(1, 0), r2=1.5, r3=4, r4=2)  # swings about theta1 + pi
TWO_RANGES = FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=1, r4=3)  # a Grashof double-rocker
PARALLELOGRAM_LIKE = FourBar(o2=(0, 0), o4=(2, 0), r2=1, r3=3, r4=2)  # folds at theta1, a change point


def misses_of_scan(close_loop: Brute, linkage: FourBar, task: MotionTask) -> npt.NDArray[np.float64]:
    """Least |dp|^2 + (angle_length dangle)^2 at each pose over all driver angles and both assemblies."""
    around = np.linspace(-np.pi, np.pi, 4001)
    target = task.positions @ np.array([1, 1j])
    least = np.full(len(task), np.inf)
    for sign in (1, -1):
        a, b, p = close_loop(linkage, around, sign)
        body = np.exp(1j * (linkage.body_angle + np.angle(b - a)))[:, None]
        turned = np.angle(body * np.exp(-1j * task.angles))
        miss = np.abs(p[:, None] - target) ** 2 + (task.angle_length * turned) ** 2
        least = np.fmin(least, np.fmin.reduce(miss, axis=0))
    return least


def perturbed(task: MotionTask, rng: np.random.Generator, share: float) -> MotionTask:
    noise = rng.normal(0, share, (len(task), 3))
    return MotionTask(task.positions + task.size * noise[:, :2], task.angles + noise[:, 2])


@given(seed=st.integers(0, 2**32), poses=st.integers(2, 8))
@CHECKED
def test_exact_poses_are_met_to_rounding(seed: int, poses: int) -> None:
    task, linkage = planted_motion(np.random.default_rng(seed), poses)
    found = nearest_to_poses(linkage, task)
    reach = linkage.lengths.max() + np.abs(task.positions).max()
    assert (found.assembly == linkage.assembly).all()
    assert found.position_error.max() <= 1e-12 * reach
    assert found.angle_error.max() <= 1e-11


@pytest.mark.study
@given(seed=st.integers(0, 2**32), share=st.sampled_from([1e-4, 1e-2, 0.05, 0.2, 1.0]))
@settings(CHECKED, max_examples=80)
def test_no_driver_angle_of_a_scan_comes_nearer(close_loop: Brute, seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    exact, linkage = planted_motion(rng, 5)
    task = perturbed(exact, rng, share)
    found = nearest_to_poses(linkage, task)
    miss = found.position_error**2 + (task.angle_length * found.angle_error) ** 2
    assert (miss <= misses_of_scan(close_loop, linkage, task) * (1 + 1e-6)).all()


@pytest.mark.slow
@pytest.mark.quick("crank-rocker")
@pytest.mark.parametrize("kind", [kind for kind in FOUR_BAR_CLASSES if kind is not GrashofClass.CHANGE_POINT])
@given(data=st.data())
@CHECKED
def test_no_driver_angle_of_a_scan_comes_nearer_for_any_class(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    centre, reach = (linkage.o2 + linkage.o4) / 2, float(linkage.lengths.sum())
    task = MotionTask(centre + reach * rng.normal(0, 0.5, (4, 2)), rng.uniform(-np.pi, np.pi, 4))
    found = nearest_to_poses(linkage, task)
    miss = found.position_error**2 + (task.angle_length * found.angle_error) ** 2
    assert np.isfinite(miss).all()
    assert (miss <= misses_of_scan(close_loop, linkage, task) * (1 + 1e-6)).all()


@given(seed=st.integers(0, 2**32))
@CHECKED
def test_errors_are_those_of_the_angles_found(close_loop: Brute, seed: int) -> None:
    rng = np.random.default_rng(seed)
    exact, linkage = planted_motion(rng, 4)
    task = perturbed(exact, rng, 0.02)
    found = nearest_to_poses(linkage, task)
    for index in range(len(task)):
        a, b, p = close_loop(linkage, found.theta2[index], found.assembly[index])
        gap = abs(p - complex(*task.positions[index]))
        turned = np.exp(1j * (np.angle(b - a) + linkage.body_angle - task.angles[index]))
        assert found.position_error[index] == pytest.approx(gap, rel=1e-9)
        assert found.angle_error[index] == pytest.approx(abs(np.angle(turned)), rel=1e-9, abs=1e-12)


def test_poses_out_of_reach_of_the_driver_are_met_at_a_dead_position(close_loop: Brute) -> None:
    a, b, p = close_loop(ABOUT_GROUND, np.arccos(-0.3125), 1)
    assert np.isfinite(b)
    beyond = 1.1 * (b - a) / abs(b - a)
    positions = [[1.0, 1.0], [(p + beyond * 1e-3).real, (p + beyond * 1e-3).imag]]
    task = MotionTask(positions, [0.0, float(np.angle(b - a))], angle_length=1.0)
    found = nearest_to_poses(ABOUT_GROUND, task)
    assert np.isfinite(found.position_error).all()
    assert found.position_error[1] < 2e-3


def test_a_linkage_that_cannot_close_meets_nothing() -> None:
    apart = FourBar(o2=(0, 0), o4=(9, 0), r2=1, r3=2, r4=2)
    found = nearest_to_poses(apart, MotionTask([[0, 0], [1, 0]], [0.0, 0.2]))
    assert np.isinf(found.position_error).all()


def way_deg(linkage: FourBar, degrees: list[float], ordered: bool = True) -> tuple[list[float], int, bool]:
    """Start and end in degrees, sense, and whether in order."""
    way = task_motion(linkage, np.radians(degrees), ordered)
    assert np.exp(1j * way.theta2) == pytest.approx(np.exp(1j * np.radians(degrees)), abs=1e-12)
    return np.degrees([way.start, way.end]).round(9).tolist(), way.direction, way.in_order


@pytest.mark.parametrize(
    ("degrees", "span", "direction", "in_order"),
    [
        ([10, 100, 200], 190, 1, True),
        ([200, 100, 10], 190, -1, True),
        ([300, 350, 20, 40], 100, 1, True),
        ([-170, 170, 90], 100, -1, True),
        ([0, 50], 50, 1, True),
        ([50, 0], 50, -1, True),
        ([0, 190], 170, -1, True),
        ([0, 90, 180, 270, 0], 360, 1, True),
        ([0, -90, -180, -270, 0], 360, -1, True),
        ([0, 120, 120, 240], 240, 1, True),
        ([0, 100, 50], 310, -1, True),
        ([0, 90, 45, 200], 560, 1, False),
        ([0, 10, 350, 340], 380, -1, False),
        ([0, 90, 180, 270, 10], 370, 1, False),
    ],
)
def test_way_of_a_crank_that_meets_targets_in_sequence(
    degrees: list[float], span: float, direction: int, in_order: bool
) -> None:
    (start, end), found_direction, found_order = way_deg(CRANK_ROCKER, degrees)
    assert (found_order, start) == (in_order, pytest.approx(degrees[0]))
    assert abs(end - start) == pytest.approx(span) if in_order else abs(end - start) > 360
    if in_order:
        assert found_direction == direction
        assert np.sign(end - start) == direction


def test_angles_along_the_way_are_counted_on() -> None:
    way = task_motion(CRANK_ROCKER, np.radians([300.0, 350.0, 20.0, 40.0]), True)
    assert np.degrees(way.theta2) == pytest.approx([300, 350, 380, 400])
    way = task_motion(CRANK_ROCKER, np.radians([20.0, 350.0, 300.0]), True)
    assert np.degrees(way.theta2) == pytest.approx([20, -10, -60])


def test_rounding_does_not_add_a_turn() -> None:
    tiny = 1e-11
    for degrees in ([0, 100, 100 - tiny, 200], [0, 90, 180, 270, -tiny], [0, 90, 180, 270, tiny]):
        (start, end), direction, in_order = way_deg(CRANK_ROCKER, degrees)
        assert in_order
        assert direction == 1
        assert end - start == pytest.approx(360 if len(degrees) == 5 else 200)


@pytest.mark.parametrize(
    ("degrees", "span"),
    [
        ([0, 100, 50], 100),
        ([350, 20, 10], 30),
        ([0, 190], 170),
        ([0, 120, 240], 240),
        ([10, 200, 350, 0], 170),
    ],
)
def test_without_order_the_shortest_arc_is_used(degrees: list[float], span: float) -> None:
    way = task_motion(CRANK_ROCKER, np.radians(degrees), False)
    assert np.degrees(way.end - way.start) == pytest.approx(span)
    assert (way.theta2 >= way.start - 1e-9).all()
    assert (way.theta2 <= way.end + 1e-9).all()
    assert np.exp(1j * way.theta2) == pytest.approx(np.exp(1j * np.radians(degrees)), abs=1e-12)


@pytest.mark.parametrize(
    ("linkage", "degrees", "expected"),
    [
        (ABOUT_GROUND, [-100, 0, 100], ([-100, 100], 1, True)),
        (ABOUT_GROUND, [100, 0, 300, 260], ([100, -100], -1, True)),
        (ABOUT_BACK, [170, -170, -150], ([170, 210], 1, True)),
        (ABOUT_BACK, [-150, 170], ([210, 170], -1, True)),
        (TWO_RANGES, [-60, -70], ([-60, -70], -1, True)),
    ],
)
def test_way_of_a_rocker_stays_inside_its_range(
    linkage: FourBar, degrees: list[float], expected: tuple[list[float], int, bool]
) -> None:
    span, direction, in_order = way_deg(linkage, degrees)
    assert span == pytest.approx(expected[0])
    assert (direction, in_order) == expected[1:]


@pytest.mark.parametrize("degrees", [[0.0, 60.0, 30.0], [0.0, 60.0, 0.0], [-20.0, 80.0, -60.0]])
def test_a_rocker_that_turns_back_is_out_of_order(degrees: list[float]) -> None:
    way = task_motion(ABOUT_GROUND, np.radians(degrees), True)
    assert not way.in_order
    assert np.degrees([way.start, way.end]) == pytest.approx([min(degrees), max(degrees)])
    assert np.degrees(way.theta2) == pytest.approx(degrees)


def test_at_a_change_point_the_driver_takes_the_shorter_way() -> None:
    assert way_deg(PARALLELOGRAM_LIKE, [170, 180, -170]) == ([170.0, 190.0], 1, True)
    assert way_deg(PARALLELOGRAM_LIKE, [-170, -180, 170]) == ([-170.0, -190.0], -1, True)
    assert way_deg(PARALLELOGRAM_LIKE, [-20, 30]) == ([-20.0, 30.0], 1, True)
