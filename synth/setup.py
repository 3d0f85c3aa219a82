"""A motion problem made ready for the search, and the way back from its frame to linkages."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import FourBar, Problem, Requirements
from grashof.problems.checks import ComplexArray, FloatArray
from grashof.synth.burmester import Displacements
from grashof.synth.frame import Frame


@dataclass(frozen=True, slots=True)
class Setup:
    """A motion problem in the frame of the search.

    Parameters
    ----------
    problem : Problem
    frame : Frame
    motion : Displacements
        From the first pose to every pose, in the frame.
    body : complex
        The guided point at the first pose, in the frame.
    wanted : Requirements
        Resolved, in the frame.
    """

    problem: Problem
    frame: Frame
    motion: Displacements
    body: complex
    wanted: Requirements

    @classmethod
    def of(cls, problem: Problem) -> Setup:
        """Make a problem ready."""
        task, frame = problem.task, Frame.of(problem.task)
        positions = frame.inward(task.positions)
        motion = Displacements.from_poses(positions, task.angles)
        return cls(problem, frame, motion, complex(positions[0]), frame.requirements(problem.requirements))

    def linkages(self, points: ComplexArray, assembly: FloatArray) -> FourBar:
        """The linkages with given pivots.

        Parameters
        ----------
        points : ndarray of complex, shape (..., 4), sizes
            O2, O4, and A, B at the first pose.
        assembly : ndarray, shape (...)

        Returns
        -------
        FourBar
            Batch of shape (...), in the problem's unit.
        """
        o2, o4, a, b = np.moveaxis(points, -1, 0)
        with np.errstate(invalid="ignore"):  # FourBar refuses a coupler of no length
            coupler = (b - a) / np.abs(b - a)
        arm = (self.body - a) * coupler.conj() * self.frame.scale
        return FourBar(
            o2=self.frame.outward(o2),
            o4=self.frame.outward(o4),
            r2=np.abs(a - o2) * self.frame.scale,
            r3=np.abs(b - a) * self.frame.scale,
            r4=np.abs(b - o4) * self.frame.scale,
            coupler_point=np.stack([arm.real, arm.imag], axis=-1),
            assembly=assembly,
            body_angle=np.angle(np.exp(1j * self.problem.task.angles[0]) * coupler.conj()),
        )
