"""A problem made ready for the search, and the way back from its frame to linkages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis.judge.design import Constraint, OwnObjective
from grashof.problems import Linkage, Objective, Problem, Requirements, Rotatability, Task
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.requirements.quantities import Quantity
from grashof.synth.programme.frame import Frame
from grashof.synth.programme.kind import Kind
from grashof.synth.programme.kinds import FOUR_BAR, kind_of
from grashof.synth.theory.burmester import Displacements


@dataclass(frozen=True, slots=True)
class ScaledProblem:
    """A problem in the frame of the search.

    Parameters
    ----------
    problem : Problem
    frame : Frame
    targets : ndarray of complex, shape (N,), sizes
        Where the coupler point P has to be, in the frame; zero where its position is free.
    weights : ndarray, shape (N,)
        Of the squared distances; zero where the position is free.
    turns : ndarray, shape (N,), rad
        Angles of the body; zero where they are free.
    turn_weights : ndarray, shape (N,), sizes squared
        Of the squared turns from there; zero where the angle is free.
    motion : Displacements or None
        Of the body from the first pose to every pose, in the frame, where whole poses are met
        exactly, untimed; None for all other tasks.
    timing : ndarray, shape (N,), rad
        Driver rotation from the first target, in either sense; all zero where it is free.
    wanted : Requirements
        Resolved, in the frame.
    exact : bool
        Every target is met; otherwise least squares.
    constraints : tuple of callable
        The user's own.
    zones : ndarray, shape (2, N), sizes and rad, or None
        How far the position and the angle of each target may be missed.
    own_objective : callable, optional
        The user's own in place of the problem's.
    of_use : float, sizes
        Least squares: designs up to this error are of use, be they far from the best.
    kind : Kind
        Of linkage: the first that the problem asks for.
    """

    problem: Problem
    frame: Frame
    targets: ComplexArray
    weights: FloatArray
    turns: FloatArray
    turn_weights: FloatArray
    motion: Displacements | None
    timing: FloatArray
    wanted: Requirements
    exact: bool
    constraints: tuple[Constraint, ...] = ()
    zones: FloatArray | None = None
    own_objective: OwnObjective | None = None
    of_use: float = 0.0
    kind: Kind = FOUR_BAR

    @classmethod
    def of(
        cls,
        problem: Problem,
        constraints: Sequence[Constraint] = (),
        own_objective: OwnObjective | None = None,
    ) -> ScaledProblem:
        """Make a problem ready."""
        task, frame = problem.task, Frame.of(problem.task)
        zones = problem.zones
        exact = problem.requirements.is_exact(task) and zones is None
        targets = np.where(task.has_position, frame.inward(task.positions), 0.0)
        turns = np.nan_to_num(task.angles)
        kind = kind_of(problem)
        by_dyads = (
            kind.dyad.bars > 1
            and exact
            and task.is_whole
            and not task.is_timed
            and not (task.closed and task.returns)
        )
        return cls(
            problem=problem,
            frame=frame,
            targets=targets,
            weights=task.weights * task.has_position,
            turns=turns,
            turn_weights=task.weights * task.has_angle * (task.angle_length / frame.scale) ** 2,
            motion=Displacements.from_poses(targets, turns) if by_dyads else None,
            timing=np.nan_to_num(task.driver_turns),
            wanted=_turning(frame.requirements(problem.requirements), task),
            exact=exact,
            constraints=tuple(constraints),
            zones=None if zones is None else zones / [[frame.scale], [1.0]],
            own_objective=own_objective,
            kind=kind,
        )

    def of_problem(self, problem: Problem) -> ScaledProblem:
        """Another problem with the same functions of the user."""
        return ScaledProblem.of(problem, self.constraints, self.own_objective)

    @property
    def objective(self) -> Objective | None:
        """What decides besides the error; None for the user's own."""
        return self.problem.objective if self.own_objective is None else None

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
        """Whether there is anything in the plane for a programme to meet: a position or an angle."""
        return bool(self.weights.any() or self.turn_weights.any())

    @property
    def timed(self) -> bool:
        """Whether the driver rotations are prescribed."""
        return bool(self.timing.any())

    @property
    def closed(self) -> bool:
        """Whether the task motion is a whole turn."""
        return self.problem.task.closed

    def scale(self, quantity: Quantity) -> float:
        """What the objective counts a quantity in, in the units of the frame."""
        return self.problem.scale(quantity) / self.frame.scale**quantity.unit.lengths

    def missed(self, p: ComplexArray, turned: FloatArray) -> FloatArray:
        """Root mean weighted square of what targets are missed by, sizes.

        Parameters
        ----------
        p : ndarray of complex, shape (..., N), sizes
        turned : ndarray, shape (..., N), rad
            Angles of the body.
        """
        off = np.angle(np.exp(1j * (turned - self.turns)))
        square = (self.weights * np.abs(p - self.targets) ** 2).sum(axis=-1)
        square = square + (self.turn_weights * off**2).sum(axis=-1)
        missed: FloatArray = np.sqrt(square / len(self.targets))
        return missed

    def linkages(
        self, points: ComplexArray, assembly: FloatArray, body_angle: FloatArray | None = None
    ) -> Linkage:
        """The linkages with given pivots.

        Parameters
        ----------
        points : ndarray of complex, shape (..., 5), sizes
            O2, O4, and A, B, P at the first target; see `Kind.placed`.
        assembly : ndarray, shape (...)
        body_angle : ndarray, shape (...), rad, optional
            From the coupler to the body. By default as the first of whole poses asks for it.

        Returns
        -------
        Linkage
            Batch of shape (...), in the problem's unit.

        Raises
        ------
        ProblemError
            Two pivots coincide.
        """
        with np.errstate(invalid="ignore", divide="ignore"):  # a value refuses a link of no length
            coupler, given = self.kind.coupler(points), self.kind.arguments(points)
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
    """A closed task takes a whole turn of the driver, whatever its rotatability."""
    if wanted.rotatability is not Rotatability.ANY or not task.closed:
        return wanted
    return replace(wanted, rotatability=Rotatability.FULL_CRANK, rotatability_margin=0.0)
