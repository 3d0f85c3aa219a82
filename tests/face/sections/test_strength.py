"""The section on strength: what a file has data for, in its units, as the analysis has it."""

from dataclasses import replace

import numpy as np
import pytest
from section_facts import facts

from grashof.analysis import Structure, solve_kinematics, strength_at
from grashof.problems import FourBar, LinkageSpec, load_linkage_spec
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.load_specs import LoadSpec
from grashof.problems.values.dynamics.strength import SectionSpec, StrengthSpec
from grashof.sections.strength import strength
from grashof.study.section import Section
from grashof.study.study import Asked, LinkageStudy

STEEL = StrengthSpec(235e6, 210e9, pin_diameter=0.1)


def section_of(spec: LinkageSpec) -> Section | None:
    return strength(LinkageStudy.of(spec, Asked()))


def jack(**given: object) -> LinkageSpec:
    spec = load_linkage_spec("pumpjack")
    assert spec.dynamics is not None
    return replace(spec, dynamics=replace(spec.dynamics, **given))  # type: ignore[arg-type]


@pytest.mark.slow
def test_forces_without_a_section_stresses_with_one_safety_with_strengths() -> None:
    bare, cut, strong = (
        section_of(jack(**given))
        for given in (
            {},
            {"section": SectionSpec(0.2, 0.2)},
            {"section": SectionSpec(0.2, 0.2), "strength": STEEL},
        )
    )
    assert bare is not None
    assert cut is not None
    assert strong is not None
    assert "moment_3" in bare.tables["strength"]
    assert "stress_3" not in bare.tables["strength"]
    assert "stress_3" in cut.tables["strength"]
    assert "safety" not in cut.tables
    assert len(strong.tables["safety"]) == 3 * 3 + 4 * 2
    least = strong.tables["safety"]["safety_factor"].min()
    assert facts(strong)["safety_factor"] == least


def test_it_is_the_analysis_and_its_peaks_hold_the_table() -> None:
    spec = jack(section=SectionSpec(0.2, 0.2), strength=STEEL)
    study = LinkageStudy.of(spec, Asked())
    found, masses = strength(study), study.masses
    assert found is not None
    assert masses is not None
    rows = found.tables["strength"]
    structure = Structure(masses, study.loads, SectionSpec(0.2, 0.2), STEEL)
    state = solve_kinematics(spec.linkage, np.radians(rows["theta2_deg"]), 20 * np.pi / 30)
    exact = strength_at(state, structure)
    np.testing.assert_allclose(rows["stress_3"], exact.bars[3]["stress"].value, rtol=1e-9)
    peaks = found.tables["strength-peaks"].set_index(["part", "what"])["largest"]
    for link in (2, 3, 4):
        most = rows[f"moment_{link}"].max()
        assert most <= peaks[f"link {link}", "bending moment"] <= most * 1.01


def test_stresses_are_pascals_in_every_unit() -> None:
    metres = jack(
        section=SectionSpec(0.2, 0.1), strength=STEEL, loads=(LoadSpec(4, (-2.0, 0.0), force=(0, -9e3)),)
    )
    bar = metres.linkage
    small = FourBar(*(1e3 * each for each in (bar.o2, bar.o4, bar.r2, bar.r3, bar.r4, bar.coupler_point)))
    assert metres.dynamics is not None
    dynamics = replace(
        metres.dynamics,
        inertias=tuple(1e6 * each for each in metres.dynamics.inertias or ()),  # type: ignore[arg-type]
        section=SectionSpec(200, 100),
        strength=StrengthSpec(235e6, 210e9, pin_diameter=100),
        loads=(LoadSpec(4, (-2000.0, 0.0), force=(0, -9e3)),),
    )
    found = [
        section_of(each) for each in (metres, LinkageSpec(small, "mm", length_unit="mm", dynamics=dynamics))
    ]
    tables = [each.tables["safety"]["safety_factor"] for each in found if each is not None]
    np.testing.assert_allclose(*tables, rtol=1e-6)


@pytest.mark.parametrize("dynamics", [None, DynamicsSpec(speed_rpm=3)])
def test_nothing_acts_nothing_is_said(dynamics: DynamicsSpec | None) -> None:
    assert section_of(LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 3), "bare", dynamics=dynamics)) is None
