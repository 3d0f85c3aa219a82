import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from known_designs import SLIDES
from scipy.optimize import brentq, minimize_scalar

from grashof.analysis import solve_position, verify
from grashof.analysis.mechanism.mobility import grashof_class
from grashof.analysis.mechanism.stroke import output_stroke
from grashof.analysis.mechanism.transmission import worst_transmission_cycle
from grashof.problems import FourBar, Requirements, SliderCrank, StrokeTask
from grashof.synth.theory.limit_positions import (
    best_of,
    best_transmission,
    families_of,
    greatest_time_ratio,
    lag_of,
    linkages_of,
    slider_cranks,
    stretches,
)

TURN = 2 * np.pi


def optimum(swing_deg, time_ratio, allowed=None):
    """Lengths and worst transmission angle (deg) of the best member."""
    swing = None if swing_deg is None else np.radians(swing_deg)
    found = []
    for family in families_of(swing, time_ratio):
        within = stretches(family, allowed) if allowed else stretches(family)
        members = family(np.array(best_of(family, within)))
        found += zip(np.degrees(members.transmission), members.lengths, strict=True)
    angle, lengths = max(found, key=lambda one: one[0])
    return lengths, angle


def linkage_of(lengths, assembly=1):
    r1, r2, r3, r4 = lengths
    return FourBar(o2=(0, 0), o4=(r1, 0), r2=r2, r3=r3, r4=r4, assembly=assembly)


def ratio_of_links(most):
    return lambda found: np.log(most) - np.log(found.lengths.max(axis=1) / found.lengths.min(axis=1))


def test_the_published_optimum() -> None:
    # goessner/crocker: swing 80 deg, time ratio 10/9, published 120, 46.7, 116, 73.9 and 37.7 deg.
    lengths, angle = optimum(80, 10 / 9)
    np.testing.assert_allclose(120 * lengths, [120, 46.67, 116.16, 73.88], atol=0.005)
    assert angle == pytest.approx(37.733, abs=5e-4)


def test_the_ratio_of_links_decides_where_both_strokes_take_as_long() -> None:
    lengths, angle = optimum(30, 1.0, ratio_of_links(10))
    np.testing.assert_allclose(lengths, [1, 0.1, 0.92775, 0.38637], atol=5e-6)
    assert angle == pytest.approx(73.801, abs=5e-4)


@pytest.mark.parametrize("swing", [20, 75, 130])
def test_without_a_limit_it_comes_as_near_as_you_like_to_its_supremum(swing) -> None:
    above = 90 - swing / 2
    angles = [optimum(swing, 1.0, ratio_of_links(most))[1] for most in (10, 100, 10_000)]
    assert angles == sorted(angles)
    assert above - 0.02 < angles[-1] < above
    assert np.isnan(best_transmission(np.radians(80), 10 / 9, ratio_of_links(1.5)))  # none fits


@pytest.mark.parametrize(("lag", "beside"), [(12, 11), (60, 3)])
def test_the_optimum_is_symmetric_about_a_swing_that_equals_the_lag(lag, beside) -> None:
    ratio = (180 + lag) / (180 - lag)
    less, equal, more = (optimum(swing, ratio)[1] for swing in (lag - beside, lag, lag + beside))
    assert less == pytest.approx(more, abs=1e-8)
    assert equal > more


@pytest.mark.parametrize(("ratio", "angle", "r2", "r3", "offset"), SLIDES)
def test_the_table_of_slides(ratio, angle, r2, r3, offset) -> None:
    lengths, found = optimum(None, ratio)
    assert found == pytest.approx(angle, abs=6e-4)
    np.testing.assert_allclose(lengths, [r2, r3, offset], atol=3e-5)


def test_slides_need_a_ratio_below_three() -> None:
    assert best_transmission(None, 2.999) > 0
    assert np.isnan(best_transmission(None, 3.001))


def test_without_an_offset_both_strokes_of_a_slide_take_as_long() -> None:
    members = slider_cranks(0.0, np.linspace(0.05, 0.95, 7))
    np.testing.assert_allclose(members.lengths[:, 0], 0.5)
    np.testing.assert_array_equal(members.lengths[:, 2], 0.0)
    assert (members.margin > 0).all()


@pytest.mark.parametrize("swing", [2, 80, 178])
def test_the_greatest_time_ratio_is_just_out_of_reach(swing) -> None:
    most = greatest_time_ratio(np.radians(swing))
    assert best_transmission(np.radians(swing), 0.9999 * most) > 0
    assert np.isnan(best_transmission(np.radians(swing), 1.0001 * most))


def turning_points(position, start):
    """Where a function of a driver's angle is greatest and least over a turn, by samples and Brent."""
    theta = start + np.linspace(0, TURN, 2000, endpoint=False)
    value, step = position(theta), TURN / 2000
    found = []
    for sign in (1, -1):
        near = theta[np.argmax(sign * value)]

        def slope(at, h=1e-4):  # five points: its zero is right to some 1e-13
            at = at + h * np.array([-2.0, -1.0, 1.0, 2.0])
            return float(position(at) @ np.array([1.0, -8.0, 8.0, -1.0])) / (12 * h)

        found.append(brentq(slope, near - step, near + step, xtol=1e-14))
    return found


def strokes(position):
    """Way between the turning points and time ratio, from the sampled motion alone."""
    high, low = turning_points(position, 0.0)
    way = float(np.diff(position(np.array([low, high])))[0])
    there = (high - low) % TURN
    return abs(way), max(there, TURN - there) / min(there, TURN - there)


@pytest.mark.parametrize(("swing", "ratio"), [(15, 1.6), (80, 10 / 9), (140, 1.0)])
def test_sampled_motion_has_the_swing_and_the_ratio(swing, ratio) -> None:
    sampled = []
    for family in families_of(np.radians(swing), ratio):
        for low, high in stretches(family):
            members = family(np.linspace(low, high, 6)[1:-1])
            assert (members.margin > 0).all()
            sampled.append(members)
    assert sampled
    for members in sampled:
        for lengths, worst in zip(members.lengths, members.transmission, strict=True):
            linkage = linkage_of(lengths)
            middle = float(solve_position(linkage, 0.0).theta4)

            def position(theta2, linkage=linkage, middle=middle):
                turned = solve_position(linkage, theta2).theta4 - middle
                return (turned + np.pi) % TURN - np.pi  # it swings by less than half a turn

            found = strokes(position)
            assert found[0] == pytest.approx(np.radians(swing), abs=1e-9)
            assert found[1] == pytest.approx(ratio, abs=1e-9)
            assert str(grashof_class(linkage)) == "crank-rocker"
            assert float(worst_transmission_cycle(linkage)) == pytest.approx(worst, abs=1e-12)


def random_crank_rockers(count, seed):
    rng = np.random.default_rng(seed)
    r2 = rng.uniform(0.05, 0.9, count)
    r3, r4 = rng.uniform(0.1, 3.0, (2, count))
    usable = (r2 < np.minimum(r3, r4)) & (r3 + r4 > 1 + r2) & (1 - r2 > np.abs(r3 - r4))
    return np.stack([np.ones(count), r2, r3, r4], axis=-1)[usable]


def test_every_crank_rocker_is_a_member_of_its_family() -> None:
    for lengths in random_crank_rockers(2000, seed=2)[:60]:
        stroke = output_stroke(linkage_of(lengths))
        share = np.array([lengths[1] / lengths[2]])
        families = families_of(float(stroke.swing), float(stroke.time_ratio))
        apart = [np.abs(family(share).lengths - lengths).max() for family in families]
        assert min(apart) < 1e-9
        assert families[int(np.argmin(apart))](share).margin.min() > 0


@pytest.mark.slow
@given(st.floats(5, 170), st.floats(1.0, 3.0), st.integers(0, 2**32 - 1))
def test_no_random_member_beats_the_optimum(swing_deg, ratio, seed) -> None:
    swing = np.radians(swing_deg)
    if ratio > greatest_time_ratio(swing):
        return
    best = best_transmission(swing, ratio)
    share = np.random.default_rng(seed).uniform(1e-5, 1, 15_000)
    for family in families_of(swing, ratio):
        members = family(share)
        assert members.transmission[members.margin > 0].max(initial=0.0) <= np.nan_to_num(best) + 1e-10


def test_both_positions_on_one_assembly_or_it_is_nonsense() -> None:
    # Without that test a slide of ratio 1.75 would be better with a crank of next to nothing.
    lag = lag_of(1.75)
    bare = minimize_scalar(
        lambda at: -slider_cranks(lag, np.array([np.exp(at)])).transmission[0], bounds=(-12, 0)
    )
    assert np.degrees(-bare.fun) > np.degrees(best_transmission(None, 1.75)) + 6
    assert not slider_cranks(lag, np.exp([bare.x])).margin.max() > 0


def test_a_window_narrower_than_the_grid_is_found() -> None:
    family = families_of(np.radians(80), 10 / 9)[1]
    at = 0.4317773
    middle = family(np.array([at])).lengths[0]
    ((low, high),) = stretches(family, lambda found: 1e-7 - np.abs(found.lengths[:, 1] - middle[1]))
    assert low <= at <= high
    assert high - low < 1e-6


@pytest.mark.parametrize(
    ("swing", "ratio", "mirrored", "sense"),
    [(80, 10 / 9, False, 1), (40, 1.0, True, 1), (30, 1.5, True, -1), (80, 10 / 9, False, -1)],
)
def test_the_slow_stroke_begins_and_ends_where_the_judge_finds_it(swing, ratio, mirrored, sense) -> None:
    task = StrokeTask.from_degrees(swing_deg=swing, time_ratio=ratio)
    wanted = Requirements(driver_sense="ccw" if sense > 0 else "cw")
    for family in families_of(np.radians(swing), ratio):
        members = family(np.array([np.mean(stretches(family)[0]), 0.6]))
        members = members.mirrored if mirrored else members
        for each in range(2):
            if not members.margin[each] > 0:
                continue
            linkage = linkage_of(members.lengths[each], members.assembly[each])
            verdict = verify(linkage, task, wanted)
            assert [defect for defect in verdict.defects if defect.requirement != "rotatability"] == []
            ends = [members.first[each], members.last[each]][::sense]
            if ratio > 1:  # else either stroke is the slow one
                apart = np.abs(np.exp(1j * verdict.theta2) - np.exp(1j * np.array(ends)))
                assert apart.max() < 1e-9
            assert sense * np.ptp(verdict.theta2) == pytest.approx(verdict.theta2[1] - verdict.theta2[0])
            assert np.ptp(verdict.theta2) == pytest.approx(task.driver_rotation, abs=1e-9)


@pytest.mark.parametrize("ratio", [1.0, 1.2, 2.0])
def test_slides_of_a_stroke_stand_at_its_ends_where_the_slow_stroke_begins_and_ends(ratio: float) -> None:
    task = StrokeTask(stroke=100, time_ratio=ratio)
    (family,) = families_of(None, ratio)
    (low, high), *_ = stretches(family)
    members = family(np.linspace(low, high, 5)[1:-1])
    slides = linkages_of(task, members)
    assert isinstance(slides, SliderCrank)
    theta2 = np.stack([members.first, members.last])
    a = slides.r2 * np.exp(1j * theta2)
    b = a.real + np.sqrt(slides.r3**2 - (slides.offset - a.imag) ** 2) + 1j * slides.offset
    np.testing.assert_allclose((b[0] - b[1]).real, 100, atol=1e-9)
    np.testing.assert_allclose((b * a.conj()).imag / np.abs(a), 0, atol=1e-9)  # driver and rod in line
    np.testing.assert_allclose(np.diff(theta2, axis=0)[0], task.driver_rotation, atol=1e-12)
