"""Limit positions: all linkages with them in closed form, the best first, then a choice of the others.

Crank-rockers with a swing and a time ratio here; slider-cranks with a stroke: `slide_limits`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import ClassVar, TypeAlias

import numpy as np

from grashof.problems import Box, FourBar, Requirements, Rotatability, StrokeTask
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.programme.kind import Lengths
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import Configurations, Screened, judge, violations_apart
from grashof.synth.programme.start import Round, Start
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.starts.member_choice import apart, diagonals, unbeaten
from grashof.synth.starts.placing import Ground, scales
from grashof.synth.theory.closure import coupler_of
from grashof.synth.theory.limit_positions import (
    Family,
    Members,
    best_of,
    families_of,
    highest,
    stretches,
)

_SPARE = 1.3  # times as many as are enough: the judge may find some alike
_SAMPLES = 400  # members of a stretch that are looked at
_FIRST = 12  # as they stand by themselves, where more than lengths and pivots decides
_ROUNDS = 6  # of members put anywhere, where more than lengths and pivots decides
_DRAWS = 4000  # of them in each round
_MANY = 20  # members to choose the closest from, where the families do not tell
_MISSING = 4  # of these are kept though they miss something, to tell what it is
# Fields that the families themselves keep.
_KEPT = (
    "transmission_min_deg", "link_length", "r1", "r2", "r3", "r4", "link_ratio_max", "o2", "o4",
    "ground_angle_deg", "theta2_start_deg", "driver_sense", "output_swing_deg", "time_ratio", "coupler_arms",
)  # fmt: skip

# O2, O4 (n,) as `Configurations` have them, and A, B and theta2 in the limit positions (n, 2), in the frame.
Places: TypeAlias = tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray, FloatArray]

# Families, whether mirrored, and where their members keep limits.
_Stretches: TypeAlias = list[tuple[Family, bool, list[tuple[float, float]]]]


@dataclass(frozen=True)
class LimitPositions:
    """All crank-rockers with a swing and a time ratio: nothing is left to solve."""

    scaled: ScaledProblem

    beginning: ClassVar[str] = "computing crank-rockers by their limit positions"
    freedom: ClassVar[bool] = False
    cognates: ClassVar[bool] = False
    patience: ClassVar[float] = np.inf
    exhausted: ClassVar[str] = "no others are worth listing"

    mechanism: ClassVar[str] = FourBar.MECHANISM
    kept: ClassVar[tuple[str, ...]] = _KEPT  # limits that the families themselves keep

    @classmethod
    def suits(cls, scaled: ScaledProblem) -> bool:
        """Limit positions are asked for, of this kind of linkage."""
        return isinstance(scaled.problem.task, StrokeTask) and scaled.kind.mechanism == cls.mechanism

    @property
    def rounds_a_pass(self) -> int:
        """One, and some more where places decide that the families do not know of."""
        return 1 + (_ROUNDS if self.elsewhere else 0)

    def refuse(self) -> None:
        """What cannot be is refused where the problem is stated."""

    def degenerate(self) -> str:
        """No swing is without a linkage."""
        return ""

    @property
    def task(self) -> StrokeTask:
        """What is asked."""
        task = self.scaled.problem.task
        if not isinstance(task, StrokeTask):
            raise TypeError("only a swing has limit positions")
        return task

    @property
    def wanted(self) -> Requirements:
        """Resolved, in the problem's unit."""
        return self.scaled.problem.requirements.resolved(self.task.size, scale_free=self.task.scale_free)

    @property
    def elsewhere(self) -> bool:
        """Whether anything is asked besides lengths, pivots and transmission: more places are tried then."""
        beyond = set(self.wanted.limited) - set(self.kept)
        return bool(beyond or self.scaled.constraints or self.wanted.keep_out)

    @cached_property
    def kinds(self) -> list[tuple[Family, bool]]:
        """The families, as they are, and mirrored where that differs."""
        families = families_of(self.task.swing, self.task.time_ratio)
        either = (False, True) if self.handed else (False,)
        return [(family, mirrored) for family in families for mirrored in either]

    @property
    def handed(self) -> bool:
        """Whether a mirror image is another linkage to the limits: where the start angle is given."""
        return self.wanted.theta2_start_deg is not None

    @property
    def fixed_angle(self) -> float | None:
        """Direction of the ground line that is asked for, deg."""
        return self.wanted.ground_angle_deg

    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """First the best members and a choice of the others; then, where places decide, members anywhere."""
        if number == 0 and size == 1:
            return self._round(self._chosen(enough))
        if not self.elsewhere or number >= self.rounds_a_pass:
            return None
        return self._round(self._anywhere(enough * size, rng))

    def near(self, rng: np.random.Generator) -> Screened:
        """Those of `relaxed`, screened."""
        starts = self.relaxed(rng)
        points = np.array([start.points for start in starts])
        track = np.array([start.track for start in starts])
        theta2 = np.array([start.theta2 for start in starts])
        return self._screened(points[:, 0], points[:, 1], track[:, 0], track[:, 1], theta2)

    def relaxed(self, _rng: np.random.Generator) -> list[Start]:
        """The members that miss the limits by least."""
        return self._closest([(family, mirrored, stretches(family)) for family, mirrored in self.kinds])

    def closest_to(self, asked: LimitPositions, rng: np.random.Generator) -> list[Start]:
        """Of the members that keep these limits, those that miss by least what else is asked, or many."""
        starts = list[Start]()
        if asked.elsewhere:
            starts += self._chosen(_MANY) + self._anywhere(_MANY, rng)
        return starts + asked._closest(self._stretches) + asked._closest(self._stretches, self)

    def _closest(self, within: _Stretches, placed: LimitPositions | None = None) -> list[Start]:
        """In each of some stretches the member that is farthest inside the limits, or least outside.

        It is put where these limits, or those of another problem, allow it.
        """
        starts = list[Start]()
        for family, mirrored, ranges in within:

            def inside(share: FloatArray, family: Family = family, mirrored: bool = mirrored) -> FloatArray:
                return self._inside(family(share), mirrored)

            for low, high in ranges:
                shares = np.linspace(low, high, _SAMPLES)
                k = int(np.argmax(inside(shares)))
                between = highest(
                    inside, float(shares[max(k - 1, 0)]), float(shares[min(k + 1, _SAMPLES - 1)])
                )
                tried = np.array([shares[k], between])
                member = family(tried[[np.argmax(inside(tried))]])
                starts += (placed or self)._starts(member, mirrored, self._factor(member, mirrored))
        return starts

    def obstacle(self, _rng: np.random.Generator, _counts: Mapping[str, int], /) -> str:
        """Nothing but limits."""
        return ""

    def _round(self, starts: list[Start]) -> Round:
        return Round(starts, {"feasible finds": len(starts)})

    def _inside(self, members: Members, mirrored: bool) -> FloatArray:
        """How far members are inside the limits of lengths, pivots and transmission, (n,)."""
        members, wanted = self._taken(members, mirrored), self.wanted
        lengths = self._links(members).T
        most = min(max(wanted.link_ratio_max, 1.0), 1e9)
        inside = [
            members.transmission - np.radians(wanted.transmission_min_deg),
            np.log(most) - np.log(lengths.max(axis=0) / lengths.min(axis=0)),
            self._turns(members)
            - (0.0 if wanted.rotatability is Rotatability.ANY else wanted.rotatability_margin),
            self._fit(members),
        ]
        if self.fixed_angle is not None and wanted.theta2_start_deg is not None:
            apart = np.exp(1j * (self._ground_angle(members) - np.radians(self.fixed_angle)))
            inside.append(-np.abs(np.angle(apart)))
        margin: FloatArray = np.min(inside, axis=0)
        return margin

    def _taken(self, members: Members, mirrored: bool) -> Members:
        """Members, or their mirror images."""
        return members.mirrored if mirrored else members

    def _links(self, members: Members) -> FloatArray:
        """Lengths of the links, (n, k)."""
        return members.lengths

    def _turns(self, members: Members) -> FloatArray:
        """By how much the driver turns fully, as a share of all lengths, (n,)."""
        r1, r2, r3, r4 = members.lengths.T
        room = np.minimum(r3 + r4 - r1 - r2, r1 - r2 - np.abs(r3 - r4))
        share: FloatArray = room / members.lengths.T.sum(axis=0)
        return share

    def _fit(self, members: Members) -> FloatArray:
        """How far members are inside the limits of lengths and pivots, in logarithms, (n,)."""
        low, high = self._scales(members)
        fit: FloatArray = np.log(high / low)
        return fit

    def _scales(self, members: Members) -> FloatArray:
        """Least and greatest factor of members, (2, n)."""
        ground = Ground.of(self.wanted).lengths(self._ground_angle(members))
        return scales(members.lengths, self.wanted.link_lengths, ground)

    def _ground_angle(self, members: Members) -> FloatArray:
        """Direction of the ground line that the limits fix, rad; NaN where they do not; shape (n,)."""
        start, fixed = self.wanted.theta2_start_deg, self.fixed_angle
        if start is not None:
            turned: FloatArray = np.radians(start) - (members.last if self._clockwise else members.first)
            return turned
        angle = np.nan if fixed is None else float(np.radians(fixed))
        return np.full(len(members.share), angle)

    @property
    def _clockwise(self) -> bool:
        return self.wanted.driver_sense == "cw"

    @cached_property
    def _stretches(self) -> _Stretches:
        """Where members of each family keep the limits."""
        return [
            (
                family,
                mirrored,
                stretches(family, partial(self._inside, mirrored=mirrored)),
            )
            for family, mirrored in self.kinds
        ]

    def _chosen(self, enough: int) -> list[Start]:
        """The best of each stretch, then others spread over size and transmission."""
        starts, groups = [], []
        for family, mirrored, within in self._stretches:
            if within:
                members = family(np.array(best_of(family, within)))
                starts += self._starts(members, mirrored)
                shares = np.concatenate([np.linspace(low, high, _SAMPLES) for low, high in within])
                groups.append((family(shares), mirrored))
        best = sorted(starts, key=lambda start: -_worst(start))
        if self.elsewhere:  # rounds of members anywhere follow
            return [one for one in best + self._spread(groups, _FIRST) if self._in_boxes(one)]
        return best + self._spread(groups, round(_SPARE * enough))

    def _spread(self, groups: list[tuple[Members, bool]], most: int) -> list[Start]:
        """So many members at most: of those that no other beats in size and transmission, then of all."""
        if not groups or not most:
            return []
        factor = [self._factor(*group) for group in groups]
        size = np.concatenate(
            [f * self._diagonals(found) for f, (found, _) in zip(factor, groups, strict=True)]
        )
        angle = np.concatenate([found.transmission for found, _ in groups])
        lengths = [f[:, None] * found.lengths for f, (found, _) in zip(factor, groups, strict=True)]
        front = unbeaten(angle, size)
        merit = np.where(front, np.pi + angle, np.where(angle > angle.max() / 2, angle, -np.inf))
        picked = apart(np.concatenate(lengths), merit, most)
        number = np.concatenate([np.full(len(found.share), k) for k, (found, _) in enumerate(groups)])
        begin = np.concatenate([[0], np.cumsum([len(found.share) for found, _ in groups])])
        starts = []
        for index in picked.tolist():
            found, mirrored = groups[k := int(number[index])]
            at = index - int(begin[k])
            starts += self._starts(found[at : at + 1], mirrored)
        return starts

    def _factor(self, members: Members, mirrored: bool, wish: float | FloatArray = 1.0) -> FloatArray:
        """By which members are scaled: as wished where that is allowed, or else what is nearest to it."""
        low, high = self._scales(self._taken(members, mirrored))
        factor: FloatArray = np.minimum(np.maximum(wish, low), high)
        return factor

    def _starts(self, members: Members, mirrored: bool, wish: float | FloatArray = 1.0) -> list[Start]:
        """Members as the limits of lengths and pivots put them into the plane."""
        factor = self._factor(members, mirrored, wish)
        members = self._taken(members, mirrored)
        ground = Ground.of(self.wanted)
        starts = []
        for k, angle in enumerate(self._ground_angle(members).tolist()):
            size = float(factor[k])
            towards = ground.direction(size, 0.0) if np.isnan(angle) else angle
            starts.append(self._start(members[k], *ground.pivots(size, towards)))
        return starts

    def _anywhere(self, count: int, rng: np.random.Generator) -> list[Start]:
        """Members of random scale, place and handedness: those that keep all limits, then some others."""
        places = [self._placed(members, rng) for members in self._drawn(rng)]
        if not places:
            return []
        screened = self._screened(*map(np.concatenate, zip(*places, strict=True)))
        feasible = screened.feasible
        missed = np.where(feasible, np.inf, screened.violations.sum(axis=1))
        chosen = [
            *np.flatnonzero(feasible)[:count],
            *np.argsort(missed)[: min(_MISSING, int((~feasible).sum()))],
        ]
        starts = [Start.of_screened(screened, int(k), self.scaled.objective) for k in chosen]
        return [replace(start, settled=True) for start in starts]

    def _diagonals(self, members: Members) -> FloatArray:
        """Of a box around each, (n,)."""
        return diagonals(members)

    def _placed(self, members: Members, rng: np.random.Generator) -> Places:
        """O2, the other end of what scales them, A, B (n, 2) and theta2 there, anywhere, in the frame."""
        ground, size, room = Ground.of(self.wanted), self.task.size, self._room
        low, high = self._scales(members)
        low, high = np.maximum(low, np.minimum(size / 30, high)), np.minimum(high, np.maximum(30 * size, low))
        sizes = np.exp(rng.uniform(np.log(low), np.log(np.maximum(high, low))))
        wish, fixed = rng.uniform(-np.pi, np.pi, len(sizes)), self._ground_angle(members)
        share = rng.uniform(0, 1, (len(sizes), 2))
        pivots = []
        for k, angle in enumerate(fixed.tolist()):
            towards = ground.direction(float(sizes[k]), float(wish[k])) if np.isnan(angle) else angle
            pivots.append(ground.pivots(float(sizes[k]), towards, share[k], room))
        at = (
            np.array(pivots, dtype=np.complex128).reshape(-1, 2) - self.scaled.frame.origin
        ) / self.scaled.frame.scale
        return self._moving(members, at)

    def _moving(self, members: Members, at: ComplexArray) -> Places:
        """Members in the limit positions, from O2 and the other end of what scales them, (n, 2): O4."""
        o2, o4 = at.T[..., None]
        _, r2, r3, r4 = members.lengths.T[..., None] * np.abs(o4 - o2)
        theta2 = self._ends(members) + np.angle(o4 - o2)
        a = o2 + r2 * np.exp(1j * theta2)
        b = a + coupler_of(o4 - a, r3, r4, members.assembly[:, None])
        return o2[:, 0], o4[:, 0], a, b, theta2

    def _ends(self, members: Members) -> FloatArray:
        """Driver angles of the slow stroke from the ground line, (n, 2), rad."""
        ends = (members.last, members.first) if self._clockwise else (members.first, members.last)
        return np.stack(ends, axis=-1)

    def _screened(
        self, o2: ComplexArray, o4: ComplexArray, a: ComplexArray, b: ComplexArray, theta2: FloatArray
    ) -> Screened:
        """Linkages in the frame screened under all requirements, from the slow stroke alone; P is A."""
        count, sense = len(o2), -1.0 if self._clockwise else 1.0
        visit = np.tile(np.arange(2), (count, 1))
        found = Configurations(o2, o4, a, b, visit, theta2, np.full(count, sense), self.scaled.kind)
        wanted = self.scaled.wanted
        violations = violations_apart(found, a[:, 0], a, wanted)
        return fully_screened(self.scaled, judge(found, a[:, 0], np.zeros(count), violations, wanted))

    @property
    def _room(self) -> Box:
        """Where O2 is put that may be anywhere: about the places that are asked for."""
        wanted = self.wanted
        boxes = [box for box in (wanted.a, wanted.b, wanted.o4) if box is not None]
        sides = []
        for axis, name in enumerate("xy"):
            ends = [end for box in boxes for end in getattr(box, name) if np.isfinite(end)]
            ends += [end for corners in wanted.keep_out for end in corners[:, axis].tolist()]
            ends = ends or [0.0]
            sides.append((min(ends) - self.task.size, max(ends) + self.task.size))
        return Box(*sides)

    def _drawn(self, rng: np.random.Generator) -> Iterator[Members]:
        """Random members, half of them mirrored."""
        ranges = [(family, within) for family, mirrored, within in self._stretches if within and not mirrored]
        for family, within in ranges:
            low, high = within[int(rng.integers(len(within)))]
            for mirrored in (False, True):
                members = family(rng.uniform(low, high, _DRAWS // (2 * len(ranges))))
                inside = self._inside(members, mirrored) >= 0
                yield self._taken(members, mirrored)[inside]

    def _in_boxes(self, start: Start) -> bool:
        """Whether A and B are where they may be in both limit positions."""
        frame = self.scaled.frame
        for box, track in zip((self.wanted.a, self.wanted.b), start.track[:2], strict=True):
            if box is not None:
                x, y = frame.outward(track).T
                if x.min() < box.x[0] or x.max() > box.x[1] or y.min() < box.y[0] or y.max() > box.y[1]:
                    return False
        return True

    def _start(self, member: Members, *ends: complex) -> Start:
        """One member, or its mirror image, at given places; P is A, as nothing is asked of it."""
        at = (np.array([ends]) - self.scaled.frame.origin) / self.scaled.frame.scale
        o2, o4, a, b, theta2 = (each[0] for each in self._moving(member[None], at))
        return Start(
            o2=complex(o2),
            o4=complex(o4),
            a=complex(a[0]),
            b=complex(b[0]),
            p=complex(a[0]),
            visit=(0, 1),
            theta2=(float(theta2[0]), float(theta2[1])),
            theta3=tuple(np.unwrap(np.angle(b - a)).tolist()),
            direction=-1 if self._clockwise else 1,
            assembly=int(member.assembly),
            objective=self.scaled.objective,
            settled=True,
            kind=self.scaled.kind,
        )


def _worst(start: Start) -> float:
    """Of the transmission angle over the turn, by the sizes of a start."""
    kind, lengths = start.kind, Lengths(*start.lengths)
    cosines = [kind.cos_mu(lengths, reach(lengths)) for reach in (kind.folded, kind.stretched)]
    return float(np.arccos(min(max(map(abs, cosines)), 1.0)))
