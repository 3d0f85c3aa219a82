"""What a linkage carries: masses and loads of a problem, as numbers of the search."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from grashof.problems import FourBar, Problem
from grashof.problems.values.dynamics.acting import JOINTS, DamperSpec, FrictionSpec, LoadSpec, SpringSpec
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.synth.programme.frame import Frame

Numbers = tuple[float, ...]
_LINKS = tuple(link.number for link in FourBar.mechanism.links[1:])


@dataclass(frozen=True, slots=True)
class Mass:
    """A mass fixed to a link: a bar along it, or a body at a place.

    Parameters
    ----------
    link : int
    per_size : float, kg/size
        Of a bar.
    width : float, sizes
        Of a bar.
    mass : float, kg
        Of a body.
    inertia : float, kg sizes^2
        Of a body about its centre.
    place : pair of float, sizes, or None
        Of a body, in the link's frame; halfway between the joints where it is None.
    at_point : bool
        It is at P instead.
    """

    link: int
    per_size: float = 0.0
    width: float = 0.0
    mass: float = 0.0
    inertia: float = 0.0
    place: Numbers | None = None
    at_point: bool = False


@dataclass(frozen=True, slots=True)
class Push:
    """A force on a link, or a moment, in reference torques and sizes.

    Parameters
    ----------
    link : int
    at : pair of float, sizes
    turning : bool
        A force turns with its link.
    moment : bool
    values : tuple of float
        Of a constant one.
    over : str
        "theta2", "theta4", "travel" or "time"; empty for a constant one.
    places : tuple of float, deg, sizes or s
    rows : tuple of tuples of float
        Its values there.
    """

    link: int
    at: Numbers
    turning: bool
    moment: bool
    values: Numbers = ()
    over: str = ""
    places: Numbers = ()
    rows: tuple[Numbers, ...] = ()


@dataclass(frozen=True, slots=True)
class Pull:
    """A spring or damper between places of two links, in reference torques and sizes."""

    links: tuple[int, ...]
    places: tuple[Numbers, ...]
    stiffness: float
    free_length: float
    damping: float


@dataclass(frozen=True, slots=True)
class Burden:
    """All that takes a drive torque. It hashes, so that a programme can be kept for it.

    Parameters
    ----------
    inertia : float
        What a kg takes for each size of acceleration in squares of the driver's mean velocity:
        omega2^2 S^2 / T0, with the task's size S in metres and the reference torque T0.
    weight : pair of float
        What a kg weighs: g S / T0.
    masses : tuple of Mass
    pushes : tuple of Push
    pulls : tuple of Pull
    windings : tuple of (joint, stiffness, free angle)
        Torsion springs.
    viscous, constant, radius : four floats
        Friction in O2, A, B, O4.
    slide_viscous, slide_constant, slide_mu, slide_length : float
        Friction in a slide; the length in sizes.
    """

    inertia: float
    weight: Numbers
    masses: tuple[Mass, ...]
    pushes: tuple[Push, ...] = ()
    pulls: tuple[Pull, ...] = ()
    windings: tuple[tuple[int, float, float], ...] = ()
    viscous: Numbers = (0.0,) * 4
    constant: Numbers = (0.0,) * 4
    radius: Numbers = (0.0,) * 4
    slide_viscous: float = 0.0
    slide_constant: float = 0.0
    slide_mu: float = 0.0
    slide_length: float = 0.0

    @classmethod
    def of(cls, problem: Problem) -> Burden | None:
        """That of a problem; None where it has no dynamics."""
        spec = problem.dynamics
        if spec is None:
            return None
        frame, unit = Frame.of(problem.task), problem.reference_torque
        size = frame.scale * metres(problem.length_unit)
        friction = spec.friction or FrictionSpec()
        return cls(
            inertia=spec.omega2**2 * size**2 / unit,
            weight=_scaled(spec.gravity, size / unit),
            masses=tuple(_masses(problem, frame.scale)),
            pushes=tuple(_push(load, frame, size / unit, 1 / unit) for load in spec.loads),
            pulls=(
                *(_pull(each, frame, size**2 / unit, spec.omega2) for each in spec.springs),
                *(_pull(each, frame, size**2 / unit, spec.omega2) for each in spec.dampers),
            ),
            windings=tuple(
                (JOINTS.index(each.between), each.stiffness / unit, float(np.radians(each.free_angle_deg)))
                for each in spec.torsion_springs
            ),
            viscous=_four(friction.viscous, spec.omega2 / unit),
            constant=_four(friction.moment, 1 / unit),
            radius=_four(friction.radius, 1 / frame.scale),
            slide_viscous=friction.slide_viscous * spec.omega2 * size**2 / unit,
            slide_constant=friction.slide_force * size / unit,
            slide_mu=friction.slide_mu,
            slide_length=friction.slide_length / frame.scale,
        )


NOTHING = Burden(0.0, (0.0, 0.0), ())


def _masses(problem: Problem, scale: float) -> Iterator[Mass]:
    spec = problem.dynamics
    if spec is None:
        return
    if spec.mass_per_length is not None:
        yield from (Mass(link, per_size=spec.mass_per_length * scale) for link in _LINKS)
    if spec.density is not None and spec.section is not None:
        per_area = spec.density * metres(problem.length_unit) ** 3 * scale
        for link, area, width in zip(_LINKS, spec.section.areas, spec.section.widths, strict=True):
            yield Mass(link, per_size=per_area * area, width=width / scale)
    if spec.masses is not None and spec.inertias is not None:
        places = spec.centres or (None, None, None)
        for link, mass, inertia, place in zip(_LINKS, spec.masses, spec.inertias, places, strict=True):
            at = None if place is None else _scaled(place, 1 / scale)
            yield Mass(link, mass=mass, inertia=inertia / scale**2, place=at)
    for weight in spec.counterweights:
        yield Mass(weight.link, mass=weight.mass, place=_scaled(weight.at, 1 / scale))
    if spec.payload:
        yield Mass(3, mass=spec.payload, at_point=True)


def _push(load: LoadSpec, frame: Frame, force: float, moment: float) -> Push:
    per = moment if load.is_moment else force
    turning, at = load.frame == "link", _scaled(load.at, 1 / frame.scale)
    if load.values is None:
        values = (load.moment,) if load.moment is not None else load.force or ()
        return Push(load.link, at, turning, load.is_moment, _scaled(values, per))
    places = tuple(row[0] / (frame.scale if load.over == "travel" else 1.0) for row in load.values)
    rows = tuple(_scaled(row[1:], per) for row in load.values)
    return Push(load.link, at, turning, load.is_moment, over=load.over, places=places, rows=rows)


def _pull(given: SpringSpec | DamperSpec, frame: Frame, per_size: float, omega2: float) -> Pull:
    places = []
    for end in given.between:
        inside = frame.inward(np.array(end.at)) if end.link == 1 else complex(*end.at) / frame.scale
        places.append((float(inside.real), float(inside.imag)))
    links = tuple(end.link for end in given.between)
    if isinstance(given, DamperSpec):
        return Pull(links, tuple(places), 0.0, 0.0, given.damping * omega2 * per_size)
    return Pull(links, tuple(places), given.stiffness * per_size, given.free_length / frame.scale, 0.0)


def _scaled(values: Numbers, factor: float) -> Numbers:
    return tuple(value * factor for value in values)


def _four(values: Numbers, factor: float) -> Numbers:
    return _scaled(values * 4 if len(values) == 1 else values, factor)
