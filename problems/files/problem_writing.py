"""A problem written as a file, which `load` reads back as the same problem."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, fields
from typing import Any

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.box import Box
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.errors import shown_key
from grashof.problems.values.linkages.mechanisms import kinds_text
from grashof.problems.values.region import Region
from grashof.problems.values.requirements.requirements import Requirements
from grashof.problems.values.requirements.target_limits import TargetLimits
from grashof.problems.values.specs.problem import Problem
from grashof.problems.values.tasks.dwell_task import DwellTask
from grashof.problems.values.tasks.function_task import FunctionTask
from grashof.problems.values.tasks.tandem_task import TandemTask
from grashof.problems.values.tasks.task import Task, row_of


def problem_toml(problem: Problem) -> str:
    """The problem as TOML, complete, with numbers in full precision.

    Angles are in degrees: those that a file stated come back to the last bit, others to rounding.
    """
    kinds = problem.mechanism
    kind = {"mechanism": kinds[0] if len(kinds) == 1 else kinds} if kinds_text(kinds) else {}
    head = {"kind": problem.task.kind, **kind, **{key: getattr(problem, key) for key in _WORDS}}
    return toml_text(head, _tables(problem))


Tables = Iterable[tuple[str, Mapping[str, Any] | list[Mapping[str, Any]]]]
"Tables by name, or lists of tables."


def toml_text(head: Mapping[str, Any], tables: Tables = ()) -> str:
    """A TOML file of keys and the tables that follow them.

    Examples
    --------
    >>> print(toml_text({"r2": 1.5}, [("dynamics", {"speed_rpm": -20.0})]))
    r2 = 1.5
    <BLANKLINE>
    [dynamics]
    speed_rpm = -20.0
    <BLANKLINE>
    """
    lines = [f"{key} = {toml_value(value)}" for key, value in head.items()]
    for name, given in tables:
        heading = f"[[{name}]]" if isinstance(given, list) else f"[{name}]"
        for table in given if isinstance(given, list) else [given]:
            lines += ["", heading, *(f"{key} = {toml_value(value)}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


_WORDS = ("title", "source", "length_unit")


def _tables(problem: Problem) -> Tables:
    stated = row_of(_TASKS, problem.task)(problem.task)
    yield problem.task.kind, stated if isinstance(stated, list) else _given(stated)
    if problem.outlines:
        yield "scene", {"outlines": problem.outlines}
    wanted = problem.requirements
    yield "requirements", _given({field.name: getattr(wanted, field.name) for field in fields(Requirements)})
    if problem.driver is not None:
        yield "driver", {"cylinder": problem.driver.stated}
    if problem.by_objective:
        yield "objective", {"maximise": problem.objective.stated}
    if problem.dynamics is not None:
        yield from dynamics_tables(problem.dynamics, problem.length_unit)
    if problem.torque is not None:
        yield "torque", problem.torque.stated
    if problem.manufacturing is not None:
        yield "manufacturing", asdict(problem.manufacturing)
    yield "search", asdict(problem.search)


def dynamics_tables(spec: DynamicsSpec, length_unit: str) -> Iterator[tuple[str, Any]]:
    """The tables of dynamics; usual sizes of parts, which files have by default, are left out."""
    # Here, not above: worker processes import this module, and need not pay for pydantic.
    from grashof.problems.files.effort_schema import usual_sizes

    for name, table in spec.tables.items():
        if name == "effort":
            for part in table.get("parts", []):
                if part["sizes"] == [size.stated for size in usual_sizes(part["kind"], length_unit)]:
                    del part["sizes"]
        yield name, table


def _given(table: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in table.items() if value is not None}


def _task(task: Task) -> dict[str, Any]:
    """A task's table: its fields, angles in degrees, and poses in rows."""
    given = {field.name: getattr(task, field.name) for field in fields(task) if field.init}  # type: ignore[arg-type]
    if given.pop("angles", None) is not None:
        given = {"poses": _poses(task), **given}
        del given["positions"]
    for name in task.in_degrees:
        if given.get(name) is not None:
            given[f"{name}_deg"] = degrees_of(given.pop(name))
    return given


def _function(task: FunctionTask) -> dict[str, Any]:
    """A function's table: its pairs, or the law with its ranges."""
    words: dict[str, Any] = {"sense": task.sense, "norm": task.norm, "link": task.link}
    if task.rates is not None:
        at, *limits = task.rates.T
        by_angle = task.lengthens and not task.travels
        rates = [degrees_of(each) if by_angle else task.rate_unit * each for each in limits]
        words["rate"] = np.column_stack([at if task.lengthens else degrees_of(at), *rates])
    if task.mirror is not None:
        words["mirror_deg"] = degrees_of(np.array(task.mirror))
    law = task.law
    if law is None:
        output = {"output": task.outputs} if task.travels else {"output_deg": degrees_of(task.outputs)}
        given = {"input": task.inputs} if task.lengthens else {"input_deg": degrees_of(task.inputs)}
        return {**given, **output, **words}
    output = {"output_range_deg": degrees_of(np.array(law.output_range))}
    return {
        "law": law.name,
        "x": law.x,
        "exponent": law.exponent,
        "input_range_deg": degrees_of(np.array(law.input_range)),
        **({"output_range": law.output_range} if law.travels else output),
        "pairs": None if task.fits_range else len(task),
        "sampled": law.samples,
        **words,
    }


def _dwell(task: DwellTask) -> dict[str, Any]:
    """A dwell's table: the band in degrees where the output swings."""
    degrees = ("dwell", "swing", "band") if task.stroke is None else ("dwell",)
    given = {name: getattr(task, name) for name in ("dwell", "swing", "stroke", "band")}
    return {
        f"{name}_deg" if name in degrees else name: degrees_of(value) if name in degrees else value
        for name, value in given.items()
        if value is not None
    }


def _strokes(task: TandemTask) -> list[Mapping[str, Any]]:
    """A table for each output."""
    swings = (degrees_of(np.array(swing)) for swing in task.swings)
    return [
        _given({"link": each.link, "swing_deg": swing, "time_ratio": each.time_ratio})
        for each, swing in zip(task.strokes, swings, strict=True)
    ]


# Tables by the kind of task; most are written by their fields.
_TASKS: Mapping[type, Callable[[Any], dict[str, Any] | list[Mapping[str, Any]]]] = {
    Task: _task,
    FunctionTask: _function,
    DwellTask: _dwell,
    TandemTask: _strokes,
}


def _poses(task: Task) -> list[Any]:
    rows = np.column_stack([task.positions, degrees_of(task.angles)]).tolist()
    given = ({key: x for key, x in zip(("x", "y", "angle"), row, strict=True) if x == x} for row in rows)
    return [row if task.is_whole else pose for row, pose in zip(rows, given, strict=True)]


def degrees_of(angles: FloatArray) -> FloatArray:
    """Degrees that give these radians to the last bit, where possible."""
    nearest = np.degrees(angles)
    beside = [np.nextafter(nearest, -np.inf), np.nextafter(nearest, np.inf), np.round(nearest, 9)]
    found = nearest.copy()
    for tried in (*beside, nearest):
        found = np.where(np.radians(tried) == angles, tried, found)
    return found


def toml_value(value: Any) -> str:
    """A value as TOML has it, numbers in full precision."""
    if isinstance(value, Region):
        value = {"inside": value.inside} if value.on is None else {"on": value.on}
    if isinstance(value, Box):
        value = asdict(value)
    if isinstance(value, TargetLimits):
        value = {name: getattr(value, name) for name in ("targets", *value.limited)}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{shown_key(key)} = {toml_value(each)}' for key, each in value.items())} }}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, (str, bool)):
        return json.dumps(value, ensure_ascii=False)
    return repr(int(value)) if isinstance(value, (int, np.integer)) else repr(float(value))
