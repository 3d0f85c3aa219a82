"""Section forces, stresses and pins of slider kinds: equilibrium at each cut, closed forms, dense search."""

from collections.abc import Callable

import numpy as np
import pytest

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    Body,
    Dynamics,
    Friction,
    Joint,
    Kinematics,
    Loads,
    Masses,
    Structure,
    driver_samples,
    inverse_dynamics,
    section_forces,
    solve_kinematics,
    strength_at,
    strength_over,
    uniform_bars,
)
from grashof.analysis.forces.bars import bars_of, longest_travel
from grashof.analysis.forces.loads import cross
from grashof.problems import InvertedSliderCrank, ProblemError, SectionSpec, SliderCrank, StrengthSpec
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage

TURN = 2 * np.pi
KINDS = (SliderCrank, InvertedSliderCrank)
Maker = Callable[..., list[Linkage]]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)
STEEL = StrengthSpec(235e6, 210e9, pin_diameter=0.02)


def before_cut(
    state: Kinematics, link: int, density: float, loads: Loads, found: Dynamics, cut: float, sign: float
) -> FloatArray:
    """Normal force, shear force and moment at a cut, from the balance of all that lies before it.

    Of a slender bar with forces on its line; `sign` turns its frame where B is behind A.
    """
    bar, theta = bars_of(state.linkage)[link], state.angular(link)[0]
    along = sign * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    here = state.point(link, (sign * cut, 0)).position
    moments, total, moment = found.joint_moments, np.zeros((*state.shape, 2)), np.zeros(state.shape)
    second = -found.slide_moment if isinstance(state.linkage, InvertedSliderCrank) else -moments[2]
    a, b = state.a.position, state.b.position
    ends = {
        2: [(state.linkage.o2, found.f12, found.torque + moments[0]), (a, found.f32, -moments[1])],
        3: [(a, -found.f32, moments[1]), (b, found.f43, second)],
    }[link]
    ends += [
        (state.point(link, force.at).position, np.asarray(force.force), np.zeros(()))
        for force in loads.forces
        if force.link == link
    ]
    for place, force, couple in ends:
        ahead = ((place - here) * along).sum(axis=-1) < 0
        total = total + np.where(ahead[..., None], force, 0.0)
        moment = moment + np.where(ahead, couple + cross(place - here, force), 0.0)
    ends_of = sorted((sign * float(bar.low), sign * float(bar.high)))
    first, last = ends_of[0], min(max(cut, ends_of[0]), ends_of[1])
    for node, weight in zip(first + (last - first) * (NODES + 1) / 2, WEIGHTS, strict=True):
        piece = state.point(link, (sign * node, 0.0))
        share = density * weight * (last - first) / 2
        push = share * (loads.gravity_vector() - piece.acceleration)
        total, moment = total + push, moment + cross(piece.position - here, push)
    return np.stack([-(along * total).sum(axis=-1), cross(along, total), -moment])


@pytest.mark.slow
@pytest.mark.quick("SliderCrank")
@pytest.mark.parametrize("kind", KINDS)
def test_every_cut_is_in_equilibrium(kind: type[Linkage], made: Maker) -> None:
    rng = np.random.default_rng(3)
    for linkage in made(kind, 12):
        state = solve_kinematics(linkage, rng.uniform(0, TURN, 5), rng.normal(), rng.normal())
        masses = uniform_bars(linkage, 2.0)
        masses = Masses(masses.crank, masses.coupler, Body(1.5, 0.2, (0.1, 0.2)))
        loads = Loads(
            gravity=(1.0, -9.0),
            forces=(
                AppliedForce(2, (0.3, 0.0), (2.0, 7.0)),
                AppliedForce(3, (0.4, 0.0), (-3.0, 5.0)),
                AppliedForce(3, (-0.3, 0.0), (1.0, 2.0)),
                AppliedForce(4, (0.1, 0.3), (-6.0, 2.0)),
            ),
            moments=(AppliedMoment(4, 1.1),),
            friction=Friction(0.3, 0.1, 0.01, 0.5, 0.2, 0.05),
        )
        found = inverse_dynamics(state, masses, loads)
        sign = -1.0 if kind is InvertedSliderCrank and linkage.assembly < 0 else 1.0
        for link, bar in section_forces(state, masses, loads, found).items():
            side = sign if link == 3 else 1.0
            first, last = bar.stations.min(axis=-1).max(), bar.stations.max(axis=-1).min()
            scale = np.abs(np.stack(bar.at(np.linspace(first, last, 40)))).max() * (1 + last - first)
            for cut in rng.uniform(first, last, 8):
                expected = before_cut(state, link, 2.0, loads, found, cut, side)
                given = np.stack(bar.at([cut]))[..., 0]
                np.testing.assert_allclose(given, expected, rtol=0, atol=1e-9 * scale)
            assert np.abs(np.stack(bar.rest)).max() < 1e-9 * scale


def test_a_rod_bends_between_crank_and_block() -> None:
    """A moment on the block: from nothing at A the rod's moment rises to it at B, by the force at A."""
    for assembly in (1, -1):
        shaper = InvertedSliderCrank((0, 0), (0, -2), 1, coupler_point=(0.5, 0.0), assembly=assembly)
        none = Masses(Body(0), Body(0), Body(0))
        state = solve_kinematics(shaper, np.radians([20.0, 100.0, 200.0]), 2.0)
        loads = Loads(moments=(AppliedMoment(4, 7.0),))
        bar = section_forces(state, none, loads)[3]
        travel = np.abs(state.slide.travel)
        np.testing.assert_allclose(bar.length, travel, rtol=1e-14)
        at = np.stack([travel / 2, travel * (1 - 1e-12)], axis=-1)
        np.testing.assert_allclose(np.abs(bar.at(at).moment), [[3.5, 7.0]] * 3, rtol=1e-9)
        structure = Structure(none, loads, SectionSpec(0.1, 0.05), STEEL)
        stress = strength_at(state, structure).bars[3]["normal_stress"]
        bending = 7.0 * 0.05 / (0.05 * 0.1**3 / 12)
        assert (stress.value >= bending * (1 - 1e-12)).all()
        np.testing.assert_allclose(stress.at, travel, rtol=1e-9)


def test_an_engine_rod_is_pushed_by_gas_over_the_cosine() -> None:
    engine = SliderCrank((0, 0), 0.05, 0.2)
    gas = Loads(forces=(AppliedForce(4, (0.0, 0.0), (-3000.0, 0.0)),))
    state = solve_kinematics(engine, np.radians([10.0, 60.0, 120.0]), 0.0)
    structure = Structure(Masses(Body(0), Body(0), Body(0)), gas, SectionSpec(0.02, 0.01), STEEL)
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

    def motion(theta2: FloatArray) -> Kinematics:
        return solve_kinematics(linkage, theta2, 4.0)

    found = strength_over(structure, motion, [driver_samples(linkage, 0.0, TURN)])
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
        section_forces(solve_kinematics(engine, 1.0), uniform_bars(engine, 1.0), links=[4])
