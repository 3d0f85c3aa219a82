"""Instant centres, centrodes that roll on each other, circles of points without curvature or acceleration."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_linkages import FOUR_BAR_CLASSES, of_each_class
from hypothesis import assume
from hypothesis import strategies as st
from scipy.integrate import quad

from grashof.analysis import (
    centrodes,
    coupler_circles,
    driver_ranges,
    instant_centres,
    solve_kinematics,
    solve_position,
)
from grashof.problems import FourBar

JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)


def carrying(linkage: FourBar, theta2: float, place: np.ndarray) -> FourBar:
    """The linkage with P at the point of the coupler that lies at a place."""
    state = solve_position(linkage, theta2)
    arm = complex(*(place - state.a)) * np.exp(-1j * state.theta3)
    return replace(linkage, coupler_point=(arm.real, arm.imag))


@of_each_class(*FOUR_BAR_CLASSES, share=st.floats(0.02, 0.97), angle=st.floats(0.3, 6.0))
def test_points_of_the_circles(linkage: FourBar, share: float, angle: float) -> None:
    low, high = driver_ranges(linkage)[0]
    theta2 = float(low + (high - low) * share)
    stands = solve_position(linkage, theta2)
    assume(abs(np.sin(stands.theta4 - stands.theta3)) > 0.01)
    state, found = solve_kinematics(linkage, theta2), coupler_circles(linkage, theta2)
    assume(abs(state.omega3) > 0.01 and abs(state.alpha3) > 0.01)
    assume(1e-3 < found.inflection_diameter < 1e3 * float(linkage.r1))
    np.testing.assert_allclose(found.pole, instant_centres(linkage, theta2).i13, rtol=1e-7, atol=1e-7)
    way = np.array([np.cos(angle), np.sin(angle)])
    on_circle = carrying(linkage, theta2, found.inflection + found.inflection_diameter / 2 * way)
    p = solve_kinematics(on_circle, theta2).p
    across = p.velocity[0] * p.acceleration[1] - p.velocity[1] * p.acceleration[0]
    assert abs(across) < 1e-7 * float(p.speed) * (np.hypot(*p.acceleration) + p.speed)
    even = carrying(linkage, theta2, found.bresse + found.bresse_diameter / 2 * way)
    p = solve_kinematics(even, theta2).p
    assert abs(p.velocity @ p.acceleration) < 1e-7 * float(p.speed) * (np.hypot(*p.acceleration) + p.speed)
    still = solve_kinematics(carrying(linkage, theta2, found.acceleration_pole), theta2).p
    scale = float(state.omega3**2 + abs(state.alpha3)) * (found.inflection_diameter + float(linkage.r2))
    assert np.abs(still.acceleration).max() < 1e-7 * scale


def test_euler_and_savary() -> None:
    """A turns about O2, B about O4, any point about the centre of its path: PX^2 = XC . XJ on its ray."""
    theta2 = 1.1
    state, found = solve_kinematics(JACK, theta2), coupler_circles(JACK, theta2)
    diameter = 2 * (found.inflection - found.pole)
    for point, centre in ((state.a.position, JACK.o2), (state.b.position, JACK.o4)):
        ray = point - found.pole
        unit = ray / np.hypot(*ray)
        inflection = found.pole + (diameter @ unit) * unit
        along_j, along_c = (inflection - point) @ unit, (centre - point) @ unit
        assert ray @ ray == pytest.approx(along_j * along_c, rel=1e-12)


@pytest.mark.parametrize(("start", "end"), [(1.3, 2.6), (5.0, 6.0)])
def test_the_moving_centrode_rolls_on_the_fixed_one(start: float, end: float) -> None:
    step = 1e-5

    def speed(theta2: float, name: str) -> float:
        ahead, behind = (getattr(centrodes(JACK, theta2 + s), name) for s in (step, -step))
        return float(np.hypot(*(ahead - behind)) / (2 * step))

    lengths = [quad(speed, start, end, args=(name,), epsrel=1e-9)[0] for name in ("fixed", "moving")]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-8)
    assert lengths[0] > 0.5


def test_centrodes_of_a_crossed_parallelogram_are_ellipses() -> None:
    crossed = FourBar(o2=(0, 0), o4=(2, 0), r2=3, r3=2, r4=3, assembly=-1)
    found = centrodes(crossed, np.linspace(0.3, 2.9, 20))
    for track in (found.fixed, found.moving):
        foci = np.hypot(*track.T) + np.hypot(*(track - (2, 0)).T)
        np.testing.assert_allclose(foci, 3, rtol=1e-12)


def test_a_coupler_that_does_not_turn_has_its_pole_at_infinity() -> None:
    parallelogram = FourBar(o2=(0, 0), o4=(3, 0), r2=2, r3=3, r4=2)
    found = coupler_circles(parallelogram, [0.5, 1.0])
    assert not np.isfinite(found.pole).any()
    assert not np.isfinite(centrodes(parallelogram, [0.5, 1.0]).fixed).all(axis=-1).any()


def test_parallel_lines_meet_nowhere() -> None:
    parallelogram = FourBar(o2=(0, 0), o4=(3, 0), r2=1, r3=3, r4=1, assembly=1)
    centres = instant_centres(parallelogram, np.pi / 2)
    np.testing.assert_allclose(centres.i34, [3, 1], atol=1e-12)
    assert not np.isfinite(centres.i13).all() or np.abs(centres.i13).max() > 1e12
    assert instant_centres(parallelogram, np.zeros((4, 1))).i24.shape == (4, 1, 2)
