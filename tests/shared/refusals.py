"""Refusals, and problem files to try them with."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from typing import Any

import pytest

from grashof.problems import Problem, ProblemError
from grashof.problems.files.problem_schema import problem_from

POSES = "poses = [[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]]"
MOTION = f'kind = "motion"\n[motion]\n{POSES}\n'
PATH = 'kind = "path"\n[path]\npoints = [[20, 20], [20, 25], [21, 30]]\n'


def refusal(make: Callable[..., object], *given: Any, **named: Any) -> str:
    """The lines with which something is refused."""
    with pytest.raises(ProblemError) as caught:
        make(*given, **named)
    return str(caught.value)


def problem(text: str) -> Problem:
    """The problem of a file."""
    return problem_from(tomllib.loads(text), "test")


def message(text: str) -> str:
    """The refusal of its file, without a chained cause."""
    with pytest.raises(ProblemError) as caught:
        problem(text)
    assert caught.value.__cause__ is None
    return str(caught.value)


def rows(table: str, **texts: str) -> list[tuple[str, ...]]:
    r"""The rows of a table with ` | ` between its cells; an indented line continues the row above.

    In a cell, `\n` is the end of a line, `#` alone no text, and `<NAME>` the text of that name.
    """
    for name, text in texts.items():
        table = table.replace(f"<{name}>", text.replace("\n", r"\n"))
    joined = re.sub(r"(\\n| ?)\n +", lambda end: end[1] or " ", table.strip("\n"))
    lines = (line.split(" | ") for line in joined.splitlines())
    return [tuple(cell.removeprefix("#").replace(r"\n", "\n") for cell in line) for line in lines]
