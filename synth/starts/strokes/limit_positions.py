"""Swing or stroke, and time ratio: linkages in closed form, the best first, then a choice of the others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import zip_longest
from typing import TypeAlias

import numpy as np

from grashof.problems import Box, Requirements, Task
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.problems.values.region import standing
from grashof.problems.values.requirements.task_limits import stated_places
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import UNSMOOTH, Round, Start, Terms
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Configurations, Screened, judge, violations_apart
from grashof.synth.starts.finder import ROUNDS_DONE, DesignFinder
from grashof.synth.starts.strokes.rocker_kind import RockerKind
from grashof.synth.starts.strokes.shaper_kind import ShaperKind
from grashof.synth.starts.strokes.slider_kind import SliderKind
from grashof.synth.starts.strokes.stroke_kind import StrokeKind
from grashof.synth.theory.distinct import DISTINCT, pick_apart
from grashof.synth.theory.limit_positions import Family, StrokeLinkages, best_of, highest, stretches

_SPARE = 1.3  # times as many as are enough: the judge may find some alike
_SAMPLES = 400  # members of a stretch that are examined
_FIRST = 12  # as they stand by themselves, where more than lengths and pivots decides
_EACH = 5  # of each stretch, where a programme moves them
_ROUNDS = 6  # of members put anywhere, where more than lengths and pivots decides
_DRAWS = 4000  # of them in each round
_MANY = 20  # members to choose the closest from, where the families do not decide
_MISSING = 4  # of these are kept though they miss something, for a programme to move them, or to report it
_ONWARD = 3  # designs of each way to pass the limit positions from which a programme continues

# O2, O4 (n,), and A, B and theta2 in the limit positions (n, 2), in the frame.
_Positions: TypeAlias = tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray, FloatArray]

# Families, and where their members keep limits.
_Stretches: TypeAlias = list[tuple[Family, list[tuple[float, float]]]]


def stroke_kind_of(kind: Kind) -> type[StrokeKind]:
    """Places of members, for a kind of linkage."""
    return next(each for each in (RockerKind, SliderKind, ShaperKind) if isinstance(kind.dyad, each.dyad))


class LimitPositions(DesignFinder):
    """All linkages with a swing, or a stroke, and a time ratio."""

    @property
    def beginning(self) -> str:
        """The first step of the search, in words."""
        return f"computing {self.stroke_kind.what} by their limit positions"

    @property
    def exhausted(self) -> str:
        """Why a search ends after all its rounds: families are known in full, places are drawn."""
        return ROUNDS_DONE if self.elsewhere else "no others are worth listing"

    @cached_property
    def stroke_kind(self) -> StrokeKind:
        """Families and places of this kind of linkage."""
        return stroke_kind_of(self.scaled.kind)(self.task, self.wanted)

    @property
    def freedom(self) -> bool:
        """Whether limits besides those that the families keep can be kept by a programme: all but areas."""
        beyond = set(self.wanted.limited) - self.stroke_kind.kept
        return bool(beyond or self.scaled.every_constraint)

    @property
    def rounds_a_pass(self) -> int:
        """One, and some more where places decide that the families do not know of."""
        return 1 + (_ROUNDS if self.elsewhere else 0)

    @property
    def task(self) -> Task:
        """The task of the problem."""
        return self.scaled.problem.task

    @property
    def wanted(self) -> Requirements:
        """Resolved, in the problem's unit; in a region a ground pivot has one place."""
        wanted = self.scaled.problem.requirements.resolved(self.task.size, scale_free=self.task.scale_free)
        return replace(wanted, o2=standing(wanted.o2), o4=standing(wanted.o4)) if wanted.regions else wanted

    @property
    def elsewhere(self) -> bool:
        """Whether more than lengths, pivots and transmission is limited: more places are tried then."""
        return bool(self.freedom or self.wanted.keep_out)

    @cached_property
    def kinds(self) -> list[tuple[Family, bool]]:
        """The families, and whether they are mirror images of others."""
        return self.stroke_kind.families(elsewhere=self.elsewhere)

    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """First the best members and a choice of the others; then, where places decide, members anywhere."""
        if number == 0 and size == 1:
            return self._round(self._chosen(enough))
        if not self.elsewhere or number >= self.rounds_a_pass:
            return None
        return self._round(self._anywhere(enough * size, rng))

    def onward(self, designs: Sequence[Candidate], misses: Sequence[Candidate] = (), /) -> Sequence[Start]:
        """Starts at the best designs, else the nearest misses, where a programme may improve them."""
        starts, ways = list[Start](), Counter[tuple[int, complex]]()
        for each in [*designs, *misses] if self.freedom else []:
            if "exact" in {defect.requirement for defect in each.verdict.defects}:
                continue
            start = Start.of_linkage(self.scaled, each.linkage, each.verdict)
            # Stretched or folded; of a rod in a block, its side.
            bend = np.exp(1j * (start.theta3[0] - start.theta2[0]))
            way = start.assembly, complex(np.round(bend))
            starts += [start] * (ways[way] < _ONWARD)
            ways[way] += 1
        return starts

    def relaxed(self, _rng: np.random.Generator) -> list[Start]:
        """The members that miss the limits by the least amount."""
        return self._closest([(family, stretches(family)) for family, _ in self.kinds])

    def closest_to(self, required: ScaledProblem, key: str, rng: np.random.Generator) -> list[Start]:
        """Of the members that keep these limits, those that miss the additional one by least, or many."""
        if key in UNSMOOTH:
            return []
        asked = LimitPositions(required)
        starts = self._anywhere(_MANY, rng) if asked.elsewhere else []
        starts += self._chosen(_MANY)[: _FIRST if self.freedom else None] if asked.elsewhere else []
        return starts + asked._closest(self._stretches) + asked._closest(self._stretches, self)

    def _closest(self, within: _Stretches, placed: LimitPositions | None = None) -> list[Start]:
        """In each of some stretches the member that is farthest inside the limits, or least outside."""
        starts = list[Start]()
        for _, member in _best(within, self.stroke_kind.inside):
            # where these limits, or those of another problem, allow it
            starts += (placed or self)._starts(member, self.stroke_kind.factor(member))
        return starts

    def follow(self, design: Candidate) -> list[Start]:
        """The member whose proportions are nearest to those of a design."""
        linkage = design.linkage
        shape = np.abs([float(getattr(linkage, name)) for name in linkage.mechanism.sizes])

        def near(members: StrokeLinkages) -> FloatArray:
            lengths = np.abs(members.lengths)
            size = np.linalg.norm(lengths, axis=1, keepdims=True)
            off = np.linalg.norm(lengths / size - shape / np.linalg.norm(shape), axis=1)
            apart: FloatArray = -off - 10.0 * (members.assembly != float(linkage.assembly))
            return apart

        found = _best(self._stretches, near)
        nearest = max(found, key=lambda each: each[0], default=None)
        return [] if nearest is None else self._starts(nearest[1])

    def _round(self, starts: list[Start]) -> Round:
        return Round(starts, {"feasible finds": len(starts)})

    @cached_property
    def _stretches(self) -> _Stretches:
        """Where members of each family keep the limits."""
        return [(family, stretches(family, self.stroke_kind.inside)) for family, _ in self.kinds]

    def _chosen(self, enough: int) -> list[Start]:
        """The best of each stretch, then others spread over size and transmission."""
        starts, groups = [], []
        for family, within in self._stretches:
            if within:
                starts += self._starts(family(np.array(best_of(family, within))))
                shares = np.concatenate([np.linspace(low, high, _SAMPLES) for low, high in within])
                groups.append(family(shares))
        best = sorted(starts, key=lambda start: -self.stroke_kind.worst(start))
        if self.freedom:
            return best + [one for group in groups for one in self._starts(group[:: len(group) // _EACH])]
        if self.elsewhere:  # rounds of members anywhere follow
            return [one for one in best + self._spread(groups, _FIRST) if self._in_boxes(one)]
        return best + self._spread(groups, round(_SPARE * enough))

    def _spread(self, groups: list[StrokeLinkages], most: int) -> list[Start]:
        """At most `most` members: of those that no other beats in size and transmission, then of all."""
        if not groups or not most:
            return []
        factors, diagonals = [self.stroke_kind.factor(each) for each in groups], self.stroke_kind.diagonals
        size = np.concatenate([f * diagonals(each) for f, each in zip(factors, groups, strict=True)])
        angle = np.concatenate([each.transmission for each in groups])
        lengths = [f[:, None] * each.lengths for f, each in zip(factors, groups, strict=True)]
        front = _unbeaten(angle, size)
        score = np.where(front, np.pi + angle, np.where(angle > angle.max() / 2, angle, -np.inf))
        begin = np.concatenate([[0], np.cumsum([len(each) for each in groups])])
        starts = []
        for index in _apart(np.concatenate(lengths), score, most).tolist():
            k = int(np.searchsorted(begin, index, side="right")) - 1
            at = index - int(begin[k])
            starts += self._starts(groups[k][at : at + 1])
        return starts

    def _starts(self, members: StrokeLinkages, preferred: float | FloatArray = 1.0) -> list[Start]:
        """Linkages as the limits of lengths and places put them into the plane."""
        factor = self.stroke_kind.factor(members, preferred)
        points = self._inward(self.stroke_kind.put(members, factor))
        return [self._start(members[k : k + 1], points[k : k + 1]) for k in range(len(members))]

    def _anywhere(self, count: int, rng: np.random.Generator) -> list[Start]:
        """Members anywhere that keep all limits, then some others, from which a programme moves the least."""
        inside, outside = list[list[Start]](), list[Start]()
        groups = self.near(rng)
        for screened in groups:
            feasible = screened.feasible
            missed = np.where(feasible, np.inf, screened.violations.sum(axis=1))
            closest = np.argsort(missed)[: min(_MISSING // len(groups), int((~feasible).sum()))]
            within, beyond = (
                [
                    Start.of_screened(screened, k, self.scaled.objective).under(settled=True)
                    for k in rows.tolist()
                ]
                for rows in (np.flatnonzero(feasible)[:count], closest)
            )
            inside.append(within)
            outside += [start.under(stay=self.freedom) for start in beyond]
        in_turn = [start for each in zip_longest(*inside) for start in each if start is not None]
        return in_turn[:count] + outside

    def near(self, rng: np.random.Generator, /) -> list[Screened]:
        """Members of each family, and their mirror images, of random scale and place, screened."""
        return [self._screened(*self._placed(members, rng)) for members in self._drawn(rng)]

    def _placed(self, members: StrokeLinkages, rng: np.random.Generator) -> _Positions:
        """O2, O4, A and B in the limit positions (n, 2) and theta2 there, anywhere, in the frame."""
        points = self._inward(self.stroke_kind.put_anywhere(members, self._room, rng))
        o4, a, b, theta2 = self.stroke_kind.moving(members, points)
        return points[:, 0], o4, a, b, theta2

    def _inward(self, points: ComplexArray) -> ComplexArray:
        return (points - self.scaled.frame.origin) / self.scaled.frame.scale

    def _screened(
        self, o2: ComplexArray, o4: ComplexArray, a: ComplexArray, b: ComplexArray, theta2: FloatArray
    ) -> Screened:
        """Linkages in the frame screened under all requirements, from the slow stroke alone; P is A."""
        count, sense = len(o2), -1.0 if self.stroke_kind.clockwise else 1.0
        visit = np.tile(np.arange(2), (count, 1))
        found = Configurations(o2, o4, a, b, visit, theta2, np.full(count, sense), self.scaled.kind)
        wanted = self.scaled.wanted
        violations = violations_apart(found, a[:, 0], a, wanted)
        return fully_screened(self.scaled, judge(found, a[:, 0], np.zeros(count), violations, wanted))

    @property
    def _room(self) -> Box:
        """Room for an unbounded O2: about the required places."""
        wanted, boxes = self.wanted, stated_places(replace(self.wanted, o2=None))
        sides = []
        for axis, name in enumerate("xy"):
            ends = [end for box in boxes for end in getattr(box, name) if np.isfinite(end)]
            ends += [end for corners in wanted.keep_out for end in corners[:, axis].tolist()]
            ends = ends or [0.0]
            sides.append((min(ends) - self.task.size, max(ends) + self.task.size))
        return Box(*sides)

    def _drawn(self, rng: np.random.Generator) -> Iterator[StrokeLinkages]:
        """Random members, half of them mirrored."""
        plain = [not mirrored for _, mirrored in self.kinds]
        ranges = [each for each, is_plain in zip(self._stretches, plain, strict=True) if each[1] and is_plain]
        either = self.stroke_kind.mirrored
        for family, within in ranges:
            low, high = within[int(rng.integers(len(within)))]
            for mirrored in either:
                members = family(rng.uniform(low, high, _DRAWS // (len(either) * len(ranges))))
                members = members.mirrored if mirrored else members
                yield members[self.stroke_kind.inside(members) >= 0]

    def _in_boxes(self, start: Start) -> bool:
        """Whether A and B are where they may be in both limit positions."""
        return self.stroke_kind.in_boxes(*map(self.scaled.frame.outward, start.track[:2]))

    def _start(self, member: StrokeLinkages, points: ComplexArray) -> Start:
        """One member, (1,), where two points of the frame, (1, 2), put it; P is A, as it may be anything."""
        o4, a, b, theta2 = (each[0] for each in self.stroke_kind.moving(member, points))
        return Start(
            o2=complex(points[0, 0]),
            o4=complex(o4),
            a=complex(a[0]),
            b=complex(b[0]),
            p=complex(a[0]),
            visit=(0, 1),
            theta2=(float(theta2[0]), float(theta2[1])),
            theta3=tuple(np.unwrap(np.angle(b - a)).tolist()),
            direction=-1 if self.stroke_kind.clockwise else 1,
            assembly=int(member.assembly[0]),
            terms=Terms(self.scaled.objective, settled=True),
            kind=self.scaled.kind,
        )


def _best(
    within: _Stretches, value: Callable[[StrokeLinkages], FloatArray]
) -> Iterator[tuple[float, StrokeLinkages]]:
    """The member, (1,), of the greatest value in each of some stretches, with that value."""
    for family, ranges in within:

        def of_share(share: FloatArray, family: Family = family) -> FloatArray:
            return value(family(share))

        for low, high in ranges:
            shares = np.linspace(low, high, _SAMPLES)
            k = int(np.argmax(of_share(shares)))
            before, behind = float(shares[max(k - 1, 0)]), float(shares[min(k + 1, _SAMPLES - 1)])
            tried = np.array([shares[k], highest(of_share, before, behind)])
            values = of_share(tried)
            best = int(np.argmax(values))
            yield float(values[best]), family(tried[[best]])


def _unbeaten(angle: FloatArray, size: FloatArray) -> BoolArray:
    """Which linkages (n,) no other one beats in transmission and size."""
    order = np.lexsort((size, -angle))
    least = np.minimum.accumulate(size[order])
    best = np.zeros(len(angle), dtype=bool)
    best[order] = size[order] <= least
    return best


def _apart(lengths: FloatArray, score: FloatArray, most: int) -> IntArray:
    """Indices of at most `most` lengths (n, 4), as far apart as possible, best first."""
    worth = np.flatnonzero(np.isfinite(score))  # without those of score -inf
    signatures = np.concatenate([lengths[worth], np.zeros((len(worth), 5))], axis=1)
    for least in (0.1, 0.05, 0.025, DISTINCT):
        picked = pick_apart(signatures, score[worth], least, most)
        if len(picked) >= most:
            break
    return worth[picked]
