"""Mobility: every formula against turning the links and marching along the closed loop."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import (
    GrashofClass,
    branch_index,
    circuit_index,
    driver_ranges,
    full_rotation,
    grashof_class,
    rotatability,
    triple_rocker_kind,
)
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.analysis.mechanism.mobility import range_index
from grashof.analysis.mechanism.transmission import quality, transmission_angle
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank

CHECKED = settings(max_examples=25)
MARCHED = settings(CHECKED, max_examples=8)
TURN = 2 * math.pi
STEP = 0.01  # rad along the curve of closed loops
Brute = Callable[..., tuple[npt.NDArray[np.complex128], ...]]
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
Angles = tuple[float, float, float]
SMOOTH = [kind for kind in FOUR_BAR_CLASSES if kind is not GrashofClass.CHANGE_POINT]
SWINGING = [GrashofClass.DOUBLE_ROCKER, GrashofClass.ROCKER_CRANK, GrashofClass.NON_GRASHOF]
CIRCUITS = {kind: 1 if kind is GrashofClass.NON_GRASHOF else 2 for kind in SMOOTH}
BRANCHES = {
    GrashofClass.CRANK_ROCKER: 2,
    GrashofClass.DOUBLE_CRANK: 2,
    GrashofClass.DOUBLE_ROCKER: 4,
    GrashofClass.ROCKER_CRANK: 4,
    GrashofClass.NON_GRASHOF: 2,
}
TURNING_LINKS = {
    GrashofClass.CRANK_ROCKER: {2},
    GrashofClass.DOUBLE_CRANK: {2, 3, 4},
    GrashofClass.DOUBLE_ROCKER: {3},
    GrashofClass.ROCKER_CRANK: {4},
    GrashofClass.NON_GRASHOF: set(),
}


def links_that_turn(linkage: FourBar) -> set[int]:
    """The links that can take every direction to the ground: the other two always close the triangle."""
    ground, *moving = (float(length) for length in linkage.lengths)
    around = np.exp(1j * np.linspace(-np.pi, np.pi, 2881))
    turning = set()
    for number, link in enumerate(moving):
        gap = np.abs(ground - link * around)
        one, other = (length for index, length in enumerate(moving) if index != number)
        if ((abs(one - other) < gap) & (gap < one + other)).all():
            turning.add(number + 2)
    return turning


@pytest.mark.parametrize("kind", SMOOTH)
@given(data=st.data())
@CHECKED
def test_class_and_rotatability_agree_with_turning_the_links(
    four_bars: Drawer, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    turning = links_that_turn(linkage)
    assert grashof_class(linkage) is kind
    assert turning == TURNING_LINKS[kind]
    assert full_rotation(linkage) == (2 in turning)
    assert bool((rotatability(linkage) > 0).all()) == (2 in turning)


@pytest.mark.parametrize("kind", SMOOTH)
@given(data=st.data())
@CHECKED
def test_rotatability_tells_through_which_side_the_driver_swings(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    _, b, _ = close_loop(linkage, linkage.theta1 + np.array([np.pi, 0.0]), 1)
    np.testing.assert_array_equal(rotatability(linkage) > 0, np.isfinite(b))
    r1, r2, r3, r4 = linkage.lengths
    shares = [(r3 + r4 - r1 - r2), abs(r1 - r2) - abs(r3 - r4)] / linkage.lengths.sum()
    np.testing.assert_allclose(rotatability(linkage), shares, rtol=1e-12)


@given(data=st.data())
@CHECKED
def test_change_points_are_named_and_do_not_count_as_turning(four_bars: Drawer, data: st.DataObject) -> None:
    linkage = data.draw(four_bars(GrashofClass.CHANGE_POINT))
    assert grashof_class(linkage) is GrashofClass.CHANGE_POINT
    least = np.abs(rotatability(linkage)).min()
    assert least < 1e-12
    shorter = np.array([0.0, 1e-6]) * float(linkage.r3)
    slightly_off = FourBar(linkage.o2, linkage.o4, linkage.r2, linkage.r3 + shorter, linkage.r4)
    assert grashof_class(slightly_off[1]) is not GrashofClass.CHANGE_POINT
    assert grashof_class(slightly_off[1], tolerance=1e-5) is GrashofClass.CHANGE_POINT


@pytest.mark.parametrize(("o4", "r2", "r3", "r4"), [((2, 0), 1, 3, 2), ((3, 0), 1, 2, 2), ((2, 0), 1, 2, 1)])
def test_exact_change_points_have_one_range_and_no_full_rotation(
    o4: tuple[float, float], r2: float, r3: float, r4: float
) -> None:
    linkage = FourBar(o2=(0, 0), o4=o4, r2=r2, r3=r3, r4=r4)
    assert grashof_class(linkage) is GrashofClass.CHANGE_POINT
    assert not full_rotation(linkage)
    assert driver_ranges(linkage)[0].tolist() == [-np.pi, np.pi]
    assert circuit_index(linkage, [0.5, -0.5, 2.5], [1, 1, -1]).tolist() == [0, 0, 1]


def test_figures_of_the_reference_file(golden_linkages: dict[str, FourBar]) -> None:
    for linkage in golden_linkages.values():
        assert grashof_class(linkage) is GrashofClass.CRANK_ROCKER
        assert full_rotation(linkage)
        assert triple_rocker_kind(linkage) == ""


def test_triple_rockers_are_named_by_their_longest_link() -> None:
    for longest in range(4):
        r1, r2, r3, r4 = np.where(np.arange(4) == longest, 5.0, 2.0)
        linkage = FourBar(o2=(0, 0), o4=(r1, 0), r2=r2, r3=r3, r4=r4)
        assert grashof_class(linkage) is GrashofClass.NON_GRASHOF
        assert triple_rocker_kind(linkage) == f"RRR{longest + 1}"


@pytest.mark.parametrize("kind", SMOOTH)
@given(data=st.data())
@CHECKED
def test_driver_ranges_hold_exactly_the_angles_that_close(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    ranges = driver_ranges(linkage)
    ranges = ranges[np.isfinite(ranges).all(axis=1)]
    assert len(ranges) == (2 if kind in (GrashofClass.DOUBLE_ROCKER, GrashofClass.ROCKER_CRANK) else 1)
    around = data.draw(st.floats(-TURN, TURN)) + np.linspace(0, TURN, 3601)
    _, b, _ = close_loop(linkage, around, 1)
    assert (np.abs(ranges.mean(axis=1)) <= np.pi + 1e-12).all()
    low, high = ranges.T
    inside = ((around[:, None] - low) % TURN <= high - low).any(axis=1)
    if kind in SWINGING:
        near_end = (np.abs((around[:, None] - ranges.ravel() + np.pi) % TURN - np.pi) < 1e-9).any(axis=1)
        np.testing.assert_array_equal(inside[~near_end], np.isfinite(b[~near_end]))
        inward = np.array([1e-7, -1e-7])
        assert np.isfinite(close_loop(linkage, ranges + inward, 1)[1]).all()
        assert np.isnan(close_loop(linkage, ranges - inward, 1)[1]).all()
    else:
        assert np.isfinite(b).all()
        assert high - low == pytest.approx(TURN, rel=1e-15)


@pytest.mark.parametrize("kind", SMOOTH)
@given(data=st.data())
@CHECKED
def test_range_index_counts_angles_inside_their_range(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    angles = np.array(data.draw(st.lists(st.floats(-3 * TURN, 3 * TURN), min_size=1, max_size=20)))
    index, inside = range_index(linkage, angles)
    np.testing.assert_array_equal(index >= 0, np.isfinite(close_loop(linkage, angles, 1)[1]))
    assert np.isnan(inside[index < 0]).all()
    for angle, number, counted in zip(angles, index, inside, strict=True):
        if number >= 0:
            low, high = driver_ranges(linkage)[number]
            assert low - 1e-9 <= counted <= high + 1e-9
            assert np.exp(1j * counted) == pytest.approx(np.exp(1j * angle), abs=1e-12)


def test_ranges_of_a_linkage_that_cannot_be_assembled() -> None:
    for o4, lengths in (((9, 0), (2, 3, 3)), ((1, 0), (2, 9, 3))):
        linkage = FourBar((0, 0), o4, *lengths)
        assert np.isnan(driver_ranges(linkage)).all()
        assert circuit_index(linkage, [0.0, 1.0], 1).tolist() == [-1, -1]
        assert branch_index(linkage, [0.0, 1.0], 1).tolist() == [-1, -1]
        assert not full_rotation(linkage)


def test_batches_give_what_single_linkages_give() -> None:
    rng = np.random.default_rng(2)
    batch = FourBar((0, 0), rng.normal(size=(40, 2)), *rng.uniform(0.2, 2, (3, 40)))
    ranges, shares, turns = driver_ranges(batch), rotatability(batch), full_rotation(batch)
    assert ranges.shape == (40, 2, 2)
    assert 0 < turns.sum() < 40
    for index in range(40):
        np.testing.assert_array_equal(ranges[index], driver_ranges(batch[index]))
        np.testing.assert_array_equal(shares[index], rotatability(batch[index]))
        assert turns[index] == full_rotation(batch[index])


def march(lengths: npt.NDArray[np.float64], start: Angles) -> npt.NDArray[np.float64]:
    """The closed curve of (theta2, theta3, theta4) through `start`: tangent steps, put back by Newton."""
    r1, r2, r3, r4 = (float(length) for length in lengths)
    track, angles = [start], start
    while len(track) < 20000:
        along = _tangent(r2, r3, r4, angles)
        size = math.hypot(*along)
        angles = _closed(r1, r2, r3, r4, [x + STEP * d / size for x, d in zip(angles, along, strict=True)])
        if len(track) > 10 and _apart(angles, start) < 0.75 * STEP:
            return np.array(track)
        track.append(angles)
    raise AssertionError("the march did not come back to its start")


def _tangent(r2: float, r3: float, r4: float, angles: Angles) -> Angles:
    t2, t3, t4 = angles
    return r3 * r4 * math.sin(t3 - t4), r2 * r4 * math.sin(t4 - t2), r2 * r3 * math.sin(t3 - t2)


def _closed(r1: float, r2: float, r3: float, r4: float, angles: list[float]) -> Angles:
    """Least-norm Newton steps on r2 e^(i theta2) + r3 e^(i theta3) - r4 e^(i theta4) - r1 = 0."""
    sizes = (r2, r3, -r4)
    for _ in range(3):
        real = [-size * math.sin(angle) for size, angle in zip(sizes, angles, strict=True)]
        imag = [size * math.cos(angle) for size, angle in zip(sizes, angles, strict=True)]
        gap_real, gap_imag = sum(imag) - r1, -sum(real)
        rr, ri, ii = (
            sum(x * y for x, y in zip(one, other, strict=True))
            for one, other in ((real, real), (real, imag), (imag, imag))
        )
        determinant = rr * ii - ri * ri
        one, other = (
            (ii * gap_real - ri * gap_imag) / determinant,
            (rr * gap_imag - ri * gap_real) / determinant,
        )
        angles = [x - dr * one - di * other for x, dr, di in zip(angles, real, imag, strict=True)]
    t2, t3, t4 = angles
    return t2, t3, t4


def _apart(one: Angles, other: Angles) -> float:
    return math.hypot(*((x - y + math.pi) % TURN - math.pi for x, y in zip(one, other, strict=True)))


def test_marching_holds_the_loop_closed_and_goes_all_the_way_around() -> None:
    lengths = np.array([4.0, 1.0, 3.5, 2.5])
    track = march(lengths, _closed(*lengths, list(_closed(*lengths, [0.3, 0.9, 1.6]))))
    loop = lengths[1:] * np.exp(1j * track) @ np.array([1, 1, -1]) - lengths[0]
    assert np.abs(loop).max() < 1e-9
    assert np.ptp(track[:, 0]) > TURN - 2 * STEP
    steps = np.linalg.norm(np.diff(track, axis=0), axis=1)
    assert np.abs(steps - STEP).max() < 1e-3 * STEP


@pytest.mark.quick("non-Grashof")
@pytest.mark.parametrize("kind", SMOOTH)
@given(data=st.data())
@MARCHED
def test_circuits_and_branches_agree_with_marching(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    theta2, signs, states = _positions(linkage, close_loop)
    circuits, branches = circuit_index(linkage, theta2, signs), branch_index(linkage, theta2, signs)
    marched_circuits = np.full(len(states), -1)
    marched_branches = np.full(len(states), -1)
    number = 0
    while (marched_circuits < 0).any():
        start = int(np.argmax(marched_circuits < 0))
        track = march(linkage.lengths, tuple(states[start]))
        segment = _segments(np.sin(track[:, 2] - track[:, 1]) > 0)
        wrapped = (states[:, None] - track + np.pi) % TURN - np.pi
        away = np.linalg.norm(wrapped, axis=-1)
        reached = away.min(axis=1) < 0.7 * STEP
        assert reached[start]
        assert (marched_circuits[reached] < 0).all()
        marched_circuits[reached] = number
        marched_branches[reached] = 100 * number + segment[away.argmin(axis=1)[reached]]
        number += 1
    assert number == CIRCUITS[kind]
    assert len(set(marched_branches)) == BRANCHES[kind]
    for formula, marched in ((circuits, marched_circuits), (branches, marched_branches)):
        together = set(zip(formula.tolist(), marched.tolist(), strict=True))
        assert len(together) == len(set(formula)) == len(set(marched))


def _positions(
    linkage: FourBar, close_loop: Brute
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64], npt.NDArray[np.float64]]:
    """Positions away from dead ones: theta2, assembly, and the angles of links 2 to 4 to the ground."""
    around = np.linspace(-np.pi, np.pi, 37) + 0.0123
    found = []
    for sign in (1, -1):
        a, b, _ = close_loop(linkage, around, sign)
        theta3, theta4 = np.angle(b - a), np.angle(b - complex(*linkage.o4))
        clear = np.abs(np.nan_to_num(np.sin(theta4 - theta3))) > 0.05
        rows = np.stack([around, np.full(37, float(sign)), around, theta3, theta4], axis=1)[clear]
        rows[:, 2:] -= linkage.theta1
        found.append(rows)
    rows = np.concatenate(found)
    return rows[:, 0], rows[:, 1].astype(np.int64), rows[:, 2:]


def _segments(positive: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
    """Number of the stretch of equal sign that each point of a closed track lies in."""
    changes = np.concatenate([[0], np.cumsum([one != other for one, other in pairwise(positive)])])
    return np.where(changes == changes[-1], 0, changes) if positive[0] == positive[-1] else changes


@pytest.mark.parametrize(
    "linkage",
    [
        FourBar((0, 0), (4, 0), 1, 3, 4),
        FourBar((0, 0), (3, 1), 2, 3, 2.5, assembly=-1),
        FourBar((0, 0), (4, 0), 2, 2, 3),
        FourBar((0, 0), (1, 0.2), 2, 2.1, 1.9),
        SliderCrank((0, 0), slide_angle=0.4, offset=0.3, r2=1, r3=2),
        SliderCrank((0, 0), slide_angle=-1.0, offset=-0.8, r2=1, r3=1.1),
        InvertedSliderCrank((0, 0), (2, 1), r2=1, offset=0.6),
        InvertedSliderCrank((0, 0), (1, 0.5), r2=1.2, offset=-0.9),
    ],
)
@pytest.mark.parametrize("least", [0.0, 5.0, 25.0, 50.0, 80.0])
def test_ranges_in_which_a_transmission_angle_is_kept(linkage: Linkage, least: float) -> None:
    limit = math.radians(least)
    theta2 = np.linspace(-math.pi, math.pi, 3001)
    kept = quality(transmission_angle(linkage, theta2)) >= max(limit, 1e-12)
    inside = np.zeros(len(theta2), dtype=bool)
    for low, high in driver_ranges(linkage, limit).tolist():
        if not math.isnan(low):
            inside |= (theta2 - low) % TURN <= high - low
            assert high - low >= TURN or all(
                abs(float(quality(transmission_angle(linkage, end))) - limit) < 1e-6 for end in (low, high)
            )
    np.testing.assert_array_equal(inside, kept)
