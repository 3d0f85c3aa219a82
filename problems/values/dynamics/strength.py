"""What the links and their pins are made of, and how much of it there is at the pins."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass

from grashof.problems.values.checks import one_or_each, size_number
from grashof.problems.values.dynamics.section import LINKS, SHAPES, OneOrEach, SectionSpec
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.problems.values.stated import Given

JOINTS = tuple(joint.name for joint in MECHANISMS[0].every_joint)


@dataclass(frozen=True, slots=True)
class StrengthSpec(Given):
    """Strengths of the links and of their pins; Pa, and the length unit.

    Parameters
    ----------
    yield_stress : float, Pa
        Of the links.
    elastic_modulus : float, Pa, optional
        Of the links; deflection and buckling need it.
    pin_diameter : float or four floats, length, optional
        Of the pins in O2, A, B, O4.
    pin_shear_strength : float, Pa, optional
        Of the pins; yield_stress / sqrt(3) by default.
    bearing_strength : float, Pa, optional
        Pressure that pins and links stand; yield_stress by default.
    pin_thickness : float or three floats, length, optional
        Of links 2, 3 and 4 where a pin goes through; the height of the section by default.
    double_shear : bool
        The links' ends are forks, so that two sections of each pin share its force.

    Raises
    ------
    ProblemError
        Numbers that are not finite and greater than zero or beyond 1e20, lists of another length, or
        strengths of pins that have no diameter.

    Notes
    -----
    A ductile material yields in shear at 0.577 of its yield stress (von Mises; Shigley, *Mechanical
    Engineering Design*, sec. 5-5).

    Examples
    --------
    >>> round(StrengthSpec(235e6).shear_limit / 1e6, 1)
    135.7
    """

    yield_stress: float
    elastic_modulus: float | None = None
    _: KW_ONLY
    pin_diameter: OneOrEach | None = None
    pin_shear_strength: float | None = None
    bearing_strength: float | None = None
    pin_thickness: OneOrEach | None = None
    double_shear: bool = False

    def __post_init__(self) -> None:
        if not isinstance(self.double_shear, bool):
            raise wrong_value("strength.double_shear", self.double_shear, "true or false")
        of_pins = ("pin_shear_strength", "bearing_strength", "pin_thickness")
        given = [name for name in of_pins if getattr(self, name) is not None]
        given += ["double_shear"] if self.double_shear else []
        if self.pin_diameter is None and given:
            raise ProblemError(f"strength.pin_diameter is missing; {given[0]} is of no use without it")
        for name in ("yield_stress", "elastic_modulus", "pin_shear_strength", "bearing_strength"):
            if name == "yield_stress" or getattr(self, name) is not None:
                object.__setattr__(self, name, size_number(getattr(self, name), f"strength.{name}"))
        for name, owners in (("pin_diameter", JOINTS), ("pin_thickness", LINKS)):
            if (lengths := getattr(self, name)) is not None:
                object.__setattr__(self, name, one_or_each(lengths, owners, f"strength.{name}"))

    @property
    def shear_limit(self) -> float:
        """Shear stress at which pins yield, Pa."""
        return (
            self.yield_stress / math.sqrt(3) if self.pin_shear_strength is None else self.pin_shear_strength
        )

    @property
    def bearing_limit(self) -> float:
        """Pressure at which pins and links yield, Pa."""
        return self.yield_stress if self.bearing_strength is None else self.bearing_strength

    def diameters(self) -> tuple[float, ...] | None:
        """Of the pins in O2, A, B, O4, length; None where none is given."""
        return None if self.pin_diameter is None else _each(self.pin_diameter, len(JOINTS))

    def thicknesses(self, section: SectionSpec | None) -> tuple[float | None, ...]:
        """Of links 2, 3 and 4 at their pins, length; None where neither table gives one."""
        if self.pin_thickness is not None:
            return _each(self.pin_thickness, len(LINKS))
        return tuple(None if section is None else section.of(link).height for link in (2, 3, 4))


def check_strength(section: SectionSpec | None, strength: StrengthSpec | None) -> None:
    """Refuse a strength without sections, or with pins but neither height nor thickness of a link."""
    if strength is None:
        return
    if section is None:
        raise ProblemError(f"section is missing, which strength needs; give {SHAPES}")
    if strength.pin_diameter is not None and None in strength.thicknesses(section):
        raise ProblemError(
            "strength.pin_thickness is missing; bearing pressure needs it where section has no height"
        )


def _each(value: OneOrEach, count: int) -> tuple[float, ...]:
    return tuple(value) if isinstance(value, Sequence) else (value,) * count
