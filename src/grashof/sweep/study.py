"""Study files: which problems a sweep solves, which of their keys it varies, how hard it searches."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import AfterValidator, Field, field_validator

from grashof.problems import ProblemError, catalogue, problem_text
from grashof.problems.files.on_disk import document_of, exists, file_text, looks_like_path
from grashof.problems.files.tables import Table, Text, listed, stated
from grashof.problems.values.checks import (
    finite_number,
    located,
    noted,
    positive_number,
    refuse,
    refused,
    whole_number,
)
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.specs.problem import Search
from grashof.problems.values.text import near_miss, readable
from grashof.sweep.keys import key_parts, overlap
from grashof.sweep.target_table import NAME, target_rows

MOST_COMBINATIONS = 100_000
_RANGE = ("from", "to", "steps")
_RANGE_SHAPE = "a list of values or { from = a, to = b, steps = n }"
_SIGNIFICANT = 12  # digits of the values of a range: 0.1 + 0.2 is 0.3


@dataclass(frozen=True, slots=True)
class Source:
    """A parsed problem file that the varied keys are set in; its tables of loads are relative to its folder.

    `cells` and `label` distinguish it from other sources, empty for a single one; `wrong` is its error.
    """

    name: str
    cells: Mapping[str, Any]
    document: dict[str, Any]
    label: str = ""
    wrong: str = ""
    folder: Path | None = None


@dataclass(frozen=True, slots=True)
class Study:
    """A study, as its file states it.

    Parameters
    ----------
    name : str
    title : str
    sources : tuple of Source
        One problem, the problems of a folder, or one for each row of a table.
    vary : mapping of str to list
        Values of each varied key.
    together : tuple of tuple of str
        Keys that vary in step.
    search : mapping
        ``starts``, ``effort``, ``seed`` and ``enough`` in place of the problems' own.
    designs : int
        Best designs that the table lists of each combination.
    time_limit : float, s, optional
        Of each combination.
    parquet : bool
        Whether the table is written as Parquet, too.
    text : str
        The study file.
    """

    name: str
    title: str
    sources: tuple[Source, ...]
    vary: Mapping[str, Sequence[Any]]
    together: tuple[tuple[str, ...], ...] = ()
    search: Mapping[str, Any] | None = None
    designs: int = 1
    time_limit: float | None = None
    parquet: bool = False
    text: str = ""

    @property
    def axes(self) -> tuple[tuple[str, ...], ...]:
        """Varied keys, those that vary in step as one; the last changes fastest."""
        grouped = {key: keys for keys in self.together for key in keys}
        return tuple(dict.fromkeys(grouped.get(key, (key,)) for key in self.vary))


def load_study(path: str | os.PathLike[str]) -> Study:
    """Study of a TOML file.

    Raises
    ------
    ProblemError
        No such file, or an invalid study: all errors, a line each, which begins with a file's name.
    """
    file = Path(path)
    text = file_text(file, "a study file")
    document = document_of(text, str(file))
    sources: tuple[Source, ...] = ()
    wrong: list[str] = []
    with noted(wrong):
        study = stated(StudyFile, document)
    elsewhere: list[str] = []
    with noted(elsewhere):
        sources = _sources(document, file.parent)
    if wrong or elsewhere:
        raise refused([*(str(located(ProblemError(line), str(file))) for line in wrong), *elsewhere])
    search = study.search.model_dump(exclude_none=True)
    return Study(
        name=readable(file.stem),
        title=study.title,
        sources=sources,
        vary={key: _values(given) for key, given in _flat(study.vary)},
        together=tuple(map(tuple, study.together)),
        time_limit=search.pop("time_limit", None),
        search=search,
        designs=study.designs,
        parquet=study.parquet,
        text=text,
    )


class SearchOptions(Table):
    """How hard to search, in place of the problems' own tables of this name.

    Parameters
    ----------
    time_limit : float, s
        Of each combination; the table of the sweep then depends on the machine.
    """

    described_by: ClassVar[tuple[type, ...]] = (Search,)

    starts: int | None = None
    enough: int | None = None
    effort: float | None = None
    seed: int | None = None
    time_limit: float | None = None

    @field_validator("starts", "enough", "effort", "seed")
    @classmethod
    def _as_in_problems(cls, given: Any, key: Any) -> Any:
        Search(**{str(key.field_name): given})
        return given

    @field_validator("time_limit")
    @classmethod
    def _positive(cls, given: float) -> float:
        return positive_number(given, "search.time_limit")


Keys = Annotated[list[str], listed("a list of keys of vary")]


class StudyFile(Table):
    """A study file.

    Parameters
    ----------
    title : str
        For people: heading of the page and of the plot.
    problem : str
        The problem that is varied: a name of the catalogue or a file, relative to the study.
    problems : str
        Instead: a folder whose problem files are all solved.
    table : str
        With `problem`: a CSV file; each row gives the targets of one problem.
    designs : int
        Best designs that the table lists of each combination.
    parquet : bool
        Whether sweep.parquet is written, too; needs `grashof[parquet]`.
    together : list
        Keys that vary in step; all others vary in every combination.
    vary : table
        Keys of the problem file, each with a list of values or an even range
        ``{ from = 1, to = 2, steps = 3 }``; entries of lists count from 0.
    search : SearchOptions
        In place of the problem's own.
    """

    title: Text = ""
    problem: str | None = None
    problems: str | None = None
    table: str | None = None
    designs: Annotated[int, AfterValidator(lambda given: whole_number(given, 1, "designs"))] = 1
    parquet: bool = False
    together: Annotated[list[Keys], listed("a list of lists of keys of vary")] = Field(default_factory=list)
    vary: dict[str, Any] = Field(default_factory=dict)
    search: SearchOptions = SearchOptions()

    @field_validator("vary")
    @classmethod
    def _varied(cls, given: dict[str, Any]) -> dict[str, Any]:
        wrong: list[str] = []
        for key, values in _flat(given):
            with noted(wrong):
                key_parts(key, "vary: a key")
                _values(values, f"vary.{key}")
        refuse(wrong)
        if overlap([key_parts(key) for key, _ in _flat(given)]):
            raise ProblemError("vary has a key and another one within it; each part may vary once")
        return given

    def value(self) -> None:
        wrong: list[str] = []
        if (self.problem is None) == (self.problems is None):
            wrong.append('a study needs problem = "..." or problems = "a folder"; it must have one of them')
        if self.table is not None and self.problem is None:
            wrong.append("table needs problem = ..., which its rows are laid over")
        if not self.vary and self.problems is None and self.table is None:
            wrong.append("vary is missing; a study varies something, or has problems or a table")
        wrong += _ill_joined(self.together, dict(_flat(self.vary)))
        refuse(wrong)


def _ill_joined(together: Sequence[Sequence[str]], vary: Mapping[str, Any]) -> list[str]:
    """Errors in the keys that vary in step."""
    wrong: list[str] = []
    seen: set[str] = set()
    for i, keys in enumerate(together):
        counts = {key: len(_values(vary[key])) for key in keys if key in vary}
        for key in keys:
            if key not in vary:
                meant = near_miss(key, list(vary))
                hint = f"; did you mean {meant}?" if meant else ""
                wrong.append(f"together[{i}] has {key}, which is not in vary{hint}")
            if key in seen:
                wrong.append(f"together[{i}] has {key} once more; a key may be there once")
            seen.add(key)
        if len(set(counts.values())) > 1:
            shown = ", ".join(f"{key} {count}" for key, count in counts.items())
            wrong.append(f"together[{i}] has keys with different numbers of values: {shown}")
    return wrong


def _flat(tables: Mapping[str, Any], above: str = "") -> list[tuple[str, Any]]:
    """Varied keys with their values or range; keys without quotes are tables in TOML."""
    found: list[tuple[str, Any]] = []
    for key, given in tables.items():
        name = f"{above}{key}"
        if isinstance(given, dict) and not any(word in given for word in _RANGE):
            found += _flat(given, f"{name}.")
        else:
            found.append((name, given))
    return found


def _values(given: Any, where: str = "vary") -> list[Any]:
    """The values of a varied key: as listed, or evenly spaced."""
    if isinstance(given, list) and given:
        return given
    if not isinstance(given, dict) or set(given) != set(_RANGE):
        raise wrong_value(where, given, _RANGE_SHAPE)
    low, high = (finite_number(given[word], f"{where}.{word}") for word in _RANGE[:2])
    steps = whole_number(given["steps"], 2, f"{where}.steps", MOST_COMBINATIONS)
    evenly = [float(f"{low + (high - low) * k / (steps - 1):.{_SIGNIFICANT}g}") for k in range(steps)]
    integers = all(isinstance(given[word], int) for word in _RANGE[:2])
    if integers and all(value.is_integer() for value in evenly):
        return [int(value) for value in evenly]
    return evenly


def _sources(document: Mapping[str, Any], folder: Path) -> tuple[Source, ...]:
    """The problems that a study names; none where it names them in the wrong way."""
    named, several, table = (document.get(key) for key in ("problem", "problems", "table"))
    if isinstance(several, str) and named is None:
        return _problems_in(folder / several)
    if not isinstance(named, str):
        return ()
    base = _base(named, folder)
    if not isinstance(table, str):
        return (base,)
    rows = target_rows(folder / table, base.document)
    labels = (f"row {cells['row']}{f' ({cells[NAME]})' if cells.get(NAME) else ''}" for cells, _ in rows)
    made = zip(rows, labels, strict=True)
    return tuple(Source(base.name, cells, laid, label, folder=base.folder) for (cells, laid), label in made)


def _base(named: str, folder: Path) -> Source:
    """The problem of the catalogue of this name, or of a file beside the study."""
    if not looks_like_path(named) and named in catalogue():
        return Source(named, {}, document_of(problem_text(named), f"{named}.toml"))
    path = folder / named
    if not looks_like_path(named) and not exists(str(path)):
        meant = near_miss(named, catalogue())
        hint = f"did you mean {meant}?" if meant else f"the catalogue has {', '.join(catalogue())}"
        raise ProblemError(f"{named!r} is neither a problem of the catalogue nor a file; {hint}")
    text = file_text(path, "a problem file or its name")
    return Source(readable(path.stem), {}, document_of(text, str(path)), folder=path.parent)


def _problems_in(folder: Path) -> tuple[Source, ...]:
    """The problem files of a folder, sorted by name; one that cannot be read is a source, too."""
    if not folder.is_dir():
        raise ProblemError(f"{folder}: is not a folder; problems must be a folder of problem files")
    found: list[Source] = []
    for path in sorted(folder.glob("*.toml")):
        name, document = readable(path.stem), {}
        wrong: list[str] = []
        with noted(wrong):
            document = document_of(file_text(path, "a problem file"), path.name)
        found.append(Source(name, {"problem": name}, document, name, "; ".join(wrong), folder))
    if not found:
        raise ProblemError(f"{folder}: has no file *.toml")
    return tuple(found)
