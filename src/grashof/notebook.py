"""Linkages, designs and results in notebooks: a table and a small drawing, as HTML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from html import escape
from io import StringIO

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from grashof.analysis import grashof_class
from grashof.figures.files import STYLE
from grashof.figures.linkage import plot_linkage
from grashof.figures.parts import missing_glyphs_unwarned
from grashof.figures.subject import Linkage
from grashof.output.terminal import best_rows, heading, units
from grashof.problems import Linkage as AnyKind
from grashof.problems import LinkageSpec, Problem, ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.text import counted
from grashof.synth import Candidate, Result
from grashof.wording.proof import proof_line

_ROWS = 12  # of a batch
_SMALL = {**STYLE, "font.size": 7, "axes.grid": False}


def html(value: AnyKind | LinkageSpec | Candidate | Result) -> str:
    """Table and drawing of a value as HTML; all text in it is escaped."""
    if isinstance(value, Result):
        return _result(value)
    if isinstance(value, Candidate):
        return _side_by_side(_facts(_judged(value)), _drawing(value))
    if isinstance(value, LinkageSpec):
        unit = value.length_unit or "none stated"
        named = {"name": value.name, "title": value.title, "source": value.source, "length unit": unit}
        facts = {**named, **_linkage(value.linkage)}
        return _side_by_side(_facts({name: text for name, text in facts.items() if text}), _drawing(value))
    if value.shape:
        return _batch(value)
    return _side_by_side(_facts(_linkage(value)), _drawing(value))


def _result(result: Result) -> str:
    if not result.candidates:
        proven = f"<br>{escape(said)}" if (said := proof_line(result)) else ""
        note = result.note or "no design"
        return f"<p>{escape(note[0].upper() + note[1:])}.{proven}</p>"
    rows = best_rows(result)
    note = f"<p>{escape(result.note)}</p>" if result.note else ""
    lines = [*heading(result, len(result)).splitlines(), proof_line(result)]
    summary = "<br>".join(escape(line) for line in lines if line)
    named = units(result.problem)
    names = (f"{name} ({named[name]})" if name in named else name for name in rows[0])
    table = _table(names, (row.values() for row in rows))
    return f"<p>{summary}</p>{note}{_side_by_side(table, _drawing(result.best, result.problem))}"


def _linkage(linkage: AnyKind) -> dict[str, str]:
    kind, columns = linkage.mechanism, linkage.columns
    slides = {row.name: row.key for row in kind.parameters if row.name.startswith("slide")}
    signs = (row.name for row in kind.parameters if row.kind == "sign")
    return {
        **{name: f"{columns[name]:.6g}" for name in kind.dimensions if name not in "uv"},
        **{_words(name.replace("_angle", "")): f"{columns[key]:.6g} deg" for name, key in slides.items()},
        **{point.upper(): _pair(getattr(linkage, point)) for point in kind.ground},
        **{_words(name): str(columns[name]) for name in linkage.choices},
        "P (u, v)": _pair(linkage.coupler_point),
        **{_words(name): f"{columns[name]:+}" for name in signs},
        "Grashof class": str(grashof_class(linkage)),
    }


def _words(name: str) -> str:
    return name.replace("_", " ")


def _judged(candidate: Candidate) -> dict[str, str]:
    verdict = candidate.verdict
    task, turn = np.degrees([verdict.transmission_min_task, verdict.transmission_min_cycle])
    over_turn = f", {turn:.1f} deg over the turn" if verdict.full_rotation else ""
    problem, error = candidate.problem, {"largest position error": f"{verdict.error_max:.2g}"}
    if problem.task.has_output.any():
        worst = problem.task.shown(verdict.structural_error_max, problem.length_unit)
        error = {"greatest structural error": worst}
    return {
        "design": candidate.id,
        **_linkage(candidate.linkage),
        **error,
        "worst transmission angle": f"{task:.1f} deg over the task{over_turn}",
        "size": f"{verdict.size:.4g}",
        "defects": "; ".join(str(defect) for defect in verdict.defects) or "none",
    }


def _batch(linkages: AnyKind) -> str:
    lengths = linkages.lengths.reshape(-1, len(linkages.mechanism.lengths))
    rows = [[f"{length:.6g}" for length in each] for each in lengths[:_ROWS]]
    first = f", the first {_ROWS}" if len(lengths) > _ROWS else ""
    summary = f"batch of {counted(len(lengths), 'linkage')}, shape {linkages.shape}{first}"
    return f"<p>{summary}</p>{_table(linkages.mechanism.lengths, rows)}"


def _pair(point: FloatArray) -> str:
    return f"{point[0]:.6g}, {point[1]:.6g}"


def _facts(facts: Mapping[str, str]) -> str:
    rows = (
        f"<tr><th style='text-align:left'>{escape(name)}</th><td>{escape(text)}</td></tr>"
        for name, text in facts.items()
    )
    return f"<table>{''.join(rows)}</table>"


def _table(names: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    head = "".join(f"<th>{escape(name)}</th>" for name in names)
    body = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _side_by_side(table: str, drawing: str) -> str:
    style = "display:flex;flex-wrap:wrap;gap:1em;align-items:flex-start"
    return f"<div style='{style}'><div>{table}</div><div>{drawing}</div></div>"


def _drawing(linkage: Linkage, problem: Problem | None = None) -> str:
    """The linkage as inline SVG, or why it cannot be drawn."""
    with rc_context(_SMALL):
        figure, page = Figure(figsize=(3.8, 3.2), layout="constrained"), StringIO()
        try:
            axes = plot_linkage(linkage, problem, ax=figure.subplots())
        except ProblemError as error:
            return f"<p>{escape(str(error))}</p>"
        legend = axes.get_legend()
        if legend is not None:
            legend.remove()
        with missing_glyphs_unwarned():
            figure.savefig(page, format="svg", metadata={"Date": None})
    text = page.getvalue()
    return text[text.index("<svg") :]
