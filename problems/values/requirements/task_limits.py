"""Requirements, tasks and kinds of linkages that contradict each other, a line each."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from grashof.problems.values.arrays import Limits
from grashof.problems.values.box import Box
from grashof.problems.values.checks import GREATEST, LEAST
from grashof.problems.values.errors import shown, shown_key
from grashof.problems.values.linkages.cylinder import CylinderSpec
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.problems.values.linkages.mechanisms import LENGTHS, joined, not_had
from grashof.problems.values.requirements.distances import Distances
from grashof.problems.values.requirements.limit_kinds import Kind
from grashof.problems.values.requirements.link_ratios import contradictions
from grashof.problems.values.requirements.modes import Rotatability
from grashof.problems.values.requirements.quantities import (
    ROCKERS,
    SLIDING,
    TRAVELLING,
    TURNING,
    Quantity,
)
from grashof.problems.values.requirements.requirements import LIMITS, Requirements
from grashof.problems.values.tasks.task import Task
from grashof.problems.values.units import Unit

_MAY_MISS = 10.0  # tolerances by which a target that counts as met may be missed here
_SWINGS = (
    'requirements.rotatability is "double-crank", whose output does not swing; '
    "with stroke it must be full-crank or crank-rocker"
)


def without_meaning(task: Task, wanted: Requirements, used: Mapping[str, Quantity]) -> list[str]:
    """Goals and limits, by key path, that do not apply to the task, a line each."""
    kind = task.kind
    wrong = [
        f"{where} does not apply to a {kind}; remove it"
        for where, quantity in used.items()
        if quantity.key in task.without
    ]
    wrong += [
        f"{where} does not apply to a {kind} of a slide, which does not turn; remove it"
        for where, quantity in used.items()
        if task.stroke is not None and quantity.unit is Unit.ANGULAR_ACCELERATION
    ]
    if wanted.keep_out:
        wrong += [
            f"requirements.keep_out_for has {part}, which does not apply to a {kind}; remove it"
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


def not_of_kinds(task: Task, given: Sequence[str], having: Mapping[str, Sequence[str]]) -> list[str]:
    """Keys, with the kinds of linkages that have them, that none of the given kinds has, a line each."""
    if task.in_plane or task.has_output.any():  # six-bars with a slide are for other tasks, not those with D
        slides = set(SLIDING)
        having = {
            where: kinds
            if where == "requirements.d"
            else [kind for kind in kinds if kind in ONE_LOOP or not slides.issuperset(kinds)]
            for where, kinds in having.items()
        }
    return [
        not_had(where, given, [kind for kind in kinds if not task.impossible(kind)] or kinds)
        for where, kinds in having.items()
        if not set(kinds) & set(given)
    ]


def requirements_wrong(task: Task, wanted: Requirements, kinds: Sequence[str]) -> list[str]:
    """Contradictions between requirements, a task and kinds of linkages, a line each."""
    wrong = []
    if task.zones is not None and wanted.exact:
        wrong.append(f"{task.kind}.within does not go with requirements.exact = true; it takes its place")
    if task.zones is not None and wanted.error_factor is not None:
        wrong.append(f"requirements.error_factor does not go with {task.kind}.within; give one of them")
    if wanted.error_factor is not None and wanted.is_exact(task):
        wrong.append("requirements.error_factor needs least squares, exact = false")
    lengths = {name: getattr(wanted, name) or wanted.link_length for name in LENGTHS}
    wrong += contradictions(wanted.ratios, lengths, wanted.link_ratio_max)
    if isinstance(wanted.distances, Distances):
        wrong += wanted.distances.wrong(task, "requirements.distances")
    directions = (name for name, limited in LIMITS.items() if limited.kind is Kind.DIRECTION)
    wrong += [
        f"requirements.{name} is a range; of a {task.kind} it must be a single angle"
        for name in directions
        if isinstance(getattr(wanted, name), tuple) and not task.has_position.any()
    ]
    for number, limits in enumerate(wanted.at):
        wrong += limits.wrong(task, kinds, f"requirements.at[{number}]")
    if wanted.at and not wanted.order:
        wrong.append("requirements.order is false; it must be true with requirements.at")
    if wanted.keep_out and "body" in wanted.keep_out_for and task.body is None:
        wrong.append(f"{task.kind}.body is missing; requirements.keep_out_for has body")
    return wrong + (stated_inside(task, wanted) if wanted.keep_out and wanted.is_exact(task) else [])


def stated_inside(task: Task, wanted: Requirements) -> list[str]:
    """Targets that put P, or the body, into an area that it keeps out of, a line each."""
    # Here, not above: shapely takes a while to import, and few problems have areas.
    from grashof.problems.values.areas import depth_of_line

    found, body = list[str](), np.zeros((0, 2)) if task.body is None else task.body
    parts = {"p": "P"} if {"p", "links"} & set(wanted.keep_out_for) and "p" not in task.without else {}
    parts |= {"body": "the body"} if len(body) and "body" in wanted.keep_out_for else {}
    rows = np.column_stack([task.positions, task.angles])
    for k, part in product(range(len(task)), parts):
        x, y, angle = np.nan_to_num(rows[k]).tolist() if part == "p" else rows[k].tolist()
        if not task.has_position[k] or np.isnan(angle):
            continue
        corners = body if part == "body" else np.zeros((1, 2))
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        deep = depth_of_line(wanted.keep_out, corners @ turn + np.array([x, y]))
        reach = task.size + float(np.abs(corners).max())
        if deep > _MAY_MISS * wanted.tolerance * reach:
            where = f"{task.kind}.{task.target}s[{k}]"
            found.append(f"requirements.keep_out: {where} puts {parts[part]} {deep:.3g} deep inside an area")
    return found


def kinds_of_names(wanted: Requirements) -> dict[str, Sequence[str]]:
    """The kinds that have the parts of each limit by name, by its key path."""
    return {
        f"requirements.{field}.{shown_key(name)}": limits.kinds_with(name)
        for field, limits in wanted.named.items()
        for name in limits
    }


def functions_wrong(task: Task, wanted: Requirements, kinds: Sequence[str]) -> list[str]:
    """Contradictions of a function with requirements, and kinds whose output moves otherwise, a line each."""
    if not task.has_output.any():
        return []
    if task.mirror is not None and wanted.exact:
        return ["requirements.exact is true; it must be false with function.mirror_deg"]
    if task.mirror is not None and wanted.theta2_start_deg is not None:
        return ["requirements.theta2_start_deg does not go with function.mirror_deg; remove one of them"]
    suited, what, unit = (TRAVELLING, "travel", "") if task.travels else (TURNING, "rotation", "_deg")
    suited = tuple(word for word in suited if not task.impossible(word))
    others = [word for word in kinds if not task.impossible(word) and word not in suited]
    if not others:
        return []
    key = f"output{'' if task.law is None else '_range'}{unit}"
    return [
        f"function.{key} is a {what}, which mechanism {' and '.join(others)} does not generate; "
        f"it goes with {joined(suited)}"
    ]


def dwells_wrong(task: Task, wanted: Requirements) -> list[str]:
    """Contradictions between a dwell and the requirements, a line each."""
    if task.dwell is None:
        return []
    wrong = []
    if wanted.exact is False:
        wrong.append(
            "requirements.exact is false; with dwell it must be true: the swing or stroke is always met"
        )
    if task.stroke is None and wanted.stroke is not None:
        wrong.append(
            "requirements.stroke does not go with dwell.swing_deg, whose output does not slide; remove it"
        )
    return wrong


def tandems_wrong(task: Task, wanted: Requirements) -> list[str]:
    """Contradictions between two strokes and the requirements, a line each."""
    if task.swings is None:
        return []
    wrong = []
    if wanted.exact is False:
        wrong.append("requirements.exact is false; with stroke it must be true: the swings are always met")
    if wanted.rotatability is Rotatability.DOUBLE_CRANK:
        wrong.append(_SWINGS)
    return wrong


def cylinders_wrong(task: Task, wanted: Requirements) -> list[str]:
    """Contradictions between a cylinder as driver and the task or requirements, a line each."""
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


def lengths_wrong(task: Task, wanted: Requirements, driver: CylinderSpec | None) -> list[str]:
    """Contradictions between inputs that are lengths of a cylinder and what drives, a line each."""
    if not task.lengthens:
        return []
    if driver is None:
        return [f"driver.cylinder is missing; {task.kind}.input, its lengthening, needs it"]
    wrong = []
    if "driver" not in driver.on:
        given = shown(list(driver.on))
        wrong.append(f"driver.cylinder.on is {given}; with {task.kind}.input it must have driver, link 2")
    if wanted.theta2_start_deg is not None:
        wrong.append(
            f"requirements.theta2_start_deg does not go with {task.kind}.input, which leaves link 2 free"
        )
    most = float(task.inputs[-1]) / (driver.ratio_max - 1)
    if driver.closed is not None and driver.closed[1] * (1 + 1e-9) < most:
        wrong.append(
            f"driver.cylinder.closed is up to {driver.closed[1]:.6g}; it must reach {most:.6g} for a stroke "
            f"of {task.inputs[-1]:.6g} with ratio_max {driver.ratio_max:g}"
        )
    return wrong


def strokes_wrong(task: Task, wanted: Requirements, kinds: Sequence[str]) -> list[str]:
    """Contradictions between a stroke, the kinds of linkages and the requirements, a line each."""
    wrong: list[str] = []
    if task.stroke is not None and task.time_ratio > 1 + wanted.tolerance and wanted.offset == (0, 0):
        wrong.append(
            f"stroke.time_ratio is {task.time_ratio:.6g}; it must be 1 where requirements.offset is [0, 0]"
        )
    wrong += _too_small(task, wanted)
    if wanted.exact is False:
        wrong.append("requirements.exact is false; with stroke it must be true: the time ratio is always met")
    if wanted.rotatability is Rotatability.DOUBLE_CRANK and not {*kinds}.isdisjoint(ROCKERS):
        wrong.append(_SWINGS)
    return wrong


def _too_small(task: Task, wanted: Requirements) -> list[str]:
    """The error of a box of B that is too small for the stroke, if it is."""
    if task.stroke is None or wanted.b is None:
        return []
    wide, tall = wanted.b.x[1] - wanted.b.x[0], wanted.b.y[1] - wanted.b.y[0]
    if math.hypot(wide, tall) >= task.stroke * (1 - wanted.tolerance):
        return []
    return [f"requirements.b is {wide:g} by {tall:g}; it must hold the stroke, {task.stroke:g}"]


def stated_size(wanted: Requirements) -> float:
    """A length that limits state, for a task without a size of its own; 1 where there is none."""
    for name in ("r1", "r4", "r3", "link_length", "r2"):
        lengths: Limits | None = getattr(wanted, name)
        if lengths is not None and 0 < lengths[1] < GREATEST:
            return lengths[1]
    if wanted.o2 is not None and wanted.o4 is not None:
        apart = [
            (sum(four) - sum(two)) / 2  # NaN where a box is open
            for two, four in ((wanted.o2.x, wanted.o4.x), (wanted.o2.y, wanted.o4.y))
        ]
        if LEAST < (distance := math.hypot(*apart)) < GREATEST:
            return distance
    return next((size for size in _stated_apart(wanted) if LEAST < size < GREATEST), 1.0)


def _stated_apart(wanted: Requirements) -> Iterator[float]:
    """Upper limits of distances, at most ten times the lower ones; the diagonal of all places."""
    for named in (wanted.named, *(each.named for each in wanted.at)):
        for low, high in named.get("distances", {}).values():
            yield min(high, 10 * low) if low > 0 else high
    sides = [
        [end for box in stated_places(wanted) for end in getattr(box, axis) if math.isfinite(end)]
        for axis in "xy"
    ]
    yield math.hypot(*(max(side) - min(side) for side in sides if side))


def stated_places(wanted: Requirements) -> list[Box]:
    """Where pivots may be, at all targets or at some."""
    places = [wanted.o2, wanted.o4, wanted.a, wanted.b]
    places += [box for each in wanted.at for box in (each.a, each.b)]
    return [box for box in places if box is not None]
