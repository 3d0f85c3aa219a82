"""What the links weigh, how fast the driver turns and where gravity points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from grashof.problems.values.checks import GREATEST, number_within, positive_number
from grashof.problems.values.errors import ProblemError, wrong_value

METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254, "ft": 0.3048}
_STEADY = 30 / np.pi  # rpm: 1 rad/s
Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True, init=False)
class DynamicsSpec:
    """Masses, speed and gravity, of a problem or of one linkage; kg, s and its length unit.

    Parameters
    ----------
    mass_per_length : float, kg/length, optional
        The links are slender uniform bars from joint to joint.
    masses, inertias : three floats, kg and kg length^2, optional
        Instead: of links 2, 3 and 4, inertias about the centres of mass, which lie halfway between
        the joints of each link (the coupler's between A and B, wherever P is).
    payload : float, kg
        Carried at P, as a point.
    speed_rpm : float
        Of the driver; 1 rad/s by default. Of a linkage counter-clockwise; of a problem greater than
        zero, in the sense that the task asks for.
    gravity : two floats, m/s^2
        In metres whatever the length unit; none by default.

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

    mass_per_length: float | None
    masses: Triple | None
    inertias: Triple | None
    payload: float
    speed_rpm: float
    gravity: tuple[float, float]

    def __init__(
        self,
        mass_per_length: float | None = None,
        masses: Sequence[float] | None = None,
        inertias: Sequence[float] | None = None,
        *,
        payload: float = 0.0,
        speed_rpm: float = _STEADY,
        gravity: Sequence[float] = (0.0, 0.0),
    ) -> None:
        if mass_per_length is not None and (masses is not None or inertias is not None):
            raise ProblemError(
                "dynamics.mass_per_length does not go with masses and inertias; give one or the other"
            )
        if (masses is None) != (inertias is None):
            absent = "masses" if masses is None else "inertias"
            raise ProblemError(f"dynamics.{absent} is missing; masses and inertias are needed together")
        if mass_per_length is not None:
            mass_per_length = positive_number(
                _bounded(mass_per_length, "dynamics.mass_per_length"), "dynamics.mass_per_length"
            )
        object.__setattr__(self, "mass_per_length", mass_per_length)
        object.__setattr__(self, "masses", _triple(masses, "dynamics.masses"))
        object.__setattr__(self, "inertias", _triple(inertias, "dynamics.inertias"))
        if self.masses is not None and not any(self.masses):
            raise ProblemError("dynamics.masses are all zero; one at least has a mass")
        object.__setattr__(self, "payload", _from_zero(payload, "dynamics.payload"))
        object.__setattr__(self, "speed_rpm", _bounded(speed_rpm, "dynamics.speed_rpm"))
        object.__setattr__(self, "gravity", _numbers(gravity, 2, "dynamics.gravity"))

    @property
    def stated(self) -> dict[str, Any]:
        """The arguments that give this value, without those that are not given: a file's table."""
        every = {name: getattr(self, name) for name in self.__slots__}
        return {name: value for name, value in every.items() if value is not None}

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
        """Whether the links or the payload have a mass."""
        return self.mass_per_length is not None or self.masses is not None or self.payload > 0

    @property
    def omega2(self) -> float:
        """Speed of the driver, rad/s."""
        return self.speed_rpm * np.pi / 30


def metres(length_unit: str) -> float:
    """Length of a unit in metres.

    Raises
    ------
    ProblemError
        The unit is none of those known.

    Examples
    --------
    >>> metres("in")
    0.0254
    """
    if length_unit not in METRES:
        raise wrong_value("length_unit", length_unit, f"one of {', '.join(METRES)} with dynamics")
    return METRES[length_unit]


def _numbers(values: Sequence[float], count: int, where: str) -> tuple[float, ...]:
    try:
        numbers = list(values)
    except TypeError:
        raise wrong_value(where, values, f"{count} numbers") from None
    if len(numbers) != count:
        entries = "1 entry" if len(numbers) == 1 else f"{len(numbers)} entries"
        raise ProblemError(f"{where} has {entries}; it must have {count} numbers")
    return tuple(_bounded(value, f"{where}[{index}]") for index, value in enumerate(numbers))


def _triple(values: Sequence[float] | None, where: str) -> tuple[float, ...] | None:
    if values is None:
        return None
    numbers = _numbers(values, 3, where)
    return tuple(_from_zero(value, f"{where}[{index}]") for index, value in enumerate(numbers))


def _from_zero(value: float, where: str) -> float:
    number = _bounded(value, where)
    if number < 0:
        raise ProblemError(f"{where} is {number:.15g}; it must be a number from zero")
    return number


def _bounded(value: float, where: str) -> float:
    return number_within(value, -GREATEST, GREATEST, where)
