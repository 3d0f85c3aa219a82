"""What `grashof analyse` finds out about one linkage: tables over the motion, extremes, a summary."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pandas as pd

from grashof.analysis import (
    Dynamics,
    GrashofClass,
    Joint,
    Kinematics,
    Loads,
    Masses,
    coupler_fit_r2,
    coupler_fourier,
    cusps,
    double_points,
    driver_ranges,
    extremes_of,
    full_rotation,
    given_masses,
    grashof_class,
    inverse_dynamics,
    output_stroke,
    reach_box,
    rotatability,
    solve_kinematics,
    straightness,
    system_centre,
    transmission_angle,
    triple_rocker_kind,
    uniform_bars,
    worst_transmission,
)
from grashof.problems import AssemblyError, DeadPositionWarning, LinkageSpec, ProblemError
from grashof.problems.checks import FloatArray
from grashof.problems.linkage_file import METRES

TURN = 2 * np.pi
_INSET = 1e-6  # rad: extremes of rates are sought so far from a dead position
_WIDE_INSET = 1e-4  # rad: the same of a change point
_DEAD = 1e-7  # sin(theta4 - theta3), as `solve_kinematics` counts it
_STEPS = 360
_HARMONICS = 5
Curve = Callable[[Kinematics], FloatArray]


@dataclass(frozen=True, slots=True)
class Fact:
    """One line of the summary.

    Parameters
    ----------
    key : str
        Its name in files.
    label : str
        What people read.
    value : float, int, str or bool
    unit : str
    """

    key: str
    label: str
    value: float | int | str | bool
    unit: str = ""


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
        return self.key in _MAGNITUDES


@dataclass(frozen=True, slots=True, eq=False)
class LinkageReport:
    """All that is told of a linkage.

    Parameters
    ----------
    spec : LinkageSpec
    speed_rpm : float
        Of the driver.
    ranges : tuple of pairs of float, rad
        Of the driver: one whole turn, or those between dead positions.
    masses : Masses, optional
    facts : tuple of Fact
    tables : mapping of str to DataFrame
        "kinematics" and, with masses, "dynamics": a row for each driver angle; "extremes".
    notes : tuple of str
        What a reader has to know about limits.
    """

    spec: LinkageSpec
    speed_rpm: float
    ranges: tuple[tuple[float, float], ...]
    turns: bool
    masses: Masses | None
    facts: tuple[Fact, ...]
    tables: Mapping[str, pd.DataFrame]
    notes: tuple[str, ...]

    @property
    def unit(self) -> str:
        """Length unit, or the word length where the file names none."""
        return self.spec.length_unit or "length"


def report_on(spec: LinkageSpec, speed_rpm: float | None = None) -> LinkageReport:
    """Analyse a linkage over all that its driver can do on its own assembly.

    Parameters
    ----------
    spec : LinkageSpec
    speed_rpm : float, optional
        Of the driver, counter-clockwise; by default that of the file, or else 1 rad/s.

    Returns
    -------
    LinkageReport

    Raises
    ------
    ProblemError
        The linkage closes at no driver angle, or a speed that is not finite.
    """
    given = spec.dynamics
    if speed_rpm is None:
        speed_rpm = given.speed_rpm if given is not None and given.speed_rpm is not None else 60 / TURN
    if not np.isfinite(speed_rpm):
        raise ProblemError(f"speed_rpm is {speed_rpm}; allowed are finite numbers")
    masses = _masses(spec)
    ranges, turns = _ranges(spec)
    with _quiet():
        states = [_state(spec, angles, speed_rpm) for angles in _angles(ranges, turns)]
        quantities = _kinematic(spec)
        tables = {"kinematics": _table(quantities, states, ranges)}
        loads = _loads(spec)
        if masses is not None:
            dynamic = _dynamic(spec, masses, loads)
            tables["dynamics"] = _table(dynamic, states, ranges)
            quantities = [*quantities, *dynamic]
        tables["extremes"] = _extremes(spec, quantities, ranges, turns, speed_rpm)
        facts = tuple(_facts(spec, ranges, turns, masses, tables, speed_rpm))
        notes = _notes(spec, ranges, turns)
    return LinkageReport(spec, speed_rpm, ranges, turns, masses, facts, tables, notes)


@contextmanager
def _quiet() -> Iterator[None]:
    """Dead positions are told in a note, not as warnings."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore", DeadPositionWarning)
        yield


def _masses(spec: LinkageSpec) -> Masses | None:
    given = spec.dynamics
    if given is None or not given.has_masses:
        return None
    if given.masses is not None and given.inertias is not None:
        masses = given_masses(spec.linkage, given.masses, given.inertias)
        return masses.with_payload(given.payload, spec.linkage.coupler_point) if given.payload else masses
    return uniform_bars(spec.linkage, given.mass_per_length or 0.0, given.payload)


def _loads(spec: LinkageSpec) -> Loads:
    given = spec.dynamics
    if given is None or spec.length_unit not in METRES:
        return Loads()
    return Loads(gravity=np.array(given.gravity) / METRES[spec.length_unit])


def _ranges(spec: LinkageSpec) -> tuple[tuple[tuple[float, float], ...], bool]:
    """Ranges of the driver between dead positions, and whether it turns fully without one."""
    linkage = spec.linkage
    if full_rotation(linkage):
        return ((0.0, TURN),), True
    found: list[tuple[float, float]] = []
    for low, high in driver_ranges(linkage):
        if np.isnan(low):
            continue
        # At a change point dead positions lie inside a range too, on the ground line.
        inside = float(linkage.theta1) + np.pi * np.arange(-1, 4)
        sine = np.sin(transmission_angle(linkage, inside))
        dead = (inside > low + 1e-9) & (inside < high - 1e-9) & ~(np.abs(sine) > _DEAD)
        ends = [float(low), *(float(angle) for angle in inside[dead]), float(high)]
        found += [(a, b) for a, b in pairwise(ends) if b - a > 4 * _INSET]
    if not found:
        raise ProblemError(f"{spec.name}: the linkage closes at no driver angle, so it has no motion")
    return tuple(found), False


def _angles(ranges: tuple[tuple[float, float], ...], turns: bool) -> Iterator[FloatArray]:
    for low, high in ranges:
        share = np.linspace(0, 1, _STEPS + 1)
        if not turns:  # closer towards dead positions, where the linkage runs away from its driver
            share = (1 - np.cos(np.pi * share)) / 2
        angles = low + (high - low) * share
        angles[-1] = high
        yield angles


def _state(spec: LinkageSpec, theta2: FloatArray, speed_rpm: float) -> Kinematics:
    return solve_kinematics(spec.linkage, theta2, speed_rpm * TURN / 60)


def _kinematic(spec: LinkageSpec) -> list[Quantity]:
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


def _dynamic(spec: LinkageSpec, masses: Masses, loads: Loads) -> list[Quantity]:
    """In N, N m and W, whatever the length unit."""
    metres = METRES[spec.length_unit]

    def quantity(
        key: str, label: str, unit: str, of: Callable[[Dynamics], FloatArray], power: int
    ) -> Quantity:
        return Quantity(key, label, unit, lambda s: of(inverse_dynamics(s, masses, loads)) * metres**power)

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


def _table(
    quantities: list[Quantity], states: list[Kinematics], ranges: tuple[tuple[float, float], ...]
) -> pd.DataFrame:
    """A row for each driver angle; empty where a quantity has no finite value."""
    parts = []
    for number, state in enumerate(states, start=1):
        columns = {
            "theta2_deg": np.round(np.degrees(state.theta2), 12),
            "omega2": state.omega2 + np.zeros(state.shape),
        }
        if len(ranges) > 1:
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


_MAGNITUDES = {
    *(f"{point}_{what}" for point in "abp" for what in ("speed", "acceleration")),
    *("torque_factor", "f12", "f32", "f43", "f14", "shaking_force"),
}
_POSITIONS = {"theta3_deg", "theta4_deg", "mu_deg", "a_x", "a_y", "b_x", "b_y", "p_x", "p_y"}


def _listed(quantity: Quantity) -> bool:
    """Extremes are told of every quantity but the components of vectors that have a size."""
    return quantity.key in _POSITIONS | _MAGNITUDES or not quantity.key.endswith(("_x", "_y"))


def _extremes(
    spec: LinkageSpec,
    quantities: list[Quantity],
    ranges: tuple[tuple[float, float], ...],
    turns: bool,
    speed_rpm: float,
) -> pd.DataFrame:
    rows = []
    for number, (low, high) in enumerate(ranges, start=1):
        for quantity in filter(_listed, quantities):
            found = _extreme(spec, quantity, low, high, turns, speed_rpm)
            named = {"quantity": quantity.key, "what": quantity.label, "unit": quantity.unit}
            rows.append({"range": number, **named, **found})
    table = pd.DataFrame(rows)
    return table if len(ranges) > 1 else table.drop(columns="range")


def _extreme(
    spec: LinkageSpec, quantity: Quantity, low: float, high: float, turns: bool, speed_rpm: float
) -> dict[str, float]:
    """Least and largest value, infinite where it grows without bound towards a dead position."""

    def curve(theta2: FloatArray) -> FloatArray:
        return np.asarray(quantity.of(_state(spec, theta2, speed_rpm)), dtype=np.float64)

    # A rate tends to infinity towards a dead position; at a change point, which is left as it is
    # entered, to a finite value that rounding hides.
    still = turns or quantity.key in _POSITIONS
    passes = [_passes(spec, limit, sense) for limit, sense in ((low, 1), (high, -1))]
    insets = [0.0 if still else _WIDE_INSET if through else _INSET for through in passes]
    start, end = low + insets[0], high - insets[1]
    try:
        found = extremes_of(curve, start, end, turns, quantity.period)
    except AssemblyError:  # rounding at the very end of a range
        try:
            found = extremes_of(curve, low + _INSET, high - _INSET, turns, quantity.period)
        except AssemblyError:
            return dict.fromkeys(("min", "theta2_min_deg", "max", "theta2_max_deg"), np.nan)
    least, largest = found.low, found.high
    if quantity.period is not None:
        turned = quantity.period * np.floor((least + quantity.period / 2) / quantity.period)
        least, largest = least - turned, largest - turned
    if quantity.never_negative:
        usual = np.median(curve(np.linspace(start, end, 101)))
        least = 0.0 if least < 1e-7 * usual else least  # a size that goes through 0
    told: dict[str, float] = {}
    for name, value, at in (("min", least, found.at_low), ("max", largest, found.at_high)):
        for near, limit, sense, through in ((start, low, 1, passes[0]), (end, high, -1, passes[1])):
            if not still and abs(at - near) < 1e-9:
                closer = float(curve(np.array([limit + sense * _INSET / 16]))[0])
                at = limit
                if not through and abs(closer) > 1.5 * abs(value):
                    value = np.copysign(np.inf, value)
        if turns:
            at = at % TURN if TURN - at % TURN > 1e-9 else 0.0
        told |= {name: float(value), f"theta2_{name}_deg": float(np.round(np.degrees(at), 9) + 0.0)}
    return told


def _passes(spec: LinkageSpec, limit: float, sense: int) -> bool:
    """Whether sin(mu) goes to 0 in proportion to the driver's way, and not like its root."""
    near = limit + sense * np.array([_WIDE_INSET, _WIDE_INSET / 4])
    far, close = np.sin(transmission_angle(spec.linkage, near))
    return bool(far > 3 * close)


def _facts(
    spec: LinkageSpec,
    ranges: tuple[tuple[float, float], ...],
    turns: bool,
    masses: Masses | None,
    tables: Mapping[str, pd.DataFrame],
    speed_rpm: float,
) -> Iterator[Fact]:
    linkage, unit = spec.linkage, spec.length_unit or "length"
    kind = grashof_class(linkage)
    triple = triple_rocker_kind(linkage)
    yield Fact("grashof_class", "Grashof class", f"{kind} {triple}".strip())
    stretched, folded = rotatability(linkage)
    yield Fact("rotatability_stretched", "(r3 + r4 - r1 - r2) / sum", float(stretched))
    yield Fact("rotatability_folded", "(|r1 - r2| - |r3 - r4|) / sum", float(folded))
    yield Fact("full_rotation", "driver turns fully", turns)
    yield Fact("speed_rpm", "driver speed", speed_rpm, "rpm")
    for number, (low, high) in enumerate([] if turns else ranges, start=1):
        mark = f"_{number}" if len(ranges) > 1 else ""
        for name, end in (("low", low), ("high", high)):
            label = f"dead position, {name} end of range {number}"
            yield Fact(f"driver_{name}{mark}_deg", label, float(np.degrees(end)), "deg")
    if turns:
        worst = float(np.degrees(worst_transmission(linkage, *ranges[0])))
        yield Fact("transmission_min_deg", "worst transmission angle", worst, "deg")
    else:
        yield Fact("transmission_min_deg", "worst transmission angle (dead positions)", 0.0, "deg")
    yield from _stroke_facts(spec, turns, tables["extremes"])
    box = np.array([reach_box(linkage, low, high) for low, high in ranges])
    extent = np.max(box[:, 1], axis=0) - np.min(box[:, 0], axis=0)
    yield Fact("size", "size (diagonal of the box it needs)", float(np.hypot(*extent)), unit)
    yield from _path_facts(spec, ranges, turns)
    if masses is not None:
        yield from _mass_facts(spec, masses, tables["dynamics"], turns)


def _stroke_facts(spec: LinkageSpec, turns: bool, extremes: pd.DataFrame) -> Iterator[Fact]:
    linkage, unit = spec.linkage, spec.length_unit or "length"
    stroke = output_stroke(linkage)
    if not turns:  # the two toggle positions may lie on different circuits
        swings = extremes[extremes["quantity"] == "theta4_deg"]
        for number, (low, high) in enumerate(zip(swings["min"], swings["max"], strict=True), start=1):
            mark, where = (f"_{number}", f", range {number}") if len(swings) > 1 else ("", "")
            yield Fact(f"output_swing{mark}_deg", f"swing of the output{where}", float(high - low), "deg")
            if spec.output_arm is not None:
                way = float(spec.output_arm * np.radians(high - low))
                yield Fact(f"output_stroke{mark}", f"stroke of the output arm{where}", way, unit)
    elif np.isfinite(stroke.swing):
        yield Fact("output_swing_deg", "swing of the output", float(np.degrees(stroke.swing)), "deg")
        yield Fact("stroke_chord", "stroke of B, chord", float(stroke.chord), unit)
        if spec.output_arm is not None:
            yield Fact(
                "output_stroke", "stroke of the output arm", float(spec.output_arm * stroke.swing), unit
            )
    if np.isfinite(stroke.time_ratio):
        yield Fact("time_ratio", "time ratio of the strokes", float(stroke.time_ratio))
    for index, name in enumerate(("stretched", "folded")):
        if np.isfinite(stroke.theta4[index]):
            for link, angle in ((2, stroke.theta2[index]), (4, stroke.theta4[index])):
                label = f"output turns back, 2 and 3 {name}: theta{link}"
                yield Fact(f"toggle_{name}_theta{link}_deg", label, float(np.degrees(angle)), "deg")
    if spec.output_arm is not None:
        try:
            factor = spec.output_arm * float(np.abs(solve_kinematics(linkage, 0.0).omega4))
        except AssemblyError:
            return
        yield Fact("torque_factor_at_0_deg", "torque factor of the output arm at theta2 = 0", factor, unit)


def _path_facts(spec: LinkageSpec, ranges: tuple[tuple[float, float], ...], turns: bool) -> Iterator[Fact]:
    linkage, unit = spec.linkage, spec.length_unit or "length"
    low, high = ranges[0]
    where = ", range 1" if len(ranges) > 1 else ""
    for degree in (4, 8):
        r2 = float(coupler_fit_r2(linkage, low, high, degree))
        if np.isfinite(r2):
            yield Fact(
                f"coupler_fit_r2_degree_{degree}", f"R2 of degree {degree} through the path of P{where}", r2
            )
    if turns:
        series = coupler_fourier(linkage)
        for harmonic in range(1, _HARMONICS + 1):
            share = float(series.content[harmonic - 1])
            if np.isfinite(share):
                yield Fact(
                    f"fourier_share_{harmonic}", f"share of harmonic {harmonic} in the path of P", share
                )
        yield Fact(
            f"fourier_error_{_HARMONICS}", f"path of P from {_HARMONICS} harmonics errs by",
            float(series.error_max[_HARMONICS]), unit,
        )  # fmt: skip
    crossings = double_points(linkage)
    yield Fact("double_points", "double points of the path of P", len(crossings))
    for number, (point, angles) in enumerate(zip(crossings.points, crossings.theta2, strict=True), start=1):
        for axis, value in zip("xy", point, strict=True):
            yield Fact(f"double_point_{number}_{axis}", f"double point {number}, {axis}", float(value), unit)
        for passage, angle in enumerate(np.degrees(angles), start=1):
            yield Fact(
                f"double_point_{number}_theta2_{passage}_deg",
                f"double point {number}, passage {passage}: theta2", float(angle), "deg",
            )  # fmt: skip
    still = np.degrees(cusps(linkage))
    yield Fact("cusps", "cusps of the path of P", len(still))
    for number, angle in enumerate(still, start=1):
        yield Fact(f"cusp_{number}_theta2_deg", f"cusp {number}: theta2", float(angle), "deg")
    yield from _straight_facts(spec, low, high, turns)


def _straight_facts(spec: LinkageSpec, low: float, high: float, turns: bool) -> Iterator[Fact]:
    """The straightest half turn, to 5 deg; of a driver that swings the whole of its first range."""
    starts = np.radians(np.arange(0, 360, 5.0)) if turns else np.array([low])
    span = np.pi if turns else high - low
    try:
        lines = [(straightness(spec.linkage, start, start + span, 61), start) for start in starts]
    except ProblemError:  # P does not move, or rounding opens the loop in a dead position
        return
    line, start = min(lines, key=lambda each: each[0].width / each[0].length)
    unit, what = spec.length_unit or "length", "straightest half turn of P" if turns else "path of P, range 1"
    yield Fact("straight_from_deg", f"{what}: from theta2", float(np.degrees(start)), "deg")
    yield Fact("straight_to_deg", f"{what}: to theta2", float(np.degrees(start + span)), "deg")
    yield Fact("straight_length", f"{what}: length along its best line", line.length, unit)
    yield Fact("straight_deviation", f"{what}: largest distance from it", line.deviation_max, unit)


def _mass_facts(spec: LinkageSpec, masses: Masses, table: pd.DataFrame, turns: bool) -> Iterator[Fact]:
    yield Fact("mass", "moving mass", float(masses.total), "kg")
    if spec.dynamics is not None:
        x, y = spec.dynamics.gravity
        yield Fact("gravity", "gravity", f"{x:g}, {y:g}", "m/s2")
    if turns:  # equal steps, the last of which is the first again
        torque = table["torque"].to_numpy()[:-1]
        mean, rms = float(np.mean(torque)), float(np.sqrt(np.mean(torque**2)))
        mean = mean if abs(mean) > 1e-12 * rms else 0.0  # less is rounding
        yield Fact("torque_mean", "drive torque, mean over the turn", mean, "N m")
        yield Fact("torque_rms", "drive torque, rms over the turn", rms, "N m")


def _notes(spec: LinkageSpec, ranges: tuple[tuple[float, float], ...], turns: bool) -> tuple[str, ...]:
    if turns:
        return ()
    between = " and ".join(f"{np.degrees(low):.6g} to {np.degrees(high):.6g}" for low, high in ranges)
    change = grashof_class(spec.linkage) is GrashofClass.CHANGE_POINT
    why = "links 3 and 4 may go either way there" if change else "rates and forces grow without bound there"
    assembly = f"shown is assembly {int(spec.linkage.assembly):+d}"
    return (f"dead positions bound the driver's motion, {between} deg: {why}; {assembly}",)


def mass_tracks(report: LinkageReport) -> dict[str, FloatArray]:
    """Tracks of the centres of mass of links 2, 3, 4, and of all together, each of shape (N, 2).

    Without masses: of the points halfway between the joints.
    """
    linkage, masses = report.spec.linkage, report.masses
    tracks: dict[str, FloatArray] = {}
    with _quiet():
        angles = _angles(report.ranges, report.turns)
        states = [_state(report.spec, each, report.speed_rpm) for each in angles]
        for link in (2, 3, 4):
            halfway = np.array([float(getattr(linkage, f"r{link}")) / 2, 0.0])
            at = halfway if masses is None else masses.of(link).centre
            tracks[f"link {link}"] = np.concatenate([_gap(s.point(link, at).position) for s in states])
        if masses is not None and masses.total > 0:
            tracks["all links"] = np.concatenate([_gap(system_centre(masses, s).position) for s in states])
    return tracks


def _gap(points: FloatArray) -> FloatArray:
    """The points with a row of NaN after them, so that lines do not join two ranges."""
    return np.concatenate([points, np.full((1, 2), np.nan)])
