"""Files that a problem file names in place of lists: tables of targets, drawings of areas and outlines."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from pathlib import Path
from typing import Any

from grashof.problems.files import drawing_files, spreadsheet
from grashof.problems.files.drawing_files import areas_of, outlines_of
from grashof.problems.files.target_files import points_of, poses_of
from grashof.problems.values.checks import located, noted, refuse
from grashof.problems.values.errors import ProblemError, shown

Read = Callable[[str, Path, str], dict[str, Any]]  # from a name, its folder and the length unit to keys


def _body(name: str, folder: Path, unit: str) -> dict[str, Any]:
    areas = areas_of(name, folder, unit)
    if len(areas) > 1:
        raise ProblemError(f"{name}: has {len(areas)} closed lines; a body must be one")
    return {"body": areas[0]}


# By table and key; what is read may be keys of the same table besides.
FILES: dict[tuple[str, str], tuple[tuple[str, ...], Read]] = {
    ("motion", "poses"): (spreadsheet.ENDINGS, lambda name, folder, _: poses_of(name, folder)),
    ("path", "points"): (spreadsheet.ENDINGS, lambda name, folder, _: points_of(name, folder)),
    ("motion", "body"): (drawing_files.ENDINGS, _body),
    ("requirements", "keep_out"): (
        drawing_files.ENDINGS,
        lambda name, folder, unit: {"keep_out": areas_of(name, folder, unit)},
    ),
    ("scene", "outlines"): (
        drawing_files.ENDINGS,
        lambda name, folder, unit: {"outlines": outlines_of(name, folder, unit)},
    ),
}


def with_files(document: dict[str, Any], folder: Path | None) -> dict[str, Any]:
    """A copy of a parsed problem file with what it names in place of the names.

    Names are relative to a folder; without it none may be given. `ProblemError` has what a file lacks, after
    the key that names it, a line each.
    """
    found, wrong = dict(document), list[str]()
    unit = document.get("length_unit", "")
    for (table, key), (endings, read) in FILES.items():
        stated = found.get(table)
        name = stated.get(key) if isinstance(stated, dict) else None
        if not isinstance(name, str) or not isinstance(stated, dict):
            continue
        with noted(wrong):
            found[table] = _filled(stated, f"{table}.{key}", name, endings, folder, read, unit)
    refuse(wrong)
    return found


def _filled(
    stated: dict[str, Any],
    where: str,
    name: str,
    endings: tuple[str, ...],
    folder: Path | None,
    read: Read,
    unit: Any,
) -> dict[str, Any]:
    """A table with what a file has in place of its name."""
    if Path(name.partition("#")[0]).suffix.lower() not in endings:
        raise ProblemError(f"{where} is {shown(name)}; it must be a list, or a file {' or '.join(endings)}")
    if folder is None:
        raise ProblemError(f"{where} is the file {name}; here it must be a list instead")
    try:
        keys = read(name, folder, unit if isinstance(unit, str) else "")
    except ProblemError as error:
        raise located(error, where) from None
    filled = copy(stated)
    for key, value in keys.items():
        if key in stated and not where.endswith(f".{key}"):
            raise ProblemError(f"{where}: {name} has {key}, which is given besides; give one of them")
        filled[key] = value
    return filled
