"""The page of an analysis: the moving linkage, every curve of its tables, extremes and summary."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from grashof.page.render import compact, render
from grashof.problems import FourBar
from grashof.study.quantities import FORCES
from grashof.survey.report import LinkageReport
from grashof.wording.numbers import number_text, value_text

_SCRIPTS = ("linkage.js", "svg.js", "stage.js", "player.js", "curves.js", "analysis.js")
_EXTREMES = (("min", "least"), ("theta2_min_deg", "at θ2"), ("max", "largest"), ("theta2_max_deg", "at θ2"))


def analysis_page(report: LinkageReport, record: Mapping[str, Any]) -> str:
    """The page of an analysis as HTML.

    Parameters
    ----------
    report : LinkageReport
    record : mapping
        "versions" and "settings" of the run.

    Returns
    -------
    str
        One file: it needs no other and no network.
    """
    sweep, spec = report.sweep, report.sweep.spec
    table = pd.concat([table for name, table in report.tables.items() if name != "extremes"], axis=1)
    parts = _by_range(table.loc[:, ~table.columns.duplicated()], len(sweep.ranges))
    data = {
        "scene": {"unit": spec.length_unit},
        "designs": [
            {
                "linkage": spec.linkage.stated,
                "low": low,
                "high": high,
                "turns": sweep.turns,
                "direction": 1 if sweep.speed_rpm >= 0 else -1,
            }
            for low, high in sweep.ranges
        ],
        "theta2": [part["theta2_deg"].tolist() for part in parts],
        "panels": [
            {
                "title": title,
                "unit": unit,
                "series": [
                    {"label": label, "values": [compact(part[key].tolist()) for part in parts]}
                    for key, label in names.items()
                    if key in table
                ],
            }
            for title, unit, names in panels(spec.unit)
            if any(key in table for key in names)
        ],
    }
    lengths = [f"{float(length):.6g}" for length in spec.linkage.lengths]
    return render(
        "analysis.html",
        _SCRIPTS,
        data,
        title=spec.title or spec.name,
        spec=spec,
        report=report,
        lengths=lengths,
        ranges=[f"{np.degrees(low):.6g} to {np.degrees(high):.6g} deg" for low, high in sweep.ranges],
        facts=[(fact.label, value_text(fact.value), fact.unit) for fact in report.facts],
        extremes=_extremes(report.tables["extremes"]),
        extreme_columns=[label for _, label in _EXTREMES],
        many="range" in report.tables["extremes"],
        record=record,
        speed_rpm=abs(sweep.speed_rpm),
    )


def panels(unit: str) -> list[tuple[str, str, dict[str, str]]]:
    """Title, unit and columns (with their labels) of every plot over the driver angle.

    Examples
    --------
    >>> title, unit, names = panels("mm")[3]
    >>> title, unit, names
    ('speed of A, B, P', 'mm/s', {'a_speed': 'A', 'b_speed': 'B', 'p_speed': 'P'})
    """
    points = {name: name.upper() for name in FourBar.MOVING}
    speeds, accelerations = (
        {f"{name}_{size}": point for name, point in points.items()} for size in ("speed", "acceleration")
    )
    places, rates = [], []
    for name, point in reversed(points.items()):
        places.append((f"place of {point}", unit, _xy(name)))
        for rate, per in (("velocity", "s"), ("acceleration", "s²")):
            rates.append((f"{rate} of {point}", f"{unit}/{per}", _xy(f"{name}_{rate}")))
    every = ", ".join(points.values())
    return [
        ("angles", "deg", {"theta3_deg": "θ3", "theta4_deg": "θ4", "mu_deg": "μ"}),
        ("angular velocity", "rad/s", {"omega3": "ω3", "omega4": "ω4"}),
        ("angular acceleration", "rad/s²", {"alpha3": "α3", "alpha4": "α4"}),
        (f"speed of {every}", f"{unit}/s", speeds),
        (f"acceleration of {every}", f"{unit}/s²", accelerations),
        ("torque factor of the output arm", unit, {"torque_factor": "factor"}),
        ("drive torque", "N m", {"torque": "torque"}),
        ("drive power", "W", {"power": "power"}),
        ("joint forces", "N", FORCES),
        ("shaking force", "N", _xy("shaking_force") | {"shaking_force": "size"}),
        ("shaking moment about O2", "N m", {"shaking_moment": "moment"}),
        *places,
        *rates,
        *((f"force {name.upper()} in {joint}", "N", _xy(name)) for name, joint in FORCES.items()),
    ]


def _xy(name: str) -> dict[str, str]:
    return {f"{name}_{axis}": axis for axis in "xy"}


def _by_range(table: pd.DataFrame, count: int) -> list[pd.DataFrame]:
    """The rows of each range of the driver."""
    return [table[table["range"] == n] for n in range(1, count + 1)] if "range" in table else [table]


def _extremes(table: pd.DataFrame) -> list[dict[str, Any]]:
    return [
        {
            "range": row.get("range", ""),
            "what": row["what"],
            "unit": row["unit"],
            "cells": [number_text(row[key], 6) for key, _ in _EXTREMES],
        }
        for row in table.to_dict("records")
    ]
