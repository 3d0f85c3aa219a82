"""The luggage problem under other limits, for proofs."""

from dataclasses import replace

import numpy as np

from grashof import load
from grashof.problems import Problem

STAIRS = np.array([[0, -9], [0, 0], [5, 0], [5, 4], [9, 4], [9, -9]], dtype=np.float64)


def luggage(**requirements: object) -> Problem:
    problem = load("luggage")
    wanted = {"transmission_min_deg": 0.0, **requirements}
    return replace(problem, requirements=replace(problem.requirements, **wanted))  # type: ignore[arg-type]


def with_links(longest: float, **requirements: object) -> Problem:
    return luggage(link_length=(0.3, longest), coupler_arms=(0.3, longest), **requirements)
