"""Problem files: the catalogue shipped with the package, and the user's own."""

from __future__ import annotations

import os
import tomllib
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path

from grashof.problems.checks import near_miss, readable
from grashof.problems.errors import ProblemError
from grashof.problems.problem import Problem


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
    >>> luggage, text = load_with_text("luggage")
    >>> text == problem_text("luggage")
    True
    """
    if isinstance(problem, str) and not _looks_like_path(problem):
        if problem in catalogue():
            text = problem_text(problem)
            return _parsed(text, f"{problem}.toml", problem), text
        # Path.exists raises for names that no file can have; this says False.
        if not problem or not os.path.exists(problem):  # noqa: PTH110
            raise ProblemError(f"{problem!r} is no problem of the catalogue and no file; {_hint(problem)}")
    path = Path(problem)
    text = _text(path)
    return _parsed(text, str(path), readable(path.stem)), text


def catalogue() -> tuple[str, ...]:
    """Names of the problems shipped with the package, sorted.

    Examples
    --------
    >>> "luggage" in catalogue()
    True
    """
    return tuple(sorted(_catalogue_files()))


def problem_text(name: str) -> str:
    """Problem of the catalogue as TOML, to copy and change.

    Raises
    ------
    ProblemError
        No problem of the catalogue has this name.

    Examples
    --------
    >>> print(problem_text("luggage").splitlines()[1])
    kind = "motion"
    """
    files = _catalogue_files()
    if name not in files:
        raise ProblemError(f"{name!r} is no problem of the catalogue; {_hint(name)}")
    return files[name].read_text(encoding="utf-8")


def _catalogue_files() -> dict[str, Traversable]:
    folder = resources.files("grashof.problems") / "data"
    return {Path(file.name).stem: file for file in folder.iterdir() if file.name.endswith(".toml")}


def _hint(name: str) -> str:
    meant = near_miss(name, catalogue())
    return f"did you mean {meant}?" if meant else f"the catalogue has {', '.join(catalogue())}"


def _looks_like_path(problem: str) -> bool:
    separators = {"/", os.sep, os.altsep}
    return problem.endswith(".toml") or any(sep in problem for sep in separators if sep)


def _text(path: Path) -> str:
    if os.path.isdir(path):  # noqa: PTH112
        raise ProblemError(f"{path}: is a folder; allowed is a problem file")
    try:
        # utf-8-sig: editors on Windows put a byte order mark first, which TOML does not know.
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise ProblemError(f"{path}: there is no such file; {_hint(path.stem)}") from None
    except OSError as error:
        raise ProblemError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ProblemError(f"{path}: is not UTF-8 text, at byte {error.start}") from None
    except ValueError as error:  # no name of a file, such as one with a null character
        raise ProblemError(f"{str(path)!r}: cannot be read: {error}") from None


def _parsed(text: str, file_name: str, name: str) -> Problem:
    # Here, not above: worker processes import this package, and need not pay for pydantic.
    from grashof.problems.schema import problem_from

    try:
        document = tomllib.loads(text)
    # Besides its own error: an integer of thousands of digits, lists nested a thousand deep.
    except (ValueError, RecursionError) as error:
        raise ProblemError(f"{file_name}: is not TOML: {error}") from None
    try:
        return problem_from(document, name)
    except ProblemError as error:
        raise ProblemError(f"{file_name}: {error}") from None
