"""How each kind of task is met, and its own requirements: a row for each kind that differs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from grashof.analysis.curves.coupler_curve import closed_length
from grashof.analysis.judge.function_output import met_as_function
from grashof.analysis.judge.meeting.dwell_output import DwellFigures, least_band
from grashof.analysis.judge.meeting.function_start import off_mirror
from grashof.analysis.judge.meeting.inputs import Driven
from grashof.analysis.judge.meeting.points import met_in_order, met_singly
from grashof.analysis.judge.meeting.poses import nearest_to_poses, poses_in_order
from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion, task_motion, task_motions
from grashof.analysis.judge.meeting.timed import met_in_time
from grashof.analysis.judge.meeting.two_outputs import TwoOutputs, two_outputs
from grashof.analysis.judge.meeting.zones import each_within, first_within
from grashof.analysis.judge.verdict import Defect
from grashof.analysis.mechanism.mobility import branch_index
from grashof.analysis.mechanism.stroke import output_stroke
from grashof.problems import (
    DwellTask,
    FunctionTask,
    Linkage,
    Requirements,
    StrokeTask,
    TandemTask,
    Task,
)
from grashof.problems.values.arrays import TURN, FloatArray, IntArray
from grashof.problems.values.specs.problem import zones_of
from grashof.problems.values.tasks.closed_curve import spline_length
from grashof.problems.values.tasks.dwell_task import SWING_WITHIN
from grashof.problems.values.tasks.stroke_task import EVEN
from grashof.problems.values.tasks.tandem_task import LINKS

Members: TypeAlias = Sequence[Linkage]
MIRRORED = 1e-9  # sizes: allowed distance of B from the mirror image of A


@dataclass(frozen=True, slots=True)
class Met:
    """A linkage at the targets of a task, and its motion.

    It must be on one circuit, and branch, at `theta2` (K,), rad, with `assembly` (K,); `covered` if it can be
    assembled over the entire range of the task. `figures` are further fields of the verdict, `defects` those
    against requirements of the kind of task alone.
    """

    targets: Targets
    motion: TaskMotion
    theta2: FloatArray
    assembly: IntArray
    covered: bool = True
    figures: Mapping[str, Any] = field(default_factory=dict)
    defects: tuple[Defect, ...] = ()


HowMet: TypeAlias = Callable[[Members, Linkage, Any, Requirements, Sequence[Driven]], list[Met]]


def meet(
    members: Members, batch: Linkage, task: Task, wanted: Requirements
) -> list[tuple[Targets, TaskMotion]]:
    """Of each linkage, driver angle, assembly and error at each target, and the motion, of least squares.

    With `order` in sequence in either sense within one turn, otherwise each by itself; with `same_branch`
    points keep to the own assembly and one range; of equal motions the shortest. Points and timed targets
    begin at `theta2_start_deg`, where it is given; otherwise targets with zones are met within them, where
    least squares leave one and other driver angles do not.
    """
    how = _points_or_timed if task.is_timed or task.only_points else _poses
    found = how(members, batch, task, wanted)
    if (zones := zones_of(task, wanted)) is not None and wanted.theta2_start_deg is None:
        if task.is_timed:
            within = partial(first_within, same_branch=wanted.same_branch)
        else:
            within = partial(each_within, ordered=wanted.order)
        found = (within(one, task, zones, *met) for one, met in zip(members, found, strict=True))
    return [(targets, motion.closed() if task.closed else motion) for targets, motion in found]


def _points_or_timed(
    members: Members, batch: Linkage, task: Task, wanted: Requirements
) -> Iterator[tuple[Targets, TaskMotion]]:
    start = None if wanted.theta2_start_deg is None else float(np.radians(wanted.theta2_start_deg))
    method = met_in_time if task.is_timed else met_in_order if wanted.order else met_singly
    found = method(members, batch, task, wanted.same_branch, start)
    for linkage, met in zip(members, found, strict=True):
        anywhere = (start or 0.0) + np.nan_to_num(task.driver_turns), np.full(len(task), linkage.assembly), 1
        theta2, assembly, sense = met or anywhere
        if start is None:
            theta2 = theta2 - TURN * np.round(theta2[0] / TURN)
        motion = TaskMotion.ordered(theta2, sense) if sense else task_motion(linkage, theta2, False)
        yield Targets.of(linkage, task, theta2, assembly), motion


def _poses(
    members: Members, batch: Linkage, task: Task, wanted: Requirements
) -> Iterator[tuple[Targets, TaskMotion]]:
    nearest = nearest_to_poses(batch, task)
    targets = nearest.targets
    motions = task_motions(batch, targets.theta2, wanted.order)
    once = len(batch.mechanism.loops) == 1  # it stands in a pose at a single driver angle
    if not wanted.order or (wanted.is_exact(task) and task.is_whole and once):
        yield from ((targets[row], motion) for row, motion in enumerate(motions))
        return
    branch = branch_index(batch[:, None], targets.theta2, targets.assembly)
    joined = (branch == branch[:, :1]).all(axis=1) & (targets.assembly[:, 0] == batch.assembly)
    for row, (linkage, motion) in enumerate(zip(members, motions, strict=True)):
        if motion.in_order and (joined[row] or not wanted.same_branch):
            yield targets[row], motion
        else:
            yield poses_in_order(linkage, task, targets[row], motion, nearest.valleys.get(row))


def _in_plane(
    members: Members, batch: Linkage, task: Task, wanted: Requirements, _: Sequence[Driven]
) -> list[Met]:
    found = meet(members, batch, task, wanted)
    return [_limited_in_length(*each, task) for each in zip(members, found, strict=True)]


def _limited_in_length(linkage: Linkage, met: tuple[Targets, TaskMotion], task: Task) -> Met:
    targets, motion = met
    most = task.most_length_ratio(linkage.mechanism)
    if not np.isfinite(most):
        return Met(targets, motion, targets.theta2, targets.assembly)
    ratio = closed_length(linkage) / spline_length(task.once_round)
    defects = [] if ratio <= most else [_too_long(ratio, most)]
    figures = {"length_ratio": ratio}
    return Met(targets, motion, targets.theta2, targets.assembly, figures=figures, defects=tuple(defects))


def _too_long(ratio: float, most: float) -> Defect:
    """The defect of a curve that strays between the points; without a number where no turn closes it."""
    what = "the length of the curve over that of the spline through the points"
    miss = ratio / most - 1 if np.isfinite(ratio) else np.inf
    return Defect("length_ratio_max", what, ratio, f"up to {most:.6g}", miss)


def _as_function(
    members: Members, batch: Linkage, task: Task, wanted: Requirements, driven: Sequence[Driven]
) -> list[Met]:
    """The entire range counts, not only its pairs."""
    made = list[Met]()
    found = met_as_function(members, batch, task, wanted, driven)
    for linkage, (targets, motion, figures, defects) in zip(members, found, strict=True):
        theta2 = np.array([motion.start, *targets.theta2, motion.end])
        assembly, covered = np.full(len(theta2), int(linkage.assembly)), figures is not None
        if task.mirror is not None:
            defects = (*defects, *_mirror_missed(linkage, task, targets, motion))
        made.append(Met(targets, motion, theta2, assembly, covered, figures or {}, defects))
    return made


def _mirror_missed(linkage: Linkage, task: Task, targets: Targets, motion: TaskMotion) -> Iterator[Defect]:
    """The miss of a mirrored position."""
    sense = np.sign(motion.end - motion.start)
    away = off_mirror(linkage, float(targets.theta2[0] + sense * task.mirror_turn))
    if not (miss := away / task.size) <= MIRRORED:
        what = "the distance of B from the mirror image of A"
        yield Defect("mirror_deg", what, away, f"up to {MIRRORED * task.size:.2g}", miss)


def _between_limits(linkage: Linkage, task: Task, wanted: Requirements, _: Driven) -> Met:
    """The limit positions of a linkage on its own assembly, and the turn that begins with the slow stroke.

    A full turn apart where there are none. Clockwise where the driver's sense has to be; either has the same
    swing and time ratio.
    """
    theta2, motion = _slow_stroke(linkage, wanted)
    assembly, defects = np.full(2, int(linkage.assembly)), tuple(_stroke_defects(linkage, task, wanted))
    return Met(Targets.of(linkage, task, theta2, assembly), motion, theta2, assembly, defects=defects)


def _slow_stroke(linkage: Linkage, wanted: Requirements) -> tuple[FloatArray, TaskMotion]:
    """Driver angles at the ends of the slow stroke of link 4, (2,), and the turn that begins with it."""
    sense = -1 if wanted.driver_sense == "cw" else 1
    stretched, folded = np.nan_to_num(output_stroke(linkage).theta2, nan=0.0).tolist()
    there = sense * (folded - stretched) % TURN
    first, way = (stretched, there) if there > np.pi - EVEN else (folded, TURN - there)
    first -= TURN * np.ceil((first - np.pi) / TURN)
    theta2 = np.array([first, first + sense * way])
    return theta2, TaskMotion.ordered(theta2, sense).closed()


def _stroke_defects(linkage: Linkage, task: Task, wanted: Requirements) -> Iterator[Defect]:
    """Misses of the swing (by `tolerance` in rad), stroke and time ratio (by that share of them)."""
    found = output_stroke(linkage)
    ratio = float(found.time_ratio)
    if task.stroke is None:
        swing = float(found.swing)
        if np.isnan(swing):  # link 4 does not turn back
            swing, ratio = TURN, task.time_ratio
        first = ("the swing in deg", swing, task.swing or 0.0, float(np.degrees(1.0)), 1.0)
    elif lacking := int(np.isnan(found.theta2).sum()):
        yield Defect("exact", "the number of limit positions", 2 - lacking, "2", 1.0)
        return
    else:
        first = ("the stroke", float(found.chord), task.stroke, 1.0, task.stroke)
    ratios = "the time ratio", ratio, task.time_ratio, 1.0, task.time_ratio
    for wish in (first, ratios):
        yield from _missed_by(wanted.tolerance, *wish)


def _missed_by(
    tolerance: float, what: str, value: float, wish: float, unit: float, scale: float
) -> Iterator[Defect]:
    """The miss of a wish, in a unit, by more than a tolerance in scales."""
    miss = abs(value - wish) / scale if np.isfinite(value) else np.inf
    if not miss <= tolerance:
        within = f"{wish * unit:.6g} within {tolerance * scale * unit:.2g}"
        yield Defect("exact", what, value * unit, within, miss - tolerance)


def _in_tandem(linkage: Linkage, task: TandemTask, wanted: Requirements, _: Driven) -> Met:
    """As for one stroke, that of link 4; both swings have to be met, and the time ratios that are stated."""
    (theta2, motion), found = _slow_stroke(linkage, wanted), two_outputs(linkage, LINKS)
    assembly, defects = np.full(2, int(linkage.assembly)), tuple(_tandem_defects(found, task, wanted))
    targets = Targets.of(linkage, task, theta2, assembly)
    return Met(targets, motion, theta2, assembly, figures={"outputs": found}, defects=defects)


def _tandem_defects(found: TwoOutputs | None, task: TandemTask, wanted: Requirements) -> Iterator[Defect]:
    """Misses of the swings (by `tolerance` in rad), and of time ratios (by that share of them)."""
    if found is None:
        yield Defect("exact", "the number of links that swing over a full turn of the driver", 0, "2", 1.0)
        return
    pairs = zip(task.strokes, found.swings, found.time_ratios, strict=True)
    for stroke, swing, ratio in pairs:
        turn = min(swing, TURN)
        name, unit = f"the swing of link {stroke.link} in deg", float(np.degrees(1.0))
        yield from _missed_by(wanted.tolerance, name, turn, stroke.swing, unit, 1.0)
        if (wish := stroke.time_ratio) is not None:
            name = f"the time ratio of link {stroke.link}"
            yield from _missed_by(wanted.tolerance, name, ratio, wish, 1.0, wish)


def _standing_still(linkage: Linkage, task: DwellTask, wanted: Requirements, _: Driven) -> Met:
    """The ends of the dwell of least band, and the turn that begins with it; anywhere where there is none."""
    sense = -1 if wanted.driver_sense == "cw" else 1
    slides = bool(linkage.mechanism.loops[-1].slide_angle)
    found = least_band(linkage, task.dwell) if slides == (task.stroke is not None) else None
    start = 0.0 if found is None else found.start if sense > 0 else found.end
    start -= TURN * np.ceil((start - np.pi) / TURN)
    theta2, assembly = np.array([start, start + sense * task.dwell]), np.full(2, int(linkage.assembly))
    motion, defects = TaskMotion.ordered(theta2, sense).closed(), tuple(_dwell_defects(found, task, slides))
    targets = Targets.of(linkage, task, theta2, assembly)
    return Met(targets, motion, theta2, assembly, figures={"dwell": found}, defects=defects)


def _dwell_defects(found: DwellFigures | None, task: DwellTask, slides: bool) -> Iterator[Defect]:
    """Misses of the swing or stroke, and a band that is too wide."""
    turns = task.stroke is None
    if found is None:
        what, number, allowed = "dwells over a full turn of the driver", 0, "1"
        if slides == turns:
            what, number, allowed = "slides as the last link", int(slides), str(int(not turns))
        yield Defect("exact", f"the number of {what}", number, allowed, 1.0)
        return
    (deg, unit), scale = (" in deg", np.degrees(1.0)) if turns else ("", 1.0), 1.0 if turns else task.size
    within = SWING_WITHIN * scale
    miss = (abs(found.swing - task.output_size) - within) / scale
    if not miss <= 0:
        allowed = f"{task.output_size * unit:.6g} within {within * unit:.2g}"
        yield Defect("exact", f"the {'swing' if turns else 'stroke'}{deg}", found.swing * unit, allowed, miss)
    if not found.band <= task.most_band:
        allowed, miss = f"up to {task.most_band * unit:.6g}", (found.band - task.most_band) / scale
        key = "band_deg" if turns else "band"
        yield Defect(key, f"the output band in the dwell{deg}", found.band * unit, allowed, miss)


def _singly(how: Callable[[Linkage, Any, Requirements, Driven], Met]) -> HowMet:
    """How the linkages of a batch meet a task, by a function of each."""

    def met(
        members: Members, _: Linkage, task: Any, wanted: Requirements, driven: Sequence[Driven]
    ) -> list[Met]:
        return [how(linkage, task, wanted, by) for linkage, by in zip(members, driven, strict=True)]

    return met


#: Of linkages of one kind, one by one and as a batch (B,), with the cylinders that drive them.
HOW_MET: Mapping[type, HowMet] = {
    Task: _in_plane,
    FunctionTask: _as_function,
    StrokeTask: _singly(_between_limits),
    DwellTask: _singly(_standing_still),
    TandemTask: _singly(_in_tandem),
}
