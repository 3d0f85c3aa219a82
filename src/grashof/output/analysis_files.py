"""The files and the output of `grashof analyse`."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain, count
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from rich.table import Table

from grashof.output.folder import ANALYSIS_PAGE, ANALYSIS_RECORD, replacing_own_files
from grashof.output.process import say
from grashof.output.run_files import listed_files, versions_of, write_csv, write_json, write_page
from grashof.output.terminal import fitting, folded, plain_table
from grashof.survey import Fact, LinkageReport
from grashof.wording.numbers import dimensions_text, number_text, value_text

_PACKAGES = ("grashof", "numpy", "scipy", "pandas", "matplotlib", "jinja2")


def write_report(folder: Path, report: LinkageReport, *, pictures: bool = False) -> list[str]:
    """Write tables, summary, page, plots, `pictures` too, and their record; the files' names, sorted.

    OSError where the disk is full or the folder is lost; it then holds its former files.
    """
    from grashof.figures.files import save
    from grashof.figures.section_plots import plots, section_pictures  # matplotlib takes a while to import
    from grashof.page.analysis import analysis_page

    about = {
        "versions": versions_of(_PACKAGES),
        "settings": {"linkage": report.sweep.spec.name, "speed_rpm": report.sweep.speed_rpm},
    }
    with replacing_own_files(folder, record=ANALYSIS_RECORD) as fresh:
        for name, table in report.tables.items():
            write_csv(fresh / f"{name}.csv", table)
        for section in report.sections:
            for name, table in section.tables.items():
                write_csv(fresh / f"table-{name}.csv", table)
        rows = [
            {"quantity": key, "value": fact.value, "unit": fact.unit, "what": fact.label, "section": section}
            for key, (section, fact) in _facts_by_key(report).items()
        ]
        write_csv(fresh / "summary.csv", pd.DataFrame(rows))
        write_json(fresh / "summary.json", _summary(report))
        write_page(fresh / ANALYSIS_PAGE, analysis_page(report, about))
        for name, figure in chain(plots(report), section_pictures(report) if pictures else ()):
            save(figure, [fresh / f"{name}.png", fresh / f"{name}.svg"])
        files = listed_files(fresh, ANALYSIS_RECORD)
        write_json(fresh / ANALYSIS_RECORD, {**about, "files": files})
    return files


def print_report(report: LinkageReport) -> None:
    """Print the summary and the extremes, no wider than the terminal where that can be."""
    spec = report.sweep.spec
    say(f"{spec.title or spec.name}: {dimensions_text(spec)}")
    for line in fitting([_facts_table("summary", report.facts)]):
        say(line)
    for line in fitting(_extremes_table(report, digits) for digits in (6, 4)):
        say(line)
    for section in report.sections:
        lines = fitting([_facts_table(section.title, section.facts)]) if section.facts else []
        for line in [*filter(None, lines), *folded(section.notes), ""] if lines else []:
            say(line)


def _facts_table(title: str, facts: Iterable[Fact]) -> Table:
    table = plain_table()
    table.add_column(title, no_wrap=True)
    table.add_column("value", justify="right", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for fact in facts:
        table.add_row(fact.label, value_text(fact.value), fact.unit)
    return table


def _extremes_table(report: LinkageReport, digits: int) -> Table:
    table, frame = plain_table(), report.tables["extremes"]
    ranges = ["range"] if "range" in frame else []
    texts = (f"extremes {report.sweep.over}", "unit")
    for name in (*ranges, *texts, "least", "at theta2", "largest", "at theta2"):
        table.add_column(name, justify="left" if name in texts else "right", no_wrap=True)
    columns = ("min", "theta2_min_deg", "max", "theta2_max_deg")
    for row in frame.to_dict("records"):
        values = (number_text(row[name], digits) for name in columns)
        table.add_row(*(str(row[name]) for name in (*ranges, "what", "unit")), *values)
    return table


def _facts_by_key(report: LinkageReport) -> dict[str, tuple[str, Fact]]:
    """Facts of the summary, with "", and of the sections by unique keys: a section's begin with its name."""
    found = {fact.key: ("", fact) for fact in report.facts}
    for section in report.sections:
        for fact in section.facts:
            longer = f"{section.key.replace('-', '_')}_{fact.key}"
            keys = chain((fact.key, longer), (f"{longer}_{number}" for number in count(2)))
            found[next(key for key in keys if key not in found)] = (section.key, fact)
    return found


def _summary(report: LinkageReport) -> dict[str, Any]:
    spec = report.sweep.spec
    return {
        "name": spec.name,
        "title": spec.title,
        "source": spec.source,
        "length_unit": spec.length_unit,
        "angle_unit": "rad",
        "mechanism": spec.linkage.mechanism.word,
        "linkage": spec.linkage.stated,
        "notes": list(report.notes),
        "facts": {
            key: {"value": _finite(fact.value), "unit": fact.unit} | ({"section": section} if section else {})
            for key, (section, fact) in _facts_by_key(report).items()
        },
        "sections": [
            {"key": section.key, "title": section.title, "notes": list(section.notes)}
            for section in report.sections
        ],
        "extremes": [
            {str(key): _finite(value) for key, value in row.items()}
            for row in report.tables["extremes"].to_dict("records")
        ],
    }


def _finite(value: Any) -> Any:
    """A value for JSON: null for NaN, words for infinity."""
    value = value.item() if isinstance(value, np.generic) else value
    if not isinstance(value, float) or np.isfinite(value):
        return value
    return None if np.isnan(value) else "infinite" if value > 0 else "-infinite"
