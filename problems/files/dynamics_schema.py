"""Tables of problem and linkage files: what a linkage weighs, what acts on it and what drives it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import Field, ValidationInfo, field_validator

from grashof.problems.files.number_table import Names, number_table
from grashof.problems.files.tables import Table, listed
from grashof.problems.values.checks import located, refuse
from grashof.problems.values.dynamics.acting import (
    OVER,
    TURNING,
    CounterweightSpec,
    DamperSpec,
    FrictionSpec,
    LoadSpec,
    Place,
    SpringSpec,
    TorsionSpringSpec,
)
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.motor import PROFILES, MotorSpec
from grashof.problems.values.dynamics.pumping_unit import CRANK, POSITION, PumpingUnitSpec
from grashof.problems.values.dynamics.section import SectionSpec
from grashof.problems.values.dynamics.strength import StrengthSpec
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.problems.values.specs.dynamics_of_kind import without_place

Point = Annotated[list[float], listed("[u, v]")]
# Columns of files, with or without their units.
_ENDINGS = {"time": "_s", **dict.fromkeys(TURNING, "_deg")}
_PLACES = {over: (over, "over", over + _ENDINGS.get(over, "")) for over in OVER}
_FORCE, _MOMENT = (("fx", "fx_n"), ("fy", "fy_n")), (("moment", "moment_nm"),)
_ROD_LOADS = {
    CRANK: (("crank", "crank_deg"), ("load", "load_n")),
    POSITION: (("position",), ("up", "up_n"), ("down", "down_n")),
}
_MOTION = (("time", "time_s"), ("angle", "angle_deg"))


class _Spec(Table):
    """A table whose keys are the arguments of a value."""

    spec: ClassVar[Callable[..., Any]]

    def given(self) -> dict[str, Any]:
        """The keys that are given, as arguments."""
        return {key: _argument(getattr(self, key)) for key in self.model_fields_set}

    def value(self) -> Any:
        return type(self).spec(**self.given())


def _argument(value: Any) -> Any:
    if isinstance(value, Table):
        return value.value()
    return tuple(_argument(each) for each in value) if isinstance(value, list) else value


class DynamicsTable(_Spec):
    speed_rpm: float | None = None
    gravity: Annotated[list[float], listed("[x, y] in m/s2")] | None = None
    mass_per_length: float | None = None
    density: float | None = None
    masses: Annotated[list[float], listed("[m2, m3, m4]")] | None = None
    inertias: Annotated[list[float], listed("[I2, I3, I4]")] | None = None
    centres: Annotated[list[Point], listed("[[u2, v2], [u3, v3], [u4, v4]]")] | None = None
    payload: float | None = None

    @field_validator("*")
    @classmethod
    def _by_itself(cls, given: Any, key: ValidationInfo) -> Any:
        pair: dict[str, Any] = {"masses": (1, 1, 1), "inertias": (1, 1, 1)}
        besides = pair if key.field_name in (*pair, "centres") else {}
        DynamicsSpec(**{**besides, **_SECTION, str(key.field_name): _argument(given)})
        return given

    def value(self) -> DynamicsSpec:
        return DynamicsSpec(**_SECTION | self.given())  # the file as a whole says whether there is a section


_SECTION: dict[str, Any] = {"section": SectionSpec(1.0, 1.0)}


class LoadTable(_Spec):
    """A force or moment on a link.

    Parameters
    ----------
    table : str
        Instead of `values`: a CSV file beside this one, with the columns over, fx, fy or over, moment.
    """

    spec = LoadSpec
    link: int
    at: Point = Field(default=[0.0, 0.0])
    force: Annotated[list[float], listed("[fx, fy] in N")] | None = None
    moment: float | None = None
    values: Annotated[list[list[float]], listed("rows [place, fx, fy] or [place, moment]")] | None = None
    over: str = "theta2"
    table: str | None = None
    frame: str = "global"

    def given(self) -> dict[str, Any]:
        given = super().given()
        if (rows := given.pop("table", None)) is not None:
            if "values" in given:
                raise ProblemError("table is given besides values; give one of them")
            given["values"] = rows
        return given

    @field_validator("table", mode="after")
    @classmethod
    def _read(cls, name: str | None, info: ValidationInfo) -> Any:
        places = _PLACES.get(info.data.get("over", "theta2"), _PLACES["theta2"])
        return None if name is None else _rows(name, info, ((places, *_FORCE), (places, *_MOMENT)))


class PlaceTable(_Spec):
    telling = False
    spec = Place
    link: int
    at: Point = Field(default=[0.0, 0.0])


Between = Annotated[list[PlaceTable], listed("two places such as [{ link = 1, at = [0, 2] }, { link = 4 }]")]


class SpringTable(_Spec):
    spec = SpringSpec
    between: Between
    stiffness: float
    free_length: float = 0.0


class DamperTable(_Spec):
    spec = DamperSpec
    between: Between
    damping: float


class TorsionSpringTable(_Spec):
    spec = TorsionSpringSpec
    between: Annotated[list[int], listed("two links of a joint, such as [2, 3]")]
    stiffness: float
    free_angle_deg: float = 0.0


class CounterweightTable(_Spec):
    spec = CounterweightSpec
    link: int
    mass: float
    at: Point


class FrictionTable(_Spec):
    spec = FrictionSpec
    coulomb: Any = 0.0
    pin_radius: Any = 0.0
    viscous: Any = 0.0
    moment: Any = 0.0
    slide_mu: float = 0.0
    slide_length: float = 0.0
    slide_viscous: float = 0.0
    slide_force: float = 0.0


class MotorTable(_Spec):
    """The drive of link 2.

    Parameters
    ----------
    profile : str
        constant; trapezoid: even acceleration from rest, even speed, even deceleration to rest; cycloid: from
        rest to rest without a jump of acceleration; or a CSV file with the columns time and angle. Over a
        task from its first target to its last, of a linkage over each turn, or from one dead position to the
        other; `speed_rpm` is the mean.
    """

    spec = MotorSpec
    profile: Any = "constant"
    ramp: float = 1 / 3
    values: Annotated[list[list[float]], listed("rows [time in s, angle in deg]")] | None = None
    gear_ratio: float = 1.0
    gear_efficiency: float = 1.0
    inertia: float = 0.0

    def given(self) -> dict[str, Any]:
        given = super().given()
        if isinstance(given.get("profile"), tuple):
            if "values" in given:
                raise ProblemError("profile is a file and values are given besides; give one of them")
            given["values"] = given.pop("profile")
        return given

    @field_validator("profile", mode="after")
    @classmethod
    def _read(cls, profile: Any, info: ValidationInfo) -> Any:
        is_file = isinstance(profile, str) and profile not in PROFILES and profile.endswith(".csv")
        return _rows(profile, info, (_MOTION,)) if is_file else profile


class PumpingUnitTable(_Spec):
    """A linkage as a beam pumping unit; its `output_arm` is that of the horsehead.

    Parameters
    ----------
    table : str
        Instead of `values`: a CSV file beside this one, with the columns crank, load or position, up, down.
    """

    spec = PumpingUnitSpec
    well: str = "right"
    crank: str = "clockwise"
    structural_unbalance: float = 0.0
    counterbalance: float = 0.0
    counterbalance_phase_deg: float = 0.0
    rating: float | None = None
    rod_load: float | None = None
    over: str = CRANK
    values: Annotated[list[list[float]], listed("rows [crank angle, load]")] | None = None
    table: str | None = None

    def given(self) -> dict[str, Any]:
        given = super().given()
        if (rows := given.pop("table", None)) is not None:
            if "values" in given:
                raise ProblemError("table is given besides values; give one of them")
            given["values"] = rows
        return given

    @field_validator("table", mode="after")
    @classmethod
    def _read(cls, name: str | None, info: ValidationInfo) -> Any:
        columns = _ROD_LOADS.get(info.data.get("over", CRANK), _ROD_LOADS[CRANK])
        return None if name is None else _rows(name, info, (columns,))


class SectionTable(_Spec):
    spec = SectionSpec
    width: Any = None
    height: Any = None
    area: Any = None
    inertia: Any = None
    extreme_fibre: Any = None
    inertia_across: Any = None
    shear_factor: Any = None


class StrengthTable(_Spec):
    spec = StrengthSpec
    yield_stress: float
    elastic_modulus: float | None = None
    pin_diameter: Any = None
    pin_shear_strength: float | None = None
    bearing_strength: float | None = None
    pin_thickness: Any = None
    double_shear: bool = False


def _rows(name: str, info: ValidationInfo, kinds: Sequence[Sequence[Names]]) -> list[list[float]]:
    """The rows of a CSV file that another file names; `ProblemError` where the text is not that of a file."""
    folder = (info.context or {}).get("folder")
    if folder is None:
        raise ProblemError(f"{info.field_name} is the file {name}; here it must be values instead")
    try:
        return number_table(Path(folder) / name, kinds)
    except ProblemError as error:
        raise located(error, str(info.field_name)) from None


# More would take minutes to analyse; a load with a table of values counts once.
_TABLES = listed("a list of tables", 100)


class MachineTables(Table):
    """What problem and linkage files have in common."""

    dynamics: DynamicsTable | None = None
    loads: Annotated[list[LoadTable], _TABLES] = Field(default=[])
    springs: Annotated[list[SpringTable], _TABLES] = Field(default=[])
    dampers: Annotated[list[DamperTable], _TABLES] = Field(default=[])
    torsion_springs: Annotated[list[TorsionSpringTable], _TABLES] = Field(default=[])
    counterweights: Annotated[list[CounterweightTable], _TABLES] = Field(default=[])
    friction: FrictionTable | None = None
    motor: MotorTable | None = None
    section: SectionTable | None = None
    strength: StrengthTable | None = None

    def dynamics_spec(self, *kinds: Mechanism) -> DynamicsSpec | None:
        """All of it as one value, for some kinds of linkages; None where nothing is stated."""
        names = [name for name in MachineTables.model_fields if getattr(self, name)]
        if not names:
            return None
        own = {} if self.dynamics is None else self.dynamics.given()
        spec = DynamicsSpec(
            **own, **{name: _argument(getattr(self, name)) for name in names if name != "dynamics"}
        )
        refuse([line for kind in kinds for line in without_place(spec, kind)])
        return spec
