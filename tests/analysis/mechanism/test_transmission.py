"""Transmission angles compared with published figures, worst values with fine sweeps."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, transmission_angle, worst_transmission, worst_transmission_cycle
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.analysis.mechanism.transmission import quality
from grashof.problems import FourBar

CHECKED = settings(max_examples=8)
TURN = 2 * np.pi
Brute = Callable[..., tuple[npt.NDArray[np.complex128], ...]]
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
Sweep = Callable[[FourBar, float, float], tuple[float, float]]


@pytest.fixture(scope="module")
def least_of_sweep(close_loop: Brute) -> Sweep:
    """Least min(mu, pi - mu) of a fine sweep, 0 where the loop is open, and the error of that."""

    def sweep(linkage: FourBar, start: float, end: float) -> tuple[float, float]:
        a, b, _ = close_loop(linkage, np.linspace(start, end, 20001), 1)
        product = (b - a) * (b - complex(*linkage.o4)).conj()
        acute = np.arctan2(np.abs(product.imag), np.abs(product.real))
        acute = np.where(np.isfinite(acute), acute, 0.0)
        lowest = int(np.argmin(acute))
        return float(acute[lowest]), float(np.ptp(acute[max(lowest - 1, 0) : lowest + 2]))

    return sweep


def test_every_state_of_the_reference_figures(
    golden_states: list[Any], golden_linkages: dict[str, FourBar]
) -> None:
    for name, _, _, expected in golden_states:
        mu = transmission_angle(golden_linkages[name], np.radians(float(expected["theta2_deg"])))
        assert np.degrees(mu) == pytest.approx(float(expected["mu_deg"]), rel=1e-12)


def test_worst_over_the_turn_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    pumpjack, bag, table7, lufkin = (
        golden["pumpjack_report_geometry"],
        golden["bag_mechanism_exact"]["mu_full_rev_deg"],
        golden["table7_lengths_theta1_0"]["mu_full_rev_deg"],
        golden["pumpjack_lufkin_C912D_427_144"],
    )
    extremes = {
        "pumpjack": (pumpjack["mu_min_deg"], pumpjack["mu_max_deg"]),
        "lufkin": (lufkin["mu_min_deg"], lufkin["mu_max_deg"]),
        "bag": tuple(bag),
        "table7": tuple(table7),
    }
    for name, (low, high) in extremes.items():
        linkage = golden_linkages[name]
        at_extremes = np.degrees(transmission_angle(linkage, linkage.theta1 + np.array([0, np.pi])))
        np.testing.assert_allclose(np.sort(at_extremes), [float(low), float(high)], rtol=1e-12)
        worst = min(float(low), 180 - float(high))
        assert np.degrees(worst_transmission_cycle(linkage)) == pytest.approx(worst, rel=1e-12)
    assert float(pumpjack["mu_worst_folded_deg"]) == pytest.approx(
        np.degrees(worst_transmission_cycle(golden_linkages["pumpjack"])), rel=1e-12
    )


@pytest.mark.parametrize("kind", FOUR_BAR_CLASSES)
@given(data=st.data())
@CHECKED
def test_worst_over_an_interval_is_the_least_of_a_sweep(
    four_bars: Drawer,
    least_of_sweep: Sweep,
    kind: GrashofClass,
    data: st.DataObject,
) -> None:
    linkage = data.draw(four_bars(kind))
    start = data.draw(st.floats(-2 * TURN, 2 * TURN))
    end = start + data.draw(st.one_of(st.floats(-0.3, 0.3), st.floats(-1.2 * TURN, 1.2 * TURN)))
    worst = float(worst_transmission(linkage, start, end))
    swept, step = least_of_sweep(linkage, start, end)
    # Near 0 the sweep's own arc cosine has half its digits.
    rounding = 1e-12 if swept > 1e-6 else 1e-6
    assert swept - step - rounding <= worst <= swept + rounding
    assert worst == worst_transmission(linkage, end, start)


@pytest.mark.parametrize("kind", FOUR_BAR_CLASSES)
@given(data=st.data())
@CHECKED
def test_worst_over_the_turn_is_the_least_of_a_sweep(
    four_bars: Drawer,
    least_of_sweep: Sweep,
    kind: GrashofClass,
    data: st.DataObject,
) -> None:
    linkage = data.draw(four_bars(kind))
    worst = float(worst_transmission_cycle(linkage))
    start = data.draw(st.floats(-TURN, TURN))
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
    folded, stretched = (quality(transmission_angle(linkage, theta1 + angle)) for angle in (0, np.pi))
    assert stretched < folded < quality(transmission_angle(linkage, theta1 + 1))

    def worst(start: float, end: float) -> float:
        return float(worst_transmission(linkage, theta1 + start, theta1 + end))

    for count in (-2, -1, 0, 1, 2):
        turns = count * TURN
        assert worst(turns - 0.3, turns + 0.4) == pytest.approx(folded, rel=1e-12)
        assert worst(turns + 0.4, turns - 0.3) == pytest.approx(folded, rel=1e-12)
        assert worst(turns + 3, turns + 3.3) == pytest.approx(stretched, rel=1e-12)
        assert worst(turns - 0.3, turns + 3.3) == pytest.approx(stretched, rel=1e-12)
        assert worst(turns + 3, turns + TURN + 0.1) == pytest.approx(stretched, rel=1e-12)
        away = quality(transmission_angle(linkage, theta1 + np.array([0.2, 0.6])))
        assert worst(turns + 0.6, turns + 0.2) == pytest.approx(away.min(), rel=1e-9)
        assert worst(turns, turns + 0.2) == pytest.approx(folded, rel=1e-12)
        assert worst(turns - 0.2, turns) == pytest.approx(folded, rel=1e-12)
        assert worst(turns + np.pi, turns + np.pi) == pytest.approx(stretched, rel=1e-12)
        assert worst(turns + 2, turns + 2) == pytest.approx(
            quality(transmission_angle(linkage, theta1 + 2)), rel=1e-9
        )


def test_transmission_angle_where_the_linkage_cannot_close() -> None:
    triple_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)  # swings 108.21 deg either way
    assert np.isnan(transmission_angle(triple_rocker, np.radians([108.3, 180, -108.3]))).all()
    assert np.isfinite(transmission_angle(triple_rocker, np.radians([108.1, 0, -108.1]))).all()
    assert worst_transmission(triple_rocker, np.radians(100), np.radians(109)) == 0
    assert worst_transmission(triple_rocker, np.radians(-100), np.radians(-260)) == 0
    assert worst_transmission(triple_rocker, np.radians(-100), np.radians(100)) > 0.1
    assert worst_transmission_cycle(triple_rocker) == 0
