"""The page of a sweep: the trade-off, all combinations, and the best design of each in motion."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import pandas as pd
from pandas.api.types import is_numeric_dtype

from grashof.page.designs import legend, scene_of
from grashof.page.render import DRAWING, plain, render
from grashof.problems.files.problem_file import problem_of
from grashof.problems.values.linkages.mechanisms import ROWS
from grashof.sweep.plot import common_unit, decisions, measures, number_axes
from grashof.sweep.result import Sweep
from grashof.sweep.table import varied_columns
from grashof.synth.designs.table import LISTED

_SCRIPTS = (*DRAWING, "table.js", "scatter.js", "cells.js", "saving.js", "sweep.js")
_ROWS = 1000  # that a browser shows at once without delay
_DIGITS = 5
# Columns beside those varied and the deciding one: lengths, then properties of the design.
_SHOWN = (
    "transmission_min_task_deg", "transmission_min_cycle_deg", "error", "torque_peak", "size", "r1", "r2",
    "r3", "r4", "r5", "r6", "grashof_class",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Heading:
    """A column of the page."""

    key: str
    label: str
    unit: str = ""
    better: int = 0
    text: bool = False


def sweep_page(done: Sweep, frame: pd.DataFrame, record: Mapping[str, Any]) -> str:
    """The page of a sweep as HTML, from its table and from the "versions" and counts in its record."""
    best = frame.drop_duplicates("combination")
    shown = best.iloc[:_ROWS]
    columns = _columns(done, shown)
    places = [int(number) - 1 for number in shown["combination"]]
    scenes, of_place = _scenes(done, places)
    rows = [
        [None if row[column.key] is pd.NA else plain(row[column.key]) for column in columns]
        for row in shown.to_dict("records")
    ]
    drawn = filter(None, (done.results[place]["drawing"] for place in places))
    meant, *_ = ROWS
    kinds = {each["linkage"].get("mechanism", meant) for each in drawn} or {meant}
    listed = {column.key for column in columns}  # an interrupted sweep may not have varied all yet
    axes = [key for key in number_axes(done) if key in listed]
    rows_of_places = {place: row for row, place in enumerate(places)}
    first = next((row for row, place in enumerate(places) if done.results[place]["found"]), 0)
    data = {
        "name": done.study.name,
        "best": first if done.best_place is None else rows_of_places.get(done.best_place, first),
        "axes": axes,
        "measure": measures(done, best)[0]["column"],
        "columns": [asdict(column) for column in columns],
        "scenes": scenes,
        "values": rows,
        "designs": [
            {
                "drawing": done.results[place]["drawing"],
                "scene": of_place.get(place),
                "about": done.combinations[place].label,
                "note": done.results[place]["note"],
            }
            for place in places
        ],
    }
    return render(
        "sweep.html",
        _SCRIPTS,
        data,
        title=done.study.title or done.study.name,
        headline=done.headline,
        compared=any(column.better for column in columns if column.key != "designs"),
        cells=len(axes) == 2,
        moves=any(done.results[place]["drawing"] for place in places),
        links=legend(rows[0] for kind, rows in ROWS.items() if kind in kinds),
        columns=columns,
        given=[column.key for column in columns].index("designs") + 1,
        rows=[
            {
                "index": index,
                "found": done.results[place]["found"] > 0,
                "note": done.results[place]["note"],
                "cells": list(map(_text, row)),
            }
            for index, (place, row) in enumerate(zip(places, rows, strict=True))
        ],
        shown=len(shown),
        total=len(best),
        text=done.study.text,
        record={
            "versions": record["versions"],
            "settings": {"designs": done.study.designs, "time_limit": done.study.time_limit},
        },
    )


def _columns(done: Sweep, shown: pd.DataFrame) -> list[Heading]:
    """Columns that vary, the results, and those of the main quantities that some design has."""
    quantities = {quantity.column: quantity for quantity in LISTED}
    decides = {each["column"] for each in decisions(done)}
    keys = dict.fromkeys([*decides, *_SHOWN] if len(decides) == 1 else _SHOWN)
    known = [key for key in keys if key in shown and shown[key].notna().any()]
    varied = [key for key in varied_columns(done.combinations) if len(set(shown[key])) > 1]
    named, unit = list[Heading](), common_unit(done) or ""
    for key in known:
        if (each := quantities.get(key)) is None:
            named.append(Heading(key, key.replace("_", " "), text=key == "grashof_class"))
        else:
            named.append(Heading(key, each.label.replace("mu ", "μ "), each.unit.of(unit), each.better))
    return [
        Heading("combination", "#"),
        *(
            Heading(key, key.removeprefix("requirements."), text=not is_numeric_dtype(shown[key]))
            for key in varied
        ),
        Heading("status", "status", text=True),
        Heading("designs", "designs", better=1),
        *(named or [Heading("note", "reason for no design", text=True)]),
    ]


def _scenes(done: Sweep, places: Sequence[int]) -> tuple[list[dict[str, Any]], dict[int, int]]:
    """Scenes of the problems, each different one once, and the number of the scene by place."""
    texts: dict[str, int] = {}
    of_place: dict[int, int] = {}
    for place in places:
        one = done.combinations[place]
        if one.text:
            text = json.dumps(scene_of(problem_of(one.text, one.name, one.name)))
            of_place[place] = texts.setdefault(text, len(texts))
    return list(map(json.loads, texts)), of_place


def _text(value: Any) -> str:
    """A cell as the page shows it."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value + 0.0:.{_DIGITS}g}" if isinstance(value, float) else str(value)
