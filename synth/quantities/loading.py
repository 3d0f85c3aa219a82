"""The loading of a linkage: masses and loads of a problem, as numbers of the search."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from grashof.problems import FourBar, Problem
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.dynamics.load_specs import JOINTS, DamperSpec, FrictionSpec, LoadSpec, SpringSpec
from grashof.synth.quantities.frame import Frame

Numbers = tuple[float, ...]
_LINKS = tuple(link.number for link in FourBar.mechanism.links[1:])


@dataclass(frozen=True, slots=True)
class Mass:
    """A mass fixed to a link: a bar along it, or a body at a place."""

    link: int
    per_size: float = 0.0  # of a bar, kg/size
    width: float = 0.0  # of a bar, sizes
    mass: float = 0.0  # of a body, kg
    inertia: float = 0.0  # of a body about its centre, kg sizes^2
    place: Numbers | None = None  # of a body, in the link's frame, sizes; None: halfway between the joints
    at_point: bool = False  # it is at P instead


@dataclass(frozen=True, slots=True)
class AppliedLoad:
    """A force on a link, or a moment, in reference torques and sizes."""

    link: int
    at: Numbers  # sizes
    turning: bool  # a force turns with its link
    moment: bool
    values: Numbers = ()  # of a constant one
    over: str = ""  # "theta2", "theta4", "travel" or "time"; empty for a constant one
    places: Numbers = ()  # deg, sizes or s
    rows: tuple[Numbers, ...] = ()  # its values there


@dataclass(frozen=True, slots=True)
class SpringDamper:
    """A spring or damper between places of two links, in reference torques and sizes."""

    links: tuple[int, ...]
    places: tuple[Numbers, ...]
    stiffness: float
    free_length: float
    damping: float


@dataclass(frozen=True, slots=True)
class Loading:
    """All causes of a drive torque. It hashes, so that a programme can be kept for it."""

    # Inertia force of a kg for an acceleration of one size, in squares of the driver's mean velocity:
    # omega2^2 S^2 / T0, with the task's size S in metres and the reference torque T0.
    inertia: float
    weight: Numbers  # of a kg: g S / T0, a pair
    masses: tuple[Mass, ...]
    applied: tuple[AppliedLoad, ...] = ()
    springs: tuple[SpringDamper, ...] = ()
    windings: tuple[tuple[int, float, float], ...] = ()  # torsion springs: joint, stiffness, free angle
    viscous: Numbers = (0.0,) * 4  # friction in O2, A, B, O4, as the next two
    constant: Numbers = (0.0,) * 4
    radius: Numbers = (0.0,) * 4
    slide_viscous: float = 0.0  # friction in a slide, as the next three
    slide_constant: float = 0.0
    slide_mu: float = 0.0
    slide_length: float = 0.0  # sizes

    @classmethod
    def of(cls, problem: Problem) -> Loading | None:
        """The loading of a problem; None where it has no dynamics."""
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
            applied=tuple(_applied_load(load, frame, size / unit, 1 / unit) for load in spec.loads),
            springs=(
                *(_spring_damper(each, frame, size**2 / unit, spec.omega2) for each in spec.springs),
                *(_spring_damper(each, frame, size**2 / unit, spec.omega2) for each in spec.dampers),
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


NOTHING = Loading(0.0, (0.0, 0.0), ())


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


def _applied_load(load: LoadSpec, frame: Frame, force: float, moment: float) -> AppliedLoad:
    per = moment if load.is_moment else force
    turning, at = load.frame == "link", _scaled(load.at, 1 / frame.scale)
    if load.values is None:
        values = (load.moment,) if load.moment is not None else load.force or ()
        return AppliedLoad(load.link, at, turning, load.is_moment, _scaled(values, per))
    places = tuple(row[0] / (frame.scale if load.over == "travel" else 1.0) for row in load.values)
    rows = tuple(_scaled(row[1:], per) for row in load.values)
    return AppliedLoad(load.link, at, turning, load.is_moment, over=load.over, places=places, rows=rows)


def _spring_damper(
    given: SpringSpec | DamperSpec, frame: Frame, per_size: float, omega2: float
) -> SpringDamper:
    places = []
    for end in given.between:
        inside = frame.inward(np.array(end.at)) if end.link == 1 else complex(*end.at) / frame.scale
        places.append((float(inside.real), float(inside.imag)))
    links = tuple(end.link for end in given.between)
    if isinstance(given, DamperSpec):
        return SpringDamper(links, tuple(places), 0.0, 0.0, given.damping * omega2 * per_size)
    return SpringDamper(
        links, tuple(places), given.stiffness * per_size, given.free_length / frame.scale, 0.0
    )


def _scaled(values: Numbers, factor: float) -> Numbers:
    return tuple(value * factor for value in values)


def _four(values: Numbers, factor: float) -> Numbers:
    return _scaled(values * 4 if len(values) == 1 else values, factor)
