"""The equations of inverse dynamics as one linear system: a second way, beside solving them in order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from grashof.analysis.forces.dynamics import friction_and_springs
from grashof.analysis.forces.joints import Joint, joints_of, slide_direction, slide_normal, slides_of
from grashof.analysis.forces.loads import Loads, cross, wrenches
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
        Inertia less the known loads: weight, outer forces, springs, friction.
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
    """The system of equations that `inverse_dynamics` solves in order.

    Parameters
    ----------
    state : Kinematics
    masses : Masses
    loads : Loads, optional
        None by default.
    joint_moments : ndarray, shape (J, ...), N length, optional
        Of friction and torsion springs, as `Dynamics` has them. By default those of the loads; friction
        that grows with the joint forces, which would make the system nonlinear, is taken from
        `inverse_dynamics`.

    Returns
    -------
    SystemOfEquations

    Notes
    -----
    Norton, *Design of Machinery*, sec. 11.4: of each link the sum of forces is m a, and the moments of the
    joint forces about its centre of mass, R x F = Rx Fy - Ry Fx, with all other moments, are I alpha.

    Examples
    --------
    >>> from grashof.analysis import solve_kinematics, uniform_bars
    >>> from grashof.problems import FourBar
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> state = solve_kinematics(jack, np.radians(60), 2 * np.pi / 3)
    >>> system = system_of_equations(state, uniform_bars(jack, (312, 312, 314)), Loads(gravity=(0, -9.81)))
    >>> dict(zip(system.unknowns, system.solution.round(6).tolist()))["T12"]
    5507.711124
    """
    loads = Loads() if loads is None else loads
    if joint_moments is None:
        joint_moments = friction_and_springs(state, masses, loads)
    linkage, gravity, outside = state.linkage, loads.gravity_vector(), wrenches(state, loads)
    bodies = masses.by_link(linkage)
    columns = [_column(state, joint) for joint in joints_of(linkage)]
    size = 3 * len(bodies)
    matrix, right_side = np.zeros((*state.shape, size, size)), np.zeros((*state.shape, size))
    for row, (link, body) in zip(range(0, size, 3), bodies.items(), strict=True):
        centre, force = state.point(link, body.centre), outside[link].force
        known = outside[link].moment - cross(centre.position - state.origin(link).position, force)
        mass = np.asarray(body.mass)[..., None]
        right_side[..., row : row + 2] = mass * (centre.acceleration - gravity) - force
        right_side[..., row + 2] = body.inertia * state.angular(link)[2] - known
        for joint, column in enumerate(columns):
            if link in column.links:
                arm, rows = column.place - centre.position, slice(row, row + 3)
                matrix[..., rows, 2 * joint : 2 * joint + 2] = column.unknown_on(link, arm)
                right_side[..., rows] -= column.known_on(link, arm, joint_moments[joint])
    for joint in slides_of(linkage):
        right_side[np.isnan(joint_moments[joint])] = np.nan  # it locks
    matrix[..., 2, -1] = 1
    names = tuple(name for column in columns for name in column.names)
    equations = tuple(f"link {link}, {what}" for link in bodies for what in _PARTS)
    return SystemOfEquations(matrix, right_side, (*names, "T12"), equations)


class _Column(NamedTuple):
    """A joint: forces on one of its links are unknowns, in a slide that across it and a moment.

    `on` is the link that the force acts on; moments are on the second of `links`.
    """

    names: tuple[str, str]
    links: tuple[int, int]
    on: int
    place: FloatArray
    forces: tuple[FloatArray, ...]  # unit vectors
    along: FloatArray | None  # of a slide

    def unknown_on(self, link: int, arm: FloatArray) -> FloatArray:
        """Effect of a unit of each unknown on a link: x, y and moment about its centre, shape (..., 3, 2)."""
        sign, turn = (1.0 if link == one else -1.0 for one in (self.on, self.links[1]))
        found = np.zeros((*arm.shape[:-1], 3, 2))
        for column, force in enumerate(self.forces):
            found[..., :2, column], found[..., 2, column] = sign * force, sign * cross(arm, force)
        if self.along is not None:
            found[..., 2, 1] = turn
        return found

    def known_on(self, link: int, arm: FloatArray, moment: FloatArray) -> FloatArray:
        """The same of the moment of a pin, or of the friction along a slide; shape (..., 3)."""
        own = moment if link == self.links[1] else -moment
        if self.along is None:
            return np.stack([np.zeros_like(own), np.zeros_like(own), own], axis=-1)
        force = own[..., None] * self.along
        return np.concatenate([force, cross(arm, force)[..., None]], axis=-1)


def _column(state: Kinematics, joint: Joint) -> _Column:
    row = state.linkage.mechanism.every_joint[joint]
    first, second = row.links
    on, by = (second, first) if first == 1 else (first, second)
    in_loop = first > 1 and first % 2 == 1 and second == first + 1  # at the end of both its links
    place = (getattr(state, row.name.lower()) if in_loop else state.origin(second)).position
    if row.slides:
        across, along = slide_normal(state, second), slide_direction(state, second)
        return _Column((f"F{by}{on}n", f"M{first}{second}"), row.links, on, place, (across,), along)
    return _Column((f"F{by}{on}x", f"F{by}{on}y"), row.links, on, place, tuple(np.eye(2)), None)
