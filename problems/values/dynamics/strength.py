"""Cross-sections and strength of the links and their pins."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import ClassVar, TypeAlias

from grashof.problems.values.checks import GREATEST, LEAST, one_or_each, size_number, true_or_false
from grashof.problems.values.errors import ProblemError, listing
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.problems.values.value_bases import TableValue, check_fields, set_fields

OneOrEach: TypeAlias = float | Sequence[float]
LINKS = ("link 2", "link 3", "link 4")
SHAPES = "width and height, or area, inertia and extreme_fibre"
_RECTANGLE = ("width", "height")
_ANY_SHAPE = ("area", "inertia", "extreme_fibre")
_POWERS = {"area": 2, "inertia": 4, "inertia_across": 4}  # of the length unit; the others are lengths
_RECTANGLE_SHEAR = 1.5
_LARGEST_SHEAR = 2.0


@dataclass(frozen=True, slots=True)
class CrossSection:
    """The section of one link.

    Parameters
    ----------
    area : float, length^2
    inertia : float, length^4
        Second moment of area for bending in the plane of motion.
    extreme_fibre : float, length
        Distance of the outermost fibre from the neutral axis in that bending.
    shear_factor : float
        Greatest shear stress over the mean one, shear force / area.
    inertia_across : float or None, length^4
        For bending out of the plane of motion, where it is known.
    height : float or None, length
        Across the plane of motion, where it is known: as long as a pin bears.
    """

    area: float
    inertia: float
    extreme_fibre: float
    shear_factor: float
    inertia_across: float | None = None
    height: float | None = None


@dataclass(frozen=True, slots=True)
class SectionSpec(TableValue):
    """Cross-sections of links 2, 3 and 4, in the length unit: one for all, or lists of three.

    Parameters
    ----------
    width : float or three floats, length, optional
        Of a solid rectangle, in the plane of motion.
    height : float or three floats, length, optional
        Of it, across that plane.
    area : float or three floats, length^2, optional
        Instead, of any shape.
    inertia : float or three floats, length^4, optional
        Its second moment of area for bending in the plane of motion.
    extreme_fibre : float or three floats, length, optional
        Distance of its outermost fibre from the neutral axis in that bending.
    inertia_across : float or three floats, length^4, optional
        For bending out of the plane of motion; without it buckling that way is left open.
    shear_factor : float or three floats, optional
        Greatest shear stress over the mean one: 2 for a thin round tube (the default), 4/3 for a round
        bar, 1.5 for a rectangle.

    Raises
    ------
    ProblemError
        Numbers that are not finite and greater than zero or beyond 1e20 (to the power of their unit),
        lists of another length, a shape that is given twice or in part, or one that cannot be.

    Notes
    -----
    A rectangle has A = width height and I = height width^3 / 12 (Shigley, *Mechanical Engineering
    Design*, table A-18); shear factors are those of Shigley, table 3-2.

    Examples
    --------
    >>> section = SectionSpec(width=0.2, height=[0.1, 0.1, 0.3])
    >>> round(section.of(4).area, 6), round(section.of(4).inertia, 6), section.of(2).height
    (0.06, 0.0002, 0.1)
    """

    keeps_defaults: ClassVar[bool] = True

    width: OneOrEach | None = None
    height: OneOrEach | None = None
    _: KW_ONLY
    area: OneOrEach | None = None
    inertia: OneOrEach | None = None
    extreme_fibre: OneOrEach | None = None
    inertia_across: OneOrEach | None = None
    shear_factor: OneOrEach | None = None

    def __post_init__(self) -> None:
        given = self.stated
        _check_shape(list(given))
        set_fields(self, **{name: _checked(name, value) for name, value in given.items()})
        for link in (2, 3, 4) if self.width is None else ():
            self._check_reach(link)

    @property
    def areas(self) -> tuple[float, float, float]:
        """Of links 2, 3 and 4, length^2."""
        return self.of(2).area, self.of(3).area, self.of(4).area

    @property
    def widths(self) -> tuple[float, ...]:
        """Of links 2, 3 and 4 in the plane of motion, length; 0 where only the area is known."""
        return self.width if isinstance(self.width, tuple) else (float(self.width or 0.0),) * 3  # type: ignore[arg-type]

    def of(self, link: int) -> CrossSection:
        """The section of link 2, 3 or 4."""
        own = {
            name: value[link - 2] if isinstance(value, list) else value for name, value in self.stated.items()
        }
        if self.width is None:
            return CrossSection(**{"shear_factor": _LARGEST_SHEAR, **own})
        width, height = own["width"], own["height"]
        return CrossSection(
            area=width * height,
            inertia=height * width**3 / 12,
            extreme_fibre=width / 2,
            shear_factor=_RECTANGLE_SHEAR,
            inertia_across=width * height**3 / 12,
            height=height,
        )

    def _check_reach(self, link: int) -> None:
        own = self.of(link)
        most = own.area * own.extreme_fibre**2
        if own.inertia > most * (1 + 1e-9):
            where = f"section.inertia[{link - 2}]" if isinstance(self.inertia, tuple) else "section.inertia"
            limit = f"at most area times extreme_fibre squared, {most:.15g}"
            raise ProblemError(f"{where} is {own.inertia:.15g}; it must be {limit}")


def _check_shape(names: Sequence[str]) -> None:
    """Refuse keys of both shapes together, or of neither one all."""
    rectangle = [name for name in names if name in _RECTANGLE]
    other = [name for name in names if name not in _RECTANGLE]
    if not names:
        raise ProblemError(f"section is empty; it must have {SHAPES}")
    if rectangle and other:
        raise ProblemError(f"section.{other[0]} does not go with {rectangle[0]}; give one shape or the other")
    needed = _RECTANGLE if rectangle else _ANY_SHAPE
    for name in needed:
        if name not in names:
            raise ProblemError(f"section.{name} is missing; {listing(needed, 'and')} are needed together")


def _checked(name: str, value: OneOrEach) -> OneOrEach:
    where = f"section.{name}"
    # The greatest shear stress is at least the mean; area and inertia are powers of lengths.
    least = 1.0 if name == "shear_factor" else LEAST ** _POWERS.get(name, 1)
    return one_or_each(value, LINKS, where, least, GREATEST ** _POWERS.get(name, 1))


JOINTS = tuple(joint.name for joint in MECHANISMS[0].every_joint)


@dataclass(frozen=True, slots=True)
class StrengthSpec(TableValue):
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
        Bearing pressure that pins and links withstand; yield_stress by default.
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

    keeps_defaults: ClassVar[bool] = True

    yield_stress: float
    elastic_modulus: float | None = None
    _: KW_ONLY
    pin_diameter: OneOrEach | None = None
    pin_shear_strength: float | None = None
    bearing_strength: float | None = None
    pin_thickness: OneOrEach | None = None
    double_shear: bool = False

    def __post_init__(self) -> None:
        check_fields(self, "strength.", double_shear=true_or_false)
        of_pins = ("pin_shear_strength", "bearing_strength", "pin_thickness")
        given = [name for name in of_pins if getattr(self, name) is not None]
        given += ["double_shear"] if self.double_shear else []
        if self.pin_diameter is None and given:
            raise ProblemError(f"strength.pin_diameter is missing; {given[0]} is of no use without it")
        check_fields(
            self,
            "strength.",
            **dict.fromkeys(
                ("yield_stress", "elastic_modulus", "pin_shear_strength", "bearing_strength"), size_number
            ),
            pin_diameter=lambda value, where: one_or_each(value, JOINTS, where),
            pin_thickness=lambda value, where: one_or_each(value, LINKS, where),
        )

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
