"""Tables of a problem file that state the task, and the scene around it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Any, ClassVar

from pydantic import AfterValidator, Tag, WithJsonSchema, model_validator

from grashof.problems.files.curves import POINTS
from grashof.problems.files.tables import (
    EACH,
    LIST,
    NUMBER,
    TABLE,
    TWO,
    SpecTable,
    Table,
    either,
    keys_of,
    listed,
    numbers,
)
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import each_checked, outline
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.specs.problem import MOST_TARGETS
from grashof.problems.values.tasks.dwell_task import DwellTask
from grashof.problems.values.tasks.function_task import FunctionTask
from grashof.problems.values.tasks.motion_task import MotionTask
from grashof.problems.values.tasks.path_task import PathTask
from grashof.problems.values.tasks.stroke_task import StrokeTask
from grashof.problems.values.tasks.tandem_task import LinkSwing, TandemTask

Corners = Annotated[
    list[Annotated[list[float], listed("a corner [x, y]"), TWO]], listed("a list of corners [x, y]")
]
Drawn = Annotated[
    list[Annotated[list[float], listed("a corner [x, y]"), TWO]],
    listed("a list of corners [x, y], or a .dxf or .svg file"),
]
Pair = Annotated[list[float], listed("[lo, hi]"), TWO]


Zone = Annotated[
    Annotated[float, Tag(NUMBER)] | Annotated[list[float], Tag(LIST)],
    either("a number, or a list of one for each target"),
]


class TargetsTable(SpecTable):
    """Targets and their options. Each key is checked by itself, on plain targets."""

    plain: ClassVar[list[float]]  # a target, but for its x
    fewest: ClassVar[int]

    @classmethod
    def needed(cls, key: str, given: Any) -> Mapping[str, Any] | None:
        targets = next(iter(cls.model_fields))
        if key == targets:
            return cls.beside.get(key, {})
        count = len(given) if isinstance(given, list) and key != "body" else cls.fewest
        if count < cls.fewest:
            return None
        return {targets: [[k, *cls.plain] for k in range(count)], **cls.beside.get(key, {})}


Numbers = Annotated[list[float], listed("a list of numbers")]
Angles = Annotated[list[float], listed("a list of angles", MOST_TARGETS)]
Poses = Annotated[
    list[Any], listed("a list of poses [x, y, angle in degrees], or a .csv or .xlsx file", MOST_TARGETS)
]
Points = Annotated[
    list[Annotated[list[float], listed("a point [x, y]"), TWO]],
    listed("a list of points [x, y], or a .csv, .xlsx, .dxf or .svg file", MOST_TARGETS),
]
_OF_TARGETS = {
    **{"poses": Poses, "points": Points, "weights": Numbers, "body": Drawn, "timing_deg": Angles},
    **dict.fromkeys(("within", "angle_within_deg"), Zone),
}


@keys_of(MotionTask, _OF_TARGETS)
class MotionTable(TargetsTable):
    plain, fewest = [0.0, 0.0], 2
    beside = MappingProxyType({"poses": {"angle_length": 1.0}})


@keys_of(PathTask, _OF_TARGETS)
class _PathKeys(TargetsTable):
    plain, fewest = [0.0], 3
    beside = MappingProxyType({"length_ratio_max": {"closed": True}})


class PathTable(_PathKeys):
    """Points that the coupler point P passes through, listed or along a drawn curve.

    Parameters
    ----------
    count : int
        Number of points, at equal distances along the curve of a drawing.
    """

    count: int = POINTS

    @classmethod
    def needed(cls, key: str, given: Any) -> Mapping[str, Any] | None:
        if key == "count":  # of a curve it is used up before
            raise ProblemError("count goes with the curve of a .dxf or .svg file as points; remove it")
        return super().needed(key, given)


@keys_of(StrokeTask, {"time_ratio": (float, ...)})
class StrokeTable(SpecTable):
    beside = MappingProxyType({**EACH, "time_ratio": {"swing_deg": 60.0}})


@keys_of(LinkSwing, {"time_ratio": (float | None, None)})
class LinkSwingTable(SpecTable):
    suggested = False
    beside = MappingProxyType(
        {"link": {"swing_deg": 60.0}, "swing_deg": {"link": 4}, "time_ratio": {"link": 4, "swing_deg": 60.0}}
    )

    @model_validator(mode="before")
    @classmethod
    def _swings(cls, given: Any) -> Any:
        if isinstance(given, dict) and "stroke" in given:
            raise ProblemError("stroke is of a slide; links 4 and 6 of two outputs have a swing, swing_deg")
        return given


class Strokes(tuple[LinkSwingTable, ...]):
    """Tables of two outputs."""

    __slots__ = ()

    def value(self) -> TandemTask:
        """The task that they state."""
        return TandemTask([table.value() for table in self])


def _both(tables: list[LinkSwingTable]) -> Strokes:
    made = Strokes(tables)
    made.value()  # so that errors are reported here
    return made


# One output, or two.
OneOrTwo = Annotated[
    Annotated[StrokeTable, Tag(TABLE)] | Annotated[list[LinkSwingTable], AfterValidator(_both), Tag(LIST)],
    either("a table [stroke], or two tables [[stroke]]"),
]


@keys_of(DwellTask)
class DwellTable(SpecTable):
    beside = MappingProxyType(
        {"dwell_deg": {"swing_deg": 60.0}, "swing_deg": {"dwell_deg": 60.0}, "stroke": {"dwell_deg": 60.0}}
    )


_RATE = Annotated[list[float], listed("a row [input, lo, hi]"), WithJsonSchema(numbers(3))]
Rates = Annotated[list[_RATE], listed("a list of rows [input, lo, hi]")]
_PAIRS = {"input_deg": [0, 1, 2], "output_deg": [0, 1, 2]}


@keys_of(
    FunctionTask,
    {
        **dict.fromkeys(("input_deg", "output_deg"), Angles),
        **dict.fromkeys(
            ("input", "output"), Annotated[list[float], listed("a list of lengths", MOST_TARGETS)]
        ),
        "rate": Rates,
        "law": str,
        "x": Pair,
        "sampled": Annotated[list[float], listed("a list of numbers", MOST_TARGETS)],
    },
)
class FunctionTable(SpecTable):
    beside = MappingProxyType(dict.fromkeys(("sense", "norm", "link"), _PAIRS))


# The kinds of tasks in the order of files, each with a table of its name.
TASKS: Mapping[str, Any] = MappingProxyType(
    {
        "motion": MotionTable,
        "path": PathTable,
        "stroke": OneOrTwo,
        "function": FunctionTable,
        "dwell": DwellTable,
    }
)
Outlines = Annotated[
    list[Corners], listed("a list of outlines, each a list of corners [x, y], or a .dxf or .svg file")
]


class SceneTable(Table):
    """The scene, which is drawn with the designs and does not limit them.

    Parameters
    ----------
    outlines : list, length
        Lines from corner to corner, such as the machine's frame.
    """

    outlines: Outlines | None = None

    def value(self) -> tuple[FloatArray, ...]:
        return tuple(each_checked(self.outlines or [], "scene.outlines", outline))
