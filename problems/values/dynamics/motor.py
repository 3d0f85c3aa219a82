"""The drive of a linkage: speed profile, gear and motor."""

from __future__ import annotations

from dataclasses import dataclass

from grashof.problems.values.checks import Rows, from_zero, positive_bounded, rising_rows, within
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.value_bases import TableValue, check_fields, set_fields

PROFILES = ("constant", "trapezoid", "cycloid")
_RAMP = 1 / 3


@dataclass(frozen=True, slots=True)
class MotorSpec(TableValue):
    """The drive of link 2.

    `ProblemError` for an unknown profile, numbers outside their ranges, or values that do not rise.

    Parameters
    ----------
    profile : str
        "constant"; "trapezoid": from rest at even acceleration, then at even speed, then to rest; or
        "cycloid": from rest to rest without a jump of acceleration (Norton, *Design of Machinery*,
        sec. 8.3). Over a task from its first target to its last, of a linkage over each turn, or from one
        dead position to the other; `speed_rpm` is the mean.
    ramp : float
        Of a trapezoid: share of the time that it takes to speed up, and to slow down, 0.01 to 0.5.
    values : sequence of rows, optional
        Instead of a profile: (time in s, angle in deg), both rising: their curve, its angles stretched to the
        motion. Its time counts, not `speed_rpm`.
    gear_ratio : float
        Speed of the motor over that of link 2.
    gear_efficiency : float
        Of the gear, 0.01 to 1.
    inertia : float, kg m^2
        Of the motor.
    """

    profile: str = "constant"
    ramp: float = _RAMP
    values: Rows | None = None
    gear_ratio: float = 1.0
    gear_efficiency: float = 1.0
    inertia: float = 0.0

    def __post_init__(self) -> None:
        if self.profile not in PROFILES:
            raise wrong_value("profile", self.profile, f"{', '.join(PROFILES)}, or the name of a CSV file")
        check_fields(
            self,
            ramp=within(0.01, 0.5),
            gear_ratio=positive_bounded,
            gear_efficiency=within(0.01, 1.0),
            inertia=from_zero,
        )
        if self.ramp != _RAMP and self.profile != "trapezoid":
            raise ProblemError('ramp does not go with this profile; it needs profile = "trapezoid"')
        if self.values is not None:
            if self.profile != "constant":
                raise ProblemError("profile is given besides values; give one of them")
            rows = rising_rows(self.values, 2, "[time, angle]", ("time", "angle"), least="three")
            set_fields(self, values=rows)

    @property
    def steady(self) -> bool:
        """Whether link 2 turns at a steady speed."""
        return self.profile == "constant" and self.values is None
