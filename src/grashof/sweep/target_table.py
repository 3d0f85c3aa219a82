"""A CSV of points or poses: each row the targets of a problem of its own."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from grashof.problems import ProblemError
from grashof.problems.files.spreadsheet import csv_rows
from grashof.problems.values.checks import located, noted, refuse
from grashof.sweep.keys import assigned, key_parts

NAME = "name"
_TARGET = re.compile(r"(x|y|angle)([1-9][0-9]*)(_deg)?")
_LAYOUTS = {"path": ("x", "y"), "motion": ("x", "y", "angle")}
_TARGETS = {"path": "points", "motion": "poses"}


def target_rows(path: Path, base: Mapping[str, Any]) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Rows of a CSV laid over a base problem: for each its cells by column, and the problem with its targets.

    The header is ``x1,y1,x2,y2,...`` for a path or ``x1,y1,angle1_deg,x2,...`` for a motion; besides ``name``
    and dotted keys of the problem file. An empty cell leaves a part of a pose free, a target with empty cells
    only is left out. ProblemError for all that is wrong with the table, a line each.
    """
    lines = csv_rows(path, "a CSV of points or poses")
    header = lines[0] if lines else []
    kind = base.get("kind")
    if kind not in _LAYOUTS:
        raise ProblemError(f'{path}: the problem that it is laid over has no kind = "path" or "motion"')
    _check_header(path, header, kind)
    rows: list[tuple[dict[str, Any], dict[str, Any]]] = []
    wrong: list[str] = []
    for number, line in enumerate(lines[1:], start=2):
        if any(cell.strip() for cell in line):
            with noted(wrong):
                rows.append(_row(f"{path}: line {number}", base, header, line))
    refuse(wrong)
    if not rows:
        raise ProblemError(f"{path}: has no rows; it must have a line for each task")
    return [({"row": number, **cells}, laid) for number, (cells, laid) in enumerate(rows, start=1)]


def _row(
    where: str, base: Mapping[str, Any], header: Sequence[str], line: Sequence[str]
) -> tuple[dict[str, Any], dict[str, Any]]:
    cells = _cells(where, header, line)
    try:
        return cells, _laid_over(base, str(base["kind"]), header, cells)
    except ProblemError as error:
        raise located(error, where) from None


def _check_header(path: Path, header: Sequence[str], kind: str) -> None:
    wrong: list[str] = []
    wanted = {_column(part, k) for k in range(1, _count(header) + 1) for part in _LAYOUTS[kind]}
    for name in header:
        if header.count(name) > 1:
            wrong.append(f"{path}: has column {name} {header.count(name)} times")
        elif name not in wanted and name != NAME:
            if "." in name:
                with noted(wrong):
                    key_parts(name, f"{path}: column")
            else:
                layout = ",".join(_column(part, k) for k in (1, 2) for part in _LAYOUTS[kind])
                wrong.append(f"{path}: column {name!r} is unknown; for a {kind} they are {layout},...")
    missing = [name for name in wanted if name not in header]
    wrong += [f"{path}: column {name} is missing" for name in sorted(missing)]
    if not wanted:
        wrong.append(f"{path}: has no columns {','.join(_column(part, 1) for part in _LAYOUTS[kind])},...")
    refuse(list(dict.fromkeys(wrong)))


def _count(header: Sequence[str]) -> int:
    found = (_TARGET.fullmatch(name) for name in header)
    return min(max((int(match[2]) for match in found if match), default=0), len(header))


def _column(part: str, number: int) -> str:
    return f"{part}{number}{'_deg' if part == 'angle' else ''}"


def _cells(where: str, header: Sequence[str], line: Sequence[str]) -> dict[str, Any]:
    if len(line) > len(header):
        raise ProblemError(f"{where} has {len(line)} cells; it must have {len(header)}, as the first line")
    wrong: list[str] = []
    cells: dict[str, Any] = {}
    for name, text in zip(header, [*line, *[""] * (len(header) - len(line))], strict=True):
        with noted(wrong):
            cells[name] = _cell(f"{where}: {name}", name, text.strip())
    refuse(wrong)
    return cells


def _cell(where: str, name: str, text: str) -> Any:
    if not text:
        return None  # judged with the others of its target
    if _TARGET.fullmatch(name):
        with suppress(ValueError):
            if math.isfinite(number := float(text)):
                return number
        raise ProblemError(f"{where} is {text!r}; it must be a finite number")
    if name != NAME:
        with suppress(tomllib.TOMLDecodeError):
            return tomllib.loads(f"value = {text}")["value"]
    return text


def _laid_over(
    base: Mapping[str, Any], kind: str, header: Sequence[str], cells: Mapping[str, Any]
) -> dict[str, Any]:
    """The problem file with the targets and other keys of a row."""
    wrong: list[str] = []
    targets: list[Any] = []
    for number in range(1, _count(header) + 1):
        with noted(wrong):
            targets.append(_target(kind, cells, number))
    refuse(wrong)
    table = base[kind] if isinstance(base.get(kind), dict) else {}
    document = {**base, kind: {**table, _TARGETS[kind]: [target for target in targets if target]}}
    for name, value in cells.items():
        if "." in name and value is not None:  # a key of the problem file
            document = assigned(document, key_parts(name), value)
    return document


def _target(kind: str, cells: Mapping[str, Any], number: int) -> Any:
    """A target of the file: a list, a table where a part is free, nothing where it is left out."""
    given = {part: cells[_column(part, number)] for part in _LAYOUTS[kind]}
    known = {part: value for part, value in given.items() if value is not None}
    for part in given:
        if kind == "path" and known and part not in known:
            raise ProblemError(f"{_column(part, number)} is empty; it must be a finite number")
    return list(known.values()) if len(known) == len(given) else known
