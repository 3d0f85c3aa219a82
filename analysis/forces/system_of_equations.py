"""The nine equations of inverse dynamics as one linear system: a second way, beside solving them in order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from grashof.analysis.forces.dynamics import Dynamics, inverse_dynamics
from grashof.analysis.forces.joints import Joint, slide_direction, slide_normal, slide_of
from grashof.analysis.forces.loads import Loads, cross, known_joint_moments, wrenches
from grashof.analysis.forces.mass import Masses
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems.values.arrays import FloatArray

# Each link with its joints: the columns of the force in it, and +1 or -1 as the link feels it.
_FELT = {2: ((0, 1), (2, 1)), 3: ((2, -1), (4, 1)), 4: ((4, -1), (6, 1))}
_FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12")
# Instead of the two components of the force in a slide: that across it, and its moment on link 4.
_IN_SLIDE = {Joint.B: (4, ("F43n", "M34")), Joint.O4: (6, ("F14n", "M14"))}


@dataclass(frozen=True, slots=True, eq=False)
class SystemOfEquations:
    """Newton's and Euler's equations of links 2, 3 and 4, three each, moments about the centres of mass.

    Parameters
    ----------
    matrix : ndarray, shape (..., 9, 9)
        Rows as `EQUATIONS`, columns as `unknowns`: 1 and -1 of forces (cosines of forces across a slide),
        arms (length) of moments.
    right_side : ndarray, shape (..., 9), N and N length
        Inertia less all that is known: weight, outer forces, springs, friction.
    unknowns : tuple of str
        Forces and the drive torque, `UNKNOWNS`; of a slide the force across it (n, to its left) and the
        moment on link 4, M14 or M34, instead of two components.
    """

    UNKNOWNS: ClassVar = _FORCES
    EQUATIONS: ClassVar = tuple(f"link {link}, {what}" for link in _FELT for what in ("x", "y", "moment"))

    matrix: FloatArray
    right_side: FloatArray
    unknowns: tuple[str, ...] = _FORCES

    @property
    def solution(self) -> FloatArray:
        """The unknowns, shape (..., 9), N and N length; NaN where the linkage is open or dead."""
        known = np.asarray(np.isfinite(self.matrix).all(axis=(-2, -1)) & np.isfinite(self.right_side).all(-1))
        matrix = np.where(known[..., None, None], self.matrix, np.eye(len(self.unknowns)))
        right_side = np.where(known[..., None], self.right_side, np.nan)
        found: FloatArray = np.linalg.solve(matrix, right_side[..., None])
        return found[..., 0]


@np.errstate(invalid="ignore", over="ignore")
def system_of_equations(
    state: Kinematics, masses: Masses, loads: Loads | None = None, joint_moments: FloatArray | None = None
) -> SystemOfEquations:
    """The system of equations whose solution is what `inverse_dynamics` finds.

    Parameters
    ----------
    state : Kinematics
    masses : Masses
    loads : Loads, optional
        None by default.
    joint_moments : ndarray, shape (4, ...), N length, optional
        Of friction and torsion springs, on the second link of each joint (in a slide the force along it),
        as `Dynamics` has them. By
        default those of the loads; friction that grows with the joint forces, which would make the
        system nonlinear, is taken from `inverse_dynamics`.

    Returns
    -------
    SystemOfEquations

    Notes
    -----
    Norton, *Design of Machinery*, sec. 11.4: of each link the sum of forces is m a, and the moments of the
    joint forces about its centre of mass, R x F = Rx Fy - Ry Fx, with what else turns it, are I alpha.

    Examples
    --------
    >>> from grashof.analysis.mechanism.kinematics import solve_kinematics
    >>> from grashof.analysis.forces.mass import uniform_bars
    >>> from grashof.problems import FourBar
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> state = solve_kinematics(jack, np.radians(60), 2 * np.pi / 3)
    >>> system = system_of_equations(state, uniform_bars(jack, (312, 312, 314)), Loads(gravity=(0, -9.81)))
    >>> dict(zip(system.unknowns, system.solution.round(6).tolist()))["T12"]
    5507.711124
    """
    loads = Loads() if loads is None else loads
    if joint_moments is None:
        joint_moments = _moments_in_joints(state, masses, loads)
    linkage, gravity = state.linkage, loads.gravity_vector()
    outside = wrenches(state, loads)
    a, b = state.a.position, state.b.position
    slide, along = slide_of(linkage), slide_direction(state)
    on_ground = b if slide is Joint.O4 else state.origin(4).position
    joints = {2: (linkage.o2, a), 3: (a, b), 4: (b, on_ground)}
    turning, rubbing = joint_moments.copy(), np.zeros((*state.shape, 9))
    if slide is not None:  # its friction is a force, known, on link 4 along the slide
        column = _IN_SLIDE[slide][0]
        sign = 1.0 if slide is Joint.O4 else -1.0
        rubbing[..., column : column + 2] = sign * joint_moments[slide][..., None] * along
        turning[slide] = 0.0
    couples = {2: turning[0] - turning[1], 3: turning[1] - turning[2], 4: turning[2] + turning[3]}
    matrix, right_side = np.zeros((*state.shape, 9, 9)), np.zeros((*state.shape, 9))
    for row, (link, felt) in zip((0, 3, 6), _FELT.items(), strict=True):
        body, alpha = masses.of(link), state.angular(link)[2]
        centre = state.point(link, body.centre)
        for place, (column, sign) in zip(joints[link], felt, strict=True):
            arm = place - centre.position
            matrix[..., row, column] = matrix[..., row + 1, column + 1] = sign
            matrix[..., row + 2, column] = -sign * arm[..., 1]
            matrix[..., row + 2, column + 1] = sign * arm[..., 0]
        mass, force = np.asarray(body.mass)[..., None], outside[link].force
        known = outside[link].moment - cross(centre.position - state.origin(link).position, force)
        right_side[..., row : row + 2] = mass * (centre.acceleration - gravity) - force
        right_side[..., row + 2] = body.inertia * alpha - known - couples[link]
    matrix[..., 2, 8] = 1
    if slide is None:
        return SystemOfEquations(matrix, right_side)
    return _with_slide(state, matrix, right_side - (matrix @ rubbing[..., None])[..., 0], slide)


def _with_slide(
    state: Kinematics, matrix: FloatArray, right_side: FloatArray, slide: Joint
) -> SystemOfEquations:
    """The system with the force across the slide and its moment for the components of the force in it."""
    column, names = _IN_SLIDE[slide]
    across = slide_normal(state)
    matrix[..., column] = (matrix[..., column : column + 2] * across[..., None, :]).sum(axis=-1)
    matrix[..., column + 1] = 0.0
    matrix[..., 8, column + 1] = 1.0
    if slide is Joint.B:
        matrix[..., 5, column + 1] = -1.0
    return SystemOfEquations(matrix, right_side, (*_FORCES[:column], *names, *_FORCES[column + 2 :]))


def _moments_in_joints(state: Kinematics, masses: Masses, loads: Loads) -> FloatArray:
    if loads.friction.of(state.linkage, "radius").any():
        found: Dynamics = inverse_dynamics(state, masses, loads)
        return found.joint_moments
    return known_joint_moments(state, loads)
