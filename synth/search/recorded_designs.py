"""Results of a record, compared with the judge: a file may contain anything."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import alike, judged_again
from grashof.synth.programme.start import Proposal, Round, Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import Attempt
from grashof.synth.search.ledger import Chunk

_COGNATE = re.compile("(d[0-9a-f]{7})?")  # id of the design that another one is a cognate of


def is_round(result: object) -> bool:
    """Whether a result is a round of starts, or None; the designs from them are judged later."""
    return result is None or isinstance(result, Round)


def are_attempts(scaled: ScaledProblem, starts: Sequence[Proposal], result: object) -> bool:
    """Whether a result is an attempt for each start, with the judge's verdict on every design."""
    if not isinstance(result, list) or len(result) != len(starts):
        return False
    allowed = [start.terms.most_error if isinstance(start, Start) else np.inf for start in starts]
    return all(
        isinstance(one, Attempt)
        and (one.candidate is None or _is_true(scaled, one.candidate, most))
        and all(each.verdict.ok and _is_true(scaled, each, most) for each in one.cognates)
        for one, most in zip(result, allowed, strict=True)
    )


def is_true_chunk(scaled: ScaledProblem, result: object) -> bool:
    """Whether a result is a chunk, with the judge's verdict on every design and miss."""
    if not isinstance(result, Chunk) or not is_complete_chunk(scaled, result):
        return False
    misses = [one.candidate for one in result.misses if one.candidate is not None]
    return all(agrees(scaled, one) for one in (*result.designs, *misses))


def is_complete_chunk(scaled: ScaledProblem, chunk: Chunk) -> bool:
    """Whether a chunk is as a search leaves it; verdicts are not checked."""
    if min(chunk.solved, chunk.size, *chunk.tally.recorded.values(), 0) < 0:
        return False
    if not all(one.verdict.ok for one in chunk.designs):
        return False
    found = (*chunk.designs, *(miss.candidate for miss in chunk.misses))
    return all(one is not None and _is_unlisted(scaled, one) for one in found)


def agrees(scaled: ScaledProblem, one: Candidate, most_error: float = np.inf) -> bool:
    """Whether the judge repeats the verdict on a design."""
    again = judged_again(scaled, one, most_error)
    return alike(again.verdict, one.verdict, scaled.problem.task.size)


def _is_true(scaled: ScaledProblem, one: Candidate, most_error: float = np.inf) -> bool:
    return _is_unlisted(scaled, one) and agrees(scaled, one, most_error)


def _is_unlisted(scaled: ScaledProblem, one: Candidate) -> bool:
    """Whether a design is of this task and not yet named by a list."""
    if one.own_objective is not None or one.region or f"{one.best_at}{one.family}{one.caution}":
        return False
    if not _COGNATE.fullmatch(one.cognate_of):
        return False
    verdict, targets = one.verdict, len(scaled.problem.task)
    each = verdict.theta2, verdict.assembly, verdict.position_error, verdict.angle_error
    return all(np.shape(array) == (targets,) and array.dtype.kind in "if" for array in each)
