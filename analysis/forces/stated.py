"""Masses and loads as a problem or linkage file states them, for one linkage."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from grashof.analysis.forces.curve_through import curve_through
from grashof.analysis.forces.loads import (
    JOINED,
    AppliedForce,
    AppliedMoment,
    Friction,
    Joint,
    Loads,
    Spring,
    TorsionSpring,
)
from grashof.analysis.forces.mass import Body, Masses, given_masses, uniform_bar, uniform_bars
from grashof.analysis.four_bar.kinematics import Kinematics
from grashof.problems import DynamicsSpec, FourBar, ProblemError
from grashof.problems.values.acting import LoadSpec, Place
from grashof.problems.values.arrays import FloatArray

Clock = Callable[[Kinematics], FloatArray]


def stated_masses(linkage: FourBar, spec: DynamicsSpec, metre: float = 1.0) -> Masses:
    """Moving links as a problem states them, with counterweights, and the payload at P.

    Parameters
    ----------
    linkage : FourBar
    spec : DynamicsSpec
    metre : float
        The length unit in metres; a density needs it.
    """
    if spec.masses is not None and spec.inertias is not None:
        found = given_masses(linkage, spec.masses, spec.inertias, spec.centres)
    elif spec.density is not None and spec.section is not None:
        bars = zip(linkage.LINKS[1:], spec.section.areas, spec.section.widths, strict=True)
        per_area = spec.density * metre**3  # kg for each length^3
        found = Masses(
            *(
                uniform_bar(getattr(linkage, f"r{link.number}"), per_area * area, width)
                for link, area, width in bars
            )
        )
    else:
        found = uniform_bars(linkage, np.float64(spec.mass_per_length or 0.0))
    links = [found.crank, found.coupler, found.output]
    for weight in spec.counterweights:
        links[weight.link - 2] = links[weight.link - 2] + Body(weight.mass, 0.0, weight.at)
    found = Masses(*links)
    return found.with_payload(spec.payload, linkage.coupler_point) if spec.payload else found


def stated_loads(spec: DynamicsSpec, metre: float, clock: Clock | None = None) -> Loads:
    """What acts on the links, as a problem states it.

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
        A load over time where there is no clock.
    """
    friction = Friction()
    if spec.friction is not None:
        given = spec.friction
        viscous, constant = (_each(values) / metre**2 for values in (given.viscous, given.moment))
        friction = Friction(viscous, constant, _each(given.radius))
    return Loads(
        gravity=np.array(spec.gravity) / metre,
        forces=tuple(_forces(spec.loads, metre, clock)),
        moments=tuple(
            AppliedMoment(load.link, _varying(load, metre**2, clock)) for load in spec.loads if load.is_moment
        ),
        springs=(
            *(Spring(*_ends(each.between), each.stiffness, each.free_length) for each in spec.springs),
            *(Spring(*_ends(each.between), 0.0, 0.0, each.damping) for each in spec.dampers),
        ),
        torsion_springs=tuple(
            TorsionSpring(
                Joint(JOINED.index(each.between)), each.stiffness / metre**2, np.radians(each.free_angle_deg)
            )
            for each in spec.torsion_springs
        ),
        friction=friction,
    )


def _forces(loads: Sequence[LoadSpec], metre: float, clock: Clock | None) -> Iterator[AppliedForce]:
    for load in loads:
        if not load.is_moment:
            yield AppliedForce(load.link, load.at, _varying(load, metre, clock), load.frame == "link")


def _ends(between: tuple[Place, Place]) -> tuple[int, tuple[float, float], int, tuple[float, float]]:
    first, second = between
    return first.link, first.at, second.link, second.at


def _each(values: tuple[float, ...]) -> FloatArray:
    """One for each joint."""
    return np.broadcast_to(np.array(values), 4)


def _varying(
    load: LoadSpec, unit: float, clock: Clock | None
) -> FloatArray | Callable[[Kinematics], FloatArray]:
    """The force or moment of a load over its unit; a function of the state where it varies."""
    if load.values is None:
        return np.asarray(load.moment if load.force is None else load.force) / unit
    if load.over == "time" and clock is None:
        raise ProblemError("a load over time needs a driver that moves; speed_rpm is 0")
    curve = curve_through(load.values, period=None if load.over == "time" else 360.0)

    def of(state: Kinematics) -> FloatArray:
        place = clock(state) if load.over == "time" and clock is not None else np.degrees(_angle(state, load))
        values = curve(np.broadcast_to(place, state.shape)) / unit
        return values[..., 0] if load.is_moment else values

    return of


def _angle(state: Kinematics, load: LoadSpec) -> FloatArray:
    return state.theta2 if load.over == "theta2" else state.theta4
