"""The page of an analysis: the moving linkage, the summary, all sections in groups that fold."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from grashof.analysis import verify
from grashof.analysis.judge.effort_of_file import effort_of_file
from grashof.page.designs import cylinder_data, legend, linkage_data, scene_of
from grashof.page.panels import motion_sections
from grashof.page.plot_data import Columns, is_thinned, plot_data
from grashof.page.render import DRAWING, STRUTS, render
from grashof.page.struts import effort_data, strut_data
from grashof.problems import LinkageSpec
from grashof.problems.values.text import counted
from grashof.study.section import DRIVER_ANGLE, Fact, Section
from grashof.survey.report import LinkageReport
from grashof.wording.numbers import dimensions_text, number_text, value_text

_SCRIPTS = (*DRAWING, "picture.js", "curves.js", "tracks.js", "saving.js", *STRUTS, "analysis.js")
_EXTREMES = (("min", "least"), ("theta2_min_deg", "at θ2"), ("max", "largest"), ("theta2_max_deg", "at θ2"))
_SMALL = 30  # rows up to which a table is in the page; a larger one is a file next to it
_DIGITS = 6
_THINNED = "long histories have only some of their samples on this page, and all of them in the tables"


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
        A single file that needs neither other files nor a network.
    """
    sweep, spec = report.sweep, report.sweep.spec
    columns, targets = Columns(), _targets(spec)
    scene = {"unit": spec.length_unit} if not targets or spec.problem is None else scene_of(spec.problem)
    sections = [
        section
        for section in (*motion_sections(report), *report.sections)
        if section.facts or section.tables or section.plots or section.notes
    ]
    facts = {fact.key: fact.value for section in report.sections for fact in section.facts}
    effort = None if spec.dynamics is None else spec.dynamics.effort
    by_hand = effort_data(effort_of_file(spec))
    cylinder = cylinder_data(spec.cylinder, float(facts.get("cylinder_closed", 0.0)))
    data = {
        "name": spec.name,
        "scene": scene,
        "designs": [
            {
                "linkage": linkage_data(spec.linkage),
                "low": low,
                "high": high,
                "turns": sweep.turns,
                "direction": 1 if sweep.speed_rpm >= 0 else -1,
                **cylinder,
                **strut_data(spec.linkage, effort),
                **by_hand,
                **targets,
            }
            for low, high in sweep.ranges
        ],
        "groups": [[plot_data(plot, columns) for plot in section.plots] for section in sections],
        "columns": columns.found,
        "driver": DRIVER_ANGLE,
    }
    return render(
        "analysis.html",
        _SCRIPTS,
        data,
        title=spec.title or spec.name,
        spec=spec,
        report=report,
        dimensions=dimensions_text(spec),
        links=legend([spec.linkage.mechanism], [spec.cylinder], [effort]),
        ranges=[f"{np.degrees(low):.6g} to {np.degrees(high):.6g} deg" for low, high in sweep.ranges],
        facts=_facts(fact for fact in report.facts if not fact.aside),
        aside=_facts(fact for fact in report.facts if fact.aside),
        task=bool(targets),
        marked="body" if scene.get("body") else "target" if scene.get("poses") or scene.get("points") else "",
        groups=[_group(section) for section in sections],
        extremes=_extremes(report.tables["extremes"]),
        extreme_columns=[label for _, label in _EXTREMES],
        many="range" in report.tables["extremes"],
        record=record,
        speed_rpm=abs(sweep.speed_rpm),
    )


def _targets(spec: LinkageSpec) -> dict[str, Any]:
    """Driver angles and assemblies at the targets; empty without a task, or where it is open at a target."""
    if spec.problem is None:
        return {}
    task, wanted = spec.problem.task, spec.problem.requirements
    verdict = verify(spec.linkage, task, wanted, problem=spec.problem, cylinder=spec.cylinder)
    if not np.isfinite(verdict.theta2).all():
        return {}
    return {"theta2": verdict.theta2.tolist(), "assemblies": verdict.assembly.tolist()}


def _facts(facts: Iterable[Fact]) -> list[tuple[str, str, str]]:
    return [(fact.label, value_text(fact.value), fact.unit) for fact in facts]


def _group(section: Section) -> dict[str, Any]:
    """A section as the template shows it."""
    small = {name: table for name, table in section.tables.items() if len(table) <= _SMALL}
    many = (("plot", len(section.plots)), ("table", len(section.tables)), ("value", len(section.facts)))
    return {
        "key": section.key,
        "title": section.title,
        "about": ", ".join(counted(number, word) for word, number in many if number),
        "notes": [*section.notes, *([_THINNED] if any(map(is_thinned, section.plots)) else [])],
        "facts": _facts(section.facts),
        "tables": [_table(name, table) for name, table in small.items()],
        "files": [
            (f"table-{name}.csv", counted(len(table), "row"), counted(table.shape[1], "column"))
            for name, table in section.tables.items()
            if name not in small
        ],
    }


def _table(name: str, table: pd.DataFrame) -> dict[str, Any]:
    return {
        "name": name,
        "file": f"table-{name}.csv",
        "columns": [(str(column), _is_text(table[column])) for column in table.columns],
        "rows": [[_cell(value) for value in row] for row in table.itertuples(index=False, name=None)],
    }


def _is_text(column: pd.Series[Any]) -> bool:
    return any(isinstance(value, str) for value in column)


def _cell(value: Any) -> str:
    plain = value.item() if isinstance(value, np.generic) else value
    return value_text(plain) if isinstance(plain, bool | int | float) else str(plain)


def _extremes(table: pd.DataFrame) -> list[dict[str, Any]]:
    return [
        {
            "range": row.get("range", ""),
            "what": row["what"],
            "unit": row["unit"],
            "cells": [number_text(row[key], _DIGITS) for key, _ in _EXTREMES],
        }
        for row in table.to_dict("records")
    ]
