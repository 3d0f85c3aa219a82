"""Problem files, of the catalogue shipped with the package and the user's own."""

from __future__ import annotations

import os
from pathlib import Path

from grashof.problems.files.on_disk import PROBLEMS, document_of
from grashof.problems.values.checks import located_in
from grashof.problems.values.specs.problem import Problem


def load(problem: str | os.PathLike[str]) -> Problem:
    """Problem of the catalogue, or of a TOML file.

    Parameters
    ----------
    problem : str or path-like
        A string with a path separator or ending in ``.toml``, and any path object, is a file.
        Another string is a name of the catalogue, or else a file in the current folder.

    Raises
    ------
    ProblemError
        No such problem, a file that cannot be read, or one that states no valid problem; the
        message begins with the name of the file.

    Examples
    --------
    >>> luggage = load("luggage")
    >>> len(luggage.task), luggage.requirements.link_length
    (4, (0.3, 8.0))
    """
    return load_with_text(problem)[0]


def load_with_text(problem: str | os.PathLike[str]) -> tuple[Problem, str]:
    """The same as `load`, with the text of the file, which is read once.

    Examples
    --------
    >>> from grashof.problems import problem_text
    >>> luggage, text = load_with_text("luggage")
    >>> text == problem_text("luggage")
    True
    """
    text, file_name, name, folder = PROBLEMS.read(problem)
    return problem_of(text, file_name, name, folder), text


def problem_of(text: str, file_name: str, name: str, folder: Path | None = None) -> Problem:
    """Problem that the text of a file states; messages begin with the name of the file.

    In a folder it may name other files, such as tables of loads.
    """
    # Here, not above: worker processes import this package, and need not pay for pydantic.
    from grashof.problems.files.problem_schema import problem_from

    document = document_of(text, file_name)
    with located_in(file_name):
        return problem_from(document, name, folder)
