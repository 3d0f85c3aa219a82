"""What the designs of a function are told to be best at."""

from dataclasses import replace

import numpy as np

from grashof.analysis import verify
from grashof.analysis.judge.planted import planted_function
from grashof.problems import Problem, Requirements
from grashof.synth import Candidate
from grashof.synth.results.function_list import named


def test_errors_of_rounding_are_all_the_least() -> None:
    task, linkage, _ = planted_function(np.random.default_rng(1), 5)
    problem = Problem(task=task, requirements=Requirements(exact=False))
    verdict = verify(linkage, task, problem.requirements)

    def name(error: float, least: float) -> str:
        design = Candidate(
            linkage, replace(verdict, square=error**2 * len(task)), problem, 0, 0, best_at="least error"
        )
        assert abs(design.error(problem) - error) < 1e-12 * error
        return named(design, problem, least, task.output_unit).best_at

    assert name(3e-16, 1e-16) == name(5e-10, 1e-16) == "least error"
    assert name(2e-4, 1.9e-4) == name(2e-9, 1e-16) == "least error nearby"
    assert name(2e-4, 1.9999e-4) == "least error"
