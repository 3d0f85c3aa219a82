"""Bounds of families: against published figures, cranks that are turned in steps, and planted linkages."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from known_designs import SLIDES
from numpy.typing import NDArray

from grashof.analysis.mechanism.mobility import rotatability
from grashof.analysis.mechanism.stroke import output_stroke
from grashof.analysis.mechanism.transmission import worst_transmission_cycle
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank
from grashof.synth.proof.strokes.cover import Cover, covered
from grashof.synth.proof.strokes.members import (
    Family,
    StrokeLimits,
    crank_rockers,
    crank_shapers,
    slider_cranks,
)
from grashof.synth.proof.strokes.ranges import HALF_TURN, Range, hypotenuse
from grashof.synth.theory.limit_positions import best_transmission

Floats = NDArray[np.float64]
GAP, FLOOR = float(np.radians(0.01)), float(np.radians(0.001))
ANY = dict.fromkeys(("r1", "r2", "r3", "r4"), (0.0, np.inf))
TWENTY = StrokeLimits(ANY, ratio=20.0, margin=0.0)


def rockers(swing: float, ratio: float, limits: StrokeLimits = TWENTY) -> list[Family]:
    return [crank_rockers(swing, ratio, side, limits) for side in (1, -1)]


def proven(families: list[Family], gap: float = GAP) -> Cover:
    found = covered(families, gap, FLOOR)
    assert found.closed
    assert found.bounded < 2000
    return found


@pytest.mark.parametrize(("ratio", "best"), [each[:2] for each in SLIDES])
def test_the_table_of_slides_is_proven(ratio: float, best: float) -> None:
    found = proven([slider_cranks(1.0, ratio, TWENTY)])
    assert np.degrees(found.lower) <= best + 6e-4
    assert best - 6e-4 <= np.degrees(found.upper) <= best + 0.011
    assert found.upper <= found.lower + GAP * (1 + 1e-9)


@pytest.mark.parametrize("ratio", [3.0, 3.001, 3.5, 10.0])
def test_none_is_proven_of_slides_three_times_as_slow(ratio: float) -> None:
    found = proven([slider_cranks(1.0, ratio, TWENTY)])
    assert (found.lower, found.upper) == (0.0, FLOOR)


@pytest.mark.parametrize("swing", [2.0, 30.0, 80.0, 150.0])
def test_none_is_proven_beyond_the_greatest_time_ratio(swing: float) -> None:
    most = (540 + swing) / (180 - swing)
    limits = StrokeLimits(ANY, 1e4, 0.0)
    assert proven(rockers(np.radians(swing), 1.0001 * most, limits)).lower == 0
    if swing > 2:  # the crank of 2 deg is less than the rest by more
        assert proven(rockers(np.radians(swing), 0.98 * most, limits)).lower > 0


def test_the_published_crank_rocker_is_proven_the_best() -> None:
    found = proven(rockers(np.radians(80), 10 / 9), gap=np.radians(1e-4))
    assert np.degrees([found.lower, found.upper]) == pytest.approx(37.733, abs=1.1e-3)


def turned_crank(pivot: NDArray[np.complex128], r2: Floats, r3: Floats) -> tuple[Floats, Floats, Floats]:
    """Worst transmission angle, swing and time ratio of a crank turned in steps; O4 = 0, r4 = 1, (n,) each.

    Of linkages that come apart the angle is 0.
    """
    steps = np.concatenate([np.linspace(0, 2 * np.pi, 180, endpoint=False), [0.0, np.pi]])
    theta = np.where(np.arange(182) < 180, steps, steps + np.angle(-pivot)[:, None])
    a = pivot[:, None] + r2[:, None] * np.exp(1j * theta)
    apart = np.abs(a)
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = (r3[:, None] ** 2 + 1 - apart**2) / (2 * r3[:, None])
        at_output = np.arccos((1 + apart**2 - r3[:, None] ** 2) / (2 * apart))
    worst = np.where(np.abs(cosine).max(axis=1) < 1, np.arccos(np.minimum(np.abs(cosine).max(axis=1), 1)), 0)
    b = np.unwrap((np.angle(a) + at_output)[:, :180], axis=1)  # B seen from O4
    swing = np.ptp(b, axis=1)
    there = np.abs(theta[0, b.argmax(axis=1)] - theta[0, b.argmin(axis=1)])
    with np.errstate(divide="ignore"):
        ratio = np.maximum(there, 2 * np.pi - there) / np.minimum(there, 2 * np.pi - there)
    return worst, swing, ratio


def by_alt(
    b1: complex, b2: complex, lag: float, number: Floats
) -> tuple[NDArray[np.complex128], Floats, Floats]:
    """O2, from where B1 and B2 are seen under the lag, and O2B1 and O2B2; a number (0 to 2 pi) says where."""
    if lag == 0:  # on the line through both
        short, way = np.tan(number / 4), (b1 - b2) / abs(b1 - b2)
        return b2 - short * way, short + abs(b1 - b2), short
    e1, e2 = np.exp(1j * number), np.exp(1j * (number + lag))
    long = ((b1 - b2) * e2.conj()).imag / np.sin(-lag)
    pivot = b1 - long * e1
    return pivot, long, ((b2 - pivot) / e2).real


def searched(swing: float, ratio: float, ways: int) -> float:
    """The best that a search by Alt's construction finds, each crank turned."""
    lag, best = np.pi * (ratio - 1) / (ratio + 1), 0.0
    b1, b2 = np.exp(1j * swing / 2), np.exp(-1j * swing / 2)
    for one, other in ((b1, b2), (b2, b1)):
        number, step = np.linspace(0, 2 * np.pi, ways, endpoint=False), 2 * np.pi / ways
        for _ in range(2):
            pivot, long, short = by_alt(one, other, lag, number)
            r3, r2 = (long + short) / 2, (long - short) / 2
            lengths = np.stack([np.abs(pivot), r2, r3, np.ones_like(r2)])
            usable = (
                (short > 0) & (r2 > 0) & (lengths.max(axis=0) <= 20 * np.maximum(lengths.min(axis=0), 1e-9))
            )
            reached = [
                (angle, place)
                for part in np.array_split(np.flatnonzero(usable), ways // 2000)
                for angle, swings, ratios, place in zip(
                    *turned_crank(pivot[part], r2[part], r3[part]), number[part], strict=True
                )
                if abs(swings - swing) < 0.02 and abs(ratios / ratio - 1) < 0.1
            ]
            if not reached:
                break
            angle, middle = max(reached)
            best = max(best, angle)
            number = middle + step * np.linspace(-1, 1, 1001)
    return best


def agree(swing: float, ratio: float, ways: int) -> None:
    found = proven(rockers(np.radians(swing), ratio))
    best = searched(np.radians(swing), ratio, ways)
    assert best <= found.upper
    assert best >= found.lower - np.radians(0.005)


@pytest.mark.parametrize(("swing", "ratio"), [(20.0, 1.25), (55.0, 1.0), (90.0, 1.5), (120.0, 1.02)])
def test_no_crank_that_is_turned_exceeds_the_bound_and_one_reaches_it(swing: float, ratio: float) -> None:
    agree(swing, ratio, ways=4000)


def test_the_ratio_of_links_decides_where_both_strokes_take_as_long() -> None:
    found = proven(rockers(np.radians(30), 1.0, StrokeLimits(ANY, ratio=10.0, margin=0.0)))
    assert np.degrees([found.lower, found.upper]) == pytest.approx(73.801, abs=0.0101)


def planted(kind: type[Linkage], seed: int) -> Linkage:
    """A linkage whose crank turns fully and whose output swings or travels to and fro."""
    rng = np.random.default_rng(seed)
    if kind is SliderCrank:
        r3 = rng.uniform(1.1, 4.0)
        return SliderCrank((0, 0), 1.0, r3, offset=rng.uniform(-1, 1) * (r3 - 1) * 0.999)
    r1 = rng.uniform(1.1, 6.0)
    if kind is InvertedSliderCrank:
        return InvertedSliderCrank((0, 0), (r1, 0), 1.0, offset=rng.uniform(-1, 1) * (r1 - 1) * 0.999)
    while True:
        r3, r4 = rng.uniform(1.0, 6.0, 2)
        if r3 + r4 > 1 + r1 and r1 - 1 > abs(r3 - r4):
            return FourBar((0, 0), (r1, 0), 1.0, r3, r4)


def families_of(linkage: Linkage, limits: StrokeLimits) -> list[Family]:
    """The families that a linkage belongs to, by its own swing or stroke and time ratio."""
    own = output_stroke(linkage)
    if isinstance(linkage, SliderCrank):
        return [slider_cranks(float(own.chord), float(own.time_ratio), limits)]
    if isinstance(linkage, InvertedSliderCrank):
        return [crank_shapers(float(own.swing), limits)]
    return rockers(float(own.swing), float(own.time_ratio), limits)


def own_limits(linkage: Linkage, by: float) -> StrokeLimits:
    """Limits that hold a linkage by so much."""
    sizes = {**linkage.columns, "offset": abs(float(getattr(linkage, "offset", 0.0)))}
    each = {
        name: (max(sizes[name] - by, 0.0), sizes[name] + by)
        for name in (*linkage.mechanism.lengths, "offset")
    }
    lengths = {name: each[name] for name in linkage.mechanism.lengths}
    return StrokeLimits(lengths, 1e3, 0.0, each["offset"])


KINDS = pytest.mark.parametrize("kind", [FourBar, SliderCrank, InvertedSliderCrank])


def test_a_cover_that_stays_open_is_bounded_by_what_is_left() -> None:
    """An offset of no width, which no number that is tried has."""
    for offset in (0.3, 0.35):
        limits = StrokeLimits(ANY, 20.0, 0.0, (offset, offset))
        found = covered([slider_cranks(1.0, 1.2, limits)], GAP, FLOOR)
        wide = proven([slider_cranks(1.0, 1.2, replace(limits, offset=(offset - 1e-9, offset + 1e-9)))])
        assert (found.closed, found.lower) == (False, 0.0)
        assert abs(found.upper - wide.lower) < 1e-8


@KINDS
@pytest.mark.parametrize("count", [4, pytest.param(300, marks=[pytest.mark.slow, pytest.mark.study])])
def test_no_linkage_is_lost(kind: type[Linkage], count: int) -> None:
    """Under limits that just hold it, and with its own transmission angle as what counts."""
    for seed in range(count):
        linkage = planted(kind, seed)
        own = float(worst_transmission_cycle(linkage))
        for limits in (StrokeLimits(ANY, 1e3, 0.0), own_limits(linkage, 1e-6), own_limits(linkage, 1e-9)):
            found = covered(families_of(linkage, limits), GAP, max(own - 1e-7, 1e-9))
            assert found.upper >= own - 1e-9, (seed, limits)
            assert found.lower or not found.closed, (seed, limits)


@KINDS
def test_limits_that_a_linkage_misses_by_little_leave_it_out(kind: type[Linkage]) -> None:
    """Its longest link just too long for the others, or it turns with just too little margin."""
    for seed in range(3):
        linkage = planted(kind, seed)
        lengths = linkage.lengths
        number = float(lengths.max() / lengths.min())
        own = float(worst_transmission_cycle(linkage))
        least = float(rotatability(linkage).min())
        exact = own_limits(linkage, 1e-9)
        for limits, some in (
            (replace(exact, ratio=number * (1 + 1e-7)), True),
            (replace(exact, ratio=number * (1 - 1e-7)), False),
            (replace(exact, margin=least - 1e-7), True),
            (replace(exact, margin=least + 1e-7), False),
        ):
            found = covered(families_of(linkage, limits), GAP, max(own - 1e-3, FLOOR))
            assert (found.lower > 0 or not found.closed) is some, (seed, limits)


@pytest.mark.parametrize("swing", [None, 15.0, 80.0, 140.0])
def test_the_best_exists_and_a_little_more_does_not(swing: float | None) -> None:
    turned = None if swing is None else float(np.radians(swing))
    for ratio in (1.07, 2.2):
        best = best_transmission(turned, ratio)
        limits = StrokeLimits(ANY, 1e6, 0.0)
        families = [slider_cranks(1.0, ratio, limits)] if turned is None else rockers(turned, ratio, limits)
        assert covered(families, GAP, best - 1e-7).lower > 0
        above = covered(families, GAP, best + 1e-7)
        assert above.closed
        assert above.lower == 0


@KINDS
def test_pieces_hold_what_their_members_transmit_and_how_that_changes(kind: type[Linkage]) -> None:
    for seed in range(12):
        linkage = planted(kind, seed)
        own = float(np.cos(worst_transmission_cycle(linkage)))
        r2 = float(linkage.r2)
        if isinstance(linkage, InvertedSliderCrank):  # r2 : offset = cos p sin s : sin p cos s
            half = float(output_stroke(linkage).swing) / 2
            number = np.tan(np.arctan2(abs(float(linkage.offset)) * np.sin(half), r2 * np.cos(half)) / 2)
        else:
            number = r2 / float(getattr(linkage, "r3", 1.0))
        near = []
        for family in families_of(linkage, StrokeLimits(ANY, 1e3, 0.0)):
            assert family.low <= number <= family.high
            at = family.members(Range.of(number))
            near.append(abs(float(at.cosine.low) - own))
            assert at.cosine.high - at.cosine.low < 1e-12
            for width in (0.1, 1e-3):
                low = max(family.low, number * (1 - width))
                piece = Range(np.array(low), np.array(min(family.high, low + 2 * width * number)))
                wide = family.members(piece)
                inner = np.linspace(piece.low, piece.high, 41)
                cosine = family.members(Range.of(inner)).cosine
                assert wide.cosine.low <= cosine.low.min()
                assert wide.cosine.high >= cosine.high.max()
                steps = np.diff(cosine.low) / np.diff(inner)
                assert wide.slope.low <= steps.min() + 1e-6
                assert wide.slope.high >= steps.max() - 1e-6
        assert min(near) < 1e-9


PI = Fraction("3.14159265358979323846264338327950288419716939937510")
ENDS = st.tuples(*(st.floats(-1e6, 1e6).filter(lambda x: x == 0 or abs(x) > 1e-100),) * 2).map(sorted)
SHARE = st.fractions(0, 1)


def inside(found: Range, exact: Fraction) -> bool:
    return Fraction(float(found.low)) <= exact <= Fraction(float(found.high))


def at(ends: list[float], share: Fraction) -> tuple[Range, Fraction]:
    """An interval, and a number in it."""
    low, high = (Fraction(end) for end in ends)
    return Range(np.array(ends[0]), np.array(ends[1])), low + share * (high - low)


@given(ENDS, ENDS, SHARE, SHARE)
def test_sums_products_and_quotients_are_enclosed(one, other, first, second) -> None:
    (a, x), (b, y) = at(one, first), at(other, second)
    assert inside(a + b, x + y)
    assert inside(a - b, x - y)
    assert inside(a * b, x * y)
    assert inside(a.size, abs(x))
    if other[0] > 0:
        assert inside(a / b, x / y)
    else:
        assert np.isinf([(a / b).low, (a / b).high]).all()


@given(ENDS, ENDS, SHARE, SHARE)
def test_roots_are_enclosed(one, other, first, second) -> None:
    (a, x), (b, y) = at(one, first), at(other, second)
    long = hypotenuse(a, b)
    assert Fraction(float(long.low)) ** 2 <= x * x + y * y <= Fraction(float(long.high)) ** 2


def test_half_a_turn_and_sines_of_its_parts_are_enclosed() -> None:
    assert inside(HALF_TURN, PI)
    assert (HALF_TURN / Range.of(6.0)).sine.holds(0.5)
    assert (HALF_TURN / Range.of(3.0)).cosine.holds(0.5)
    eighth = (HALF_TURN / Range.of(4.0)).cosine
    assert inside(eighth * eighth, Fraction(1, 2))
    assert HALF_TURN.sine.holds(0.0)
    assert eighth.high - eighth.low < 1e-14


def test_wide_angles_are_enclosed() -> None:
    angle = Range(np.linspace(-3, 3, 50), np.linspace(-3, 3, 50) + 0.3)
    for share in np.linspace(0, 1, 9):
        inner = angle.low + share * (angle.high - angle.low)
        assert angle.sine.holds(np.sin(inner))
        assert angle.cosine.holds(np.cos(inner))
