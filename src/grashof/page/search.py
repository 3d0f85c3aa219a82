"""The page of a search: the task, the designs, and how they were found."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from grashof.page.columns import Column, columns_of, figures_of
from grashof.page.designs import designs_of, legend, loci_of, moves, scene_of
from grashof.page.render import DRAWING, STRUTS, render
from grashof.problems import Problem
from grashof.problems.values.linkages.mechanisms import ROWS
from grashof.problems.values.text import counted
from grashof.synth import Candidate, Result
from grashof.synth.designs.table import Row, rows_of, rows_of_nearest
from grashof.synth.results.result import note_parts
from grashof.synth.search.ledger import LISTED, Tally
from grashof.wording.problem import goals, summary
from grashof.wording.proof import enclosure_line, proof_line, work_line

_SCRIPTS = (
    *DRAWING, "picture.js", "curves.js", "scatter.js", "table.js", "compare.js", "saving.js", "loci.js",
    *STRUTS, "search.js",
)  # fmt: skip


def search_page(
    result: Result, record: Mapping[str, Any], text: str = "", *, rows: Sequence[Row] | None = None
) -> str:
    """The page of a search as HTML; with its closest misses where it found no design.

    Parameters
    ----------
    result : Result
    record : mapping
        "versions" and "settings" of the run.
    text : str
        The problem file.
    rows : sequence of dict, optional
        Rows of its candidates or, without any, of its nearest, if they are known.

    Returns
    -------
    str
        A single file that needs neither other files nor a network.
    """
    problem = result.problem
    listing = result.candidates or result.nearest
    if rows is None:
        rows = rows_of(problem, listing) if result.candidates else rows_of_nearest(problem, listing)
    rows = [row for row, each in zip(rows, listing, strict=True) if moves(each)]
    designs = list(filter(moves, listing))
    note, ways = note_parts(result.note)
    data = search_data(problem, designs, rows, found=bool(result.candidates))
    data["loci"] = loci_of(result)
    columns = [Column(**each) for each in data["columns"]]
    drawn = list(dict.fromkeys(each.linkage.mechanism for each in designs))
    cylinders = [each.verdict.cylinder for each in designs]
    efforts = [each.verdict.effort for each in designs]
    return render(
        "search.html",
        _SCRIPTS,
        data,
        title=problem.title or problem.name,
        problem=problem,
        asked=[line.strip() for line in summary(problem)][1:],
        found=bool(result.candidates),
        headline=headline(result),
        proven=proof_line(result),
        enclosed=enclosure_line(result),
        loci=data["loci"],
        proof_work="" if result.proof is None else work_line(result.proof),
        note=note,
        ways=ways,
        goals=goals(problem).replace("mu", "μ"),
        columns=columns,
        rows=(listed := _rows(rows, columns)),
        **{name: any(row[name] for row in listed) for name in ("alike", "best_at", "caution")},
        regions=len({row["region"] for row in listed} - {""}) > 1,
        classes=sorted({row["grashof_class"] for row in rows}),
        mechanisms=list(dict.fromkeys(row.word for row in drawn)),
        links=legend(drawn or [ROWS[word][0] for word in problem.mechanism], cylinders, efforts),
        counts=_counts(result.tally),
        seconds={stage: f"{time:.2f}" for stage, time in result.seconds.items()},
        record=record,
        text=text,
        speed_rpm=None if problem.dynamics is None else problem.dynamics.speed_rpm,
    )


def search_data(
    problem: Problem, designs: Sequence[Candidate], rows: Sequence[Row], *, found: bool
) -> dict[str, Any]:
    """Data of a search for the scripts: the scene, designs that can be assembled, and their quantities.

    The rows are those of `rows_of`; designs that are not `found` are closest misses.
    """
    axes = columns_of(problem, rows) if designs else []
    return {
        "name": problem.name,
        "found": found,
        "scene": scene_of(problem),
        "columns": [asdict(each) for each in axes if each.listed],
        "axes": [asdict(each) for each in axes],
        "values": [asdict(each) for each in figures_of(rows, problem.length_unit)] if designs else [],
        "designs": designs_of(problem, designs, rows),
    }


def headline(result: Result) -> str:
    """The numbers of designs that a search found and lists."""
    listed = len(result.candidates)
    if not listed:
        return "No design found." if result.complete else "Interrupted before any design was found."
    verified = max(result.tally.totals[LISTED], listed)
    families = len(result.families)
    shown = f" in {counted(families, 'family')}" if families < listed else ""
    if verified > listed:
        shown = f", listed are the best {listed}{shown}"
    cut = "" if result.complete else "; the search was interrupted"
    return f"{counted(verified, 'distinct verified design')}{shown}{cut}."


def _rows(rows: Sequence[Row], columns: list[Column]) -> list[dict[str, Any]]:
    """The table as text, a row for each design; `alike` counts the others of its family."""
    families = Counter(row["family"] for row in rows)
    return [
        {
            "rank": row["rank"],
            "id": row["id"],
            "alike": families[row["family"]] - 1,
            "first": row["id"] == row["family"],
            "best_at": row["best_at"] or "",
            "caution": row["caution"] or "",
            "region": row["region"] or "",
            "pareto": bool(row["pareto"]),
            "mechanism": row["mechanism"],
            "kind": row["grashof_class"],
            "misses": row.get("misses", ""),
            "cells": [column.text(row[column.key]) for column in columns],
        }
        for row in rows
    ]


def _counts(tally: Tally) -> list[tuple[str, list[tuple[str, int]]]]:
    """Counts of the search under headings."""
    tables = {
        "Counted": tally.general,
        "Rejected, by the first requirement missed": tally.rejected,
        "Ipopt ended with": tally.statuses,
    }
    return [(heading, list(rows.items())) for heading, rows in tables.items() if rows]
