"""Functions of four pairs: bounds of the transmission angle of all four-bars that generate them.

Seen from link 4, link 2 moves through known poses, and the coupler is a dyad of that motion: one piece of a
curve is one coupler, and with it, as O2 = 0 and O4 = 1, the whole linkage.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np

from grashof.analysis import verify
from grashof.problems import ProblemError
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray
from grashof.problems.values.mechanisms import FOUR_BAR
from grashof.synth.proof.asked import LEAST, SLACK, Asked
from grashof.synth.proof.bounds import TOO_SMALL, Bounds, Proving
from grashof.synth.proof.branch_and_bound import MOST_LEVELS
from grashof.synth.proof.forms import Form, Span
from grashof.synth.proof.lookout import quantity_of
from grashof.synth.proof.loop import LoopLimits, lengths_allowed, transmission_bound
from grashof.synth.proof.square import nothing_left
from grashof.synth.proof.table import Pieces, Side, Table, TooMany
from grashof.synth.starts.function_aims import FunctionAims
from grashof.synth.starts.function_search import FoundFunction
from grashof.synth.theory.burmester import Displacements, Dyads, centre_points, polish
from grashof.synth.theory.function_four_bar import FourBars
from grashof.synth.theory.stopping import Stopped, give_way

FOUR = 4
MOST_PIECES = 200_000
JUDGED = 6  # of each level, those with the greatest bounds
# Fields of the requirements that have forms here, or that say nothing of a shape.
_FORMS = (
    "transmission_min_deg", "link_ratio_max", "link_length", "r1", "r2", "r3", "r4", "o2", "o4",
    "driver_sense", "ground_angle_deg",
)  # fmt: skip


def bounds_of_pairs(aims: FunctionAims, proving: Proving) -> tuple[Bounds, list[FoundFunction]] | None:
    """Bounds of the best four-bar through four pairs, and the designs that they were found by.

    None of other functions, other objectives, or with the driver angle given.
    """
    problem, ways = aims.problem, list(aims.ways())
    if problem.mechanism[0] != FOUR_BAR or not aims.exact or len(aims.task) != FOUR:
        return None
    if any(first is not None for _, _, first in ways) or set(problem.objective.goals) != {"transmission"}:
        return None
    since, lower, found = perf_counter(), 0.0, list[FoundFunction]()
    stated = problem.requirements.limited
    whole = Bounds(left_out=tuple(name for name in stated if name not in _FORMS))
    try:
        for sense, driver, _ in {sense: (sense, driver, first) for sense, driver, first in ways}.values():
            one = _Sense.of(aims, sense, driver)
            table = Table.covering(one.asked)
            begun = whole.pieces[0] + len(table)
            lower, count, levels = one.best(table, lower, float(np.radians(proving.gap)), found)
            halved = max(whole.levels, levels)
            whole = replace(whole, pieces=(begun, begun), pairs=whole.pairs + count, levels=halved)
    except TooMany:
        return replace(whole, why=TOO_SMALL), found
    except Stopped:
        return replace(whole, why="it was stopped"), found
    upper = max(lower + float(np.radians(proving.gap)) if lower else 0.0, _floor(aims))
    seconds = perf_counter() - since
    return replace(whole, lower=lower, upper=upper, closed=True, seconds=seconds), found


def _floor(aims: FunctionAims) -> float:
    return max(LEAST, float(np.radians(aims.wanted.transmission_min_deg)) - SLACK)


@dataclass(frozen=True, slots=True)
class _Sense:
    """The four-bars whose output turns in one sense."""

    aims: FunctionAims
    driver: int
    motion: Displacements
    asked: Asked
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
        asked = Asked.within(motion, ratio, 1 / ratio)
        return cls(aims, driver, motion, asked, loop, float(wanted.turned[0]))

    def best(
        self, table: Table, lower: float, gap: float, found: list[FoundFunction]
    ) -> tuple[float, int, int]:
        """The transmission angle of the best design, rad, more than which by the gap none has.

        With how many pieces were bounded, and how often they were halved.
        """
        which, count, levels = np.arange(len(table)), 0, 0
        while len(which):
            give_way()
            count += len(which)
            if count > MOST_PIECES or levels >= MOST_LEVELS:
                raise TooMany
            least = max(lower + gap if lower else 0.0, _floor(self.aims))
            rows, bound = self.rows_left(table.pieces, which, np.full(len(which), least))
            which = which[rows]
            order = np.argsort(-bound, kind="stable")[:JUDGED]
            lower = self._looked(table, which[order], lower, found)
            which = which[bound > max(lower + gap if lower else 0.0, _floor(self.aims))]
            halves = table.halve(which).ravel()
            which, levels = halves[halves >= 0], levels + 1
        return lower, count, levels

    def rows_left(self, pieces: Pieces, which: IntArray, least: FloatArray) -> tuple[IntArray, FloatArray]:
        """Which pieces may hold a linkage that transmits more than `least`, rad, and their bounds."""
        side = Side.of(pieces, which, is_driver=True)
        z, c, nothing = side.z, side.c, np.zeros(len(which))
        output = Span(c.middle - 1.0, c.s, c.t, c.rest)
        lengths = Form(nothing + 1.0, nothing, nothing, nothing), z.norm, (c - z).norm, output.norm
        areas = [
            (c - self._placed(z, complex(turn), complex(move))).cross(output)
            for turn, move in zip(self.motion.rotation, self.motion.shift, strict=True)
        ]
        bound, forms = transmission_bound(self.limits, lengths, areas, self._passed(z), least)
        allowed = lengths_allowed(self.limits, lengths) & (bound > least)
        rows = np.flatnonzero(allowed)
        rows = rows[~nothing_left([form[rows] for form in forms])]
        return rows, bound[rows]

    @staticmethod
    def _placed(z: Span, turn: complex, move: complex) -> Span:
        return Span(turn * z.middle + move, turn * z.s, turn * z.t, z.rest)

    def _passed(self, z: Span) -> tuple[BoolArray, BoolArray]:
        """Where A surely passes the ground line on the side of O4, and on the other one."""
        everywhere = np.ones(len(z.rest), dtype=bool)
        if self.aims.limits.over_cycle:
            return everywhere, everywhere
        size = np.maximum(np.abs(z.middle), 1e-300)
        reach = (np.abs(z.s) + z.rest) / size
        off = np.where(reach < 1, np.arcsin(np.minimum(reach, 1.0)), np.inf)
        first = np.angle(z.middle) - self.begun
        low, high = first + off + SLACK, first + self.aims.limits.span - off - SLACK

        def passes(angle: float) -> BoolArray:
            """Whether a whole number of turns beyond an angle lies between both."""
            with np.errstate(invalid="ignore"):
                inside: BoolArray = np.ceil((low - angle) / TURN) * TURN + angle <= high
            return inside & (off < np.inf)

        return passes(0.0), passes(np.pi)

    def _looked(self, table: Table, which: IntArray, lower: float, found: list[FoundFunction]) -> float:
        """The greatest transmission angle of designs in the middle of pieces, as judged, rad."""
        if not len(which):
            return lower
        points: ComplexArray = self.asked.curve.onto(table.pieces.tubes.middle[which])
        centres = centre_points(self.motion, points)
        dyads = polish(self.motion, Dyads(points, np.where(np.isfinite(centres), centres, 0.0)), steps=2)
        with np.errstate(invalid="ignore", divide="ignore"):
            made = FourBars.of_pivots(dyads.moving, dyads.ground).begun(self.begun)
        problem, key = self.aims.problem, quantity_of(self.aims.problem).key
        for k in range(len(which)):
            try:
                linkage = self.aims.linkage(made[k : k + 1], self.driver)
            except ProblemError:  # pivots that coincide
                continue
            verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
            value = float(verdict.transmission_min_cycle if "cycle" in key else verdict.transmission_min_task)
            if verdict.ok and value > lower:
                lower = value
                found.append(FoundFunction(made[k : k + 1], self.driver))
        return lower
