"""Energies, and the powers that change them."""

from dataclasses import replace

import numpy as np

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    Body,
    Friction,
    Joint,
    Loads,
    Masses,
    Spring,
    TorsionSpring,
    driver_motion,
    energies,
    powers,
    solve_kinematics,
)
from grashof.problems import FourBar

JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762, coupler_point=(1.7, 0.7))
MASSES = Masses(Body(2, 0.3, (0.4, 0.1)), Body(3, 0.5, (1.0, -0.3)), Body(1.5, 0.2, (0.7, 0.2)))
LOADS = Loads(
    gravity=(1.0, -9.81),
    forces=(AppliedForce(3, (0.3, 0.4), lambda s: np.stack([s.omega2, -3 * s.theta2], axis=-1)),),
    moments=(AppliedMoment(2, 3.0), AppliedMoment(4, lambda state: np.sin(state.theta2))),
    springs=(Spring(1, (2, 0), 4, (1, 0.2), 20, 1.0, damping=4.0), Spring(2, (0.5, 0), 4, (1, 0), 10, 0.5)),
    torsion_springs=(TorsionSpring(Joint.B, 5.0, 1.0), TorsionSpring(Joint.A, 2.0, -1.0)),
    friction=Friction(viscous=0.3, coulomb=(0.1, 0.2, 0.3, 0.4), radius=0.02),
)


def state_at(time: np.ndarray, sense: float = 1.0) -> object:
    return solve_kinematics(JACK, *driver_motion(lambda t: sense * (1.5 * t + 0.2 * np.sin(3 * t)), time))


def test_each_power_is_by_itself() -> None:
    state = state_at(np.linspace(0, 4, 30))
    smooth = replace(LOADS, friction=Friction())
    assert np.abs(powers(state, MASSES, smooth).friction).max() < 1e-12
    conservative = Loads(LOADS.gravity, springs=LOADS.springs[1:], torsion_springs=LOADS.torsion_springs)
    assert np.abs(powers(state, MASSES, conservative).loads).max() < 1e-12
    damped = Loads(springs=LOADS.springs[:1])
    assert (powers(state, MASSES, damped).loads <= 0).all()


def test_kinetic_energy_is_that_of_every_particle() -> None:
    """A bar as many points."""
    bar = Body(3.0, 3.0 * 3.048762**2 / 12, (3.048762 / 2, 0.0))
    state = state_at(np.linspace(0, 4, 5))
    found = energies(state, Masses(Body(0), Body(0), bar), Loads(gravity=(0, -9.81)))
    nodes, weights = np.polynomial.legendre.leggauss(4)
    along = 3.048762 * (nodes + 1) / 2
    points = [state.point(4, (at, 0.0)) for at in along]
    kinetic = sum(w * 1.5 / 2 * p.speed**2 for w, p in zip(weights, points, strict=True))
    height = sum(w * 1.5 * 9.81 * p.position[:, 1] for w, p in zip(weights, points, strict=True))
    np.testing.assert_allclose(found.kinetic[2], kinetic, rtol=1e-12)
    np.testing.assert_allclose(found.weight, height, rtol=1e-12)
    np.testing.assert_array_equal(found.kinetic[:2], 0)
    np.testing.assert_allclose(found.total, kinetic + height, rtol=1e-12)
