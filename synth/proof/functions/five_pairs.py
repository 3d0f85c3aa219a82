"""Functions of five pairs: all four-bars that generate them, each for certain."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np

from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.poses.five_poses import FIVE, STOPPED, Certified, certified_dyads, why_open
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.theory.burmester import Displacements
from grashof.synth.theory.stopping import StopRequested

_TRIVIAL = 1e-6  # of r1: the ground link itself is a dyad of every function


def certified_functions(scaled: ScaledProblem) -> Certified | None:
    """All couplers of four-bars through five pairs, up to a ratio of lengths; None for other functions.

    Seen from link 4, link 2 moves through known poses, and the coupler is a dyad of that motion; with r1 = 1
    no length is greater than the ratio of lengths allows.
    """
    problem = scaled.problem
    if scaled.kind.dyad.bars < 2 or not scaled.exact or not problem.task.has_output.all():
        return None
    if len(problem.task) != FIVE or problem.requirements.theta2_start_deg is not None:
        return None
    if problem.driver is not None:  # not every linkage has a cylinder within its limits
        return None
    aims, since, found = FunctionAims.of(scaled), perf_counter(), []
    if aims.made is not aims.kind:  # places are searched for, and not all are tried
        return None
    for sense in dict.fromkeys(sense for sense, _, _ in aims.ways()):
        wanted = aims.pairs(sense)
        turned, output = wanted.turned - wanted.turned[0], wanted.output - wanted.output[0]
        motion = Displacements(np.exp(1j * (turned - output)), 1.0 - np.exp(-1j * output))
        try:
            made = certified_dyads(Required.within(motion, aims.wanted.link_ratio_max), motion)
        except StopRequested:
            return replace(Certified.nothing(), why=STOPPED)
        made = replace(made, within=int(made.within - _trivial(made)), why=why_open(made, motion))
        found.append(made)
    joined = replace(found[0], within=sum(one.within for one in found), seconds=perf_counter() - since)
    why = next((one.why for one in found if one.why), "")
    return replace(joined, complete=not why, why=why)


def _trivial(dyads: Certified) -> int:
    """Number of dyads that are the ground link."""
    return int(np.sum((np.abs(dyads.moving) < _TRIVIAL) & (np.abs(dyads.ground - 1) < _TRIVIAL)))
