"""The shapes of values that the value types check, not the tables: by hand, by table and key."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from grashof.problems.files.dynamics_schema import MotorTable
from grashof.problems.files.linkage_schema import FILES as KINDS
from grashof.problems.files.linkage_schema import DyadTable
from grashof.problems.files.named_files import FILES
from grashof.problems.files.place_schema import BoxTable
from grashof.problems.files.problem_schema import (
    CylinderTable,
    ObjectiveTable,
    ProblemFile,
    RequirementsTable,
    TargetTable,
)
from grashof.problems.files.tables import Table, numbers, tables_of
from grashof.problems.files.task_schema import TASKS, MotionTable
from grashof.problems.values.linkages.cylinder import CARRIERS
from grashof.problems.values.linkages.mechanism import WORDS
from grashof.problems.values.linkages.mechanisms import SIX_BAR
from grashof.problems.values.requirements.distances import EITHER_WAY
from grashof.problems.values.requirements.link_ratios import PAIR
from grashof.problems.values.requirements.objective import GOALS
from grashof.problems.values.requirements.requirement_checks import MAY_KEEP_OUT
from grashof.problems.values.requirements.target_limits import TOGGLE

Shape = dict[str, Any]
"A part of a JSON Schema."


def _some_of(words: Any) -> Shape:
    return {"type": "array", "items": {"enum": list(words)}}


def _limits_by_name(pattern: str) -> Shape:
    return {
        "type": "object",
        "propertyNames": {"pattern": f"^{pattern}$"},
        "additionalProperties": {"anyOf": [{"type": "number"}, numbers(2)]},
        "minProperties": 1,
    }


def _pose() -> Shape:
    parts: Shape = {name: {"type": "number"} for name in ("x", "y", "angle")}
    alone = [{"required": ["angle"]}, {"required": ["x"]}]
    both = {"x": ["y"], "y": ["x"]}
    table = {"type": "object", "properties": parts, "additionalProperties": False}
    return {"anyOf": [numbers(3), {**table, "anyOf": alone, "dependentRequired": both}]}


_NUMBER_OR_ONE_EACH: Shape = {"anyOf": [{"type": "number"}, {"type": "array", "items": {"type": "number"}}]}
_KINDS = {"enum": [*WORDS, SIX_BAR]}
_SIGN = {"enum": [1, -1]}
_BY_HAND: Mapping[tuple[type[Table], str], Shape] = MappingProxyType(
    {
        (ProblemFile, "kind"): {"enum": [*TASKS]},
        (ProblemFile, "mechanism"): {
            "anyOf": [_KINDS, {"type": "array", "items": _KINDS, "minItems": 1, "uniqueItems": True}]
        },
        (MotionTable, "poses"): {"type": "array", "items": _pose()},
        **{(BoxTable, axis): {"anyOf": [{"type": "number"}, numbers(2)]} for axis in ("x", "y")},
        (CylinderTable, "on"): _some_of(CARRIERS),
        (ObjectiveTable, "maximise"): {"anyOf": [{"enum": [*GOALS]}, {"$ref": "#/$defs/WeightsTable"}]},
        (RequirementsTable, "keep_out_for"): _some_of(MAY_KEEP_OUT),
        (TargetTable, "links"): _some_of(TOGGLE),
        (RequirementsTable, "link_ratios"): _limits_by_name(PAIR.pattern),
        **{
            (table, "distances"): _limits_by_name(f"({'|'.join(EITHER_WAY)})")
            for table in (RequirementsTable, TargetTable)
        },
        (MotorTable, "profile"): {"type": "string"},
        (DyadTable, "assembly"): _SIGN,
        **{(table, "assembly"): _SIGN for table in KINDS.values()},
    }
)


def shape_of(table: type[Table], key: str, known: Shape) -> Shape:
    """The shape of a key, where pydantic has found another one, or none.

    Examples
    --------
    >>> shape_of(DyadTable, "assembly", {"type": "integer"}), shape_of(DyadTable, "c", {"type": "array"})
    ({'enum': [1, -1]}, {'type': 'array'})
    """
    made = _BY_HAND.get((table, key), known or _NUMBER_OR_ONE_EACH)
    endings = _named_files().get((table, key))
    return made if endings is None else {"anyOf": [made, {"type": "string", "pattern": endings}]}


def kinds_of(table: type[Table]) -> list[str]:
    """The words for the kinds of linkages that a linkage file states."""
    return [word for word, file in KINDS.items() if file is table]


def conditions(table: type[Table]) -> Shape:
    """Conditions between the keys of a table: of a task and its kind, of a linkage and its ground."""
    if table is ProblemFile:
        return {"allOf": [_only(kind) for kind in TASKS]}
    words = kinds_of(table)
    usual = words and table.model_fields["mechanism"].default in words
    given = {} if usual or not words else {"required": ["mechanism"]}
    ground = [{"required": ["o4"]}, {"required": ["r1"]}] if words and "o4" in table.model_fields else []
    return {"allOf": [each for each in (given, {"oneOf": ground} if ground else {}) if each]} if words else {}


def _only(kind: str) -> Shape:
    others = {other: False for other in TASKS if other != kind}
    stated = {"properties": {"kind": {"const": kind}}, "required": ["kind"]}
    return {"if": stated, "then": {"required": [kind], "properties": others}}


def _named_files() -> dict[tuple[type[Table], str], str]:
    """Patterns of the names of files that may stand for a value."""
    tables = dict(tables_of(ProblemFile))
    return {(tables[table], key): _pattern(endings) for (table, key), (endings, _) in FILES.items()}


def _pattern(endings: tuple[str, ...]) -> str:
    either = "|".join("".join(f"[{x}{x.upper()}]" for x in ending[1:]) for ending in endings)
    return rf"^[^#]+\.({either})(#.*)?$"
