"""The stroke task: how far the output goes between its limit positions, and how fast there and back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import finite_number, noted, refuse, size_number
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.linkages.mechanism import ONE_LOOP, DyadKind
from grashof.problems.values.linkages.mechanisms import INVERTED, closing_dyad
from grashof.problems.values.tasks.output_task import OutputTask
from grashof.problems.values.tasks.task import USUAL_MARGIN, Task
from grashof.problems.values.text import with_article
from grashof.problems.values.value_bases import set_fields

LEAST_SWING = 1e-3  # rad
EVEN = 1e-7  # rad: strokes whose driver rotations are so close to half a turn take equally long
# Of an offset slider-crank. Up to 3 there are some in theory, whose transmission angle is below
# a thousandth of a degree: rounding locks them.
MOST_SLIDE_RATIO = 2.999
_SAME_RATIO = 1e-6  # share by which a time ratio may differ from that of a swing


@dataclass(frozen=True, slots=True, init=False, eq=False)
class StrokeTask(OutputTask):
    """Swing of a rocker, or stroke of a slide, and its time ratio.

    Its two targets are the limit positions, where driver and coupler are in line: the slow stroke goes
    from the first to the last. Where they are is free, and without a stroke so is the scale.

    Parameters
    ----------
    swing : float, rad, optional
        Of link 4 between its limit positions, below half a turn.
    stroke : float, length, optional
        Of a slide between its limit positions; either this or the swing is given.
    time_ratio : float
        Time of the slow stroke over that of the quick one, the driver turning steadily; from 1 on.

    Raises
    ------
    ProblemError
        Both of swing and stroke, or neither; a number that no linkage can have.

    Examples
    --------
    >>> task = StrokeTask.from_degrees(swing_deg=80, time_ratio=1.25)
    >>> len(task), round(float(np.degrees(task.driver_rotation)), 9)
    (2, 200.0)
    """

    kind: ClassVar[Literal["stroke"]] = "stroke"
    target: ClassVar[Literal["limit position"]] = "limit position"
    kinds: ClassVar[tuple[str, ...]] = tuple(ONE_LOOP)
    in_degrees: ClassVar[tuple[str, ...]] = ("swing",)

    swing: float | None
    stroke: float | None
    time_ratio: float
    timing: FloatArray | None = field(init=False)
    closed: bool = field(init=False)
    within: FloatArray | None = field(init=False)
    reference: float = field(init=False)  # length that counts as the size where the scale is free

    def __init__(
        self, *, swing: float | None = None, stroke: float | None = None, time_ratio: float = 1.0
    ) -> None:
        kept: dict[str, Any] = {"timing": None, "closed": True, "within": None, "reference": 1.0}
        wrong: list[str] = []
        with noted(wrong):
            self.refuse_both(swing, stroke)
            kept["swing"] = None if swing is None else rocker_swing(swing, "stroke.")
            kept["stroke"] = None if stroke is None else size_number(stroke, "stroke.stroke")
        with noted(wrong):
            kept["time_ratio"] = slow_over_quick(time_ratio, "stroke.")
        refuse(wrong)
        set_fields(self, **kept)

    @classmethod
    def from_degrees(
        cls, *, swing_deg: float | None = None, stroke: float | None = None, time_ratio: float = 1.0
    ) -> StrokeTask:
        """Task with its swing in degrees, as problem files write it."""
        if swing_deg is not None:
            swing_deg = float(np.radians(finite_number(swing_deg, "stroke.swing_deg")))
        return cls(swing=swing_deg, stroke=stroke, time_ratio=time_ratio)

    @property
    def driver_rotation(self) -> float:
        """Of the slow stroke, rad: half a turn or more."""
        return float(2 * np.pi * self.time_ratio / (self.time_ratio + 1))

    @property
    def limits_size(self) -> bool:
        """False for a slide, whose rod is better the longer it is, within limits."""
        return self.stroke is None

    @property
    def usual_margin(self) -> float:
        """None for a slide: it is tan²(mu / 2), so that near the greatest time ratios there is hardly any."""
        return USUAL_MARGIN if self.stroke is None else 0.0

    def impossible(self, word: str) -> str:
        """Why a kind of linkage cannot perform it, in one line; empty if it may.

        Examples
        --------
        >>> StrokeTask(stroke=100.0).impossible("four-bar")
        'stroke.stroke is of a slide; a four-bar has a swing, stroke.swing_deg'
        """
        if line := Task.impossible(self, word):
            return line
        given, dyad = f"stroke.time_ratio is {self.time_ratio:.6g}; it must be", closing_dyad(word)
        if dyad is DyadKind.RRP:
            if self.stroke is None:
                return "stroke.swing_deg is of a rocker; a slider-crank has a slide, stroke.stroke"
            most, whose = MOST_SLIDE_RATIO, "a slider-crank, whose crank would not turn fully"
        else:
            if self.swing is None:
                return f"stroke.stroke is of a slide; {with_article(word)} has a swing, stroke.swing_deg"
            swings = f"swings by {np.degrees(self.swing):.6g} deg"
            if dyad is DyadKind.RPR:
                # In both limit positions the crank is perpendicular to the rod.
                ratio = (np.pi + self.swing) / (np.pi - self.swing)
                wanted = f"{ratio:.8g} for an {INVERTED} that {swings}, (180 + swing) / (180 - swing)"
                same = abs(self.time_ratio - ratio) <= _SAME_RATIO * ratio
                return "" if same else f"{given} {wanted}"
            # Beyond, limit positions on one assembly need a driver that does not turn fully.
            most, whose = most_ratio(self.swing), f"a crank-rocker that {swings}"
        return "" if self.time_ratio < most else f"{given} less than {most:.6g} for {whose}"


def most_ratio(swing: float) -> float:
    """The time ratio below which those of crank-rockers with a swing, rad, lie."""
    return float((3 * np.pi + swing) / (np.pi - swing))


def rocker_swing(swing: float, where: str = "") -> float:
    """A swing, rad, checked: a rocker swings by less than half a turn."""
    number = finite_number(swing, f"{where}swing_deg")
    if not LEAST_SWING <= number < np.pi:
        least = np.degrees(LEAST_SWING)
        raise ProblemError(
            f"{where}swing_deg is {np.degrees(number):.6g}; "
            f"it must be from {least:.3g} to less than 180, as a rocker swings"
        )
    return number


def slow_over_quick(ratio: float, where: str = "") -> float:
    """A time ratio, checked."""
    number = finite_number(ratio, f"{where}time_ratio")
    if number < 1:
        raise ProblemError(
            f"{where}time_ratio is {number:.6g}; it must be at least 1, the slow stroke over the quick one"
        )
    return number
