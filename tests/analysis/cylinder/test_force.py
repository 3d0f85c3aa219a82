"""The force of a cylinder on every kind of one loop: it leaves no drive torque."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from grashof.analysis import (
    AppliedForce,
    Friction,
    Kinematics,
    Loads,
    energies,
    inverse_dynamics,
    solve_kinematics,
    solve_position,
    system_of_equations,
    uniform_bars,
)
from grashof.analysis.cylinder.lengths import cylinder_force, cylinder_state
from grashof.problems import Cylinder, FourBar, InvertedSliderCrank, Linkage, SliderCrank

ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2.5, r4=3, coupler_point=(1, 1))
ENGINE = SliderCrank((0, 0), 2, 5, 0.4, 0.3, (1, 1))
SHAPER = InvertedSliderCrank((0, 0), (4, 0.3), 1.5, 0.3, (2, 1))
WEIGHT = Loads(gravity=(0.0, -9.8))
LOADS = replace(
    WEIGHT, forces=(AppliedForce(3, (1, 1), (3.0, -20.0)), AppliedForce(4, (0.3, 0.2), (5.0, -7.0)))
)

every = pytest.mark.parametrize("linkage", [ROCKER, ENGINE, SHAPER], ids=lambda each: each.mechanism.word)
LINKS = ("driver", "coupler", "output")
on_every_link = pytest.mark.parametrize("on", LINKS)
# Of the four-bar others have no lever somewhere in their range.
RUBBING = [(ROCKER, "driver"), *product((ENGINE, SHAPER), LINKS)]


def jack_on(on: str, linkage: Linkage) -> Cylinder:
    return Cylinder(on, base=(-2 if linkage is ROCKER else -6, -2.5), point=(1.2, -0.6))


def range_of(linkage: Linkage) -> np.ndarray:
    return np.linspace(0.35, 1.3, 21) if linkage is ROCKER else np.linspace(1.5, 2.4, 21)


def left(state: Kinematics, jack: Cylinder, loads: Loads, force: np.ndarray) -> float:
    """Torque left where the cylinder pushes, by the links one by one and by all equations at once."""
    found = cylinder_state(jack, state.linkage, state)
    push = force[:, None] * (found.pivot - np.array(jack.base)) / found.length[:, None]
    pushed = replace(loads, forces=(*loads.forces, AppliedForce(jack.link, jack.point, push)))
    masses = uniform_bars(state.linkage, 2.0)
    torque = np.abs(inverse_dynamics(state, masses, pushed).torque).max()
    if not loads.friction.slide_mu:
        torque = max(torque, np.abs(system_of_equations(state, masses, pushed).solution[..., -1]).max())
    return float(torque)


@every
@on_every_link
@pytest.mark.parametrize("omega2", [3.0, -3.0])
def test_no_torque_is_left_when_it_pushes(linkage: Linkage, on: str, omega2: float) -> None:
    state, masses = solve_kinematics(linkage, range_of(linkage), omega2, 1.5), uniform_bars(linkage, 2.0)
    force = cylinder_force(state, jack_on(on, linkage), masses, LOADS)
    scale = np.abs(inverse_dynamics(state, masses, LOADS).torque).max()
    assert np.isfinite(force).all()
    assert left(state, jack_on(on, linkage), LOADS, force) < 1e-9 * scale


@every
@on_every_link
def test_its_power_is_that_of_the_energy(linkage: Linkage, on: str) -> None:
    jack, step, masses, at = jack_on(on, linkage), 1e-5, uniform_bars(linkage, 2.0), range_of(linkage)
    force = cylinder_force(solve_kinematics(linkage, at, 1.0), jack, masses, WEIGHT)
    ahead, behind = (solve_kinematics(linkage, at + k, 1.0) for k in (step, -step))
    rise = np.asarray(energies(ahead, masses, WEIGHT).total) - energies(behind, masses, WEIGHT).total
    longer = cylinder_state(jack, linkage, ahead).length - cylinder_state(jack, linkage, behind).length
    np.testing.assert_allclose(
        force * longer, rise, rtol=1e-6, atol=1e-7 * np.abs(rise).max() * (linkage is not ROCKER)
    )


@pytest.mark.parametrize(("linkage", "on"), RUBBING)
def test_friction_follows_from_the_forces_of_the_cylinder(linkage: Linkage, on: str) -> None:
    if linkage is ROCKER:
        friction = Friction(coulomb=0.1, radius=0.02)
    else:
        friction = Friction(radius=(0.02, 0.02, 0, 0), slide_mu=0.1, slide_coulomb=0.5)
    jack, masses, loads = jack_on(on, linkage), uniform_bars(linkage, 2.0), replace(LOADS, friction=friction)
    state = solve_kinematics(linkage, range_of(linkage), 1.0)
    force = cylinder_force(state, jack, masses, loads)
    assert np.isfinite(force).all()
    assert left(state, jack, loads, force) < 1e-9 * np.abs(force).max()
    as_torque = inverse_dynamics(state, masses, loads).torque / cylinder_state(jack, linkage, state).rate
    assert np.abs(force - as_torque).max() > 1e-4 * np.abs(force).max()


def test_along_the_slide_it_bears_the_slider_s_load_alone() -> None:
    """Massless links: the force on the slider along its slide, and its friction besides."""
    state = solve_kinematics(ENGINE, range_of(ENGINE), 1.0)  # the slider goes back
    masses = uniform_bars(ENGINE, 0.0)
    along, beside = np.array([np.cos(0.3), np.sin(0.3)]), np.array([-np.sin(0.3), np.cos(0.3)])
    base = tuple(solve_position(ENGINE, state.theta2[0]).b - 12 * along)
    for pull, mu in ((50.0, 0.0), (50.0, 0.2)):
        loads = Loads(
            forces=(AppliedForce(4, (0, 0), pull * along + 30 * beside),), friction=Friction(slide_mu=mu)
        )
        force = cylinder_force(state, Cylinder("output", base, (0, 0)), masses, loads)
        np.testing.assert_allclose(force, -(pull + mu * 30), rtol=1e-9)
