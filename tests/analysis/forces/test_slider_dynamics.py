"""Slider kinds, driven or left to themselves: friction of slides, textbooks, rest and equilibrium."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from refusals import refusal

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    Body,
    Ending,
    Friction,
    Joint,
    Kinematics,
    Loads,
    Masses,
    TorsionSpring,
    balance_force,
    equilibria,
    free_response,
    generalised_inertia,
    holding,
    inverse_dynamics,
    solve_kinematics,
    stated_loads,
    stated_masses,
)
from grashof.analysis.forces.bars import bars_of
from grashof.analysis.forces.joints import joint_motion, slides_of
from grashof.analysis.forces.loads import wrenches
from grashof.analysis.numerics import collocation
from grashof.problems import DynamicsSpec, FourBar, InvertedSliderCrank, ProblemError, SliderCrank
from grashof.problems.values.dynamics.load_specs import FrictionSpec, LoadSpec
from grashof.problems.values.linkages.linkage import Linkage

TURN = 2 * np.pi
KINDS = (SliderCrank, InvertedSliderCrank)
Maker = Callable[..., list[Linkage]]
Specs = dict[type[Linkage], DynamicsSpec]
INCH = 0.0254


def state_of(linkage: Linkage, count: int = 97, speed: float = 3.0) -> Kinematics:
    return solve_kinematics(linkage, np.linspace(0.01, 6.27, count), speed, 2.0)


@pytest.mark.parametrize("kind", KINDS)
def test_friction_of_a_slide_is_as_stated(kind: type[Linkage], everything: Specs, made: Maker) -> None:
    for linkage in made(kind, 5):
        state, masses = state_of(linkage), stated_masses(linkage, everything[kind])
        (slide,) = slides_of(linkage)
        speed = joint_motion(state, slide)[1]
        weight = Loads(gravity=(0, -9.81))
        plain = inverse_dynamics(state, masses, weight)
        assert (plain.joint_moments == 0).all()
        rubbed = inverse_dynamics(
            state, masses, replace(weight, friction=Friction(slide_viscous=2.0, slide_coulomb=0.4))
        )
        expected = -2.0 * speed - 0.4 * np.sign(speed)
        np.testing.assert_allclose(rubbed.joint_moments[slide], expected, rtol=1e-12)
        for length in (0.0, 0.3):
            friction = Friction(slide_mu=0.05, slide_length=length)
            found = inverse_dynamics(state, masses, replace(weight, friction=friction))
            pressing = np.abs(found.slide_force)
            if length:  # two ends of a guide, their forces added
                ends = found.slide_force / 2 + found.slide_moment / length * np.array([[1], [-1]])
                pressing = np.abs(ends).sum(axis=0)
            expected = -0.05 * pressing * np.sign(speed)
            np.testing.assert_allclose(found.joint_moments[slide], expected, rtol=1e-9, atol=1e-12)


def test_norton_engine_with_lumped_masses() -> None:
    """Norton, sec. 14.4 to 14.6: exact in theta2 for a rod of two point masses; signs as here.

    Inertia torque = m_B r^2 omega^2 ... of the slider's acceleration, gas torque F r sin(theta)(1 + ...).
    """
    r, length, omega = 2.6 * INCH, 10.4 * INCH, 340.0
    engine = SliderCrank((0, 0), r, length)
    at_a, at_b, piston = 0.3, 0.2, 0.4
    crank_pin = Body(at_a, 0.0, (0.0, 0.0)) + Body(at_b, 0.0, (length, 0.0))
    masses = Masses(Body(0.0), crank_pin, Body(piston))
    theta = np.linspace(0, TURN, 181)
    found = inverse_dynamics(solve_kinematics(engine, theta, omega), masses)
    sine = r / length * np.sin(theta)
    cosine = np.sqrt(1 - sine**2)
    turning = r / length * np.cos(theta) / cosine
    bend = (-r / length * np.sin(theta) + sine * turning**2) / cosine  # of the rod's inclination
    acceleration = -(omega**2) * (r * np.cos(theta) + length * (cosine * turning**2 + sine * bend))
    pull = (at_b + piston) * acceleration
    arm = -r * np.sin(theta) - length * sine * turning  # dx/dtheta
    np.testing.assert_allclose(found.torque, pull * arm, rtol=0, atol=1e-12 * np.abs(pull * arm).max())
    # The guide takes what the rod's inclination makes of the pull on the piston.
    wall = pull * sine / cosine
    np.testing.assert_allclose(found.slide_force, wall, rtol=0, atol=1e-12 * np.abs(wall).max())
    # Two terms of the series in r / l (Norton, eqs. 14.12 and 14.14): right to their order.
    lam = r / length
    series = (
        0.5
        * (at_b + piston)
        * (r * omega) ** 2
        * (lam / 2 * np.sin(theta) - np.sin(2 * theta) - 1.5 * lam * np.sin(3 * theta))
    )
    np.testing.assert_allclose(-found.torque, series, rtol=0, atol=lam**2 * np.abs(series).max())
    shaking = (at_a * r * omega**2 * np.cos(theta)
               + (at_b + piston) * r * omega**2 * (np.cos(theta) + lam * np.cos(2 * theta)))  # fmt: skip
    np.testing.assert_allclose(
        found.shaking_force[:, 0], shaking, rtol=0, atol=lam**3 * np.abs(shaking).max()
    )
    np.testing.assert_allclose(
        found.shaking_force[:, 1], at_a * r * omega**2 * np.sin(theta), rtol=0, atol=1e-9 * shaking.max()
    )


def test_gas_on_the_piston_turns_the_crank_as_the_textbook_has_it() -> None:
    """F r sin(theta + phi) / cos(phi): exact (Norton, sec. 13.7; phi the rod's inclination)."""
    engine = SliderCrank((0, 0), 0.05, 0.2)
    theta = np.radians([10.0, 60.0, 120.0, 250.0])
    gas = Loads(forces=(AppliedForce(4, (0.0, 0.0), (-3000.0, 0.0)),))
    found = inverse_dynamics(solve_kinematics(engine, theta, 100.0), Masses(Body(0), Body(0), Body(0)), gas)
    phi = np.arcsin(0.25 * np.sin(theta))
    np.testing.assert_allclose(-found.torque, 3000 * 0.05 * np.sin(theta + phi) / np.cos(phi), rtol=1e-12)
    np.testing.assert_allclose(found.slide_force, 3000 * -np.tan(phi) * -1, rtol=1e-12)
    beside = Loads(forces=(AppliedForce(4, (0.0, 0.01), (-3000.0, 0.0)),))
    held = inverse_dynamics(solve_kinematics(engine, theta, 100.0), Masses(Body(0), Body(0), Body(0)), beside)
    np.testing.assert_allclose(held.torque, found.torque, rtol=1e-12)
    np.testing.assert_allclose(held.slide_moment, -30.0, rtol=1e-12)  # against 3000 N above B


def test_a_quick_return_that_cuts() -> None:
    """A force on the rod's end of a shaper without offset: the block turns it, moment over moment arm."""
    shaper = InvertedSliderCrank((0, 0), (0, -2), 1, coupler_point=(3.0, 0.0))
    theta = np.radians([20.0, 100.0, 200.0, 310.0])
    state = solve_kinematics(shaper, theta, 2.0)
    none = Masses(Body(0), Body(0), Body(0))
    moment = Loads(moments=(AppliedMoment(4, 7.0),))
    found = inverse_dynamics(state, none, moment)
    np.testing.assert_allclose(found.torque * 2.0, -7.0 * state.omega4, rtol=1e-12)
    # The rod carries the moment by the force across it at A, and across it in the block.
    arm = np.linalg.norm(state.a.position - shaper.o4, axis=-1)
    np.testing.assert_allclose(np.abs(found.slide_force), 7.0 / arm, rtol=1e-12)
    np.testing.assert_allclose(found.slide_moment, -7.0, rtol=1e-12)


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
    engine, bar = SliderCrank((0, 0), 1, 3), FourBar((0, 0), (4, 0), 1, 4, 3)
    none = Masses(Body(0), Body(0), Body(0))
    for linkage, loads, line in (
        (engine, Loads(torsion_springs=(TorsionSpring(Joint.O4, 1.0),)), "a torsion spring is at the slide"),
        (engine, Loads(friction=Friction(viscous=(0, 0, 0, 1))), "viscous friction in O4 is 1"),
        (bar, Loads(friction=Friction(slide_mu=0.1)), "slide_mu friction is 0.1; a four-bar has no slide"),
        (engine, Loads(friction=Friction(slide_mu=-0.1)), "slide_mu is -0.1"),
    ):
        message = refusal(inverse_dynamics, solve_kinematics(linkage, 1.0), none, loads)
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
            stated_loads(short, 1.0),
        )
    enough = replace(spec, loads=(replace(spec.loads[1], values=((2, 1, 0), (4, 2, 0))),))
    state = solve_kinematics(engine, np.array([0.0, np.pi]))
    felt = wrenches(state, stated_loads(replace(enough, springs=(), dampers=()), 1.0))
    np.testing.assert_allclose(felt[4].force, [[2, 0], [1, 0]], atol=1e-12)


NONE = Masses(Body(0.0), Body(0.0), Body(0.0))


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
        masses, loads = stated_masses(linkage, spec), stated_loads(spec, 1.0)
        time = np.linspace(0, 1.5, 40)
        free = free_response(linkage, masses, time, 0.3, 0.0, loads=loads)
        moving = free.state
        steady = inverse_dynamics(moving, masses, loads)
        inertia = generalised_inertia(linkage, moving.theta2, masses)
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
    masses, loads = stated_masses(crank, spec, 1e-3), stated_loads(spec, 1e-3)
    free = free_response(crank, masses, np.linspace(0, 0.06, 601), np.pi / 9, 0.0, loads=loads)
    assert free.end == pytest.approx(0.06)
    assert len(steps) < 300
    speeds = np.abs(free.state.omega2)
    assert speeds.max() > 100
    assert speeds[-20:].max() < 1e-3 * speeds.max()


@pytest.mark.slow
def test_in_dead_positions_the_output_holds_loads_that_the_driver_cannot() -> None:
    """A slider-crank whose driver swings: rod across the slide. A rod through O4's block, at its offset."""
    swings = SliderCrank((0, 0), 2.0, 1.0)
    weight, masses = Loads(gravity=(3, -10)), Masses(Body(1.0, 0, (1, 0)), Body(1.0, 0, (0.5, 0)), Body(1.0))
    dead = holding(swings, np.array([np.radians(30.0)]), masses, weight)
    assert np.abs(dead.torque[0]) > 1e6
    assert np.isfinite(dead.moment[0])
    free = free_response(swings, masses, np.linspace(0, 5, 9), 0.2, 2.0, loads=weight)
    assert free.ending is Ending.DEAD_POSITION
    rod = InvertedSliderCrank((0, 0), (2, 0), 1.5, 1.0)
    end = float(np.arccos((4 + 2.25 - 1) / (2 * 2 * 1.5)))
    dead = holding(rod, np.array([end, -end]), masses, weight)
    assert (np.abs(dead.torque) > 1e6).all()
    assert np.isfinite(dead.moment).all()
    free = free_response(rod, masses, np.linspace(0, 9, 9), 1.0, -3.0, loads=weight)
    assert free.ending is Ending.DEAD_POSITION


def test_equilibria_and_swings_of_a_hanging_engine() -> None:
    """A slider on a vertical slide: of x = r cos t + sqrt(l^2 - r^2 sin^2 t) the second derivatives."""
    r, length, mass = 0.5, 2.0, 3.0
    engine = SliderCrank((0, 0), r, length, slide_angle=-np.pi / 2)
    masses = Masses(Body(2.0, 0.3), Body(0.0), Body(mass))
    found = equilibria(engine, masses, Loads(gravity=(0, -9.81)), 0.0, TURN, closed=True)
    np.testing.assert_allclose(np.degrees(found.theta2), [90, 270], atol=1e-9)
    up, down = (mass * 9.81 * (r**2 / length + sign * r) for sign in (-1, 1))
    np.testing.assert_allclose(found.stiffness, [up, down], rtol=1e-8)
    np.testing.assert_allclose(found.inertia, 0.3, rtol=1e-9)


def test_a_balanced_inverted_slider_crank_does_not_shake(everything: Specs, made: Maker) -> None:
    spec = replace(lossless(everything[InvertedSliderCrank]), springs=(), torsion_springs=(), gravity=(0, 0))
    for linkage in made(InvertedSliderCrank, 10):
        masses, loads = stated_masses(linkage, spec), stated_loads(spec, 1.0)
        state = solve_kinematics(linkage, np.linspace(0, 6, 50), 3.0, 2.0)
        before = inverse_dynamics(state, masses, loads)
        balanced = balance_force(linkage, masses, 0.5, 0.7).masses
        after = inverse_dynamics(state, balanced, loads)
        scale = np.abs(before.shaking_force).max()
        np.testing.assert_allclose(after.shaking_force, 0, atol=1e-10 * scale)


def test_a_slider_crank_is_not_balanced_by_weights_on_links_that_turn_about_the_ground() -> None:
    with pytest.raises(ProblemError, match=r"^a slider-crank has no link 4 that turns about the ground"):
        balance_force(SliderCrank((0, 0), 1, 3), NONE)
