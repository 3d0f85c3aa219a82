"""The nine equations solved at once against the same solved in order, and against published figures."""

from typing import Any

import numpy as np
import pytest

from grashof.analysis import (
    Body,
    Loads,
    Masses,
    driver_ranges,
    given_masses,
    solve_kinematics,
    system_of_equations,
    uniform_bars,
)
from grashof.problems import DeadPositionWarning, FourBar

TURN = 2 * np.pi


def test_reference_figures_of_the_luggage(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    bag, linkage = golden["bag_mechanism_exact"], golden_linkages["table7"]
    masses = given_masses(linkage, [float(m) for m in bag["masses"]], [float(i) for i in bag["inertias"]])
    for expected in golden["table7_lengths_theta1_0"]["states"]:
        state = solve_kinematics(linkage, np.radians(float(expected["theta2_deg"])))
        system = system_of_equations(state, masses)
        solution = dict(zip(system.UNKNOWNS, system.solution, strict=True))
        torque = float(expected["T(g=0)"])
        assert solution["T12"] == pytest.approx(torque, rel=1e-9, abs=1e-9)
        for name in ("F12", "F32", "F43", "F14"):
            force = [float(part) for part in expected[f"{name}(g=0)"]]
            limit = 1e-9 * max(1.0, *map(abs, force))
            assert [solution[f"{name}x"], solution[f"{name}y"]] == pytest.approx(force, rel=1e-9, abs=limit)


def test_the_rows_are_those_of_the_textbook() -> None:
    """Link 2 of a linkage at rest, written out: arms from its centre to O2 and A."""
    linkage = FourBar(o2=(1, 2), o4=(5, 2), r2=1, r3=4, r4=3)
    masses = given_masses(linkage, (2, 3, 4), (1, 1, 1), [(0.25, 0.0), (2, 0), (1.5, 0)])
    system = system_of_equations(solve_kinematics(linkage, np.pi / 2, 0.0), masses, Loads(gravity=(0, -10)))
    assert len(system.EQUATIONS) == len(system.UNKNOWNS) == 9
    assert system.matrix[:3].round(12).tolist() == [
        [1, 0, 1, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, 1, 0, 0, 0, 0, 0],
        [0.25, 0, -0.75, 0, 0, 0, 0, 0, 1],
    ]
    assert system.right_side.round(12).tolist() == [0, 20, 0, 0, 30, 0, 0, 40, 0]


def test_dead_and_open_positions_have_no_solution() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    end = driver_ranges(rocker)[0, 1]
    with pytest.warns(DeadPositionWarning):
        state = solve_kinematics(rocker, [0.0, end, 3.0])
    for masses in (uniform_bars(rocker, 2.0), Masses(Body(0), Body(0), Body(0))):
        solution = system_of_equations(state, masses, Loads(gravity=(0, -9.81))).solution
        np.testing.assert_array_equal(np.isfinite(solution).all(axis=-1), [True, False, False])
