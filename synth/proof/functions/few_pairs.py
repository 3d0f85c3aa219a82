"""Functions of three and four pairs: bounds of the transmission angle of all four-bars that generate them.

Seen from link 4, link 2 moves through known poses, and the coupler is a dyad of that motion: with O2 = 0 and
O4 = 1 each coupler is a whole linkage. Four pairs leave a curve of couplers, three a plane.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np

from grashof.analysis import verify
from grashof.problems import ProblemError
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray
from grashof.problems.values.mechanisms import FOUR_BAR
from grashof.synth.proof.curve.asked import LEAST, SLACK, Asked
from grashof.synth.proof.curve.patches import Patches
from grashof.synth.proof.curve.poles import poles
from grashof.synth.proof.curve.table import Side, Table, TooMany
from grashof.synth.proof.forms.forms import Form, Span
from grashof.synth.proof.forms.loop import LoopLimits, lengths_allowed, transmission_bound
from grashof.synth.proof.forms.square import nothing_left
from grashof.synth.proof.poses.bounds import TOO_SMALL, Bounds, Proving
from grashof.synth.proof.poses.branch_and_bound import MOST_LEVELS
from grashof.synth.proof.poses.lookout import quantity_of
from grashof.synth.starts.function_aims import FunctionAims
from grashof.synth.starts.function_search import FoundFunction
from grashof.synth.theory.burmester import Displacements, Dyads, centre_points, polish
from grashof.synth.theory.function_four_bar import FourBars
from grashof.synth.theory.stopping import Stopped, give_way

THREE, FOUR = 3, 4
# Of the budget of pairs: a piece takes longer, and most are needed where a centre stays open.
SHARE_OF_CURVE, SHARE_OF_PLANE = 0.1, 0.4
ABOUT = 1e-3  # of r1: so near a pole A is left to B; where B is so near one, too, both are in small discs
JUDGED = 6  # of each level, those with the greatest bounds
# Fields of the requirements that have forms here, or that say nothing of a shape.
_FORMS = (
    "transmission_min_deg", "link_ratio_max", "link_length", "r1", "r2", "r3", "r4", "o2", "o4",
    "driver_sense", "ground_angle_deg",
)  # fmt: skip


def bounds_of_pairs(
    aims: FunctionAims, proving: Proving, lower: float = 0.0
) -> tuple[Bounds, list[FoundFunction]] | None:
    """Bounds of the best four-bar through three or four pairs, and designs better than a given one.

    `lower` is the transmission angle of a design that is known, as judged, rad. None of other functions,
    of other objectives, or where the driver angle is given.
    """
    problem, ways = aims.problem, list(aims.ways())
    if problem.mechanism[0] != FOUR_BAR or not aims.exact or len(aims.task) not in (THREE, FOUR):
        return None
    if any(first is not None for _, _, first in ways) or set(problem.objective.goals) != {"transmission"}:
        return None
    since, found, stated = perf_counter(), list[FoundFunction](), problem.requirements.limited
    whole = Bounds(left_out=tuple(name for name in stated if name not in _FORMS))
    share = SHARE_OF_PLANE if len(aims.task) == THREE else SHARE_OF_CURVE
    most = round(share * proving.most_pairs)
    search = _Search(aims, float(np.radians(proving.gap)), most, found, lower)
    try:
        for sense, driver, _ in {sense: (sense, driver, first) for sense, driver, first in ways}.values():
            search.run(_Sense.of(aims, sense, driver))
    except TooMany:
        whole = replace(whole, why=TOO_SMALL)
    except Stopped:
        whole = replace(whole, why="it was stopped")
    if search.over_budget:
        whole = replace(whole, why=f"the budget of {most} pieces ended")
    closed = not whole.why
    made = replace(
        whole,
        lower=search.lower,
        upper=search.threshold if closed else float(np.pi / 2),
        closed=closed,
        pieces=(search.begun, search.begun),
        pairs=search.count,
        levels=search.levels,
        seconds=perf_counter() - since,
    )
    return made, found


@dataclass(frozen=True, slots=True)
class _Sense:
    """The four-bars whose output turns in one sense."""

    aims: FunctionAims
    driver: int
    motion: Displacements
    limits: LoopLimits
    begun: float  # driver rotation from the beginning of the range to the first pair

    @classmethod
    def of(cls, aims: FunctionAims, sense: int, driver: int) -> _Sense:
        wanted, limits = aims.pairs(sense), aims.limits
        turned, output = wanted.turned - wanted.turned[0], wanted.output - wanted.output[0]
        motion = Displacements(np.exp(1j * (turned - output)), 1.0 - np.exp(-1j * output))
        ratio = float(np.exp(limits.caps.max())) * (1 + SLACK)
        turns = limits.margin is not None or limits.over_cycle
        loop = LoopLimits(
            lengths=((0.0, np.inf),) * 4,
            ratio=ratio,
            turns=turns,
            margin=(limits.margin or 0.0) - SLACK,
            longer_ground=(limits.shortest,) if limits.shortest else (1, -1),
            one_branch=True,
        )
        return cls(aims, driver, motion, loop, float(wanted.turned[0]))

    @property
    def asked(self) -> Asked:
        """What is asked of couplers alone."""
        return Asked.within(self.motion, self.limits.ratio, 1 / self.limits.ratio)

    def rows_left(self, z: Span, c: Span, least: float) -> tuple[IntArray, FloatArray]:
        """Which pieces may hold a linkage that transmits more than `least`, rad, and their bounds."""
        nothing = np.zeros(len(z.rest))
        output, ground = c.placed(1.0, -1.0), Form(nothing + 1.0, np.zeros(z.steps.shape), nothing)
        lengths = ground, z.norm, (c - z).norm, output.norm
        pairs = zip(self.motion.rotation, self.motion.shift, strict=True)
        arms = [(c - z.placed(complex(turn), complex(move)), output) for turn, move in pairs]
        bound, forms = transmission_bound(self.limits, lengths, arms, self._passed(z), nothing + least)
        allowed = lengths_allowed(self.limits, lengths) & (bound > least)
        rows = np.flatnonzero(allowed)
        rows = rows[~nothing_left([form[rows] for form in forms])]
        return rows, bound[rows]

    def _passed(self, z: Span) -> tuple[BoolArray, BoolArray]:
        """Where A surely passes the ground line on the side of O4, and on the other one."""
        everywhere = np.ones(len(z.rest), dtype=bool)
        if self.aims.limits.over_cycle:
            return everywhere, everywhere
        size = np.maximum(np.abs(z.middle), 1e-300)
        reach = z.reach / size
        off = np.where(reach < 1, np.arcsin(np.minimum(reach, 1.0)), np.inf)
        first = np.angle(z.middle) - self.begun
        low, high = first + off + SLACK, first + self.aims.limits.span - off - SLACK

        def passes(angle: float) -> BoolArray:
            """Whether a whole number of turns beyond an angle lies between both."""
            with np.errstate(invalid="ignore"):
                inside: BoolArray = np.ceil((low - angle) / TURN) * TURN + angle <= high
            return inside & (off < np.inf)

        return passes(0.0), passes(np.pi)

    def designs(self, dyads: Dyads) -> Iterator[tuple[FoundFunction, float]]:
        """Those of some linkages that the judge accepts, with their transmission angles, rad."""
        with np.errstate(invalid="ignore", divide="ignore"):
            made = FourBars.of_pivots(dyads.moving, dyads.ground).begun(self.begun)
        problem, key = self.aims.problem, quantity_of(self.aims.problem).key
        for k in range(len(dyads)):
            try:
                linkage = self.aims.linkage(made[k : k + 1], self.driver)
            except ProblemError:  # pivots that coincide
                continue
            verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
            if verdict.ok:
                yield FoundFunction(made[k : k + 1], self.driver), float(getattr(verdict, key))

    @property
    def couplers(self) -> _Curve | _Plane:
        """All couplers, in pieces."""
        return _Curve.of(self) if len(self.aims.task) == FOUR else _Plane.of(self)


@dataclass(slots=True)
class _Search:
    """A branch and bound over pieces, of one sense after the other."""

    aims: FunctionAims
    gap: float
    most: int
    found: list[FoundFunction]
    lower: float = 0.0
    begun: int = 0
    count: int = 0
    levels: int = 0
    over_budget: bool = False

    @property
    def threshold(self) -> float:
        """Designs that transmit less do not count, rad."""
        floor = max(LEAST, float(np.radians(self.aims.wanted.transmission_min_deg)) - SLACK)
        return max(self.lower + self.gap if self.lower else 0.0, floor)

    def run(self, sense: _Sense) -> None:
        """Bound all pieces, look for designs in those that are left, divide these, until none is left."""
        couplers = sense.couplers
        which, level = np.arange(len(couplers)), 0
        self.begun += len(which)
        while len(which):
            give_way()
            self.count += len(which)
            if self.count > self.most:
                self.over_budget = True
                return
            if level >= MOST_LEVELS:
                raise TooMany
            rows, bound = sense.rows_left(*couplers.spans(which), self.threshold)
            which = which[rows]
            best = which[np.argsort(-bound, kind="stable")[:JUDGED]]
            for one, value in sense.designs(couplers.dyads(best)) if len(best) else ():
                if value > self.lower:
                    self.lower = value
                    self.found.append(one)
            which = couplers.divided(which[bound > self.threshold])
            level += 1
            self.levels = max(self.levels, level)
        if isinstance(couplers, _Plane) and len(sense.rows_left(*couplers.discs, self.threshold)[0]):
            raise TooMany


@dataclass(slots=True)
class _Curve:
    """Couplers of four pairs: pieces of a curve."""

    table: Table

    @classmethod
    def of(cls, sense: _Sense) -> _Curve:
        return cls(Table.covering(sense.asked))

    def __len__(self) -> int:
        return len(self.table)

    def spans(self, which: IntArray) -> tuple[Span, Span]:
        """A and B as forms."""
        side = Side.of(self.table.pieces, which, is_driver=True)
        return side.z, side.c

    def divided(self, which: IntArray) -> IntArray:
        """Halves."""
        halves = self.table.halve(which).ravel()
        return halves[halves >= 0]

    def dyads(self, which: IntArray) -> Dyads:
        """Those in the middle."""
        motion = self.table.asked.curve
        points: ComplexArray = motion.onto(self.table.pieces.tubes.middle[which])
        return _dyads_at(Displacements(motion.rotation, motion.shift), points)


@dataclass(slots=True)
class _Plane:
    """Couplers of three pairs: squares of the plane, of A but near poles, and of B with A near a pole.

    With A at a pole of two pairs B is anywhere on a line; seen from there, B decides where A is.

    Parameters
    ----------
    of_a, of_b : Patches
    poles, others : ndarray of complex
        Of A, and of B.
    """

    of_a: Patches
    of_b: Patches
    poles: ComplexArray
    others: ComplexArray

    @classmethod
    def of(cls, sense: _Sense) -> _Plane:
        motion, reach = sense.motion, sense.limits.ratio
        back = motion.inverse()
        of_a, of_b = Patches.covering(motion, reach, reach), Patches.covering(back, 1 + reach, reach)
        return cls(of_a, of_b, poles(motion)[1], poles(back)[1])._cut()

    def _cut(self) -> _Plane:
        """Without squares of A about poles, without those of B that have no A there."""
        of_a = self.of_a[self.of_a.bounded & ~self.of_a.within(self.poles, ABOUT)]
        of_b = self.of_b[self.of_b.bounded & ~self.of_b.within(self.others, ABOUT)]
        places = of_b.spans[1]
        near = np.abs(places.middle[:, None] - self.poles).min(axis=1, initial=np.inf)
        of_b = of_b[near - places.reach <= ABOUT]
        return _Plane(of_a, of_b, self.poles, self.others)

    def __len__(self) -> int:
        return len(self.of_a) + len(self.of_b)

    def _parts(self, which: IntArray) -> tuple[Patches, Patches]:
        mine = which < len(self.of_a)
        return self.of_a[which[mine]], self.of_b[which[~mine] - len(self.of_a)]

    def spans(self, which: IntArray) -> tuple[Span, Span]:
        """A and B as forms; `which` in rising order."""
        of_a, of_b = self._parts(which)
        (a, b), (other_b, other_a) = of_a.spans, of_b.spans
        return Span.joined(a, other_a), Span.joined(b, other_b)

    @property
    def discs(self) -> tuple[Span, Span]:
        """A and B each about one of its poles: what no square holds."""
        a, b = (each.ravel() for each in np.meshgrid(self.poles, self.others))
        nothing, rest = np.zeros((2, len(a)), dtype=np.complex128), np.full(len(a), ABOUT)
        return Span(a, nothing, rest), Span(b, nothing, rest)

    def divided(self, which: IntArray) -> IntArray:
        """Quarters, which take the place of all squares."""
        of_a, of_b = (part.quarters for part in self._parts(which))
        made = _Plane(of_a, of_b, self.poles, self.others)._cut()
        self.of_a, self.of_b = made.of_a, made.of_b
        return np.arange(len(self))

    def dyads(self, which: IntArray) -> Dyads:
        """Those in the middle."""
        of_a, of_b = self._parts(np.sort(which))
        mine = _dyads_at(of_a.motion, of_a.middle)
        others = _dyads_at(of_b.motion, of_b.middle)
        return Dyads(
            np.concatenate([mine.moving, others.ground]), np.concatenate([mine.ground, others.moving])
        )


def _dyads_at(motion: Displacements, points: ComplexArray) -> Dyads:
    centres = centre_points(motion, points)
    return polish(motion, Dyads(points, np.where(np.isfinite(centres), centres, 0.0)), steps=2)
