"""Counterweights against the shaking force, and for an even drive torque: before and after."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from grashof.analysis import (
    Body,
    Kinematics,
    Loads,
    Masses,
    balance_force,
    balance_reciprocating,
    balance_turn,
    inverse_dynamics,
)
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.study.kinds import output_turns, plain
from grashof.study.samples import Columns, curves, over_driver, table
from grashof.study.section import Fact, Section, angle_fact
from grashof.study.study import LinkageStudy
from grashof.study.turn import turn_means, turn_peaks

_BARE, _FORCE, _RMS, _PEAK = "as it is", "shaking force", "torque, rms", "torque, peak"
_KEYS = {_BARE: "before", _FORCE: "force", _RMS: "rms", _PEAK: "peak"}
_PLOTS = (
    ("shaking_force", "balancing-shaking-force", "shaking force", "N"),
    ("shaking_moment", "balancing-shaking-moment", "shaking moment about O2", "N m"),
    ("torque", "balancing-torque", "drive torque", "N m"),
)
_NOTHING = 1e-12  # share of the greatest: rounding


@dataclass(frozen=True, slots=True, eq=False)
class _Balanced:
    """Masses with the counterweights for one aim, by the links that carry them."""

    masses: Masses
    weights: Mapping[int, Body]


def balancing(study: LinkageStudy) -> Section | None:
    """Counterweights for each aim with the remaining forces and torque; None unless they are requested."""
    if not study.asked.balance:
        return None
    masses, loads = study.masses, study.loads
    if masses is None or not masses.total > 0:
        raise ProblemError("balance needs masses; [dynamics] states none")
    ways, notes = _alternatives(study, masses, loads)
    columns = over_driver(study, lambda state: _columns(state, ways, loads, study.metre))
    plots = [
        curves(columns, key, title, unit, {way: f"{name}_{_KEYS[way]}" for way in ways})
        for name, key, title, unit in _PLOTS
    ]
    rows = pd.DataFrame([_row(study, name, way, loads) for name, way in ways.items()])
    if "shaking_force_peak" in rows:
        small = rows["shaking_force_peak"] < _NOTHING * rows["shaking_force_peak"].max()
        rows.loc[small, "shaking_force_peak"] = 0.0
    tables = {"balancing": rows, "balancing-curves": table(columns)}
    return Section("balancing", "Balancing", tuple(_facts(study, rows)), tables, tuple(plots), notes)


def _alternatives(
    study: LinkageStudy, masses: Masses, loads: Loads
) -> tuple[dict[str, _Balanced], tuple[str, ...]]:
    """The alternatives that are compared by their aims, and notes with the reason where some are missing."""
    linkage, steady = study.linkage, all(law.motor.steady for law in study.sweep.laws)
    way, note = _against_force(linkage, masses)
    ways = {_BARE: _Balanced(masses, {}), _FORCE: way}
    notes = [note, "shaking force and moment are those of inertia; weights and loads are left out"]
    why = (
        "gravity is zero, so no counterweight evens out the torque"
        if not loads.gravity_vector().any()
        else "the driver does not turn fully, so no counterweight evens out its torque"
        if not study.sweep.turns
        else "the torque of a driver that starts and stops is not evened out"
        if not steady
        else ""
    )
    if why:
        return ways, (*notes, why)
    omega2, radius = study.sweep.speed_rpm * TURN / 60, float(linkage.r2)
    for name, measure in ((_RMS, "rms"), (_PEAK, "peak")):
        try:
            found = balance_turn(linkage, masses, omega2, loads, radius, measure)
        except ProblemError as error:  # numeric overflow
            raise ProblemError(f"balance: the torque is not evened out: {error}") from None
        ways[name] = _Balanced(found.masses, {2: found.crank_weight})
    return ways, tuple(notes)


def _against_force(linkage: Linkage, masses: Masses) -> tuple[_Balanced, str]:
    """Masses with counterweights against the shaking force, and a note on these."""
    same = "others of the same mass times radius do"
    kind = linkage.mechanism
    if len(kind.dyads) == 1 and not output_turns(kind):
        half = balance_reciprocating(linkage, masses, 0.5)
        balanced = "the rotating and half of the reciprocating masses"
        note = f"the counterweight at r2 balances {balanced}; {same}"
        return _Balanced(half.masses, {2: half.crank_weight}), note
    full = balance_force(linkage, masses)
    place = "r4" if plain(kind) else "r2"
    note = f"counterweights are points at r2 from O2 and {place} from O4; {same}"
    return _Balanced(full.masses, {2: full.crank_weight, 4: full.output_weight}), note


def _columns(state: Kinematics, ways: Mapping[str, _Balanced], loads: Loads, metre: float) -> Columns:
    return {
        f"{quantity}_{_KEYS[name]}": values
        for name, way in ways.items()
        for (quantity, *_), values in zip(_PLOTS, _rows(state, way.masses, loads, metre), strict=True)
    }


def _rows(state: Kinematics, masses: Masses, loads: Loads, metre: float) -> FloatArray:
    """Shaking force, shaking moment and drive torque, each a row; N and N m."""
    inertia, torque = inverse_dynamics(state, masses), inverse_dynamics(state, masses, loads).torque
    force = np.hypot(inertia.shaking_force[:, 0], inertia.shaking_force[:, 1]) * metre
    return np.stack([force, inertia.shaking_moment * metre**2, torque * metre**2])


def _row(study: LinkageStudy, name: str, way: _Balanced, loads: Loads) -> dict[str, object]:
    row: dict[str, object] = {"aim": name}
    for link in (2, 4):
        weight = way.weights.get(link)
        mass, u, v = (0.0, 0.0, 0.0) if weight is None else (float(weight.mass), *weight.centre.tolist())
        row |= {f"mass_{link}": mass, f"u_{link}": u, f"v_{link}": v}
        row[f"mass_times_radius_{link}"] = mass * float(np.hypot(u, v))
    return row | (_figures(study, way.masses, loads) if study.sweep.turns else {})


def _figures(study: LinkageStudy, masses: Masses, loads: Loads) -> dict[str, float]:
    """Peaks over the turn, and the root mean square of the torque."""

    def rows(state: Kinematics) -> FloatArray:
        return np.abs(_rows(state, masses, loads, study.metre))

    largest, _ = turn_peaks(study, rows)
    square = turn_means(study, lambda state: rows(state)[2:] ** 2)
    peaks = {f"{name}_peak": value for (name, *_), value in zip(_PLOTS, largest.tolist(), strict=True)}
    return peaks | {"torque_rms": float(np.sqrt(square[0]))}


def _facts(study: LinkageStudy, rows: pd.DataFrame) -> Iterator[Fact]:
    unit = study.spec.unit
    for row in rows.to_dict("records"):
        aim, key = row["aim"], _KEYS[row["aim"]]
        for link in (2, 4):
            if row[f"mass_{link}"] > 0:
                label = f"counterweight on link {link} for {aim}"
                name = f"balance_{key}_{link}"
                product = row[f"mass_times_radius_{link}"]
                angle = np.arctan2(row[f"v_{link}"], row[f"u_{link}"])
                yield Fact(f"{name}_mass_radius", f"{label}: mass times radius", product, f"kg {unit}")
                yield angle_fact(f"{name}_angle", f"{label}: direction from the link", angle)
        for column, label, per in (
            ("shaking_force_peak", "shaking force, peak", "N"),
            ("shaking_moment_peak", "shaking moment, peak", "N m"),
            ("torque_peak", "drive torque, peak", "N m"),
            ("torque_rms", "drive torque, rms", "N m"),
        ):
            if column in rows and np.isfinite(row[column]):
                what = label if aim == _BARE else f"{label}, balanced for {aim}"
                yield Fact(f"balance_{key}_{column}", what, row[column], per)
