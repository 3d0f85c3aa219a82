"""What a page may ask for: within limits, and refused in a line otherwise."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

from grashof.live.jobs import FILES, KINDS, Job
from grashof.problems import Problem, ProblemError, catalogue, load_with_text
from grashof.problems.files.on_disk import document_of
from grashof.problems.files.problem_file import problem_of, problem_text
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.checks import readable
from grashof.problems.values.errors import wrong_value

MOST_BYTES = 1_000_000  # of a request
MOST_TARGETS = 200
MOST_CORNERS = 1000  # of all areas, outlines and bodies together
MOST_EFFORT = 4.0
MOST_KEYS = 50
_DEPTH = 12  # of tables and lists in each other
_NAME = re.compile(r"[^\w.-]+")


def request_of(body: bytes) -> dict[str, Any]:
    """A request as JSON without NaN; ProblemError where it is too large, no JSON, or no table."""
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
    """The job that a request asks for; ProblemError where it is malformed or more than one page may ask.

    It has "what", "document", "name", and for some kinds "keys", "key", "file" and "text".
    """
    what = _one_of(request, "what", KINDS)
    document = request.get("document")
    if not isinstance(document, dict):
        raise wrong_value("document", document, "a problem file as a table")
    refuse_too_much(document)
    options: dict[str, Any] = {"keys": _keys(request.get("keys", []), "keys")}
    if what == "outline":
        if not isinstance(text := request.get("text"), str):
            raise ProblemError("text must be that of a DXF file")
        options = {"text": text}
    if what == "file":
        options = {"file": _one_of(request, "file", FILES), "key": _keys([request.get("key", 0)], "key")[0]}
    return Job(what, document, name_of(request.get("name", "")), options, shown)


def name_of(name: object) -> str:
    """A name for files, of letters, digits, dots and dashes.

    >>> name_of("../my task"), name_of("")
    ('my-task', 'task')
    """
    if not isinstance(name, str):
        raise wrong_value("name", name, "text")
    return _NAME.sub("-", readable(name)).strip("-._")[:60] or "task"


def _one_of(request: dict[str, Any], key: str, allowed: tuple[str, ...]) -> str:
    word = request.get(key)
    if word not in allowed:
        raise wrong_value(key, word, f"one of {', '.join(allowed)}")
    return str(word)


def _keys(given: object, name: str) -> list[int]:
    if not isinstance(given, list) or len(given) > MOST_KEYS:
        raise wrong_value(name, given, f"a list of at most {MOST_KEYS} numbers of designs")
    for key in given:
        if isinstance(key, bool) or not isinstance(key, int):
            raise wrong_value(name, key, "the number of a design")
    return given


def refuse_too_much(document: dict[str, Any]) -> None:
    """ProblemError for more targets, corners or effort than a page may ask for.

    What is refused would keep a solver busy for long; `grashof solve` takes it.
    """
    targets = max((len(each) for table in _tables(document) for each in _lists(table)), default=0)
    if targets > MOST_TARGETS:
        raise ProblemError(f"the task has {targets} targets; the live page takes at most {MOST_TARGETS}")
    _numbers(document)
    wanted = document.get("requirements")
    areas = wanted.get("keep_out") if isinstance(wanted, dict) else None
    corners = _numbers(document.get("scene")) + _numbers(areas)
    if corners > 2 * MOST_CORNERS:
        raise ProblemError(
            f"areas and outlines have {corners // 2} corners; at most {MOST_CORNERS} are drawn"
        )
    search = document.get("search")
    effort = search.get("effort") if isinstance(search, dict) else None
    if isinstance(effort, int | float) and effort > MOST_EFFORT:
        raise ProblemError(f"search.effort is {effort:g}; the live page takes at most {MOST_EFFORT:g}")


def _tables(document: dict[str, Any]) -> Iterator[dict[str, Any]]:
    return (
        each for each in document.values() if isinstance(each, dict) and each is not document.get("scene")
    )


def _lists(table: dict[str, Any]) -> Iterator[list[Any]]:
    return (each for each in table.values() if isinstance(each, list))


def _numbers(value: object, depth: int = 0) -> int:
    """How many numbers there are in tables and lists within each other; too deep ones are refused."""
    if depth > _DEPTH:
        raise ProblemError(f"the document has tables in each other more than {_DEPTH} deep")
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        return sum(_numbers(each, depth + 1) for each in value)
    return int(isinstance(value, int | float))


def document_from(text: str, name: str) -> dict[str, Any]:
    """A problem file as JSON; ProblemError where it states no valid problem, or names other files.

    >>> document_from(problem_text("luggage"), "luggage")["motion"]["poses"][0]
    [5, 4, 0]
    """
    problem_of(text, f"{name}.toml", name)
    return document_of(text, f"{name}.toml")


def beginning(problem: Problem | str | None) -> dict[str, Any]:
    """What a page begins with: a problem, one of the catalogue, one from a file, or luggage.

    Tables of numbers that a file names become part of the document. ProblemError where it is no problem, or
    more than a page may ask for.
    """
    if isinstance(problem, Problem):
        found, text = problem, problem_toml(problem)
    else:
        found, text = load_with_text("luggage" if problem is None else problem)
    try:
        document = document_from(text, found.name)
    except ProblemError:  # it names files beside it, which the page has no way to
        document = document_of(problem_toml(found), found.name)
    refuse_too_much(document)
    return {"document": document, "name": name_of(Path(found.name).name)}


def opened(begin: dict[str, Any], request: dict[str, Any]) -> dict[str, Any]:
    """What a page asks for: the problem it begins with, one of the catalogue, or a file's text.

    As "document", "name", and the names of the "catalogue"; ProblemError where it is no problem.
    """
    found = begin
    if "text" in request:
        text, name = request["text"], name_of(request.get("name", ""))
        if not isinstance(text, str):
            raise ProblemError("text must be that of a problem file")
        found = {"document": document_from(text, name), "name": name}
    elif "catalogue" in request:
        name = str(request["catalogue"])
        found = {"document": document_from(problem_text(name), name), "name": name}
    return {**found, "catalogue": list(catalogue())}
