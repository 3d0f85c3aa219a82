"""The bars of a linkage, their sections and strengths, and the loads at which they fail."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.joints import Joint
from grashof.analysis.forces.loads import Loads
from grashof.analysis.forces.mass import Masses
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import refuse
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.strength import OneOrEach, SectionSpec, StrengthSpec, check_strength
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.problems.values.specs.dynamics_of_kind import without_place


@dataclass(frozen=True, slots=True)
class Measure:
    """Greatest measure along a bar, or of a pin: in N, N m, Pa, the linkage's "length", or "" for a share."""

    key: str
    label: str
    unit: str


#: Measures of a bar at a position: forces, stresses, deflection, the share of its strength in use.
BAR_MEASURES = (
    Measure("tension", "tension", "N"),
    Measure("compression", "compression", "N"),
    Measure("thrust", "compression between the joints", "N"),
    Measure("shear", "shear force", "N"),
    Measure("moment", "bending moment", "N m"),
    Measure("normal_stress", "normal stress", "Pa"),
    Measure("shear_stress", "shear stress", "Pa"),
    Measure("stress", "equivalent stress", "Pa"),
    Measure("deflection", "deflection", "length"),
    Measure("utilisation", "share of its strength in use", ""),
)
#: The same of a pin.
PIN_MEASURES = (
    Measure("pin_force", "force", "N"),
    Measure("pin_shear", "shear stress of the pin", "Pa"),
    Measure("bearing", "bearing pressure", "Pa"),
)
MEASURES = {measure.key: measure for measure in (*BAR_MEASURES, *PIN_MEASURES)}


@dataclass(frozen=True, slots=True, eq=False)
class Structure:
    """The bars of a linkage and their loads.

    Parameters
    ----------
    masses : Masses
    loads : Loads
        In kg, s and the length unit: newtons over `metre`.
    section : SectionSpec, optional
        Without it there are forces and moments alone.
    strength : StrengthSpec, optional
        Needs `section`.
    metre : float
        The length unit in metres.

    Raises
    ------
    ProblemError
        Strength without the sections that it needs.
    """

    masses: Masses
    loads: Loads
    section: SectionSpec | None = None
    strength: StrengthSpec | None = None
    metre: float = 1.0

    def __post_init__(self) -> None:
        check_strength(self.section, self.strength)

    def in_si(self, unit: str) -> float:
        """A unit of `Measure` in kg, s and the length unit, in SI: the only conversion."""
        return {"N": self.metre, "N m": self.metre**2, "Pa": 1 / self.metre}.get(unit, 1.0)

    @property
    def modulus(self) -> float | None:
        """Elastic modulus in kg, s and the length unit; None where it is not known."""
        given = None if self.strength is None else self.strength.elastic_modulus
        return None if given is None else given / self.in_si("Pa")

    def buckling_loads(self, link: int, length: npt.ArrayLike) -> dict[str, FloatArray]:
        """Loads at which a bar buckles, N, of the length between its joints; by key of a `SafetyFactor`.

        Notes
        -----
        Euler's, pi^2 E I / l^2, both ends pinned in the plane of motion and, on the safe side, out of it;
        of stocky bars, where it exceeds half the yield load A Sy, Johnson's parabola,
        A Sy (1 - A Sy / (4 Euler's)) (Shigley, *Mechanical Engineering Design*, secs. 4-12 and 4-13).
        """
        if self.section is None or self.strength is None or self.modulus is None:
            return {}
        section, square = self.section.of(link), np.square(length)
        crushing = self.strength.yield_stress / self.in_si("Pa") * section.area
        found = {}
        for key, inertia in (("buckling", section.inertia), ("buckling_across", section.inertia_across)):
            if inertia is not None:
                euler = np.pi**2 * self.modulus * inertia / square
                johnson = crushing * (1 - crushing / (4 * euler))
                found[key] = np.where(2 * euler < crushing, euler, johnson) * self.in_si("N")
        return found

    def check(self, linkage: Linkage) -> None:
        """Refuse sections and pins, a list each, that are not those of a linkage.

        Raises
        ------
        ProblemError
        """
        given = DynamicsSpec(mass_per_length=1.0, section=self.section, strength=self.strength)
        refuse(without_place(given, linkage.mechanism))

    def pin_areas(self, joint: Joint, links: tuple[int, int] | None = None) -> dict[str, float]:
        """Areas that share a joint's force, length^2, by key of `PIN_MEASURES`; none without diameters.

        Parameters
        ----------
        joint : Joint
        links : pair of int, optional
            That it joins; by default in a linkage of one loop.

        Notes
        -----
        The pin's in one section or two, and its diameter times the thickness of the thinner link (mean
        stress and pressure: Shigley, sec. 8-12; Norton, *Machine Design*, sec. 4.8).
        """
        strength = self.strength
        if strength is None or strength.pin_diameter is None:
            return {}
        links = MECHANISMS[0].every_joint[joint].links if links is None else links
        own = [self._thickness(strength, link) for link in links if link != 1]
        sections = 2 if strength.double_shear else 1
        diameter = _one_of(strength.pin_diameter, joint)
        return {
            "pin_shear": sections * np.pi * diameter**2 / 4,
            "bearing": diameter * min(each for each in own if each is not None),
        }

    def _thickness(self, strength: StrengthSpec, link: int) -> float | None:
        if strength.pin_thickness is not None:
            return _one_of(strength.pin_thickness, link - 2)
        return None if self.section is None else self.section.of(link).height


def _one_of(value: OneOrEach, index: int) -> float:
    """One of a list, or the one value for all."""
    return float(value[index] if isinstance(value, Sequence) else value)
