"""The problem file's structure: which keys there are and of what type.

The value types check what the values mean; both kinds of error leave as one `ProblemError`.
"""

from __future__ import annotations

import json
import re
import reprlib
from typing import Annotated, Any, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Tag,
    ValidationError,
    model_validator,
)
from pydantic_core import ErrorDetails, PydanticCustomError

from grashof.problems.checks import FloatArray, counted, near_miss, outline
from grashof.problems.dynamics_spec import DynamicsSpec, metres
from grashof.problems.errors import ProblemError
from grashof.problems.manufacturing import Manufacturing
from grashof.problems.motion_task import MotionTask
from grashof.problems.path_task import PathTask
from grashof.problems.problem import Objective, Problem, Search
from grashof.problems.requirements import Box, Requirements
from grashof.problems.task import Task


def problem_from(document: dict[str, Any], name: str) -> Problem:
    """Problem stated by a parsed problem file.

    Parameters
    ----------
    document : dict
        The file as `tomllib` gives it.
    name : str
        What the problem is called, `Problem.name`.

    Raises
    ------
    ProblemError
        The first error found, with its key path, and how many more there are.

    Examples
    --------
    >>> poses = [[0, 0, 0], [3, 4, 90]]
    >>> problem_from({"kind": "motion", "motion": {"poses": poses}}, "two poses").task.size
    5.0
    >>> problem_from({"kind": "motion", "motion": {"pose": poses}}, "two poses")
    Traceback (most recent call last):
        ...
    grashof.problems.errors.ProblemError: motion.pose is unknown; did you mean poses? (and 1 more error)
    """
    try:
        file = ProblemFile.model_validate(document)
    except ValidationError as refused:
        errors = refused.errors(include_url=False)
    else:
        return file.problem(name)
    raise ProblemError(_message(errors))


# What a validator of this module says about a value: its message is what is allowed instead.
_WRONG = "wrong"


def _listed(allowed: str) -> BeforeValidator:
    """Validator that refuses what is no list, saying what it should be a list of."""

    def refuse(value: object) -> object:
        if not isinstance(value, list):
            raise PydanticCustomError(_WRONG, allowed)
        return value

    return BeforeValidator(refuse)


def _one_of(*words: str) -> AfterValidator:
    """Validator of a word: one of those given."""

    def refuse(word: str) -> str:
        if word not in words:
            raise PydanticCustomError(_WRONG, f"{', '.join(words[:-1])} or {words[-1]}")
        return word

    return AfterValidator(refuse)


class _Table(BaseModel):
    """A table of the file. Its value type is built once here, so that what it refuses is counted too."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    def value(self) -> object:
        """What the table states, as a value type."""
        return None

    @model_validator(mode="after")
    def _refuse_bad_values(self) -> Self:
        self.value()
        return self


Corners = Annotated[
    list[Annotated[list[float], _listed("a corner [x, y]")]], _listed("a list of corners [x, y]")
]
Pair = Annotated[list[float], _listed("[lo, hi]")]


class MotionTable(_Table):
    poses: Annotated[list[Any], _listed("a list of poses [x, y, angle in degrees]")]
    weights: Annotated[list[float], _listed("a list of numbers")] | None = None
    angle_length: float | None = None
    body: Corners | None = None

    def value(self) -> MotionTask:
        return MotionTask.from_degrees(
            self.poses, weights=self.weights, angle_length=self.angle_length, body=self.body
        )


class PathTable(_Table):
    points: Annotated[
        list[Annotated[list[float], _listed("a point [x, y]")]], _listed("a list of points [x, y]")
    ]
    timing_deg: Annotated[list[float], _listed("a list of angles")] | None = None
    closed: bool = False

    def value(self) -> PathTask:
        return PathTask.from_degrees(self.points, timing_deg=self.timing_deg, closed=self.closed)


class SceneTable(_Table):
    outlines: Annotated[list[Corners], _listed("a list of outlines, each a list of corners [x, y]")] = []

    def value(self) -> tuple[FloatArray, ...]:
        return tuple(outline(corners, f"scene.outlines[{i}]") for i, corners in enumerate(self.outlines))


class BoxTable(_Table):
    x: Pair | None = None
    y: Pair | None = None

    def value(self) -> Box:
        sides: dict[str, Any] = {axis: getattr(self, axis) for axis in self.model_fields_set}
        return Box(**sides)


def _box(place: BoxTable | list[float]) -> Box:
    if isinstance(place, BoxTable):
        return place.value()
    x, y = place
    return Box((x, x), (y, y))


def _point(point: list[float]) -> list[float]:
    if len(point) != 2:
        raise PydanticCustomError(_WRONG, _PLACE_SHAPES)
    _box(point)
    return point


def _tag(value: object) -> str | None:
    return _TAGS.get(type(value))


# Tags enter the location of an error; `_path` leaves out what begins as they do.
_TAGS: dict[type, str] = {dict: "<table>", BoxTable: "<table>", list: "<list>", str: "<word>"}
_PLACE_SHAPES = "[x, y] or { x = [lo, hi], y = [lo, hi] }"
Place = Annotated[
    Annotated[BoxTable, Tag("<table>")] | Annotated[list[float], AfterValidator(_point), Tag("<list>")],
    Discriminator(_tag, custom_error_type=_WRONG, custom_error_message=_PLACE_SHAPES),
]


class RequirementsTable(_Table):
    exact: bool | None = None
    tolerance: float | None = None
    rotatability: str | None = None
    rotatability_margin: float | None = None
    order: bool | None = None
    same_branch: bool | None = None
    transmission_min_deg: float | None = None
    transmission_over: str | None = None
    link_length: Pair | None = None
    r1: Pair | None = None
    r2: Pair | None = None
    r3: Pair | None = None
    r4: Pair | None = None
    link_ratio_max: float | None = None
    coupler_arms: Pair | None = None
    o2: Place | None = None
    o4: Place | None = None
    a: Place | None = None
    b: Place | None = None
    ground_angle_deg: float | None = None
    theta2_start_deg: float | None = None
    keep_out: (
        Annotated[list[Corners], _listed("a list of polygons, each a list of corners [x, y]")] | None
    ) = None
    keep_out_for: Annotated[list[str], _listed("a list of o2, o4, a, b, p and links")] | None = None

    def value(self) -> Requirements:
        given: dict[str, Any] = {key: getattr(self, key) for key in self.model_fields_set}
        for key in given.keys() & {"o2", "o4", "a", "b"}:
            given[key] = _box(given[key])
        return Requirements(**given)


class WeightsTable(_Table):
    transmission: float = 0.0
    compactness: float = 0.0
    torque: float = 0.0


Maximise = Annotated[
    Annotated[str, _one_of("transmission", "compactness", "torque"), Tag("<word>")]
    | Annotated[WeightsTable, Tag("<table>")],
    Discriminator(
        lambda value: "<table>" if isinstance(value, WeightsTable) else _tag(value),
        custom_error_type=_WRONG,
        custom_error_message="transmission, compactness, torque or a table of weights",
    ),
]


class ObjectiveTable(_Table):
    maximise: Maximise = "transmission"

    def value(self) -> Objective:
        if isinstance(self.maximise, WeightsTable):
            return Objective(**dict(self.maximise))
        return Objective(**{name: float(name == self.maximise) for name in WeightsTable.model_fields})


class ManufacturingTable(_Table):
    length_tolerance: float
    band: float | None = None

    def value(self) -> Manufacturing:
        return Manufacturing(self.length_tolerance, self.band)


class DynamicsTable(_Table):
    speed_rpm: float | None = None
    gravity: Annotated[list[float], _listed("[x, y] in m/s2")] | None = None
    mass_per_length: float | None = None
    masses: Annotated[list[float], _listed("[m2, m3, m4]")] | None = None
    inertias: Annotated[list[float], _listed("[I2, I3, I4]")] | None = None
    payload: float | None = None

    def value(self) -> DynamicsSpec:
        given: dict[str, Any] = {key: getattr(self, key) for key in self.model_fields_set}
        return DynamicsSpec(**given)


class SearchTable(_Table):
    starts: int | None = None
    enough: int | None = None
    seed: int | None = None

    def value(self) -> Search:
        given: dict[str, Any] = {key: getattr(self, key) for key in self.model_fields_set}
        return Search(**given)


class ProblemFile(_Table):
    kind: Annotated[str, _one_of("motion", "path")]
    title: str = ""
    source: str = ""
    length_unit: str = ""
    motion: MotionTable | None = None
    path: PathTable | None = None
    scene: SceneTable = SceneTable()
    requirements: RequirementsTable = RequirementsTable()
    objective: ObjectiveTable = ObjectiveTable()
    dynamics: DynamicsTable | None = None
    manufacturing: ManufacturingTable | None = None
    search: SearchTable = SearchTable()

    def value(self) -> Task:
        tables = {"motion": self.motion, "path": self.path}
        mine = tables.pop(self.kind)
        for other, table in tables.items():
            if table is not None:
                raise ProblemError(f'{other} does not belong to kind = "{self.kind}"')
        if mine is None:
            raise ProblemError(f"{self.kind} is missing")
        if self.dynamics is not None:
            metres(self.length_unit)
        return mine.value()

    def problem(self, name: str) -> Problem:
        return Problem(
            name=name,
            title=self.title,
            source=self.source,
            length_unit=self.length_unit,
            task=self.value(),
            outlines=self.scene.value(),
            requirements=self.requirements.value(),
            objective=self.objective.value(),
            dynamics=None if self.dynamics is None else self.dynamics.value(),
            manufacturing=None if self.manufacturing is None else self.manufacturing.value(),
            search=self.search.value(),
        )


_TABLES: dict[str, type[_Table]] = {
    "": ProblemFile,
    "motion": MotionTable,
    "path": PathTable,
    "scene": SceneTable,
    "requirements": RequirementsTable,
    "requirements.o2": BoxTable,
    "requirements.o4": BoxTable,
    "requirements.a": BoxTable,
    "requirements.b": BoxTable,
    "objective": ObjectiveTable,
    "objective.maximise": WeightsTable,
    "dynamics": DynamicsTable,
    "manufacturing": ManufacturingTable,
    "search": SearchTable,
}

_ALLOWED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "a string",
    "bool_type": "true or false",
    "model_type": "a table",
}


def _message(errors: list[ErrorDetails]) -> str:
    # A missing key comes last: most often it stands in the file, misspelt, and that error says more.
    first = min(errors, key=lambda error: error["type"] == "missing")
    others = len(errors) - 1
    return f"{_described(first)} (and {counted(others, 'more error')})" if others else _described(first)


def _described(error: ErrorDetails) -> str:
    path, kind = _path(error["loc"]), error["type"]
    if kind == "extra_forbidden":
        return _unknown(error["loc"])
    if kind == "missing":
        return f"{path} is missing"
    if kind == "value_error":
        text = str(error["ctx"]["error"])
        # A value type names its key from the top of the file; a box cannot know whose it is.
        return text if text.startswith(path) else f"{path}.{text}"
    allowed = _ALLOWED.get(kind, error["msg"])
    return f"{path} is {_shown(error['input'])}; allowed is {allowed}"


def _unknown(location: tuple[int | str, ...]) -> str:
    path, table, key = _path(location), _path(location[:-1]), str(location[-1])
    keys = list(_TABLES[table].model_fields)
    # A key under the wrong heading; x and y of a box say nothing about where they belong.
    homes = (name for name, other in _TABLES.items() if key in other.model_fields and other is not BoxTable)
    meant = near_miss(key, keys) or next((f"{home}.{key}".lstrip(".") for home in homes), None)
    return f"{path} is unknown; " + (f"did you mean {meant}?" if meant else f"allowed are {', '.join(keys)}")


def _path(location: tuple[int | str, ...]) -> str:
    path = ""
    for part in location:
        if isinstance(part, int):
            path += f"[{part}]"
        elif part not in _TAGS.values():
            key = part if re.fullmatch(r"[A-Za-z0-9_-]+", part) else json.dumps(part)
            path += f".{key}" if path else key
    return path


def _shown(value: object) -> str:
    if isinstance(value, dict):
        return "a table"
    return str(value).lower() if isinstance(value, bool) else reprlib.repr(value)
