"""Linkages of every class: limit and dead positions, even motions, figures of complete motions."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_linkages import SMOOTH, SWINGING, linkages, of_each_class
from hypothesis import assume
from hypothesis import strategies as st

from grashof.analysis import (
    GrashofClass,
    dead_ends,
    driver_ranges,
    even_motion,
    extremes,
    full_rotation,
    grashof_class,
    instant_centres,
    output_stroke,
    reach_box,
    rotatability,
    solve_kinematics,
    solve_position,
    transmission_angle,
    transmission_extremes,
    worst_transmission,
    worst_transmission_cycle,
)
from grashof.analysis.curves.coupler_curve import coupler_curve
from grashof.analysis.judge.tolerance import made_linkages
from grashof.analysis.mechanism.sensitivity import turn_sensitivity
from grashof.analysis.mechanism.transmission import quality
from grashof.problems import DeadPositionWarning, InvertedSliderCrank, SliderCrank

SLIDING = [kind for kind in GrashofClass if kind not in (*SMOOTH, GrashofClass.CHANGE_POINT)]
CLASSES = [*SMOOTH, *SLIDING]
MOVING = [GrashofClass.NON_GRASHOF, *SLIDING]  # tests of their own cover other four-bars
ROCKING = [*SWINGING, GrashofClass.SLIDER_ROCKER, GrashofClass.INVERTED_SLIDER_ROCKER]
ENDS, SHARES = st.sampled_from([0, 1]), st.floats(0.2, 0.8)


def inside(linkage, share):
    """A driver angle at a share of the first range of a linkage."""
    low, high = driver_ranges(linkage)[0]
    return float(low + (high - low) * share)


@of_each_class(*CLASSES)
def test_the_class_is_that_of_the_strategy(linkage, kind) -> None:
    assert grashof_class(linkage) is kind
    turning = {
        GrashofClass.CRANK_ROCKER, GrashofClass.DOUBLE_CRANK, GrashofClass.SLIDER_CRANK,
        GrashofClass.CRANK_SHAPER, GrashofClass.WHITWORTH,
    }  # fmt: skip
    assert bool(full_rotation(linkage)) == bool((rotatability(linkage) > 0).all()) == (kind in turning)


@of_each_class(*CLASSES)
def test_the_output_is_at_rest_in_limit_positions(linkage, kind) -> None:
    stroke, slides = output_stroke(linkage), isinstance(linkage, SliderCrank)
    for theta2 in stroke.theta2[np.isfinite(stroke.theta2)]:
        if quality(transmission_angle(linkage, theta2)) >= 1e-3:
            state = solve_kinematics(linkage, theta2)
            rest = state.slide.velocity / linkage.lengths.sum() if slides else state.omega4
            assert abs(rest) < 1e-6
    if full_rotation(linkage):
        fine = solve_position(linkage, np.linspace(0, 2 * np.pi, 5001))
        if slides:
            assert stroke.chord == pytest.approx(np.ptp(fine.travel), rel=1e-4)
        swing = np.ptp(np.unwrap(fine.theta4))
        if kind in (GrashofClass.CRANK_ROCKER, GrashofClass.CRANK_SHAPER):
            assert stroke.swing == pytest.approx(swing, rel=1e-4)
        if kind in (GrashofClass.WHITWORTH, GrashofClass.DOUBLE_CRANK):  # it turns fully
            assert swing == pytest.approx(2 * np.pi, abs=1e-9)
            assert np.isnan([*stroke.theta2, stroke.swing, stroke.time_ratio]).all()


@of_each_class(*ROCKING, end=ENDS, exponent=st.floats(-7, -2))
def test_coupler_rates_grow_without_digits_lost_near_dead_positions(linkage, end, exponent) -> None:
    assume(not full_rotation(linkage))
    theta2 = driver_ranges(linkage)[0][end] + (1 - 2 * end) * 10**exponent
    state = solve_kinematics(linkage, theta2)
    # theta3 varies with the root of the distance from the end.
    assert np.isfinite([state.omega3, state.alpha3, state.jerk3]).all()
    p, rate, _ = coupler_curve(linkage, theta2)
    assert np.isfinite([p, rate]).all()
    assert (rate.real, rate.imag) == pytest.approx(tuple(state.p.velocity), rel=1e-5)


@of_each_class(*ROCKING, end=ENDS, omega2=st.sampled_from([-1.0, 1.0]))
def test_infinite_rates_of_dead_positions_have_the_sign_nearby(linkage, end, omega2) -> None:
    assume(not full_rotation(linkage))
    low, high = driver_ranges(linkage)[0]
    with pytest.warns(DeadPositionWarning):
        there = solve_kinematics(linkage, dead_ends(linkage, low, high)[end], omega2)
    near = solve_kinematics(linkage, (low, high)[end] + (1 - 2 * end) * 1e-9, omega2)
    names = ["omega3", "alpha3", "jerk3"]
    if not isinstance(linkage, SliderCrank):
        names += ["omega4", "alpha4", "jerk4"]
    for name in names:
        assert getattr(there, name) == np.sign(getattr(near, name)) * np.inf
    if near.slide is not None:
        for name in ("velocity", "acceleration", "jerk"):
            assert getattr(there.slide, name) == np.sign(getattr(near.slide, name)) * np.inf


@of_each_class(*SLIDING, first=st.floats(0, 0.4), last=st.floats(0.6, 1))
def test_even_motion_has_neither_jumps_nor_crowds(linkage, first, last) -> None:
    motion, share = (
        even_motion(linkage, inside(linkage, first), inside(linkage, last)),
        np.linspace(0, 1, 361),
    )
    theta2 = motion.theta2(share)
    assert (np.diff(theta2) >= 0).all()
    assert motion.share(theta2[10:-10]) == pytest.approx(share[10:-10], abs=1e-6)
    theta3 = np.unwrap(solve_position(linkage, theta2).theta3)
    assert np.abs(np.diff(theta3)).max() < 0.2
    slope = (motion.theta2(share[5:-5] + 1e-6) - motion.theta2(share[5:-5] - 1e-6)) / 2e-6
    assert motion.rate(share[5:-5]) == pytest.approx(slope, rel=1e-5, abs=1e-6)


@of_each_class(*CLASSES, share=SHARES)
def test_turns_by_dimensions_are_differences_of_positions(linkage, share) -> None:
    theta2 = inside(linkage, share)
    assume(0.3 < transmission_angle(linkage, theta2) < np.pi - 0.3)
    step = 1e-6 * float(linkage.lengths.sum())
    deviations = np.eye(len(linkage.mechanism.dimensions)) * step
    ahead, behind = (solve_position(made_linkages(linkage, sign * deviations)[0], theta2) for sign in (1, -1))
    for link in (3, 4):
        apart = ahead.angles[link] - behind.angles[link]
        slope = ((apart + np.pi) % (2 * np.pi) - np.pi) / (2 * step)
        found = turn_sensitivity(linkage, theta2, link)
        assert found == pytest.approx(slope, rel=1e-5, abs=1e-4 / float(linkage.lengths.sum()))


def motion_of(linkage):
    """Ends of a motion: a turn, or a range of the driver."""
    return (0.3, 0.3 + 2 * np.pi) if full_rotation(linkage) else tuple(driver_ranges(linkage)[0].tolist())


@of_each_class(*MOVING)
def test_extremes_and_boxes_are_those_of_dense_samples(linkage) -> None:
    start, end = motion_of(linkage)
    start, end = start + 1e-3 * (end - start), end - 1e-3 * (end - start)
    size = float(linkage.lengths.sum())
    fine = start + (end - start) * (1 - np.cos(np.linspace(0, np.pi, 5001))) / 2
    state = solve_position(linkage, fine)
    found = extremes(linkage, lambda state: state.p.position[:, 0], start=start, end=end)
    closed = np.isfinite(state.p[:, 0])
    assert closed[1:-1].all()
    assert found.low == pytest.approx(state.p[closed, 0].min(), abs=1e-5 * size)
    assert found.high == pytest.approx(state.p[closed, 0].max(), abs=1e-5 * size)
    pivots = [getattr(linkage, name)[None] for name in linkage.mechanism.ground]
    every = np.concatenate([state.a[closed], state.b[closed], state.p[closed], *pivots])
    box = reach_box(linkage, start, end)
    assert np.allclose(box, [every.min(axis=0), every.max(axis=0)], rtol=0, atol=1e-5 * size)
    mu = transmission_angle(linkage, fine[closed])
    ends = transmission_extremes(linkage, start, end)
    assert (ends.low, ends.high) == pytest.approx((mu.min(), mu.max()), abs=2e-3)
    assert ends.low <= mu.min() + 1e-9
    assert ends.high >= mu.max() - 1e-9


@of_each_class(*MOVING, share=SHARES)
def test_links_have_one_velocity_in_their_instant_centre(linkage, share) -> None:
    theta2 = inside(linkage, share)
    state, centres = solve_kinematics(linkage, theta2), instant_centres(linkage, theta2)
    size = float(linkage.lengths.sum())

    def velocity(link, place):
        origin = state.origin(link)
        turned = complex(*(place - origin.position)) * 1j * state.angular(link).omega
        return origin.velocity + np.array([turned.real, turned.imag])

    if np.isfinite(centres.i13).all() and np.abs(centres.i13).max() < 1e4 * size:
        assert np.abs(velocity(3, centres.i13)).max() < 1e-7 * size
    if np.isfinite(centres.i24).all() and np.abs(centres.i24).max() < 1e4 * size:
        two, four = velocity(2, centres.i24), velocity(4, centres.i24)
        assert np.abs(two - four).max() < 1e-7 * (size + np.abs(two).max())
    assert np.isnan(centres.i14).all() == isinstance(linkage, SliderCrank)
    assert np.isnan(centres.i34).all() == isinstance(linkage, InvertedSliderCrank)


# Functions of linkages alone, and functions of driver angles too.
OF_LINKAGES = (
    driver_ranges, full_rotation, rotatability, worst_transmission_cycle,
    *(lambda linkage, name=name: getattr(output_stroke(linkage), name)
      for name in ("theta2", "theta4", "swing", "chord", "time_ratio")),
)  # fmt: skip
AT_ANGLES = (
    *(lambda linkage, theta2, name=name: getattr(solve_position(linkage, theta2), name)
      for name in ("theta2", "theta3", "theta4", "a", "b", "p")),
    *(lambda linkage, theta2, name=name: getattr(solve_kinematics(linkage, theta2, 1 + theta2, 0.3), name)
      for name in ("omega3", "omega4", "alpha3", "alpha4", "jerk3", "jerk4")),
    lambda linkage, theta2: solve_kinematics(linkage, theta2, 1.5, 0.3).p.jerk,
    transmission_angle,
    lambda linkage, theta2: worst_transmission(linkage, theta2, theta2[::-1] + 0.4),
)  # fmt: skip


@of_each_class(*MOVING[:2], GrashofClass.CRANK_SHAPER, examples=3)
def test_a_batch_is_its_linkages_one_by_one(linkage, kind, data) -> None:
    both = linkage, data.draw(linkages(kind))
    batch, theta2 = type(linkage).stacked(both), np.linspace(-3, 3, 7)
    for row, one in enumerate(both):
        for of in OF_LINKAGES:
            assert np.array_equal(of(batch)[row], of(one), equal_nan=True)
        for of in AT_ANGLES:
            assert np.array_equal(of(batch[:, None], theta2)[row], of(one, theta2), equal_nan=True)
