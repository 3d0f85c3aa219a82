"""Shared by tests of the batched search: limits that bind nothing, points at random, central differences."""

from dataclasses import replace
from typing import Any

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.starts.closed_loop import Batch, SearchTargets
from grashof.synth.starts.loop_search import fitting

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


def differences(target: SearchTargets, batch: Batch, of: int) -> FloatArray:
    """Central differences of part `of` of the linearisation by every unknown, unknowns last."""
    step, columns = 1e-6, []
    for change in step * np.eye(batch.unknowns.shape[1]):
        ahead, behind = (
            fitting(target)(replace(batch, unknowns=batch.unknowns + s * change))[of] for s in (1, -1)
        )
        columns.append((ahead - behind) / (2 * step))
    return np.stack(columns, axis=-1)
