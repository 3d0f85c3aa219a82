"""Judging: what the analysis says of a linkage, by the requirements of a scaled problem."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.analysis import Verdict, verify
from grashof.analysis.judge.over_task import torque_peak
from grashof.problems import FourBar, ProblemError
from grashof.problems.values.arrays import ComplexArray
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.results.candidate import Candidate


def linkage_of(
    scaled: ScaledProblem, points: ComplexArray, assembly: int, body_angle: float
) -> FourBar | None:
    """The linkage of pivots and coupler point at the first target; None where two pivots coincide."""
    # Of whole poses the first one says how the body stands to the coupler.
    given = None if scaled.motion is not None else np.array(body_angle)
    try:
        return scaled.linkages(points, np.array(assembly), given)
    except ProblemError:
        return None


def verdict_on(scaled: ScaledProblem, linkage: FourBar, most_error: float = np.inf) -> Verdict:
    """The judge's verdict; `most_error` is the root mean square error allowed, sizes."""
    problem, task = scaled.problem, scaled.problem.task
    square = len(task) * (most_error * task.size) ** 2
    return verify(linkage, task, problem.requirements, scaled.constraints, most_square=square)


def judged(
    scaled: ScaledProblem, linkage: FourBar, start: int, iterations: int, most_error: float = np.inf
) -> Candidate:
    """A design with the verdict on it, and its torque where it is accepted."""
    verdict = verdict_on(scaled, linkage, most_error)
    torque = torque_peak(linkage, scaled.problem, verdict) if verdict.ok else np.nan
    return Candidate(linkage, verdict, start, iterations, torque_peak=torque)


def judged_again(scaled: ScaledProblem, candidate: Candidate, most_error: float = np.inf) -> Candidate:
    """A design judged by the requirements of another problem with the same targets."""
    return replace(candidate, verdict=verdict_on(scaled, candidate.linkage, most_error))
