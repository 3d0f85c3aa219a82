"""Quantities that vary over the motion of a linkage, and tables of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache, partial
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from grashof.analysis import Kinematics, inverse_dynamics, solve_kinematics, transmission_angle
from grashof.analysis.mechanism.transmission import quality
from grashof.problems import LinkageSpec
from grashof.problems.values.arrays import FloatArray
from grashof.study.kinds import force_key, forces_of, turning
from grashof.study.study import LinkageStudy

if TYPE_CHECKING:
    import pandas as pd

Curve = Callable[[Kinematics], FloatArray]
_DEAD = 1e-7  # rad: transmission angle that rounding of the driver angle leaves in a dead position


@dataclass(frozen=True, slots=True)
class Quantity:
    """A quantity that varies over the motion.

    Parameters
    ----------
    key, label, unit : str
    of : callable
        From a `Kinematics` to its values, in `unit`.
    period : float, optional
        Period of an angle, by which it may jump.
    position : bool
        It depends on the position alone, and stays finite towards a dead position.
    never_negative : bool
        It is a magnitude.
    mu_of : int, optional
        It is the transmission angle of this loop.
    """

    key: str
    label: str
    unit: str
    of: Curve
    period: float | None = None
    position: bool = False
    never_negative: bool = False
    mu_of: int | None = None


def kinematic_quantities(spec: LinkageSpec) -> list[Quantity]:
    """Angles, rates and points, and the torque factor of an output arm."""
    unit, kind = spec.unit, spec.linkage.mechanism
    driven = turning(kind)
    found = [
        Quantity(f"theta{n}_deg", f"angle of {name} {n}", "deg", _degrees(f"theta{n}"), 360.0, position=True)
        for n, name in driven.items()
    ]
    found += [_transmission(loop) for loop in range(1, len(kind.dyads) + 1)]
    found += [
        Quantity(f"{key}{n}", f"angular {rate} of {n}", per, attrgetter(f"{key}{n}"))
        for key, rate, per in (("omega", "velocity", "rad/s"), ("alpha", "acceleration", "rad/s2"))
        for n in driven
    ]
    if kind.slides:
        part = partial(_part_of, attrgetter("slide"))
        found.append(Quantity("slide_travel", "travel of the slide", unit, part("travel"), position=True))
        found += [
            Quantity(f"slide_{rate}", f"{rate} of the slide", f"{unit}{per}", part(rate))
            for rate, per in (("velocity", "/s"), ("acceleration", "/s2"))
        ]
    for name in kind.moving:
        point, moves = name.upper(), lru_cache(maxsize=2)(attrgetter(name))
        place = _part_of(moves, "position")
        found += [
            Quantity(f"{name}_{axis}", f"{point} {axis}", unit, _component(place, axis), position=True)
            for axis in "xy"
        ]
        for rate, size, per in (("velocity", "speed", "s"), ("acceleration", "acceleration", "s2")):
            vector, keys = _part_of(moves, rate), (f"{name}_{rate}", f"{name}_{size}")
            found += _vector(keys, (f"{rate} of {point}", f"{size} of {point}"), f"{unit}/{per}", vector)
    if spec.output_arm is not None:
        arm, label = spec.output_arm, "torque factor of the output arm"
        signed = "torque factor, + where 4 turns with 2"
        found += [
            Quantity("torque_factor", label, unit, lambda s: arm * np.abs(_ratio(s)), never_negative=True),
            Quantity("torque_factor_signed", signed, unit, lambda s: arm * _ratio(s)),
        ]
    return found


def dynamic_quantities(study: LinkageStudy) -> list[Quantity]:
    """Torque, power and forces in N m, W and N, whatever the length unit; empty without masses or loads."""
    masses = study.masses
    if masses is None:
        return []
    metre, loads = study.metre, study.loads

    solved = lru_cache(maxsize=2)(lambda s: inverse_dynamics(s, masses, loads))
    of = partial(_part_of, solved)

    def force(joint: int) -> Curve:
        return lambda s: np.asarray(solved(s).forces[joint])

    def moment(key: str, label: str, unit: str) -> Quantity:
        return Quantity(key, label, unit, lambda s: of(key)(s) * metre**2)

    found = [moment("torque", "drive torque", "N m"), moment("power", "drive power", "W")]
    kind = study.linkage.mechanism
    numbers = {force_key(joint.links): number for number, joint in enumerate(kind.every_joint)}
    for key, joint in forces_of(kind).items():
        labels = (f"force {key.upper()} in {joint}", f"joint force in {joint}")
        found += _vector((key, key), labels, "N", force(numbers[key]), metre)
    if kind.slides:
        across = of("slide_force")
        found.append(Quantity("slide_force", "force across the slide", "N", lambda s: across(s) * metre))
        found.append(moment("slide_moment", "moment that the slide bears", "N m"))
    keys, labels = ("shaking_force", "shaking_force"), ("shaking force", "shaking force")
    found += _vector(keys, labels, "N", of("shaking_force"), metre)
    return [*found, moment("shaking_moment", "shaking moment about O2", "N m")]


def _vector(
    keys: tuple[str, str], labels: tuple[str, str], unit: str, of: Curve, factor: float = 1.0
) -> list[Quantity]:
    """Components and size of a vector, with the keys and labels of both."""
    components = [
        Quantity(f"{keys[0]}_{axis}", f"{labels[0]}, {axis}", unit, _component(of, axis, factor))
        for axis in "xy"
    ]

    def size(state: Kinematics) -> FloatArray:
        vector = of(state)
        return np.hypot(vector[..., 0], vector[..., 1]) * factor

    return [*components, Quantity(keys[1], labels[1], unit, size, never_negative=True)]


def _part_of(solve: Callable[[Kinematics], object], name: str) -> Curve:
    return lambda s: np.asarray(getattr(solve(s), name))


def _component(of: Curve, axis: str, factor: float = 1.0) -> Curve:
    return lambda s: of(s)[..., "xy".index(axis)] * factor


def _degrees(angle: str) -> Curve:
    return lambda s: np.degrees(getattr(s, angle))


def _transmission(loop: int) -> Quantity:
    """The transmission angle of a loop."""
    ending, where = ("", "") if loop == 1 else (f"_{loop}", f" of loop {loop}")

    def values(state: Kinematics) -> FloatArray:
        mu = transmission_angle(state.linkage, state.theta2, loop)
        return np.degrees(np.where(quality(mu) <= _DEAD, np.where(mu < 1, 0.0, np.pi), mu))

    label = f"transmission angle mu{where}"
    return Quantity(f"mu{ending}_deg", label, "deg", values, position=True, mu_of=loop)


def _ratio(state: Kinematics) -> FloatArray:
    """Derivative of theta4 by theta2."""
    return solve_kinematics(state.linkage, state.theta2, 1.0).omega4


def table_of(quantities: list[Quantity], states: list[Kinematics]) -> pd.DataFrame:
    """A row for each driver angle; empty where a quantity has no finite value."""
    import pandas as pd  # takes as long as all other modules of a drawing

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
                values = counted_on(values, quantity.period)
            columns[quantity.key] = np.where(np.isfinite(values), values, np.nan)
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def by_range(table: pd.DataFrame, name: str) -> FloatArray:
    """A column of a table over the driver angle, with NaN between two ranges, so that lines break."""
    values = table[name].to_numpy(dtype=np.float64)
    if "range" not in table:
        return values
    return np.insert(values, np.flatnonzero(np.diff(table["range"])) + 1, np.nan)


def counted_on(values: FloatArray, period: float) -> FloatArray:
    """Angles along a motion without jumps, the least of them within half a period of zero."""
    known = np.isfinite(values)
    values = values.copy()
    values[known] = np.unwrap(values[known], period=period)
    least = np.min(values[known], initial=np.inf)
    return values - period * np.floor((least + period / 2) / period) if known.any() else values


def counted_with(angle: float, swings: Iterable[tuple[float, float]], period: float) -> float:
    """An angle shifted by full periods into the nearest of some swings, each from least to largest."""
    middles = [(low + high) / 2 for low, high in swings]
    near = [angle + period * round((middle - angle) / period) for middle in middles]
    return min(near, key=lambda each: min(abs(each - middle) for middle in middles), default=angle)
