"""Figures of whole motions of every kind of linkage, against dense samples and quadrature."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import scipy
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import (
    GrashofClass,
    coupler_fit_r2,
    driver_ranges,
    extremes,
    full_rotation,
    instant_centres,
    output_stroke,
    rotatability,
    solve_kinematics,
    solve_position,
    straightness,
    transmission_angle,
    worst_transmission,
    worst_transmission_cycle,
)
from grashof.analysis.mechanism.driver_law import mean_over
from grashof.analysis.mechanism.extremes import reach_box, transmission_extremes
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import InvertedSliderCrank, SliderCrank

# Of the four-bars, tests of their own know more.
CLASSES = [GrashofClass.NON_GRASHOF, *(kind for kind in GrashofClass if kind not in FOUR_BAR_CLASSES)]
few = settings(max_examples=4)


def motion_of(linkage):
    """Ends of a motion: a turn, or a range of the driver."""
    low, high = driver_ranges(linkage)[0]
    return (0.3, 0.3 + 2 * np.pi) if full_rotation(linkage) else (float(low), float(high))


def dense(start, end, count=5001):
    """Driver angles, closer towards the ends."""
    return start + (end - start) * (1 - np.cos(np.linspace(0, np.pi, count))) / 2


@pytest.mark.parametrize("kind", CLASSES)
def test_extremes_and_boxes_are_those_of_dense_samples(linkages, kind) -> None:
    @few
    @given(linkages(kind))
    def check(linkage) -> None:
        start, end = motion_of(linkage)
        start, end = start + 1e-3 * (end - start), end - 1e-3 * (end - start)
        size = float(linkage.lengths.sum())
        fine = dense(start, end)
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

    check()


@pytest.mark.parametrize("kind", CLASSES)
def test_means_are_those_of_another_quadrature(linkages, kind) -> None:
    @settings(max_examples=1)
    @given(linkages(kind))
    def check(linkage) -> None:
        start, end = motion_of(linkage)

        def curve(theta2):
            return np.nan_to_num(np.cos(solve_position(linkage, theta2).theta3))

        def part(low, high):
            return scipy.integrate.quad(lambda theta2: float(curve(theta2)), low, high, limit=100)[0]

        mean, error = mean_over(linkage, curve, start, end)
        parts = [part(*ends) for ends in pairwise(np.linspace(start, end, 9))]
        assert error < 1e-8
        assert float(mean) == pytest.approx(sum(parts) / (end - start), abs=1e-7)

    check()


@pytest.mark.parametrize("kind", CLASSES)
def test_fits_and_straightness_are_those_of_dense_samples(linkages, kind) -> None:
    @settings(max_examples=2)
    @given(linkages(kind))
    def check(linkage) -> None:
        start, end = motion_of(linkage)
        end = start + 0.8 * (end - start)  # from a dead position on, where the driver swings
        even = np.linspace(start, end, 10001)[1:]
        p = solve_position(linkage, even).p
        fitted = np.stack([np.polynomial.Polynomial.fit(even, row, 4)(even) for row in p.T], axis=-1)
        r2 = 1 - ((p - fitted) ** 2).sum() / ((p - p.mean(axis=0)) ** 2).sum()
        assert coupler_fit_r2(linkage, start, end) == pytest.approx(r2, abs=2e-4)
        line = straightness(linkage, start, end)
        p = solve_position(linkage, dense(start, end)[1:]).p
        step = np.hypot(*np.diff(p, axis=0).T)
        middle = (p[1:] + p[:-1]) / 2
        centre = (step[:, None] * middle).sum(axis=0) / step.sum()
        spread = np.cov((middle - centre).T, aweights=step)
        normal = np.linalg.eigh(spread)[1][:, 0]
        across = (p - centre) @ normal
        size = float(linkage.lengths.sum())
        assert line.width == pytest.approx(np.ptp(across), abs=2e-3 * size)

    check()


@pytest.mark.parametrize("kind", CLASSES)
def test_links_have_one_velocity_in_their_instant_centre(linkages, kind) -> None:
    @few
    @given(linkages(kind), st.floats(0.2, 0.8))
    def check(linkage, share) -> None:
        low, high = driver_ranges(linkage)[0]
        theta2 = float(low + (high - low) * share)
        state, centres = solve_kinematics(linkage, theta2), instant_centres(linkage, theta2)
        size = float(linkage.lengths.sum())

        def velocity(link, place):
            arm = complex(*(place - state.point(link, (0, 0)).position))
            turned = arm * 1j * state.angular(link)[1]
            return state.point(link, (0, 0)).velocity + np.array([turned.real, turned.imag])

        if np.isfinite(centres.i13).all() and np.abs(centres.i13).max() < 1e4 * size:
            assert np.abs(velocity(3, centres.i13)).max() < 1e-7 * size
        if np.isfinite(centres.i24).all() and np.abs(centres.i24).max() < 1e4 * size:
            two, four = velocity(2, centres.i24), velocity(4, centres.i24)
            assert np.abs(two - four).max() < 1e-7 * (size + np.abs(two).max())
        assert np.isnan(centres.i14).all() == isinstance(linkage, SliderCrank)
        assert np.isnan(centres.i34).all() == isinstance(linkage, InvertedSliderCrank)

    check()


# What is of linkages alone, and what is at driver angles.
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


@pytest.mark.parametrize("kind", [*CLASSES[:2], GrashofClass.CRANK_SHAPER])
def test_a_batch_is_its_linkages_one_by_one(linkages, kind) -> None:
    @settings(max_examples=3)
    @given(linkages(kind), linkages(kind))
    def check(one, other) -> None:
        batch = type(one)(*(np.stack(pair) for pair in zip(one.parameters, other.parameters, strict=True)))
        theta2 = np.linspace(-3, 3, 7)
        for row, linkage in enumerate((one, other)):
            for of in OF_LINKAGES:
                assert np.array_equal(of(batch)[row], of(linkage), equal_nan=True)
            for of in AT_ANGLES:
                assert np.array_equal(of(batch[:, None], theta2)[row], of(linkage, theta2), equal_nan=True)

    check()
