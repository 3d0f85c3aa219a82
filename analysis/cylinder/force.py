"""The force of a cylinder that moves a linkage."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from grashof.analysis.cylinder.lengths import cylinder_state
from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.loads import AppliedForce, Loads
from grashof.analysis.forces.mass import Masses
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems import Cylinder
from grashof.problems.values.arrays import BoolArray, FloatArray

_ROUNDS, _SECANTS, _SETTLED = 60, 30, 1e-13


def cylinder_force(state: Kinematics, cylinder: Cylinder, masses: Masses, loads: Loads) -> FloatArray:
    """Force of a cylinder without mass or friction of its own, shape (...), in newtons over the metre.

    Positive where it pushes; infinite where its length stands, or friction locks it. Virtual work (Norton,
    *Design of Machinery*, sec. 11.10): F dL/dtheta2 = T, the torque on link 2. Friction that grows with joint
    forces depends on what drives: there F is put on the link and corrected until no torque is left.
    """
    found = cylinder_state(cylinder, state.linkage, state)
    out = found.pivot - np.asarray(cylinder.base)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        force: FloatArray = inverse_dynamics(state, masses, loads).torque / found.rate
        if not loads.friction.of(state.linkage, "radius").any():
            return force
        push = out / found.length[..., None]

        def step(tried: FloatArray) -> FloatArray:
            """The correction that the torque left at some forces would take, friction as it is there."""
            pushed = AppliedForce(cylinder.link, cylinder.point, tried[..., None] * push)
            left = inverse_dynamics(state, masses, replace(loads, forces=(*loads.forces, pushed))).torque
            return np.asarray(left / found.rate)

        for _ in range(_ROUNDS):
            before, last = force, step(force)
            force = force + last
            settled = np.abs(last) <= _SETTLED * np.abs(force)
            if settled.all():
                return force
        settled, force = _by_secants(step, settled, (before, last), force)
        return np.where(settled | np.isnan(force), force, np.inf)


def _by_secants(
    step: Callable[[FloatArray], FloatArray],
    settled: BoolArray,
    known: tuple[FloatArray, FloatArray],
    force: FloatArray,
) -> tuple[BoolArray, FloatArray]:
    """Forces where friction is nearly as much as what the cylinder gives: there single steps hardly end.

    Friction that grows faster than that, so that more force leaves more to be done, locks.
    """
    before, last = known
    moving = ~settled
    for _ in range(_SECANTS):
        now = step(force)
        slope = (now - last) / (force - before)
        there = moving & (np.abs(now) <= _SETTLED * np.abs(force))
        settled, moving = settled | there, moving & ~there & (slope < 0)
        before, last = np.where(moving, force, before), np.where(moving, now, last)
        force = np.where(moving, force - now / slope, force)
        if not moving.any():
            break
    return settled, force
