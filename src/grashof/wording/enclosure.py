"""What intervals of the driver angle show of a list, in one line and for the record."""

from __future__ import annotations

from typing import Any

from grashof.analysis.judge.enclosed import find_enclosures
from grashof.analysis.judge.verdict import Enclosure
from grashof.problems.values.checks import counted
from grashof.synth import Result

_NAMED = 2  # designs of each reason, by their ids


def enclosure_line(result: Result) -> str:
    """How many designs are verified by intervals, and what is not shown of which; empty without designs."""
    named = list(zip((each.id for each in result.candidates), enclosures(result), strict=True))
    if any(each.contradicts for _, each in named):
        wrong = _by_reason({name: each.why for name, each in named if each.contradicts})
        return f"Intervals contradict the judge, an error of this program to report: {wrong}."
    if not named:
        return ""
    undecided = {name: each.why for name, each in named if not each.holds}
    shown = len(named) - len(undecided)
    many = counted(shown, "design") if not undecided else f"{shown} of {counted(len(named), 'design')}"
    rest = f"; undecided: {_by_reason(undecided)}" if undecided else ""
    shown_of = f"Closure and transmission angle of {many} verified by intervals of the driver angle"
    return f"{shown_of}, over their whole motion{rest}."


def _by_reason(missing: dict[str, str]) -> str:
    """What is not shown, each once, after the first designs that it is of.

    >>> _by_reason({"1f": "order", "2e": "closure", "3d": "order", "4c": "order"})
    '1f, 3d and another (order), 2e (closure)'
    """
    said = []
    for why in dict.fromkeys(missing.values()):
        mine = [name for name, its in missing.items() if its == why]
        others = len(mine) - _NAMED
        more = f" and {'another' if others == 1 else f'{others} others'}" if others > 0 else ""
        said.append(f"{', '.join(mine[:_NAMED])}{more} ({why})")
    return ", ".join(said)


def enclosures(result: Result) -> tuple[Enclosure, ...]:
    """Of each design of a list."""
    return find_enclosures([each.values for each in result.candidates])


def enclosure_record(result: Result) -> dict[str, Any] | None:
    """The same for `run.json`; None without designs."""
    found = enclosures(result)
    if not found:
        return None
    named = list(zip((each.id for each in result.candidates), found, strict=True))
    return {
        "designs": sum(each.holds for each in found),
        "intervals": sum(each.intervals for each in found),
        "undecided": {name: each.why for name, each in named if not (each.holds or each.contradicts)},
        "contradicted": {name: each.why for name, each in named if each.contradicts},
    }
