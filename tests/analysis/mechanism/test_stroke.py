"""Strokes of the output: published figures, and the extremes of its angle."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, extremes, output_stroke, solve_kinematics
from grashof.problems import FourBar

CHECKED = settings(max_examples=20)
TURN = 2 * np.pi
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]


def test_strokes_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    given_stroke = golden["pumpjack_report_geometry"]
    stroke = output_stroke(golden_linkages["pumpjack"])
    assert np.degrees(stroke.swing) == pytest.approx(float(given_stroke["rocker_swing_deg"]), rel=1e-12)
    assert stroke.chord == pytest.approx(float(given_stroke["chord_stroke_of_B"]), rel=1e-12)
    arc = float(given_stroke["arc_stroke_horsehead_A=4.572m"])
    assert 4.572 * stroke.swing == pytest.approx(arc, rel=1e-12)
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


@given(data=st.data())
@CHECKED
def test_the_output_turns_back_where_the_angle_is_extreme(four_bars: Drawer, data: st.DataObject) -> None:
    linkage = data.draw(four_bars(GrashofClass.CRANK_ROCKER))
    stroke = output_stroke(linkage)
    state = solve_kinematics(linkage, stroke.theta2)
    assert np.abs(state.omega4).max() < 1e-10
    np.testing.assert_allclose(np.sin(stroke.theta4 - state.theta4), 0, atol=1e-12)
    swept = extremes(linkage, lambda state: state.theta4, period=TURN)
    assert stroke.swing == pytest.approx(swept.stroke, rel=1e-9)
    where = np.sort(np.array([swept.at_low, swept.at_high]) % TURN)
    apart = (np.sort(stroke.theta2) - where + np.pi) % TURN - np.pi
    assert np.abs(apart).max() < 1e-9
    assert stroke.time_ratio >= 1


def test_an_output_that_turns_fully_has_no_stroke() -> None:
    double_crank = FourBar(o2=(0, 0), o4=(1, 0), r2=2.5, r3=2, r4=2.6)
    stroke = output_stroke(double_crank)
    assert np.isnan(stroke.swing)
    assert np.isnan(stroke.theta2).all()
    assert np.isnan(stroke.time_ratio)
