"""The subject of an analysis: a linkage with its motion, masses, loads and the requested options."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from grashof.analysis import DriverLaw, DriverMotion, Kinematics, Loads, Masses, stated_loads, stated_masses
from grashof.analysis.mechanism.stroke import LinkStroke, link_stroke
from grashof.problems import FourBar, Linkage, LinkageSpec, ProblemError
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.checks import refuse
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.study.asked import Asked as Asked
from grashof.study.sweep import INSET, Sweep

_TOUCHING = 1e-9  # rad: a driver angle this little beyond a dead position counts as in it


@dataclass(frozen=True, slots=True, eq=False)
class LinkageStudy:
    """An analysed linkage; a section of the report is a function of it."""

    sweep: Sweep
    asked: Asked = field(default_factory=Asked)

    @classmethod
    def of(cls, spec: LinkageSpec, asked: Asked) -> LinkageStudy:
        """The study of a linkage; `ProblemError` where it has no motion, or a load ends before the motion."""
        sweep = Sweep.of(spec, asked.speed_rpm)
        if spec.dynamics is not None:
            lasts = max(law.duration for law in sweep.laws)
            refuse(spec.dynamics.too_short(lasts, f"the motion at {sweep.speed_rpm:g} rpm"))
        return cls(sweep, asked)

    @property
    def spec(self) -> LinkageSpec:
        """The linkage with the contents of its file."""
        return self.sweep.spec

    @property
    def linkage(self) -> Linkage:
        """The linkage itself."""
        return self.spec.linkage

    @property
    def four_bar(self) -> FourBar:
        """The linkage as a four-bar; `ProblemError` for other kinds."""
        return self.spec.four_bar

    @property
    def output(self) -> int:
        """Number of the output link."""
        return self.linkage.mechanism.links[-1].number

    @property
    def masses(self) -> Masses | None:
        """Masses in kg and the length unit; None where the file states nothing that requires a torque."""
        given = self.spec.dynamics
        if given is None or not given.acts:
            return None
        return stated_masses(self.linkage, given, self.metre)

    @property
    def loads(self) -> Loads:
        """Loads on the links in kg, s and the length unit: newtons over `metre`."""
        given = self.spec.dynamics
        if given is None or not given.acts:
            return Loads()
        return stated_loads(given, self.metre, lambda state: self.sweep.time(state.theta2))

    @property
    def metre(self) -> float:
        """The length unit in metres; `ProblemError` where it is unknown."""
        return metres(self.spec.length_unit)

    @property
    def states(self) -> list[Kinematics]:
        """Kinematics of each range of the driver at the angles of the tables."""
        return self.sweep.states()

    @property
    def start(self) -> float:
        """Driver angle at time 0, rad, in its ranges; ProblemError where the linkage is open there."""
        if self.asked.start_deg is not None:
            return float(self.in_range([self.asked.start_deg], "start_deg")[0])
        return 0.0 if self.sweep.turns else self.sweep.laws[0].start

    @property
    def law_at_start(self) -> tuple[DriverLaw, float]:
        """The law of the driver's motion from `start` on, and the time elapsed on it up to there, s.

        At a change point, where two ranges meet, it is that of the range ahead.
        """
        start, laws = self.start, self.sweep.laws
        ahead = start + 1e-6 * np.sign(laws[0].rotation)
        law = next((law for law in laws if law.holds(ahead)), None)
        law = law or next((law for law in laws if law.holds(start)), laws[0])
        gone = float(law.time_at(start))
        return law, gone if np.isfinite(gone) else 0.0  # not finite at zero speed

    def driver(self, time: npt.ArrayLike) -> DriverMotion:
        """Motion of the driver at times (N,), s, from `start` on, its angle increasing turn after turn.

        A driver that does not turn fully stops at a dead position.
        """
        law, gone = self.law_at_start
        now = gone + np.asarray(time, dtype=np.float64)
        if np.isinf(law.duration):  # at rest
            still = np.zeros(now.shape)
            return DriverMotion(still + self.start, still, still, still)
        if not self.sweep.turns:
            return law.at_time(np.minimum(now, law.duration))
        turns = np.floor(now / law.duration + 1e-12)
        motion = law.at_time(np.maximum(now - turns * law.duration, 0.0))
        return motion._replace(theta2=motion.theta2 + turns * law.rotation)

    def limit_positions(self) -> list[LinkStroke]:
        """Limit positions of the last link in each range of the driver, for linkages of several loops."""
        if self.sweep.turns:
            return [link_stroke(self.linkage)]
        ends = ((low + INSET, high - INSET) for low, high in self.sweep.ranges)
        return [link_stroke(self.linkage, start=low, end=high) for low, high in ends]

    def in_range(self, angles_deg: npt.ArrayLike, name: str) -> FloatArray:
        """Driver angles (N,), deg, brought into the ranges, rad.

        ProblemError, which calls them `name`, where the linkage is open at one of them.
        """
        angles = np.radians(np.atleast_1d(np.asarray(angles_deg, dtype=np.float64)))
        if self.sweep.turns:
            return np.where((angles >= 0) & (angles <= TURN), angles, angles % TURN)
        found = np.full(angles.shape, np.nan)
        for low, high in self.sweep.ranges:
            turned = low + (angles - low + _TOUCHING) % TURN - _TOUCHING
            inside = np.isnan(found) & (turned <= high + _TOUCHING)
            found[inside] = np.clip(turned[inside], low, high)
        if np.isnan(found).any():
            wrong = np.degrees(angles[np.isnan(found)][0])
            raise ProblemError(f"{name} is {wrong:.6g}; the driver moves {self.reach}")
        return found

    @property
    def chosen(self) -> FloatArray:
        """The requested driver angles, rad, shape (N,); by default one."""
        if self.asked.at_deg:
            return self.in_range(self.asked.at_deg, "at_deg")
        low, high = self.sweep.ranges[0]
        return np.array([low if self.sweep.turns else (low + high) / 2])

    @property
    def reach(self) -> str:
        """The ranges of the driver in words."""
        ranges = (f"from {np.degrees(low):.6g} to {np.degrees(high):.6g}" for low, high in self.sweep.ranges)
        return f"{' and '.join(ranges)} deg"

    @staticmethod
    def joined(parts: list[FloatArray]) -> FloatArray:
        """Values of all ranges in sequence with a row of NaN between two, so that lines break."""
        gaps = [np.full((1, *part.shape[1:]), np.nan) for part in parts]
        rows = [piece for pair in zip(parts, gaps, strict=True) for piece in pair]
        return np.concatenate(rows[:-1])
