"""Functions of three and four pairs: bounds of the transmission angle of all four-bars that generate them.

Seen from link 4, link 2 moves through known poses, and the coupler is a dyad of that motion: with O2 = 0 and
O4 = 1 each coupler is a complete linkage. Four pairs leave a curve of couplers, three a plane.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from time import perf_counter
from typing import cast

import numpy as np

from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import judged_linkage
from grashof.synth.proof.claims.bounds import TOO_SMALL, Bounds, Proving
from grashof.synth.proof.claims.proof import quantity_of
from grashof.synth.proof.curve.required import LEAST, SLACK
from grashof.synth.proof.curve.table import TooMany
from grashof.synth.proof.forms.forms import Form, Span
from grashof.synth.proof.forms.loop import LoopLimits, lengths_allowed, transmission_bound
from grashof.synth.proof.forms.square import nothing_left
from grashof.synth.proof.functions.couplers import CurveOfCouplers, PlaneOfCouplers
from grashof.synth.proof.poses.branch_and_bound import MOST_LEVELS
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.theory.burmester import Displacements, Dyads
from grashof.synth.theory.functions.four_bar import FourBars
from grashof.synth.theory.stopping import StopRequested, raise_if_stopped

THREE, FOUR = 3, 4
# Of the budget of pairs: a piece takes longer, and most are needed where a centre stays open.
SHARE_OF_CURVE, SHARE_OF_PLANE = 0.1, 0.6
FLOORS = 75.0, 45.0, 20.0, 5.0  # deg
SCREENED, JUDGED = 4000, 3  # linkages of each level, and the best of them
# Fields of the requirements that have forms here, or that say nothing of a shape.
_FORMS = (
    "transmission_min_deg", "link_ratio_max", "link_length", "r1", "r2", "r3", "r4", "o2", "o4",
    "driver_sense", "ground_angle_deg",
)  # fmt: skip


def bounds_of_pairs(scaled: ScaledProblem, proving: Proving, lower: float = 0.0) -> Bounds | None:
    """Bounds of the best four-bar through three or four pairs.

    `lower` is the transmission angle of a design that is known, as judged, rad; `Bounds.found` is one that
    is better. None for other tasks and objectives, or where the driver angle is given.
    """
    problem = scaled.problem
    if scaled.kind.dyad.bars < 2 or not scaled.exact or not problem.task.has_output.all():
        return None
    if len(problem.task) not in (THREE, FOUR) or problem.requirements.theta2_start_deg is not None:
        return None
    if problem.driver is not None:  # not every linkage has a cylinder within its limits
        return None
    if scaled.objective is None or set(scaled.objective.goals) != {"transmission"}:
        return None
    aims = FunctionAims.of(scaled).anywhere
    ways = list(aims.ways())
    since, stated = perf_counter(), problem.requirements.limited
    share = SHARE_OF_PLANE if len(aims.task) == THREE else SHARE_OF_CURVE
    search = _Search(scaled, aims, float(np.radians(proving.gap)), round(share * proving.most_pairs), lower)
    try:
        search.descend({sense: Sense.of(aims, sense, driver) for sense, driver, _ in ways})
        why = ""
    except TooMany as ended:
        why = str(ended)
    except StopRequested:
        why = "it was stopped"
    beyond = [name for name in stated if name not in _FORMS] + ["constraints"] * bool(scaled.constraints)
    beyond += ["at"] * bool(problem.requirements.at)
    beyond += ["function.rate"] * (problem.task.rates is not None)
    return Bounds(
        lower=search.lower,
        upper=search.upper,
        closed=not why,
        found=search.found,
        pieces=(search.begun, search.begun),
        pairs=search.count,
        levels=search.levels,
        seconds=perf_counter() - since,
        left_out=tuple(beyond),
        why=why,
    )


@dataclass(frozen=True, slots=True)
class Sense:
    """The four-bars whose output turns in one sense."""

    aims: FunctionAims
    sense: int
    driver: int
    motion: Displacements
    limits: LoopLimits
    begun: float  # driver rotation from the beginning of the range to the first pair

    @classmethod
    def of(cls, aims: FunctionAims, sense: int, driver: int) -> Sense:
        """Of one sense of the output, and of the driver."""
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
        return cls(aims, sense, driver, motion, loop, float(wanted.turned[0]))

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
            """Whether an angle plus some number of full turns lies between both."""
            with np.errstate(invalid="ignore"):
                inside: BoolArray = np.ceil((low - angle) / TURN) * TURN + angle <= high
            return inside & (off < np.inf)

        return passes(0.0), passes(np.pi)

    def linkages(self, dyads: Dyads, least: float) -> Iterator[Linkage]:
        """The best of some linkages that transmit more than `least`, rad."""
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            kind = cast("type[FourBars]", self.aims.kind)
            made = kind.of_pivots(dyads.moving, dyads.ground).begun(self.begun).finite
            transmitted = np.arccos(
                np.minimum(
                    made.worst_cosine(TURN if self.aims.limits.over_cycle else self.aims.limits.span), 1.0
                )
            )
            limits = self.aims.limits_of(self.driver, self.sense).of(made)
            kept = np.flatnonzero((transmitted > least) & (limits.value.min(axis=1) >= 0))
        for k in kept[np.argsort(-transmitted[kept], kind="stable")[:JUDGED]]:
            with suppress(ProblemError):  # pivots that coincide
                yield self.aims.linkage(made[k : k + 1], self.driver)

    @property
    def couplers(self) -> CurveOfCouplers | PlaneOfCouplers:
        """All couplers, in pieces."""
        kind = CurveOfCouplers if len(self.aims.task) == FOUR else PlaneOfCouplers
        return kind.of(self.motion, self.limits.ratio)


@dataclass(slots=True)
class _Search:
    """A branch and bound over pieces, of one sense after the other."""

    scaled: ScaledProblem
    aims: FunctionAims
    gap: float  # rad
    most: int  # budget of pieces
    lower: float = 0.0  # rad, transmission angle of a design that is known, 0 where none is
    upper: float = np.pi / 2  # rad; no design has more
    floor: float = LEAST  # rad; designs that transmit less do not count
    found: Candidate | None = None  # the design with `lower`, if it came up here
    begun: int = 0
    count: int = 0
    levels: int = 0

    @property
    def threshold(self) -> float:
        """Transmission angle that a better design has to exceed, rad."""
        return max(self.lower + self.gap if self.lower else 0.0, self.floor)

    def descend(self, senses: dict[int, Sense]) -> None:
        """Lower the floor until there is a design above it: so there is an upper bound early on."""
        least = max(LEAST, float(np.radians(self.aims.wanted.transmission_min_deg)) - SLACK)
        for floor in (*(each for each in np.radians(FLOORS).tolist() if each > least), least):
            if least < floor <= self.lower + self.gap:
                continue
            self.floor = floor
            for sense in senses.values():
                self._run(sense)
            self.upper = self.threshold
            if self.lower and self.upper > floor:
                return

    def _run(self, sense: Sense) -> None:
        """Bound all pieces, look for designs in those that are left, divide these, until none is left."""
        couplers = sense.couplers
        which, level = np.arange(len(couplers)), 0
        self.begun = max(self.begun, len(which))
        while len(which):
            raise_if_stopped()
            self.count += len(which)
            if self.count > self.most:
                raise TooMany(f"the budget of {self.most} pieces ended")
            if level >= MOST_LEVELS:
                raise TooMany(TOO_SMALL)
            rows, bound = sense.rows_left(*couplers.spans(which), self.threshold)
            which = which[rows]
            some = np.sort(which[:: max(1, -(-len(which) // SCREENED))])
            for linkage in sense.linkages(couplers.dyads(some), self.lower) if len(some) else ():
                self._judge(linkage)
            which = couplers.divided(which[bound > self.threshold])
            level += 1
            self.levels = max(self.levels, level)
        if isinstance(couplers, PlaneOfCouplers) and len(sense.rows_left(*couplers.discs, self.threshold)[0]):
            raise TooMany(TOO_SMALL)

    def _judge(self, linkage: Linkage) -> None:
        """Keep a linkage that the judge accepts and that transmits more than the best."""
        one = judged_linkage(self.scaled, linkage, start=0, iterations=0)
        value = float(one.values[quantity_of(self.scaled.problem).key])
        if one.verdict.ok and value > self.lower:
            self.lower, self.found = value, one
