"""Extremes, strokes and boxes: published figures, fine sweeps, and curves with known answers."""

from collections.abc import Callable
from operator import attrgetter
from typing import Any

import numpy as np
import pytest
from drawn_linkages import of_each_class

from grashof.analysis import (
    Extremes,
    GrashofClass,
    dead_ends,
    driver_ranges,
    extremes,
    extremes_of,
    output_stroke,
    reach_box,
    solve_kinematics,
    solve_position,
    transmission_angle,
    transmission_extremes,
)
from grashof.analysis.mechanism.extremes import diagonal
from grashof.problems import AssemblyError, DeadPositionWarning, FourBar, ProblemError

TURN = 2 * np.pi
SPEED = TURN / 3
TURNING = (GrashofClass.CRANK_ROCKER, GrashofClass.DOUBLE_CRANK)
ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
CRANK_ROCKER = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)

QUANTITIES: dict[str, Callable[[Any], Any]] = {
    **{name: attrgetter(name) for name in ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")},
    "vB_mag": attrgetter("b.speed"),
    "aB_mag": attrgetter("b.acceleration_magnitude"),
    "P_x": lambda state: state.p.position[..., 0],
    "P_y": lambda state: state.p.position[..., 1],
}


@pytest.mark.parametrize("name", ["pumpjack", "lufkin"])
def test_extremes_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar], name: str
) -> None:
    section, key = {
        "pumpjack": ("pumpjack_report_geometry", "extremes_sigma+1"),
        "lufkin": ("pumpjack_lufkin_C912D_427_144", "extremes_20rpm_SI"),
    }[name]
    checked = 0
    for label, expected in golden[section][key].items():
        if not isinstance(expected, dict):
            continue
        quantity, side = label.replace("_unwrapped", "").rsplit("_", 1)
        period = TURN if quantity.startswith("theta") else None
        found = extremes(golden_linkages[name], QUANTITIES[quantity], SPEED, period=period)
        value, where = (found.high, found.at_high) if side == "max" else (found.low, found.at_low)
        largest = max(abs(found.low), abs(found.high))
        full_turns = TURN * np.round((value - float(expected["value"])) / TURN) if period else 0.0
        assert abs(value - full_turns - float(expected["value"])) <= 1e-12 * largest, label
        assert abs(np.degrees(where) % 360 - float(expected["theta2_deg"])) <= 1e-12 * 360, label
        checked += 1
    assert checked == {"pumpjack": 19, "lufkin": 8}[name]


def test_curves_with_known_extremes() -> None:
    found = extremes_of(lambda x: x**3 - x, -2, 2)
    assert found == Extremes(-6, 6, -2, 2)
    found = extremes_of(lambda x: x**3 - x, -1, 1)
    root = 1 / np.sqrt(3)
    np.testing.assert_allclose([found.at_low, found.at_high], [root, -root], rtol=1e-12)
    kinked = extremes_of(lambda x: np.abs(x - 0.123), -1, 1)
    assert kinked.at_low == pytest.approx(0.123, abs=1e-7)
    assert kinked.low == pytest.approx(0, abs=1e-7)
    assert extremes_of(lambda x: 0 * x + 3, 0, 1).stroke == 0
    # Across the ends of a closed curve.
    across = extremes_of(lambda x: np.cos(x - 1e-5), 0, TURN, closed=True)
    assert across.at_high % TURN == pytest.approx(1e-5, abs=1e-12)
    assert across.high == 1


def test_extremes_of_a_rocking_driver_end_in_its_dead_positions() -> None:
    with pytest.warns(DeadPositionWarning):
        found = extremes(ROCKER, lambda state: state.omega4)
    assert {abs(found.low), abs(found.high)} == {np.inf}
    swing = extremes(ROCKER, lambda state: state.theta4, start=-1.0, end=1.0)
    angles = solve_kinematics(ROCKER, np.linspace(-1, 1, 10001)).theta4
    assert swing.low == pytest.approx(angles.min(), abs=1e-7)
    assert swing.high == pytest.approx(angles.max(), abs=1e-7)


@pytest.mark.parametrize(
    ("linkage", "expected"),
    [
        (FourBar((0, 0), (4, 0), 2, 2, 3), [(None, 180.0)]),  # through theta1: stretched at both ends
        (FourBar((1, 2), (5, 2), 2, 4.5, 2.499), [(0.0, None)]),  # through theta1 + pi: folded
        (FourBar((0, 0), (4, 0), 3, 1, 3), [(0.0, 180.0), (0.0, 180.0)]),
        (FourBar((0, 0), (0, 4), 2, 4.5, 2.5), [(0.0, None)]),  # a change point, folded
        (FourBar((0, 0), (4, 0), 1, 3, 2), [(None, 180.0)]),  # stretched
        (FourBar((0, 0), (4, 0), 1, 4, 1), [(0.0, 180.0)]),  # both
    ],
)
def test_mu_is_0_or_180_deg_at_dead_positions(
    linkage: FourBar, expected: list[tuple[float | None, float | None]]
) -> None:
    for (low, high), ends in zip(driver_ranges(linkage).tolist(), expected, strict=False):
        inner = transmission_angle(linkage, np.linspace(low, high, 5001)[1:-1])
        sampled = np.degrees([inner.min(), inner.max()])
        moved = low + TURN, high + TURN
        for start, end in ((low, high), dead_ends(linkage, low, high), (high, low), moved):
            found = transmission_extremes(linkage, start, end)
            for value, exact, close in zip(np.degrees([found.low, found.high]), ends, sampled, strict=True):
                assert value == (pytest.approx(close, abs=6e-4) if exact is None else exact)
            assert min(start, end) <= found.at_low <= max(start, end)


@of_each_class(*TURNING)
def test_mu_of_a_turn_is_outermost_on_the_ground_line(linkage: FourBar) -> None:
    found = transmission_extremes(linkage, 0.0, TURN)
    generic = extremes(linkage, lambda state: transmission_angle(linkage, state.theta2))
    assert (found.low, found.high) == pytest.approx((generic.low, generic.high), rel=1e-13)
    part = transmission_extremes(linkage, 0.3, 1.1)
    inner = transmission_angle(linkage, np.linspace(0.3, 1.1, 5001))
    assert (part.low, part.high) == pytest.approx((inner.min(), inner.max()), abs=1e-6)


def test_extremes_within_a_thousandth_of_a_radian() -> None:
    """Near a change point the output jerks between even samples: mu is 0.08 deg at worst."""
    linkage = FourBar((0, 0), (4, 0), 2, 4.5, 2.500005, (2, 1))
    assert np.degrees(transmission_extremes(linkage, 0.0, TURN).low) == pytest.approx(0.0764, abs=1e-4)
    for quantity in (lambda state: state.alpha4, lambda state: state.b.acceleration_magnitude):
        found = extremes(linkage, quantity)
        near = np.concatenate([sign * np.logspace(-7, -1, 10_001) for sign in (-1, 1)])
        values = quantity(solve_kinematics(linkage, np.concatenate([near, np.linspace(0.1, 6.2, 10_001)])))
        assert (found.low, found.high) == pytest.approx((values.min(), values.max()), rel=1e-6)
        assert found.low <= values.min()
        assert found.high >= values.max()


def test_bad_input_is_refused() -> None:
    theta4 = QUANTITIES["theta4"]
    with pytest.raises(ProblemError, match="give both or neither"):
        extremes(CRANK_ROCKER, theta4, start=1.0)
    with pytest.raises(ProblemError, match="start must be less than end"):
        extremes(CRANK_ROCKER, theta4, start=1.0, end=0.5)
    with pytest.raises(ProblemError, match="one value for each angle"):
        extremes(CRANK_ROCKER, lambda state: state.b.position)
    with pytest.raises(AssemblyError, match="at any driver angle"):
        extremes(FourBar((0, 0), (9, 0), 1, 1, 1), theta4)
    with pytest.raises(AssemblyError, match="no value at driver angle"):
        extremes(ROCKER, theta4, start=0.0, end=3.0)


def test_strokes_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    given_stroke = golden["pumpjack_report_geometry"]
    stroke = output_stroke(golden_linkages["pumpjack"])
    swept = extremes(golden_linkages["pumpjack"], QUANTITIES["theta4"], period=TURN).stroke
    for swing in (stroke.swing, swept):
        assert np.degrees(swing) == pytest.approx(float(given_stroke["rocker_swing_deg"]), rel=1e-12)
    assert stroke.chord == pytest.approx(float(given_stroke["chord_stroke_of_B"]), rel=1e-12)
    # The extremes of theta4, 246.76 and 72.50 deg.
    assert stroke.time_ratio == pytest.approx(1.0658, abs=1e-4)


def test_strokes_of_the_real_unit(golden: dict[str, Any]) -> None:
    unit = golden["pumpjack_lufkin_C912D_427_144"]
    size = {name: float(value) for name, value in unit["inputs_in"].items()}
    for radius, expected in unit["strokes"].items():
        linkage = FourBar(
            o2=(0, 0), o4=(size["I"], size["H"] - size["G"]), r2=float(radius), r3=size["P"], r4=size["C"]
        )
        stroke = output_stroke(linkage)
        assert np.degrees(stroke.swing) == pytest.approx(float(expected["swing_deg"]), rel=1e-12)
        assert size["A"] * stroke.swing == pytest.approx(float(expected["stroke_in"]), rel=1e-12)
        # psi: angle at O4 between B and O2.
        psi = np.degrees(np.abs(stroke.theta4 - linkage.theta1 - np.pi)) % 360
        psi = np.sort(np.minimum(psi, 360 - psi))
        ends = [float(expected["psi_t_deg"]), float(expected["psi_b_deg"])]
        np.testing.assert_allclose(psi, ends, rtol=1e-12)


def test_box_of_a_single_position_holds_every_point_of_the_linkage() -> None:
    """Of one that cannot close, the ground pivots."""
    # A at (1, 0), B where the circles of 4 about A and 3 about O4 meet: (11, sqrt(80)) / 3.
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(0, 5))
    box = reach_box(linkage, 0.0, 0.0)
    coupler = np.array([8, np.sqrt(80)]) / 12
    p = np.array([1, 0]) + 5 * np.array([-coupler[1], coupler[0]])
    np.testing.assert_allclose(box, [[p[0], 0], [4, p[1]]], atol=1e-12)
    assert diagonal(box) == pytest.approx(np.hypot(4 - p[0], p[1]), rel=1e-12)
    apart = FourBar(o2=(1, 2), o4=(10, -1), r2=1, r3=2, r4=2)
    assert reach_box(apart, 0.0, 1.0).tolist() == [[1.0, -1.0], [10.0, 2.0]]


@pytest.mark.parametrize("kite", [(30.0, 30.0, 30.0), (30.0, 35.0, 35.0)])
def test_box_of_a_kite_reaches_to_where_its_links_are_free(kite: tuple[float, float, float]) -> None:
    """A meets O4 in the middle of the motion, where B is undetermined; before that it was in front of O4."""
    linkage = FourBar(o2=(0, 0), o4=(30, 0), r2=kite[0], r3=kite[1], r4=kite[2], assembly=-1)
    box = reach_box(linkage, -3.0, 3.0)
    angles = np.concatenate([-np.geomspace(3.0, 1e-6, 4001), np.geomspace(1e-6, 3.0, 4001)])
    state = solve_position(linkage, angles)
    b = np.concatenate([state.a, state.b, state.p, [[0, 0], [30, 0]]])
    np.testing.assert_allclose(box, [b.min(axis=0), b.max(axis=0)], atol=2e-3)
    assert box[1, 0] == pytest.approx(30 + kite[2], abs=1e-3)
