"""Strength of bars and pins: forces along the bars, stress, deflection, safety factors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
import pandas as pd

from grashof.analysis import (
    BAR_MEASURES,
    PIN_MEASURES,
    Kinematics,
    SafetyFactor,
    StrengthPeak,
    StrengthSummary,
    Structure,
    driver_samples,
    strength_at,
    strength_over,
)
from grashof.analysis.forces.joints import joints_of
from grashof.problems.values.arrays import FloatArray
from grashof.study.samples import Columns, curves, over_driver, table
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy


def strength(study: LinkageStudy) -> Section | None:
    """Forces along the bars; with a section also stresses, with strengths safety factors."""
    masses, given = study.masses, study.spec.dynamics
    if masses is None or given is None:
        return None
    structure = Structure(masses, study.loads, given.section, given.strength, study.metre)
    columns = over_driver(study, lambda state: _columns(state, structure))
    stretches = [driver_samples(study.linkage, low, high) for low, high in study.sweep.ranges]
    summary = strength_over(structure, study.sweep.state, stretches)
    plots, facts = tuple(_plots(study, columns)), tuple(_facts(study, summary))
    peaks = _worst_table(summary.peaks, "what", "largest")
    peaks.insert(3, "unit", [_unit(study, peak.unit) for peak in summary.peaks])
    tables = {"strength": table(columns), "strength-peaks": peaks}
    if summary.factors:
        tables["safety"] = _worst_table(summary.factors, "failure", "safety_factor")
    notes = ["bars are straight and even; holes, notches, fatigue and impact are left out"]
    if not study.sweep.turns:
        notes.append("towards dead positions forces grow without bound, so that there are no greatest ones")
    return Section("strength", "Strength of bars and pins", facts, tables, plots, tuple(notes))


def _columns(state: Kinematics, structure: Structure) -> Columns:
    found = strength_at(state, structure)
    columns: dict[str, FloatArray] = {
        f"{key}_{link}": along.value
        for link, measures in found.bars.items()
        for key, along in measures.items()
    }
    return columns | {
        f"{key}_{joint.name.lower()}": values
        for joint, measures in found.pins.items()
        for key, values in measures.items()
    }


def _plots(study: LinkageStudy, columns: Columns) -> Iterator[Plot]:
    """A plot for each measure, with a line for each bar or joint."""
    bars = {str(link.number): f"link {link.number}" for link in study.linkage.mechanism.links[1:]}
    pins = {joint.name.lower(): joint.name for joint in joints_of(study.linkage)}
    for measures, parts in ((BAR_MEASURES, bars), (PIN_MEASURES, pins)):
        for measure in measures:
            labels = {label: f"{measure.key}_{part}" for part, label in parts.items()}
            if all(key in columns for key in labels.values()):
                key = f"strength-{measure.key.replace('_', '-')}"
                yield curves(columns, key, measure.label, _unit(study, measure.unit), labels)


def _worst_table(found: Iterable[StrengthPeak | SafetyFactor], label: str, value: str) -> pd.DataFrame:
    """A row for each, with these headings for its label and value."""
    rows = [
        {
            "part": each.part,
            label: each.label,
            value: each.value,
            "theta2_deg": _degrees(each.place),
            "at": each.at,
        }
        for each in found
    ]
    return pd.DataFrame(rows).replace([np.inf, -np.inf], np.nan)


def _facts(study: LinkageStudy, summary: StrengthSummary) -> Iterator[Fact]:
    bar, worst = summary.worst_bar, summary.worst
    if np.isfinite(bar.value):
        label = f"greatest {bar.label}"
        yield Fact("worst_bar", f"bar with the {label}", bar.part)
        yield Fact("worst_bar_value", label, bar.value, _unit(study, bar.unit))
        yield Fact("worst_bar_theta2_deg", f"{label}: theta2", _degrees(bar.place), "deg")
        yield Fact("worst_bar_at", f"{label}: from the origin of the link", bar.at, study.spec.unit)
    if worst is not None and np.isfinite(worst.value) and worst.value > 0:
        yield Fact("safety_factor", f"least safety factor: {worst.label}, {worst.part}", worst.value)
        yield Fact("safety_factor_theta2_deg", "least safety factor: theta2", _degrees(worst.place), "deg")


def _degrees(theta2: float) -> float:
    return float(np.round(np.degrees(theta2), 9) + 0.0)


def _unit(study: LinkageStudy, unit: str) -> str:
    return study.spec.unit if unit == "length" else unit
