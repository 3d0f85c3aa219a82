"""One attempt: a solve from one start, polished and judged. Runs in any process."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from grashof.problems import Linkage
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.designs.alike import verified_alike
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import MISSED, Steps, ToJudge, in_step, made_linkage, shares
from grashof.synth.designs.polishing import polished_solve, polished_start
from grashof.synth.designs.ranking import ranking_key
from grashof.synth.programme.nonlinear_programme import SOLVED, Solve, begun_from, solve_by_exchange
from grashof.synth.programme.start import UNSMOOTH, DrivenLinkage, Proposal, Start
from grashof.synth.programme.structure import held_nearest
from grashof.synth.quantities.formulas import FORMULAS
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.finder import finder_for
from grashof.synth.theory.stopping import overdue, stop_requested

LEFT_ALONE = "Stopped"  # status of a start that was skipped because the search was overdue
AS_IT_IS = "Not_Solved"  # status of a design that was judged as the search proposed it
# The judge may put the driver at slightly other angles than the programme, and looks between the targets:
# `MORE` solves at most are tightened by `BEYOND` times the miss, unless it exceeds a limit (as in
# `Defect.miss`; share of a zone).
MORE, BEYOND, A_LITTLE, OF_ZONE = 5, 1.05, 0.2, 1e-4
STRIDE = 0.3  # sizes: greatest move of a six-bar's pivots in a solve
STRIDES = 3  # greatest number of such solves
NEARER = (0.2, 0.05, 0.01)  # sizes: neighbourhoods of a start, tried where a free solve ends in an area
# Fields that can be tightened.
TIGHTENED = {
    "within", "transmission_min_deg", "size",
    *(name for name, limit in LIMITS.items() if limit.quantity.key in FORMULAS),
}  # fmt: skip


class Outcome(StrEnum):
    """The outcome of a start."""

    VERIFIED = "verified"
    REJECTED = "rejected"
    NO_LINKAGE = "no linkage"


@dataclass(frozen=True, slots=True)
class Attempt:
    """The design of a start."""

    status: str  # Ipopt's return status
    candidate: Candidate | None  # the design, judged, defects or not; None when the numbers make no linkage
    cognates: tuple[Candidate, ...] = ()  # other linkages without defects that lead P, or the body, alike

    @property
    def outcome(self) -> Outcome:
        """Whether the judge accepted the design."""
        if self.candidate is None:
            return Outcome.NO_LINKAGE
        return Outcome.VERIFIED if self.candidate.verdict.ok else Outcome.REJECTED

    @property
    def verified(self) -> tuple[Candidate, ...]:
        """The design, if the judge accepted it, and its cognates."""
        if self.candidate is None or not self.candidate.verdict.ok:
            return ()
        return (self.candidate, *self.cognates)


def attempts(
    scaled: ScaledProblem, starts: Sequence[Proposal], first: int, *, cognates: bool = True
) -> list[Attempt]:
    """Solve from starts, numbered from a first one; polish and verify the designs, which are judged together.

    Their cognates too, where they are of use. A linkage is verified as it is.
    """
    routines = [
        attempted(scaled, start, number, cognates=cognates) for number, start in enumerate(starts, first)
    ]
    return in_step(scaled, routines)


def attempt(scaled: ScaledProblem, start: Proposal, number: int, *, cognates: bool = True) -> Attempt:
    """The attempt from start `number`."""
    return attempts(scaled, [start], number, cognates=cognates)[0]


def attempted(
    scaled: ScaledProblem, start: Proposal, number: int, *, cognates: bool = True
) -> Steps[Attempt]:
    """The attempt from start `number`, as a routine that asks for designs."""
    if overdue():
        return Attempt(LEFT_ALONE, None)
    if isinstance(start, Linkage):
        return Attempt(AS_IT_IS, (yield ToJudge(start, number, 0)))
    if isinstance(start, DrivenLinkage):
        return Attempt(AS_IT_IS, (yield ToJudge(start.linkage, number, 0, cylinder=start.cylinder)))
    finder, start = finder_for(scaled), polished_start(scaled, start)
    done = None
    solvable = scaled.solvable or start.second is not None
    if start.terms.settled or not solvable or not set(UNSMOOTH).isdisjoint(start.terms.relaxed):
        done = yield from polished_and_judged(scaled, start, Solve.unchanged(start, AS_IT_IS), number)
    closed = bool(np.isfinite(start.points).all())
    may_move = scaled.solvable and start.terms.settled and finder.freedom and closed
    if done is None or (may_move and not done.verified):
        done = yield from (_clear if start.second is None else _in_strides)(scaled, start, number)
    if cognates and done.verified and finder.cognates:
        found = yield from verified_alike(scaled, done.verified[0], start.terms.most_error)
        done = replace(done, cognates=found)
    return done


def _clear(scaled: ScaledProblem, start: Start, number: int) -> Steps[Attempt]:
    """A solve; where it moves parts into areas between the targets, a solve nearer to the start, or none.

    No constraint keeps parts out of areas between the targets, but starts are screened there.
    """
    done = yield from _solved(scaled, start, number)
    wanted = scaled.wanted
    swept = bool(wanted.keep_out) and bool(
        set(wanted.keep_out_for) - set(scaled.kind.linkage.mechanism.ground)
    )
    if done.verified or done.candidate is None or not swept or start.terms.relaxed:
        return done
    if {defect.requirement for defect in done.candidate.verdict.defects} != {"keep_out"}:
        return done
    as_it_is = yield from polished_and_judged(scaled, start, Solve.unchanged(start, AS_IT_IS), number)
    if not as_it_is.verified:
        return done
    for radius in NEARER:
        near = yield from _solved(scaled, start.under(radius=min(radius, start.terms.radius)), number)
        if near.verified and _key(scaled, near) < _key(scaled, as_it_is):
            return near
    return as_it_is


def _solved(scaled: ScaledProblem, start: Start, number: int) -> Steps[Attempt]:
    """Solve; tighten and repeat while a single requirement is narrowly missed.

    Driver angles need not be those that the judge will find where that converges sooner, or alone. Where the
    error is to be least this comes first, as it leaves the least error; a goal that depends on these angles
    would be worse for them.
    """
    strict, by_error = start, not start.terms.bounded
    may_loosen = any(held_nearest(scaled, start))
    start = strict.under(loose=may_loosen and by_error)
    solve = solve_by_exchange(scaled, start)
    if may_loosen and not by_error and solve.status not in SOLVED and not stop_requested():
        start = strict.under(loose=True)
        solve = solve_by_exchange(scaled, start)
    done = yield from polished_and_judged(scaled, start, solve, number)
    if may_loosen and by_error and not done.verified and not stop_requested():
        strict = begun_from(strict, solve) if solve.status in SOLVED else strict
        again = solve_by_exchange(scaled, strict)
        if again.status in SOLVED:
            start, solve = strict, again
            done = yield from polished_and_judged(scaled, start, solve, number)
    for _ in range(MORE if solve.status in SOLVED else 0):
        more = _more(scaled, start, done.candidate)
        if not more or stop_requested():
            break
        start = begun_from(start, solve).under(more={**start.terms.more, **more})
        again = solve_by_exchange(scaled, start)
        if again.status not in SOLVED:
            break
        solve = replace(again, iterations=solve.iterations + again.iterations)
        done = yield from polished_and_judged(scaled, start, solve, number)
    return done


def _in_strides(scaled: ScaledProblem, start: Start, number: int) -> Steps[Attempt]:
    """Successive solves of a six-bar while they help, each with small moves of its pivots.

    Far from a start the loops seldom close.
    """
    done = yield from _solved(scaled, start.under(radius=STRIDE), number)
    for _ in range(STRIDES - 1):
        here = done.candidate
        if here is None or not np.isfinite(here.verdict.theta2).all() or stop_requested():
            break
        if scaled.exact and not done.verified:
            break
        there = replace(Start.of_linkage(scaled, here.linkage, here.verdict), terms=start.terms)
        again = yield from _solved(scaled, there.under(radius=STRIDE), number)
        if done.verified and (not again.verified or _key(scaled, again) >= _key(scaled, done)):
            break
        done = again
    return done


def _key(scaled: ScaledProblem, one: Attempt) -> tuple[float, ...]:
    """Where a verified design ranks."""
    return ranking_key(scaled.problem, one.verified[0])


def _more(scaled: ScaledProblem, start: Start, candidate: Candidate | None) -> dict[str, float]:
    """Amounts by which the next solve is tightened, by field; empty unless one alone is narrowly missed."""
    missed = {defect.requirement for defect in candidate.verdict.defects} if candidate is not None else set()
    if candidate is None or not missed:
        return {}
    if missed <= MISSED and start.terms.zoned and not start.terms.relaxed:
        field, short, little = "within", max(shares(scaled.problem, candidate.verdict)) - 1, OF_ZONE
    else:
        field, short, little = min(missed), max(each.miss for each in candidate.verdict.defects), A_LITTLE
    loose = field not in TIGHTENED or start.terms.relaxes(field)
    if len(missed - MISSED) > 1 or loose or not 0 < short < little:
        return {}
    return {field: start.terms.tightened_by(field) + BEYOND * short}


def polished_and_judged(scaled: ScaledProblem, start: Start, solve: Solve, number: int) -> Steps[Attempt]:
    """The design of a solve on its targets; of least squares as solved, if it is not a design there."""
    done = Attempt(solve.status, None)
    if not np.isfinite(solve.points).all():
        return done
    about = number, solve.iterations, start.terms.most_error
    for version in (polished_solve(scaled, start, solve), solve):
        points, second = np.array(version.points), version.second
        linkage = made_linkage(scaled, points, start.assembly, version.body_angle, second)
        candidate = None if linkage is None else (yield ToJudge(linkage, *about))
        done = replace(done, candidate=candidate)
        if done.verified or scaled.exact or version is solve:
            break
    return done
