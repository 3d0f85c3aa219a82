"""Requests of a live page, checked against limits; the jobs for its solvers, and the lines that come back."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn

from grashof.problems import Problem, ProblemError, catalogue, load_linkage_spec, load_with_text
from grashof.problems.files.design_link import is_link, read_link
from grashof.problems.files.on_disk import document_of, problem_text
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.checks import located_in
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.text import file_name

KINDS = ("track", "search", "file", "outline")
FILES = ("problem", "list", "designs", "report", "dxf", "linkage", "link", "problem-link")
TOP = 50  # families in a list, as `grashof solve` has them
MOST_BYTES = 1_000_000  # of a request
MOST_TARGETS = 200
MOST_CORNERS = 1000  # of all areas, outlines and bodies together
MOST_EFFORT = 4.0
MOST_KEYS = 50
_DEPTH = 12  # of tables and lists in each other


@dataclass(frozen=True, slots=True)
class Job:
    """Work for a page, one of `KINDS`, with the problem file as JSON and its name.

    `options` are those of the kind: keys of designs, a kind of file, the text of a drawing, the linkage
    file of a link; `shown` has the designs of the page, as the previous job left them.
    """

    what: str
    document: dict[str, Any]
    name: str
    options: Mapping[str, Any] = field(default_factory=dict)
    shown: bytes = b""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of JSON for the page; `shown` has the designs of the page from now on."""

    text: str
    shown: bytes | None = None


def error_line(*lines: str) -> Line:
    """A line that states an error."""
    return Line(json.dumps({"kind": "error", "lines": list(lines)}))


def request_of(body: bytes) -> dict[str, Any]:
    """The table in a request; ProblemError where it is too large, has NaN, or is not a table in JSON."""
    if len(body) > MOST_BYTES:
        raise ProblemError(f"the request has {len(body)} bytes; at most {MOST_BYTES} are allowed")
    try:
        found = json.loads(body, parse_constant=_no_constant)
    except (ValueError, RecursionError):
        raise ProblemError("the request is not JSON with finite numbers") from None
    if not isinstance(found, dict):
        raise ProblemError("the request must be a table")
    return found


def _no_constant(word: str) -> NoReturn:
    raise ValueError(word)


def job_of(request: dict[str, Any], shown: bytes = b"") -> Job:
    """The job of a request with "what", "document", "name", and what its kind needs.

    That is "keys" to follow, "given" to search, "text" of an outline; "key", "file" and "address" of a file.
    ProblemError where it is malformed or exceeds a limit.
    """
    what = _one_of(request, "what", KINDS)
    document = request.get("document")
    if not isinstance(document, dict):
        raise wrong_value("document", document, "a problem file as a table")
    refuse_too_much(document)
    options: dict[str, Any] = {"keys": _keys(request.get("keys", []), "keys")}
    if what == "outline":
        options = {"text": _text(request, "text", "a DXF file")}
    if what == "search":
        options = {"given": _text(request, "given", "a linkage file") if "given" in request else ""}
    if what == "file":
        options = {
            "file": _one_of(request, "file", FILES),
            "key": _keys([request.get("key", 0)], "key")[0],
            "address": _text(request, "address", "a page") if "address" in request else "",
        }
    return Job(what, document, name_of(request.get("name", "")), options, shown)


def name_of(name: object) -> str:
    """A name for files from that of a request."""
    if not isinstance(name, str):
        raise wrong_value("name", name, "text")
    return file_name(name)


def _one_of(request: dict[str, Any], key: str, allowed: tuple[str, ...]) -> str:
    word = request.get(key)
    if word not in allowed:
        raise wrong_value(key, word, f"one of {', '.join(allowed)}")
    return str(word)


def _text(request: dict[str, Any], key: str, of: str) -> str:
    if not isinstance(text := request.get(key), str):
        raise ProblemError(f"{key} must be that of {of}")
    return text


def _keys(given: object, name: str) -> list[int]:
    if not isinstance(given, list) or len(given) > MOST_KEYS:
        raise wrong_value(name, given, f"a list of at most {MOST_KEYS} numbers of designs")
    for key in given:
        if isinstance(key, bool) or not isinstance(key, int):
            raise wrong_value(name, key, "the number of a design")
    return given


def refuse_too_much(document: dict[str, Any]) -> None:
    """Refuse more targets, corners or effort than the live page takes (ProblemError).

    They would keep a solver busy for long; `grashof solve` takes them.
    """
    tables = [each for key, each in document.items() if isinstance(each, dict) and key != "scene"]
    lists = [each for table in tables for each in table.values() if isinstance(each, list)]
    targets = max(map(len, lists), default=0)
    if targets > MOST_TARGETS:
        raise ProblemError(f"the task has {targets} targets; the live page takes at most {MOST_TARGETS}")
    _count_numbers(document)  # refuses deep nesting
    corners = _count_numbers([document.get("scene"), _entry(document, "requirements", "keep_out")])
    if corners > 2 * MOST_CORNERS:
        raise ProblemError(
            f"areas and outlines have {corners // 2} corners; at most {MOST_CORNERS} are drawn"
        )
    effort = _entry(document, "search", "effort")
    if isinstance(effort, int | float) and effort > MOST_EFFORT:
        raise ProblemError(f"search.effort is {effort:g}; the live page takes at most {MOST_EFFORT:g}")


def _entry(document: dict[str, Any], table: str, key: str) -> object:
    found = document.get(table)
    return found.get(key) if isinstance(found, dict) else None


def _count_numbers(value: object, depth: int = 0) -> int:
    """Count the numbers in nested tables and lists; refuse those nested too deeply."""
    if depth > _DEPTH:
        raise ProblemError(f"the document has tables in each other more than {_DEPTH} deep")
    if isinstance(value, dict | list):
        entries = value.values() if isinstance(value, dict) else value
        return sum(_count_numbers(each, depth + 1) for each in entries)
    return int(isinstance(value, int | float))


def document_from(text: str, name: str) -> dict[str, Any]:
    """A problem file as JSON; ProblemError where it is invalid or names other files."""
    problem_of(text, f"{name}.toml", name)
    return document_of(text, f"{name}.toml")


def beginning(problem: Problem | str | None) -> dict[str, Any]:
    """The "document" and "name" of a new page: of a problem, or by the name of one, a file or a link.

    Tables of numbers that a file names become part of the document. ProblemError where the problem is invalid
    or exceeds a limit.
    """
    if isinstance(problem, str) and is_link(problem):
        return _linked(problem)
    if isinstance(problem, Problem):
        found, text = problem, problem_toml(problem)
    else:
        found, text = load_with_text("luggage" if problem is None else problem)
    try:
        document = document_from(text, found.name)
    except ProblemError:  # it names files beside it, which the page cannot reach
        document = document_of(problem_toml(found), found.name)
    refuse_too_much(document)
    return {"document": document, "name": name_of(Path(found.name).name)}


def _linked(link: str) -> dict[str, Any]:
    """The "document" and "name" of a link, and a linkage file "given" with them.

    ProblemError where they are invalid, or exceed a limit.
    """
    shared = read_link(link)
    refuse_too_much(shared.document)
    with located_in("the link"):
        problem_from(shared.document, shared.name)
    given = {}
    if shared.linkage:
        load_linkage_spec(link)
        given = {"given": shared.linkage}
    return {"document": shared.document, "name": shared.name, **given}


def opened(begin: dict[str, Any], request: dict[str, Any]) -> dict[str, Any]:
    """The "document" and "name" that a request opens, and the "catalogue".

    They are those of a link, of a problem of the catalogue, of a file or, by default, of the first problem.
    """
    found = begin
    if "link" in request:
        found = _linked(_text(request, "link", "a design"))
    elif "text" in request:
        text, name = _text(request, "text", "a problem file"), name_of(request.get("name", ""))
        found = {"document": document_from(text, name), "name": name}
    elif "catalogue" in request:
        name = str(request["catalogue"])
        found = {"document": document_from(problem_text(name), name), "name": name}
    return {**found, "catalogue": list(catalogue())}
