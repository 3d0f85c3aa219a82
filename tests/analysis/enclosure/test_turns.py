"""Enclosures over the driver's range compared with dense samples of the closed forms, for every kind."""

from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from random_linkages import six_bars

from grashof.analysis import transmission_angle
from grashof.analysis.enclosure.closure import Pieces, closure_of, least_transmission, places
from grashof.analysis.enclosure.interval import Centred, Interval, crank
from grashof.analysis.judge.planted import (
    random_full_crank,
    random_inverted_slider_crank,
    random_slider_crank,
)
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.mechanism.transmission import quality, worst_transmission
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, ProblemError, SliderCrank

MAKERS = (random_full_crank, random_slider_crank, random_inverted_slider_crank)
SHARP = np.radians(1e-6)
# Almost at a change point, or exactly at one, in the turn of the driver.
NEARLY = (
    FourBar((0, 0), (4, 0), 1, 3, 2.0000001),
    FourBar((0, 0), (4, 0), 1, 3 + 1e-9, 2 + 1e-9),
    FourBar((0, 0), (4, 0), 1, 4, 1 + 1e-7),
    SliderCrank((1, 2), 1, 1.5000001, 0.5, 0.3),
    InvertedSliderCrank((1, 2), (1, 4), 1, 1 - 1e-7),
)


@pytest.fixture(params=MAKERS, ids=lambda make: make.__name__)
def batch(request: Any) -> Linkage:
    rng = np.random.default_rng(29)
    return Linkage.stacked([request.param(rng) for _ in range(6)])


def test_the_enclosure_holds_the_least_angle_and_is_sharp(batch: Linkage) -> None:
    rng = np.random.default_rng(1)
    start = rng.uniform(-4, 4, 6)
    end = start + rng.uniform(-6.3, 6.3, 6)
    least = least_transmission(batch, start, end)
    dense = quality(transmission_angle(batch[:, None], np.linspace(start, end, 20_000, axis=1))).min(axis=1)
    assert (least.lo <= dense).all()
    assert (least.hi - least.lo <= SHARP).all()
    exact = worst_transmission(batch, start, end)
    assert (least.lo <= exact).all()
    assert (exact <= least.hi + 1e-14).all()


@pytest.mark.parametrize("linkage", NEARLY)
def test_the_enclosure_holds_beside_change_points(linkage: Linkage) -> None:
    one, turn = Linkage.stacked([linkage]), np.array([0.3])
    least = least_transmission(one, turn, turn + 2 * np.pi)
    around = linkage.theta1 + np.linspace(-np.pi, np.pi, 20_001)
    dense = quality(transmission_angle(linkage, around)).min()
    assert least.lo[0] <= dense + 1e-12
    assert least.hi[0] - least.lo[0] < 1e-7  # rounding of near, and a root of it
    assert least.pieces[0] < 2000


def test_closure_alone_takes_any_positive_bound(batch: Linkage) -> None:
    start = np.zeros(6)
    least = least_transmission(batch, start, start + 6.3, np.full(6, np.nan))
    sharp = least_transmission(batch, start, start + 6.3)
    assert (least.lo > 0).all()
    assert (least.lo <= sharp.hi).all()
    assert (least.pieces <= sharp.pieces).all()


def test_an_angle_that_hardly_varies_takes_few_intervals() -> None:
    flat = [
        InvertedSliderCrank(o2=(0, 0), o4=(1, 0), r2=r2, offset=offset)
        for r2, offset in ((0.5, 0.0), (0.5, 1e-9), (0.9, -1e-10), (2.0, 0.0))
    ]
    found = least_transmission(Linkage.stacked(flat), np.zeros(4), np.full(4, 6.3), np.zeros(4))
    assert np.all(found.pieces < 20_000)
    assert np.all(found.lo > np.radians(89.5))
    assert np.all(found.lo <= found.hi)
    assert np.all(found.hi <= np.pi / 2)


def test_a_range_that_opens_between_its_ends_has_the_bound_0() -> None:
    """The loop is open over about 1e-5 rad, far less than the spacing of the samples."""
    linkage = FourBar((0, 0), (4, 0), 1, 3, 2 - 1e-10)  # stretched: r1 + r2 = r3 + r4 + 1e-10
    least = least_transmission(Linkage.stacked([linkage]), np.array([3.0]), np.array([3.3]))
    assert least.lo[0] == 0
    assert least.hi[0] < 1e-4
    closes = least_transmission(Linkage.stacked([linkage]), np.array([2.0]), np.array([3.1]))
    assert closes.lo[0] > 0


def test_pieces_leave_no_gap_in_exact_arithmetic() -> None:
    """About 0, too, where a middle has lost the digits of the ends."""
    rng = np.random.default_rng(5)
    start = rng.uniform(-7, 7, 10)
    end = start + rng.uniform(-6.3, 6.3, 10)
    pieces = Pieces.covering(start, end)
    pieces = pieces.halves(np.arange(len(pieces.row)))
    for row in range(10):
        own = pieces.row == row
        middle, half = pieces.middle[own], pieces.half[own]
        ends = sorted(
            (Fraction(m) - Fraction(h), Fraction(m) + Fraction(h)) for m, h in zip(middle, half, strict=True)
        )
        assert ends[0][0] <= min(start[row], end[row])
        assert ends[-1][1] >= max(start[row], end[row])
        assert all(one[1] >= other[0] for one, other in pairwise(ends))


def test_places_hold_dense_samples_of_points(batch: Linkage) -> None:
    start = np.linspace(-3, 3, 6)
    pieces = Pieces.covering(start, start + 6.2, widest=0.05)
    some, angle = batch[pieces.row], pieces.middle + pieces.half * np.linspace(-1, 1, 15)[:, None]
    found = places(some, some.assembly, crank(pieces.middle, pieces.half))
    state = solve_kinematics(some, angle, 1.0, 0.0)
    for name in ("a", "b", "p"):
        for axis in range(2):
            centred: Centred = getattr(found, name).x if axis == 0 else getattr(found, name).y
            point = getattr(state, name)
            assert_within(point.position[..., axis], centred.over)
            assert_within(point.velocity[..., axis], centred.slope)
    assert_within(np.cos(state.theta3), found.direction3.x.over)
    assert_within(np.sin(state.theta3), found.direction3.y.over)


def test_two_loops_are_refused_in_one_line() -> None:
    two = six_bars("pins 3 1", 2, np.random.default_rng(1))
    with pytest.raises(
        ProblemError, match=r"a stephenson-3 has two loops; it cannot be proven by intervals$"
    ):
        least_transmission(two, np.zeros(2), np.ones(2))


def assert_within(values: np.ndarray, held: Interval, rounding: float = 1e-12) -> None:
    """Samples are rounded, too."""
    assert (values >= held.lo - rounding * (1 + np.abs(values))).all()
    assert (values <= held.hi + rounding * (1 + np.abs(values))).all()


def test_slopes_are_as_narrow_as_the_derivative(batch: Linkage) -> None:
    """At a single angle the enclosure of the derivative is the derivative, no wider than necessary."""
    angle = np.linspace(0.2, 5.9, 6)
    found = places(batch, batch.assembly, crank(angle, np.zeros(6)))
    state = solve_kinematics(batch, angle, 1.0, 0.0)
    for name in ("a", "b", "p"):
        velocity = getattr(state, name).velocity
        for axis, part in enumerate((getattr(found, name).x, getattr(found, name).y)):
            np.testing.assert_allclose(part.slope.lo, velocity[:, axis], rtol=1e-8, atol=1e-9)
            np.testing.assert_allclose(part.slope.hi, velocity[:, axis], rtol=1e-8, atol=1e-9)
            np.testing.assert_allclose(part.mid.lo, getattr(state, name).position[:, axis], atol=1e-9)


def test_the_excess_falls_with_the_square_of_the_width(batch: Linkage) -> None:
    """Mean-value form: the excess width falls with the square of the width."""
    angle = np.linspace(0.2, 5.9, 6)
    excess = []
    for half in (2e-3, 1e-3):
        margin = closure_of(batch).margins(batch, crank(angle, np.full(6, half))).near
        true = np.stack(
            [
                closure_of(batch).margins(batch, crank(angle + d, np.zeros(6))).near.mid.lo
                for d in np.linspace(-half, half, 9)
            ]
        )
        excess.append((margin.over.hi - margin.over.lo) - np.ptp(true, axis=0))
    assert np.median(excess[0] / excess[1]) > 3


@pytest.mark.parametrize(
    "work",
    [
        lambda x, y: x + y, lambda x, y: x - y, lambda x, y: x * y, lambda x, y: x / y,
        lambda x, y: -x * 3.0, lambda x, y: y.root(),
    ],
)  # fmt: skip
def test_operations_hold_derivatives(work: Callable[..., Any]) -> None:
    """Each rule compared with central differences of its middles."""

    def at(middle: np.ndarray, half: np.ndarray) -> Centred:
        e = crank(middle, half)
        return work(e.x, e.y * e.y + 2.0)

    angle, step = np.linspace(-3, 3, 31), 1e-6
    zero = np.zeros(31)
    ahead, behind = at(angle + step, zero).mid, at(angle - step, zero).mid
    slope = (ahead.lo - behind.lo) / (2 * step)
    exact = at(angle, zero).slope
    np.testing.assert_allclose(exact.lo, slope, atol=1e-8)
    np.testing.assert_allclose(exact.hi, slope, atol=1e-8)
    assert_within(slope, at(angle, zero + 0.01).slope, 1e-8)


def test_intervals_hold_exact_quotients_and_undefined_values() -> None:
    one, zero = np.array([1.0]), np.array([0.0])
    beyond = Interval.of(one) / Interval(-one, one)
    assert beyond.lo[0] == -np.inf
    assert beyond.hi[0] == np.inf
    undefined = Interval(zero, zero) * beyond
    assert undefined.lo[0] <= 0 <= undefined.hi[0]
