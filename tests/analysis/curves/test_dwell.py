"""Dwells against the longest run of a fine sweep."""

import numpy as np
import numpy.typing as npt
import pytest
from numpy.lib.stride_tricks import sliding_window_view

from grashof.analysis import Kinematics, dwell, output_stroke, solve_kinematics
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import FourBar, ProblemError

TURN = 2 * np.pi
CRANK_ROCKER = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)


def output_angle(state: Kinematics) -> npt.NDArray[np.float64]:
    return state.theta4


@pytest.mark.parametrize("seed", range(3))
def test_no_run_of_a_very_fine_sweep_is_longer(seed: int) -> None:
    linkage, tolerance = random_full_crank(np.random.default_rng(seed)), np.radians(2)
    found = dwell(linkage, output_angle, tolerance, period=TURN)
    theta2 = np.linspace(0, 2 * TURN, 200_001)
    values = np.unwrap(solve_kinematics(linkage, theta2).theta4)
    # Runs that are longer than the one found begin and end with a pair of samples further apart.
    steps = int(np.ceil(found.duration / theta2[1])) + 1
    windows = sliding_window_view(values[: 100_001 + steps], steps + 1)[::50]
    assert (np.ptp(windows, axis=1) > tolerance).all()
    inside = np.unwrap(solve_kinematics(linkage, np.linspace(found.start, found.end, 20_001)).theta4)
    assert np.ptp(inside) == pytest.approx(tolerance, rel=1e-7)  # samples miss the turning points
    assert inside.min() == pytest.approx(found.low + TURN * np.round((inside.min() - found.low) / TURN))


def test_the_longest_of_many_runs_across_an_edge_is_found() -> None:
    """sin(x) + sin(3 x) / 3 stays longest about its flat tops: by symmetry about 90 and 270 deg."""
    found = dwell(
        CRANK_ROCKER, lambda state: np.sin(state.theta2) + np.sin(3 * state.theta2) / 3 + 1e-3 * state.theta2,
        0.2, start=0.0, end=6.0,
    )  # fmt: skip
    theta2 = np.linspace(0, 6, 600_001)
    values = np.sin(theta2) + np.sin(3 * theta2) / 3 + 1e-3 * theta2
    first, longest = 0, 0.0
    for last in range(0, len(theta2), 50):
        while np.ptp(values[first : last + 1 : 50]) > 0.2:
            first += 50
        longest = max(longest, theta2[last] - theta2[first])
    assert found.duration == pytest.approx(longest, abs=2e-3)
    assert found.duration >= longest


def test_a_constant_dwells_throughout() -> None:
    found = dwell(CRANK_ROCKER, lambda state: np.hypot(*state.a.position.T), 1e-6)
    assert found.duration == pytest.approx(TURN)


def test_a_dwell_across_the_ends_of_the_turn_is_one() -> None:
    # Turned so that the output turns back where the driver is at 0.
    back = -float(output_stroke(CRANK_ROCKER).theta2[1])
    o4 = 100 * np.array([np.cos(back), np.sin(back)])
    turned = FourBar(o2=(0, 0), o4=o4, r2=40, r3=120, r4=80)
    found, same = (dwell(linkage, output_angle, 0.01, period=TURN) for linkage in (turned, CRANK_ROCKER))
    assert found.duration == pytest.approx(same.duration, rel=1e-7)
    assert found.start < TURN < found.end or found.start < 0 < found.end


def test_a_rocking_driver_may_dwell_at_its_end() -> None:
    found = dwell(CRANK_ROCKER, lambda state: state.theta2, 0.25, start=1.0, end=2.0)
    assert found.duration == pytest.approx(0.25, abs=1e-9)


def test_bad_input_is_refused() -> None:
    with pytest.raises(ProblemError, match="tolerance"):
        dwell(CRANK_ROCKER, output_angle, 0.0)
