"""Linkages and loads that tests of forces, strength and wanted torques share."""

from dataclasses import replace
from typing import Any

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
    verify,
)
from grashof.analysis.judge.planted import planted_motion
from grashof.analysis.judge.wanted_torque import torque_misses
from grashof.problems import (
    DeadPositionWarning,
    DynamicsSpec,
    FourBar,
    Linkage,
    PathTask,
    Problem,
    Requirements,
    WantedTorque,
)
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.load_specs import LoadSpec, Place, SpringSpec

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


ROWS = 7  # of a planted torque


def loads(rng: np.random.Generator, size: float) -> DynamicsSpec:
    """Bars, a payload, a force on the coupler, and a spring from there to the ground."""
    at = (float(rng.uniform(-0.5, 0.5) * size), 0.0)
    ends = [tuple(rng.uniform(-far * size, far * size, 2).tolist()) for far in (2, 1)]
    return DynamicsSpec(
        mass_per_length=float(rng.uniform(0.5, 3)),
        payload=float(rng.uniform(5, 40)),
        speed_rpm=10,
        gravity=(0, -9.80665),
        loads=(LoadSpec(3, at=at, force=tuple(rng.uniform(-200, 200, 2).tolist())),),
        springs=(
            SpringSpec(
                (Place(1, ends[0]), Place(3, ends[1])),
                float(rng.uniform(50, 500)),
                float(rng.uniform(0, size)),
            ),
        ),
    )


def wanted_of(problem: Problem, linkage: Linkage, places: FloatArray, **others: Any) -> WantedTorque:
    """The torques that a linkage has at places of a task."""
    none = WantedTorque([(place, 0.0) for place in places.tolist()], others.get("over", "share"))
    stated = replace(problem, torque=none)
    verdict = verify(linkage, problem.task, problem.requirements, problem=stated)
    torques = torque_misses(linkage, stated, verdict)
    return WantedTorque(list(zip(places.tolist(), torques.tolist(), strict=True)), **others)


def planted_torque(
    seed: int, poses: int, mechanism: str = FourBar.mechanism.word, over: str = "share"
) -> tuple[Problem, Any]:
    """Poses to be met, and the torque of the planted linkage at `ROWS` places, or at every target."""
    rng = np.random.default_rng(seed)
    task, linkage = planted_motion(rng, poses, mechanism=mechanism)
    problem = Problem(task=task, mechanism=mechanism, length_unit="m", dynamics=loads(rng, task.size))
    places = np.linspace(0, 1, ROWS) if over == "share" else np.arange(1, poses + 1)
    torque = wanted_of(problem, linkage, places, over=over)
    return replace(problem, torque=torque, objective=None), linkage


def planted_path_torque(seed: int, points: int, weight: float = 1.0) -> tuple[Problem, Any]:
    """The same of points by least squares, with a weight of the torque."""
    problem, linkage = planted_torque(seed, points)
    task, wanted = PathTask(problem.task.positions), Requirements(exact=False)
    least = replace(problem, task=task, requirements=wanted, torque=None, objective=None)
    torque = wanted_of(least, linkage, np.linspace(0, 1, ROWS), over="share", weight=weight)
    return replace(least, torque=torque), linkage
