"""Every kind of linkage against Newton's method on the equations of its loop."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from grashof.analysis import (
    GrashofClass,
    driver_ranges,
    full_rotation,
    grashof_class,
    output_stroke,
    rotatability,
    solve_kinematics,
    solve_position,
    transmission_angle,
)
from grashof.analysis.curves.coupler_curve import coupler_curve, coupler_motion
from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.mobility import dead_ends
from grashof.analysis.mechanism.sensitivity import turn_sensitivity
from grashof.analysis.mechanism.transmission import quality
from grashof.problems import DeadPositionWarning, FourBar, SliderCrank

SWINGING = [
    GrashofClass.DOUBLE_ROCKER,
    GrashofClass.ROCKER_CRANK,
    GrashofClass.NON_GRASHOF,
    GrashofClass.SLIDER_ROCKER,
    GrashofClass.INVERTED_SLIDER_ROCKER,
]
CLASSES = [kind for kind in GrashofClass if kind is not GrashofClass.CHANGE_POINT]
SLIDING = CLASSES[-5:]
few, fewer = settings(max_examples=6), settings(max_examples=3)


def inside(linkage, share):
    """A driver angle at a share of the first range of a linkage."""
    low, high = driver_ranges(linkage)[0]
    return float(low + (high - low) * share)


def unknowns(linkage, state):
    """What the second opinion solves for: theta3, and theta4 or a length."""
    if isinstance(linkage, FourBar):
        return np.array([state.theta3, state.theta4])
    if isinstance(linkage, SliderCrank):
        slide = np.array([np.cos(linkage.slide_angle), np.sin(linkage.slide_angle)])
        return np.array([state.theta3, (state.b - linkage.o2) @ slide])
    return np.array([state.theta3, (state.b - state.a) @ [np.cos(state.theta3), np.sin(state.theta3)]])


@pytest.mark.parametrize("kind", CLASSES)
def test_the_class_is_the_one_drawn(linkages, kind) -> None:
    @few
    @given(linkages(kind))
    def check(linkage) -> None:
        assert grashof_class(linkage) is kind
        turning = {
            GrashofClass.CRANK_ROCKER, GrashofClass.DOUBLE_CRANK, GrashofClass.SLIDER_CRANK,
            GrashofClass.CRANK_SHAPER, GrashofClass.WHITWORTH,
        }  # fmt: skip
        assert bool(full_rotation(linkage)) == bool((rotatability(linkage) > 0).all()) == (kind in turning)

    check()


@pytest.mark.parametrize("kind", SLIDING)
def test_positions_are_those_of_the_loop_equations(linkages, second_opinion, kind) -> None:
    @few
    @given(linkages(kind), st.floats(0.02, 0.98), st.sampled_from([-1, 1]))
    def check(linkage, share, assembly) -> None:
        theta2 = inside(linkage, share)
        state = solve_position(linkage, theta2, assembly)
        other = second_opinion(linkage)
        found = other.at(theta2, assembly)
        ours = unknowns(linkage, state)
        away = (ours - found + np.pi) % (2 * np.pi) - np.pi if isinstance(linkage, FourBar) else ours - found
        away[0] = (away[0] + np.pi) % (2 * np.pi) - np.pi
        size = float(linkage.lengths.sum())
        sine = float(other.sine(found))
        assert np.abs(away / [1, 1 if isinstance(linkage, FourBar) else size]).max() < 1e-12 / abs(sine)
        assert state.margins[0] == pytest.approx(sine, abs=1e-11)
        assert np.sin(transmission_angle(linkage, theta2)) == pytest.approx(abs(sine), abs=1e-9)

    check()


@pytest.mark.parametrize("kind", CLASSES)
def test_points_move_as_their_places_do(linkages, kind) -> None:
    """B and P, and points of link 4, against central differences of places."""

    @few
    @given(linkages(kind), st.floats(0.15, 0.85))
    def check(linkage, share) -> None:
        theta2 = inside(linkage, share)
        mu = transmission_angle(linkage, theta2)
        assume(0.2 < mu < np.pi - 0.2)
        step = 1e-3
        around = theta2 + step * np.arange(-4, 5)
        weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / step
        state, places = solve_kinematics(linkage, theta2), solve_position(linkage, around)
        size = float(linkage.lengths.sum())
        moving = coupler_motion(linkage, theta2)
        assert (moving.omega, moving.alpha) == pytest.approx((state.omega3, state.alpha3), rel=1e-9)
        motions = {"a": state.a, "b": state.b, "p": state.p}
        for point, motion in motions.items():
            track = getattr(places, point)
            assert np.allclose(motion.position, track[4], rtol=0, atol=1e-10 * size)
            assert np.allclose(motion.velocity, weights @ track, rtol=1e-6, atol=1e-6 * size)
        many = solve_kinematics(linkage, around)
        for link in (2, 3, 4):
            found, track = (
                state.point(link, (0.3 * size, -0.2 * size)),
                many.point(link, (0.3 * size, -0.2 * size)),
            )
            assert np.allclose(found.velocity, weights @ track.position, rtol=1e-6, atol=1e-6 * size)
            assert np.allclose(found.acceleration, weights @ track.velocity, rtol=1e-5, atol=1e-5 * size)
            assert np.allclose(found.jerk, weights @ track.acceleration, rtol=1e-4, atol=1e-3 * size)

    check()


@pytest.mark.parametrize(
    "kind", [GrashofClass.NON_GRASHOF, GrashofClass.SLIDER_ROCKER, GrashofClass.WHITWORTH]
)
def test_the_loop_closes_within_the_ranges_alone(linkages, second_opinion, kind) -> None:
    @fewer
    @given(linkages(kind))
    def check(linkage) -> None:
        ranges = driver_ranges(linkage)
        other = second_opinion(linkage)
        turns = bool(full_rotation(linkage))
        assert turns == (np.nan_to_num(ranges[:, 1] - ranges[:, 0]).sum() > 2 * np.pi - 1e-9)
        for theta2 in np.linspace(-np.pi, np.pi, 7) + 0.01:
            closes = bool((((theta2 - ranges[:, 0]) % (2 * np.pi)) < ranges[:, 1] - ranges[:, 0]).any())
            near = np.abs((ranges - theta2 + np.pi) % (2 * np.pi) - np.pi)
            if not turns and np.nanmin(near) < 1e-3:
                continue
            assert closes == np.isfinite(other.at(float(theta2), 1)).all()
            assert closes == np.isfinite(solve_position(linkage, theta2).theta3)
        for low, high in ranges[np.isfinite(ranges[:, 0])] if not turns else []:
            # The determinant goes to zero at either end, as the root of the way to it.
            for end, sense in ((low, 1), (high, -1)):
                state = solve_position(linkage, end + sense * 1e-8)
                assert abs(other.sine(unknowns(linkage, state))) < 1e-2
            ends = np.array(dead_ends(linkage, low, high))
            assert (solve_position(linkage, ends).margins[0] == 0).all()
            assert np.abs(ends - [low, high]).max() < 1e-11

    check()


@pytest.mark.parametrize("kind", CLASSES)
def test_limit_positions_are_where_the_output_rests(linkages, kind) -> None:
    @few
    @given(linkages(kind))
    def check(linkage) -> None:
        stroke = output_stroke(linkage)
        for theta2 in stroke.theta2[np.isfinite(stroke.theta2)]:
            mu = transmission_angle(linkage, theta2)
            if quality(mu) < 1e-3:
                continue
            state = solve_kinematics(linkage, theta2)
            rest = state.slide.velocity if isinstance(linkage, SliderCrank) else state.omega4
            size = float(linkage.lengths.sum()) if isinstance(linkage, SliderCrank) else 1.0
            assert abs(rest) < 1e-6 * size
        if full_rotation(linkage):
            fine = solve_position(linkage, np.linspace(0, 2 * np.pi, 5001))
            if isinstance(linkage, SliderCrank):
                travel = solve_kinematics(linkage, fine.theta2).slide.travel
                assert stroke.chord == pytest.approx(np.ptp(travel), rel=1e-4)
            swing = np.ptp(np.unwrap(fine.theta4))
            if kind in (GrashofClass.CRANK_ROCKER, GrashofClass.CRANK_SHAPER):
                assert stroke.swing == pytest.approx(swing, rel=1e-4)
            if kind is GrashofClass.WHITWORTH:
                assert swing == pytest.approx(2 * np.pi, abs=1e-9)
                assert np.isnan(stroke.theta2).all()

    check()


@pytest.mark.parametrize("kind", SWINGING)
def test_coupler_rates_grow_without_digits_lost_near_dead_positions(linkages, kind) -> None:
    @few
    @given(linkages(kind), st.sampled_from([0, 1]), st.floats(-7, -2))
    def check(linkage, end, exponent) -> None:
        assume(not full_rotation(linkage))
        theta2 = driver_ranges(linkage)[0][end] + (1 - 2 * end) * 10**exponent
        state = solve_kinematics(linkage, theta2)
        # theta3 goes as the root of the way to the end: rate = 1/2 (theta3 - theta3 end) / way, nearly.
        assert np.isfinite([state.omega3, state.alpha3, state.jerk3]).all()
        p, rate, _ = coupler_curve(linkage, theta2)
        assert np.isfinite([p, rate]).all()
        assert (rate.real, rate.imag) == pytest.approx(tuple(state.p.velocity), rel=1e-5)

    check()


@pytest.mark.parametrize("kind", SWINGING)
def test_rates_in_a_dead_position_have_the_signs_they_grow_with(linkages, kind) -> None:
    @few
    @given(linkages(kind), st.sampled_from([0, 1]), st.sampled_from([-1.0, 1.0]))
    def check(linkage, end, omega2) -> None:
        assume(not full_rotation(linkage))
        low, high = driver_ranges(linkage)[0]
        dead = dead_ends(linkage, low, high)[end]
        with pytest.warns(DeadPositionWarning):
            there = solve_kinematics(linkage, dead, omega2)
        near = solve_kinematics(linkage, (low, high)[end] + (1 - 2 * end) * 1e-9, omega2)
        names = ["omega3", "alpha3", "jerk3"]
        if not isinstance(linkage, SliderCrank):
            names += ["omega4", "alpha4", "jerk4"]
        for name in names:
            assert getattr(there, name) == np.sign(getattr(near, name)) * np.inf
        if near.slide is not None:
            for name in ("velocity", "acceleration", "jerk"):
                assert getattr(there.slide, name) == np.sign(getattr(near.slide, name)) * np.inf

    check()


@pytest.mark.parametrize("kind", SLIDING)
def test_even_motion_has_neither_jumps_nor_crowds(linkages, kind) -> None:
    @few
    @given(linkages(kind), st.floats(0, 0.4), st.floats(0.6, 1))
    def check(linkage, first, last) -> None:
        start, end = inside(linkage, first), inside(linkage, last)
        motion = even_motion(linkage, start, end)
        share = np.linspace(0, 1, 361)
        theta2 = motion.theta2(share)
        assert (np.diff(theta2) >= 0).all()
        assert motion.share(theta2[10:-10]) == pytest.approx(share[10:-10], abs=1e-6)
        theta3 = np.unwrap(solve_position(linkage, theta2).theta3)
        assert np.abs(np.diff(theta3)).max() < 0.2
        slope = (motion.theta2(share[5:-5] + 1e-6) - motion.theta2(share[5:-5] - 1e-6)) / 2e-6
        assert motion.rate(share[5:-5]) == pytest.approx(slope, rel=1e-5, abs=1e-6)

    check()


@pytest.mark.parametrize("kind", CLASSES)
def test_dimensions_turn_the_links_as_linkages_made_so_show(linkages, kind) -> None:
    @few
    @given(linkages(kind), st.floats(0.2, 0.8))
    def check(linkage, share) -> None:
        from grashof.analysis.judge.tolerance import made_linkages

        theta2 = inside(linkage, share)
        mu = transmission_angle(linkage, theta2)
        assume(0.3 < mu < np.pi - 0.3)
        step = 1e-6 * float(linkage.lengths.sum())
        deviations = np.eye(len(linkage.mechanism.dimensions)) * step
        for link, name in ((3, "theta3"), (4, "theta4")):
            found = turn_sensitivity(linkage, theta2, link)
            apart = [
                getattr(solve_position(made_linkages(linkage, sign * deviations)[0], theta2), name)
                for sign in (1, -1)
            ]
            slope = ((apart[0] - apart[1] + np.pi) % (2 * np.pi) - np.pi) / (2 * step)
            assert found == pytest.approx(slope, rel=1e-5, abs=1e-4 / float(linkage.lengths.sum()))

    check()
