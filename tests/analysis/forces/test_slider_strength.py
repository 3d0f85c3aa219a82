"""Section forces, stresses and pins of slider kinds: equilibrium at each cut, closed forms, dense search."""

from collections.abc import Callable

import numpy as np
import pytest
from loaded_linkages import TURN

from grashof import analysis
from grashof.analysis import WEIGHTLESS, Joint, Loads, Structure, solve_kinematics, strength_at, uniform_bars
from grashof.analysis.forces.bars import longest_travel
from grashof.problems import InvertedSliderCrank, ProblemError, SectionSpec, SliderCrank, StrengthSpec
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage

KINDS = (SliderCrank, InvertedSliderCrank)
Maker = Callable[..., list[Linkage]]
STEEL = StrengthSpec(235e6, 210e9, pin_diameter=0.02)


def test_a_rod_bends_between_crank_and_block() -> None:
    """A moment on the block: from nothing at A the rod's moment rises to it at B, by the force at A."""
    for assembly in (1, -1):
        shaper = InvertedSliderCrank((0, 0), (0, -2), 1, coupler_point=(0.5, 0.0), assembly=assembly)
        state = solve_kinematics(shaper, np.radians([20.0, 100.0, 200.0]), 2.0)
        loads = Loads(moments=(analysis.AppliedMoment(4, 7.0),))
        bar = analysis.section_forces(state, WEIGHTLESS, loads)[3]
        travel = np.abs(state.slide.travel)
        np.testing.assert_allclose(bar.length, travel, rtol=1e-14)
        at = np.stack([travel / 2, travel * (1 - 1e-12)], axis=-1)
        np.testing.assert_allclose(np.abs(bar.at(at).moment), [[3.5, 7.0]] * 3, rtol=1e-9)
        structure = Structure(WEIGHTLESS, loads, SectionSpec(0.1, 0.05), STEEL)
        stress = strength_at(state, structure).bars[3]["normal_stress"]
        bending = 7.0 * 0.05 / (0.05 * 0.1**3 / 12)
        assert (stress.value >= bending * (1 - 1e-12)).all()
        np.testing.assert_allclose(stress.at, travel, rtol=1e-9)


def test_an_engine_rod_is_pushed_by_gas_over_the_cosine() -> None:
    engine = SliderCrank((0, 0), 0.05, 0.2)
    gas = Loads(forces=(analysis.AppliedForce(4, (0.0, 0.0), (-3000.0, 0.0)),))
    state = solve_kinematics(engine, np.radians([10.0, 60.0, 120.0]), 0.0)
    structure = Structure(WEIGHTLESS, gas, SectionSpec(0.02, 0.01), STEEL)
    found = strength_at(state, structure)
    phi = np.arcsin(0.25 * np.sin(state.theta2))
    np.testing.assert_allclose(found.bars[3]["thrust"].value, 3000 / np.cos(phi), rtol=1e-12)
    assert list(found.bars) == [2, 3]
    assert list(found.pins) == [Joint.O2, Joint.A, Joint.B]
    assert list(strength_at(state, structure, links=[2]).bars) == [2]


@pytest.mark.quick("0.0254-InvertedSliderCrank")
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("metre", [1.0, 1e-3, 0.0254])
def test_strength_over_a_turn_is_that_of_a_dense_search(
    kind: type[Linkage], metre: float, made: Maker
) -> None:
    linkage = made(kind, 2, margin=0.2)[1].scaled(1 / metre, np.zeros(2))
    masses, weight = uniform_bars(linkage, 5.0 * metre, payload=1.0), Loads(gravity=(0, -9.81 / metre))
    steel = StrengthSpec(235e6, 210e9, pin_diameter=0.02 / metre)
    structure = Structure(masses, weight, SectionSpec(0.05 / metre, 0.03 / metre), steel, metre)

    def motion(theta2: FloatArray) -> analysis.Kinematics:
        return solve_kinematics(linkage, theta2, 4.0)

    found = analysis.strength_over(structure, motion, [analysis.driver_samples(linkage, 0.0, TURN)])
    dense = strength_at(motion(np.linspace(0, TURN, 1001)), structure)
    for link, measures in dense.bars.items():
        for key, along in measures.items():
            assert found.peak(key, f"link {link}").value == pytest.approx(along.value.max(), rel=2e-4)
    for joint, pins in dense.pins.items():
        assert found.peak("pin_force", joint.name).value == pytest.approx(pins["pin_force"].max(), rel=2e-4)
    parts = {factor.part for factor in found.factors}
    gone = {"O4"} if kind is SliderCrank else {"B"}
    assert parts == {"link 2", "link 3", "O2", "A", "B", "O4"} - gone
    if kind is InvertedSliderCrank:  # the rod buckles most easily where it is longest
        limit = next(each for each in found.factors if each.key == "buckling" and each.part == "link 3")
        long = float(longest_travel(linkage)) * metre
        euler = np.pi**2 * 210e9 * 0.03 * 0.05**3 / 12 / long**2
        crushing = 235e6 * 0.05 * 0.03
        expected = euler if 2 * euler < crushing else crushing * (1 - crushing / (4 * euler))
        assert limit.limit == pytest.approx(expected, rel=1e-9)


def test_sliders_and_blocks_are_no_bars() -> None:
    engine = SliderCrank((0, 0), 1, 3)
    with pytest.raises(ProblemError, match=r"^link 4 of a slider-crank is not a bar"):
        analysis.section_forces(solve_kinematics(engine, 1.0), uniform_bars(engine, 1.0), links=[4])
