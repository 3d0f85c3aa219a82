"""Linkage files: one linkage as TOML, the catalogue of real ones, and designs out of a candidates list."""

from __future__ import annotations

import json
import os
import re
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from grashof.problems.files.design_link import SharedDesign, is_link, read_link
from grashof.problems.files.on_disk import (
    LINKAGES,
    MOST_BYTES_MADE,
    catalogue,
    document_of,
    exists,
    file_text,
)
from grashof.problems.files.problem_file import problem_of
from grashof.problems.values import checks
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.errors import ProblemError, shown
from grashof.problems.values.linkages.cylinder import Cylinder
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import MECHANISMS, WORDS
from grashof.problems.values.linkages.mechanisms import FOUR_BAR, mechanism
from grashof.problems.values.specs.linkage_spec import LinkageSpec, ListedDesign
from grashof.problems.values.specs.problem import Problem
from grashof.problems.values.text import readable

_LAST_RANK = 10**9
_VERSION = r"[0-9A-Za-z.+!_-]{1,40}"


def load_linkage(linkage: str | os.PathLike[str]) -> Linkage:
    """Linkage of the catalogue, of a TOML file, or of a candidates list.

    Parameters
    ----------
    linkage : str or path-like
        A name of `linkage_catalogue`, a linkage file, ``DIR/candidates.json#3`` for the design of
        rank 3 of a list, in place of the rank also the design's id, or a link copied from the live page.

    Raises
    ------
    ProblemError
        No such linkage, a file that cannot be read, or one that states no valid linkage; the
        message begins with the name of the file.

    Examples
    --------
    >>> pumpjack = load_linkage("pumpjack")
    >>> float(pumpjack.r1), float(pumpjack.r2)
    (5.0, 1.1938)
    """
    return load_linkage_spec(linkage).linkage


def load_linkage_spec(linkage: str | os.PathLike[str]) -> LinkageSpec:
    """The same as `load_linkage`, with title, source, unit, output arm and masses.

    Examples
    --------
    >>> unit = load_linkage_spec("lufkin-c912d")
    >>> unit.length_unit, unit.output_arm
    ('in', 180.0)
    """
    text = os.fspath(linkage)
    if is_link(text):
        return _linked(read_link(text))
    file, mark, which = text.rpartition("#")
    if mark and file.endswith(".json"):
        return _candidate(Path(file), which)[0]
    table, row = (file, which) if mark and file.endswith(".csv") else (text, "1")
    if Path(table).name == "nearest.csv":
        raise ProblemError(f"{text}: is a table of misses; a linkage file with their dimensions can be read")
    if table.endswith(".csv"):
        raise ProblemError(f"{text}: is a table; name the design as {table.removesuffix('.csv')}.json#{row}")
    if text.endswith(".json"):
        raise ProblemError(f"{text}: is a list of designs; name one of them, such as {text}#1")
    if isinstance(linkage, str) and text in catalogue() and not exists(text):
        raise ProblemError(_problem_given(text, text))
    return linkage_spec_of(*LINKAGES.read(linkage))


def load_design(path: Path, which: str) -> ListedDesign:
    """Design of a list of `grashof solve`, by rank or id; `ProblemError` also where it states no targets."""
    spec, design = _candidate(path, which)
    try:
        return ListedDesign(
            spec=spec,
            rank=_rank(design["rank"]),
            id=readable(str(design["id"])),
            theta2=tuple(
                checks.number_within(angle, -checks.GREATEST, checks.GREATEST, "theta2")
                for angle in design["theta2"]
            ),
            assembly=tuple(design["assembly"]),
            position_error=_errors(design["position_error"]),
            angle_error=_errors(design.get("angle_error", [])),
        )
    except (KeyError, TypeError, ValueError):
        raise ProblemError(
            f"{path}#{which}: states no targets; it must be a candidates.json of grashof solve"
        ) from None


def _problem_given(given: str, name: str) -> str:
    return f"{given}: is a problem; solve it, then name a design: {name}-designs/candidates.json#1"


def linkage_spec_of(text: str, file_name: str, name: str, folder: Path | None = None) -> LinkageSpec:
    """Linkage that the text of a file states; messages begin with the name of the file."""
    # Here, not above: worker processes import this package, and need not pay for pydantic.
    from grashof.problems.files.linkage_schema import linkage_from

    document = document_of(text, file_name)
    if "kind" in document:
        raise ProblemError(_problem_given(file_name, name))
    with checks.located_in(file_name):
        return linkage_from(document, name, folder)


def _linked(shared: SharedDesign) -> LinkageSpec:
    """The design of a link, with its problem."""
    # Here, not above, likewise.
    from grashof.problems.files.problem_schema import problem_from

    if not shared.linkage:
        raise ProblemError("the link has a problem alone, without a design; grashof live opens it")
    spec = linkage_spec_of(shared.linkage, "the link", shared.name)
    with checks.located_in("the link"):
        return replace(spec, problem=problem_from(shared.document, shared.name))


def _candidate(path: Path, which: str) -> tuple[LinkageSpec, dict[str, Any]]:
    """Design of a list that `grashof solve` wrote, and its entry in the list."""
    try:
        content = json.loads(file_text(path, "a list of designs", most=MOST_BYTES_MADE))
        designs = {_rank(design["rank"]): design for design in content["designs"]}
        ranks = {
            str(name): rank for rank, design in designs.items() for name in (rank, design.get("id", rank))
        }
        heading = {"title": content["title"] or content["problem"], "length_unit": content["length_unit"]}
    except ProblemError:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError):
        raise ProblemError(
            f"{path}: is not a list of designs; it must be a candidates.json of grashof solve"
        ) from None
    with checks.located_in(f"{path}#{which}"):
        if which not in ranks:
            hint = (
                f"name a rank, 1 to {max(designs)}, or the id of a design" if designs else "the list is empty"
            )
            raise ProblemError(f"has no design {which or '(none named)'}; {hint}")
        design = designs[ranks[which]]
        # JSON can spell values that no file can.
        heading = {key: readable(x) if isinstance(x, str) else x for key, x in heading.items()}
        spec, direction = _design(design, heading | {"dynamics": content.get("dynamics", {})}, path)
    problem = _listed_problem(content, path)
    dynamics = ((spec if problem is None else problem).dynamics or DynamicsSpec()).turning(direction)
    with checks.located_in(f"{path}#{which}"):
        dynamics = _with_parts(dynamics, design)
        return replace(spec, dynamics=dynamics, problem=problem), design


def _design(design: dict[str, Any], document: dict[str, Any], path: Path) -> tuple[LinkageSpec, int]:
    """The linkage of an entry of a list, and the sense of its driver."""
    from grashof.problems.files.linkage_schema import as_document, linkage_from

    kind = mechanism(design.get("mechanism", FOUR_BAR), among=WORDS)
    keys = _names(kind, design.get("linkage"))
    try:
        stated = {key: design["linkage"][key] for key in keys}
        turned = {key: stated.pop(key) for key, angle in keys.items() if angle}
        direction = design["direction"]
    except (KeyError, TypeError):
        raise ProblemError(f"states no linkage and direction; the keys are {', '.join(keys)}") from None
    cylinder = _cylinder(design.get("cylinder"))
    name = readable(f"{path.parent.name or path.stem}-{design['rank']}")
    spec = linkage_from({**document, "mechanism": kind, **as_document(stated)}, name)
    angles = {key: np.asarray(checks.finite_number(angle, key)) for key, angle in turned.items()}
    if direction not in (1, -1):
        raise ProblemError(f"direction is {shown(direction)}; it must be +1 or -1")
    title, source = f"{spec.title}: design {design['rank']}", readable(str(path))
    linkage = spec.linkage.changed(**angles)
    return replace(spec, linkage=linkage, title=title, source=source, cylinder=cylinder), direction


def _with_parts(dynamics: DynamicsSpec, design: dict[str, Any]) -> DynamicsSpec:
    """The dynamics with the travel of a design, and its struts and springs from a list."""
    from grashof.problems.files.effort_schema import parts_from

    effort, given = dynamics.effort, design.get("parts")
    if effort is None:
        return dynamics
    if given is not None:
        effort = replace(effort, parts=parts_from(given))
    ends = design.get("theta2")
    if isinstance(ends, list) and len(ends) > 1 and ends[0] != ends[-1]:
        angles = [checks.finite_number(angle, "theta2") for angle in (ends[0], ends[-1])]
        first, last = np.degrees(angles).tolist()
        effort = replace(effort, travel_deg=(first, last))
    return replace(dynamics, effort=effort)


def _names(word: str, stated: Any) -> dict[str, bool]:
    """Keys of `Linkage.stated` for a kind of linkage, and whether each is an angle."""
    rows = [row for row in MECHANISMS if row.word == word]
    given = set(stated) if isinstance(stated, dict) else set()
    kind = max(rows, key=lambda row: len(given & {each.name for each in row.parameters}))
    choices = ("hosts", "point_link") if len(kind.dyads) > 1 else ()
    return {each.name: each.kind == "angle" for each in kind.parameters} | dict.fromkeys(choices, False)


def _cylinder(stated: Any) -> Cylinder | None:
    """The cylinder that a list states of a design."""
    if stated is None:
        return None
    keys = ("on", "base", "point")
    if not isinstance(stated, dict) or not all(key in stated for key in keys):
        raise ProblemError(f"cylinder is {shown(stated)}; it must be an object of {', '.join(keys)}")
    return Cylinder(*(stated[key] for key in keys))


def _listed_problem(content: dict[str, Any], path: Path) -> Problem | None:
    """The problem that a list was made for; None where a list, made by hand, does not state it."""
    if (text := content.get("problem_toml")) is None:
        return None
    wrong = f"{shown(text)} is not text"
    if isinstance(text, str):
        try:
            return problem_of(text, "problem_toml", readable(str(content.get("problem", path.stem))))
        except ProblemError as error:
            wrong = str(error).splitlines()[0]
    writer = content.get("grashof")
    if not (isinstance(writer, str) and re.fullmatch(_VERSION, writer)):
        writer = "of unknown version"
    raise ProblemError(
        f"{path}: was written by grashof {writer}, and grashof {version('grashof')} cannot read its problem: "
        f"{wrong}; solve it again"
    )


def _errors(given: list[float | None]) -> tuple[float | None, ...]:
    return tuple(
        None if error is None else checks.number_within(error, 0.0, checks.GREATEST, "error")
        for error in given
    )


def _rank(given: object) -> int:
    """A rank; `ValueError` where it is not one."""
    if isinstance(given, bool) or not isinstance(given, int) or not 1 <= given <= _LAST_RANK:
        raise ValueError
    return given
