"""Loads over a travel: a defect where their rows end before the slide does, to the digit."""

from dataclasses import replace

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import solve_kinematics, verify
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.over_task import motion_ends
from grashof.analysis.judge.planted import planted_path
from grashof.problems import DynamicsSpec, PathTask, Problem
from grashof.problems.values.dynamics.load_specs import LoadSpec

SLIDING = "slider-crank", "inverted-slider-crank"


def loaded(problem: Problem, low: float, high: float) -> Problem:
    load = LoadSpec(4, at=(0.1, 0), values=[(low, 1, 0), (high, 2, 0)], over="travel")
    return replace(problem, length_unit="m", dynamics=DynamicsSpec(loads=[load]))


@pytest.mark.slow
@pytest.mark.quick("inverted-slider-crank")
@pytest.mark.parametrize("mechanism", SLIDING)
def test_rows_that_end_too_early_are_a_defect(mechanism: str) -> None:
    for seed in range(8):
        task, linkage = planted_path(np.random.default_rng(seed), points=5, mechanism=mechanism)
        plain = Problem(task=task, mechanism=mechanism)
        verdict = verify(linkage, task, plain.requirements)
        dense = solve_kinematics(linkage, np.linspace(*motion_ends(task, verdict), 200_001)).slide
        assert dense is not None
        low, high = float(dense.travel.min()), float(dense.travel.max())
        spare = 1e-6 * task.size
        for problem, found in (
            (loaded(plain, low - spare, high + spare), []),
            (loaded(plain, low + spare, high + spare), [low]),
            (loaded(plain, low - spare, high - spare), [high]),
        ):
            judged = verify(linkage, task, problem.requirements, problem=problem)
            defects = [one for one in judged.defects if one.requirement == "loads"]
            assert [one.found for one in defects] == pytest.approx(found, abs=1e-7 * task.size)
            assert found or np.isfinite(Values(linkage, judged, problem)["torque_peak"])


@pytest.mark.quick("inverted-slider-crank")
@pytest.mark.slow
@pytest.mark.parametrize("mechanism", SLIDING)
def test_a_search_lists_designs_whose_loads_are_known(mechanism: str) -> None:
    task = PathTask([[0, 0], [60, 90], [180, 140], [300, 90], [340, 0]])
    problem = loaded(Problem(task=task, mechanism=mechanism), -1000.0, 1000.0)
    result = synthesize(problem, starts=8, enough=8)
    assert len(result)
    assert not any(np.isnan(each.values["torque_peak"]) for each in result.candidates)
    short = synthesize(loaded(problem, -1.0, 1.0), starts=4, enough=4)
    assert len(short) == 0
    assert "misses loads: the travel of the slide under loads[0]" in short.note
