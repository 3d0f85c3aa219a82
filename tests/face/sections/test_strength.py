"""The section on strength: what a file has data for, in its units, as the analysis has it."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from section_facts import JACK, facts, loaded

from grashof.analysis import Structure, solve_kinematics, strength_at
from grashof.problems import FourBar, LinkageSpec
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.load_specs import LoadSpec
from grashof.problems.values.dynamics.strength import SectionSpec, StrengthSpec

STEEL = StrengthSpec(235e6, 210e9, pin_diameter=0.1)


@pytest.mark.slow
def test_forces_without_a_section_stresses_with_one_safety_with_strengths(sections: Any) -> None:
    bars = {"section": SectionSpec(0.2, 0.2)}
    given = ({}, bars, bars | {"strength": STEEL})
    bare, cut, strong = (sections(loaded(JACK, **each))["strength"] for each in given)
    assert "moment_3" in bare.tables["strength"]
    assert "stress_3" not in bare.tables["strength"]
    assert "stress_3" in cut.tables["strength"]
    assert "safety" not in cut.tables
    assert len(strong.tables["safety"]) == 3 * 3 + 4 * 2
    least = strong.tables["safety"]["safety_factor"].min()
    assert facts(strong)["safety_factor"] == least


def test_it_is_the_analysis_and_its_peaks_hold_the_table(sections: Any) -> None:
    made = sections(loaded(JACK, section=SectionSpec(0.2, 0.2), strength=STEEL))
    found, study = made["strength"], made.study
    rows = found.tables["strength"]
    structure = Structure(study.masses, study.loads, SectionSpec(0.2, 0.2), STEEL)
    state = solve_kinematics(JACK.linkage, np.radians(rows["theta2_deg"]), 20 * np.pi / 30)
    exact = strength_at(state, structure)
    np.testing.assert_allclose(rows["stress_3"], exact.bars[3]["stress"].value, rtol=1e-9)
    peaks = found.tables["strength-peaks"].set_index(["part", "what"])["largest"]
    for link in (2, 3, 4):
        most = rows[f"moment_{link}"].max()
        assert most <= peaks[f"link {link}", "bending moment"] <= most * 1.01


def test_stresses_are_pascals_in_every_unit(sections: Any) -> None:
    load = LoadSpec(4, (-2.0, 0.0), force=(0, -9e3))
    metres = loaded(JACK, section=SectionSpec(0.2, 0.1), strength=STEEL, loads=(load,))
    assert metres.dynamics is not None
    small = replace(metres, linkage=JACK.linkage.scaled(1e3, np.zeros(2)), length_unit="mm")
    millimetres = loaded(
        small,
        inertias=tuple(1e6 * each for each in metres.dynamics.inertias or ()),
        section=SectionSpec(200, 100),
        strength=StrengthSpec(235e6, 210e9, pin_diameter=100),
        loads=(LoadSpec(4, (-2000.0, 0.0), force=(0, -9e3)),),
    )
    tables = [sections(each)["strength"].tables["safety"] for each in (metres, millimetres)]
    np.testing.assert_allclose(*(each["safety_factor"] for each in tables), rtol=1e-6)


@pytest.mark.parametrize("dynamics", [None, DynamicsSpec(speed_rpm=3)])
def test_nothing_acts_nothing_is_said(sections: Any, dynamics: DynamicsSpec | None) -> None:
    spec = LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 3), "bare", dynamics=dynamics)
    assert "strength" not in sections(spec)
