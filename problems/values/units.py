"""Units of quantities."""

from __future__ import annotations

from enum import StrEnum

import numpy as np

from grashof.problems.values.arrays import Limits


class Unit(StrEnum):
    """Units of quantities: lengths in the problem's unit, angles in rad, in files in deg."""

    LENGTH = "length"
    AREA = "length²"
    ANGLE = "deg"
    RATIO = ""
    SHARE = "share"
    TORQUE = "N m"
    FORCE = "N"
    ANGULAR_VELOCITY = "rad/s"
    ANGULAR_ACCELERATION = "rad/s²"
    VELOCITY = "length/s"
    ACCELERATION = "length/s²"

    @property
    def lengths(self) -> int:
        """Power of the length in it; torques and forces come in metres."""
        return {"length²": 2}.get(self, int(self.startswith("length")))

    @property
    def shown(self) -> float:
        """Factor from values inside to those in files and tables."""
        return float(np.degrees(1.0)) if self is Unit.ANGLE else 1.0

    def range_text(self, limits: Limits) -> str:
        """Limits as files state them: "0.3 to 8", "from 15", "up to 20"; empty where none are.

        >>> Unit.LENGTH.range_text((0.3, 8.0)), Unit.ANGLE.range_text((0.0, np.inf))
        ('0.3 to 8', 'from 0')
        """
        low, high = (f"{side * self.shown:.6g}" for side in limits)
        if np.isinf(limits[0]):
            return "" if np.isinf(limits[1]) else f"up to {high}"
        if np.isinf(limits[1]):
            return f"from {low}"
        return low if low == high else f"{low} to {high}"

    def of(self, length_unit: str) -> str:
        """The unit with the problem's own unit of length in it, where that has a name."""
        return self.replace("length", length_unit or "length")
