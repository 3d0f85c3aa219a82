"""One attempt: a solve from one start, made exact, and judged. Runs in any process."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis import verify
from grashof.problems import ProblemError
from grashof.synth.burmester import Dyads, polish
from grashof.synth.four_poses import UNSOLVED
from grashof.synth.programme import Solve, solve
from grashof.synth.result import Candidate
from grashof.synth.setup import Setup
from grashof.synth.start import Start


@dataclass(frozen=True, slots=True)
class Attempt:
    """What became of a start.

    Parameters
    ----------
    status : str
        Ipopt's return status.
    candidate : Candidate or None
        The design, judged, defects or not; None when the numbers make no linkage.
    """

    status: str
    candidate: Candidate | None


def attempt(setup: Setup, start: Start, number: int) -> Attempt:
    """Solve from a start, polish the poses to be exact, verify.

    Parameters
    ----------
    setup : Setup
    start : Start
    number : int
        Of the start.

    Returns
    -------
    Attempt
    """
    if UNSOLVED.isdisjoint(start.relaxed):
        solved = solve(setup.motion, setup.body, setup.wanted, start)
    else:
        solved = Solve((start.o2, start.o4, start.a, start.b), "Not_Solved", 0)
    points = np.array(solved.points)
    if not np.isfinite(points).all():
        return Attempt(solved.status, None)
    dyads = polish(setup.motion, Dyads(moving=points[2:], ground=points[:2]))
    pivots = np.concatenate([dyads.ground, dyads.moving])
    try:
        linkage = setup.linkages(pivots, np.array(start.assembly))
    except ProblemError:  # the solver ended where two pivots coincide
        return Attempt(solved.status, None)
    verdict = verify(linkage, setup.problem.task, setup.problem.requirements)
    return Attempt(solved.status, Candidate(linkage, verdict, number, solved.iterations))
