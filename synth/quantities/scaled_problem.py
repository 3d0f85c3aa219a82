"""A problem in the frame of the search, and the way back from there to linkages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from grashof.analysis.judge.design import Constraint, OwnObjective
from grashof.problems import (
    Linkage,
    Objective,
    Problem,
    Requirements,
    Rotatability,
    Task,
    TransmissionOver,
)
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.linkages.mechanisms import has_one_loop
from grashof.problems.values.requirements.quantities import Quantity
from grashof.synth.loop.dyad import direction_of
from grashof.synth.quantities.driver_motion import drive_of
from grashof.synth.quantities.formulas import of_six_bars
from grashof.synth.quantities.frame import Frame
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.kinds import kind_of
from grashof.synth.quantities.loading import Loading
from grashof.synth.quantities.target_constraints import AtTarget, target_constraints
from grashof.synth.quantities.wanted_torque import WantedCurve
from grashof.synth.theory.burmester import Displacements


@dataclass(frozen=True, eq=False)
class ScaledProblem:
    """A problem in the frame of the search: N targets, lengths in sizes, angles in rad."""

    problem: Problem
    frame: Frame
    targets: ComplexArray  # (N,); places of P; zero where its position is free
    weights: FloatArray  # (N,), of the squared distances; zero where the position is free
    turns: FloatArray  # (N,); angles of the body; zero where they are free
    turn_weights: FloatArray  # (N,), sizes^2; of the squared turns from there; zero where the angle is free
    # of the body from the first pose to every pose, where whole poses are met exactly, untimed; else None
    motion: Displacements | None
    timing: FloatArray  # (N,); driver rotation from the first target, in either sense; zero where free
    wanted: Requirements  # resolved, in the frame
    exact: bool  # every target is met; otherwise least squares
    kind: Kind  # the first that the problem requests
    constraints: tuple[Constraint, ...] = ()  # the user's own
    zones: FloatArray | None = None  # (2, N); permitted misses of the position and the angle of each target
    own_objective: OwnObjective | None = None  # the user's own in place of the problem's
    of_use: float = 0.0  # least squares: designs up to this error are useful, even far from the best

    @classmethod
    def of(
        cls,
        problem: Problem,
        constraints: Sequence[Constraint] = (),
        own_objective: OwnObjective | None = None,
    ) -> ScaledProblem:
        """A problem in its frame."""
        task, frame = problem.task, Frame.of(problem.task)
        zones = problem.zones
        exact = problem.requirements.is_exact(task) and zones is None
        targets = np.where(task.has_position, frame.inward(task.positions), 0.0)
        turns = np.nan_to_num(task.angles)
        kind = kind_of(problem)
        by_dyads = (
            kind.dyad.bars > 1
            and has_one_loop(problem.mechanism[0])
            and exact
            and task.is_whole
            and not task.is_timed
            and not (task.closed and task.returns)
        )
        return cls(
            problem=problem,
            frame=frame,
            targets=targets,
            weights=task.meeting_weights * task.has_position,
            turns=turns,
            turn_weights=task.meeting_weights * task.has_angle * (task.meeting_lengths / frame.scale) ** 2,
            motion=Displacements.from_poses(targets, turns) if by_dyads else None,
            timing=np.nan_to_num(task.driver_turns),
            wanted=_turning(frame.requirements(problem.requirements), task),
            exact=exact,
            constraints=tuple(constraints),
            zones=None if zones is None else zones / [[frame.scale], [1.0]],
            own_objective=own_objective,
            kind=kind,
        )

    def __getstate__(self) -> dict[str, Any]:
        """Without cached values, so that a problem is the same in bytes at any time."""
        return {each.name: getattr(self, each.name) for each in fields(self)}

    def of_problem(self, problem: Problem) -> ScaledProblem:
        """Another problem with the same functions of the user."""
        return ScaledProblem.of(problem, self.constraints, self.own_objective)

    @property
    def objective(self) -> Objective | None:
        """The objective besides the error; None for the user's own."""
        return self.problem.objective if self.own_objective is None else None

    @cached_property
    def at_targets(self) -> tuple[AtTarget, ...]:
        """Limits at single targets as constraints."""
        return target_constraints(self.problem)

    @property
    def every_constraint(self) -> tuple[Constraint, ...]:
        """The user's own constraints, and limits at single targets."""
        return (*self.constraints, *self.at_targets)

    @cached_property
    def loading(self) -> Loading | None:
        """Masses and loads; None without dynamics."""
        return Loading.of(self.problem)

    @cached_property
    def drive(self) -> tuple[MotorSpec | None, float]:
        """The motor and the driver's mean velocity, as of `drive_of`."""
        return drive_of(self.problem)

    @cached_property
    def wanted_torque(self) -> WantedCurve | None:
        """The wanted torque; None without one."""
        return WantedCurve.of(self.problem)

    @property
    def bounded(self) -> bool:
        """Whether the objective decides among designs that may miss the targets."""
        return self.zones is not None or self.problem.requirements.error_factor is not None

    @property
    def has_angles(self) -> bool:
        """Whether any target has an angle."""
        return bool(self.turn_weights.any())

    @property
    def has_targets(self) -> bool:
        """Whether a programme has targets in the plane, a position or an angle, and covers the mechanism."""
        return self.problem.task.in_plane and self.one_loop

    @property
    def solvable(self) -> bool:
        """Whether a programme covers the targets: in the plane, or limit positions of one stroke."""
        return self.has_targets or self.problem.task.at_limits

    @property
    def one_loop(self) -> bool:
        """Whether the linkages have a single loop."""
        return has_one_loop(self.problem.mechanism[0])

    @property
    def by_descent(self) -> bool:
        """Whether a programme minimises the error of targets in the plane."""
        return self.has_targets and not self.exact

    @property
    def has_programme(self) -> bool:
        """Whether a programme covers the targets, functions of the user, and goals where these count.

        Of six-bars it has no functions, and goals with a formula alone.
        """
        if self.one_loop or not self.problem.task.in_plane:
            return self.has_targets
        own = self.every_constraint or self.own_objective is not None
        known = {"transmission", "size", *of_six_bars(())}
        by_goals = self.exact or self.bounded
        return not own and (not by_goals or set(self.problem.objective.goals) <= known)

    @property
    def timed(self) -> bool:
        """Whether the driver rotations are prescribed."""
        return bool(self.timing.any())

    @property
    def closed(self) -> bool:
        """Whether the task motion is a full turn."""
        return self.problem.task.closed

    def scale(self, quantity: Quantity) -> float:
        """The unit of a quantity in the objective, in the units of the frame."""
        return self.problem.scale(quantity) / self.frame.scale**quantity.unit.lengths

    def missed(self, p: ComplexArray, turned: FloatArray) -> FloatArray:
        """Root mean weighted square, sizes, of the misses of P, sizes, and the body, rad, (..., N)."""
        off = np.angle(np.exp(1j * (turned - self.turns)))
        square = (self.weights * np.abs(p - self.targets) ** 2).sum(axis=-1)
        square = square + (self.turn_weights * off**2).sum(axis=-1)
        missed: FloatArray = np.sqrt(square / len(self.targets))
        return missed

    def linkages(
        self, points: ComplexArray, assembly: FloatArray, body_angle: FloatArray | None = None
    ) -> Linkage:
        """Linkages with given pivots, (...), in the problem's unit; ProblemError where two pivots coincide.

        O2, O4, and A, B, P at the first target are (..., 5) in sizes, see `Kind.placed`; the angle from the
        coupler to the body (...) in rad is by default that of the first pose.
        """
        with np.errstate(invalid="ignore", divide="ignore"):  # a value refuses a link of no length
            coupler, given = direction_of(points[..., 3] - points[..., 2]), self.kind.arguments(points)
        arm = (points[..., 4] - points[..., 2]) * coupler.conj() * self.frame.scale
        if body_angle is None:
            body_angle = np.angle(np.exp(1j * self.turns[0]) * coupler.conj())
        rows = {row.name: row for row in self.kind.linkage.mechanism.parameters}
        for name, value in given.items():
            if rows[name].kind == "place":
                given[name] = self.frame.outward(value)
            elif rows[name].in_length:
                given[name] = value * self.frame.scale
        made: Callable[..., Linkage] = self.kind.linkage
        return made(
            **given,
            coupler_point=np.stack([arm.real, arm.imag], axis=-1),
            assembly=assembly,
            body_angle=body_angle,
        )


def _turning(wanted: Requirements, task: Task) -> Requirements:
    """The requirements of a closed task, which takes a full turn of the driver for any rotatability.

    Targets lie all round it, but for limit positions.
    """
    if task.at_limits:
        wanted = replace(wanted, transmission_over=TransmissionOver.CYCLE)
    if wanted.rotatability is not Rotatability.ANY or not task.closed:
        return wanted
    return replace(wanted, rotatability=Rotatability.FULL_CRANK, rotatability_margin=0.0)
