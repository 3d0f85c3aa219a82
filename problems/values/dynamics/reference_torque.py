"""The torque that objectives count torques in."""

from __future__ import annotations

import math

from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec


def reference_torque(spec: DynamicsSpec, task_size: float, metre: float) -> float:
    """What `Problem.reference_torque` states, N m, from the size of the task and its unit in metres."""
    size = task_size * metre
    mass = (spec.mass_per_length or 0.0) * task_size + sum(spec.masses or ()) + spec.payload
    mass += sum(weight.mass for weight in spec.counterweights)
    if spec.density is not None and spec.section is not None:
        mass += spec.density * max(spec.section.areas) * metre**2 * size
    torque = mass * size * (math.hypot(*spec.gravity) + spec.omega2**2 * size)
    torque += sum(load.greatest * (1.0 if load.is_moment else size) for load in spec.loads)
    torque += sum(spring.stiffness for spring in spec.springs) * size**2
    torque += sum(damper.damping for damper in spec.dampers) * spec.omega2 * size**2
    torque += sum(spring.stiffness for spring in spec.torsion_springs)
    if spec.friction is not None:
        torque += max(spec.friction.moment) + max(spec.friction.viscous) * spec.omega2
    return torque or 1.0
