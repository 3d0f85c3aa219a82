"""From a problem to a proof about its best design, without a list."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from grashof.analysis import verify
from grashof.analysis.judge.design import Constraint
from grashof.problems import Problem, ProblemError
from grashof.problems.values.checks import number_within
from grashof.problems.values.linkages.mechanism import DyadKind
from grashof.problems.values.linkages.mechanisms import closing_dyad
from grashof.synth.pipeline import synthesize
from grashof.synth.proof.claims.bounds import Bounds, Proving
from grashof.synth.proof.claims.proof import Claim, Proof, proof_of, quantity_of
from grashof.synth.proof.curve.required import POSES, refusal
from grashof.synth.proof.curve.table import Trail
from grashof.synth.proof.functions.few_pairs import FOUR, THREE
from grashof.synth.proof.poses.certificate import certificate_of, without_check, writable, write
from grashof.synth.proof.poses.five_poses import FIVE
from grashof.synth.proof.poses.four_poses import bounds_of_four
from grashof.synth.proof.provers import bounds_before, bounds_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.finder import refuse_unsearchable
from grashof.synth.search.history import StopCondition
from grashof.synth.theory.stopping import stopping

_RIGHT = 90.0  # deg: a bound without information
_BEYOND = (
    "there are proofs of three to five whole poses, and pairs of a function, that a four-bar meets exactly, "
    "of four whole poses of a slider-crank, and of a swing or a stroke; of no other task yet, and of none "
    "driven by a cylinder"
)


def prove(
    problem: Problem,
    *,
    at_least: float | None = None,
    gap: float = 0.01,
    constraints: Sequence[Constraint] = (),
    time_limit: float | None = None,
    stop: Callable[[], bool] | None = None,
    certificate: str | Path | None = None,
) -> Proof:
    """Prove how good the best design can be, or that there is none.

    Parameters
    ----------
    problem : Problem
        For a four-bar, met exactly: three or four whole poses, the transmission angle to be maximised; five
        whole poses; a function of three to five pairs. For a slider-crank four whole poses. For every kind of
        linkage a swing or a stroke; of a list of kinds for the first.
    at_least : float, deg, optional
        Only decide whether a design has at least this transmission angle.
    gap : float, deg
        Difference to which the bounds are brought together, 0.0001 to 90.
    constraints : sequence of callable
        Your own, as for `synthesize`; the bound ignores them.
    time_limit, stop
        As for `synthesize`; the bound reached by then is valid.
    certificate : str or Path, optional
        File for the certificate of four poses, to be checked by ``scripts/check_certificate.py``; it is
        not written where no bound was reached.

    Returns
    -------
    Proof
        Its `lower` is the value of a design that the judge accepts, None where none was found.

    Raises
    ------
    ProblemError
        The problem, or another argument, is invalid.

    Notes
    -----
    Branch and bound over pairs of pieces of Burmester's curve, of three poses of squares of the plane; of
    five targets a search among all dyads; of a stroke over one-parameter families.
    See "Proofs" in the documentation.

    Examples
    --------
    >>> from grashof import load
    >>> proof = prove(load("luggage"))
    >>> str(proof.claim), round(proof.lower, 1), round(proof.upper, 1)
    ('best', 27.3, 27.3)
    >>> str(prove(load("luggage"), at_least=28).claim)
    'none'
    """
    stop_condition = StopCondition.of(time_limit, stop)
    if not isinstance(problem, Problem):
        raise ProblemError(f"problem is a {type(problem).__name__}; it must be a Problem, such as load gives")
    refuse_unsearchable(problem)
    if at_least is not None:
        number_within(at_least, 0.0, 90.0, "at_least")
    proving = Proving.patient(gap)
    beyond = Proof(claim=Claim.REFUSED, quantity=quantity_of(problem).column, why=_BEYOND)
    stroke, bars = problem.task.at_limits, _of_bars(problem)
    kind = problem.mechanism[0] if stroke or bars is None else bars
    if certificate is not None:
        _certifiable(problem, constraints, Path(certificate))
    alone = problem.for_kind(kind)
    function, count = bool(problem.task.has_output.any()), len(problem.task)
    if kind != bars and (function or (count != POSES and not stroke)):
        return beyond
    whole = problem.task.is_whole
    three = whole and count == THREE and at_least is None
    by_list = stroke or (function and count in (THREE, FOUR, FIVE)) or (whole and count == FIVE)
    if by_list or (three and _takes_minutes(ScaledProblem.of(alone, constraints), proving)):
        found = synthesize(
            alone, constraints=constraints, time_limit=time_limit, stop=stop, gap=gap, prove=True
        ).proof
        if found is not None or count != THREE:
            return beyond if found is None else _of_at_least(found, at_least)
    if function:
        return beyond
    scaled = ScaledProblem.of(alone, constraints)
    trail = None if certificate is None else Trail()
    with stopping(stop_condition):
        if trail is None:
            bounds = bounds_of(scaled, proving, at_least)
        else:
            bounds = bounds_of_four(scaled, proving, at_least, trail)
    if bounds is None:
        return beyond
    proof = proof_of(scaled.problem, bounds, _known(scaled, bounds), gap)
    if trail is not None and certificate is not None and has_certificate(proof):
        write(certificate_of(scaled, trail, float(np.degrees(bounds.upper)), at_least), Path(certificate))
    return proof


def _of_bars(problem: Problem) -> str | None:
    """The requested kind that consists of bars alone, which has most proofs; None without it."""
    return next((kind for kind in problem.mechanism if closing_dyad(kind) is DyadKind.RRR), None)


def _takes_minutes(scaled: ScaledProblem, proving: Proving) -> bool:
    """Whether three poses stay open at first: a good design of a list then saves many pairs."""
    return not refusal(scaled, THREE) and bounds_before(scaled, proving) is None


def has_certificate(proof: Proof) -> bool:
    """Whether a proof of four poses reached a bound, so that there is a certificate of it."""
    return proof.claim is not Claim.REFUSED and proof.upper is not None and proof.upper < _RIGHT


def _certifiable(problem: Problem, constraints: Sequence[Constraint], path: Path) -> None:
    """Refuse a certificate, before the proof, where there can be none."""
    bars = _of_bars(problem)
    scaled = ScaledProblem.of(problem if bars is None else problem.for_kind(bars), constraints)
    if refusal(scaled) is None:
        raise ProblemError(
            f"certificate {path}: there are certificates of four whole poses only, met by a four-bar"
        )
    if without := without_check(scaled):
        raise ProblemError(f"certificate {path}: certificates cannot state {' and '.join(without)} yet")
    writable(path)


def _of_at_least(proof: Proof, at_least: float | None) -> Proof:
    """The proof where only designs with at least `at_least` count, deg."""
    reached = proof.lower if proof.complete else proof.upper
    if at_least is None or proof.claim is Claim.REFUSED or (reached or 0.0) >= at_least:
        return proof
    return replace(proof, claim=Claim.NONE, lower=None, upper=at_least)


def _known(scaled: ScaledProblem, bounds: Bounds) -> float | None:
    """Transmission angle of the design that was found, deg, where it meets all requirements."""
    if bounds.found is None:
        return None
    problem, linkage = scaled.problem, bounds.found.linkage
    accepted = verify(linkage, problem.task, problem.requirements, scaled.constraints, problem=problem).ok
    return float(np.degrees(bounds.lower)) if accepted else None
