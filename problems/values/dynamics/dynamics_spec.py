"""Dynamics: masses of the links, speed of the driver, gravity, loads."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from grashof.problems.values.checks import bounded, from_zero, pair, positive_bounded
from grashof.problems.values.dynamics.effort import EffortSpec
from grashof.problems.values.dynamics.load_specs import (
    CounterweightSpec,
    DamperSpec,
    FrictionSpec,
    LoadSpec,
    Pair,
    SpringSpec,
    TorsionSpringSpec,
)
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.dynamics.strength import SectionSpec, StrengthSpec, check_strength
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.problems.values.value_bases import TableValue, check_fields, set_fields

METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254, "ft": 0.3048}
STEADY = 30 / np.pi  # rpm: 1 rad/s
_MOVING = {len(row.links) - 1 for row in MECHANISMS}  # how many moving links a linkage may have
_LISTS: dict[str, type] = {
    "loads": LoadSpec,
    "springs": SpringSpec,
    "dampers": DamperSpec,
    "torsion_springs": TorsionSpringSpec,
    "counterweights": CounterweightSpec,
}
# Keys of the table [dynamics]; the other fields have tables of their own.
DYNAMICS_KEYS = (
    "mass_per_length", "density", "masses", "inertias", "centres", "payload", "speed_rpm", "gravity",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class DynamicsSpec(TableValue):
    """Masses, speed, gravity and loads, of a problem or of one linkage; kg, s and its length unit.

    Forces are in N, moments in N m, stiffness in N/m, whatever the length unit.

    Parameters
    ----------
    mass_per_length : float, kg/length, optional
        The links are slender uniform bars from joint to joint.
    masses : floats, kg, optional
        Instead, with `inertias`: of links 2, 3 and 4; of a six-bar of links 2 to 6.
    inertias : floats, kg length^2, optional
        Of the same links about their centres of mass.
    centres : pairs of float, length, optional
        Centres of mass of the same links in their frames; by default halfway between the joints of
        each link (the coupler's between A and B, wherever P is).
    density : float, kg/m^3, optional
        Instead: the links are uniform bars of the `section`.
    payload : float, kg
        Carried at P, as a point.
    speed_rpm : float
        Of the driver; 1 rad/s by default. Of a linkage counter-clockwise; of a problem greater than
        zero, in the sense that the task requires.
    gravity : two floats, m/s^2
        In metres whatever the length unit; none by default.
    loads : tuple of LoadSpec
        Forces and moments on the links.
    springs : tuple of SpringSpec
        Straight ones, between points of two links.
    dampers : tuple of DamperSpec
        Against the speed at which points of two links part.
    torsion_springs : tuple of TorsionSpringSpec
        About joints, between the two links there.
    counterweights : tuple of CounterweightSpec
        Point masses on the links, besides their own.
    friction : FrictionSpec, optional
        In joints and in a slide.
    motor : MotorSpec, optional
        Speed profile, gear and inertia of the drive; steady speed without it.
    section : SectionSpec, optional
        Of the bars; `density` needs it, and strength.
    strength : StrengthSpec, optional
        Of the bars and pins.
    effort : EffortSpec, optional
        The effort by which a hand moves the linkage, with its struts and springs.

    Raises
    ------
    ProblemError
        Numbers that are not finite or beyond 1e20, negative masses, or links whose masses are given
        twice or in part.

    Examples
    --------
    >>> round(DynamicsSpec(mass_per_length=2.0, speed_rpm=30).omega2, 6)
    3.141593
    """

    mass_per_length: float | None = None
    masses: tuple[float, ...] | None = None
    inertias: tuple[float, ...] | None = None
    centres: tuple[Pair, ...] | None = None
    density: float | None = None
    payload: float = 0.0
    speed_rpm: float = STEADY
    gravity: Pair = (0.0, 0.0)
    loads: tuple[LoadSpec, ...] = ()
    springs: tuple[SpringSpec, ...] = ()
    dampers: tuple[DamperSpec, ...] = ()
    torsion_springs: tuple[TorsionSpringSpec, ...] = ()
    counterweights: tuple[CounterweightSpec, ...] = ()
    friction: FrictionSpec | None = None
    motor: MotorSpec | None = None
    section: SectionSpec | None = None
    strength: StrengthSpec | None = None
    effort: EffortSpec | None = None

    def __post_init__(self) -> None:
        self._check_masses()
        check_fields(self, "dynamics.", mass_per_length=positive_bounded, density=positive_bounded)
        number = partial(_each, what="a number", check=from_zero)
        check_fields(self, "dynamics.", masses=number, inertias=number)
        if self.masses and not any(self.masses):
            raise ProblemError("dynamics.masses are all zero; one at least has a mass")
        places = partial(_each, what="a place [u, v]", check=pair)
        check_fields(self, "dynamics.", centres=places, payload=from_zero, speed_rpm=bounded, gravity=pair)
        for name, kind in _LISTS.items():
            entries = getattr(self, name)
            if not isinstance(entries, Sequence) or not all(isinstance(each, kind) for each in entries):
                raise wrong_value(name, entries, f"a list of {kind.__name__}")
            set_fields(self, **{name: tuple(entries)})

    def _check_masses(self) -> None:
        given = [name for name in ("mass_per_length", "density") if getattr(self, name) is not None]
        given += ["masses and inertias"] if (self.masses, self.inertias) != (None, None) else []
        if len(given) > 1:
            raise ProblemError(f"dynamics.{given[0]} does not go with {given[1]}; give one or the other")
        if (self.masses is None) != (self.inertias is None):
            absent = "masses" if self.masses is None else "inertias"
            raise ProblemError(f"dynamics.{absent} is missing; masses and inertias are needed together")
        if self.centres is not None and self.masses is None:
            raise ProblemError("dynamics.masses is missing; centres are those of given masses and inertias")
        if self.density is not None and self.section is None:
            raise ProblemError("section is missing; dynamics.density needs it")
        check_strength(self.section, self.strength)

    @property
    def tables(self) -> dict[str, Any]:
        """The tables, and lists of tables, of a file that states it, by name."""
        own = {key: getattr(self, key) for key in DYNAMICS_KEYS if getattr(self, key) is not None}
        return {
            "dynamics": own,
            **{key: given for key, given in self.stated.items() if key not in DYNAMICS_KEYS},
        }

    def turning(self, direction: int) -> DynamicsSpec:
        """The dynamics of a linkage whose driver turns counter-clockwise (+1) or clockwise (-1).

        Examples
        --------
        >>> DynamicsSpec(payload=1.0, speed_rpm=20).turning(-1).speed_rpm
        -20.0
        """
        return replace(self, speed_rpm=direction * abs(self.speed_rpm))

    @property
    def has_masses(self) -> bool:
        """Whether the links, the payload or counterweights have a mass."""
        bars = (self.mass_per_length, self.density, self.masses)
        return any(given is not None for given in bars) or self.payload > 0 or bool(self.counterweights)

    @property
    def acts(self) -> bool:
        """Whether anything takes a torque: masses, loads, springs, dampers, friction."""
        given = (self.loads, self.springs, self.dampers, self.torsion_springs)
        return self.has_masses or any(given) or self.friction is not None

    def too_short(self, duration: float, where: str) -> list[str]:
        """Errors of loads over time that do not cover a duration (s), which `where` explains."""
        return [
            f"loads[{index}] covers {load.values[0][0]:g} to {load.values[-1][0]:g} s; "
            f"it must cover 0 to {duration:.6g} s, {where}"
            for index, load in enumerate(self.loads)
            if load.values is not None and load.over == "time"
            if load.values[0][0] > 0 or not load.values[-1][0] >= duration * (1 - 1e-12)
        ]

    @property
    def beside_task(self) -> list[str]:
        """Keys that do not go with a problem, a line each."""
        if self.effort is None or self.effort.travel_deg is None:
            return []
        return ["effort.travel_deg does not go with a problem; it travels from the first target to the last"]

    @property
    def turn_time(self) -> float:
        """Duration of a turn of the driver, s: at its mean speed, or from the motor's table."""
        if self.motor is not None and self.motor.values is not None:
            return self.motor.values[-1][0] - self.motor.values[0][0]
        return 60 / abs(self.speed_rpm) if self.speed_rpm else np.inf

    @property
    def omega2(self) -> float:
        """Speed of the driver, rad/s; its mean where a motor starts and stops."""
        return self.speed_rpm * np.pi / 30


def reference_torque(spec: DynamicsSpec, task_size: float, metre: float) -> float:
    """`Problem.reference_torque`, N m, from the size of the task and its unit in metres."""
    size = task_size * metre
    mass = (spec.mass_per_length or 0.0) * task_size + sum(spec.masses or ()) + spec.payload
    mass += sum(weight.mass for weight in spec.counterweights)
    if spec.density is not None and spec.section is not None:
        mass += spec.density * max(spec.section.areas) * metre**2 * size
    torque = mass * size * (math.hypot(*spec.gravity) + spec.omega2**2 * size)
    torque += sum(load.greatest * (1.0 if load.is_moment else size) for load in spec.loads)
    torque += sum(spring.stiffness for spring in spec.springs) * size**2
    torque += sum(damper.damping for damper in spec.dampers) * spec.omega2 * size**2
    torque += sum(spring.stiffness for spring in spec.torsion_springs)
    if spec.friction is not None:
        torque += max(spec.friction.moment) + max(spec.friction.viscous) * spec.omega2
    return torque or 1.0


def metres(length_unit: str, needed_by: str = "dynamics") -> float:
    """Length of a unit in metres; `ProblemError` where it is none of `METRES`."""
    if length_unit not in METRES:
        raise wrong_value("length_unit", length_unit, f"one of {', '.join(METRES)} with {needed_by}")
    return METRES[length_unit]


def _each(values: Any, where: str, what: str, check: Callable[[Any, str], Any]) -> tuple[Any, ...]:
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise wrong_value(where, values, f"{what} for each moving link")
    given = tuple(values)
    if len(given) not in _MOVING:
        return given  # of no linkage: `misplaced` reports how many are needed
    return tuple(check(value, f"{where}[{index}]") for index, value in enumerate(given))
