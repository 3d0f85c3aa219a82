"""The candidate list as a table: the columns of candidates.csv."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from grashof.analysis.judge.measures import find_together
from grashof.problems import Problem
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.quantities import Quantity
from grashof.problems.values.units import Unit
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.ranking import pareto_goals, pareto_optimal

if TYPE_CHECKING:
    import pandas as pd

LISTED = tuple(quantity for quantity in QUANTITIES.values() if quantity.listed)
# Columns that are not quantities by the quantity that follows them: their names in words, and explanations.
_BEFORE = {
    "o2_x": {
        "rank": ("rank", "place in the list, from 1"),
        "id": ("id", "name of the design, the same in every list that has it: `candidates.json#df2467fa`"),
        "mechanism": ("kind of linkage", ""),
        "family": ("family", "id of the best of the designs that are like this one"),
        "region": (
            "region",
            "number of the connected set of designs that contains it, from 1; of four poses of a four-bar",
        ),
        "grashof_class": (
            "Grashof class",
            "crank-rocker, double-crank and so on; with a slide crank-shaper, Whitworth and so on",
        ),
        "direction": ("sense of the driver (+1 counter-clockwise)", "from the first target to the last"),
        "assembly": (
            "assembly mode (+1 or −1)",
            "B left (+1) or right (-1) of the line from A to O4",
        ),
    },
    "r5": {
        "assembly_2": (
            "assembly mode of the second loop (+1 or −1)",
            "E left (+1) or right (-1) of the line from C to D; ahead of C along a slide (+1) or behind",
        ),
        "hosts": ("hosts", "links that carry C and D, such as 3-1"),
        "point_link": ("link of P", "link that carries P, in whose frame p_u and p_v are"),
    },
    "cylinder_base_x": {"cylinder_on": ("cylinder, on link", "")},
    "effort_deviation": {
        "part_sizes": ("struts and springs", "number, kind and size of each, for the effort")
    },
    "omega4_max": {
        "circuit_ok": ("all targets on one circuit", ""),
        "branch_ok": ("all targets on one branch", ""),
        "order_ok": ("targets in their order", ""),
        "full_rotation": ("driver turns fully", ""),
    },
    "hausdorff": {
        "pareto": ("Pareto-optimal", "nothing in the list is better in every goal"),
        "cognate_of": ("cognate of", "id of the design that has the same coupler curve"),
        "start": ("start of the search", "which one it came from"),
        "iterations": ("iterations from that start", "that Ipopt needed"),
        "best_at": (
            "best at",
            "the strength of a design, such as the least error; `objective` for the best one by the "
            "objective where it does not come first",
        ),
        "caution": (
            "caution",
            "why a design comes after all others, such as its size; empty for those that do not",
        ),
    },
}
_WORDS = {column: words for before in _BEFORE.values() for column, words in before.items()}
ABOUT = {column: about for column, (_, about) in _WORDS.items() if about}
# Columns without a meaning for a task stay empty.
COLUMNS = tuple(name for quantity in LISTED for name in (*_BEFORE.get(quantity.key, ()), quantity.column))
# The user's own objective, a last column where there is one.
OWN = Quantity(
    "objective", "objective", Unit.RATIO, better=-1, digits=4, about="less is better", full="own objective"
)
# Every column in words; for nearest misses also the misses.
NAMES: dict[str, str] = {
    **{column: name for column, (name, _) in _WORDS.items()},
    **{quantity.column: quantity.full for quantity in (*LISTED, OWN)},
    "misses": "misses",
}


Row = dict[str, Any]
"A design by column, None or NaN where something is not known."


def rows_of(
    problem: Problem, candidates: Sequence[Candidate], quantities: Sequence[Quantity] = LISTED
) -> list[Row]:
    """Candidates as rows, in the order given, each with the columns `COLUMNS`."""
    keys = {each.key for each in quantities}
    find_together([candidate.values for candidate in candidates], keys)
    ranked = keys.issuperset(goal.key for goal in pareto_goals(problem))
    fronts = pareto_optimal(problem, candidates) if ranked else [False] * len(candidates)
    own = any(candidate.own_objective is not None for candidate in candidates)
    # of some quantities alone the other columns stay empty; nothing is measured for them
    empty = dict.fromkeys([*COLUMNS, *([OWN.column] if own else [])])
    return [
        {
            **empty,
            "rank": rank,
            "pareto": bool(front),
            **facts(candidate),
            **{each.column: candidate.values[each.key] * each.unit.shown for each in quantities},
            **({OWN.column: candidate.own_objective} if own else {}),
        }
        for rank, (candidate, front) in enumerate(zip(candidates, fronts, strict=True), start=1)
    ]


def rows_of_nearest(problem: Problem, nearest: Sequence[Candidate]) -> list[Row]:
    """Closest misses as rows, with their misses in a last column."""
    rows = rows_of(problem, nearest)
    for row, candidate in zip(rows, nearest, strict=True):
        row["misses"] = "; ".join(str(each) for each in candidate.verdict.defects)
    return rows


def to_frame(problem: Problem, candidates: Sequence[Candidate]) -> pd.DataFrame:
    """The rows of candidates as a table."""
    import pandas as pd  # takes longer than the search of many a problem

    rows = rows_of(problem, candidates)
    return pd.DataFrame(rows) if rows else pd.DataFrame(columns=[*COLUMNS])


def known(value: Any) -> bool:
    """Whether a row has this value; an infinite one is known."""
    return value is not None and value == value


def facts(candidate: Candidate) -> dict[str, Any]:
    """Names and classes of a design, by column; None where unknown."""
    verdict = candidate.verdict
    driven = {} if verdict.cylinder is None else {"cylinder_on": verdict.cylinder.on}
    if verdict.effort is not None:
        driven["part_sizes"] = "; ".join(part.chosen for part in verdict.effort.parts)
    return {
        "id": candidate.id,
        "mechanism": candidate.linkage.mechanism.word,
        "family": candidate.family or candidate.id,
        "region": candidate.region or None,
        "cognate_of": candidate.cognate_of or None,
        "best_at": candidate.best_at or None,
        "caution": candidate.caution or None,
        "grashof_class": str(verdict.grashof_class),
        "direction": verdict.direction,
        "assembly": int(candidate.linkage.assembly),
        **{name: candidate.values.columns.get(name) for name in ("assembly_2", "hosts", "point_link")},
        "circuit_ok": verdict.circuit_ok,
        "branch_ok": verdict.branch_ok,
        "order_ok": verdict.order_ok,
        "full_rotation": verdict.full_rotation,
        "start": candidate.start,
        "iterations": candidate.iterations,
        **driven,
    }
