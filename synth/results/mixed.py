"""The lists of several kinds of linkage as one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.problems import Problem
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.families import listed
from grashof.synth.quantities.scores import same_error
from grashof.synth.results.result import Result
from grashof.synth.search.history import RunHistory, StopReason
from grashof.synth.search.tally import DISTINCT, Tally


def one_list(problem: Problem, found: Sequence[Result]) -> Result:
    """One ranked list of what was found for each kind of linkage that a problem asks for.

    For the problem `Problem.for_kind` of each, in their order; perhaps not for the last ones. With
    ``error_factor`` the least error of all kinds counts.
    """
    if len(problem.mechanism) == 1 and found:
        return found[0]
    least = float(np.min([one.least_error for one in found], initial=np.inf, where=_known(found)))
    designs = [replace(each, problem=problem) for one in found for each in one.candidates]
    chosen = listed(problem, within_factor(problem, designs, least / problem.task.error_unit))
    tally = Tally()
    for one in found:
        tally.update(one.tally)
    tally.totals[DISTINCT] = len(chosen)
    return Result(
        problem=problem,
        candidates=chosen,
        nearest=() if chosen else tuple(each for one in found for each in one.nearest),
        tally=tally,
        seconds=found[-1].seconds if found else {},
        note="" if chosen else _by_kind(found, "note"),
        complete=len(found) == len(problem.mechanism) and all(one.complete for one in found),
        ended=_by_kind(found, "ended"),
        least_error=least if np.isfinite(least) else np.nan,
        history=_history([one.history for one in found if one.history is not None]),
        proof=next((one.proof for one in found if one.proof is not None), None),
    )


def _known(found: Sequence[Result]) -> list[bool]:
    return [not np.isnan(one.least_error) for one in found]


def within_factor(problem: Problem, designs: Sequence[Candidate], least: float) -> list[Candidate]:
    """Designs whose error ``error_factor`` allows, by the least error of all, sizes."""
    factor = problem.requirements.error_factor
    most = np.inf if factor is None else factor * max(least, same_error(problem))
    return [each for each in designs if each.error(problem) <= most * (1 + 1e-9)]


def _by_kind(found: Sequence[Result], name: str) -> str:
    """What several lists say of themselves, each with its kind."""
    said = [(one.problem.mechanism[0], getattr(one, name)) for one in found]
    return "; ".join(f"{kind}: {text}" for kind, text in said if text)


def _history(parts: Sequence[RunHistory]) -> RunHistory | None:
    if not parts:
        return None
    endings = [part.ending for part in parts if part.ending is not StopReason.COMPLETE]
    ending = endings[0] if endings else StopReason.COMPLETE
    return replace(parts[-1], begun=parts[0].begun, ending=ending)
