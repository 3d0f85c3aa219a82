"""Mobility: formulas compared with closing the loop, circuits with the judge, which follows them."""

import math
from collections import Counter

import numpy as np
import pytest
from body_coordinates import circuit, margins, start
from body_plans import plan_of
from drawn_linkages import SMOOTH, SWINGING, close_loop, of_each_class
from hypothesis import strategies as st
from random_linkages import any_linkages

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
from grashof.analysis.mechanism.mobility import range_index
from grashof.analysis.mechanism.transmission import quality, transmission_angle
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank

TURN = 2 * math.pi
ANGLES = st.lists(st.floats(-3 * TURN, 3 * TURN), min_size=1, max_size=20)


@of_each_class(*SMOOTH)
def test_rotatability_decides_through_which_side_the_driver_swings(linkage: FourBar) -> None:
    _, b, _ = close_loop(linkage, linkage.theta1 + np.array([np.pi, 0.0]), 1)
    np.testing.assert_array_equal(rotatability(linkage) > 0, np.isfinite(b))


@of_each_class(GrashofClass.CHANGE_POINT, examples=8)
def test_change_points_are_named_and_do_not_count_as_turning(linkage: FourBar) -> None:
    assert grashof_class(linkage) is GrashofClass.CHANGE_POINT
    assert np.abs(rotatability(linkage)).min() < 1e-12
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


def test_triple_rockers_are_named_by_their_longest_link() -> None:
    assert triple_rocker_kind(FourBar((0, 0), (4, 0), 1, 4, 3)) == ""
    for longest in range(4):
        r1, *others = np.where(np.arange(4) == longest, 5.0, 2.0)
        linkage = FourBar((0, 0), (r1, 0), *others)
        assert grashof_class(linkage) is GrashofClass.NON_GRASHOF
        assert triple_rocker_kind(linkage) == f"RRR{longest + 1}"


@of_each_class(*SMOOTH, first=st.floats(-TURN, TURN))
def test_driver_ranges_hold_exactly_the_angles_that_close(
    linkage: FourBar, kind: GrashofClass, first: float
) -> None:
    ranges = driver_ranges(linkage)
    ranges = ranges[np.isfinite(ranges).all(axis=1)]
    assert len(ranges) == (2 if kind in (GrashofClass.DOUBLE_ROCKER, GrashofClass.ROCKER_CRANK) else 1)
    around = first + np.linspace(0, TURN, 3601)
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


@of_each_class(*SMOOTH, angles=ANGLES.map(np.array))
def test_range_index_counts_angles_inside_their_range(linkage: FourBar, angles: np.ndarray) -> None:
    index, inside = range_index(linkage, angles)
    known = index >= 0
    np.testing.assert_array_equal(known, np.isfinite(close_loop(linkage, angles, 1)[1]))
    assert np.isnan(inside[~known]).all()
    low, high = driver_ranges(linkage)[index[known]].T
    assert ((low - 1e-9 <= inside[known]) & (inside[known] <= high + 1e-9)).all()
    np.testing.assert_allclose(np.exp(1j * inside[known]), np.exp(1j * angles[known]), atol=1e-12)


def test_ranges_of_a_linkage_that_cannot_be_assembled() -> None:
    for o4, lengths in (((9, 0), (2, 3, 3)), ((1, 0), (2, 9, 3))):
        linkage = FourBar((0, 0), o4, *lengths)
        assert np.isnan(driver_ranges(linkage)).all()
        assert circuit_index(linkage, [0.0, 1.0], 1).tolist() == [-1, -1]
        assert branch_index(linkage, [0.0, 1.0], 1).tolist() == [-1, -1]
        assert not full_rotation(linkage)


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
@pytest.mark.parametrize("least", [0.0, 5.0, 50.0])
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


@pytest.mark.parametrize("kind", [FourBar, SliderCrank, InvertedSliderCrank])
def test_circuits_and_branches_are_those_that_the_judge_passes(kind: type[Linkage]) -> None:
    """It follows each circuit without a driver, through dead positions, and meets no other branch."""
    rng = np.random.default_rng(5)
    some, theta = any_linkages(kind, 60, rng), rng.uniform(-np.pi, np.pi, 60)
    plan = plan_of(some)
    q = start(plan, theta, guesses=40)
    found = np.flatnonzero(np.isfinite(q).all(axis=-1))
    passed, back = circuit(plan.taken(found), q[found])
    signed = margins(plan.taken(found), passed)[..., 0]
    assert back.mean() > 0.9
    judged: dict[tuple[int, int], int] = Counter()
    for k, linkage in enumerate(some[n] for n in found):
        clear = np.isfinite(passed[:, k, 0]) & (np.abs(signed[:, k]) > 1e-4)
        place = passed[clear, k, 2], np.sign(signed[clear, k])
        (own,) = set(circuit_index(linkage, *place).tolist())
        ranges = driver_ranges(linkage)
        each = np.meshgrid(ranges[np.isfinite(ranges[:, 0])].mean(axis=-1), [1, -1])
        circuits, branches = circuit_index(linkage, *each), branch_index(linkage, *each)
        if back[k] and np.nanmin(np.ptp(ranges, axis=-1)) > 1e-2:
            assert set(branches[circuits == own].tolist()) == set(branch_index(linkage, *place).tolist())
            judged[len(np.unique(circuits)), len(np.unique(branches))] += 1
    # One or two circuits, of two branches each where the driver does not turn fully.
    assert set(judged) == ({(1, 2), (2, 2)} if kind is InvertedSliderCrank else {(1, 2), (2, 2), (2, 4)})
