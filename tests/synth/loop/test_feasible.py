"""Lengths feasible by construction, before the judge."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import driver_ranges, full_rotation, worst_transmission
from grashof.analysis.mechanism.mobility import rotatability
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray
from grashof.synth.loop.dyad import Sizes
from grashof.synth.loop.feasible import INSIDE, Demand, feasible
from grashof.synth.quantities.kinds import KINDS

WORDS = list(KINDS)
ROUNDING = 1e-7
share = st.floats(0, 1, exclude_max=True)
shares = st.tuples(share, share, share).map(np.array)
angle = st.floats(0, np.radians(80))
margin = st.floats(0, 0.2)


def linkage_of(word: str, sizes: Sizes) -> Linkage:
    """With the ground line, or the normal of the slide, along x: phi is theta2."""
    origin = np.zeros(2)
    if word == "four-bar":
        return FourBar(origin, (1.0, 0.0), sizes.r2, sizes.r3, sizes.r4)
    if word == "slider-crank":
        return SliderCrank(origin, sizes.r2, sizes.r3, offset=sizes.offset, slide_angle=-np.pi / 2)
    return InvertedSliderCrank(origin, (1.0, 0.0), sizes.r2, offset=sizes.offset)


def made(word: str, numbers: FloatArray, longer: bool | BoolArray, demand: Demand) -> Linkage:
    return linkage_of(word, feasible(KINDS[word].dyad, numbers, np.asarray(longer), demand))


@pytest.mark.parametrize("word", WORDS)
@given(numbers=shares, longer=st.booleans(), mu=angle, least=margin)
@settings(max_examples=60)
def test_the_driver_turns_fully(
    word: str, numbers: FloatArray, longer: bool, mu: float, least: float
) -> None:
    linkage = made(word, numbers, longer, Demand.turning(mu, least))
    assert full_rotation(linkage)
    assert rotatability(linkage).min() > least - ROUNDING
    assert worst_transmission(linkage, 0.0, TURN) > mu - ROUNDING
    assert word == "slider-crank" or (linkage.r2 > 1) == longer


@pytest.mark.parametrize("word", WORDS)
@given(numbers=shares, longer=st.booleans(), mu=angle, low=st.floats(-7, 7), span=st.floats(0.01, 6))
@settings(max_examples=60)
def test_the_driver_covers_a_range(
    word: str, numbers: FloatArray, longer: bool, mu: float, low: float, span: float
) -> None:
    linkage = made(word, numbers, longer, Demand.covering(low, low + span, mu))
    assert worst_transmission(linkage, low, low + span) > mu - ROUNDING
    ranges = driver_ranges(linkage, max(mu - ROUNDING, 0.0))
    low_ends, widths = ranges[:, :1], np.diff(ranges)
    on_the_way = np.linspace(low, low + span, 25)
    within = (on_the_way - low_ends + ROUNDING) % TURN <= widths + 2 * ROUNDING
    assert within.any(axis=0).all()


@pytest.mark.parametrize("word", WORDS)
@pytest.mark.parametrize("longer", [False, True])
@pytest.mark.parametrize(("mu_deg", "least"), [(0, 0), (30, 0), (0, 0.05), (25, 0.02)])
def test_there_are_none_besides(word: str, longer: bool, mu_deg: float, least: float) -> None:
    """Random linkages that the judge finds good enough have shares between 0 and 1."""
    rng, count, mu = np.random.default_rng(0), 20_000, np.radians(mu_deg)
    one, (first, second, third) = np.ones(count), rng.uniform(0, 1, (3, count))
    r2 = 1 / first if longer and word != "slider-crank" else first
    if word == "four-bar":
        sizes = Sizes(one, r2, 4 * (1 + r2) * second, 4 * (1 + r2) * third)
    else:
        sizes = Sizes(one, r2, one, 2 * second - 1)
    every = linkage_of(word, sizes)
    good = np.flatnonzero(
        (worst_transmission(every, 0.0, TURN) >= mu) & (rotatability(every) > least).all(axis=-1)
    )
    assert len(good) > 20
    shares = np.full((len(good), 3), 0.5)
    for place in range(3 if word == "four-bar" else 2):
        ends = []
        for end in (0.5 if place == 2 else 0.0, 1.0):
            shares[:, place] = end
            found = feasible(KINDS[word].dyad, shares, np.full(len(good), longer), Demand.turning(mu, least))
            ends.append(of_share(word, found)[place])
        begin, last = ends
        value = of_share(word, sizes)[place][good]
        rise = (value - begin) / (last - begin)
        assert (rise > -3 * INSIDE).all()
        assert (rise < 1 + 3 * INSIDE).all()
        shares[:, place] = np.clip(0.5 + rise / 2 if place == 2 else rise, 0, 1)


def of_share(word: str, sizes: Sizes) -> list[FloatArray]:
    """Quantities that grow or fall evenly with each share."""
    longest = np.maximum(sizes.r2, 1.0)
    if word == "four-bar":
        return [sizes.r2 / longest**2, 1 / (sizes.r3 + sizes.r4), np.abs(sizes.r3 - sizes.r4)]
    return [sizes.r2 / (1 + sizes.r2) if word == "slider-crank" else sizes.r2 / longest**2, sizes.offset]


@pytest.mark.parametrize("mu_deg", [0, 20, 40, 60])
def test_the_longest_crank_of_a_crank_rocker(mu_deg: float) -> None:
    """A-O4 is r1 - r2 to r1 + r2 long, with a ratio of at least tan(mu / 2)."""
    mu = np.radians(mu_deg)
    sizes = feasible(KINDS["four-bar"].dyad, np.ones(3), np.asarray(False), Demand.turning(mu))
    assert sizes.r2 == pytest.approx(np.tan(np.pi / 4 - mu / 2), rel=1e-5)


def test_where_there_are_none_there_are_no_numbers() -> None:
    """A third is the margin of a four-bar of r2 = 0, r3 = r4 = r1, which no other has."""
    numbers = np.random.default_rng(0).random((50, 3))
    for least, none in ((0.333, False), (0.334, True)):
        sizes = feasible(KINDS["four-bar"].dyad, numbers, np.zeros(50, dtype=bool), Demand.turning(0, least))
        assert np.isnan([sizes.r2, sizes.r3, sizes.r4]).all() == none
