"""Proposals of the rounds for a function, and of the last round from designs."""

import numpy as np
import pytest

from grashof.analysis import Verdict, verify
from grashof.problems import FunctionTask, Linkage, Problem, Requirements
from grashof.synth.designs.judging import judged_linkage
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.functions.finder import Functions

LAW = FunctionTask.from_degrees(
    law="log10", x=(1, 2), input_range_deg=60, output_range_deg=90, norm="max", sense="given"
)
PROBLEM = Problem(task=LAW, requirements=Requirements(link_ratio_max=10, exact=False))


def accepted(starts: object) -> list[tuple[Linkage, Verdict]]:
    every = [(one, verify(one, LAW, PROBLEM.requirements)) for one in starts]  # type: ignore[attr-defined]
    return [(one, verdict) for one, verdict in every if verdict.ok]


@pytest.fixture(scope="module")
def finder() -> Functions:
    return Functions(ScaledProblem.of(PROBLEM))


def test_levels_below_the_least_error_are_skipped_and_its_valley_is_followed(finder: Functions) -> None:
    made = finder.round(0, 50, np.random.default_rng(0), 1)
    assert made is not None
    best, verdict = min(accepted(made.starts), key=lambda each: each[1].structural_error_max)
    reached = np.degrees(verdict.transmission_min_task)
    assert made.skip == sum(level <= reached for level in finder.levels)

    designs = [judged_linkage(finder.scaled, best, start=0, iterations=0)]
    after = min(each.structural_error_max for _, each in accepted(finder.onward(designs)))
    assert verdict.structural_error_max * (1 - 1e-4) < after < verdict.structural_error_max


def test_designs_of_an_angle_transmit_so_much(finder: Functions) -> None:
    number = len(finder.levels)
    made = finder.round(number, 50, np.random.default_rng(0), 1)
    assert made is not None
    least = np.radians(finder.levels[-1]) - 1e-6
    assert accepted(made.starts)
    assert all(verdict.transmission_min_task > least for _, verdict in accepted(made.starts))
    assert finder.round(number + 1, 50, np.random.default_rng(0), 1) is None
