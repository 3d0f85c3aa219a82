"""Inverse dynamics of slider kinds: virtual work, power, balance of each link and of the whole, textbooks."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from refusals import refusal

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    Body,
    Friction,
    Joint,
    Kinematics,
    Loads,
    Masses,
    TorsionSpring,
    inverse_dynamics,
    solve_kinematics,
    stated_loads,
    stated_masses,
)
from grashof.analysis.forces.bars import bars_of
from grashof.analysis.forces.joints import joint_motion, slides_of
from grashof.analysis.forces.loads import wrenches
from grashof.problems import DynamicsSpec, FourBar, InvertedSliderCrank, ProblemError, SliderCrank
from grashof.problems.values.linkages.linkage import Linkage

TURN = 2 * np.pi
KINDS = (SliderCrank, InvertedSliderCrank)
Maker = Callable[..., list[Linkage]]
Specs = dict[type[Linkage], DynamicsSpec]
INCH = 0.0254


def state_of(linkage: Linkage, count: int = 97, speed: float = 3.0) -> Kinematics:
    return solve_kinematics(linkage, np.linspace(0.01, 6.27, count), speed, 2.0)


@pytest.mark.parametrize("kind", KINDS)
def test_friction_of_a_slide_is_what_is_stated(kind: type[Linkage], everything: Specs, made: Maker) -> None:
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


def test_what_a_kind_has_not_is_refused_in_one_line() -> None:
    engine, bar = SliderCrank((0, 0), 1, 3), FourBar((0, 0), (4, 0), 1, 4, 3)
    none = Masses(Body(0), Body(0), Body(0))
    for linkage, loads, line in (
        (engine, Loads(torsion_springs=(TorsionSpring(Joint.O4, 1.0),)), "a torsion spring is at the slide"),
        (engine, Loads(friction=Friction(viscous=(0, 0, 0, 1))), "viscous friction in O4 is 1"),
        (bar, Loads(friction=Friction(slide_mu=0.1)), "slide_mu friction is 0.1; a four-bar has no slide"),
        (engine, Loads(friction=Friction(slide_mu=-0.1)), "slide_mu is -0.1"),
    ):
        told = refusal(inverse_dynamics, solve_kinematics(linkage, 1.0), none, loads)
        assert told.startswith(line)
        assert len(told.splitlines()) == 1


def test_a_load_over_travel_has_to_cover_it(everything: Specs) -> None:
    engine = SliderCrank((0, 0), 1, 3)
    spec = everything[SliderCrank]
    short = replace(spec, loads=(replace(spec.loads[1], values=((2.5, 1, 0), (4, 2, 0))),))
    with pytest.raises(ProblemError, match=r"^a load over travel covers 2.5 to 4; the slide comes to 2, too"):
        inverse_dynamics(
            solve_kinematics(engine, np.linspace(0, TURN, 9)),
            stated_masses(engine, spec),
            stated_loads(short, 1.0),
        )
    whole = replace(spec, loads=(replace(spec.loads[1], values=((2, 1, 0), (4, 2, 0))),))
    state = solve_kinematics(engine, np.array([0.0, np.pi]))
    felt = wrenches(state, stated_loads(replace(whole, springs=(), dampers=()), 1.0))
    np.testing.assert_allclose(felt[4].force, [[2, 0], [1, 0]], atol=1e-12)
