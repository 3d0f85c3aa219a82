"""Least and largest values over a linkage's motion, to rounding."""

from __future__ import annotations

import numpy as np
import pandas as pd

from grashof.analysis import extremes_of, transmission_angle
from grashof.problems import AssemblyError, FourBar
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.study.quantities import Quantity
from grashof.study.sweep import INSET, Sweep

_WIDE_INSET = 1e-4  # rad: extremes of rates are sought so far from a dead position of a change point
_CONSTANT = 1e-12  # least and largest values apart, as a share: the quantity is constant


def _listed(quantity: Quantity) -> bool:
    """Extremes are listed of every quantity but the components of vectors that have a size."""
    return quantity.position or not quantity.key.endswith(("_x", "_y"))


def extremes_table(sweep: Sweep, quantities: list[Quantity]) -> pd.DataFrame:
    """A row for each quantity: least and largest value, and the driver angles of both.

    The angles are NaN where the quantity is constant.
    """
    rows = []
    for number, (low, high) in enumerate(sweep.ranges, start=1):
        for quantity in filter(_listed, quantities):
            found = _extreme(sweep, quantity, low, high)
            named = {"quantity": quantity.key, "what": quantity.label, "unit": quantity.unit}
            rows.append({"range": number, **named, **found})
    table = pd.DataFrame(rows)
    return table if len(sweep.ranges) > 1 else table.drop(columns="range")


def _extreme(sweep: Sweep, quantity: Quantity, low: float, high: float) -> dict[str, float]:
    """Least and largest value, infinite where it grows without bound towards a dead position."""

    def curve(theta2: FloatArray) -> FloatArray:
        return np.asarray(quantity.of(sweep.state(theta2)), dtype=np.float64)

    # A rate tends to infinity towards a dead position; at a change point, which is left as it is
    # entered, to a finite value that rounding hides.
    still = sweep.turns or quantity.position
    passes = [_passes(sweep.spec.linkage, limit, sense) for limit, sense in ((low, 1), (high, -1))]
    insets = [0.0 if still else _WIDE_INSET if through else INSET for through in passes]
    start, end = low + insets[0], high - insets[1]
    try:
        found = extremes_of(curve, start, end, sweep.turns, quantity.period)
    except AssemblyError:  # rounding at the very end of a range
        try:
            found = extremes_of(curve, low + INSET, high - INSET, sweep.turns, quantity.period)
        except AssemblyError:
            return dict.fromkeys(("min", "theta2_min_deg", "max", "theta2_max_deg"), np.nan)
    least, largest = found.low, found.high
    if quantity.period is not None:
        turned = quantity.period * np.floor((least + quantity.period / 2) / quantity.period)
        least, largest = least - turned, largest - turned
    if quantity.never_negative:
        usual = np.median(curve(np.linspace(start, end, 101)))
        least = 0.0 if least < 1e-7 * usual else least  # a size that goes through 0
    extremes: dict[str, float] = {}
    for name, value, at in (("min", least, found.at_low), ("max", largest, found.at_high)):
        for near, limit, sense, through in ((start, low, 1, passes[0]), (end, high, -1, passes[1])):
            if not still and abs(at - near) < 1e-9:
                closer = float(curve(np.array([limit + sense * INSET / 16]))[0])
                at = limit
                if not through and abs(closer) > 1.5 * abs(value):
                    value = np.copysign(np.inf, value)
        if sweep.turns:
            at = at % TURN if TURN - at % TURN > 1e-9 else 0.0
        extremes |= {name: float(value), f"theta2_{name}_deg": float(np.round(np.degrees(at), 9) + 0.0)}
    if np.isclose(least, largest, rtol=_CONSTANT, atol=0.0):  # rounding alone would choose the angles
        extremes |= dict.fromkeys(("theta2_min_deg", "theta2_max_deg"), np.nan)
    return extremes


def _passes(linkage: FourBar, limit: float, sense: int) -> bool:
    """Whether sin(mu) goes to 0 in proportion to the driver angle left, and not like its root."""
    near = limit + sense * np.array([_WIDE_INSET, _WIDE_INSET / 4])
    far, close = np.sin(transmission_angle(linkage, near))
    return bool(far > 3 * close)
