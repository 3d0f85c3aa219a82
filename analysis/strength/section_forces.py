"""Normal force, shear force and bending moment inside each link, seen as a bar along its joints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.bars import bars_of
from grashof.analysis.forces.dynamics import Dynamics, inverse_dynamics
from grashof.analysis.forces.loads import Loads, cross, placed_loads, turned
from grashof.analysis.forces.mass import Body, Masses
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems import ProblemError
from grashof.problems.values.arrays import BoolArray, FloatArray

_SAME = 1e-9  # share of a link's length within which places on it are one


class SectionForce(NamedTuple):
    """Force and moment that the part of a bar beyond a cut exerts on the part before it.

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
            Distances from the link's origin; the bar ends at the first and last station.
        before : bool
            Where a load acts at the very cut: just before it, else just beyond it.

        Returns
        -------
        SectionForce, each of shape (..., S)
            NaN beyond the bar.
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
        A link that is not a bar.

    Notes
    -----
    Each link is a straight bar along the line of its joints. A load beside that line acts through a
    rigid arm on the bar, perpendicular to it; beyond a joint the bar continues to the last load on it, such
    as a horsehead or a counterweight. A load that lies further beside the line than beyond the joint acts
    on an arm from the joint instead. That changes nothing between the joints.

    A body of mass m and inertia I about its centre is spread evenly over the stretch of the bar that
    reaches h = sqrt(3 I / m) from the centre to both sides, but no further than its farther end; that
    is a uniform bar exactly, and a point mass where I = 0. Inertia that is left resists as that of wide
    sections does: by an evenly distributed couple. Force and moment are those of the entire body in any
    case. `Body.parts` are spread one by one, so that a payload stays a point.

    The drive and torsion springs act in the joints, and so does friction.

    Every part is in equilibrium with its inertia forces (d'Alembert; Norton, *Design of Machinery*, sec.
    11.1; diagrams: Shigley, *Mechanical Engineering Design*, sec. 3-2).

    Examples
    --------
    >>> from grashof.analysis import solve_kinematics, uniform_bars
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
    acting, gravity, bars = list(placed_loads(state, loads)), loads.gravity_vector(), {}
    for link in links:
        bar = _frame(state, link)
        points = list(_joint_loads(state, found, link, bar))
        points += [bar.hung(load.at, load.force, load.moment) for load in acting if load.link == link]
        pieces = [piece for piece in masses.of(link).pieces if np.any(piece.mass) or np.any(piece.inertia)]
        spreads = [_spread(state, link, bar, piece, gravity) for piece in pieces]
        bars[link] = _cut(link, bar.length, state.shape, points, spreads)
    return bars


class _Point(NamedTuple):
    """A load on the bar itself at u, shape (...): forces along it and across it and a couple, (..., 3)."""

    at: FloatArray
    load: FloatArray


class _Spread(NamedTuple):
    """Such loads for each unit of length from low to high, linear in u: those at u = 0, and their slopes."""

    low: FloatArray
    high: FloatArray
    at_zero: FloatArray
    slope: FloatArray
    point: _Point  # the same where it has no length


class _BarFrame(NamedTuple):
    """How a bar, whose own u runs to its other joint, lies in its link's frame, and where it ends."""

    theta: FloatArray
    sign: FloatArray  # -1 where the other joint lies against the link's u-axis
    length: FloatArray
    low: FloatArray
    high: FloatArray

    def own(self, at: npt.ArrayLike) -> FloatArray:
        """A place of the link's frame in that of the bar."""
        place: FloatArray = np.asarray(at, dtype=np.float64) * self.sign[..., None]
        return place

    def turned(self, force: FloatArray) -> FloatArray:
        """A vector of global axes in the frame of the bar."""
        return turned(np.asarray(force), -self.theta) * self.sign[..., None]

    def foot(self, at: FloatArray) -> FloatArray:
        """The place on the bar of the arm to a point (u, v) of its frame, shape (...)."""
        (u, v), same = (at[..., 0], at[..., 1]), _SAME * (self.high - self.low)
        nearest = np.clip(u, self.low, self.high)
        beyond = np.abs(u - nearest)
        on_joint = (beyond <= same) | (np.abs(v) > beyond)
        foot = np.where(on_joint, nearest, u)
        foot = np.where(np.abs(foot) <= same, 0.0, foot)
        return np.where(np.abs(foot - self.length) <= same, self.length, foot)

    def hung(self, at: npt.ArrayLike, force: FloatArray, couple: npt.ArrayLike) -> _Point:
        """A force in global axes at a point (u, v) of the link's frame as the bar feels it."""
        place, own = self.own(at), self.turned(force)
        foot = self.foot(place)
        arm = place - np.stack([foot, np.zeros_like(foot)], axis=-1)
        return _Point(foot, _load(own, np.asarray(couple) + cross(arm, own)))


def _frame(state: Kinematics, link: int) -> _BarFrame:
    bar, theta, ahead = bars_of(state.linkage)[link], state.angular(link)[0], np.ones(())
    slide = state.slides[(link - 3) // 2] if (link, link + 1) in state.linkage.mechanism.slides else None
    if slide is not None:
        sign = np.where(slide.travel < 0, -1.0, 1.0)
        ends = bar.low * sign, bar.high * sign
        return _BarFrame(theta, sign, np.abs(slide.travel), np.minimum(*ends), np.maximum(*ends))
    return _BarFrame(theta, ahead, np.asarray(bar.high), np.asarray(bar.low), np.asarray(bar.high))


def _load(force: FloatArray, couple: FloatArray) -> FloatArray:
    return np.stack(np.broadcast_arrays(force[..., 0], force[..., 1], couple), axis=-1)


def _checked(state: Kinematics, links: Sequence[int] | None) -> Sequence[int]:
    bars = tuple(bars_of(state.linkage))
    for link in links or ():
        if link not in bars:
            raise ProblemError(
                f"link {link} of a {state.linkage.mechanism.word} is not a bar; "
                f"section forces are of links {bars}"
            )
    return bars if links is None else links


def _joint_loads(state: Kinematics, found: Dynamics, link: int, bar: _BarFrame) -> Iterator[_Point]:
    """Loads of the joints of a link on it, the drive with them."""
    linkage = state.linkage
    points = linkage.mechanism.links[link - 1].points
    for number, joint in enumerate(linkage.mechanism.every_joint):
        if link not in joint.links:
            continue
        first, second = joint.links
        force = found.forces[number] if link == first or first == 1 else -found.forces[number]
        moment = found.slide_moment if joint.slides and first != 1 else found.joint_moments[number]
        couple = moment if link == second else -moment
        if number == 0:
            couple = couple + found.torque
        name = joint.name.lower()
        if name in points[2:]:
            yield bar.hung(getattr(linkage, name), force, couple)
        else:
            at = np.zeros(()) if name == points[0] else bar.length
            yield _Point(at, _load(bar.turned(force), couple))


def _spread(state: Kinematics, link: int, bar: _BarFrame, body: Body, gravity: FloatArray) -> _Spread:
    """Weight and inertia of a body, spread along the bar."""
    mass, inertia, centre = np.asarray(body.mass), np.asarray(body.inertia), bar.own(body.centre)
    foot = bar.foot(centre)
    arm_u, arm_v = centre[..., 0] - foot, centre[..., 1]
    farther = np.maximum(foot - bar.low, bar.high - foot)
    half = np.where(inertia > 0, np.sqrt(3 * inertia / mass), 0.0)
    point = half <= _SAME * (bar.high - bar.low)
    half = np.where(half > (1 - _SAME) * farther, farther, np.where(point, 0.0, half))
    turning = inertia - mass * half**2 / 3
    _, omega, alpha, _ = state.angular(link)
    origin = bar.turned(state.point(link, (0.0, 0.0)).acceleration - gravity)
    pull, line, turn = omega**2, *(np.where(half > 0, each / (2 * half), 0.0) for each in (mass, turning))
    arm = np.stack(np.broadcast_arrays(arm_u, arm_v), axis=-1)

    def inertial(share: FloatArray, u: FloatArray, couple: FloatArray) -> FloatArray:
        """Load of a share of the mass that is attached to the bar at u, with a couple."""
        x, y = u + arm_u, arm_v
        push = [origin[..., 0] - alpha * y - pull * x, origin[..., 1] + alpha * x - pull * y]
        force = share[..., None] * -np.stack(push, axis=-1)
        return _load(force, cross(arm, force) - couple)

    slope = line[..., None] * np.stack([pull, -alpha], axis=-1)
    lumped = np.where((half > 0)[..., None], 0.0, inertial(mass, foot, np.zeros(())))
    return _Spread(
        foot - half,
        foot + half,
        inertial(line, np.zeros(()), turn * alpha),
        _load(slope, cross(arm, slope)),
        _Point(foot - half, lumped),
    )


def _cut(
    link: int, length: FloatArray, shape: tuple[int, ...], points: list[_Point], spreads: list[_Spread]
) -> BarForces:
    """Equilibrium of ever longer parts of the bar, from its first station to its last."""
    ends = [_Point(spread.high, np.zeros(3)) for spread in spreads]
    every = [*points, *(spread.point for spread in spreads), *ends]
    places = np.stack([np.broadcast_to(point.at, shape) for point in every], axis=-1)
    order = np.argsort(places, axis=-1, kind="stable")
    stations = np.take_along_axis(places, order, axis=-1)
    outer = np.stack([np.broadcast_to(point.load, (*shape, 3)) for point in every], axis=-2)
    jumps = np.moveaxis(np.take_along_axis(outer, order[..., None], axis=-2) * (-1, 1, -1), -1, 0)
    steps, loaded = np.diff(stations, axis=-1), _loaded(stations, spreads)
    values = jumps[..., 0]
    pieces: tuple[list[FloatArray], ...] = ([], [], [])
    for span in range(len(every) - 1):
        (pull, push, turn), (pull_slope, push_slope, turn_slope) = loaded[..., span]
        normal, shear, moment = values
        terms = (
            (normal, -pull, -pull_slope / 2),
            (shear, push, push_slope / 2),
            (moment, shear - turn, (push - turn_slope) / 2, push_slope / 6),
        )
        for piece, own in zip(pieces, terms, strict=True):
            piece.append(np.stack(own, axis=-1))
        beyond = [polynomial(piece[-1], steps[..., span, None])[..., 0] for piece in pieces]
        values = np.stack(beyond) + jumps[..., span + 1]
    along_bar, across_bar, bending = (np.stack(piece, axis=-2) for piece in pieces)
    rest = SectionForce(*values)
    return BarForces(link, np.broadcast_to(length, shape), stations, along_bar, across_bar, bending, rest)


def _loaded(stations: FloatArray, spreads: list[_Spread]) -> FloatArray:
    """Loads of `_Spread` where the spans begin, and their slopes, shape (2, 3, ..., K - 1)."""
    start = stations[..., :-1, None]
    middle = start + np.diff(stations, axis=-1)[..., None] / 2
    total = np.zeros((2, *start.shape[:-1], 3))
    for spread in spreads:
        inside = (spread.low[..., None, None] < middle) & (middle < spread.high[..., None, None])
        slope = spread.slope[..., None, :]
        total[0] += np.where(inside, spread.at_zero[..., None, :] + slope * start, 0.0)
        total[1] += np.where(inside, slope, 0.0)
    return np.moveaxis(total, -1, 1)
