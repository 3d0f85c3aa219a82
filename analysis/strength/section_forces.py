"""Normal force, shear force and bending moment inside each link, seen as a bar along its joints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.bars import bars_of
from grashof.analysis.forces.dynamics import Dynamics, inverse_dynamics
from grashof.analysis.forces.loads import Loads, cross, placed_loads
from grashof.analysis.forces.mass import Body, Masses
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.analysis.strength.bar_frame import BarFrame, bar_frame
from grashof.problems import ProblemError
from grashof.problems.values.arrays import BoolArray, FloatArray

_SAME = 1e-9  # share of a link's length within which places on it are one


class SectionForce(NamedTuple):
    """What the part of a bar beyond a cut exerts on the part before it.

    Parameters
    ----------
    normal : ndarray, N
        Positive in tension.
    shear : ndarray, N
        The sum of the forces across the bar (to its left) on the part before the cut: d moment / du
        where no couple acts.
    moment : ndarray, N length
        Counter-clockwise on the part before the cut: positive where the bar's right side is stretched.
    """

    normal: FloatArray
    shear: FloatArray
    moment: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class BarForces:
    """Section forces all along one link: a polynomial between any two stations.

    Parameters
    ----------
    link : int
        2, 3 or 4; of a six-bar to 6.
    length : ndarray, shape (...), length
        Between its joints; of the rod of an inverted slider-crank from A to where B is then.
    stations : ndarray, shape (..., K), length
        Distances from the link's origin (O2, A, O4, C, D) towards its other joint at which loads begin, end
        or act, ascending. They cover both joints and all loads, so that the bar may reach beyond its joints.
    normal, shear : ndarray, shape (..., K - 1, 3), N over length^0 to length^2
        Coefficients of the polynomials, constant first, in the distance from the station before.
    moment : ndarray, shape (..., K - 1, 4), N length over length^0 to length^3
    rest : SectionForce, each of shape (...)
        Beyond the last station: zero but for rounding, as the bar is in equilibrium.
    """

    link: int
    length: FloatArray
    stations: FloatArray
    normal: FloatArray
    shear: FloatArray
    moment: FloatArray
    rest: SectionForce

    @property
    def spans(self) -> FloatArray:
        """Lengths between the stations, shape (..., K - 1)."""
        return np.diff(self.stations, axis=-1)

    @property
    def real(self) -> BoolArray:
        """Which spans there are; the others lie between loads at one place. Shape (..., K - 1)."""
        found: BoolArray = self.spans > _SAME * self.length[..., None]
        return found

    @property
    def between_joints(self) -> BoolArray:
        """Which spans lie between the joints, shape (..., K - 1)."""
        middle = self.stations[..., :-1] + self.spans / 2
        inside: BoolArray = self.real & (middle > 0) & (middle < self.length[..., None])
        return inside

    def at(self, u: npt.ArrayLike, *, before: bool = False) -> SectionForce:
        """Section forces at cuts.

        Parameters
        ----------
        u : array_like, shape (S,) or (..., S), length
            Distances from the link's origin; there is no bar beyond the first and last station.
        before : bool
            Where a load acts at the very cut: just before it, else just beyond it.

        Returns
        -------
        SectionForce, each of shape (..., S)
            NaN where there is no bar.
        """
        cuts = np.broadcast_to(np.asarray(u, dtype=np.float64), (*self.length.shape, np.shape(u)[-1]))
        starts = self.stations[..., None, :-1]
        passed = cuts[..., None] > starts if before else cuts[..., None] >= starts
        passed = passed & self.real[..., None, :]
        last = passed.shape[-1] - 1 - np.argmax(passed[..., ::-1], axis=-1)
        span = np.where(passed.any(axis=-1), last, np.argmax(self.real, axis=-1)[..., None])
        beyond = cuts - np.take_along_axis(self.stations, span, axis=-1)
        slack = _SAME * self.length[..., None]
        here = (cuts >= self.stations[..., :1] - slack) & (cuts <= self.stations[..., -1:] + slack)

        def value(terms: FloatArray) -> FloatArray:
            own = np.take_along_axis(terms, span[..., None], axis=-2)
            return np.where(here, polynomial(own, beyond[..., None])[..., 0], np.nan)

        return SectionForce(value(self.normal), value(self.shear), value(self.moment))


def polynomial(terms: FloatArray, at: FloatArray) -> FloatArray:
    """Polynomials (..., K), constant first, each at several places (..., S); shape (..., S)."""
    value = np.zeros(np.broadcast_shapes(at.shape, (*terms.shape[:-1], 1)))
    for power in reversed(range(terms.shape[-1])):
        value = value * at + terms[..., power, None]
    return value


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def section_forces(
    state: Kinematics,
    masses: Masses,
    loads: Loads | None = None,
    found: Dynamics | None = None,
    links: Sequence[int] | None = None,
) -> dict[int, BarForces]:
    """Normal force, shear force and bending moment along the links.

    Parameters
    ----------
    state : Kinematics
    masses : Masses
    loads : Loads, optional
    found : Dynamics, optional
        Of `inverse_dynamics` for these three; by default it is computed.
    links : sequence of int, optional
        Some of those that are bars (`bars_of`); all by default.

    Returns
    -------
    dict of int to BarForces
        Not finite where the joint forces are not.

    Raises
    ------
    ProblemError
        A link that is no bar.

    Notes
    -----
    Each link is a straight bar along the line of its joints. What acts beside that line acts through a
    rigid arm on the bar, square to it; beyond a joint the bar goes on as far as loads lie on it, such as
    a horsehead or a counterweight. A load that lies further beside the line than beyond the joint hangs
    on an arm from the joint instead. That changes nothing between the joints.

    A body of mass m and inertia I about its centre is spread evenly over the stretch of the bar that
    reaches h = sqrt(3 I / m) from the centre to both sides, but no further than its farther end; that
    is a uniform bar exactly, and a point mass where I = 0. Inertia that is left resists as that of wide
    sections does: by an evenly distributed couple. Force and moment are those of the whole body in any
    case. `Body.parts` are spread one by one, so that a payload stays a point.

    The drive and torsion springs act in the joints, and so does friction.

    Every part is in equilibrium with its inertia forces (d'Alembert; Norton, *Design of Machinery*, sec.
    11.1; diagrams: Shigley, *Mechanical Engineering Design*, sec. 3-2).

    Examples
    --------
    >>> from grashof.analysis.mechanism.kinematics import solve_kinematics
    >>> from grashof.analysis.forces.mass import uniform_bars
    >>> from grashof.problems import FourBar
    >>> rectangle = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=1)
    >>> resting = solve_kinematics(rectangle, np.pi / 2, 0.0)
    >>> bars = section_forces(resting, uniform_bars(rectangle, 3.0), Loads(gravity=(0, -10)))
    >>> float(bars[3].at([2.0]).moment.round(6)[0])  # 30 N/m over 4 m: w L^2 / 8
    60.0
    """
    loads = Loads() if loads is None else loads
    links = _checked(state, links)
    found = inverse_dynamics(state, masses, loads) if found is None else found
    pushed = {link: list(_joint_loads(state, found, link)) for link in links}
    for load in placed_loads(state, loads):
        if load.link in pushed:
            pushed[load.link].append(_hung(state, load.link, load.at, load.force, load.moment))
    gravity, bars = loads.gravity_vector(), {}
    for link, points in pushed.items():
        pieces = [piece for piece in masses.of(link).pieces if np.any(piece.mass) or np.any(piece.inertia)]
        spreads = [_spread(state, link, piece, gravity) for piece in pieces]
        bars[link] = _cut(link, state, points, spreads)
    return bars


class _Point(NamedTuple):
    """A force and a couple on the bar itself, in the link's frame."""

    at: FloatArray
    force: FloatArray
    couple: FloatArray


class _Spread(NamedTuple):
    """A force and a couple for each unit of length, linear in u: the value at u = 0, and the slope."""

    low: FloatArray
    high: FloatArray
    force: tuple[FloatArray, FloatArray]
    couple: tuple[FloatArray, FloatArray]
    point: _Point  # the same where it has no length


def _checked(state: Kinematics, links: Sequence[int] | None) -> Sequence[int]:
    bars = tuple(bars_of(state.linkage))
    for link in links or ():
        if link not in bars:
            raise ProblemError(
                f"link {link} of a {state.linkage.mechanism.word} is no bar; "
                f"section forces are of links {bars}"
            )
    return bars if links is None else links


def _foot(at: FloatArray, bar: BarFrame) -> FloatArray:
    """Where a point (u, v) of a bar's frame hangs on the bar, shape (...)."""
    (u, v), same = (at[..., 0], at[..., 1]), _SAME * (bar.high - bar.low)
    nearest = np.clip(u, bar.low, bar.high)
    beyond = np.abs(u - nearest)
    on_joint = (beyond <= same) | (np.abs(v) > beyond)
    foot = np.where(on_joint, nearest, u)
    foot = np.where(np.abs(foot) <= same, 0.0, foot)
    return np.where(np.abs(foot - bar.length) <= same, bar.length, foot)


def _hung(
    state: Kinematics, link: int, at: npt.ArrayLike, force: FloatArray, couple: npt.ArrayLike
) -> _Point:
    """A force in global axes at a point (u, v) as the bar feels it."""
    bar = bar_frame(state, link)
    place = bar.own(at)
    foot = _foot(place, bar)
    arm = place - np.stack([foot, np.zeros_like(foot)], axis=-1)
    own = bar.turned(force)
    return _Point(foot, own, np.asarray(couple) + cross(arm, own))


def _joint_loads(state: Kinematics, found: Dynamics, link: int) -> Iterator[_Point]:
    """What the joints of a link exert on it, the drive with them."""
    linkage, bar = state.linkage, bar_frame(state, link)
    points = linkage.mechanism.links[link - 1].points
    for number, joint in enumerate(linkage.mechanism.every_joint):
        if link not in joint.links:
            continue
        first, second = joint.links
        force = found.forces[number] if link == first or first == 1 else -found.forces[number]
        between = (first, second) in linkage.mechanism.slides and first != 1
        moment = found.slide_moment if between else found.joint_moments[number]
        couple = moment if link == second else -moment
        if number == 0:
            couple = couple + found.torque
        name = joint.name.lower()
        if name in points[2:]:
            yield _hung(state, link, getattr(linkage, name), force, couple)
        else:
            at = np.zeros(()) if name == points[0] else bar.length
            yield _Point(at, bar.turned(force), couple)


def _spread(state: Kinematics, link: int, body: Body, gravity: FloatArray) -> _Spread:
    """Weight and inertia of a body, spread along the bar."""
    bar, mass, inertia = bar_frame(state, link), np.asarray(body.mass), np.asarray(body.inertia)
    centre = bar.own(body.centre)
    foot = _foot(centre, bar)
    arm_u, arm_v = centre[..., 0] - foot, centre[..., 1]
    farther = np.maximum(foot - bar.low, bar.high - foot)
    half = np.where(inertia > 0, np.sqrt(3 * inertia / mass), 0.0)
    point = half <= _SAME * (bar.high - bar.low)
    half = np.where(half > (1 - _SAME) * farther, farther, np.where(point, 0.0, half))
    turning = inertia - mass * half**2 / 3
    _, omega, alpha, _ = state.angular(link)
    origin = bar.turned(state.point(link, (0.0, 0.0)).acceleration - gravity)
    pull, line, turn = omega**2, *(_over(each, 2 * half) for each in (mass, turning))

    def inertial(u: FloatArray) -> FloatArray:
        """Of a unit of mass that hangs on the bar at u."""
        x, y = u + arm_u, arm_v
        return -np.stack(
            [origin[..., 0] - alpha * y - pull * x, origin[..., 1] + alpha * x - pull * y], axis=-1
        )

    arm = np.stack(np.broadcast_arrays(arm_u, arm_v), axis=-1)
    slope = line[..., None] * np.stack([pull, -alpha], axis=-1)
    at_origin = line[..., None] * inertial(np.zeros(()))
    whole = mass[..., None] * inertial(foot)
    has_length = half > 0
    return _Spread(
        foot - half,
        foot + half,
        (at_origin, slope),
        (cross(arm, at_origin) - turn * alpha, cross(arm, slope)),
        _Point(
            foot - half,
            np.where(has_length[..., None], 0.0, whole),
            np.where(has_length, 0.0, cross(arm, whole)),
        ),
    )


def _over(whole: FloatArray, stretch: FloatArray) -> FloatArray:
    """Share of a unit of length, none where there is no length."""
    return np.where(stretch > 0, whole / stretch, 0.0)


def _cut(link: int, state: Kinematics, points: list[_Point], spreads: list[_Spread]) -> BarForces:
    """Equilibrium of ever longer parts of the bar, from its first station to its last."""
    shape = state.shape
    ends = [_Point(spread.high, np.zeros(2), np.zeros(())) for spread in spreads]
    every = [*points, *(spread.point for spread in spreads), *ends]
    places = _stacked([point.at for point in every], shape)
    order = np.argsort(places, axis=-1, kind="stable")
    stations = np.take_along_axis(places, order, axis=-1)
    along, across, couples = (
        np.take_along_axis(_stacked(values, shape), order, axis=-1)
        for values in (
            [point.force[..., 0] for point in every],
            [point.force[..., 1] for point in every],
            [point.couple for point in every],
        )
    )
    steps, loaded = np.diff(stations, axis=-1), _loaded(stations, spreads)
    normal, shear, moment = -along[..., 0], across[..., 0], -couples[..., 0]
    pieces: tuple[list[FloatArray], ...] = ([], [], [])
    for span in range(len(every) - 1):
        pull, pull_slope, push, push_slope, turn, turn_slope = loaded[..., span]
        terms = (
            (normal, -pull, -pull_slope / 2),
            (shear, push, push_slope / 2),
            (moment, shear - turn, (push - turn_slope) / 2, push_slope / 6),
        )
        for piece, own in zip(pieces, terms, strict=True):
            piece.append(np.stack(own, axis=-1))
        normal, shear, moment = (polynomial(piece[-1], steps[..., span, None])[..., 0] for piece in pieces)
        normal = normal - along[..., span + 1]
        shear = shear + across[..., span + 1]
        moment = moment - couples[..., span + 1]
    length = np.broadcast_to(bar_frame(state, link).length, shape)
    rest = SectionForce(normal[()], shear[()], moment[()])
    along_bar, across_bar, bending = (np.stack(piece, axis=-2) for piece in pieces)
    return BarForces(link, length, stations, along_bar, across_bar, bending, rest)


def _stacked(values: list[FloatArray], shape: tuple[int, ...]) -> FloatArray:
    return np.stack([np.broadcast_to(value, shape) for value in values], axis=-1)


def _loaded(stations: FloatArray, spreads: list[_Spread]) -> FloatArray:
    """Load along and across and couple, for each unit of length: each where a span begins, and its slope.

    Shape (6, ..., K - 1).
    """
    start = stations[..., :-1]
    middle = start + np.diff(stations, axis=-1) / 2
    total = np.zeros((6, *start.shape))
    for spread in spreads:
        inside = (spread.low[..., None] < middle) & (middle < spread.high[..., None])
        rows = ((spread.force[0][..., 0], spread.force[1][..., 0]),
                (spread.force[0][..., 1], spread.force[1][..., 1]), spread.couple)  # fmt: skip
        for row, (at_origin, slope) in enumerate(rows):
            steep = np.asarray(slope)[..., None]
            total[2 * row] += np.where(inside, np.asarray(at_origin)[..., None] + steep * start, 0.0)
            total[2 * row + 1] += np.where(inside, steep, 0.0)
    return total
