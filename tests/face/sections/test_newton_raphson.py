"""Newton-Raphson beside the closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from section_facts import facts

from grashof.analysis import solve_position
from grashof.problems import FourBar, LinkageSpec, load_linkage

ONLY = ("newton-raphson",)


@pytest.mark.parametrize("name", ["pumpjack", "luggage-report", "lufkin-c912d"])
def test_both_ways_agree(sections: Any, name: str) -> None:
    section = sections(name, sections=ONLY)["newton-raphson"]
    table = section.tables["newton-raphson"]
    exact = solve_position(load_linkage(name), np.radians(table["theta2_deg"]))
    np.testing.assert_allclose(table["theta3_deg"], np.degrees(exact.theta3), rtol=0, atol=1e-9)
    np.testing.assert_allclose(table["theta4_difference_deg"], 0, atol=1e-9)
    given = facts(section)
    assert given["newton_difference_max_deg"] < 1e-10
    assert given["newton_steps_max"] == table["steps"].max() <= 8
    assert section.notes == ()
    assert np.abs(np.diff(section.plots[0].series["theta4"])).max() < 40


def test_what_misses_is_counted(sections: Any) -> None:
    """In a dead position the two assemblies are one; beyond steps of 1 deg they are apart."""
    swinging = LinkageSpec(FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)), "rocker")
    section = sections(swinging, sections=ONLY)["newton-raphson"]
    table = section.tables["newton-raphson"]
    off = table[["theta3_difference_deg", "theta4_difference_deg"]].abs().max(axis=1)
    missed = int((~(off < 1)).sum())
    assert missed < 5
    assert [int(note.split()[1]) for note in section.notes] == ([missed] if missed else [])


def test_over_time_it_follows_the_history(sections: Any) -> None:
    section = sections("pumpjack", sections=ONLY, seconds=6, start_deg=90)["newton-raphson"]
    assert section.tables["newton-raphson"]["time_s"].iloc[-1] == 6
    assert section.plots[0].key == "newton-raphson-over-time"
