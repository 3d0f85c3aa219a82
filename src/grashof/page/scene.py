"""What a page draws of a problem: targets, scene, areas kept out, regions, the published path."""

from __future__ import annotations

from typing import Any

import numpy as np

from grashof.analysis import driver_ranges
from grashof.drawing.scene import Scene
from grashof.page.render import compact, plain
from grashof.problems import FourBar, Problem, Task, catalogue, load
from grashof.problems.files.published import published
from grashof.synth import Result

_SAMPLES = 181


def scene_of(problem: Problem) -> dict[str, Any]:
    """A problem as the scripts draw it; lengths in its unit, angles in rad, null where free or open."""
    wanted = problem.requirements
    boxes = {name: box for name in FourBar.mechanism.pivots if (box := getattr(wanted, name)) is not None}
    return {
        **_targets(problem.task),
        "unit": problem.length_unit,
        "outlines": [corners.tolist() for corners in problem.outlines],
        "keepOut": [corners.tolist() for corners in wanted.keep_out],
        "keptOut": list(wanted.keep_out_for),
        "regions": [
            {
                "name": ", ".join(name.upper() for name, other in boxes.items() if other == box),
                "x": list(map(plain, np.array(box.x, dtype=float))),
                "y": list(map(plain, np.array(box.y, dtype=float))),
            }
            for box in dict.fromkeys(boxes.values())
        ],
        "published": _published(problem),
    }


def loci_of(result: Result) -> dict[str, Any] | None:
    """Where the joints can be, the pieces of the best linkages last; None where that is not known, or few."""
    loci = result.loci
    if loci is None or not len(loci.transmission) or not result.candidates:
        return None
    order = np.argsort(loci.transmission, kind="stable")
    degrees = np.degrees(loci.transmission[order])
    return {
        "moving": [compact(ends) for ends in loci.moving[order].reshape(-1, 4)],
        "ground": [compact(ends) for ends in loci.ground[order].reshape(-1, 4)],
        "share": [round(float(each), 3) for each in degrees / degrees[-1]],
        "best": round(float(degrees[-1]), 1),
    }


def _targets(task: Task) -> dict[str, Any]:
    if not task.has_position.any() and not task.has_angle.any():  # limit positions: the linkage has them
        return {"points": [], "closed": task.closed}
    if task.only_points:
        return {"points": task.positions.tolist(), "closed": task.closed}
    poses = np.column_stack([task.positions, task.angles])
    body = None if task.body is None or not task.has_angle.any() else task.body.tolist()
    targets = {"poses": [list(map(plain, pose)) for pose in poses], "body": body, "closed": task.closed}
    return targets | {"bare": True} if task.has_output.any() else targets


def _published(problem: Problem) -> dict[str, Any] | None:
    """Path of the best published design, for a path of the catalogue."""
    task, known = problem.task, published(problem.name)
    if not known or problem.name not in catalogue():
        return None
    if not np.array_equal(task.positions, load(problem.name).task.positions):
        return None  # another problem of the same name
    best = known[0]
    low, high = driver_ranges(best.linkage)[0]
    path = Scene(best.linkage).path(np.linspace(low, high, _SAMPLES))
    return {
        "label": f"{best.method} {best.year}",
        "path": [compact(point) for point in path if np.isfinite(point).all()],
    }
