"""The drive torque and the joint forces of a loaded linkage at an instant.

Written once for arrays and for CasADi symbols, as in `grashof.synth.quantities.formulas`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from grashof.problems.values.dynamics.load_specs import JOINTS, TURNING
from grashof.synth.loop.instant import Instant
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.driver_motion import cubics
from grashof.synth.quantities.loading import AppliedLoad, Loading, Mass

_TURN_DEG = 360.0
_FRICTION_ROUNDS = 3  # each takes the joint forces of the last
_TINY = 1e-30  # under roots


def drive_torque(at: Instant, loading: Loading) -> list[Any]:
    """Virtual work: T = sum of (m (a - g) - F) . dr + (I alpha - M) dtheta, by the driver angle."""
    moments = _joint_moments(at, loading)
    torque: Any = 0.0
    for link, arm, force in _forces(at, loading):
        torque = torque + force.dot(at.moved(link, arm))
    for link, moment in _moments(at, loading):
        torque = torque + moment * at.speed(link)
    for joint, moment in enumerate(moments):
        torque = torque - moment * at.opening(joint)
    return [torque]


def joint_forces(at: Instant, loading: Loading) -> list[Any]:
    """Forces in O2, A, B and O4, or a slide there, friction in the joints included."""
    return _reactions(at, loading, _joint_moments(at, loading))[0]


def _reactions(at: Instant, loading: Loading, moments: list[Any]) -> tuple[list[Any], tuple[Any, Any]]:
    """Forces in O2, A, B and O4, and the force across the slide with its moment."""
    # about A of link 3 and the origin of the frame of link 4; a moment in a pin is a force along a slide
    force: dict[int, Any] = {2: Vector(0.0, 0.0), 3: Vector(0.0, 0.0), 4: Vector(0.0, 0.0)}
    turning = [0.0 if joint == at.slide else moment for joint, moment in enumerate(moments)]
    about: dict[int, Any] = {2: 0.0, 3: turning[2] - turning[1], 4: -turning[2] - turning[3]}
    for link, arm, demand in _forces(at, loading):
        force[link] = force[link] + demand
        about[link] = about[link] + arm.cross(demand)
    for link, moment in _moments(at, loading):
        about[link] = about[link] + moment
    in_b = at.force_in_b(force, about, 0.0 if at.slide is None else moments[at.slide])
    in_a = force[3] - in_b  # by link 2 on link 3
    return [force[2] + in_a, in_a, in_b, force[4] + in_b], at.pressing(in_b, force, about)


def _forces(at: Instant, loading: Loading) -> Iterator[tuple[int, Vector, Vector]]:
    """Link, place from the origin of its frame, and the force that the joints have to give there."""
    weight = Vector(*loading.weight)
    for each in loading.masses:
        mass, _, arm = _body(at, each)
        yield each.link, arm, mass * (loading.inertia * at.acceleration(each.link, arm) - weight)
    for load in loading.applied:
        if not load.moment:
            force = Vector(*_values(at, load))
            if load.turning:
                along = at.link(load.link)
                force = (force.x * along + force.y * along.left) / np.sqrt(along.square)
            yield load.link, at.on_link(load.link, load.at), -force
    for spring in loading.springs:
        first, second = map(at.place, spring.links, spring.places)
        rates = [
            at.velocity(link, at.on_link(link, place)) if link != 1 else Vector(0.0, 0.0)
            for link, place in zip(spring.links, spring.places, strict=True)
        ]
        way = second - first
        force = spring.stiffness * way
        if spring.free_length or spring.damping:
            along = way / np.sqrt(way.square + _TINY)
            slack = spring.damping * along.dot(rates[1] - rates[0]) - spring.stiffness * spring.free_length
            force = force + slack * along
        for link, place, demand in zip(spring.links, spring.places, (-force, force), strict=True):
            if link != 1:
                yield link, at.on_link(link, place), demand


def _moments(at: Instant, loading: Loading) -> Iterator[tuple[int, Any]]:
    """Link, and the moment on it besides those of forces."""
    for each in loading.masses:
        inertia = _body(at, each)[1]
        if each.inertia or each.per_size:
            yield each.link, loading.inertia * inertia * at.turned(each.link)
    for load in loading.applied:
        if load.moment:
            (moment,) = _values(at, load)
            yield load.link, -moment


def _body(at: Instant, mass: Mass) -> tuple[Any, Any, Vector]:
    """Mass, inertia about its centre, and the centre from the origin of its link's frame."""
    if mass.at_point:
        return mass.mass, 0.0, at.point
    if not mass.per_size:
        return mass.mass, mass.inertia, at.on_link(mass.link, mass.place)
    found = at.bar(mass.link)
    if found is None:
        return 0.0, 0.0, Vector(0.0, 0.0)
    square, middle = found
    bar = mass.per_size * np.sqrt(square)
    return bar, bar * (square + mass.width**2) / 12, middle


def _values(at: Instant, load: AppliedLoad) -> list[Any]:
    """Components of a force or moment: constant, or of the curve through its rows."""
    if not load.over:
        return list(load.values)
    if load.over == "time":
        place = at.driver.time
    elif load.over == "travel":
        place = at.travel
    else:
        degrees = np.degrees(1.0) * at.turn(2 if load.over == "theta2" else 4)
        place = load.places[0] + np.remainder(degrees - load.places[0], _TURN_DEG)
    return [_curve(load, column, place) for column in range(len(load.rows[0]))]


def _curve(load: AppliedLoad, column: int, place: Any) -> Any:
    """The monotone cubic through a column."""
    places, values = np.array(load.places), np.array(load.rows)[:, column]
    if load.over in TURNING:  # its slopes look at the neighbours on the other turn
        beside = min(2, len(places) - 1)
        places = np.concatenate(
            [places[-1 - beside : -1] - _TURN_DEG, places, places[1 : 1 + beside] + _TURN_DEG]
        )
        values = np.concatenate([values[-1 - beside : -1], values, values[1 : 1 + beside]])
    return cubics(places, values, place)[0]


def _joint_moments(at: Instant, loading: Loading) -> list[Any]:
    """On the second link of each joint: of torsion springs and friction; in a slide its friction along it."""
    moments: list[Any] = [0.0] * len(JOINTS)
    for joint, stiffness, free in loading.windings:
        first, second = JOINTS[joint]
        angle = at.turn(second) - at.turn(first) - free
        moments[joint] = moments[joint] - stiffness * (np.remainder(angle + np.pi, 2 * np.pi) - np.pi)
    viscous, constant, slides = list(loading.viscous), list(loading.constant), at.slide is not None
    if at.slide is not None:
        viscous[at.slide], constant[at.slide] = loading.slide_viscous, loading.slide_constant
    for joint in range(len(JOINTS)):
        rate = at.driver.pace * at.opening(joint)
        if viscous[joint]:
            moments[joint] = moments[joint] - viscous[joint] * rate
        if constant[joint]:
            moments[joint] = moments[joint] - constant[joint] * np.sign(rate)
    if not any(loading.radius) and not (slides and loading.slide_mu):
        return moments
    known = moments
    for _ in range(_FRICTION_ROUNDS):
        forces, pressed = _reactions(at, loading, moments)
        sizes = [
            loading.slide_mu * _pressing(loading, *pressed)
            if joint == at.slide
            else loading.radius[joint] * np.sqrt(force.square + _TINY)
            for joint, force in enumerate(forces)
        ]
        moments = [
            moment - size * np.sign(at.driver.pace * at.opening(joint))
            for joint, (moment, size) in enumerate(zip(known, sizes, strict=True))
        ]
    return moments


def _pressing(loading: Loading, across: Any, moment: Any) -> Any:
    """The force that causes friction in the slide: max(|N|, 2 |M| / length)."""
    across = np.sqrt(across**2 + _TINY)
    if not loading.slide_length:
        return across
    return np.maximum(across, 2 * np.sqrt(moment**2 + _TINY) / loading.slide_length)
