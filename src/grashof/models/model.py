"""The common base of models: a linkage as it is used, the range of its driver, the masses of its links."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from grashof.analysis import Position, driver_ranges, full_rotation, solve_position
from grashof.analysis.forces.from_spec import stated_masses
from grashof.analysis.forces.mass import Masses, uniform_bars
from grashof.problems import Linkage, LinkageSpec, ProblemError
from grashof.problems.values.arrays import TURN
from grashof.problems.values.dynamics.dynamics_spec import METRES
from grashof.problems.values.specs.linkage_spec import ListedDesign

_BAR = 1.0  # kg/m, of the bars of a linkage whose file states no masses


@dataclass(frozen=True)
class Model:
    """A linkage on the assembly that it is used on, at a driver angle to begin from.

    Parameters
    ----------
    spec : LinkageSpec
    linkage : Linkage
        A single one.
    low, high : float, rad
        Driver angles between which it moves: a full turn, or the dead positions beside `start`.
    start : float, rad
        Of a listed design that of its first target, else the middle of the range.

    Examples
    --------
    >>> from grashof.problems import load_linkage_spec
    >>> model = Model.of(load_linkage_spec("pumpjack"))
    >>> model.turns, model.start
    (True, 0.0)
    """

    spec: LinkageSpec
    linkage: Linkage
    low: float
    high: float
    start: float

    @classmethod
    def of(cls, one: LinkageSpec | ListedDesign) -> Model:
        """The model of a linkage file, or of a design of a list.

        Raises
        ------
        ProblemError
            It cannot be assembled at any driver angle.
        """
        spec, theta2 = (one.spec, one.theta2[0]) if isinstance(one, ListedDesign) else (one, None)
        linkage = spec.linkage
        if isinstance(one, ListedDesign):
            linkage = linkage.changed(assembly=float(one.assembly[0]))
        if full_rotation(linkage):
            start = 0.0 if theta2 is None else float(theta2)
            low = TURN * float(np.floor(start / TURN))
            return cls(spec, linkage, low, low + TURN, start)
        ranges = driver_ranges(linkage)
        ranges = ranges[np.isfinite(ranges[:, 0])]
        if not len(ranges):
            raise ProblemError(f"{spec.name} cannot be assembled at any driver angle")
        if theta2 is None:
            low, high = ranges[0].tolist()
            return cls(spec, linkage, low, high, (low + high) / 2)
        for low, high in ranges.tolist():
            turned = low + (float(theta2) - low) % TURN
            if turned <= high:
                return cls(spec, linkage, low, high, turned)
        raise ProblemError(f"{spec.name} cannot be assembled at its first target")

    @property
    def turns(self) -> bool:
        """Whether the driver turns fully."""
        return bool(
            np.isclose(self.high - self.low, TURN, rtol=0, atol=1e-12) and full_rotation(self.linkage)
        )

    @cached_property
    def first(self) -> Position:
        """The position at `start`."""
        return solve_position(self.linkage, self.start)

    @property
    def metre(self) -> float:
        """The length unit in metres; 1 where it is not one of `METRES`."""
        return METRES.get(self.spec.length_unit, 1.0)

    @property
    def omega2(self) -> float:
        """Speed of the driver, rad/s; 1 where the file states none."""
        dynamics = self.spec.dynamics
        return float(dynamics.omega2) if dynamics is not None and dynamics.omega2 else 1.0

    @property
    def masses(self) -> Masses:
        """Masses of the links, lengths in the linkage's unit; bars of 1 kg/m where the file states none."""
        dynamics = self.spec.dynamics
        if dynamics is None or {dynamics.masses, dynamics.density, dynamics.mass_per_length} == {None}:
            return uniform_bars(self.linkage, _BAR * self.metre)
        return stated_masses(self.linkage, dynamics, self.metre)


def add(parent: ET.Element, tag: str, **attributes: str) -> ET.Element:
    """Add an element to another one."""
    return ET.SubElement(parent, tag, attributes)
