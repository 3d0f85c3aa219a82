"""Inexact dimensions of a linkage: peaks of the displacements."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from section_facts import ONE_RANGE, facts

from grashof.analysis import solve_position
from grashof.analysis.judge.tolerance import made_linkages
from grashof.problems import load_linkage_spec

LUFKIN = load_linkage_spec("lufkin-c912d")


def test_made_linkages_move_by_no_more(sections: Any) -> None:
    found = sections(LUFKIN, tolerance=0.01)["tolerance"]
    table = found.tables["tolerance"]
    theta2 = np.radians(table["theta2_deg"].to_numpy())
    errors = np.random.default_rng(1).choice([-0.01, 0.01], (300, 6))
    made, _ = made_linkages(LUFKIN.linkage, errors)
    states, nominal = solve_position(made[:, None], theta2), solve_position(LUFKIN.linkage, theta2)
    way = np.hypot(*np.moveaxis(states.p - nominal.p, -1, 0))
    assert (way <= table["p_worst"].to_numpy() * 1.001).all()
    turned = np.degrees(np.abs((states.theta4 - nominal.theta4 + np.pi) % (2 * np.pi) - np.pi))
    assert (turned <= table["theta4_worst_deg"].to_numpy() * 1.001).all()
    assert turned.max() > 0.98 * table["theta4_worst_deg"].max()
    given = facts(found)
    assert given["tolerance_theta4_worst_deg"] >= table["theta4_worst_deg"].max()
    assert given["tolerance_theta4_worst_deg"] == pytest.approx(table["theta4_worst_deg"].max(), rel=1e-3)
    assert given["tolerance_dimension"] == "r2"  # P is A


def test_a_driver_that_swings_has_no_limit(sections: Any) -> None:
    found = sections(ONE_RANGE, tolerance=0.01)["tolerance"]
    assert [fact.key for fact in found.facts] == ["tolerance"]
