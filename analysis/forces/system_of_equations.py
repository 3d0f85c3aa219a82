"""The equations of inverse dynamics as one linear system: a second way, beside solving them in order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from grashof.analysis.forces.dynamics import Dynamics, inverse_dynamics
from grashof.analysis.forces.joints import Joint, joints_of, slide_direction, slide_normal
from grashof.analysis.forces.loads import Loads, cross, known_joint_moments, wrenches
from grashof.analysis.forces.mass import Masses
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems.values.arrays import FloatArray

_FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12")
_PARTS = ("x", "y", "moment")


@dataclass(frozen=True, slots=True, eq=False)
class SystemOfEquations:
    """Newton's and Euler's equations of the moving links, three each, moments about the centres of mass.

    Parameters
    ----------
    matrix : ndarray, shape (..., N, N)
        Rows as `equations`, columns as `unknowns`: 1 and -1 of forces (cosines of forces across a slide),
        arms (length) of moments. Nine of each; of a six-bar fifteen.
    right_side : ndarray, shape (..., N), N and N length
        Inertia less all that is known: weight, outer forces, springs, friction.
    unknowns : tuple of str
        Forces and the drive torque, `UNKNOWNS` of a linkage of one loop; of a slide the force across it (n,
        to its left) and the moment on the slider or block, M14 or M34, instead of two components.
    equations : tuple of str
        `EQUATIONS` of a linkage of one loop.
    """

    UNKNOWNS: ClassVar = _FORCES
    EQUATIONS: ClassVar = tuple(f"link {link}, {what}" for link in (2, 3, 4) for what in _PARTS)

    matrix: FloatArray
    right_side: FloatArray
    unknowns: tuple[str, ...]
    equations: tuple[str, ...]

    @property
    def solution(self) -> FloatArray:
        """The unknowns, shape (..., N), N and N length; NaN where the linkage is open or dead."""
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
    joint_moments : ndarray, shape (J, ...), N length, optional
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
    kind, gravity, outside = state.linkage.mechanism, loads.gravity_vector(), wrenches(state, loads)
    bodies, columns = (
        masses.by_link(state.linkage),
        [_column(state, joint) for joint in joints_of(state.linkage)],
    )
    size = 3 * len(bodies)
    matrix, right_side = np.zeros((*state.shape, size, size)), np.zeros((*state.shape, size))
    centres = {link: state.point(link, body.centre) for link, body in bodies.items()}
    for row, (link, body) in zip(range(0, size, 3), bodies.items(), strict=True):
        centre, force = centres[link], outside[link].force
        known = outside[link].moment - cross(centre.position - state.origin(link).position, force)
        mass = np.asarray(body.mass)[..., None]
        right_side[..., row : row + 2] = mass * (centre.acceleration - gravity) - force
        right_side[..., row + 2] = body.inertia * state.angular(link)[2] - known
    for number, (joint, column) in enumerate(zip(kind.every_joint, columns, strict=True)):
        for link in joint.links:
            if link == 1:
                continue
            row = 3 * (link - 2)
            sign, turn = (1.0 if link == column.on else -1.0), (1.0 if link == joint.links[1] else -1.0)
            arm = column.place - centres[link].position
            for offset, (force, moment) in enumerate(column.unknown):
                at = 2 * number + offset
                matrix[..., row : row + 2, at] = sign * force
                matrix[..., row + 2, at] = sign * cross(arm, force) + turn * moment
            rubbing = joint_moments[number]
            if column.along is None:
                right_side[..., row + 2] -= turn * rubbing
            else:  # the friction of a slide is a force, known, on its second link
                pull = turn * rubbing[..., None] * column.along
                right_side[..., row : row + 2] -= pull
                right_side[..., row + 2] -= cross(arm, pull)
    matrix[..., 2, -1] = 1
    names = tuple(name for column in columns for name in column.names)
    equations = tuple(f"link {link}, {what}" for link in bodies for what in _PARTS)
    return SystemOfEquations(matrix, right_side, (*names, "T12"), equations)


class _Column(NamedTuple):
    """What is not known of a joint: two unit forces on a link, or one and a moment on the second link."""

    names: tuple[str, str]
    on: int
    place: FloatArray
    unknown: tuple[tuple[FloatArray, float], tuple[FloatArray, float]]
    along: FloatArray | None  # of a slide


def _column(state: Kinematics, joint: Joint) -> _Column:
    row = state.linkage.mechanism.every_joint[joint]
    first, second = row.links
    on, by = (second, first) if first == 1 else (first, second)
    in_loop = first % 2 == 1 and second == first + 1 and first > 1
    place = (getattr(state, row.name.lower()) if in_loop else state.origin(second)).position
    if row.slides:
        across, none = slide_normal(state, second), np.zeros(2)
        names = f"F{by}{on}n", f"M{first}{second}"
        return _Column(names, on, place, ((across, 0.0), (none, 1.0)), slide_direction(state, second))
    x, y = np.eye(2)
    return _Column((f"F{by}{on}x", f"F{by}{on}y"), on, place, ((x, 0.0), (y, 0.0)), None)


def _moments_in_joints(state: Kinematics, masses: Masses, loads: Loads) -> FloatArray:
    if loads.friction.of(state.linkage, "radius").any():
        found: Dynamics = inverse_dynamics(state, masses, loads)
        return found.joint_moments
    return known_joint_moments(state, loads)
