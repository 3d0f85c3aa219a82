"""Linkages and loads that tests of forces and strength share."""

import numpy as np
import pytest

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    Body,
    Joint,
    Kinematics,
    Loads,
    Masses,
    Spring,
    TorsionSpring,
    driver_ranges,
    solve_kinematics,
)
from grashof.problems import DeadPositionWarning, FourBar

TURN = 2 * np.pi
JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762, coupler_point=(1.7, 0.7))
# Its driver swings 108 deg either way.
ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3, coupler_point=(1, 1), assembly=-1)
MASSES = Masses(Body(2, 0.3, (0.4, 0.1)), Body(3, 0.5, (1.0, -0.3)), Body(1.5, 0.2, (0.7, 0.2)))
WEIGHT = Loads(gravity=(0, -9.81))
SPRUNG = Loads(
    gravity=(0, -9.81),
    springs=(Spring(1, (2, 0), 4, (1, 0.2), 20, 1.0),),
    torsion_springs=(TorsionSpring(Joint.B, 5.0, 1.0), TorsionSpring(Joint.O4, 3.0, -2.0)),
)
LOADS = Loads(
    gravity=(1.0, -9.81),
    forces=(AppliedForce(3, (0.3, 0.4), (5.0, -7.0)), AppliedForce(4, (1, 0), (0.0, 8.0), turning=True)),
    moments=(AppliedMoment(2, 3.0), AppliedMoment(4, lambda state: np.sin(state.theta2))),
    springs=(Spring(1, (2, 0), 4, (1, 0.2), 20, 1.0, damping=4.0), Spring(2, (0.5, 0), 4, (1, 0), 10, 0.5)),
    torsion_springs=(TorsionSpring(Joint.B, 5.0, 1.0), TorsionSpring(Joint.A, 2.0, -1.0)),
)


def closed_dead_and_open() -> Kinematics:
    """A rocker in three positions, of which forces are finite in the first alone."""
    with pytest.warns(DeadPositionWarning):
        return solve_kinematics(ROCKER, [0.0, driver_ranges(ROCKER)[0, 1], 3.0])
