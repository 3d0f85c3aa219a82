"""Transmission angles compared with published figures, worst values with fine sweeps."""

from typing import Any

import numpy as np
import pytest
from drawn_linkages import FOUR_BAR_CLASSES, close_loop, of_each_class
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, transmission_angle, worst_transmission, worst_transmission_cycle
from grashof.analysis.mechanism.transmission import quality
from grashof.problems import FourBar

TURN = 2 * np.pi
SPANS = st.one_of(st.floats(-0.3, 0.3), st.floats(-1.2 * TURN, 1.2 * TURN))


def least_of_sweep(linkage: FourBar, start: float, end: float) -> tuple[float, float]:
    """Least min(mu, pi - mu) of a fine sweep, 0 where the loop is open, and the error of that."""
    a, b, _ = close_loop(linkage, np.linspace(start, end, 20001), 1)
    product = (b - a) * (b - complex(*linkage.o4)).conj()
    acute = np.arctan2(np.abs(product.imag), np.abs(product.real))
    acute = np.where(np.isfinite(acute), acute, 0.0)
    lowest = int(np.argmin(acute))
    return float(acute[lowest]), float(np.ptp(acute[max(lowest - 1, 0) : lowest + 2]))


def test_every_state_of_the_reference_figures(
    golden_states: list[Any], golden_linkages: dict[str, FourBar]
) -> None:
    for name, _, _, expected in golden_states:
        mu = transmission_angle(golden_linkages[name], np.radians(float(expected["theta2_deg"])))
        assert np.degrees(mu) == pytest.approx(float(expected["mu_deg"]), rel=1e-12)


def test_worst_over_the_turn_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    for name, section in {
        "pumpjack": "pumpjack_report_geometry", "lufkin": "pumpjack_lufkin_C912D_427_144",
        "bag": "bag_mechanism_exact", "table7": "table7_lengths_theta1_0",
    }.items():  # fmt: skip
        linkage, figures = golden_linkages[name], golden[section]
        given = figures.get("mu_full_rev_deg") or (figures["mu_min_deg"], figures["mu_max_deg"])
        low, high = map(float, given)
        at_extremes = np.degrees(transmission_angle(linkage, linkage.theta1 + np.array([0, np.pi])))
        np.testing.assert_allclose(np.sort(at_extremes), [low, high], rtol=1e-12)
        worst = min(low, 180 - high)
        assert np.degrees(worst_transmission_cycle(linkage)) == pytest.approx(worst, rel=1e-12)


@of_each_class(*FOUR_BAR_CLASSES, examples=8, start=st.floats(-2 * TURN, 2 * TURN), span=SPANS)
def test_worst_angles_are_the_least_of_a_sweep(
    linkage: FourBar, kind: GrashofClass, start: float, span: float
) -> None:
    worst = float(worst_transmission(linkage, start, start + span))
    swept, step = least_of_sweep(linkage, start, start + span)
    # Near 0 the sweep's own arc cosine has half its digits.
    rounding = 1e-12 if swept > 1e-6 else 1e-6
    assert swept - step - rounding <= worst <= swept + rounding
    assert worst == worst_transmission(linkage, start + span, start)
    worst = float(worst_transmission_cycle(linkage))
    if kind is GrashofClass.CHANGE_POINT:
        assert worst < 1e-6
    elif kind in (GrashofClass.CRANK_ROCKER, GrashofClass.DOUBLE_CRANK):
        swept, step = least_of_sweep(linkage, start, start + TURN)
        assert 0 < swept - step - 1e-12 <= worst <= swept + 1e-12
    else:
        assert worst == 0
    for span in (TURN * (1 + 1e-12), -1.5 * TURN, 7.3 * TURN):
        assert worst_transmission(linkage, start, start + span) == pytest.approx(worst, rel=1e-12)


@pytest.mark.parametrize(("theta1", "assembly"), [(0.0, 1), (-2.9, -1)])
def test_extremes_inside_an_interval_are_found(theta1: float, assembly: int) -> None:
    o4 = 4 * np.array([np.cos(theta1), np.sin(theta1)])
    linkage = FourBar(o2=(0, 0), o4=o4, r2=1, r3=3, r4=2.6, assembly=assembly)
    folded, stretched, away, late = quality(
        transmission_angle(linkage, theta1 + np.array([0, np.pi, 0.6, 2]))
    )
    assert stretched < folded < away
    for turns in TURN * np.arange(-2, 3):
        for start, end, worst in (
            (-0.3, 0.4, folded), (0.4, -0.3, folded), (0, 0.2, folded), (-0.2, 0, folded),
            (3, 3.3, stretched), (-0.3, 3.3, stretched), (3, 6.4, stretched), (np.pi, np.pi, stretched),
            (0.6, 0.8, away), (0.8, 0.6, away), (2, 2, late),
        ):  # fmt: skip
            found = worst_transmission(linkage, theta1 + turns + start, theta1 + turns + end)
            assert found == pytest.approx(worst, rel=1e-9)


def test_transmission_angle_is_nan_where_the_linkage_cannot_close() -> None:
    triple_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)  # swings 108.21 deg either way
    mu = transmission_angle(triple_rocker, np.radians([108.3, 180, -108.3, 108.1, 0, -108.1]))
    assert np.isnan(mu).tolist() == [True] * 3 + [False] * 3
