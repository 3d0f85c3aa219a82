"""The judge's verdict on a linkage that a user has, in words."""

from __future__ import annotations

import numpy as np

from grashof.problems import LinkageSpec, Problem, ProblemError
from grashof.problems.values.requirements.quantities import Scope
from grashof.problems.values.requirements.requirements import QUANTITIES
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.families import caution
from grashof.synth.designs.judging import driven_verdict
from grashof.synth.quantities.scaled_problem import ScaledProblem

# What is reported of a linkage besides what it misses, where it has a value.
_KEYS = (
    "error_max", "error_rms", "structural_error_max", "structural_error_rms", "transmission_min_task",
    "transmission_min_cycle", "driver_rotation", "output_swing", "stroke", "time_ratio", "size",
    "torque_peak",
)  # fmt: skip


def judged_for(problem: Problem, spec: LinkageSpec) -> Candidate:
    """A user's own linkage with the verdict on it, by the judge that every design of a list has passed.

    The problem's list of kinds need not have its own. Its cylinder drives it, or, where the problem asks for
    one and it has none, the best. ProblemError for lengths in different units, or a linkage of two loops.
    """
    if len(spec.linkage.mechanism.dyads) > 1:
        word = spec.linkage.mechanism.word
        raise ProblemError(f"{spec.name} is a {word}; only linkages of one loop can be judged")
    if problem.length_unit and spec.length_unit and problem.length_unit != spec.length_unit:
        raise ProblemError(
            f"{spec.name}: lengths are in {spec.length_unit}, those of {problem.name} in "
            f"{problem.length_unit}; they must be in the same unit"
        )
    of = problem.for_kind(spec.linkage.mechanism.word)
    verdict = driven_verdict(ScaledProblem.of(of), spec.linkage, known=spec.cylinder)
    return Candidate(spec.linkage, verdict, of, 0, 0)


def verdict_lines(candidate: Candidate, name: str) -> list[str]:
    """What a linkage does with a task: whether all is met, each requirement that is not, its figures."""
    problem, verdict = candidate.problem, candidate.verdict
    missed = [str(defect) for defect in verdict.defects]
    lines = [f"{name} {'does not meet' if missed else 'meets'} the requirements of {problem.name}"]
    lines += [f"  missed: {line}" for line in missed]
    if not missed and (doubt := caution(problem, candidate)):
        lines.append(f"  but {doubt}")
    lines.append(f"  {verdict.grashof_class}; driver {'turns fully' if verdict.full_rotation else 'swings'}")
    for key in _KEYS:
        quantity = QUANTITIES[key]
        if quantity.over is Scope.CYCLE and not verdict.full_rotation:
            continue
        if candidate.linkage.mechanism.word in quantity.kinds and np.isfinite(value := candidate.values[key]):
            unit = quantity.unit.of(problem.length_unit)
            lines.append(f"  {quantity.full}: {value * quantity.unit.shown:.6g} {unit}".rstrip())
    return lines
