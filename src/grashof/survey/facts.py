"""The summary of the analysis of a linkage: class, limits, strokes, path of P, masses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from grashof.analysis import (
    Masses,
    coupler_fit_r2,
    coupler_harmonics,
    cusps,
    double_points,
    grashof_class,
    output_stroke,
    reach_box,
    rotatability,
    solve_kinematics,
    straightest_half_turn,
    straightness,
    triple_rocker_kind,
    worst_transmission_cycle,
)
from grashof.analysis.mechanism.driver_law import mean_in_time
from grashof.analysis.numerics.quadrature import held
from grashof.problems import FourBar, LinkageSpec, ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.study.kinds import LIMIT_POSITIONS, SHARES, output_turns, plain, turning
from grashof.study.quantities import counted_with, dynamic_quantities
from grashof.study.section import Fact, angle_fact
from grashof.study.study import LinkageStudy
from grashof.study.sweep import Sweep
from grashof.study.turn import degrees

_HARMONICS = 5
_DOUBTED = 2.0  # times its error: a mean below this is 0


def facts_of(study: LinkageStudy, tables: Mapping[str, pd.DataFrame]) -> Iterator[Fact]:
    """The lines of the summary in order."""
    sweep, masses = study.sweep, study.masses
    spec, ranges, turns = sweep.spec, sweep.ranges, sweep.turns
    linkage, unit = spec.linkage, spec.unit
    first, *more = linkage.mechanism.dyads
    kind, of_first = grashof_class(linkage), " of the first loop" if more else ""
    triple = triple_rocker_kind(linkage)
    yield Fact("grashof_class", f"Grashof class{of_first}", f"{kind} {triple}".strip())
    stretched, folded = rotatability(linkage)
    both = {"stretched": stretched, "folded": folded}
    for (name, share), label in zip(both.items(), SHARES[first.kind], strict=True):
        if label:
            yield Fact(f"rotatability_{name}", label, float(share))
    yield Fact("full_rotation", "driver turns fully", turns)
    yield Fact("speed_rpm", "driver speed", sweep.speed_rpm, "rpm")
    for number, (low, high) in enumerate([] if turns else ranges, start=1):
        mark = f"_{number}" if len(ranges) > 1 else ""
        for name, end in (("low", low), ("high", high)):
            yield angle_fact(f"driver_{name}{mark}", f"dead position, {name} end of range {number}", end)
    worst, where = (worst_transmission_cycle(linkage), "") if turns else (0.0, " (dead positions)")
    yield angle_fact("transmission_min", f"worst transmission angle {sweep.over}{where}", worst)
    extremes = tables["extremes"]
    yield from _limit_facts(study, extremes) if more else _stroke_facts(spec, turns, extremes)
    box = np.array([reach_box(linkage, low, high) for low, high in ranges])
    extent = np.max(box[:, 1], axis=0) - np.min(box[:, 0], axis=0)
    yield Fact("size", f"size {sweep.over} (diagonal of the box it needs)", float(np.hypot(*extent)), unit)
    yield from (replace(fact, aside=True) for fact in _path_facts(sweep))
    if masses is not None:
        yield from _mass_facts(study, masses)


def _stroke_facts(spec: LinkageSpec, turns: bool, extremes: pd.DataFrame) -> Iterator[Fact]:
    linkage, unit, kind = spec.linkage, spec.unit, spec.linkage.mechanism
    stroke, moved = output_stroke(linkage), kind.links[-1].name
    if not turns:  # the two toggle positions may lie on different circuits
        yield from _ranges_facts(spec, extremes)
    elif not output_turns(kind):
        yield Fact("stroke", "stroke of the slide", float(stroke.chord), unit)
    elif np.isfinite(stroke.swing):
        yield angle_fact("output_swing", "swing of the output", stroke.swing)
        if plain(kind):
            yield Fact("stroke_chord", "stroke of B, chord", float(stroke.chord), unit)
        if spec.output_arm is not None:
            way = float(spec.output_arm * stroke.swing)
            yield Fact("output_stroke", "stroke of the output arm", way, unit)
    if np.isfinite(stroke.time_ratio):
        yield Fact("time_ratio", "time ratio of the strokes", float(stroke.time_ratio))
    for index, (name, words) in enumerate(LIMIT_POSITIONS[kind.dyads[0].kind].items()):
        if np.isfinite(stroke.theta4[index]):
            key = f"toggle_{name}_theta"
            label = f"{moved} turns back, {words}: theta"
            yield angle_fact(f"{key}2", f"{label}2", stroke.theta2[index])
            if 4 in turning(kind):
                angle = _counted(float(np.degrees(stroke.theta4[index])), extremes, "theta4_deg")
                yield Fact(f"{key}4_deg", f"{label}4", angle, "deg")


def _limit_facts(study: LinkageStudy, extremes: pd.DataFrame) -> Iterator[Fact]:
    """Motion of the last link of several loops, whose limit positions have no closed form."""
    kind, unit = study.linkage.mechanism, study.spec.unit
    yield from _ranges_facts(study.spec, extremes)
    found, moved = study.limit_positions(), kind.links[-1]
    if np.isfinite(found[0].time_ratio):
        yield Fact("time_ratio", "time ratio of the strokes", found[0].time_ratio)
    theta = f"theta{moved.number}"
    theta2, values = (np.concatenate([getattr(each, name) for each in found]) for name in ("theta2", "value"))
    for number, (at, value) in enumerate(zip(theta2.tolist(), values.tolist(), strict=True), start=1):
        key, label = f"turns_back_{number}", f"{moved.name} turns back, {number}"
        yield Fact(f"{key}_theta2_deg", f"{label}: theta2", degrees(at), "deg")
        if output_turns(kind):
            angle = _counted(float(np.degrees(value)), extremes, f"{theta}_deg")
            yield Fact(f"{key}_{theta}_deg", f"{label}: {theta}", angle, "deg")
        else:
            yield Fact(f"{key}_travel", f"{label}: travel", value, unit)


def _counted(angle_deg: float, extremes: pd.DataFrame, key: str) -> float:
    """An angle of a link in the turn in which the extremes count it."""
    rows = extremes[extremes["quantity"] == key]
    return counted_with(angle_deg, zip(rows["min"], rows["max"], strict=True), 360.0)


def _ranges_facts(spec: LinkageSpec, extremes: pd.DataFrame) -> Iterator[Fact]:
    """Stroke or swing of the output in each range of the driver; none of an output that turns fully."""
    kind = spec.linkage.mechanism
    output = f"theta{kind.links[-1].number}_deg" if output_turns(kind) else "slide_travel"
    rows = extremes[extremes["quantity"] == output]
    for number, (low, high) in enumerate(zip(rows["min"], rows["max"], strict=True), start=1):
        mark, where = (f"_{number}", f", range {number}") if len(rows) > 1 else ("", "")
        if not output_turns(kind):
            yield Fact(f"stroke{mark}", f"stroke of the slide{where}", float(high - low), spec.unit)
        elif np.isfinite(high - low):
            yield Fact(f"output_swing{mark}_deg", f"swing of the output{where}", float(high - low), "deg")
            if spec.output_arm is not None:
                way = float(spec.output_arm * np.radians(high - low))
                yield Fact(f"output_stroke{mark}", f"stroke of the output arm{where}", way, spec.unit)


def _path_facts(sweep: Sweep) -> Iterator[Fact]:
    spec, ranges, turns = sweep.spec, sweep.ranges, sweep.turns
    linkage, unit = spec.linkage, spec.unit
    low, high = ranges[0]
    where = sweep.over if len(ranges) == 1 else "over range 1"
    for degree in (4, 8):
        r2 = float(coupler_fit_r2(linkage, low, high, degree))
        if np.isfinite(r2):
            label = f"R2 of degree {degree} through the path of P {where}"
            yield Fact(f"coupler_fit_r2_degree_{degree}", label, r2)
    if turns:
        series = coupler_harmonics(linkage, _HARMONICS)
        for number, share in enumerate(series.content.tolist(), start=1):
            if np.isfinite(share):
                yield Fact(f"fourier_share_{number}", f"share of harmonic {number} in the path of P", share)
        label = f"path of P from {_HARMONICS} harmonics errs by"
        yield Fact(f"fourier_error_{_HARMONICS}", label, float(series.error_max[_HARMONICS]), unit)
    if plain(linkage.mechanism):
        yield from _double_points(spec.four_bar, unit)
    still = cusps(linkage)
    yield Fact("cusps", "cusps of the path of P", len(still))
    for number, angle in enumerate(still, start=1):
        yield angle_fact(f"cusp_{number}_theta2", f"cusp {number}: theta2", angle)
    yield from _straight_facts(spec, low, high, turns)


def _double_points(linkage: FourBar, unit: str) -> Iterator[Fact]:
    crossings = double_points(linkage)
    yield Fact("double_points", "double points of the path of P", len(crossings))
    for number, (point, angles) in enumerate(zip(crossings.points, crossings.theta2, strict=True), start=1):
        for axis, value in zip("xy", point, strict=True):
            yield Fact(f"double_point_{number}_{axis}", f"double point {number}, {axis}", float(value), unit)
        for passage, angle in enumerate(angles, start=1):
            label = f"double point {number}, passage {passage}: theta2"
            yield angle_fact(f"double_point_{number}_theta2_{passage}", label, angle)


def _straight_facts(spec: LinkageSpec, low: float, high: float, turns: bool) -> Iterator[Fact]:
    """The half turn of least width over length; for a driver that swings, its entire first range."""
    unit = spec.unit
    what = "straightest half turn of P" if turns else "path of P, range 1"
    try:
        if turns:
            low, line = straightest_half_turn(spec.linkage)
            high = low + np.pi
        else:
            line = straightness(spec.linkage, low, high)
    except ProblemError:  # P does not move
        return
    yield angle_fact("straight_from", f"{what}: from theta2", low)
    yield angle_fact("straight_to", f"{what}: to theta2", high)
    yield Fact("straight_length", f"{what}: length along its best line", line.length, unit)
    least = ", least over length" if turns else ""
    yield Fact("straight_width", f"{what}: width{least}", line.width, unit)
    yield Fact("straight_deviation", f"{what}: largest distance from it", line.deviation_max, unit)


def _mass_facts(study: LinkageStudy, masses: Masses) -> Iterator[Fact]:
    spec = study.spec
    yield Fact("mass", "moving mass", float(masses.total), "kg")
    if spec.dynamics is not None:
        x, y = spec.dynamics.gravity
        yield Fact("gravity", "gravity", f"{x:g}, {y:g}", "m/s2")
    if study.sweep.turns:
        for name, value in zip(("mean", "rms"), _torque_over_turn(study), strict=True):
            if np.isfinite(value):  # friction may lock the linkage
                yield Fact(f"torque_{name}", f"drive torque, {name} over the turn", value, "N m")


def _torque_over_turn(study: LinkageStudy) -> tuple[float, float]:
    """Mean and root mean square of the drive torque over time, with their valid digits."""
    torque = next(quantity for quantity in dynamic_quantities(study) if quantity.key == "torque")
    law = study.sweep.laws[0]

    def powers(place: FloatArray) -> FloatArray:
        values = torque.of(solve_kinematics(study.linkage, *law.at_place(place)))
        return np.stack([values, values**2])

    (mean, square), (error, square_error) = mean_in_time(study.linkage, law, powers)
    rms = float(np.sqrt(square))
    return held(float(mean), _DOUBTED * error), held(rms, square_error / (2 * rms) if rms > 0 else 0.0)
