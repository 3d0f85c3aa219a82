"""Why there is no design: single requirements that would have to be relaxed, and the closest misses."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis import Verdict
from grashof.problems import Objective, Problem, Rotatability, Task
from grashof.problems.values.units import Unit
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import judged_again
from grashof.synth.designs.ranking import ranked
from grashof.synth.programme.start import Round
from grashof.synth.programme.user_functions import relaxed_by_own
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.larger_zones import up, wider
from grashof.synth.results.relaxations import relaxations, work_of
from grashof.synth.results.result import BETWEEN, WOULD
from grashof.synth.results.trade_offs import Chosen
from grashof.synth.search.attempt import Attempt
from grashof.synth.search.chunks import solve
from grashof.synth.search.finder import finder_for
from grashof.synth.search.ledger import Ledger
from grashof.synth.search.run import Run
from grashof.synth.search.searches import search_designs
from grashof.synth.starts.finder import DesignFinder
from grashof.synth.starts.strokes.limit_positions import stroke_kind_of
from grashof.synth.theory.limit_positions import best_transmission
from grashof.synth.theory.stopping import StopRequested

STOPPED = "no design: the search was stopped before it found one"
UNEXPLAINED = "no design: the search for the reason was stopped"
SHOWN = 8  # least-squares designs that stand for the nearest
ALTERNATIVES = 6  # that the note names
NEAR_EFFORT, NEAR, NEAR_SOLVES = 0.2, 8, 24  # of a search for designs that come near
LONGER = 2.0  # effort with which that search is a whole one, even if it takes long
LATER = 0.3  # share of the usual work for a second round of relaxations, of least squares
GOOD = float(np.radians(40))  # transmission angle that textbooks recommend (Norton, sec. 3.3)
LITTLE = float(np.radians(1))  # below it more digits are shown
_HALVINGS = 12


@dataclass(frozen=True, slots=True)
class Explanation:
    """Why a list is empty."""

    note: str
    nearest: tuple[Candidate, ...] = ()  # the closest misses, the smallest first
    designs: tuple[Candidate, ...] = ()  # that meet all requirements, found in the search for near ones


@dataclass(frozen=True, slots=True)
class _Near:
    """A design of least squares, judged as such and by the requirements as stated."""

    by_squares: Verdict
    candidate: Candidate


def explain(scaled: ScaledProblem, ledger: Ledger, chosen: Chosen, run: Run) -> Explanation:
    """State why a list is empty: what changes would give a design, and how near designs come."""
    if not ledger.complete:
        return Explanation(STOPPED)
    asked = ledger.scaled if len(scaled.targets) < 3 else scaled  # two poses nearly met are two that are met
    try:
        with run.timed("explaining"):
            return _explained(asked, ledger, chosen.rejected, run)
    except StopRequested:
        return Explanation(UNEXPLAINED)


def _explained(scaled: ScaledProblem, ledger: Ledger, rejected: list[Attempt], run: Run) -> Explanation:
    finder = finder_for(scaled)
    rng = np.random.default_rng(np.random.SeedSequence(run.search.seed, spawn_key=(0,)))
    known = [one.candidate for one in rejected if one.candidate is not None]
    relaxed = relaxations(scaled, known, rng, run)
    ways = relaxed.found + wider(scaled.problem, scaled.constraints, known)
    squares = None if run.ended() or not _may_be_near(scaled) else _least_squares(scaled, run)
    ranks = () if squares is None else ranked(squares.scaled.problem, squares.best)
    near = [_Near(one.verdict, judged_again(scaled, one)) for one in ranks[:SHOWN]]  # the nearest first
    designs = tuple(one.candidate for one in near if one.candidate.verdict.ok)
    if designs:
        return Explanation("", designs=designs)
    why = finder.obstacle(rng, ledger.tally.found)
    if ways:
        alternatives = [(way.miss, way.words, way.candidate) for way in ways]
        for one in near[:1]:
            miss = _miss(one, scaled.problem.task.size)
            if miss < 1:  # no farther away than the size of the task
                words = f"exact = false ({_comes_within(scaled, one, then='then ')})"
                alternatives.append((miss, words, one.candidate))
        alternatives.sort(key=lambda one: one[:2])
        named = [words for _, words, _ in alternatives[:ALTERNATIVES]]
        note = _ways_note(why, named, cut=_cut(scaled, relaxed.effort, run))
        return Explanation(note, tuple(candidate for _, _, candidate in alternatives))
    if near:
        note = f"no design: {why or 'exact: none'}; {_comes_within(scaled, near[0])}, with exact = false"
        return Explanation(note + _cut(scaled, relaxed.effort, run), tuple(one.candidate for one in near))
    starts = [*finder.relaxed(rng), *relaxed_by_own(scaled, ledger.latest)]
    nearest = () if run.ended() else closest_misses(run.solve(scaled, starts, len(rejected)))
    nearest = nearest or closest_misses(rejected)
    if squares is not None and not _misses_one(nearest) and not run.ended():
        missed = [one.candidate for one in squares.rejected if one.candidate is not None]
        again = relaxations(squares.scaled, missed, rng, run, most=LATER)
        relaxed = max(relaxed, again, key=lambda one: one.effort)
        loose = [
            (each, _Near(each.candidate.verdict, judged_again(scaled, each.candidate)))
            for each in again.found
        ]
        loose = [(each, one) for each, one in loose if _miss(one, scaled.problem.task.size) < 1]
        named = [f"{each.words} ({_comes_within(scaled, one)})" for each, one in loose[:ALTERNATIVES]]
        if named:
            note = _ways_note(why, named, "with exact = false ", cut=_cut(scaled, relaxed.effort, run))
            return Explanation(note, tuple(one.candidate for _, one in loose))
    return Explanation(_none_note(scaled, nearest, why) + _cut(scaled, relaxed.effort, run), nearest)


def _misses_one(nearest: tuple[Candidate, ...]) -> bool:
    """Whether the closest miss is of one requirement alone."""
    return bool(nearest) and len({defect.requirement for defect in nearest[0].verdict.defects}) == 1


def closest_misses(attempts: list[Attempt]) -> tuple[Candidate, ...]:
    """The closest miss for each set of missed requirements, fewest and smallest misses first."""
    closest: dict[tuple[str, ...], tuple[float, Candidate]] = {}
    for one in attempts:
        if one.candidate is not None and not one.verified:
            defects = one.candidate.verdict.defects
            kind, miss = tuple(sorted({d.requirement for d in defects})), sum(d.miss for d in defects)
            if kind not in closest or miss < closest[kind][0]:
                closest[kind] = (miss, one.candidate)
    fewest = min(map(len, closest), default=0)
    found = [(miss, kind, candidate) for kind, (miss, candidate) in closest.items() if len(kind) == fewest]
    return tuple(candidate for _, _, candidate in sorted(found, key=lambda item: item[:2]))


def _least_squares(scaled: ScaledProblem, run: Run) -> Ledger:
    """For targets to be met exactly: the search for the nearest designs."""
    wanted = replace(scaled.problem.requirements, exact=False)
    # Zones apart, an objective is of no effect there.
    objective = scaled.problem.objective if scaled.bounded else Objective()
    problem = replace(scaled.problem, requirements=wanted, objective=objective)
    enough, starts = min(run.search.enough, NEAR), min(run.search.starts, int(NEAR_SOLVES / work_of(problem)))
    search = replace(run.search, effort=NEAR_EFFORT, enough=enough, starts=starts)
    alone = replace(run, search=search, progress=None, seconds=dict(run.seconds))
    squares = scaled.of_problem(problem)
    finder = finder_for(squares)
    if not isinstance(finder, DesignFinder) or not _takes_long(squares) or run.search.effort >= LONGER:
        return search_designs(squares, alone)
    ledger = Ledger(squares, search, finder.exhausted)
    ledger.begin(Round(finder.closest_to(squares, "exact", np.random.default_rng(search.seed)), {}))
    solve(ledger.latest, ledger, alone)
    return ledger


def _takes_long(scaled: ScaledProblem) -> bool:
    """Whether a whole search is too long for an explanation."""
    return bool(np.isfinite(finder_for(scaled).searches_near))


def _may_be_near(scaled: ScaledProblem) -> bool:
    """Whether targets may be missed instead: two poses leave least squares no error to minimise."""
    return scaled.exact and len(scaled.targets) > 2


def _miss(near: _Near, size: float) -> float:
    """Greatest miss of a least-squares design: sizes or rad."""
    verdict = near.by_squares
    return float(np.nanmax([*verdict.angle_error, *verdict.output_error, verdict.error_max / size]))


def _cut(scaled: ScaledProblem, effort: float, run: Run) -> str:
    """A clause for an explanation that was cut short: the effort that would have left nothing out."""
    if _takes_long(scaled) and _may_be_near(scaled):
        effort = max(effort, LONGER)
    if effort <= max(run.search.effort, 1.0):
        return ""
    return f"; the explanation is cut short, effort = {np.ceil(effort):g} gives the full one"


def _ways_note(why: str, words: list[str], given: str = "", cut: str = "") -> str:
    """The note that names single requirements, each sufficient together with `given`."""
    reason = (f"no design: {why}" if why else "no design meets all requirements") + cut
    alone = f"{given}{'this' if len(words) == 1 else 'each of these'}{WOULD}"
    return f"{reason}; {alone}: {BETWEEN.join(words)}"


def _comes_within(scaled: ScaledProblem, near: _Near, then: str = "") -> str:
    """Misses of a least-squares design in words; numbers are rounded up, so that they hold."""
    unit = f" {scaled.problem.length_unit}" if scaled.problem.length_unit else ""
    verdict, output = near.by_squares, scaled.problem.task.counted_in
    missed = {
        "position": (verdict.position_error, unit),
        "angle": (np.degrees(verdict.angle_error), " deg"),
        "output": (output.shown * verdict.output_error, unit if output is Unit.LENGTH else " deg"),
    }
    most = [f"{up(float(np.nanmax(e))):g}{u}" for e, u in missed.values() if not np.isnan(e).all()]
    return f"the closest design {then}comes within {' and '.join(most)} everywhere"


def _none_note(scaled: ScaledProblem, nearest: tuple[Candidate, ...], why: str) -> str:
    """The note where no single requirement would do."""
    squares = ", nor a least-squares design" if _may_be_near(scaled) else ""
    closest = f"; the closest one misses {_missed(scaled, nearest[0])}" if nearest else ""
    if why:
        return f"no design: {why}{'; least squares finds none either' if squares else ''}{closest}"
    if not nearest:
        return f"no design: the search found none{squares}, nor a near miss"
    return f"no design meets all requirements{'' if _misses_one(nearest) else ', nor all but one'}{closest}"


def _missed(scaled: ScaledProblem, candidate: Candidate) -> str:
    """The defects of a design, and the line of the problem file that would require less."""
    defects = candidate.verdict.defects
    missed, less = {defect.requirement for defect in defects}, ""
    if "rotatability" in missed and scaled.wanted.rotatability is not Rotatability.ANY:
        less = '; rotatability = "any" requires less'
    return " and ".join(map(str, defects)) + less


def advice(problem: Problem) -> str:
    """A note for a stroke that no linkage transmits well, with tasks that would allow more; else empty.

    >>> from grashof.problems import StrokeTask
    >>> advice(Problem(task=StrokeTask.from_degrees(swing_deg=80, time_ratio=1.05)))
    ''
    >>> print(advice(Problem(task=StrokeTask.from_degrees(swing_deg=40, time_ratio=1.5))))
    crank-rockers with this swing and time ratio transmit at 31.8 deg at best, less than the usual 40 deg; \
time ratios up to 1.30 allow 40 deg, and a six-bar may do it as asked
    """
    task = problem.task
    if not task.at_limits:
        return ""
    stroke_kind = stroke_kind_of(ScaledProblem.of(problem).kind)
    if not stroke_kind.advised or (best := best_transmission(task.swing, task.time_ratio)) >= GOOD:
        return ""
    kinds, what = stroke_kind.what, stroke_kind.advised
    usual = f"{np.degrees(GOOD):.0f} deg"
    ratio = _ratio_that_allows(task)
    smaller = (
        f"time ratios up to {ratio:.2f} allow {usual}" if ratio > 1 else f"{usual} takes a smaller {what}"
    )
    angle = f"{np.degrees(best):.{1 if best > LITTLE else 4}f}"
    return (
        f"{kinds} with this {what} and time ratio transmit at {angle} deg at best, less than "
        f"the usual {usual}; {smaller}, and a six-bar may do it as asked"
    )


def _ratio_that_allows(task: Task) -> float:
    """The greatest time ratio, in hundredths, that allows a good transmission angle; 1 where none does."""
    low, high = 1.0, task.time_ratio
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        good = best_transmission(task.swing, middle) >= GOOD
        low, high = (middle, high) if good else (low, middle)
    return float(np.floor(100 * low) / 100)
