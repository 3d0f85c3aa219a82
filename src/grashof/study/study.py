"""What an analysis is made of: a linkage with its motion, what it weighs, what acts on it, what was asked."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from grashof.analysis import Kinematics, Loads, Masses
from grashof.problems import FourBar, LinkageSpec
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics_spec import metres
from grashof.study.sweep import Sweep, masses_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """What an analysis is asked for besides what it always reports.

    Parameters
    ----------
    speed_rpm : float, optional
        Of the driver, counter-clockwise; by default that of the file, or else 1 rad/s.
    """

    speed_rpm: float | None = None


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
        """The study of a linkage; `ProblemError` where it closes at no driver angle."""
        return cls(Sweep.of(spec, asked.speed_rpm), asked)

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
        """Of the links, kg and the length unit; None where the file states none."""
        return masses_of(self.spec)

    @property
    def loads(self) -> Loads:
        """What acts on the links, in kg, s and the length unit: newtons over `metre`."""
        given = self.spec.dynamics
        return Loads() if given is None else Loads(gravity=np.array(given.gravity) / self.metre)

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
