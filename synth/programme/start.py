"""A start: a linkage that nearly or fully does the task, and its discrete choices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np

from grashof.analysis import Verdict, solve_position
from grashof.problems import Cylinder, Linkage, Objective
from grashof.problems.values.arrays import ComplexArray
from grashof.synth.loop.dyad import PlacedLoop, Sizes, as_vector
from grashof.synth.programme.second_loop import SecondLoop
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened

UNSMOOTH = ("order", "same_branch")  # requirements that no smooth constraint can relax


@dataclass(frozen=True, slots=True)
class Terms:
    """The goal and the bounds of a solve, besides the requirements."""

    objective: Objective | None = field(default_factory=Objective)  # None: the user's own
    radius: float = np.inf  # limit on the change of each coordinate of the pivots
    stay: bool = False  # move no farther than the requirements make it, whatever the objective
    settled: bool = False  # the targets leave no freedom: the design is there already, or nowhere near
    # Requirements (fields), or parts ("o2.x"), that it may miss, but as little as possible; it keeps all
    # others.
    relaxed: tuple[str, ...] = ()
    # Further shares of the motion at which a quantity along it is bounded, by the key of the quantity.
    peaks_at: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    # Amounts by which the limits of each field are tightened, in the units of `Defect.miss`.
    more: Mapping[str, float] = field(default_factory=dict)
    loose: bool = False  # driver angles need not be those that the judge will find
    most_error: float = np.inf  # root mean square error up to which the objective decides
    zoned: bool = False  # the objective decides while each target is missed by no more than is allowed

    @property
    def bounded(self) -> bool:
        """Whether the error is bounded, and the objective decides."""
        return self.zoned or bool(np.isfinite(self.most_error))

    @property
    def goals(self) -> Mapping[str, float]:
        """Weights of the quantities to be improved; none where the user's own objective decides."""
        return {} if self.objective is None else self.objective.goals

    def tightened_by(self, field: str) -> float:
        """Amount by which the limits of a field are tightened."""
        return self.more.get(field, 0.0)

    def relaxes(self, *parts: str) -> bool:
        """Whether a requirement, or a part of it, may be missed."""
        return any(part in self.relaxed for part in parts)


@dataclass(frozen=True, slots=True)
class Start:
    """Where a solve begins, in the frame of the search; lengths in sizes, angles in rad.

    It fixes the discrete choices: the order of visit, the sense of the driver, assembly, which of r1 and r2
    is longer, and the positions with O2A along the ground line that the driver passes.
    """

    o2: complex
    o4: complex  # of a slider-crank the point of its slide's line that lies r3 ahead of B at the first target
    a: complex  # at the first target, as b and p
    b: complex
    p: complex
    visit: tuple[int, ...]  # targets in the order in which the driver meets them
    theta2: tuple[float, ...]  # in that order, unwrapped along the motion
    theta3: tuple[float, ...]  # in that order, each near the last
    direction: int
    assembly: int
    kind: Kind
    body_angle: float = 0.0  # from the coupler to the body, where the first pose does not fix it; else zero
    expected_error: float = 0.0  # root mean square error of a least-squares search here, limits included
    terms: Terms = field(default_factory=Terms)
    second: SecondLoop | None = None  # of a six-bar: the other fields but P are those of its first loop
    transmission: float = 0.0  # rad: the worst transmission angle that a solve begins with

    @classmethod
    def of_linkage(cls, scaled: ScaledProblem, linkage: Linkage, verdict: Verdict) -> Start:
        """A start at a linkage where the judge found it nearest to the targets, in order."""
        state = solve_position(linkage, verdict.theta2, verdict.assembly)
        visit = np.argsort(verdict.direction * verdict.theta2, kind="stable")
        two_loops = len(linkage.mechanism.loops) > 1
        o2, a, b, p = (
            complex(scaled.frame.inward(x)) for x in (linkage.o2, state.a[0], state.b[0], state.p[0])
        )
        return cls(
            o2, scaled.kind.o4_of(linkage, b, scaled.frame), a, b, p,
            visit=tuple(visit.tolist()),
            theta2=tuple(verdict.theta2[visit].tolist()),
            theta3=tuple(np.unwrap(state.theta3[visit]).tolist()),
            direction=verdict.direction,
            assembly=int(linkage.assembly),
            terms=Terms(scaled.objective),
            body_angle=float(linkage.body_angle),
            kind=scaled.kind,
            second=SecondLoop.of(linkage, scaled.frame, state.carrying[visit]) if two_loops else None,
        )  # fmt: skip

    def at(
        self,
        points: Sequence[complex],
        theta2: Sequence[float],
        theta3: Sequence[float],
        body_angle: float,
        second: SecondLoop | None = None,
    ) -> Start:
        """The start with another linkage, its angles in the order of visit."""
        o2, o4, a, b, p = (complex(point) for point in points)
        moved = replace(self, o2=o2, o4=o4, a=a, b=b, p=p, body_angle=body_angle, second=second)
        return replace(moved, theta2=tuple(theta2), theta3=tuple(theta3))

    def under(self, **terms: Any) -> Start:
        """The start under other terms, by name."""
        return replace(self, terms=replace(self.terms, **terms))

    @property
    def points(self) -> ComplexArray:
        """O2, O4, and A, B, P at the first target, shape (5,), sizes."""
        return np.array([self.o2, self.o4, self.a, self.b, self.p])

    @property
    def theta1(self) -> float:
        """Direction of the ground line, rad."""
        return float(self.kind.theta1_of(self.o2, self.o4, self.b))

    @property
    def arm(self) -> complex:
        """P in the frame of its link as u + iv."""
        if self.second is not None:
            return self.second.arm
        return (self.p - self.a) * abs(self.b - self.a) / (self.b - self.a or np.nan)

    @property
    def track(self) -> ComplexArray:
        """A, B and P at every target in the order of visit, shape (3, N), sizes."""
        _, r2, *_ = self.lengths
        e2: ComplexArray = np.exp(1j * np.array(self.theta2))
        a = np.asarray(self.o2 + r2 * e2, dtype=np.complex128)
        turned: ComplexArray = np.exp(1j * np.array(self.theta3))
        b = self.kind.b_of(self.lengths, self.o4, a, turned)
        if self.second is None:
            return np.stack([a, b, a + self.arm * turned])
        loop = PlacedLoop()
        loop.o2, loop.o4 = (as_vector(np.asarray(pivot)) for pivot in (self.o2, self.o4))
        *_, loop.r4 = self.lengths
        return np.stack([a, b, self.second.p(loop, np.array(self.theta2), a, turned, b)])

    @property
    def carrying(self) -> tuple[float, ...]:
        """Directions of P's link at the targets, in the order of visit, rad."""
        return self.theta3 if self.second is None else self.second.turned

    @property
    def lengths(self) -> tuple[float, float, float, float]:
        """r1, r2, r3, r4 in sizes; of slider kinds the offset in place of r4, and 0 for what they lack."""
        o2, o4, a, b, _ = self.points.tolist()
        return self.kind.dyad.lengths_of(o2, o4, a, b)

    @property
    def turns_fully(self) -> bool:
        """Whether the loop closes all round the turn."""
        return bool(self.kind.dyad.turns_fully(Sizes(*self.lengths)))

    @property
    def half_turns(self) -> tuple[int, int]:
        """Numbers of the half turns from the ground line in which the driver starts and ends."""
        ends = (self.theta2[0], self.theta2[-1])
        first, last = (int(np.floor((angle - self.theta1) / np.pi)) for angle in ends)
        return first, last

    @classmethod
    def of_screened(cls, linkages: Screened, index: int, objective: Objective | None) -> Start:
        """A start at entry `index` of screened linkages."""
        visit, (o2, o4, a, b, p) = linkages.visit[index], linkages.points[index].tolist()
        return cls(
            o2, o4, a, b, p,
            visit=tuple(visit.tolist()),
            theta2=tuple(linkages.theta2[index].tolist()),
            theta3=tuple(np.unwrap(np.angle(linkages.coupler[index][visit])).tolist()),
            direction=int(linkages.direction[index]),
            assembly=int(linkages.assembly[index]),
            terms=Terms(objective),
            body_angle=float(linkages.body_angle[index]),
            kind=linkages.kind,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class DrivenLinkage:
    """A linkage with the cylinder that drives it."""

    linkage: Linkage
    cylinder: Cylinder


# A linkage is already a design, with nothing left to solve.
Proposal: TypeAlias = Start | Linkage | DrivenLinkage


@dataclass(frozen=True, slots=True)
class Round:
    """The starts of one round of a search."""

    starts: Sequence[Proposal]  # the most promising first
    counts: Mapping[str, int]  # of the linkages examined
    size: int = 1  # its work, in usual rounds
    # Least squares: starts are not solved whose expected error exceeds this many times the least error found.
    prune: float = np.inf
    free: bool = False  # no limit binds: starts with the same coupler curve are the same design or cognates
    together: bool = False  # all are judged before there are enough: their order does not show the best one
    skip: int = 0  # number of the next rounds that bring nothing new
    reached: int = 0  # independent draws that led to the best of the starts, where they are counted
