"""Dotted keys of a problem file, such as ``motion.poses[1].x``: read, and set in a parsed file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, TypeAlias

from grashof.problems import ProblemError
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.requirements.limit_kinds import Kind
from grashof.problems.values.requirements.requirements import LIMITS

Parts: TypeAlias = tuple[str | int, ...]

_PART = r"[A-Za-z0-9_/-]+(?:\[[0-9]+\])*"
_KEY = re.compile(rf"{_PART}(?:\.{_PART})*")
_COORDINATES = {"x": 0, "y": 1, "angle": 2}  # of a pose or point that is stated as a list
_PLACES = {name for name, limit in LIMITS.items() if limit.kind in (Kind.INSIDE, Kind.ON_BODY)}


def key_parts(key: str, where: str = "key") -> Parts:
    """A dotted key as names and places in lists, which count from 0.

    >>> key_parts("motion.poses[1].x")
    ('motion', 'poses', 1, 'x')
    """
    if not _KEY.fullmatch(key):
        raise wrong_value(where, key, "a dotted key such as requirements.o2.x or motion.poses[1].x")
    found = re.findall(r"([A-Za-z0-9_/-]+)|\[([0-9]+)\]", key)
    return tuple(name or int(index) for name, index in found)


def assigned(document: dict[str, Any], parts: Parts, value: Any) -> dict[str, Any]:
    """A parsed problem file with another value at a key; tables that are missing are made.

    A number for x or y of a place such as ``requirements.o2`` becomes an interval of no width. ``x``, ``y``
    and ``angle`` are entries of poses and points stated as lists, too. ProblemError where a list on the way
    lacks the entry, or something on the way is not a table.

    >>> assigned({"requirements": {}}, key_parts("requirements.o2.x"), 2.5)
    {'requirements': {'o2': {'x': [2.5, 2.5]}}}
    >>> assigned({"path": {"points": [[0, 0], [1, 2]]}}, key_parts("path.points[1].y"), 3)
    {'path': {'points': [[0, 0], [1, 3]]}}
    """
    changed: dict[str, Any] = _assigned(document, parts, value, "")
    return changed


def _assigned(old: Any, parts: Parts, value: Any, where: str) -> Any:
    if not parts:
        return value
    head, rest = parts[0], parts[1:]
    if isinstance(old, list):
        index = _COORDINATES.get(head, -1) if isinstance(head, str) else head
        place = _joined(where, head)
        if not 0 <= index < len(old):
            last = f"ends with [{len(old) - 1}]" if old else "is empty"
            raise ProblemError(f"{place} is missing; {where} {last}")
        return [*old[:index], _assigned(old[index], rest, value, place), *old[index + 1 :]]
    if isinstance(head, int):
        raise ProblemError(f"{_joined(where, head)} is missing; {where} is not a list")
    table = {} if old is None else old
    if not isinstance(table, dict):
        raise ProblemError(f"{_joined(where, head)} is missing; {where} is {old!r}, which is not a table")
    if not rest and _fixes(where, head, value):
        value = [value, value]
    return {**table, head: _assigned(table.get(head), rest, value, _joined(where, head))}


def _fixes(where: str, head: str, value: Any) -> bool:
    """Whether a number is given for a side of a place, which is an interval."""
    table, _, name = where.partition(".")
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return is_number and table == "requirements" and name in _PLACES and head in ("x", "y")


def _joined(where: str, part: str | int) -> str:
    if isinstance(part, int):
        return f"{where}[{part}]"
    return f"{where}.{part}" if where else part


def overlap(keys: Sequence[Parts]) -> bool:
    """Whether one key lies within another one, or is the same."""
    return any(
        one == other[: len(one)] for i, one in enumerate(keys) for j, other in enumerate(keys) if i != j
    )
