"""The judge: does this linkage do the task under the requirements? From the linkage alone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from grashof.analysis.forces.from_spec import TRAVEL_ROUNDING
from grashof.analysis.judge.at_targets import missed_at_targets
from grashof.analysis.judge.cylinder_drive import cylinder_defects, cylinder_travel
from grashof.analysis.judge.design import Constraint, Design, greatest, name_of
from grashof.analysis.judge.how_met import HOW_MET
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.meeting.task_motion import STEADY, Targets, TaskMotion
from grashof.analysis.judge.missed_limits import SLACK, missed
from grashof.analysis.judge.over_task import as_used, joins, motion_ends, sampled
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.analysis.judge.wanted_torque import torque_misses
from grashof.analysis.mechanism.extremes import diagonal, reach_box
from grashof.analysis.mechanism.mobility import (
    branch_index,
    circuit_index,
    closes_everywhere,
    full_rotation,
    grashof_class,
    passes_change_point,
    rotatability,
)
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.mechanism.second_loop import cut
from grashof.analysis.mechanism.transmission import worst_transmission, worst_transmission_cycle
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import Cylinder, Linkage, Problem, Requirements, Rotatability, Task, WantedTorque
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.requirements.function_ground import grounded
from grashof.problems.values.tasks.task import row_of


def verify(
    linkage: Linkage,
    task: Task,
    requirements: Requirements,
    constraints: Sequence[Constraint] = (),
    *,
    most_square: float = np.inf,
    problem: Problem | None = None,
    cylinder: Cylinder | None = None,
) -> Verdict:
    """Judge a single linkage.

    Parameters
    ----------
    linkage : Linkage
    task : Task
    requirements : Requirements
        Defaults that depend on the size of the task are filled in.
    constraints : sequence of callable
        The user's own: functions of a `Design`, zero or negative where met.
    most_square : float, length squared
        Greatest `Verdict.square` allowed: the least one found by ``error_factor``.
    problem : Problem, optional
        That the task is of: needed for limits of torques, forces or made linkages.
    cylinder : Cylinder, optional
        That drives the linkage, where the problem requires one.

    Returns
    -------
    Verdict

    Notes
    -----
    Circuit, branch and order defects as Chase & Mirth (1993) define them. With ``order = false``
    the task motion is the shortest that holds all targets; of a closed task it is the full turn.

    Examples
    --------
    >>> from grashof.analysis.judge.planted import planted_motion
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=4)
    >>> verdict = verify(linkage, task, Requirements())
    >>> verdict.ok, bool(verdict.error_max < 1e-12 * task.size)
    (True, True)
    """
    task = grounded(task, requirements)
    wanted = requirements.for_task(task).resolved(task.size, scale_free=task.scale_free)
    met = row_of(HOW_MET, task)(linkage, task, wanted, cylinder)
    targets, motion = met.targets, met.motion
    circuits = circuit_index(linkage, met.theta2, met.assembly)
    branches = branch_index(linkage, met.theta2, met.assembly)
    circuit_ok = bool((circuits == circuits[0]).all() and circuits[0] >= 0) and met.covered
    branch_ok = circuit_ok and bool((branches == branches[0]).all())
    branch_ok = branch_ok and not passes_change_point(linkage, motion.start, motion.end)
    # Without a motion that joins the targets nothing is transmitted.
    task_worst = float(worst_transmission(linkage, motion.start, motion.end)) if branch_ok else 0.0
    cycle_worst = float(worst_transmission_cycle(linkage))
    verdict = Verdict(
        theta2=motion.theta2,
        assembly=targets.assembly,
        position_error=targets.position_error,
        angle_error=targets.angle_error,
        square=_square(targets, task),
        direction=motion.direction,
        grashof_class=grashof_class(linkage),
        full_rotation=bool(full_rotation(linkage)),
        circuit_ok=circuit_ok,
        branch_ok=branch_ok,
        order_ok=motion.in_order,
        transmission_min_task=task_worst,
        transmission_min_cycle=cycle_worst,
        size=diagonal(reach_box(linkage, motion.start, motion.end)),
        defects=(),
        cylinder=cylinder,
        output_error=targets.output_error,
        **met.figures,
    )
    if problem is not None and problem.torque is not None and problem.torque.weight:
        verdict = replace(
            verdict, square=verdict.square + _of_torque(linkage, problem, problem.torque, verdict)
        )
    drive = _drive(linkage, task, wanted, verdict, motion, problem)
    defects = (
        *(_exactness(targets, task, wanted) if wanted.is_exact(task) else []),
        *met.defects,
        *_zones(targets, task),
        *_total_error(verdict.square, task, most_square),
        *drive,
        *_rotatability(linkage, task, wanted),
        *_covered(targets),
        *(_loads(linkage, problem, verdict) if problem is not None else []),
        *missed(
            Values(linkage, verdict, problem or Problem(task=task, mechanism=linkage.mechanism.word)), wanted
        ),
        *(missed_at_targets(linkage, task, wanted, verdict) if wanted.at else []),
        *(_own(Design.judged(linkage, verdict), constraints) if constraints else []),
        *(_kept_out(linkage, targets, motion, task, wanted, joined=branch_ok) if wanted.keep_out else []),
    )
    return replace(verdict, defects=defects)


def _square(targets: Targets, task: Task) -> float:
    if task.has_output.any():
        return float(task.weights @ targets.output_error**2)
    turned = task.angle_length * targets.angle_error
    return float(np.nansum(task.weights * targets.position_error**2) + np.nansum(task.weights * turned**2))


def _of_torque(linkage: Linkage, problem: Problem, torque: WantedTorque, verdict: Verdict) -> float:
    """Share of the deviation from a wanted torque in the square; 0 where targets are not joined."""
    misses = torque_misses(linkage, problem, verdict) / torque.greatest
    per_target = np.nan_to_num(np.mean((torque.weight * problem.task.size * misses) ** 2))
    return float(len(problem.task) * per_target)


def _exactness(targets: Targets, task: Task, wanted: Requirements) -> list[Defect]:
    allowed, deg = wanted.tolerance * task.size, float(np.degrees(1.0))
    errors = (
        ("position error", targets.position_error, allowed, task.size, 1.0),
        ("angle error in deg", targets.angle_error, allowed / task.angle_length, 1.0, deg),
        # Of the output of a function: rad, or as a share of its entire travel.
        ("output error at the pairs", targets.output_error, allowed, task.size, 1.0)
        if task.travels
        else (f"{task.link} error in deg at the pairs", targets.output_error, wanted.tolerance, 1.0, deg),
    )
    return [
        Defect(
            "exact", f"the largest {what}", worst * unit, f"up to {most * unit:.6g}", (worst - most) / size
        )
        for what, error, most, size, unit in errors
        if not (worst := float(np.nanmax(error, initial=0.0))) <= most
    ]


def _zones(targets: Targets, task: Task) -> Iterator[Defect]:
    """Targets that are missed by more than each allows."""
    if task.zones is None:
        return
    misses = (targets.position_error, targets.angle_error)
    for what, miss, zone, size in zip(
        ("position", "angle"), misses, task.zones, (task.size, 1.0), strict=True
    ):
        over = np.nan_to_num((miss - zone) / size, nan=-np.inf)
        worst = int(np.argmax(over))
        if over[worst] > SLACK:
            unit = np.degrees(1.0) if what == "angle" else 1.0
            key, deg = ("angle_within_deg", " in deg") if what == "angle" else ("within", "")
            found, allowed = unit * float(miss[worst]), f"up to {unit * zone[worst]:.6g}"
            where = f"the {what} error{deg} at target {worst + 1}"
            yield Defect(key, where, found, allowed, float(over[worst]))


def _total_error(square: float, task: Task, most_square: float) -> Iterator[Defect]:
    found, most = (float(np.sqrt(each / len(task))) for each in (square, most_square))
    miss = (found - most) / task.size
    if miss > SLACK:
        yield Defect("error_factor", "the error (root mean square)", found, f"up to {most:.6g}", miss)


def _drive(
    linkage: Linkage,
    task: Task,
    wanted: Requirements,
    verdict: Verdict,
    motion: TaskMotion,
    problem: Problem | None,
) -> list[Defect]:
    """Defects of branch and order, of the actual driver, and of its cylinder."""
    spec = None if problem is None else problem.driver
    moved = cylinder_travel(linkage, task, verdict) if spec is not None else None
    through = moved is not None and not verdict.branch_ok  # a cylinder, through dead positions of link 2
    by_link2 = [] if through else [
        *(_same_branch(verdict, int(linkage.assembly)) if wanted.same_branch else []),
        *(_order(motion) if wanted.order else []),
    ]  # fmt: skip
    if spec is None:
        return by_link2
    return [*by_link2, *cylinder_defects(spec, verdict.cylinder, moved, task.size)]


def _same_branch(verdict: Verdict, declared: int) -> Iterator[Defect]:
    used = int(verdict.assembly[0])
    if not verdict.branch_ok:
        what = "branches used (a dead position lies between)" if verdict.circuit_ok else "circuits used"
        yield Defect("same_branch", f"the number of {what}", 2, "1", 1.0)
    elif used != declared:
        allowed = f"{declared:+d}, the linkage's own"
        yield Defect("same_branch", "the assembly at the targets", used, allowed, 1.0)


def _order(motion: TaskMotion) -> Iterator[Defect]:
    if motion.in_order:
        return
    turns = abs(motion.end - motion.start) / (2 * np.pi)
    if turns > 1:
        yield Defect("order", "turns of the driver to meet the targets in sequence", turns, "up to 1", 1.0)
    else:
        step = np.diff(motion.theta2)
        reversals = int(np.count_nonzero(np.diff(np.sign(step[np.abs(step) > STEADY]))))
        yield Defect("order", "the number of reversals of the driver between targets", reversals, "0", 1.0)


def _rotatability(linkage: Linkage, task: Task, wanted: Requirements) -> Iterator[Defect]:
    margin, why = wanted.rotatability_margin, str(wanted.rotatability)
    if wanted.rotatability is Rotatability.ANY:
        if not task.closed:
            return
        margin, why = 0.0, f"a closed {task.kind} takes a full turn"
    least = float(rotatability(linkage).min())
    if least < margin - SLACK:
        allowed = f"from {margin:g} ({why})"
        yield Defect("rotatability", "the margin of full rotation", least, allowed, margin - least)
    elif len(linkage.mechanism.loops) > 1:
        yield from _stopped(linkage, why, at_change_points=margin > 0)
    kind = {Rotatability.CRANK_ROCKER: 1, Rotatability.DOUBLE_CRANK: -1}.get(wanted.rotatability, 0)
    # As far as O4 of a slider-crank: it lies at infinity.
    difference = float(getattr(linkage, "r1", np.inf) - linkage.r2)
    miss = -kind * difference / float(linkage.lengths.sum())
    if miss > SLACK:
        allowed = f"{'greater' if kind > 0 else 'less'} than 0 ({wanted.rotatability})"
        yield Defect("rotatability", "r1 - r2", difference, allowed, miss)


def _stopped(linkage: Linkage, why: str, *, at_change_points: bool) -> Iterator[Defect]:
    """The defect of a second loop that stops a driver which the first loop lets turn.

    The margin keeps change points out of the first loop alone; here they count if `at_change_points`.
    """
    found = cut(linkage)
    if not closes_everywhere(linkage):
        reach = float(np.ptp(found.ranges, axis=-1).max(initial=0.0))
        what = "the driver rotation in deg over which both loops close"
        yield Defect("rotatability", what, float(np.degrees(reach)), f"360 ({why})", 1 - reach / TURN)
    elif at_change_points and len(found.touched):
        what = "the number of change points of the second loop"
        yield Defect("rotatability", what, len(found.touched), f"0 ({why})", 1.0)


def _covered(targets: Targets) -> list[Defect]:
    open_at = sum(int(np.isinf(error).sum()) for error in (targets.position_error, targets.output_error))
    what = "the number of targets at which the linkage cannot be assembled"
    return [Defect("rotatability", what, open_at, "0", 1.0)] if open_at else []


def _loads(linkage: Linkage, problem: Problem, verdict: Verdict) -> Iterator[Defect]:
    """Loads over the travel of a slide that do not cover all of it."""
    loads = () if problem.dynamics is None else problem.dynamics.loads
    over = {index: load.values for index, load in enumerate(loads) if load.over == "travel" and load.values}
    if not over or not linkage.mechanism.slides:
        return
    linkage = as_used(linkage, verdict)
    theta2 = sampled(linkage, *motion_ends(problem.task, verdict))
    if not joins(linkage, verdict, theta2):
        return

    def travels(angles: FloatArray) -> FloatArray:
        travel = solve_position(linkage, angles).travel
        return np.stack([travel, -travel])

    high, low = peaks(travels, [theta2])[0] * [1.0, -1.0]
    for index, rows in over.items():
        least, most = rows[0][0], rows[-1][0]
        slack = TRAVEL_ROUNDING * max(abs(least), abs(most))
        for found, miss in ((low, least - low), (high, high - most)):
            if miss > slack:
                what = f"the travel of the slide under loads[{index}]"
                yield Defect(
                    "loads", what, float(found), f"{least:g} to {most:g}", float(miss / problem.task.size)
                )


def _own(design: Design, constraints: Sequence[Constraint]) -> Iterator[Defect]:
    for constraint in constraints:
        if not (value := greatest(constraint, design)) <= SLACK:
            yield Defect("constraints", name_of(constraint), value, "up to 0", value)


def _kept_out(
    linkage: Linkage, targets: Targets, motion: TaskMotion, task: Task, wanted: Requirements, *, joined: bool
) -> list[Defect]:
    # Here, not above: shapely takes a while to import, and few problems have areas.
    from grashof.analysis.judge.keep_out import intrusions

    return [
        Defect("keep_out", f"the depth of {part} inside", deep, "0", deep / task.size)
        for part, deep in intrusions(linkage, task, wanted, targets, motion, joined=joined).items()
    ]
