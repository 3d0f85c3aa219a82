"""Values that grow without bound are cut off in plots, mere peaks are not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.problems import FourBar, LinkageSpec
from grashof.study.limits import broken_beyond, greatest_drawn, middle
from grashof.study.section import DRIVER_ANGLE, Plot
from grashof.survey import report_on

THETA2 = np.arange(361.0)
TURN = np.radians(THETA2)


def over_turn(values: np.ndarray, unit: str = "N") -> Plot:
    return Plot("p", "p", unit, {"a": np.asarray(values, dtype=float)}, THETA2)


@given(st.floats(0.01, 0.99), st.floats(1, 1e6))
def test_a_simple_pole_is_cut_wherever_it_lies(place: float, size: float) -> None:
    with np.errstate(divide="ignore"):
        pole = size / np.tan(TURN / 2 - np.pi * place)
    # Half of the turn the size of a cotangent is below 1.
    assert greatest_drawn(over_turn(pole)) == pytest.approx(12 * size, rel=0.02)


@pytest.mark.parametrize("unknown", [np.nan, np.inf, -np.inf])
def test_a_pole_that_is_met_is_cut(unknown: float) -> None:
    with np.errstate(divide="ignore"):
        pole = np.where(np.isin(THETA2, (0, 180, 360)), unknown, 1 / np.sin(TURN))
    assert np.isfinite(greatest_drawn(over_turn(pole)))


@given(st.floats(3, 60), st.floats(0, 360), st.floats(-1e3, 1e3))
def test_a_smooth_peak_is_drawn_completely(width: float, place: float, size: float) -> None:
    """However high above the rest, as an inertia torque near a bad transmission angle."""
    away = (THETA2 - place + 180) % 360 - 180
    peak = np.sin(TURN) + 1e3 * size / (1 + (away / width) ** 2) ** 2
    assert greatest_drawn(over_turn(peak)) == np.inf


@pytest.mark.parametrize("first", [20, 300])
@pytest.mark.parametrize("last", [30, 90])
def test_a_load_over_a_short_part_of_the_turn_is_drawn_completely(first: int, last: int) -> None:
    noise = 1e-13 * np.random.default_rng(0).normal(size=361)
    pressed = np.isin(THETA2, np.arange(first, first + last))
    assert greatest_drawn(over_turn(np.where(pressed, 1e5, noise))) == np.inf


@pytest.mark.parametrize(
    "values",
    [np.zeros(361), np.full(361, np.nan), np.full(361, -7.0), np.full(361, np.inf), 1e300 * np.sin(TURN)],
)
def test_values_without_a_typical_size_are_drawn_completely(values: np.ndarray) -> None:
    assert greatest_drawn(over_turn(values)) == np.inf


def test_nothing_is_cut_of_nothing_or_of_angles() -> None:
    assert greatest_drawn(Plot("p", "p", "", {}, THETA2)) == np.inf
    assert greatest_drawn(Plot("p", "p", "", {})) == np.inf
    assert greatest_drawn(over_turn(1 / np.sin(TURN + 1e-9), "deg")) == np.inf


def test_rates_between_dead_positions_are_cut() -> None:
    report = report_on(LinkageSpec(FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)), "rocker"))
    table = report.tables["kinematics"]
    first = table[table["range"] == 1]
    places, omega3 = (first[name].to_numpy() for name in ("theta2_deg", "omega3"))
    plot = Plot("p", "p", "rad/s", {"omega3": omega3}, places)
    assert plot.swings
    assert greatest_drawn(plot) == pytest.approx(12 * np.nanmedian(np.abs(omega3)))
    turned = Plot("p", "p", "rad/s", {"omega3": omega3}, places, "time (s)")
    assert not turned.swings


@pytest.mark.parametrize(
    ("places", "swings"),
    [
        (THETA2, False),
        (-THETA2, False),
        (THETA2 * 2, False),
        (THETA2 / 2, True),
        (np.append(THETA2, np.nan), True),
        (np.zeros(0), False),
    ],
)
def test_a_driver_swings_where_its_angles_are_not_a_full_turn(places: np.ndarray, swings: bool) -> None:
    assert Plot("p", "p", "", {"a": np.zeros_like(places)}, places, DRIVER_ANGLE).swings is swings


def test_tracks_that_go_to_infinity_are_shown_where_they_mostly_are() -> None:
    parabola = np.column_stack([np.tan(TURN / 2 + 1e-9), np.tan(TURN / 2 + 1e-9) ** 2 / 10])
    plot = Plot("p", "p", "m", {"fixed": parabola})
    most = greatest_drawn(plot)
    away = np.hypot(*(parabola - middle(plot)).T)
    assert most == pytest.approx(4 * np.median(away), rel=1e-6)
    circle = np.column_stack([1e3 + np.cos(TURN), np.sin(TURN)])
    assert greatest_drawn(Plot("p", "p", "m", {"circle": circle})) == np.inf
    assert middle(Plot("p", "p", "m", {"circle": circle})) == pytest.approx((1e3, 0), abs=0.02)


def test_lines_break_where_they_jump_through_infinity() -> None:
    values = np.array([1.0, 50, -50, -1, 2, 30, 40, 3])
    np.testing.assert_array_equal(broken_beyond(values, 10), [1, np.nan, -50, -1, 2, 30, 40, 3])
    np.testing.assert_array_equal(broken_beyond(values, np.inf), values)


def test_bounded_values_are_drawn_completely_however_few_their_samples_are() -> None:
    """A peak between samples 5 deg apart is isolated like a pole."""
    place = np.arange(0.0, 481.0, 5.0)
    peak = 1 / (1 + ((place - 208) / 3) ** 2)
    coarse = Plot("p", "p", "N", {"a": peak}, place, "time (s)")
    assert np.isfinite(greatest_drawn(coarse))
    assert greatest_drawn(replace(coarse, bounded=True)) == np.inf
