"""The judge: does this linkage do the task under the requirements? From the linkage alone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis.judge.at_targets import missed_at_targets
from grashof.analysis.judge.cylinder_drive import cylinder_defects, cylinder_travel
from grashof.analysis.judge.design import Constraint, Design, greatest, name_of
from grashof.analysis.judge.how_met import HOW_MET, Met
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.meeting.inputs import Driven
from grashof.analysis.judge.meeting.task_motion import STEADY, Targets, TaskMotion
from grashof.analysis.judge.missed_limits import SLACK, missed, stated_limits
from grashof.analysis.judge.over_task import uncovered_loads
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.analysis.judge.wanted_torque import torque_misses
from grashof.analysis.mechanism.extremes import diagonal, reach_box
from grashof.analysis.mechanism.mobility import (
    circuits_and_branches,
    closes_everywhere,
    full_rotation,
    grashof_class,
    passes_change_point,
    rotatability,
)
from grashof.analysis.mechanism.second_loop import cut
from grashof.analysis.mechanism.transmission import worst_transmission, worst_transmission_cycle
from grashof.problems import Cylinder, Linkage, Problem, Requirements, Rotatability, Task, WantedTorque
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray
from grashof.problems.values.linkages.linkage import by_kind
from grashof.problems.values.requirements.function_ground import grounded
from grashof.problems.values.tasks.task import row_of

_AT_ONCE = 64  # linkages whose arrays fit well into a cache


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
    judge = Judge(task, requirements, constraints, problem)
    return judge.verdicts([Subject(linkage, most_square, cylinder)])[0]


@dataclass(frozen=True, slots=True)
class Subject:
    """A linkage to be judged, with `most_square` and `cylinder` as of `verify`."""

    linkage: Linkage
    most_square: float = np.inf
    cylinder: Cylinder | None = None


class Judge:
    """The judge of linkages by the requirements of a task, with arguments as of `verify`."""

    def __init__(
        self,
        task: Task,
        requirements: Requirements,
        constraints: Sequence[Constraint] = (),
        problem: Problem | None = None,
    ) -> None:
        self.task = grounded(task, requirements)
        wanted = requirements.for_task(self.task)
        self.wanted = wanted.resolved(self.task.size, scale_free=self.task.scale_free)
        self.constraints, self.problem = constraints, problem

    def verdicts(self, designs: Sequence[Subject]) -> list[Verdict]:
        """The verdicts on linkages, in their order; each to the last bit as on it alone."""
        found: dict[int, Verdict] = {}
        for alike in by_kind([each.linkage for each in designs]):
            for begin in range(0, len(alike), _AT_ONCE):
                rows = alike[begin : begin + _AT_ONCE]
                found |= zip(rows, self._of_kind([designs[row] for row in rows]), strict=True)
        return [found[row] for row in range(len(designs))]

    def _of_kind(self, designs: Sequence[Subject]) -> Iterator[Verdict]:
        """Verdicts on linkages of one kind."""
        members = [each.linkage for each in designs]
        batch = type(members[0]).stacked(members)
        how = row_of(HOW_MET, self.task)
        met = how(members, batch, self.task, self.wanted, [self._driven(each) for each in designs])
        moved = Moved.of(batch, met)
        problem = self.problem or Problem(task=self.task, mechanism=batch.mechanism.word)
        stated = stated_limits(problem, self.wanted, batch.mechanism.word)
        for row, (design, one) in enumerate(zip(designs, met, strict=True)):
            linkage, verdict = design.linkage, self._figures(design, one, moved, row)
            defects = (
                *self._of_targets(one, verdict, design.most_square),
                *self._of_drive(linkage, one, verdict, moved.shares[row]),
                *missed(Values(linkage, verdict, problem), stated, self.wanted.same_branch),
                *self._beyond(linkage, one, verdict),
            )
            yield replace(verdict, defects=defects)

    def _driven(self, design: Subject) -> Driven:
        """The cylinder of a design, with its limits."""
        spec = None if self.problem is None else self.problem.driver
        return Driven(design.cylinder, spec, np.radians(self.wanted.cylinder_angle_min_deg or 0.0))

    def _figures(self, design: Subject, met: Met, moved: Moved, row: int) -> Verdict:
        """The verdict on a linkage, without its defects."""
        targets, motion, problem = met.targets, met.motion, self.problem
        verdict = Verdict(
            theta2=motion.theta2,
            assembly=targets.assembly,
            position_error=targets.position_error,
            angle_error=targets.angle_error,
            square=_square(targets, self.task),
            direction=motion.direction,
            grashof_class=grashof_class(design.linkage),
            full_rotation=bool(moved.turns[row]),
            circuit_ok=bool(moved.circuit_ok[row]),
            branch_ok=bool(moved.branch_ok[row]),
            order_ok=motion.in_order,
            # Without a motion that joins the targets nothing is transmitted.
            transmission_min_task=float(moved.transmission_task[row]) if moved.branch_ok[row] else 0.0,
            transmission_min_cycle=float(moved.transmission_cycle[row]),
            size=float(moved.size[row]),
            defects=(),
            cylinder=design.cylinder,
            output_error=targets.output_error,
            **met.figures,
        )
        if problem is None or problem.torque is None or not problem.torque.weight:
            return verdict
        added = _of_torque(design.linkage, problem, problem.torque, verdict)
        return replace(verdict, square=verdict.square + added)

    def _of_targets(self, met: Met, verdict: Verdict, most_square: float) -> Iterator[Defect]:
        """Defects of targets that are missed."""
        task, wanted = self.task, self.wanted
        if wanted.is_exact(task):
            yield from _exactness(met.targets, task, wanted)
        yield from met.defects
        yield from _zones(met.targets, task)
        yield from _total_error(verdict.square, task, most_square)

    def _of_drive(self, linkage: Linkage, met: Met, verdict: Verdict, shares: FloatArray) -> Iterator[Defect]:
        """Defects of the motion and of what drives it."""
        yield from _drive(linkage, self.task, self.wanted, verdict, met.motion, self.problem)
        yield from _rotatability(linkage, self.task, self.wanted, float(shares.min()))
        yield from _covered(met.targets)
        if self.problem is not None:
            yield from uncovered_loads(linkage, self.problem, verdict)

    def _beyond(self, linkage: Linkage, met: Met, verdict: Verdict) -> Iterator[Defect]:
        """Defects at single targets, of the user's own constraints, and of areas kept out."""
        if self.wanted.at:
            yield from missed_at_targets(linkage, self.task, self.wanted, verdict)
        if self.constraints:
            yield from _own(Design.judged(linkage, verdict), self.constraints)
        if self.wanted.keep_out:
            # Here, not above: shapely takes a while to import, and few problems have areas.
            from grashof.analysis.judge.keep_out import parts_inside

            motions = met.targets, met.motion
            yield from parts_inside(linkage, self.task, self.wanted, *motions, joined=verdict.branch_ok)


@dataclass(frozen=True, slots=True)
class Moved:
    """Figures of the motions of a batch of linkages, each of shape (B,); `shares` as of `rotatability`."""

    circuit_ok: BoolArray
    branch_ok: BoolArray
    turns: BoolArray
    transmission_task: FloatArray
    transmission_cycle: FloatArray
    size: FloatArray
    shares: FloatArray

    @classmethod
    def of(cls, batch: Linkage, met: Sequence[Met]) -> Moved:
        """The figures of a batch in the motions that meet the targets."""
        start, end = np.array([(each.motion.start, each.motion.end) for each in met]).T
        at = np.stack([each.theta2 for each in met]), np.stack([each.assembly for each in met])
        circuits, branches = circuits_and_branches(batch[:, None], *at)
        circuit_ok = (circuits == circuits[:, :1]).all(axis=1) & (circuits[:, 0] >= 0)
        circuit_ok &= [each.covered for each in met]
        branch_ok = circuit_ok & (branches == branches[:, :1]).all(axis=1)
        branch_ok &= ~passes_change_point(batch, start, end)
        return cls(
            circuit_ok,
            branch_ok,
            full_rotation(batch),
            worst_transmission(batch, start, end),
            worst_transmission_cycle(batch),
            diagonal(reach_box(batch, start, end)),
            rotatability(batch),
        )


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


def _rotatability(linkage: Linkage, task: Task, wanted: Requirements, least: float) -> Iterator[Defect]:
    """The defects of a driver that does not turn as required; `least` is the margin of full rotation."""
    margin, why = wanted.rotatability_margin, str(wanted.rotatability)
    if wanted.rotatability is Rotatability.ANY:
        if not task.closed:
            return
        margin, why = 0.0, f"a closed {task.kind} takes a full turn"
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


def _own(design: Design, constraints: Sequence[Constraint]) -> Iterator[Defect]:
    for constraint in constraints:
        if not (value := greatest(constraint, design)) <= SLACK:
            yield Defect("constraints", name_of(constraint), value, "up to 0", value)
