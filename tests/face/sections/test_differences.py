"""Central differences: their order, the step they are taken in, and the two reports."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from grashof.analysis import solve_kinematics
from grashof.problems import FourBar, LinkageSpec, load_linkage_spec

ONLY = ("differences",)
STEP = (2 * np.pi + np.radians(121.9353869)) / 100
SWINGING = LinkageSpec(FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)), "rocker")


def largest(section: Any) -> dict[tuple[int, int], float]:
    """Largest share by derivative and order, of the angles."""
    table = section.tables["differences-deviations"]
    angles = table[table["quantity"].str.match("(omega|alpha)")]
    return dict(angles.groupby(["derivative", "order"])["share"].max().items())


def test_over_the_driver_angle_each_degree_has_its_neighbours(sections: Any) -> None:
    section = sections("pumpjack", sections=ONLY)["differences"]
    table = section.tables["differences"]
    assert table["theta2_deg"].tolist() == pytest.approx(list(range(361)))
    assert not table.isna().any(axis=None)
    state = solve_kinematics(
        load_linkage_spec("pumpjack").linkage, np.radians(table["theta2_deg"]), 2 * np.pi / 3
    )
    np.testing.assert_allclose(table["omega3"], state.omega3, rtol=0, atol=1e-12)
    np.testing.assert_allclose(table["alpha4"], state.alpha4, rtol=0, atol=1e-12)
    # The same by plain arithmetic, from the angle a degree before and after.
    beside = [
        np.unwrap(solve_kinematics(state.linkage, np.radians(table["theta2_deg"] + way)).theta3)
        for way in (-1, 1)
    ]
    plain = (beside[1] - beside[0]) / np.radians(2) * 2 * np.pi / 3
    np.testing.assert_allclose(table["omega3_order_2"], plain, rtol=0, atol=1e-9)
    worst = np.abs(table["omega3_order_2"] - table["omega3"]).max()
    rows = section.tables["differences-deviations"].set_index(["quantity", "order"])
    assert rows.loc[("omega3", 2), "largest"] == pytest.approx(worst)
    assert len(rows) == 24


def test_errors_fall_as_the_step_to_the_order(sections: Any) -> None:
    """Over a history of full turns of a clockwise driver, in steps of 2 and of 1 deg."""
    coarse, fine = (
        largest(sections("pumpjack", sections=ONLY, seconds=6, step=step, speed_rpm=-10)["differences"])
        for step in (2 / 60, 1 / 60)
    )
    for (derivative, order), share in coarse.items():
        assert np.log2(share / fine[derivative, order]) == pytest.approx(order, abs=0.15), (derivative, order)


def test_the_samples_of_the_luggage_report(sections: Any) -> None:
    """Divided by 5 deg in place of their step of 4.8194 deg they come out 3.6 and 7.1 % low."""
    asked = {"seconds": 100 * STEP, "step": STEP, "start_deg": 74.0323}
    section = sections("luggage-report", sections=ONLY, **asked)["differences"]
    table = section.tables["differences"]
    assert len(table) == 101
    assert np.degrees(STEP) == pytest.approx(4.8194, abs=5e-5)
    assert table["omega3_order_2"].isna().sum() == 2
    assert table["g4_acceleration_x_order_4"].isna().sum() == 4
    # Near 8 deg of transmission angle this step is too coarse for either order.
    assert largest(section)[2, 2] > 0.1
    assert largest(section)[2, 4] > 0.04


def test_towards_a_dead_position_nothing_warns_or_is_infinite(sections: Any) -> None:
    section = sections(SWINGING, sections=ONLY)["differences"]
    table = section.tables["differences"]
    assert set(table["range"]) == {1, 2}
    for _, rows in table.groupby("range"):
        assert np.ptp(np.diff(rows["theta2_deg"])) < 1e-9  # an even grid, inside
    assert table["theta2_deg"].abs().max() < 67.9757
    assert np.isfinite(section.tables["differences-deviations"][["largest", "share"]]).all(axis=None)
    assert "no step is small enough" in section.notes[0]


def test_too_few_samples_are_said(sections: Any) -> None:
    section = sections("pumpjack", sections=ONLY, seconds=0.1)["differences"]
    assert section.notes == ("differences need 5 samples or more",)
    assert not section.tables


def test_only_when_asked_for(sections: Any) -> None:
    assert "differences" not in sections("pumpjack", sections=("fits",))
