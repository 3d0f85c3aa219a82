"""The table [effort] of problem and linkage files, and the tables of struts and springs that it names."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, Tag, ValidationInfo, field_validator

from grashof.problems.files import tables
from grashof.problems.files.named_files import region_of
from grashof.problems.files.place_schema import Place
from grashof.problems.files.spreadsheet import rows_of
from grashof.problems.files.task_schema import Pair
from grashof.problems.values import checks
from grashof.problems.values.dynamics import struts
from grashof.problems.values.dynamics.dynamics_spec import METRES
from grashof.problems.values.dynamics.effort import MOST_PARTS, SQUARE, EffortSpec
from grashof.problems.values.dynamics.struts import EffortPlace, PartSize, PartSpec
from grashof.problems.values.errors import ProblemError, shown

USUAL = "usual"
_MOST_SIZES = 2000


@tables.keys_of(EffortPlace, {"link": int | str, "at": Place})
class EffortPlaceTable(tables.NestedTable):
    suggested = False

    @field_validator("at", mode="before", check_fields=False)
    @classmethod
    def _drawn(cls, at: Any, info: ValidationInfo) -> Any:
        """The corners in place of the name of a drawing."""
        name, context = at.get("inside") if isinstance(at, dict) else None, info.context or {}
        if not isinstance(name, str):
            return at
        unit = str(context.get("length_unit"))
        return {**at, "inside": region_of(name, "at.inside", context.get("folder"), unit)}


@tables.keys_of(PartSize)
class PartSizeTable(tables.NestedTable):
    suggested = False


_End = Annotated[
    Annotated[EffortPlaceTable, Tag(tables.TABLE)] | Annotated[int, Tag(tables.NUMBER)],
    tables.either("a place such as { link = 3, at = { x = [0, 1], y = 2 } }, or of torsion a link"),
]


@tables.keys_of(
    PartSpec,
    {
        "between": Annotated[list[_End], tables.listed("two places, or of torsion two links of a joint")],
        "free_angle_deg": Annotated[
            Annotated[float, Tag(tables.NUMBER)] | Annotated[Pair, Tag(tables.LIST)],
            tables.either("a number or [lo, hi]"),
        ],
        "sizes": (Annotated[list[PartSizeTable], tables.listed("a list of sizes", _MOST_SIZES)] | None, None),
    },
    ("kind", "between", "sizes", "count", "free_angle_deg"),
)
class _Part(tables.NestedTable):
    pass


class PartTable(_Part):
    """A strut or spring, of a size to be chosen, between places to be found.

    Parameters
    ----------
    table : str
        In place of `sizes`: a CSV file beside this one, or "usual" for the sizes that come with the program.
    """

    table: str = Field(default=USUAL, validate_default=True)

    @field_validator("table", mode="after")
    @classmethod
    def _read(cls, name: str, info: ValidationInfo) -> Any:
        """The sizes in place of the name of their file."""
        context, kind = info.context or {}, info.data.get("kind")
        unit = str(context.get("length_unit"))
        if kind not in struts.KINDS or (name == USUAL and info.data.get("sizes") is not None):
            return ()
        if name == USUAL:
            return usual_sizes(kind, unit)
        if context.get("folder") is None:
            raise ProblemError(f"table is the file {name}; here it must be sizes instead")
        with checks.located_in("table"):
            return sizes_from(rows_of(name, Path(context["folder"])), name, kind, unit)

    def given(self) -> dict[str, Any]:
        given = super().given()
        angle, read = given.get("free_angle_deg"), given.pop("table", self.table)
        if given.get("sizes") is None:
            given["sizes"] = read
        elif read:
            raise ProblemError("table is given besides sizes; give one of them")
        if isinstance(angle, float | int):
            given["free_angle_deg"] = (angle, angle)
        return given


@tables.keys_of(
    EffortSpec,
    {
        "on": EffortPlaceTable,
        "direction": Annotated[
            Annotated[str, Tag(tables.WORD)] | Annotated[Pair, Tag(tables.LIST)],
            tables.either(f'"{SQUARE}" or [x, y]'),
        ],
        "wanted": Annotated[list[Pair], tables.listed("rows [deg, N]")],
        **dict.fromkeys(("band", "stays_deg", "travel_deg"), Pair),
        "temperatures_c": Annotated[list[float], tables.listed("a list of temperatures")],
        "parts": (
            Annotated[list[PartTable], tables.listed("a list of tables", MOST_PARTS)],
            Field(default=[]),
        ),
    },
)
class EffortTable(tables.NestedTable):
    pass


class _PartsTable(tables.Table):
    parts: Annotated[list[PartTable], tables.listed("a list of tables", MOST_PARTS)]


def parts_from(given: Any) -> tuple[PartSpec, ...]:
    """Parts in a list of designs; `ProblemError` has a line for each error."""
    found = tables.stated(_PartsTable, {"parts": given})
    return tuple(part.value() for part in found.parts)


@cache
def usual_sizes(kind: str, length_unit: str) -> tuple[PartSize, ...]:
    """The sizes that come with the program, lengths in a unit."""
    file = resources.files("grashof.problems").joinpath(f"data/struts-{kind}.csv")
    rows = [line.split(",") for line in file.read_text(encoding="utf-8").splitlines()]
    return sizes_from(rows, file.name, kind, length_unit)


def sizes_from(
    lines: Sequence[Sequence[str]], name: str, kind: str, length_unit: str
) -> tuple[PartSize, ...]:
    """The sizes of a table whose first line names its columns, with their units.

    `ProblemError` for columns that are missing, unknown or without unit, and cells that are not numbers.
    """
    usual, columns = _columns(kind)
    head = [cell.casefold() for cell in lines[0]] if lines else []
    allowed = f"the columns are name, {', '.join(usual.values())}"
    for column in head:
        if column in usual:
            raise ProblemError(f"{name}: column {column} has no unit; it must be such as {usual[column]}")
        if column not in columns:
            raise ProblemError(f"{name}: column {shown(column)} is unknown; {allowed}")
    given = [columns[column] for column in head]
    for key, column in usual.items():
        if given.count(key) > 1 or (key not in given and key != "friction"):
            state = "twice" if key in given else "missing"
            raise ProblemError(f"{name}: column {column} is {state}; {allowed}")
    if not 2 <= len(lines) <= _MOST_SIZES + 1:
        raise ProblemError(f"{name}: has {len(lines) - 1} rows; it must have from 1 to {_MOST_SIZES}")
    metre = METRES.get(length_unit, 1.0)  # an unknown unit is refused elsewhere
    factors = [METRES.get(column.rpartition("_")[2], metre) / metre for column in head]

    def size(line: Sequence[str], where: str) -> PartSize:
        if len(line) != len(given):
            raise ProblemError(f"{where} has {len(line)} cells; it must have {len(given)}")
        with checks.located_in(where):
            cells = zip(given, line, factors, strict=True)
            return PartSize(**{_KEYS.get(key, key): _cell(key, cell, factor) for key, cell, factor in cells})

    return tuple(checks.each_checked(lines[1:], name, size, ": row {}", 1))


_KEYS = {"turn": "turn_deg"}  # keys of columns, whose endings are units


def _columns(kind: str) -> tuple[dict[str, str], dict[str, str]]:
    """The usual column of each quantity of a kind, with its unit; and the quantity of every column."""
    lengths, newton = tuple(METRES), ("n",)
    units = {"extended": lengths, "stroke": lengths, "force_extended": newton, "force_compressed": newton}
    if kind == struts.TORSION:
        units = {"moment": ("nm",), "turn": ("deg",)}
    units["friction"] = units["moment"] if kind == struts.TORSION else newton
    columns = {f"{key}_{unit}": key for key, each in units.items() for unit in each}
    return {key: f"{key}_{each[0]}" for key, each in units.items()}, columns | {"name": "name"}


def _cell(key: str, cell: str, factor: float) -> Any:
    if key == "name":
        return cell
    try:
        return float(cell) * factor
    except ValueError:
        raise ProblemError(f"{key} is {shown(cell)}; it must be a number") from None
