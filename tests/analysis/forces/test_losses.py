"""What friction and dampers take is what the drive gives, less what the rest stores and does."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import (
    damper_power,
    friction_power,
    inverse_dynamics,
    mechanical_energy,
    solve_kinematics,
    stated_loads,
    stated_masses,
)
from grashof.problems import DynamicsSpec, FourBar


@pytest.mark.parametrize("omega2", [4.0, -4.0])
def test_power_is_balanced(
    omega2: float, everything: DynamicsSpec, linkages: Callable[[int], list[FourBar]]
) -> None:
    """Drive power = rate of energy + losses, at every instant."""
    spec = replace(everything, loads=())
    for linkage in linkages(10):
        masses, loads = stated_masses(linkage, spec), stated_loads(spec, 1.0)
        theta2, h = np.linspace(0.1, 6.2, 97), 1e-5
        states = [solve_kinematics(linkage, theta2 + omega2 * shift, omega2) for shift in (-h, 0.0, h)]
        before, _, after = (mechanical_energy(state, masses, loads) for state in states)
        found = inverse_dynamics(states[1], masses, loads)
        lost = friction_power(states[1], loads, found)
        assert (lost >= 0).all()
        taken = lost.sum(axis=0) + damper_power(states[1], loads) + (after - before) / (2 * h)
        np.testing.assert_allclose(found.power, taken, rtol=0, atol=1e-6 * np.abs(found.power).max())
