"""Slider kinds left to themselves, at rest, in equilibrium, with a flywheel: energy, work, closed forms."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import (
    Body,
    Ending,
    Friction,
    Loads,
    Masses,
    balance_force,
    energies,
    equilibria,
    free_response,
    generalised_inertia,
    holding,
    inverse_dynamics,
    solve_kinematics,
    stated_loads,
    stated_masses,
)
from grashof.analysis.numerics import collocation
from grashof.problems import DynamicsSpec, InvertedSliderCrank, ProblemError, SliderCrank
from grashof.problems.values.dynamics.acting import FrictionSpec, LoadSpec
from grashof.problems.values.linkages.linkage import Linkage

TURN = 2 * np.pi
KINDS = (SliderCrank, InvertedSliderCrank)
Maker = Callable[..., list[Linkage]]
Specs = dict[type[Linkage], DynamicsSpec]
NONE = Masses(Body(0.0), Body(0.0), Body(0.0))


def lossless(spec: DynamicsSpec) -> DynamicsSpec:
    return replace(spec, loads=(), dampers=(), friction=None)


@pytest.mark.study
@pytest.mark.quick("InvertedSliderCrank--40.0-2.0-0.3")
@pytest.mark.parametrize(("omega2", "lasts", "margin"), [(40.0, 2.0, 0.2), (-40.0, 2.0, 0.3)])
@pytest.mark.parametrize("kind", KINDS)
def test_a_released_linkage_keeps_its_energy_for_ten_turns(
    kind: type[Linkage], omega2: float, lasts: float, margin: float, everything: Specs, made: Maker
) -> None:
    for linkage in made(kind, 1, margin=margin):
        # A spring about a joint that turns fully is wound by less than half a turn, so its moment jumps.
        turning = kind is InvertedSliderCrank and linkage.r2 > linkage.r1
        springs = [each for each in everything[kind].torsion_springs if each.between != (2, 3)]
        spec = replace(lossless(everything[kind]), torsion_springs=() if turning else tuple(springs))
        masses, loads = stated_masses(linkage, spec), stated_loads(spec, 1.0)
        free = free_response(linkage, masses, np.linspace(0, lasts, 99), 0.4, omega2, loads=loads)
        assert free.ending is Ending.TIME
        assert abs(free.state.theta2[-1] - 0.4) > 10 * TURN
        assert np.ptp(free.energy) < 1e-11 * np.abs(free.energy).max()


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


@pytest.mark.study
def test_friction_of_a_slide_brings_an_engine_to_rest() -> None:
    engine = SliderCrank((0, 0), 0.05, 0.2)
    masses = Masses(Body(1.0, 0.01), Body(0.5, 0.002, (0.07, 0.0)), Body(0.4))
    loads = Loads(friction=Friction(slide_coulomb=2.0))
    begin = float(energies(solve_kinematics(engine, 0.3, 20.0), masses).total)
    free = free_response(engine, masses, np.linspace(0, 60, 50), 0.3, 20.0, loads=loads)
    assert free.ending is Ending.AT_REST
    last = free_response(engine, masses, np.array([0.0, free.end]), 0.3, 20.0, loads=loads).state
    travel = np.linspace(0.3, float(last.theta2[-1]), 200_001)
    slid = np.abs(np.diff(solve_kinematics(engine, travel).slide.travel)).sum()
    assert begin == pytest.approx(2.0 * slid, rel=1e-6)  # the work of friction, over the way of the slider


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
def test_dead_positions_hold_what_the_driver_cannot() -> None:
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
        whole = balance_force(linkage, masses, 0.5, 0.7).masses
        after = inverse_dynamics(state, whole, loads)
        scale = np.abs(before.shaking_force).max()
        np.testing.assert_allclose(after.shaking_force, 0, atol=1e-10 * scale)


def test_a_slider_crank_is_not_balanced_by_weights_on_links_that_turn_about_the_ground() -> None:
    with pytest.raises(ProblemError, match=r"^a slider-crank has no link 4 that turns about the ground"):
        balance_force(SliderCrank((0, 0), 1, 3), NONE)
