"""What varies over a linkage's motion, and tables of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from grashof.analysis import (
    Dynamics,
    Joint,
    Kinematics,
    Loads,
    Masses,
    inverse_dynamics,
    solve_kinematics,
    transmission_angle,
)
from grashof.problems import LinkageSpec
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics_spec import metres

Curve = Callable[[Kinematics], FloatArray]
MAGNITUDES = {
    *(f"{point}_{what}" for point in "abp" for what in ("speed", "acceleration")),
    *("torque_factor", "f12", "f32", "f43", "f14", "shaking_force"),
}
POSITIONS = {"theta3_deg", "theta4_deg", "mu_deg", "a_x", "a_y", "b_x", "b_y", "p_x", "p_y"}


@dataclass(frozen=True, slots=True)
class Quantity:
    """Something that varies over the motion.

    Parameters
    ----------
    key, label, unit : str
    of : callable
        From a `Kinematics` to its values, in `unit`.
    period : float, optional
        By which it may jump.
    """

    key: str
    label: str
    unit: str
    of: Curve
    period: float | None = None

    @property
    def never_negative(self) -> bool:
        """Whether it is the size of something."""
        return self.key in MAGNITUDES


def kinematic_quantities(spec: LinkageSpec) -> list[Quantity]:
    """Angles, rates and points, and the torque factor of an output arm."""
    unit = spec.length_unit or "length"
    found = [
        Quantity("theta3_deg", "angle of coupler 3", "deg", lambda s: np.degrees(s.theta3), 360.0),
        Quantity("theta4_deg", "angle of output 4", "deg", lambda s: np.degrees(s.theta4), 360.0),
        Quantity("mu_deg", "transmission angle mu", "deg", _mu),
        Quantity("omega3", "angular velocity of 3", "rad/s", lambda s: s.omega3),
        Quantity("omega4", "angular velocity of 4", "rad/s", lambda s: s.omega4),
        Quantity("alpha3", "angular acceleration of 3", "rad/s2", lambda s: s.alpha3),
        Quantity("alpha4", "angular acceleration of 4", "rad/s2", lambda s: s.alpha4),
    ]
    for name in ("a", "b", "p"):
        points: tuple[tuple[str, Curve], ...] = (
            ("x", lambda s, n=name: getattr(s, n).position[..., 0]),  # type: ignore[misc]
            ("y", lambda s, n=name: getattr(s, n).position[..., 1]),  # type: ignore[misc]
        )
        found += [Quantity(f"{name}_{key}", f"{name.upper()} {key}", unit, of) for key, of in points]
        for order, (key, per) in enumerate((("velocity", "s"), ("acceleration", "s2"))):
            for axis, label in enumerate(("x", "y")):
                found.append(
                    Quantity(
                        f"{name}_{key}_{label}", f"{key} of {name.upper()}, {label}", f"{unit}/{per}",
                        lambda s, n=name, k=key, i=axis: getattr(getattr(s, n), k)[..., i],  # type: ignore[misc]
                    )
                )  # fmt: skip
            measure = ("speed", "acceleration_magnitude")[order]
            found.append(
                Quantity(
                    f"{name}_{('speed', 'acceleration')[order]}",
                    f"{('speed', 'acceleration')[order]} of {name.upper()}", f"{unit}/{per}",
                    lambda s, n=name, m=measure: getattr(getattr(s, n), m),  # type: ignore[misc]
                )
            )  # fmt: skip
    if spec.output_arm is not None:
        arm = spec.output_arm
        found.append(
            Quantity("torque_factor", "torque factor of the output arm", unit, lambda s: arm * _ratio(s))
        )
    return found


def _mu(state: Kinematics) -> FloatArray:
    return np.degrees(transmission_angle(state.linkage, state.theta2))


def _ratio(state: Kinematics) -> FloatArray:
    """Size of d theta4 / d theta2."""
    return np.abs(solve_kinematics(state.linkage, state.theta2, 1.0).omega4)


def dynamic_quantities(spec: LinkageSpec, masses: Masses, loads: Loads) -> list[Quantity]:
    """Torque, power and forces in N, N m and W, whatever the length unit."""
    metre = metres(spec.length_unit)

    def quantity(
        key: str, label: str, unit: str, of: Callable[[Dynamics], FloatArray], power: int
    ) -> Quantity:
        return Quantity(key, label, unit, lambda s: of(inverse_dynamics(s, masses, loads)) * metre**power)

    found = [
        quantity("torque", "drive torque", "N m", lambda d: d.torque, 2),
        quantity("power", "drive power", "W", lambda d: d.power, 2),
    ]
    pairs = (("O2", "f12"), ("A", "f32"), ("B", "f43"), ("O4", "f14"))
    for joint, (place, name) in zip(Joint, pairs, strict=True):
        for axis, label in enumerate(("x", "y")):
            found.append(
                quantity(
                    f"{name}_{label}", f"force {name.upper()} in {place}, {label}", "N",
                    lambda d, n=name, i=axis: getattr(d, n)[..., i], 1,  # type: ignore[misc]
                )
            )  # fmt: skip
        found.append(
            quantity(name, f"joint force in {place}", "N", lambda d, j=joint: d.joint_force(j), 1)  # type: ignore[misc]
        )
    for axis, label in enumerate(("x", "y")):
        found.append(
            quantity(
                f"shaking_force_{label}", f"shaking force, {label}", "N",
                lambda d, i=axis: d.shaking_force[..., i], 1,  # type: ignore[misc]
            )
        )  # fmt: skip
    return [
        *found,
        quantity(
            "shaking_force", "shaking force", "N", lambda d: np.hypot(*np.moveaxis(d.shaking_force, -1, 0)), 1
        ),
        quantity("shaking_moment", "shaking moment about O2", "N m", lambda d: d.shaking_moment, 2),
    ]


def table_of(quantities: list[Quantity], states: list[Kinematics]) -> pd.DataFrame:
    """A row for each driver angle; empty where a quantity has no finite value."""
    parts = []
    for number, state in enumerate(states, start=1):
        columns = {
            "theta2_deg": np.round(np.degrees(state.theta2), 12),
            "omega2": state.omega2 + np.zeros(state.shape),
        }
        if len(states) > 1:
            columns = {"range": np.full(state.shape, number), **columns}
        for quantity in quantities:
            values = np.asarray(quantity.of(state), dtype=np.float64)
            if quantity.period is not None:
                values = _counted_on(values, quantity.period)
            columns[quantity.key] = np.where(np.isfinite(values), values, np.nan)
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def _counted_on(values: FloatArray, period: float) -> FloatArray:
    known = np.isfinite(values)
    values = values.copy()
    values[known] = np.unwrap(values[known], period=period)
    least = np.min(values[known], initial=np.inf)  # counted so that the least lies in half a period of 0
    return values - period * np.floor((least + period / 2) / period) if known.any() else values
