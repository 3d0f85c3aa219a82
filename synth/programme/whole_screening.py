"""Violations that take the whole problem: areas and limits of the motion, the user's constraints."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.programme.user_functions import own_violations
from grashof.synth.quantities.along_motion import ALONG, SCREENED, magnitudes, value_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS, Screened


def fully_screened(scaled: ScaledProblem, linkages: Screened) -> Screened:
    """The same with these violations, too."""
    wanted = scaled.wanted
    along = [name for name in wanted.limited if LIMITS[name].quantity.key in ALONG]
    if not len(linkages) or not (along or wanted.size or scaled.constraints or wanted.keep_out):
        return linkages
    violations = linkages.violations.copy()
    if wanted.keep_out:
        # Here, not above: shapely takes a while to import, and few problems have areas.
        from grashof.synth.quantities.keep_out_motion import depth_on_the_way

        sound = linkages.feasible  # the others need not be looked at so closely
        violations[sound, GROUPS.index("keep_out")] = depth_on_the_way(scaled, linkages[sound])
    if wanted.size is not None:
        size = _sizes(linkages, len(scaled.kind.linkage.mechanism.ground))
        low, high = wanted.size
        violations[:, GROUPS.index("size")] = np.maximum(np.maximum(low - size, size - high), 0.0)
    for name in along:
        violations[:, GROUPS.index(name)] = _beyond(scaled, linkages, name)
    if scaled.constraints:
        violations[:, GROUPS.index("constraints")] += own_violations(scaled, linkages)
    return replace(linkages, violations=violations)


def _sizes(linkages: Screened, ground: int) -> FloatArray:
    """Diagonals of boxes around the pivots and the coupler point at all targets, shape (n,), sizes."""
    places = np.concatenate([linkages.points[:, :ground], *linkages.track], axis=1)
    diagonal: FloatArray = np.hypot(np.ptp(places.real, axis=1), np.ptp(places.imag, axis=1))
    return diagonal


def _beyond(scaled: ScaledProblem, linkages: Screened, name: str) -> FloatArray:
    """By how much the greatest magnitude exceeds its limit, as a share of it; (n,)."""
    quantity = LIMITS[name].quantity
    low, high = scaled.problem.requirements.ranges(name)[""]
    ways = linkages.theta2, linkages.direction, linkages.assembly
    peak = magnitudes(scaled, quantity.key, linkages.points, *ways, SCREENED).max(axis=1)
    value = value_of(quantity.key, peak) * scaled.problem.scale(quantity)
    share = np.maximum(low - value, value - high) / (high if np.isfinite(high) else max(low, 1.0))
    amount: FloatArray = np.maximum(np.nan_to_num(share, posinf=FAR), 0.0)
    return amount


FAR = 1e3  # stands for an amount without bound
