"""One combination solved: from the text of its problem to plain values, in any process."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from math import isfinite, isnan
from time import perf_counter
from typing import TYPE_CHECKING, Any

from grashof.problems import Problem, ProblemError
from grashof.problems.files.on_disk import versions
from grashof.problems.files.problem_file import problem_of
from grashof.wording.numbers import with_unit

if TYPE_CHECKING:
    from grashof.synth import Result

OK, NONE, CUT, INVALID = "ok", "no design", "time limit", "invalid"
OBJECTIVE = "objective"  # column of the weighted sum of several goals


@dataclass(frozen=True, slots=True)
class Options:
    """How many of the best designs of a task are kept, and its time limit, s."""

    designs: int = 1
    time_limit: float | None = None


def task_key(name: str, text: str, options: Options) -> str:
    """Name of a task: the same for the same problem, options and versions only.

    >>> task_key("a", "", Options()) == task_key("a", "", Options(designs=2))
    False
    """
    content = json.dumps([name, text, asdict(options), versions()], sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()[:32]


def solve_task(
    name: str, text: str, options: Mapping[str, Any], stop: Callable[[], bool] = lambda: False
) -> dict[str, Any] | None:
    """Solve a problem file with `Options`; plain values, or None if `stop`, called between batches, holds."""
    from grashof.synth import synthesize

    begun = perf_counter()
    try:
        result = synthesize(problem_of(text, name, name), time_limit=options["time_limit"], stop=stop)
    except ProblemError as error:  # found only by a search
        return invalid(str(error).splitlines())
    if not result.complete and stop():
        return None
    return {**_plain_result(result, options["designs"]), "seconds": round(perf_counter() - begun, 3)}


def invalid(wrong: Sequence[str]) -> dict[str, Any]:
    """The result of a combination that states no problem."""
    return {**_empty(INVALID), "note": "; ".join(wrong), "seconds": 0.0}


def _empty(status: str) -> dict[str, Any]:
    return {"status": status, "found": 0, "note": "", "decides": None, "designs": [], "drawing": None}


def _plain_result(result: Result, most: int) -> dict[str, Any]:
    """The part of a result that the table, the plot and the page need."""
    from grashof.page.designs import designs_of
    from grashof.synth.designs.ranking import pareto_optimal
    from grashof.synth.designs.table import rows_of

    status = CUT if not result.complete else OK if result.candidates else NONE
    found = {**_empty(status), "found": len(result), "note": result.note}
    listed = result.candidates[:most]
    if not listed:
        return found
    problem = result.problem
    decides = decides_of(problem)
    fronts = pareto_optimal(problem, result.candidates)
    known = [
        {**row, "pareto": bool(front)} for row, front in zip(rows_of(problem, listed), fronts, strict=False)
    ]
    drawing = designs_of(problem, listed[:1], known[:1])[0]
    if decides["column"] == OBJECTIVE:
        known = [{**row, OBJECTIVE: one.objective(problem)} for row, one in zip(known, listed, strict=True)]
    rows = [{key: _plain(value) for key, value in row.items()} for row in known]
    return {**found, "decides": decides, "designs": rows, "drawing": {key: drawing[key] for key in _DRAWN}}


_DRAWN = ("id", "linkage", "low", "high", "turns", "direction", "theta2", "assemblies", "task")


def decides_of(problem: Problem) -> dict[str, Any]:
    """The quantity by which the best design is chosen: its column, its label, and which way is better."""
    from grashof.problems.values.requirements.all_quantities import QUANTITIES

    goals, lengths = problem.goals, {"length_unit": problem.length_unit}
    if problem.by_objective and len(goals) > 1:
        return {"column": OBJECTIVE, "label": "objective", "better": 1, **lengths}
    quantity = goals[0][0] if problem.by_objective else QUANTITIES["error"]
    label = with_unit(quantity.words, quantity.unit.of(problem.length_unit))
    return {"column": quantity.column, "label": label, "better": quantity.better, **lengths}


def _plain(value: Any) -> Any:
    """A value for JSON: null for NaN, words for infinity."""
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, float) and not isfinite(value):
        return None if isnan(value) else str(value)
    return value
