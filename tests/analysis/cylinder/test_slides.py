"""Cylinders on slider-cranks and inverted ones: velocities, dead and limit positions, what slides."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.analysis import (
    driver_ranges,
    full_rotation,
    output_stroke,
    solve_kinematics,
    solve_position,
)
from grashof.analysis.cylinder.lengths import cylinder_figures, cylinder_state
from grashof.analysis.cylinder.travel import travel
from grashof.problems import Cylinder, FourBar, InvertedSliderCrank, Linkage, SliderCrank

LINKS = ("driver", "coupler", "output")
FOUR_BAR = FourBar((0.3, -0.2), (4, 0.5), 1, 3.5, 3, (1, 1))
ENGINE = SliderCrank((0.3, -0.2), 1, 3, 0.4, 0.7, (1.5, 0.6))
SHAPER = InvertedSliderCrank((0.3, -0.2), (3, 0.5), 1.1, 0.3, (2.5, 0.6))
# Their drivers swing.
ROCKER = SliderCrank((0.3, -0.2), 2, 1.5, 0.2, 0.7, (1, 0.6))
SWINGING = InvertedSliderCrank((0.3, -0.2), (2, 0.5), 1.5, 0.9, (2, 0.6))

places = st.tuples(st.floats(-3, 3), st.floats(-3, 3))


@pytest.mark.parametrize("linkage", [FOUR_BAR, ENGINE, SHAPER])
@pytest.mark.parametrize("on", LINKS)
@pytest.mark.parametrize("assembly", [1, -1])
@pytest.mark.parametrize("sense", [2.0, -2.0])
def test_rate_and_lever_are_those_of_the_velocities(
    linkage: Linkage, on: str, assembly: int, sense: float
) -> None:
    jack = Cylinder(on, base=(-1, -2.5), point=(0.8, -0.6))
    state = solve_kinematics(linkage, np.linspace(0.3, 6.1, 39), sense, assembly=assembly)
    found, pivot = cylinder_state(jack, linkage, state), state.point(jack.link, jack.point)
    np.testing.assert_allclose(found.pivot, pivot.position, atol=1e-13)
    speed = ((pivot.position - np.array(jack.base)) * pivot.velocity).sum(axis=-1) / found.length
    np.testing.assert_allclose(found.rate * sense, speed, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(np.abs(found.lever), np.abs(speed) / pivot.speed, rtol=1e-10, atol=1e-12)


@given(st.sampled_from([ROCKER, SWINGING]), st.sampled_from(LINKS[1:]), places, places)
def test_levers_are_smooth_through_dead_positions(
    linkage: Linkage, on: str, base: tuple[float, float], point: tuple[float, float]
) -> None:
    """Against differences of the places over a parameter that has no dead position."""
    assert not full_rotation(linkage)
    high = float(driver_ranges(linkage)[0, 1])
    moved = travel(linkage, np.array([high - 0.2, high - 0.2]), np.array([1, -1]))
    assert moved is not None
    assert len(moved.dead) == 1
    at, step, jack = np.linspace(moved.start, moved.end, 41), 1e-5, Cylinder(on, base, point)
    ahead, here, behind = (
        cylinder_state(jack, linkage, moved.at(at + k)) for k in (step, np.zeros(41), -step)
    )
    way = np.hypot(*(ahead.pivot - behind.pivot).T)
    sound = (way > 1e-3 * way.max()) & (here.length > 0.05) & (way > 1e-8)
    slope = (ahead.length - behind.length)[sound] / way[sound]
    np.testing.assert_allclose(np.abs(here.lever)[sound], np.abs(slope), atol=1e-5)
    if sound.all() and np.abs(slope).min() > 1e-3:
        assert (np.diff(np.sign(here.lever)) == 0).all() == (np.diff(np.sign(slope)) == 0).all()


def test_a_slider_goes_through_no_dead_position_of_its_own() -> None:
    high = float(driver_ranges(ROCKER)[0, 1])
    moved = travel(ROCKER, np.array([high - 0.3, high - 0.1, high - 0.2]), np.array([1, 1, -1]))
    assert moved is not None
    assert len(moved.dead) == 1
    along = np.array([np.cos(0.7), np.sin(0.7)])
    base = tuple(moved.at(moved.start).b + 4 * along * np.sign(moved.at(0.0).b @ along + 1e-9))
    found = cylinder_figures(Cylinder("output", base, (0, 0)), moved)
    assert found.monotone
    assert np.degrees(found.angle_min) == pytest.approx(90, abs=1e-5)
    ends = moved.at([moved.start, moved.end]).b @ along
    assert found.stroke == pytest.approx(abs(ends[1] - ends[0]), rel=1e-12)
    assert not cylinder_figures(Cylinder("driver", base, (1, 0)), moved).monotone


@pytest.mark.parametrize("linkage", [ENGINE, SHAPER])
def test_link_4_turns_back_in_its_limit_positions(linkage: Linkage) -> None:
    turning = float(output_stroke(linkage).theta2[0])
    jack = Cylinder("output", base=(-4, -6), point=(0.3, 0.2))
    short = travel(linkage, turning + np.array([-0.3, -1e-3]), np.array([1, 1]))
    through = travel(linkage, turning + np.array([-0.3, 1e-3]), np.array([1, 1]))
    assert short is not None
    assert through is not None
    assert cylinder_figures(jack, short).monotone
    assert not cylinder_figures(jack, through).monotone


def test_the_lever_angle_of_a_slider_is_its_way_s_to_the_cylinder() -> None:
    at = solve_position(ENGINE, np.linspace(0.4, 2.4, 9))
    jack = Cylinder("output", base=(-3, 2), point=(0.2, -0.4))
    found = cylinder_state(jack, ENGINE, at)
    out = found.pivot - np.array(jack.base)
    between = np.arctan2(out[:, 1], out[:, 0]) - 0.7
    np.testing.assert_allclose(np.sin(found.angle), np.abs(np.cos(between)), rtol=1e-12)


def test_a_rod_in_its_block_is_a_cylinder_from_a_to_o4() -> None:
    """Where nothing is offset, the slide itself is a cylinder on link 2."""
    linkage = InvertedSliderCrank((0, 0), (3, 0), 1.2)
    theta2 = np.linspace(0.3, 2.5, 11)
    at = solve_position(linkage, theta2)
    found = cylinder_state(Cylinder("driver", (3, 0), (1.2, 0)), linkage, at)
    np.testing.assert_allclose(found.length, at.travel, rtol=1e-12)
    lever = np.abs(np.sin(at.theta2 - at.theta3))
    np.testing.assert_allclose(np.sin(found.angle), lever, rtol=1e-9)
