"""Masses and loads of a linkage from the specification in a problem or linkage file."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import scipy

from grashof.analysis.forces.joints import Joint, joint_motion, slides_of
from grashof.analysis.forces.loads import AppliedForce, AppliedMoment, Friction, Loads, Spring, TorsionSpring
from grashof.analysis.forces.mass import Body, Masses, given_masses, loaded, uniform_bars
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems import DynamicsSpec, Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import refuse
from grashof.problems.values.dynamics.load_specs import TURNING, LoadSpec, Place
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.problems.values.specs.dynamics_of_kind import without_place

# Joints by their links, which distinguish them in any kind of linkage.
JOINT_OF = {joint.links: Joint(k) for row in MECHANISMS for k, joint in enumerate(row.every_joint)}
TRAVEL_ROUNDING = 1e-9  # share of the greatest travel by which it may pass the rows of a load


class BeyondLoadError(ProblemError):
    """A slide that travels farther than the rows of a load."""


Clock = Callable[[Kinematics], FloatArray]


def stated_masses(linkage: Linkage, spec: DynamicsSpec, metre: float = 1.0) -> Masses:
    """Moving links as a problem states them, with counterweights, and the payload at P.

    Parameters
    ----------
    linkage : Linkage
    spec : DynamicsSpec
    metre : float
        The length unit in metres; a density needs it.

    Raises
    ------
    ProblemError
        Masses, sections or counterweights of links that the linkage has not.
    """
    refuse(without_place(spec, linkage.mechanism))
    if spec.masses is not None and spec.inertias is not None:
        found = given_masses(linkage, spec.masses, spec.inertias, spec.centres)
    elif spec.density is not None and spec.section is not None:
        per_area = spec.density * metre**3  # kg for each length^3
        links = [link.number for link in linkage.mechanism.links[1:]]
        areas = [spec.section.of(link).area for link in links]
        found = uniform_bars(linkage, per_area * np.array(areas), widths=spec.section.width or 0.0)
    else:
        found = uniform_bars(linkage, np.float64(spec.mass_per_length or 0.0))
    for weight in spec.counterweights:
        found = found.with_body(weight.link, Body(weight.mass, 0.0, weight.at))
    return loaded(found, linkage, spec.payload) if spec.payload else found


def stated_loads(spec: DynamicsSpec, metre: float, clock: Clock | None = None) -> Loads:
    """Loads on the links, as a problem states them.

    Parameters
    ----------
    spec : DynamicsSpec
        In N, N m and N/m.
    metre : float
        The length unit in metres.
    clock : callable, optional
        Time of states, s; loads over time need it.

    Returns
    -------
    Loads
        Forces in newtons over `metre`, moments in newton metres over its square. Loads over time
        are NaN outside their rows.

    Raises
    ------
    ProblemError
        A load over time without a clock.
    """
    friction = Friction()
    if spec.friction is not None:
        given = spec.friction
        viscous, constant = (_each(values) / metre**2 for values in (given.viscous, given.moment))
        friction = Friction(
            viscous, constant, _each(given.radius),
            given.slide_viscous, given.slide_force / metre, given.slide_mu, given.slide_length,
        )  # fmt: skip
    return Loads(
        gravity=np.array(spec.gravity) / metre,
        forces=tuple(
            AppliedForce(load.link, load.at, _varying(load, metre, clock), load.frame == "link")
            for load in spec.loads
            if not load.is_moment
        ),
        moments=tuple(
            AppliedMoment(load.link, _varying(load, metre**2, clock)) for load in spec.loads if load.is_moment
        ),
        springs=(
            *(Spring(*_ends(each.between), each.stiffness, each.free_length) for each in spec.springs),
            *(Spring(*_ends(each.between), 0.0, 0.0, each.damping) for each in spec.dampers),
        ),
        torsion_springs=tuple(
            TorsionSpring(JOINT_OF[each.between], each.stiffness / metre**2, np.radians(each.free_angle_deg))
            for each in spec.torsion_springs
        ),
        friction=friction,
    )


def curve_through(
    rows: Sequence[Sequence[float]], *, period: float | None = None
) -> Callable[[FloatArray], FloatArray]:
    """The monotone cubic (Fritsch & Carlson 1980) through rows (N, 1 + K) of a rising place and K values.

    A function from places (...) to values (..., K), NaN outside the rows; or of a period, in the unit of the
    places, from one end of which the rows go to the other, with equal values there. It has no overshoot of a
    spline at the corners of a measured load.
    """
    table = np.array(rows, dtype=np.float64)
    places, values = table[:, 0], table[:, 1:]
    if period is None:
        return scipy.interpolate.PchipInterpolator(places, values, extrapolate=False)
    beside = min(2, len(places) - 1)  # its slopes look at the neighbours
    places = np.concatenate([places[-1 - beside : -1] - period, places, places[1 : 1 + beside] + period])
    values = np.concatenate([values[-1 - beside : -1], values, values[1 : 1 + beside]])
    curve, first = scipy.interpolate.PchipInterpolator(places, values), float(table[0, 0])
    return lambda place: np.asarray(curve(first + (place - first) % period))


def _ends(between: tuple[Place, Place]) -> tuple[int, tuple[float, float], int, tuple[float, float]]:
    first, second = between
    return first.link, first.at, second.link, second.at


def _each(values: tuple[float, ...]) -> FloatArray:
    """One for each joint, or one for all pins."""
    return np.array(values if len(values) > 1 else values[0])


def _varying(
    load: LoadSpec, unit: float, clock: Clock | None
) -> FloatArray | Callable[[Kinematics], FloatArray]:
    """The force or moment of a load over its unit; a function of the state where it varies."""
    if load.values is None:
        return np.asarray(load.moment if load.force is None else load.force) / unit
    if load.over == "time" and clock is None:
        raise ProblemError("a load over time needs a driver that moves; speed_rpm is 0")
    curve = curve_through(load.values, period=360.0 if load.over in TURNING else None)

    def of(state: Kinematics) -> FloatArray:
        place = clock(state) if load.over == "time" and clock is not None else _place(state, load)
        values = curve(np.broadcast_to(place, state.shape)) / unit
        return values[..., 0] if load.is_moment else values

    return of


def _place(state: Kinematics, load: LoadSpec) -> FloatArray:
    """Where in its rows a load is: an angle in deg, or the travel of the slide."""
    slides, kind = slides_of(state.linkage), state.linkage.mechanism
    if load.over in TURNING:
        link = int(load.over.removeprefix("theta"))
        if (1, link) in kind.slides:
            raise ProblemError(
                f"a load is over {load.over}, but a slider does not turn; it must be over travel"
            )
        return np.degrees(state.angular(link).theta)
    if not slides:
        last = f"theta{kind.links[-1].number}"
        raise ProblemError(f"a load is over travel, but a {kind.word} has no slide; it must be over {last}")
    travel, _ = joint_motion(state, slides[0])
    return _within(travel, load)


def _within(travel: FloatArray, load: LoadSpec) -> FloatArray:
    """A travel, put back where rounding carries it past the rows of a load."""
    rows = load.values or ((0.0,),)
    low, high = rows[0][0], rows[-1][0]
    slack = TRAVEL_ROUNDING * max(abs(low), abs(high))
    known = np.asarray(travel)[np.isfinite(travel)]
    least, most = known.min(initial=high), known.max(initial=low)
    if least < low - slack or most > high + slack:
        past = least if least < low - slack else most
        raise BeyondLoadError(f"a load over travel covers {low:g} to {high:g}; the slide reaches {past:.6g}")
    return np.clip(travel, low, high)
