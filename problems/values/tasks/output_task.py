"""The common part of tasks that state an output alone: the swing of a link, or the stroke of a slide."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar, Self

import numpy as np

from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.tasks.task import Task
from grashof.problems.values.value_bases import set_fields

# Quantities and parts that do not apply where no point is carried.
OF_POINTS = (
    "coupler_arms", "coupler_fit_r2", "point_speed_max", "point_acceleration_max", "p", "body", "worst_move",
    "share_within_linear", "share_within_made", "theta2_start",
)  # fmt: skip


class OutputTask(Task):
    """Two targets without positions, between which the output moves; without a stroke the scale is free."""

    __slots__ = ()

    no_cylinder: ClassVar[str] = "whose driver turns all round"

    returns = False  #: The last target is another position than the first.
    exact_by_default = True  #: The swing, or the stroke, is met.

    reference: float  #: Length that counts as the size where the scale is free.

    @property
    def positions(self) -> FloatArray:
        """Free at both targets, shape (2, 2)."""
        return np.full((2, 2), np.nan)

    @property
    def size(self) -> float:
        """The stroke of a slide; otherwise a length from the requirements (`sized`), or 1."""
        return self.reference if self.stroke is None else self.stroke

    @property
    def angle_length(self) -> float:
        """The size: no target has an angle."""
        return self.size

    @property
    def scale_free(self) -> bool:
        """Whether linkages of any size perform it."""
        return self.stroke is None

    @property
    def states_length(self) -> bool:
        """Whether the output is a stroke."""
        return self.stroke is not None

    def sized(self, reference: float) -> Self:
        """The same with another length that counts as the size where the scale is free."""
        made = replace(self)  # type: ignore[type-var]
        set_fields(made, reference=reference)
        return made

    def some(self, index: IntArray, positions: FloatArray, angles: FloatArray) -> Self:  # noqa: ARG002
        """The task itself: neither target exists without the other."""
        return self

    @classmethod
    def refuse_both(cls, swing: float | None, stroke: float | None) -> None:
        """Raise `ProblemError` unless one of them is given."""
        if (swing is None) == (stroke is None):
            both = "both swing_deg and" if stroke is not None else "neither swing_deg nor"
            either = "it must be one of the two: swing_deg for a rocker, stroke for a slide"
            raise ProblemError(f"{cls.kind} has {both} stroke; {either}")
