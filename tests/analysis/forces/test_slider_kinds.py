"""Slider kinds: friction of slides, textbooks, rest and equilibrium; their bars."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from loaded_linkages import TURN, WEIGHT
from refusals import refusal

from grashof import analysis, problems
from grashof.analysis import WEIGHTLESS, Body, Loads, inverse_dynamics, solve_kinematics, stated_masses
from grashof.analysis.forces.bars import bars_of, longest_travel
from grashof.analysis.forces.joints import joint_motion, slides_of
from grashof.analysis.forces.loads import wrenches
from grashof.analysis.numerics import collocation
from grashof.problems import DynamicsSpec, InvertedSliderCrank, ProblemError, SectionSpec, SliderCrank
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.load_specs import FrictionSpec, LoadSpec
from grashof.problems.values.linkages.linkage import Linkage

KINDS = (SliderCrank, InvertedSliderCrank)
Maker = Callable[..., list[Linkage]]
Specs = dict[type[Linkage], DynamicsSpec]


def state_of(linkage: Linkage, count: int = 97, speed: float = 3.0) -> analysis.Kinematics:
    return solve_kinematics(linkage, np.linspace(0.01, 6.27, count), speed, 2.0)


@pytest.mark.parametrize("kind", KINDS)
def test_friction_of_a_slide_is_as_stated(kind: type[Linkage], everything: Specs, made: Maker) -> None:
    for linkage in made(kind, 5):
        state, masses = state_of(linkage), stated_masses(linkage, everything[kind])
        (slide,) = slides_of(linkage)
        speed = joint_motion(state, slide)[1]
        plain = inverse_dynamics(state, masses, WEIGHT)
        assert (plain.joint_moments == 0).all()
        rubbed = inverse_dynamics(
            state, masses, replace(WEIGHT, friction=analysis.Friction(slide_viscous=2.0, slide_coulomb=0.4))
        )
        expected = -2.0 * speed - 0.4 * np.sign(speed)
        np.testing.assert_allclose(rubbed.joint_moments[slide], expected, rtol=1e-12)
        for length in (0.0, 0.3):
            friction = analysis.Friction(slide_mu=0.05, slide_length=length)
            found = inverse_dynamics(state, masses, replace(WEIGHT, friction=friction))
            pressing = np.abs(found.slide_force)
            if length:  # two ends of a guide, their forces added
                ends = found.slide_force / 2 + found.slide_moment / length * np.array([[1], [-1]])
                pressing = np.abs(ends).sum(axis=0)
            expected = -0.05 * pressing * np.sign(speed)
            np.testing.assert_allclose(found.joint_moments[slide], expected, rtol=1e-9, atol=1e-12)


def test_norton_engine_with_lumped_masses() -> None:
    """Norton, sec. 14.4 to 14.6: a rod of two point masses; series in r / l are right to their order."""
    r, length, omega, at_a, at_b, piston = 2.6 * 0.0254, 10.4 * 0.0254, 340.0, 0.3, 0.2, 0.4
    rod = Body(at_a, 0.0, (0.0, 0.0)) + Body(at_b, 0.0, (length, 0.0))
    theta = np.linspace(0, TURN, 181)
    state = solve_kinematics(SliderCrank((0, 0), r, length), theta, omega)
    found = inverse_dynamics(state, analysis.Masses(Body(0.0), rod, Body(piston)))
    mass, lam, force = at_b + piston, r / length, r * omega**2
    pull, sine = mass * state.slide.acceleration, lam * np.sin(theta)
    exact = {"torque": pull * state.slide.velocity / omega, "slide_force": pull * sine / np.sqrt(1 - sine**2)}
    for name, value in exact.items():
        np.testing.assert_allclose(getattr(found, name), value, rtol=0, atol=1e-12 * np.abs(value).max())
    waves = 1.5 * lam * np.sin(3 * theta) + np.sin(2 * theta) - lam / 2 * np.sin(theta)
    along = mass * force * (np.cos(theta) + lam * np.cos(2 * theta)) + at_a * force * np.cos(theta)
    for value, series, order in (
        (found.torque, mass / 2 * force * r * waves, lam**2),  # Norton, eqs. 14.12 and 14.14
        (found.shaking_force[:, 0], along, lam**3),
        (found.shaking_force[:, 1], at_a * force * np.sin(theta), 1e-9),
    ):
        np.testing.assert_allclose(value, series, rtol=0, atol=order * np.abs(series).max())


def test_gas_on_the_piston_turns_the_crank_as_the_textbook_has_it() -> None:
    """F r sin(theta + phi) / cos(phi): exact (Norton, sec. 13.7; phi the rod's inclination)."""
    engine = SliderCrank((0, 0), 0.05, 0.2)
    theta = np.radians([10.0, 60.0, 120.0, 250.0])
    gas = Loads(forces=(analysis.AppliedForce(4, (0.0, 0.0), (-3000.0, 0.0)),))
    found = inverse_dynamics(solve_kinematics(engine, theta, 100.0), WEIGHTLESS, gas)
    phi = np.arcsin(0.25 * np.sin(theta))
    np.testing.assert_allclose(-found.torque, 3000 * 0.05 * np.sin(theta + phi) / np.cos(phi), rtol=1e-12)
    np.testing.assert_allclose(found.slide_force, 3000 * -np.tan(phi) * -1, rtol=1e-12)
    beside = Loads(forces=(analysis.AppliedForce(4, (0.0, 0.01), (-3000.0, 0.0)),))
    held = inverse_dynamics(solve_kinematics(engine, theta, 100.0), WEIGHTLESS, beside)
    np.testing.assert_allclose(held.torque, found.torque, rtol=1e-12)
    np.testing.assert_allclose(held.slide_moment, -30.0, rtol=1e-12)  # against 3000 N above B


def test_masses_of_bars_sliders_blocks_and_rods(everything: Specs) -> None:
    engine = SliderCrank((0, 0), 1, 3, coupler_point=(1.0, 0.5))
    masses = stated_masses(engine, replace(everything[SliderCrank], counterweights=(), payload=0.0))
    assert [float(masses.of(link).mass) for link in (2, 3, 4)] == pytest.approx([0.8, 2.4, 0.0])
    for assembly in (1, -1):
        for point in ((0.3, 1.0), (9.0, 0.0), (-5.0, 0.0)):
            shaper = InvertedSliderCrank((0, 0), (3, 0), 1, 0.5, point, assembly)
            bar = bars_of(shaper)[3]
            travel = solve_kinematics(shaper, np.linspace(0, TURN, 721)).slide.travel
            reach = [0.0, point[0], travel.min(), travel.max()]
            assert float(bar.low) == pytest.approx(min(reach), rel=1e-12)
            assert float(bar.high) == pytest.approx(max(reach), rel=1e-12)
            rod = stated_masses(shaper, replace(everything[InvertedSliderCrank], counterweights=())).coupler
            assert float(rod.mass) == pytest.approx(0.8 * (max(reach) - min(reach)) + 1.0)


def test_a_rod_that_swings_reaches_its_farthest_travel() -> None:
    swinging = InvertedSliderCrank((0, 0), (2, 0), 1.5, 1.0)
    bar = bars_of(swinging)[3]
    assert float(bar.high) == pytest.approx(np.sqrt(3.5**2 - 1))


def test_loads_that_a_kind_cannot_have_are_refused_in_one_line() -> None:
    engine, bar = SliderCrank((0, 0), 1, 3), problems.FourBar((0, 0), (4, 0), 1, 4, 3)
    for linkage, loads, line in (
        (
            engine,
            Loads(torsion_springs=(analysis.TorsionSpring(analysis.Joint.O4, 1.0),)),
            "a torsion spring is at the slide",
        ),
        (engine, Loads(friction=analysis.Friction(viscous=(0, 0, 0, 1))), "viscous friction in O4 is 1"),
        (
            bar,
            Loads(friction=analysis.Friction(slide_mu=0.1)),
            "slide_mu friction is 0.1; a four-bar has no slide",
        ),
        (engine, Loads(friction=analysis.Friction(slide_mu=-0.1)), "slide_mu is -0.1"),
    ):
        message = refusal(inverse_dynamics, solve_kinematics(linkage, 1.0), WEIGHTLESS, loads)
        assert message.startswith(line)
        assert len(message.splitlines()) == 1


def test_a_load_over_travel_has_to_cover_it(everything: Specs) -> None:
    engine = SliderCrank((0, 0), 1, 3)
    spec = everything[SliderCrank]
    short = replace(spec, loads=(replace(spec.loads[1], values=((2.5, 1, 0), (4, 2, 0))),))
    with pytest.raises(ProblemError, match=r"^a load over travel covers 2.5 to 4; the slide reaches 2"):
        inverse_dynamics(
            solve_kinematics(engine, np.linspace(0, TURN, 9)),
            stated_masses(engine, spec),
            analysis.stated_loads(short, 1.0),
        )
    enough = replace(spec, loads=(replace(spec.loads[1], values=((2, 1, 0), (4, 2, 0))),))
    state = solve_kinematics(engine, np.array([0.0, np.pi]))
    felt = wrenches(state, analysis.stated_loads(replace(enough, springs=(), dampers=()), 1.0))
    np.testing.assert_allclose(felt[4].force, [[2, 0], [1, 0]], atol=1e-12)


def lossless(spec: DynamicsSpec) -> DynamicsSpec:
    return replace(spec, loads=(), dampers=(), friction=None)


@pytest.mark.slow
@pytest.mark.quick("SliderCrank")
@pytest.mark.parametrize("kind", KINDS)
def test_the_torque_of_a_released_linkage_is_none(
    kind: type[Linkage], everything: Specs, made: Maker
) -> None:
    """With everything that acts, friction of pins and slide too, from rest on: its motion needs no drive."""
    spec = replace(everything[kind], loads=everything[kind].loads[2:6])
    for linkage in made(kind, 1, margin=0.2):
        masses, loads = stated_masses(linkage, spec), analysis.stated_loads(spec, 1.0)
        time = np.linspace(0, 1.5, 40)
        free = analysis.free_response(linkage, masses, time, 0.3, 0.0, loads=loads)
        moving = free.state
        steady = inverse_dynamics(moving, masses, loads)
        inertia = analysis.generalised_inertia(linkage, moving.theta2, masses)
        scale = np.abs(inertia * moving.alpha2).max()
        turning = np.abs(moving.omega2) > 1e-3 * np.abs(moving.omega2).max()
        assert turning.sum() > 20
        np.testing.assert_allclose(steady.torque[turning], 0.0, atol=1e-8 * scale)


@pytest.mark.slow
def test_a_swing_that_dies_away_where_the_slide_turns_back_takes_few_steps(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    crank = SliderCrank((0, 0), 1, 3, offset=-0.5, slide_angle=np.pi / 6, assembly=-1)
    spec = DynamicsSpec(
        mass_per_length=0.002,
        loads=(LoadSpec(4, values=((-9, 1, 2), (0, 3, 4), (9, 1, 2)), over="travel"),),
        friction=FrictionSpec(slide_mu=0.1, slide_length=0.4, slide_viscous=2, slide_force=3),
    )
    made, steps = collocation._panel, list[float]()
    monkeypatch.setattr(collocation, "_panel", lambda *given: (steps.append(given[1]), made(*given))[1])
    masses, loads = stated_masses(crank, spec, 1e-3), analysis.stated_loads(spec, 1e-3)
    free = analysis.free_response(crank, masses, np.linspace(0, 0.06, 601), np.pi / 9, 0.0, loads=loads)
    assert free.end == pytest.approx(0.06)
    assert len(steps) < 300
    speeds = np.abs(free.state.omega2)
    assert speeds.max() > 100
    assert speeds[-20:].max() < 1e-3 * speeds.max()


@pytest.mark.slow
def test_in_dead_positions_the_output_holds_loads_that_the_driver_cannot() -> None:
    """A slider-crank whose driver swings: rod across the slide. A rod through O4's block, at its offset."""
    swings = SliderCrank((0, 0), 2.0, 1.0)
    weight, masses = (
        Loads(gravity=(3, -10)),
        analysis.Masses(Body(1.0, 0, (1, 0)), Body(1.0, 0, (0.5, 0)), Body(1.0)),
    )
    dead = analysis.holding(swings, np.array([np.radians(30.0)]), masses, weight)
    assert np.abs(dead.torque[0]) > 1e6
    assert np.isfinite(dead.moment[0])
    free = analysis.free_response(swings, masses, np.linspace(0, 5, 9), 0.2, 2.0, loads=weight)
    assert free.ending is analysis.Ending.DEAD_POSITION
    rod = InvertedSliderCrank((0, 0), (2, 0), 1.5, 1.0)
    end = float(np.arccos((4 + 2.25 - 1) / (2 * 2 * 1.5)))
    dead = analysis.holding(rod, np.array([end, -end]), masses, weight)
    assert (np.abs(dead.torque) > 1e6).all()
    assert np.isfinite(dead.moment).all()
    free = analysis.free_response(rod, masses, np.linspace(0, 9, 9), 1.0, -3.0, loads=weight)
    assert free.ending is analysis.Ending.DEAD_POSITION


def test_equilibria_and_swings_of_a_hanging_engine() -> None:
    """A slider on a vertical slide: of x = r cos t + sqrt(l^2 - r^2 sin^2 t) the second derivatives."""
    r, length, mass = 0.5, 2.0, 3.0
    engine = SliderCrank((0, 0), r, length, slide_angle=-np.pi / 2)
    masses = analysis.Masses(Body(2.0, 0.3), Body(0.0), Body(mass))
    found = analysis.equilibria(engine, masses, WEIGHT, 0.0, TURN, closed=True)
    np.testing.assert_allclose(np.degrees(found.theta2), [90, 270], atol=1e-9)
    up, down = (mass * 9.81 * (r**2 / length + sign * r) for sign in (-1, 1))
    np.testing.assert_allclose(found.stiffness, [up, down], rtol=1e-8)
    np.testing.assert_allclose(found.inertia, 0.3, rtol=1e-9)


def test_a_balanced_inverted_slider_crank_does_not_shake(everything: Specs, made: Maker) -> None:
    spec = replace(lossless(everything[InvertedSliderCrank]), springs=(), torsion_springs=(), gravity=(0, 0))
    for linkage in made(InvertedSliderCrank, 10):
        masses, loads = stated_masses(linkage, spec), analysis.stated_loads(spec, 1.0)
        state = solve_kinematics(linkage, np.linspace(0, 6, 50), 3.0, 2.0)
        before = inverse_dynamics(state, masses, loads)
        balanced = analysis.balance_force(linkage, masses, 0.5, 0.7).masses
        after = inverse_dynamics(state, balanced, loads)
        scale = np.abs(before.shaking_force).max()
        np.testing.assert_allclose(after.shaking_force, 0, atol=1e-10 * scale)


def test_a_slider_crank_is_not_balanced_by_weights_on_links_that_turn_about_the_ground() -> None:
    with pytest.raises(ProblemError, match=r"^a slider-crank has no link 4 that turns about the ground"):
        analysis.balance_force(SliderCrank((0, 0), 1, 3), WEIGHTLESS)


STEEL = problems.StrengthSpec(235e6, 210e9, pin_diameter=0.02)


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
        structure = analysis.Structure(WEIGHTLESS, loads, SectionSpec(0.1, 0.05), STEEL)
        stress = analysis.strength_at(state, structure).bars[3]["normal_stress"]
        bending = 7.0 * 0.05 / (0.05 * 0.1**3 / 12)
        assert (stress.value >= bending * (1 - 1e-12)).all()
        np.testing.assert_allclose(stress.at, travel, rtol=1e-9)


def test_an_engine_rod_is_pushed_by_gas_over_the_cosine() -> None:
    engine = SliderCrank((0, 0), 0.05, 0.2)
    gas = Loads(forces=(analysis.AppliedForce(4, (0.0, 0.0), (-3000.0, 0.0)),))
    state = solve_kinematics(engine, np.radians([10.0, 60.0, 120.0]), 0.0)
    structure = analysis.Structure(WEIGHTLESS, gas, SectionSpec(0.02, 0.01), STEEL)
    found = analysis.strength_at(state, structure)
    phi = np.arcsin(0.25 * np.sin(state.theta2))
    np.testing.assert_allclose(found.bars[3]["thrust"].value, 3000 / np.cos(phi), rtol=1e-12)
    assert list(found.bars) == [2, 3]
    assert list(found.pins) == [analysis.Joint.O2, analysis.Joint.A, analysis.Joint.B]
    assert list(analysis.strength_at(state, structure, links=[2]).bars) == [2]


@pytest.mark.quick("0.0254-InvertedSliderCrank")
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("metre", [1.0, 1e-3, 0.0254])
def test_strength_over_a_turn_is_that_of_a_dense_search(
    kind: type[Linkage], metre: float, made: Maker
) -> None:
    linkage = made(kind, 2, margin=0.2)[1].scaled(1 / metre, np.zeros(2))
    masses, weight = (
        analysis.uniform_bars(linkage, 5.0 * metre, payload=1.0),
        Loads(gravity=(0, -9.81 / metre)),
    )
    steel = problems.StrengthSpec(235e6, 210e9, pin_diameter=0.02 / metre)
    structure = analysis.Structure(masses, weight, SectionSpec(0.05 / metre, 0.03 / metre), steel, metre)

    def motion(theta2: FloatArray) -> analysis.Kinematics:
        return solve_kinematics(linkage, theta2, 4.0)

    found = analysis.strength_over(structure, motion, [analysis.driver_samples(linkage, 0.0, TURN)])
    dense = analysis.strength_at(motion(np.linspace(0, TURN, 1001)), structure)
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
        analysis.section_forces(solve_kinematics(engine, 1.0), analysis.uniform_bars(engine, 1.0), links=[4])
