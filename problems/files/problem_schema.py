"""The structure of problem files: their keys and types; the value types check the values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Tag, ValidationInfo, create_model, field_validator
from pydantic_core import PydanticCustomError

from grashof.problems.files import tables
from grashof.problems.files.dynamics_schema import MachineTables
from grashof.problems.files.named_files import with_files
from grashof.problems.files.place_schema import Place
from grashof.problems.files.task_schema import TASKS, Corners, Pair, SceneTable
from grashof.problems.values.checks import noted, refused
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.dynamics.manufacturing import Manufacturing
from grashof.problems.values.dynamics.wanted_torque import ROW, WantedTorque
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.linkages.cylinder import CARRIERS, CylinderSpec
from grashof.problems.values.linkages.mechanisms import ANY_KINDS, mechanisms
from grashof.problems.values.requirements.limit_kinds import Kind
from grashof.problems.values.requirements.modes import Rotatability
from grashof.problems.values.requirements.objective import GOALS, Objective
from grashof.problems.values.requirements.requirement_checks import KEPT_OUT
from grashof.problems.values.requirements.requirements import LIMITS, Requirements
from grashof.problems.values.requirements.target_limits import TOGGLE, TargetLimits
from grashof.problems.values.specs.problem import NO_OBJECTIVE, Problem, Search
from grashof.problems.values.tasks.task import Task
from grashof.problems.values.text import near_miss


def problem_from(document: dict[str, Any], name: str, folder: Path | None = None) -> Problem:
    """Problem stated by a parsed problem file; `ProblemError` has a line with the key path of each error.

    Without the folder of the file the document may name no other file.
    """
    document = with_files(document, folder)
    wrong: list[str] = []
    with noted(wrong):
        return tables.stated(ProblemFile, document, folder).problem(name)
    raise refused([*wrong, *_ill_matched(document)])


def _ill_matched(document: dict[str, Any]) -> Iterator[str]:
    """Contradictions between tables, which stay unreported while a table has errors of its own."""
    kind, unit = document.get("kind"), document.get("length_unit", "")
    for other in TASKS if kind in [*TASKS] else ():  # a file may state a table as its kind
        if other != kind and other in document:
            yield f'{other} does not belong to kind = "{kind}"'
    wrong: list[str] = []
    if any(table in document for table in MachineTables.model_fields) and isinstance(unit, str):
        with noted(wrong):
            metres(unit)
    yield from wrong


_AREAS = "a list of polygons, each a list of corners [x, y], or a .dxf or .svg file"


def _is_corner(given: Any) -> bool:
    return isinstance(given, list) and len(given) == 2 and all(isinstance(x, int | float) for x in given)


_SEVERAL = tables.unless(
    lambda given: not (isinstance(given, list) and given and all(map(_is_corner, given))),
    "a list of polygons, such as [[[0, 0], [1, 0], [1, 1]]]",  # a single one is refused in one line
)
Areas = Annotated[list[Corners], tables.listed(_AREAS), BeforeValidator(_SEVERAL)]
Parts = Annotated[list[str], tables.listed(KEPT_OUT)]
Direction = Annotated[
    Annotated[float, Tag(tables.NUMBER)] | Annotated[Pair, Tag(tables.LIST)],
    tables.either("a number or [lo, hi]"),
]
_BY_KIND = {
    Kind.DIRECTION: Direction,
    Kind.BETWEEN: Pair,
    Kind.HEADING: Pair,
    Kind.INSIDE: Place,
    Kind.ON_BODY: Place,
    Kind.WORD: str,
    Kind.NAMED: dict[str, Direction],
}


_AT_TARGETS = {
    "targets": list[int],
    "links": (list[str], [*TOGGLE]),
    **dict.fromkeys(("a", "b", "instant_centre"), (Place | None, None)),
}
_OF_TARGETS = {
    **dict.fromkeys(("past_deg", "coupler_angle_deg", "coupler_rate"), (Pair | None, None)),
    "distances": (dict[str, Direction] | None, None),
}


@tables.keys_of(TargetLimits, {**_AT_TARGETS, **_OF_TARGETS})
class TargetTable(tables.SpecTable):
    beside = MappingProxyType({"*": {"targets": [1], "transmission_min_deg": 1.0}})


_MODES: dict[str, Any] = {
    **dict.fromkeys(("exact", "order", "same_branch"), bool),
    **dict.fromkeys(("rotatability", "transmission_over"), str),
    "keep_out": Areas,
    "keep_out_for": Parts,
    "at": list[Annotated[TargetTable, AfterValidator(TargetTable.value)]],
}


# The type of each key of ``[requirements]``: by its limit, or as a mode.
_TYPES: dict[str, Any] = {
    each.name: _BY_KIND.get(LIMITS[each.name].kind, float)
    if each.name in LIMITS
    else _MODES.get(each.name, float)
    for each in fields(Requirements)
}


@tables.keys_of(Requirements, {name: (given | None, None) for name, given in _TYPES.items()})
class RequirementsTable(tables.SpecTable):
    beside = tables.EACH


_Weights = create_model("_Weights", __base__=tables.Table, **dict.fromkeys(GOALS, (float, 0.0)))  # type: ignore[call-overload]


class WeightsTable(_Weights):  # type: ignore[misc, valid-type]
    @field_validator("*")
    @classmethod
    def _by_itself(cls, weight: float, key: ValidationInfo) -> float:
        Objective(**{"transmission": 1.0, "compactness": 1.0, str(key.field_name): weight})
        return weight


_GOALS = "transmission, compactness, torque, another quantity"


def _goal(word: str) -> str:
    if word not in GOALS:
        raise PydanticCustomError(tables.WRONG, f"{near_miss(word, list(GOALS)) or _GOALS}")
    return word


Maximise = Annotated[
    Annotated[str, AfterValidator(_goal), Tag(tables.WORD)] | Annotated[WeightsTable, Tag(tables.TABLE)],
    tables.either(f"{_GOALS} or a table of weights"),
]


class ObjectiveTable(tables.Table):
    """The criterion that ranks designs.

    Parameters
    ----------
    maximise : str or table
        The goal, or weights of several; quantities that are better when small are made small.
    """

    maximise: Maximise = "transmission"

    def value(self) -> Objective:
        if isinstance(self.maximise, WeightsTable):
            return Objective(**dict(self.maximise))
        return Objective(**{"transmission": 0.0, self.maximise: 1.0})


Carriers = Annotated[list[str], tables.listed(f"a list of some of {', '.join(CARRIERS)}")]


@tables.keys_of(CylinderSpec, {"closed": Pair, "on": Carriers, "base": Place})
class CylinderTable(tables.SpecTable):
    beside = tables.EACH


class DriverTable(tables.Table):
    """The drive of the linkage in place of a crank.

    Parameters
    ----------
    cylinder : CylinderSpec
        Between the ground and a link.
    """

    cylinder: CylinderTable

    def value(self) -> CylinderSpec:
        made: CylinderSpec = self.cylinder.value()
        return made


@tables.keys_of(Manufacturing)
class ManufacturingTable(tables.SpecTable):
    beside = MappingProxyType({"*": {"length_tolerance": 1.0}})


@tables.keys_of(
    WantedTorque, {"wanted": Annotated[list[list[float]], tables.listed(f"a list of rows {ROW}")]}
)
class TorqueTable(tables.SpecTable):
    beside = MappingProxyType({"over": {"wanted": [[1.0, 1.0]]}, "weight": {"wanted": [[1.0, 1.0]]}})


@tables.keys_of(Search)
class SearchTable(tables.SpecTable):
    beside = tables.EACH


Mechanism = Annotated[
    Annotated[str, Tag(tables.WORD)] | Annotated[list[Any], Tag(tables.LIST)],
    tables.either(ANY_KINDS),
    AfterValidator(mechanisms),
]


class _Heading(tables.Table):
    """The complete problem; the keys of a file come in this order.

    Parameters
    ----------
    kind : str
        The kind of task; the table of this name states it.
    title : str
        For people: headings of lists, pages and drawings.
    source : str
        Where the problem is from, for people.
    length_unit : str
        Unit of all lengths: mm, cm, m, in or ft where there are forces, otherwise any word.
    """

    kind: Annotated[str, tables.one_of(*TASKS)]
    mechanism: Mechanism | None = None
    title: tables.Text = ""
    source: tables.Text = ""
    length_unit: tables.Text = ""


_tables: dict[str, Any] = {kind: (table | None, None) for kind, table in TASKS.items()}
_WithTask = create_model("_WithTask", __base__=_Heading, **_tables)


class _Task(_WithTask):  # type: ignore[misc, valid-type]
    scene: SceneTable = SceneTable.model_construct()
    requirements: RequirementsTable = RequirementsTable.model_construct()
    driver: DriverTable | None = None
    objective: ObjectiveTable | None = None


class ProblemFile(MachineTables, _Task):
    torque: TorqueTable | None = None
    manufacturing: ManufacturingTable | None = None
    search: SearchTable = SearchTable.model_construct()

    def value(self) -> Task:
        by_kind: dict[str, Any] = {kind: getattr(self, kind) for kind in TASKS}
        mine = by_kind.pop(self.kind)
        for other, table in by_kind.items():
            if table is not None:
                raise ProblemError(f'{other} does not belong to kind = "{self.kind}"')
        if mine is None:
            raise ProblemError(f"{self.kind} is missing")
        if self.dynamics_spec() is not None:
            metres(self.length_unit)  # refuses one that is not known
        task: Task = mine.value()
        return task

    def _requirements(self) -> Requirements:
        """As stated; a cylinder turns nothing fully, so that with one the default rotatability is any."""
        wanted: Requirements = self.requirements.value()
        if self.driver is not None and not wanted.same_branch:
            raise ProblemError("requirements.same_branch is false; it must be true with driver.cylinder")
        if self.driver is None or "rotatability" in self.requirements.model_fields_set:
            return wanted
        return replace(wanted, rotatability=Rotatability.ANY)

    def problem(self, name: str) -> Problem:
        stated = {} if self.objective is None else {"objective": self.objective.value()}
        problem = Problem(
            name=name,
            title=self.title,
            source=self.source,
            length_unit=self.length_unit,
            task=self.value(),
            outlines=self.scene.value(),
            requirements=self._requirements(),
            dynamics=self.dynamics_spec(),
            torque=None if self.torque is None else self.torque.value(),
            driver=None if self.driver is None else self.driver.value(),
            manufacturing=None if self.manufacturing is None else self.manufacturing.value(),
            search=self.search.value(),
            mechanism=self.mechanism or (),
            **stated,
        )
        if "objective" in self.model_fields_set and not problem.by_objective:
            raise ProblemError(NO_OBJECTIVE)
        return problem
