"""The force of a cylinder: what it leaves of the drive torque, by the equations of all links, is nothing."""

from dataclasses import replace

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
    system_of_equations,
    uniform_bars,
)
from grashof.analysis.cylinder.force import cylinder_force
from grashof.analysis.cylinder.lengths import cylinder_state
from grashof.problems import Cylinder, FourBar

LINKAGE = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2.5, r4=3, coupler_point=(1, 1))
MASSES = uniform_bars(LINKAGE, 2.0)
LOADS = Loads(gravity=(0.0, -9.8), forces=(AppliedForce(3, (1, 1), (3.0, -20.0)),))
LINKS = ("driver", "coupler", "output")


def jack_on(on: str) -> Cylinder:
    return Cylinder(on, base=(-2, -2.5), point=(1.2, -0.6))


def pushed(state: Kinematics, jack: Cylinder, loads: Loads, force: np.ndarray) -> Loads:
    found = cylinder_state(jack, LINKAGE, state)
    out = (found.pivot - np.array(jack.base)) / found.length[:, None]
    return replace(loads, forces=(*loads.forces, AppliedForce(jack.link, jack.point, force[:, None] * out)))


@pytest.mark.parametrize("on", LINKS)
@pytest.mark.parametrize("omega2", [3.0, -3.0])
def test_no_torque_is_left_when_it_pushes(on: str, omega2: float) -> None:
    state, jack = solve_kinematics(LINKAGE, np.linspace(0.35, 1.3, 21), omega2, 1.5), jack_on(on)
    force = cylinder_force(state, jack, MASSES, LOADS)
    scale = np.abs(inverse_dynamics(state, MASSES, LOADS).torque).max()
    loads = pushed(state, jack, LOADS, force)
    assert np.abs(inverse_dynamics(state, MASSES, loads).torque).max() < 1e-9 * scale
    whole = system_of_equations(state, MASSES, loads)  # nine equations at once
    assert np.abs(whole.solution[..., -1]).max() < 1e-9 * scale


@pytest.mark.parametrize("on", LINKS)
def test_its_power_is_that_of_energies_and_loads(on: str) -> None:
    jack, step = jack_on(on), 1e-5
    theta2 = np.linspace(0.35, 1.3, 9)
    state = solve_kinematics(LINKAGE, theta2, 1.0)
    force = cylinder_force(state, jack, MASSES, Loads(gravity=(0.0, -9.8)))

    def energy(angles: np.ndarray) -> np.ndarray:
        return np.asarray(
            energies(solve_kinematics(LINKAGE, angles, 1.0), MASSES, Loads(gravity=(0.0, -9.8))).total
        )

    rate = (energy(theta2 + step) - energy(theta2 - step)) / (2 * step)
    lengthens = [
        cylinder_state(jack, LINKAGE, solve_kinematics(LINKAGE, theta2 + k)).length for k in (step, -step)
    ]
    np.testing.assert_allclose(force * (lengthens[0] - lengthens[1]) / (2 * step), rate, rtol=1e-6)


def test_pin_friction_follows_from_the_forces_of_the_cylinder() -> None:
    loads = replace(LOADS, friction=Friction(coulomb=0.1, radius=0.02))
    state, jack = solve_kinematics(LINKAGE, np.linspace(0.35, 1.3, 21), 1.0), jack_on("driver")
    force = cylinder_force(state, jack, MASSES, loads)
    left = inverse_dynamics(state, MASSES, pushed(state, jack, loads, force)).torque
    assert np.abs(left).max() < 1e-9 * np.abs(force).max()
    as_torque = inverse_dynamics(state, MASSES, loads).torque / cylinder_state(jack, LINKAGE, state).rate
    assert np.abs(force - as_torque).max() > 1e-4 * np.abs(force).max()


def test_without_loads_there_is_no_force() -> None:
    state = solve_kinematics(LINKAGE, np.linspace(0.35, 1.3, 5), 0.0)
    assert (cylinder_force(state, jack_on("output"), MASSES, Loads()) == 0).all()
