"""What an analysis is made of: a linkage with its motion, what it weighs, what acts on it, what was asked."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from grashof.analysis import Kinematics, Loads, Masses, stated_loads, stated_masses
from grashof.problems import FourBar, LinkageSpec
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import refuse
from grashof.problems.values.dynamics_spec import metres
from grashof.study.sweep import Sweep


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """What an analysis is asked for besides what it always reports.

    Parameters
    ----------
    speed_rpm : float, optional
        Of the driver, counter-clockwise; by default that of the file, or else 1 rad/s.
    at_deg : tuple of float, deg
        Driver angles at which the linkage is looked at closely.
    dwell_deg : float, deg, optional
        The band in which link 4 counts as dwelling.
    release_deg, release_rpm : float, deg and rpm, optional
        Driver angle at which the linkage is let go, and the driver's speed there: none by default.
    seconds : float, s, optional
        How long that motion is followed.
    """

    speed_rpm: float | None = None
    at_deg: tuple[float, ...] = ()
    dwell_deg: float | None = None
    release_deg: float | None = None
    release_rpm: float | None = None
    seconds: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class LinkageStudy:
    """A linkage that is analysed; a section of the report is a function of it.

    Parameters
    ----------
    sweep : Sweep
        Its motion.
    asked : Asked
    """

    sweep: Sweep
    asked: Asked = field(default_factory=Asked)

    @classmethod
    def of(cls, spec: LinkageSpec, asked: Asked) -> LinkageStudy:
        """The study of a linkage; `ProblemError` where it has no motion, or a load does not last for it."""
        sweep = Sweep.of(spec, asked.speed_rpm)
        if spec.dynamics is not None:
            lasts = max(law.duration for law in sweep.laws)
            refuse(spec.dynamics.too_short(lasts, f"the motion at {sweep.speed_rpm:g} rpm"))
        return cls(sweep, asked)

    @property
    def spec(self) -> LinkageSpec:
        """The linkage with what its file states."""
        return self.sweep.spec

    @property
    def linkage(self) -> FourBar:
        """The linkage itself."""
        return self.spec.linkage

    @property
    def masses(self) -> Masses | None:
        """Of the links, kg and the length unit; None where the file states nothing that takes a torque."""
        given = self.spec.dynamics
        if given is None or not given.acts:
            return None
        return stated_masses(self.linkage, given, self.metre)

    @property
    def loads(self) -> Loads:
        """What acts on the links, in kg, s and the length unit: newtons over `metre`."""
        given = self.spec.dynamics
        if given is None or not given.acts:
            return Loads()
        return stated_loads(given, self.metre, lambda state: self.sweep.time(state.theta2))

    @property
    def metre(self) -> float:
        """The length unit in metres; `ProblemError` where it is none of those known."""
        return metres(self.spec.length_unit)

    @property
    def states(self) -> list[Kinematics]:
        """Kinematics of each range of the driver at the angles of the tables."""
        return self.sweep.states()

    def joined(self, parts: list[FloatArray]) -> FloatArray:
        """Values of each range one after the other, a row of NaN between them, so that lines break."""
        gaps = [np.full((1, *part.shape[1:]), np.nan) for part in parts]
        rows = [piece for pair in zip(parts, gaps, strict=True) for piece in pair]
        return np.concatenate(rows[:-1])
