"""A problem made ready for the search, and the way back from its frame to linkages."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import FourBar, MotionTask, PathTask, Problem, Requirements
from grashof.problems.checks import ComplexArray, FloatArray
from grashof.synth.burmester import Displacements
from grashof.synth.frame import Frame


@dataclass(frozen=True, slots=True)
class Setup:
    """A problem in the frame of the search.

    Parameters
    ----------
    problem : Problem
    frame : Frame
    targets : ndarray of complex, shape (N,), sizes
        Where the coupler point P has to be, in the frame.
    motion : Displacements or None
        Of the body from the first pose to every pose, in the frame; None for a path.
    timing : ndarray, shape (N,), rad, or None
        Driver rotation from the first target, where it is prescribed.
    wanted : Requirements
        Resolved, in the frame.
    exact : bool
        Every target is met; otherwise least squares.
    """

    problem: Problem
    frame: Frame
    targets: ComplexArray
    motion: Displacements | None
    timing: FloatArray | None
    wanted: Requirements
    exact: bool

    @classmethod
    def of(cls, problem: Problem) -> Setup:
        """Make a problem ready."""
        task, frame = problem.task, Frame.of(problem.task)
        targets = frame.inward(task.positions)
        return cls(
            problem=problem,
            frame=frame,
            targets=targets,
            motion=Displacements.from_poses(targets, task.angles) if isinstance(task, MotionTask) else None,
            timing=task.timing if isinstance(task, PathTask) else None,
            wanted=frame.requirements(problem.requirements),
            exact=problem.requirements.is_exact(task),
        )

    def linkages(self, points: ComplexArray, assembly: FloatArray) -> FourBar:
        """The linkages with given pivots.

        Parameters
        ----------
        points : ndarray of complex, shape (..., 5), sizes
            O2, O4, and A, B, P at the first target.
        assembly : ndarray, shape (...)

        Returns
        -------
        FourBar
            Batch of shape (...), in the problem's unit.

        Raises
        ------
        ProblemError
            Two pivots coincide.
        """
        o2, o4, a, b, p = np.moveaxis(points, -1, 0)
        with np.errstate(invalid="ignore"):  # FourBar refuses a coupler of no length
            coupler = (b - a) / np.abs(b - a)
        arm = (p - a) * coupler.conj() * self.frame.scale
        task = self.problem.task
        first = task.angles[0] if isinstance(task, MotionTask) else None
        turned = 0.0 if first is None else np.angle(np.exp(1j * first) * coupler.conj())
        return FourBar(
            o2=self.frame.outward(o2),
            o4=self.frame.outward(o4),
            r2=np.abs(a - o2) * self.frame.scale,
            r3=np.abs(b - a) * self.frame.scale,
            r4=np.abs(b - o4) * self.frame.scale,
            coupler_point=np.stack([arm.real, arm.imag], axis=-1),
            assembly=assembly,
            body_angle=turned,
        )
