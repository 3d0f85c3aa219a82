"""All combinations of a study, each a problem made as from a problem file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from math import prod
from typing import Any

from grashof.problems import ProblemError
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.checks import noted, refused
from grashof.sweep.keys import assigned, key_parts
from grashof.sweep.study import MOST_COMBINATIONS, Source, Study


@dataclass(frozen=True, slots=True)
class Combination:
    """One problem of a sweep, with its cells of the table and a label that distinguishes it.

    `text`, the problem file, is empty where the problem is invalid; `wrong` has the reasons, a line each.
    """

    cells: Mapping[str, Any]
    name: str
    label: str
    text: str = ""
    wrong: tuple[str, ...] = ()


def combinations(study: Study) -> tuple[Combination, ...]:
    """Every combination of a study; the last of the varied keys changes fastest.

    ProblemError for errors common to all: they are those of the study, or of the base problem.
    """
    count = len(study.sources) * prod(len(study.vary[keys[0]]) for keys in study.axes)
    if count > MOST_COMBINATIONS:
        raise ProblemError(
            f"{study.name}: has {count} combinations; it must have at most {MOST_COMBINATIONS}"
        )
    found = tuple(_combined(study, source, values) for source in study.sources for values in _varied(study))
    always = [line for line in found[0].wrong if all(line in one.wrong for one in found)]
    if always and all(one.wrong for one in found):
        raise refused(f"{study.name}: in every combination, {line}" for line in always)
    return found


def _varied(study: Study) -> Iterator[dict[str, Any]]:
    """The values of the varied keys in each combination."""
    axes = [
        [dict(zip(keys, step, strict=True)) for step in zip(*(study.vary[key] for key in keys), strict=True)]
        for keys in study.axes
    ]
    for steps in product(*axes):
        given = {key: value for step in steps for key, value in step.items()}
        yield {key: given[key] for key in study.vary}


def _combined(study: Study, source: Source, values: Mapping[str, Any]) -> Combination:
    cells = {**source.cells, **values}
    wrong = [source.wrong] if source.wrong else []
    text, document = "", source.document
    if not wrong:
        settings = [(("search", key), value) for key, value in (study.search or {}).items()]
        for parts, value in [*settings, *((key_parts(key), value) for key, value in values.items())]:
            with noted(wrong):
                document = assigned(document, parts, value)
        with noted(wrong):
            text = problem_toml(problem_from(document, source.name, source.folder))
    words = [source.label, *(f"{key} = {value}" for key, value in values.items())]
    label = ", ".join(filter(None, words)) or source.name
    return Combination(cells, source.name, label, "" if wrong else text, tuple(wrong))
