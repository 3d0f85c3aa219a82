"""Rates of cylinders by the angle of link 4, against differences of places and angles of meeting circles."""

import numpy as np
import pytest
from drawn_linkages import SMOOTH, of_each_class
from hypothesis import strategies as st

from grashof.analysis import driver_ranges, output_stroke, solve_position, verify
from grashof.analysis.cylinder.lengths import CylinderFigures, cylinder_figures, cylinder_state
from grashof.analysis.cylinder.travel import Travel, travel
from grashof.analysis.judge.measures import Values
from grashof.problems import (
    Cylinder,
    CylinderSpec,
    FourBar,
    InvertedSliderCrank,
    Linkage,
    MotionTask,
    Problem,
    ProblemError,
    Requirements,
    SliderCrank,
)
from grashof.problems.values.arrays import FloatArray

LINKS = ("driver", "coupler", "output")
RATES = ("start", "end", "min", "max")
FOUR_BAR = FourBar((0.3, -0.2), (4, 0.5), 1, 3.5, 3, (1, 1))
ROCKER = FourBar((0.3, -0.2), (4, 0.5), 2, 2.5, 3, (1, 1))
ENGINE = SliderCrank((0.3, -0.2), 1, 3, 0.4, 0.7, (1.5, 0.6))
SHAPER = InvertedSliderCrank((0.3, -0.2), (3, 0.5), 1.1, 0.3, (2.5, 0.6))


def moved_by(linkage: Linkage, theta2: FloatArray, assembly: tuple[int, ...] = (1, 1)) -> Travel:
    found = travel(linkage, theta2, np.array(assembly))
    assert found is not None
    return found


def by_circles(jack: Cylinder, theta2: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lengths of a cylinder on link 2, 3 or 4 of `FOUR_BAR`, and theta4, from two circles that meet in B."""
    o2, o4 = complex(*FOUR_BAR.o2), complex(*FOUR_BAR.o4)
    r2, r3, r4 = FOUR_BAR.r2, FOUR_BAR.r3, FOUR_BAR.r4
    a = o2 + r2 * np.exp(1j * theta2)
    between, far = (o4 - a) / np.abs(o4 - a), np.abs(o4 - a)
    foot = (far**2 + r3**2 - r4**2) / (2 * far)
    both = [a + between * (foot + 1j * side * np.sqrt(r3**2 - foot**2)) for side in (1, -1)]
    b = min(both, key=lambda b: float(np.abs(b - solve_position(FOUR_BAR, theta2).b @ [1, 1j]).max()))
    axes = {"driver": (o2, a - o2), "coupler": (a, b - a), "output": (o4, b - o4)}
    origin, axis = axes[jack.on]
    pivot = origin + complex(*jack.point) * axis / np.abs(axis)
    return np.abs(pivot - complex(*jack.base)), np.unwrap(np.angle(b - o4))


@pytest.mark.parametrize("on", LINKS)
def test_the_rate_is_the_quotient_of_differences(on: str) -> None:
    jack, theta2, step = Cylinder(on, (-1, -2.5), (0.8, -0.6)), np.linspace(0.3, 6.1, 39), 1e-5
    ahead, behind = (by_circles(jack, theta2 + side * step) for side in (1, -1))
    found = cylinder_state(jack, FOUR_BAR, solve_position(FOUR_BAR, theta2))
    rate = (ahead[0] - behind[0]) / (ahead[1] - behind[1])
    np.testing.assert_allclose(found.output_rate, rate, rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize("assembly", [1, -1])
@pytest.mark.parametrize("on", LINKS)
def test_the_rate_is_that_of_the_angle_of_the_rod_of_an_inverted_slider_crank(on: str, assembly: int) -> None:
    jack, theta2, step = Cylinder(on, (-1, -2.5), (0.8, -0.6)), np.linspace(0.3, 6.1, 39), 1e-5
    here, ahead, behind = (solve_position(SHAPER, theta2 + k, assembly) for k in (0, step, -step))
    away = [cylinder_state(jack, SHAPER, at).length for at in (ahead, behind)]
    turned = np.unwrap(np.stack([behind.theta4, ahead.theta4]), axis=0)
    rate = (away[0] - away[1]) / (turned[1] - turned[0])
    np.testing.assert_allclose(cylinder_state(jack, SHAPER, here).output_rate, rate, rtol=1e-6, atol=1e-8)


def test_on_link_4_it_is_the_arm_of_the_cylinder_s_line_about_o4() -> None:
    jack, theta2 = Cylinder("output", (6, -3), (1.4, 0.5)), np.linspace(0, 6, 25)
    found = cylinder_state(jack, FOUR_BAR, solve_position(FOUR_BAR, theta2))
    line = (found.pivot - np.array(jack.base)) / found.length[:, None]
    to_o4 = np.array(FOUR_BAR.o4) - np.array(jack.base)
    arm = np.abs(line[:, 0] * to_o4[1] - line[:, 1] * to_o4[0])
    np.testing.assert_allclose(np.abs(found.output_rate), arm, rtol=1e-12)


def dense(jack: Cylinder, moved: Travel) -> tuple[CylinderFigures, FloatArray]:
    """The figures, and magnitudes of the rate by differences at many places."""
    at = np.linspace(moved.start, moved.end, 4001)
    place = moved.at(at)
    change = np.gradient(cylinder_state(jack, moved.linkage, place).length)
    turn = np.gradient(np.unwrap(place.theta4))
    with np.errstate(divide="ignore"):
        return cylinder_figures(jack, moved), np.abs(change / turn)[1:-1]


places = st.tuples(st.floats(-3, 3), st.floats(-3, 3))
parts = st.sampled_from([(0.05, 0.3), (0.9, 0.4), (0.2, 0.93), (0.51, 0.5)])  # of the range of the driver


@of_each_class(*SMOOTH, examples=3, on=st.sampled_from(LINKS), base=places, point=places, ends=parts)
def test_extremes_are_those_of_dense_differences(
    linkage: FourBar,
    on: str,
    base: tuple[float, float],
    point: tuple[float, float],
    ends: tuple[float, float],
) -> None:
    low, high = driver_ranges(linkage)[0]
    size, moved = float(linkage.r2), moved_by(linkage, low + (high - low) * np.array(ends))
    jack = Cylinder(on, tuple(size * np.array(base)), tuple(size * np.array(point)))
    found, rates = dense(jack, moved)
    if not found.monotone:
        assert (found.rate_min, found.rate_max) == (0, np.inf)
        return
    turns_back = np.ptp(np.sign(np.diff(np.unwrap(moved.at(moved.places).theta4)))) > 0
    assert found.rate_min <= min(found.rate_start, found.rate_end) * (1 + 1e-9)
    assert found.rate_min <= rates.min() * (1 + 1e-4) + 1e-9 * size
    assert found.rate_min >= 0.9 * rates.min() - 1e-2 * size
    if turns_back:
        assert found.rate_max == np.inf
    else:
        assert found.rate_max >= rates.max() * (1 - 1e-4)
        assert max(found.rate_start, found.rate_end) <= found.rate_max * (1 + 1e-9)


def test_rates_are_finite_through_a_dead_position_of_link_2() -> None:
    high = float(driver_ranges(ROCKER)[0, 1])
    moved = moved_by(ROCKER, np.array([high - 0.2, high - 0.2]), (1, -1))
    found, rates = dense(Cylinder("output", (7, -4), (1.5, 0.2)), moved)
    assert found.monotone
    assert (found.rate_min, found.rate_max) == pytest.approx((rates.min(), rates.max()), rel=1e-3)
    ends = cylinder_state(Cylinder("output", (7, -4), (1.5, 0.2)), ROCKER, moved.at(moved.targets))
    assert (found.rate_start, found.rate_end) == pytest.approx(np.abs(ends.output_rate), rel=1e-12)


@pytest.mark.parametrize("on", ["driver", "coupler"])
def test_the_rate_has_no_bound_where_link_4_turns_back_or_does_not_turn(on: str) -> None:
    turning = float(output_stroke(FOUR_BAR).theta2[0])
    jack = Cylinder(on, (-3, 1.5), (0.9, 0.2))
    through = cylinder_figures(jack, moved_by(FOUR_BAR, turning + np.array([-0.2, 0.2])))
    before = cylinder_figures(jack, moved_by(FOUR_BAR, turning + np.array([-0.2, -0.1])))
    assert through.monotone
    assert through.rate_max == np.inf
    assert 0 < through.rate_min < np.inf
    assert before.rate_max < np.inf
    still = cylinder_figures(jack, moved_by(ENGINE, np.array([1.0, 1.4])))
    assert still.rate_max == np.inf


def asked(linkage: Linkage, theta2: FloatArray, limits: tuple[float, float] | None) -> Problem:
    at = solve_position(linkage, theta2)
    return Problem(
        task=MotionTask(at.p, at.theta3),
        requirements=Requirements(rotatability="any", cylinder_rate=limits),
        mechanism=linkage.mechanism.word,
        driver=CylinderSpec(),
    )


def test_the_judge_limits_it_on_either_side_and_lists_it() -> None:
    jack, theta2 = Cylinder("driver", (-3, 0.6), (0.8, -0.6)), np.radians([90.0, 115.0, 140.0])
    found = cylinder_figures(jack, moved_by(FOUR_BAR, theta2, (1, 1, 1)))

    def missed(low: float, high: float) -> list[float]:
        of = asked(FOUR_BAR, theta2, (low, high))
        verdict = verify(FOUR_BAR, of.task, of.requirements, problem=of, cylinder=jack)
        values = Values(FOUR_BAR, verdict, of)
        listed = [values[f"cylinder_rate_{name}"] for name in RATES]
        assert listed == pytest.approx([getattr(found, f"rate_{name}") for name in RATES], rel=1e-9)
        return [each.found for each in verdict.defects if each.requirement == "cylinder_rate"]

    least, most = found.rate_min, found.rate_max
    assert missed(0.99 * least, 1.01 * most) == []
    assert missed(1.01 * least, 1.01 * most) == [pytest.approx(least)]
    assert missed(0.0, 0.99 * most) == [pytest.approx(most)]
    assert missed(1.01 * least, 0.99 * most) == [pytest.approx(least), pytest.approx(most)]


def test_it_is_of_linkages_whose_link_4_turns() -> None:
    theta2 = np.radians([95.0, 115.0, 135.0])
    with pytest.raises(ProblemError, match=r"^requirements.cylinder_rate .*slider-crank"):
        asked(ENGINE, theta2, (1, 2))
    of, jack = asked(ENGINE, theta2, None), Cylinder("driver", (-1, -2.5), (0.8, -0.6))
    values = Values(ENGINE, verify(ENGINE, of.task, of.requirements, problem=of, cylinder=jack), of)
    assert np.isnan([values[f"cylinder_rate_{name}"] for name in RATES]).all()
