"""Tables of problem and linkage files for masses, loads and drives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, ClassVar

from pydantic import Field, ValidationInfo, create_model, field_validator

from grashof.problems.files.effort_schema import EffortTable
from grashof.problems.files.spreadsheet import Names, number_table
from grashof.problems.files.tables import TWO, NestedTable, Table, keys_of, listed, spec_table
from grashof.problems.values.checks import located_in
from grashof.problems.values.dynamics import load_specs
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.dynamics.pumping_unit import CRANK, POSITION, PumpingUnitSpec
from grashof.problems.values.dynamics.strength import SectionSpec, StrengthSpec
from grashof.problems.values.errors import ProblemError

_POINT = Annotated[list[float], listed("[u, v]"), TWO]
_Kinds = Sequence[Sequence[Names]]
# Columns of files, with or without their units.
_ENDINGS = {"time": "_s", **dict.fromkeys(load_specs.TURNING, "_deg")}
_FORCE, _MOMENT = (("fx", "fx_n"), ("fy", "fy_n")), (("moment", "moment_nm"),)
_PLACES = {over: (over, "over", over + _ENDINGS.get(over, "")) for over in load_specs.OVER}
_LOADS: dict[str, _Kinds] = {
    over: ((places, *_FORCE), (places, *_MOMENT)) for over, places in _PLACES.items()
}
_ROD_LOADS: dict[str, _Kinds] = {
    CRANK: ((("crank", "crank_deg"), ("load", "load_n")),),
    POSITION: ((("position",), ("up", "up_n"), ("down", "down_n")),),
}
_MOTION: dict[str, _Kinds] = {"time": ((("time", "time_s"), ("angle", "angle_deg")),)}


class _FromFile(NestedTable):
    """A table whose `values` may be in a CSV file that a key names; its columns depend on their variable."""

    columns: ClassVar[Mapping[str, _Kinds]]
    file_key: ClassVar[str] = "table"

    def given(self) -> dict[str, Any]:
        given = super().given()
        if isinstance(given.get(self.file_key), tuple):  # the rows of the file
            if "values" in given:
                raise ProblemError(f"{self.file_key} is given besides values; give one of them")
            given["values"] = given.pop(self.file_key)
        return given

    @field_validator("table", "profile", mode="after", check_fields=False)
    @classmethod
    def _read(cls, name: Any, info: ValidationInfo) -> Any:
        if not isinstance(name, str) or (info.field_name == "profile" and not name.endswith(".csv")):
            return name
        usual = next(iter(cls.columns.values()))
        return _rows(name, info, cls.columns.get(info.data.get("over", ""), usual))


@keys_of(
    load_specs.LoadSpec,
    {
        "at": _POINT,
        "force": Annotated[list[float], listed("[fx, fy] in N"), TWO],
        "values": Annotated[list[list[float]], listed("rows [place, fx, fy] or [place, moment]")],
        "table": (str | None, None),
    },
    ("link", "at", "force", "moment", "values", "over", "table", "frame"),
)
class LoadTable(_FromFile):
    """A force or moment on a link.

    Parameters
    ----------
    table : str
        Instead of `values`: a CSV file beside this one, with the columns over, fx, fy or over, moment.
    """

    columns = _LOADS


@keys_of(
    PumpingUnitSpec,
    {
        "values": Annotated[list[list[float]], listed("rows [crank angle, load]")],
        "table": (str | None, None),
    },
    (
        *("well", "crank", "structural_unbalance", "counterbalance", "counterbalance_phase_deg", "rating"),
        *("rod_load", "over", "values", "table"),
    ),
)
class PumpingUnitTable(_FromFile):
    """A linkage as a beam pumping unit; its `output_arm` is that of the horsehead.

    Parameters
    ----------
    table : str
        Instead of `values`: a CSV file beside this one, with the columns crank, load or position, up, down.
    """

    columns = _ROD_LOADS


@keys_of(
    MotorSpec,
    {
        "profile": Any,
        "values": Annotated[list[list[float]], listed("rows [time in s, angle in deg]")],
    },
)
class MotorTable(_FromFile):
    """The drive of link 2.

    Parameters
    ----------
    profile : str
        constant; trapezoid: even acceleration from rest, even speed, even deceleration to rest; cycloid: from
        rest to rest without a jump of acceleration; or a CSV file with the columns time and angle. Over a
        task from its first target to its last, of a linkage over each turn, or from one dead position to the
        other; `speed_rpm` is the mean.
    """

    columns = _MOTION
    file_key = "profile"


@keys_of(load_specs.Place, {"at": _POINT})
class PlaceTable(NestedTable):
    suggested = False


_SECTION: dict[str, Any] = {"section": SectionSpec(1.0, 1.0)}
_LINKS = _SECTION | {"masses": (1, 1, 1), "inertias": (1, 1, 1)}


@keys_of(
    DynamicsSpec,
    {
        "gravity": Annotated[list[float], listed("[x, y] in m/s2"), TWO],
        "masses": Annotated[list[float], listed("[m2, m3, m4]")],
        "inertias": Annotated[list[float], listed("[I2, I3, I4]")],
        "centres": Annotated[list[_POINT], listed("[[u2, v2], [u3, v3], [u4, v4]]")],
    },
    ("speed_rpm", "gravity", "mass_per_length", "density", "masses", "inertias", "centres", "payload"),
)
class DynamicsTable(NestedTable):
    # Whether there is a section is checked with the complete file.
    beside = MappingProxyType({"*": _SECTION, **dict.fromkeys(("masses", "inertias", "centres"), _LINKS)})

    def value(self) -> DynamicsSpec:
        return DynamicsSpec(**_SECTION | self.given())


def _rows(name: str, info: ValidationInfo, kinds: Sequence[Sequence[Names]]) -> list[list[float]]:
    """The rows of a CSV file that another file names; `ProblemError` where the text is not that of a file."""
    folder = (info.context or {}).get("folder")
    if folder is None:
        raise ProblemError(f"{info.field_name} is the file {name}; here it must be values instead")
    path = Path(folder) / name
    with located_in(str(info.field_name)):
        return number_table(path, str(path), kinds)


# More would take minutes to analyse; a load with a table of values counts once.
_TABLES = listed("a list of tables", 100)
_BETWEEN = Annotated[list[PlaceTable], listed("two places such as [{ link = 1, at = [0, 2] }, { link = 4 }]")]
_JOINT = Annotated[list[int], listed("two links of a joint, such as [2, 3]")]
_ONE_OR_EACH = dict.fromkeys(("coulomb", "pin_radius", "viscous", "moment"), (Any, 0.0))


def _one(table: Any) -> Any:
    return table | None, None


def _some(table: Any) -> Any:
    return Annotated[list[table], _TABLES], Field(default=[])


_Machine = create_model(
    "_Machine",
    __base__=Table,
    dynamics=_one(DynamicsTable),
    loads=_some(LoadTable),
    springs=_some(spec_table(load_specs.SpringSpec, NestedTable, {"between": _BETWEEN})),
    dampers=_some(spec_table(load_specs.DamperSpec, NestedTable, {"between": _BETWEEN})),
    torsion_springs=_some(spec_table(load_specs.TorsionSpringSpec, NestedTable, {"between": _JOINT})),
    counterweights=_some(spec_table(load_specs.CounterweightSpec, NestedTable, {"at": _POINT})),
    friction=_one(spec_table(load_specs.FrictionSpec, NestedTable, _ONE_OR_EACH)),
    motor=_one(MotorTable),
    section=_one(spec_table(SectionSpec, NestedTable)),
    strength=_one(spec_table(StrengthSpec, NestedTable)),
    effort=_one(EffortTable),
)


class MachineTables(_Machine):  # type: ignore[misc, valid-type]
    """Tables that problem and linkage files have in common."""

    def dynamics_spec(self) -> DynamicsSpec | None:
        """All of it as one value; None where nothing is stated."""
        names = [name for name in MachineTables.model_fields if getattr(self, name)]
        if not names:
            return None
        own = {} if self.dynamics is None else self.dynamics.given()
        return DynamicsSpec(
            **own, **{name: NestedTable.argument(getattr(self, name)) for name in names if name != "dynamics"}
        )
