"""Tables and keys of problem and linkage files, from the models that read them.

The meaning of a key is stated where the value is declared: in the docstring of the table or of the value type
that it makes. Nothing is repeated here.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import MISSING, dataclass, fields, is_dataclass
from enum import StrEnum
from math import inf
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

from pydantic import Discriminator
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from grashof.problems.files.dynamics_schema import MachineTables
from grashof.problems.files.linkage_schema import FILES, DyadTable, LinkageTable
from grashof.problems.files.problem_schema import ProblemFile, WeightsTable
from grashof.problems.files.tables import Table, tables_of
from grashof.problems.schema.docstrings import Described, code, parameters_of, sentence, summary_of
from grashof.problems.values.checks import GREATEST
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.linkages.mechanisms import CLASSES
from grashof.problems.values.linkages.six_bar import SixBar
from grashof.problems.values.requirements.limit_kinds import Limit
from grashof.problems.values.requirements.modes import Rotatability
from grashof.problems.values.requirements.objective import GOALS
from grashof.problems.values.requirements.quantities import Needs, Quantity
from grashof.problems.values.requirements.requirements import LIMITS, Requirements
from grashof.problems.values.specs.linkage_spec import LinkageSpec
from grashof.problems.values.specs.problem import Problem

_UNITS = {
    *(
        "length",
        "length^2",
        "length^4",
        "deg",
        "rad",
        "kg",
        "kg/length",
        "kg/m^3",
        "kg and kg length^2",
        "kg m^2",
    ),
    *("m/s^2", "N", "N m", "N/m", "N s/m", "N m/rad", "N m s/rad", "Pa", "s"),
}
_PLAIN = {float: "number", int: "whole number", str: "string", bool: "true or false", Any: ""}


@dataclass(frozen=True, slots=True)
class Key:
    """A key of a file.

    Parameters
    ----------
    name : str
    value : str
        Its allowed values, in Markdown.
    unit : str
    default : str
        In Markdown.
    text : str
        Its meaning.
    words : tuple of str
        The allowed words; none if its value is not a word.
    bounds : pair of float
        Least and greatest number, both allowed; infinite without a limit.
    usual : object
        Its default as a file has it; None where it has none.
    """

    name: str
    value: str
    unit: str
    default: str
    text: str
    words: tuple[str, ...]
    bounds: tuple[float, float]
    usual: Any


def problem_tables() -> dict[str, type[Table]]:
    """Tables of problem files by their key paths, the file itself first as ""."""
    return dict(tables_of(ProblemFile))


def linkage_tables() -> dict[str, type[Table]]:
    """The keys of all linkage files, those of each kind, and the tables that problem files lack."""
    shared = MachineTables.model_fields
    inner = {path: table for file in FILES.values() for path, table in tables_of(file)}
    tops = {path: path.split(".")[0].removesuffix("[]") for path in inner}
    own = {path: table for path, table in inner.items() if path and tops[path] not in shared}
    kinds: dict[str, type[Table]] = {f'mechanism = "{kind}"': file for kind, file in FILES.items()}
    return {"": LinkageTable, **kinds, **own}


def described_keys(table: type[Table]) -> list[Key]:
    """The keys of a table, in the order of a file.

    Examples
    --------
    >>> starts = described_keys(problem_tables()["search"])[0]
    >>> starts.name, starts.value, starts.default
    ('starts', 'whole number', '`200`')
    """
    known: dict[str, Described] = {}
    for source in _sources(table):
        known = parameters_of(source) | known
    return [
        _key(name, given, known.get(name) or known.get(name.removesuffix("_deg")), table)
        for name, given in table.model_fields.items()
    ]


def _sources(table: type[Table]) -> Iterator[object]:
    """The docstrings that describe the keys of a table: its own, then that of the value it makes."""
    tables = (each for each in table.__mro__ if issubclass(each, Table) and each is not Table)
    yield from (each for each in tables if each.__dict__.get("__doc__"))
    yield from table.described_by
    if issubclass(table, ProblemFile):
        yield from (Problem, DynamicsSpec)
    elif issubclass(table, DyadTable):
        yield SixBar
    elif issubclass(table, LinkageTable):
        yield from {CLASSES.get(kind, SixBar): None for kind, file in FILES.items() if file is table}
        yield from (LinkageSpec, DynamicsSpec)
    elif isinstance(made := _made(table), type):
        yield from (getattr(made, "from_degrees", made), made)


def summary(table: type[Table]) -> str:
    """The subject of a table: the first line of its own docstring, or of that of the value it makes."""
    own = table.__dict__.get("__doc__")
    return summary_of(table if own else _made(table))


def _key(name: str, given: FieldInfo, known: Described | None, table: type[Table]) -> Key:
    limited = LIMITS.get(name) if _made(table) is Requirements else None
    declared = _declared(table, name)
    text = "" if known is None else known.text
    if not text and limited is not None:
        text = _quantity_text(limited.quantity)
    elif not text and table is WeightsTable:
        text = f"{GOALS[name].full}, the {'greater' if GOALS[name].better > 0 else 'smaller'} the better"
    elif not text and (inner := next(_tables_in(given.annotation), None)) is not None:
        text = summary(inner)
    words, usual = _words(name, declared, known, limited), _usual(given, declared)
    shape = _shape(given.annotation, given.metadata) or _loose(known)
    return Key(
        name,
        ", ".join(code(f'"{word}"') for word in words) or f"{shape}{_bounds_text(*_bounds(limited))}",
        _unit(name, known, limited),
        _default(given, usual, limited),
        sentence(text.removeprefix("(lo, hi) for ")),
        words,
        _bounds(limited),
        usual,
    )


def _tables_in(annotation: Any) -> Iterator[type[Table]]:
    if isinstance(annotation, type) and issubclass(annotation, Table):
        yield annotation
    for part in get_args(annotation):
        yield from _tables_in(part)


def _loose(known: Described | None) -> str:
    """The shape of a value that the value type checks, not the table: a number, or one for each joint."""
    stated = "string" if known is None else known.type.split(",")[0]
    return stated.replace("float or", "number, or a list of").replace("floats", "").strip()


def _made(table: type[Table]) -> Any:
    """The type of the value that a table makes."""
    return getattr(table, "spec", get_type_hints(table.value).get("return"))


def _declared(table: type[Table], name: str) -> Any:
    """The default of a key in the value that a table makes; None where there is none."""
    made = _made(table)
    known = fields(made) if is_dataclass(made) else ()
    found = next((each.default for each in known if each.name == name), MISSING)
    # Fields of a task that have a property of `Task` for a default are computed where they are not given.
    return None if found is MISSING or isinstance(found, property) else found


def _quantity_text(quantity: Quantity) -> str:
    about = f": {quantity.about}" if quantity.about and quantity.about != quantity.full else ""
    needs = "" if quantity.needs is Needs.NOTHING else f"; needs {quantity.needs.value}"
    return f"{quantity.full}{about}{needs}"


def _words(name: str, declared: Any, known: Described | None, limited: Limit | None) -> tuple[str, ...]:
    """The allowed words of a key; none if its value is not a word."""
    if limited is not None:
        return tuple(limited.words)
    if known is not None and known.type.startswith("{"):
        return tuple(re.findall(r'"([^"]+)"', known.type[: known.type.index("}")]))
    kind = Rotatability if name == "rotatability" else type(declared)
    return tuple(str(word) for word in kind) if issubclass(kind, StrEnum) else ()


def _bounds(limited: Limit | None) -> tuple[float, float]:
    """The numbers that a limit may be."""
    low, high = (-inf, inf) if limited is None else limited.allowed
    return low if low > -GREATEST else -inf, high if high < GREATEST else inf


def _bounds_text(low: float, high: float) -> str:
    if low == -inf:
        return "" if high == inf else f", up to {high:g}"
    return f", from {low:g}" if high == inf else f", {low:g} to {high:g}"


def _shape(annotation: Any, metadata: Sequence[Any] = ()) -> str:
    """The form of a model's type in a file."""
    for each in metadata:
        if wanted := getattr(getattr(each, "func", None), "keywords", {}).get("wanted"):
            return str(wanted)
        if isinstance(each, Discriminator) and each.custom_error_message:
            return each.custom_error_message
    if annotation in _PLAIN:
        return _PLAIN[annotation]
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return "table"
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin in (Union, UnionType):
        return " or ".join(filter(None, (_shape(part) for part in parts if part is not NoneType)))
    if hasattr(annotation, "__metadata__"):
        return _shape(parts[0], annotation.__metadata__)
    if origin is list:
        return "tables" if _shape(parts[0]) == "table" else "list"
    return "table" if origin is dict else ""


def _unit(name: str, known: Described | None, limited: Limit | None) -> str:
    if limited is not None:
        return str(limited.quantity.unit)
    parts = [] if known is None else known.type.split(", ")
    unit = "deg" if name.endswith("_deg") else next((part for part in parts if part in _UNITS), "")
    for power, sign in (("^2", "²"), ("^3", "³"), ("^4", "⁴")):
        unit = unit.replace(power, sign)
    return unit


def _usual(given: FieldInfo, declared: Any) -> Any:
    """The default of a key that a file may state; None where there is none."""
    value = declared if given.default in (PydanticUndefined, None) else given.default
    empty = isinstance(value, Table) or value in (None, [], (), "", {}, (-inf, inf))
    return None if empty or given.is_required() else value


def _default(given: FieldInfo, usual: Any, limited: Limit | None) -> str:
    if given.is_required():
        return "required"
    if usual is None:
        sizes = None if limited is None else limited.usual
        return "" if sizes is None else f"{sizes[0]:g} to {sizes[1]:g} sizes of the task"
    return code(_toml(usual))


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_toml(each) for each in value)}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
