"""The judge's checks of lengths, places and angles against their limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.four_bar.position import Position
from grashof.analysis.judge.task_motion import Targets
from grashof.problems import Box, FourBar, Requirements, Task
from grashof.problems.values.arrays import Limits

# Limits are inclusive; rounding may carry a design this far past them (sizes, rad or ratio).
SLACK = 1e-9


@dataclass(frozen=True, slots=True)
class Defect:
    """One requirement that a design misses.

    Parameters
    ----------
    requirement : str
        Its key; "exact" for targets that are not met.
    what : str
        The quantity judged, such as "r3".
    found : float
        Its value, as tables print it (degrees for angles).
    allowed : str
    miss : float
        By how much it is missed: share of the size, rad, or ratio.
    """

    requirement: str
    what: str
    found: float
    allowed: str
    miss: float

    def __str__(self) -> str:
        return f"{self.requirement}: {self.what} is {self.found:.6g}, allowed is {self.allowed}"


def geometry(linkage: FourBar, task: Task, wanted: Requirements) -> list[Defect]:
    """Links, coupler arms and the link ratio that are out of their limits."""
    defects = []
    for name, value, limits in zip(
        ("r1", "r2", "r3", "r4"), linkage.lengths, wanted.link_lengths, strict=True
    ):
        key = "link_length" if getattr(wanted, name) is None else name
        defects += _within(key, name, float(value), limits, task.size)
    arm = complex(*linkage.coupler_point)
    for name, value in (("A-P", abs(arm)), ("B-P", abs(arm - complex(linkage.r3)))):
        defects += _within("coupler_arms", name, value, wanted.coupler_arms, task.size)
    shortest = float(linkage.lengths.min())
    ratio = float(linkage.lengths.max()) / shortest if shortest > 0 else np.inf
    if ratio > wanted.link_ratio_max * (1 + SLACK):
        miss = ratio / wanted.link_ratio_max - 1
        allowed = f"up to {wanted.link_ratio_max:g}"
        defects.append(Defect("link_ratio_max", "longest to shortest link", ratio, allowed, miss))
    return defects


def places(linkage: FourBar, state: Position, task: Task, wanted: Requirements) -> list[Defect]:
    """Pivots outside their boxes, the moving ones at any target."""
    defects = []
    pivots = {
        "o2": linkage.o2[None], "o4": linkage.o4[None], "a": state.a, "b": state.b,
    }  # fmt: skip
    for name, points in pivots.items():
        box: Box = getattr(wanted, name) or Box()
        for axis, limits in enumerate((box.x, box.y)):
            values = points[:, axis]
            for value in (values.min(), values.max()):
                found = _within(name, f"{name}.{'xy'[axis]}", float(value), limits, task.size)
                if found and found[0] not in defects:
                    defects += found
    return defects


def angles(linkage: FourBar, targets: Targets, wanted: Requirements) -> list[Defect]:
    """Prescribed angles that are missed."""
    defects = []
    for key, angle in (("ground_angle_deg", linkage.theta1), ("theta2_start_deg", targets.theta2[0])):
        value = getattr(wanted, key)
        if value is not None:
            miss = float(np.abs(np.angle(np.exp(1j * (angle - np.radians(value))))))
            if miss > SLACK:
                found = float(np.degrees(angle))
                defects.append(Defect(key, "the angle in deg", found, f"{value:g}", miss))
    return defects


def _within(key: str, what: str, value: float, limits: Limits | None, size: float) -> list[Defect]:
    low, high = limits if limits is not None else (-np.inf, np.inf)
    miss = max(low - value, value - high) / size
    if not miss > SLACK:  # NaN where the linkage does not close, which "exact" tells
        return []
    return [Defect(key, what, value, _range(low, high), miss)]


def _range(low: float, high: float) -> str:
    if low == -np.inf:
        return f"up to {high:.6g}"
    return f"from {low:.6g}" if high == np.inf else f"{low:.6g} to {high:.6g}"
