"""What a kind of task, or a cylinder as driver, does not go with, a line each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from grashof.problems.values.requirements.quantities import TRAVELLING, TURNING, Needs, Quantity
from grashof.problems.values.requirements.requirements import Requirements, Rotatability
from grashof.problems.values.tasks.task import Task


def without_meaning(task: Task, wanted: Requirements, asked: Mapping[str, Quantity]) -> list[str]:
    """What is asked, by its key path, or limited though it means nothing for the task."""
    kind = task.kind
    wrong = [
        f"{where} means nothing for a {kind}; leave it out"
        for where, quantity in asked.items()
        if quantity.key in task.without
    ]
    if wanted.keep_out:
        wrong += [
            f"requirements.keep_out_for has {part}, which means nothing for a {kind}; leave it out"
            for part in wanted.keep_out_for
            if part in task.without
        ]
    if task.has_output.any():
        wrong += [
            f"requirements.{name} is false; it must be true for a {kind}"
            for name in ("order", "same_branch")
            if not getattr(wanted, name)
        ]
    return wrong


def no_output(task: Task) -> dict[Needs, str]:
    """What is missing where a structural error is asked for, in words."""
    if not task.has_output.any():
        none = f'{task.kind} asks for no output; kind = "function" does'
        return dict.fromkeys((Needs.OUTPUTS, Needs.ROTATION, Needs.TRAVEL), none)
    return {
        Needs.ROTATION: "function has an output that slides, not one that turns",
        Needs.TRAVEL: "function has an output that turns, not one that slides",
    }


def functions_wrong(task: Task, kinds: Sequence[str]) -> list[str]:
    """Kinds of linkages whose output does not move as a function asks for."""
    if not task.has_output.any():
        return []
    suited, what, unit = (TRAVELLING, "travel", "") if task.travels else (TURNING, "rotation", "_deg")
    others = [word for word in kinds if word not in suited]
    if not others:
        return []
    key = f"output{'' if task.law is None else '_range'}{unit}"
    return [
        f"function.{key} is a {what}, which mechanism {' and '.join(others)} does not put out; "
        f"it goes with {' and '.join(suited)}"
    ]


def cylinders_wrong(task: Task, wanted: Requirements) -> list[str]:
    """What a cylinder cannot do, where one is the driver."""
    wrong = []
    if task.no_cylinder:
        wrong.append(f"driver.cylinder does not go with {task.kind}, {task.no_cylinder}")
    elif task.closed:
        wrong.append(f"{task.kind}.closed is true; it must be false with driver.cylinder, which reverses")
    if wanted.rotatability is not Rotatability.ANY:
        wrong.append(
            f"requirements.rotatability is {wanted.rotatability}; it must be any with driver.cylinder, "
            "which turns nothing fully"
        )
    return wrong
