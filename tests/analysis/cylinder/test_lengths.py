"""Lengths, rates and levers of cylinders on every kind; the motions they give, through dead positions."""

import numpy as np
import numpy.typing as npt
import pytest
from drawn_linkages import SMOOTH, of_each_class
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import (
    driver_ranges,
    full_rotation,
    output_stroke,
    solve_kinematics,
    solve_position,
)
from grashof.analysis.cylinder.lengths import cylinder_figures, cylinder_state
from grashof.analysis.cylinder.travel import Travel, travel
from grashof.problems import Cylinder, FourBar, InvertedSliderCrank, Linkage, SliderCrank

LINKS = ("driver", "coupler", "output")
CRANK = FourBar((0, 0), (4, 0), 1, 4, 3)
FOUR_BAR = FourBar((0.3, -0.2), (4, 0.5), 1, 3.5, 3, (1, 1))
ENGINE = SliderCrank((0.3, -0.2), 1, 3, 0.4, 0.7, (1.5, 0.6))
SHAPER = InvertedSliderCrank((0.3, -0.2), (3, 0.5), 1.1, 0.3, (2.5, 0.6))
# Their drivers swing.
FOUR_BAR_ROCKER = FourBar((0.3, -0.2), (4, 0.5), 2, 2.5, 3, (1, 1))
TRIPLE_ROCKER = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))
ROCKER = SliderCrank((0.3, -0.2), 2, 1.5, 0.2, 0.7, (1, 0.6))
SWINGING = InvertedSliderCrank((0.3, -0.2), (2, 0.5), 1.5, 0.9, (2, 0.6))

places = st.tuples(st.floats(-3, 3), st.floats(-3, 3))
parts = st.sampled_from([(0.05, 0.3), (0.9, 0.4), (0.2, 0.93), (0.51, 0.5)])  # of the range of the driver


def moved_by(linkage: Linkage, theta2: npt.ArrayLike, assembly: list[int] | None = None) -> Travel:
    """The motion through targets, on the linkage's own assembly unless others are given."""
    angles = np.asarray(theta2)
    signs = np.full(len(angles), int(linkage.assembly)) if assembly is None else np.array(assembly)
    found = travel(linkage, angles, signs)
    assert found is not None
    assert len(found.dead) == (len(set(signs.tolist())) > 1)
    return found


def there_and_back(linkage: Linkage, short: float = 0.2) -> Travel:
    """To the end of the driver's range, a dead position, and back on the other assembly."""
    high = float(driver_ranges(linkage)[0, 1])
    return moved_by(linkage, [high - short, high - short], [1, -1])


def test_on_link_2_it_is_a_triangle_with_a_variable_side() -> None:
    theta2 = np.linspace(0.3, 1.4, 23)
    jack = Cylinder("driver", base=(-1.2, -1.5), point=(1.1, 0.4))
    found = cylinder_state(jack, FOUR_BAR_ROCKER, solve_position(FOUR_BAR_ROCKER, theta2))
    arm, far = np.hypot(1.1, 0.4), np.hypot(1.5, 1.3)
    at_o2 = theta2 + np.arctan2(0.4, 1.1) - np.arctan2(-1.3, -1.5)
    np.testing.assert_allclose(found.length**2, arm**2 + far**2 - 2 * arm * far * np.cos(at_o2), rtol=1e-13)
    sine = far * np.abs(np.sin(at_o2)) / found.length  # of the angle at Q
    np.testing.assert_allclose(np.sin(found.angle), sine, rtol=1e-12)
    np.testing.assert_allclose(np.abs(found.rate), arm * sine, rtol=1e-12)


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


@settings(max_examples=12)
@given(st.sampled_from([ROCKER, SWINGING]), st.sampled_from(LINKS[1:]), places, places)
def test_levers_are_smooth_through_dead_positions(
    linkage: Linkage, on: str, base: tuple[float, float], point: tuple[float, float]
) -> None:
    """Against differences of the places over a parameter that has no dead position."""
    assert not full_rotation(linkage)
    moved = there_and_back(linkage)
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


@of_each_class(*SMOOTH, examples=3, on=st.sampled_from(LINKS), base=places, point=places, ends=parts)
def test_extremes_are_those_of_dense_samples(
    linkage: FourBar,
    on: str,
    base: tuple[float, float],
    point: tuple[float, float],
    ends: tuple[float, float],
) -> None:
    low, high = driver_ranges(linkage)[0]
    size, moved = float(linkage.r2), moved_by(linkage, low + (high - low) * np.array(ends))
    jack = Cylinder(on, tuple(size * np.array(base)), tuple(size * np.array(point)))
    found = cylinder_figures(jack, moved)
    dense = cylinder_state(jack, moved.linkage, moved.at(np.linspace(moved.start, moved.end, 4001)))
    assert dense.length.min() - 1e-2 * size <= found.closed <= dense.length.min() + 1e-9 * size
    assert found.open >= dense.length.max() - 1e-9 * size
    one_way = bool((dense.lever > 0).all() or (dense.lever < 0).all())
    if found.monotone:
        assert one_way
        assert found.angle_min <= dense.angle.min() + 1e-9
        outer = dense.length[[0, -1]]
        assert (found.closed, found.open) == pytest.approx((outer.min(), outer.max()), rel=1e-9)
    else:
        assert found.angle_min == 0


def test_a_cylinder_that_reverses_or_whose_pivot_rests_does_not_drive() -> None:
    assert full_rotation(CRANK)
    found = cylinder_figures(Cylinder("driver", (3, 0), (1, 0)), moved_by(CRANK, [-0.6, 0.9]))
    assert (found.monotone, found.angle_min) == (False, 0.0)  # in line with its arm at 0
    assert found.closed == pytest.approx(2.0, rel=1e-12)
    moved = moved_by(FOUR_BAR_ROCKER, [0.4, 1.0])
    assert not cylinder_figures(Cylinder("driver", (3, 1), (0, 0)), moved).monotone


@pytest.mark.parametrize("on", ["coupler", "output"])
def test_a_dead_position_of_link_2_is_none_for_a_cylinder_on_links_3_and_4(on: str) -> None:
    moved = there_and_back(FOUR_BAR_ROCKER)
    found = cylinder_figures(Cylinder(on, (7, -4), (1.5, 0.2)), moved)
    assert found.monotone
    assert found.angle_min > 0.1
    on_link_2 = cylinder_figures(Cylinder("driver", (7, -4), (1.5, 0.2)), moved)
    assert not on_link_2.monotone  # link 2 turns back there, and its cylinder with it


def test_a_slider_goes_through_no_dead_position_of_its_own() -> None:
    high = float(driver_ranges(ROCKER)[0, 1])
    moved = moved_by(ROCKER, [high - 0.3, high - 0.1, high - 0.2], [1, 1, -1])
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
    for end, monotone in ((-1e-3, True), (1e-3, False)):
        moved = moved_by(linkage, [turning - 0.3, turning + end], [1, 1])
        assert cylinder_figures(jack, moved).monotone == monotone


def test_the_lever_angle_of_a_slider_is_its_way_s_to_the_cylinder() -> None:
    at = solve_position(ENGINE, np.linspace(0.4, 2.4, 9))
    jack = Cylinder("output", base=(-3, 2), point=(0.2, -0.4))
    found = cylinder_state(jack, ENGINE, at)
    out = found.pivot - np.array(jack.base)
    between = np.arctan2(out[:, 1], out[:, 0]) - 0.7
    np.testing.assert_allclose(np.sin(found.angle), np.abs(np.cos(between)), rtol=1e-12)


def test_places_are_driver_angles_where_link_2_turns_fully() -> None:
    moved = moved_by(CRANK, [0.5, 1.0, 2.0])
    assert (moved.turns, moved.start, moved.end, len(moved.dead)) == (True, 0.5, 2.0, 0)
    assert travel(CRANK, np.array([0.5, 2.0, 1.0]), np.array([1, 1, 1])) is None
    assert travel(CRANK, np.array([0.5, 1.0]), np.array([1, -1])) is None  # two circuits


@pytest.mark.parametrize("way", [1, -1])
def test_the_way_through_a_dead_position_is_smooth_and_meets_the_targets(way: int) -> None:
    high = float(driver_ranges(TRIPLE_ROCKER)[0, 1])
    theta2, assembly = np.array([high - 0.4, high - 0.1, high - 0.2])[::way], np.array([1, 1, -1])[::way]
    moved = moved_by(TRIPLE_ROCKER, theta2, assembly.tolist())
    at = moved.at(moved.targets)
    there = solve_position(TRIPLE_ROCKER, theta2, assembly)
    np.testing.assert_allclose(at.b, there.b, atol=1e-12)
    step = np.diff(moved.at(moved.places).b, axis=0)
    assert np.hypot(*step.T).max() < 0.02  # no leap from one assembly to the other
    turn = np.abs(np.diff(np.unwrap(np.arctan2(step[:, 1], step[:, 0]))))
    assert turn.max() < 0.05


def test_targets_out_of_order_are_no_motion() -> None:
    low, high = driver_ranges(TRIPLE_ROCKER)[0]
    middle = (low + high) / 2
    assert travel(TRIPLE_ROCKER, middle + np.array([0.0, 0.2, 0.1, 0.15]), np.array([1, 1, 1, 1])) is None
    assert (
        travel(TRIPLE_ROCKER, middle + np.array([0.0, 0.2, -3.0]), np.array([1, 1, 1])) is None
    )  # out of reach


def test_the_ends_of_a_motion_on_one_branch_are_kept() -> None:
    low, high = driver_ranges(TRIPLE_ROCKER)[0]
    theta2 = (low + high) / 2 + np.array([0.1, 0.3, -0.2])
    moved = travel(TRIPLE_ROCKER, theta2, np.array([1, 1, 1]), (theta2.min(), theta2.max()))
    assert moved is not None
    ends = moved.at([moved.start, moved.end]).theta2
    np.testing.assert_allclose(ends, [theta2.min(), theta2.max()], atol=1e-12)
