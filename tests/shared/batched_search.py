"""Shared by tests of the batched search: limits that bind nothing, points at random, central differences."""

from dataclasses import replace
from typing import Any

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import Batch
from grashof.synth.starts.coupler_search import search
from grashof.synth.starts.loop_search import Model

GENEROUS: dict[str, Any] = {
    "link_length": (1e-7, 1e7),
    "link_ratio_max": 1e6,
    "coupler_arms": (0.0, 1e7),
    "rotatability_margin": 0.0,
}


def points_along(along: FloatArray, rng: np.random.Generator) -> ComplexArray:
    """Points at random along a curve, none of them special."""
    off: ComplexArray = rng.normal(0, 0.1, (len(along), 2)) @ np.array([1, 1j])
    return np.exp(0.7j * along) * (1 + 0.2 * along) + off


def differences(model: Model, batch: Batch, of: int) -> FloatArray:
    """Central differences of part `of` of a model by every unknown, unknowns last."""
    step, columns = 1e-6, []
    for change in step * np.eye(batch.unknowns.shape[1]):
        ahead, behind = (model(replace(batch, unknowns=batch.unknowns + s * change))[of] for s in (1, -1))
        columns.append((ahead - behind) / (2 * step))
    return np.stack(columns, axis=-1)


def least_found(scaled: ScaledProblem, good: float) -> float:
    """The least error of a few rounds of the search, which end with one below `good`; sizes."""
    rng, least = np.random.default_rng(0), np.inf
    for _ in range(4):
        least = min(least, search(scaled, 1, rng).error.min(initial=np.inf))
        if least < good:
            break
    return least
