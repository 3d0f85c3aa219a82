"""Regions of joints for the drawings of a page: boxes, polygons and segments, each with its name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from grashof.page.render import plain
from grashof.problems import Box, Problem, Region, Task
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.struts import BODY

PIVOTS = ("o2", "o4", "d", "a", "b")  # equal places are drawn once, in this order


def regions_of(problem: Problem) -> list[dict[str, Any]]:
    """Every region that a problem states, as the scripts draw it, with null for an open side.

    Regions on the body are placed at the first pose; they are left out where that is incomplete or a side is
    open.
    """
    wanted = problem.requirements
    boxes = {name: box for name in PIVOTS if (box := getattr(wanted, name)) is not None}
    found = []
    for box in dict.fromkeys(boxes.values()):
        names = ", ".join(name.upper() for name, other in boxes.items() if other == box)
        found.append(_drawn(f"{names} region", box))
    found += [*_at_targets(problem), *_on_body(problem), *_of_struts(problem)]
    if problem.driver is not None and problem.driver.base is not None:
        found.append(_drawn("region of the cylinder's base", problem.driver.base))
    return found


def _at_targets(problem: Problem) -> Iterator[dict[str, Any]]:
    for each in problem.requirements.at:
        targets = f"target{'s' * (len(each.targets) > 1)} {', '.join(map(str, each.targets))}"
        for name, joint in {"a": "A", "b": "B", "instant_centre": "instant centre"}.items():
            if (box := getattr(each, name)) is not None:
                yield _drawn(f"{joint} region at {targets}", box)


def _on_body(problem: Problem) -> Iterator[dict[str, Any]]:
    for name in ("a", "b"):
        if (box := getattr(problem.requirements, f"{name}_on_body")) is not None:
            yield from _turned(f"{name.upper()} region on the body", box, problem.task)


def _of_struts(problem: Problem) -> Iterator[dict[str, Any]]:
    """Areas of the ends of struts and springs on the ground and on the body."""
    effort = None if problem.dynamics is None else problem.dynamics.effort
    for number, part in enumerate(() if effort is None else effort.parts, start=1):
        for end, place in enumerate(part.places, start=1):
            name = f"region of end {end} of part {number}"
            if place.link == BODY:
                yield from _turned(name, place.at, problem.task)
            elif place.link == 1:
                yield _drawn(name, place.at)


def _turned(name: str, box: Box, task: Task) -> Iterator[dict[str, Any]]:
    """A region on the body where it stands at the first pose, if that is known."""
    corners = _at_first_pose(task, box)
    if corners is not None:
        sides = np.stack([corners.min(axis=0), corners.max(axis=0)]).T.tolist()
        yield {"name": name, "x": sides[0], "y": sides[1], "corners": corners.tolist()}


def _at_first_pose(task: Task, box: Box) -> FloatArray | None:
    """Corners (M, 2) of a place on the body; None where they are not known."""
    if isinstance(box, Region):
        corners = box.corners
    else:
        (left, right), (low, high) = box.x, box.y
        corners = np.array([[left, low], [right, low], [right, high], [left, high]])
    if not np.isfinite([*corners.ravel(), *task.positions[0], task.angles[0]]).all():
        return None
    pose = complex(*task.positions[0]) + corners @ np.array([1, 1j]) * np.exp(1j * task.angles[0])
    return np.column_stack([pose.real, pose.imag])


def _drawn(name: str, box: Box) -> dict[str, Any]:
    corners = {"corners": box.corners.tolist()} if isinstance(box, Region) else {}
    sides = {axis: list(map(plain, np.array(getattr(box, axis), dtype=float))) for axis in ("x", "y")}
    return {"name": name, **sides, **corners}
