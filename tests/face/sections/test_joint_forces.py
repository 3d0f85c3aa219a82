"""Forces in the joints: in the frames of the links, and by the nine equations as a table."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from section_facts import INCH, JACK, ONE_RANGE, in_inches, loaded

from grashof.problems import DynamicsSpec
from grashof.survey import report_on

ONLY = ("equations",)
NAMES = ["F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12"]


@pytest.mark.slow
def test_pin_forces_turned_back_are_those_of_the_table(sections: Any) -> None:
    found, dynamics = sections(JACK)["pin-forces"], report_on(JACK).tables["dynamics"]
    table, motion = found.tables["pin-forces"], report_on(JACK).tables["kinematics"]
    for joint, link, force, sign in (
        ("o2", 2, "f12", 1), ("a", 2, "f32", 1), ("a", 3, "f32", -1), ("b", 3, "f43", 1), ("b", 4, "f43", -1),
        ("o4", 4, "f14", 1),
    ):  # fmt: skip
        turn = np.exp(1j * np.radians(motion["theta2_deg" if link == 2 else f"theta{link}_deg"]))
        there = (table[f"{joint}_on_{link}_u"] + 1j * table[f"{joint}_on_{link}_v"]) * turn
        expected = sign * (dynamics[f"{force}_x"] + 1j * dynamics[f"{force}_y"])
        np.testing.assert_allclose(there, expected, rtol=1e-9, atol=1e-6)
    track = found.plots[0].series["A"]
    np.testing.assert_allclose(track[:, 0], -dynamics["f32_x"], rtol=1e-12)


def test_the_table_solves_to_the_forces_of_the_analysis(sections: Any) -> None:
    section = sections("pumpjack", sections=ONLY, at_deg=(0, 60))["equations"]
    table = section.tables["equations"]
    assert len(table) == 18
    rows = table[table["theta2_deg"] == 60]
    solved = np.linalg.solve(rows[NAMES].to_numpy(), rows["right_side"].to_numpy())
    np.testing.assert_allclose(solved, rows["solution"], rtol=1e-12, atol=1e-9)
    assert rows["unknown"].tolist() == NAMES
    assert rows["solution"].iloc[-1] == pytest.approx(5507.7, rel=2e-3)  # at g = 9.81 it is 5507.711
    assert section.facts[0].value < 1e-8


def test_arms_are_in_metres_and_forces_in_newtons_in_every_unit(sections: Any) -> None:
    """The pumpjack in inches has the same equations."""
    assert JACK.dynamics is not None
    inertias = tuple(inertia / INCH**2 for inertia in JACK.dynamics.inertias or ())
    small = replace(JACK, linkage=in_inches(JACK.linkage), length_unit="in")
    tables = [
        sections(each, sections=ONLY, at_deg=(75,))["equations"].tables["equations"]
        for each in (JACK, loaded(small, inertias=inertias))
    ]
    for name in [*NAMES, "right_side", "solution"]:
        np.testing.assert_allclose(tables[1][name], tables[0][name], rtol=1e-9, atol=1e-9)


def test_dead_positions_and_linkages_without_masses(sections: Any) -> None:
    assert "neither masses nor loads" in sections("lufkin-c912d", sections=ONLY)["equations"].notes[0]
    swinging = replace(ONE_RANGE, length_unit="mm", dynamics=DynamicsSpec(mass_per_length=1.0))
    middle = sections(swinging, sections=ONLY)["equations"].tables["equations"]
    assert middle["theta2_deg"].unique() == pytest.approx([0])
    assert np.isfinite(middle["solution"]).all()
    limit = float(np.degrees(np.arccos((16 + 4 - 25) / 16)))
    dead = sections(swinging, sections=ONLY, at_deg=(limit,))["equations"]
    assert dead.tables["equations"]["solution"].isna().all()
    assert dead.facts[0].value == 0
