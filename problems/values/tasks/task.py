"""Tasks: the table of targets that a linkage has to meet, however they are stated."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar, Self, TypeVar

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.problems.values.errors import listing
from grashof.problems.values.extent import span
from grashof.problems.values.linkages.mechanism import MECHANISMS, WORDS, Mechanism
from grashof.problems.values.tasks.generated_output import GeneratedOutput
from grashof.problems.values.value_bases import ReadOnly

_SAME = 1e-12  # sizes, rad
_FOUR_BAR_CURVES = ((2, 1), (4, 1))  # hosts of six-bars whose link 5 leads P as a four-bar does
USUAL_MARGIN = 1e-3  # of full rotation
USUAL_RATIO = 1.02  # of the length of a six-bar's curve to that of the spline through the points
_Row = TypeVar("_Row")


class Task(GeneratedOutput, ReadOnly, ABC):
    """N targets that a linkage has to meet in order; base of `MotionTask`, `PathTask` and others.

    Each target is a row. Its columns are the position of the coupler point, the angle of the body, the
    output, the driver rotation from the first target, and the weight; NaN where a target leaves that part
    free.
    """

    __slots__ = ()

    kind: ClassVar[str]  # its table in problem files
    target: ClassVar[str]  # word for a target in messages
    usual_rotatability: ClassVar[str] = "full-crank"  # where requirements do not state one
    usual_mechanism: ClassVar[tuple[str, ...]] = ("four-bar",)  # where a problem does not state one
    kinds: ClassVar[tuple[str, ...]] = WORDS  # of linkages that are searched for it
    without: ClassVar[tuple[str, ...]] = ()  # quantities and parts that do not apply to it
    no_cylinder: ClassVar[str] = ""  # why a cylinder cannot be its driver; empty if it can
    in_degrees: ClassVar[tuple[str, ...]] = ("angle_within", "timing")  # fields that files have in degrees

    timing: FloatArray | None
    closed: bool
    within: FloatArray | None
    # What a task need not state, with the value that it then has.
    #: Outline carried, in the body's frame, shape (M, 2), length.
    body: FloatArray | None = None
    #: How far each angle may be missed, shape (N,), rad.
    angle_within: FloatArray | None = None
    #: Swing of link 4 between its limit positions, rad.
    swing: float | None = None
    #: Stroke of a slide between its limit positions, length.
    stroke: float | None = None
    #: Driver rotation over which the output stands still, rad.
    dwell: float | None = None
    #: Greatest length of the curve over that of the closed spline through the points, where it is stated.
    length_ratio_max: float | None = None
    #: Swings of links 4 and 6, rad, of a linkage with two outputs.
    swings: tuple[float, float] | None = None
    #: Their time ratios; None where free.
    time_ratios: tuple[float | None, float | None] = (None, None)
    #: Time of the slow stroke over that of the quick one; NaN where free.
    time_ratio: float = np.nan

    @property
    @abstractmethod
    def positions(self) -> FloatArray:
        """Where the coupler point P has to be, shape (N, 2), length."""

    @property
    def angles(self) -> FloatArray:
        """Angles of the body, shape (N,), rad."""
        return np.full(len(self), np.nan)

    @property
    def driver_turns(self) -> FloatArray:
        """Driver rotation from the first target, in either sense, shape (N,), rad."""
        return np.full(len(self), np.nan) if self.timing is None else np.abs(self.timing)

    @property
    def weights(self) -> FloatArray:
        """Of the squared errors, shape (N,)."""
        return np.ones(len(self))

    @property
    def angle_length(self) -> float:
        """Length that one radian of orientation error counts as."""
        return span(self.positions)

    @property
    def size(self) -> float:
        """Greatest distance between two target positions; `angle_length` for a pure rotation."""
        return span(self.positions[self.has_position]) or self.angle_length

    @property
    def error_unit(self) -> float:
        """The unit of errors of designs."""
        return self.size

    @property
    def scale_free(self) -> bool:
        """Whether linkages of any size perform the task, so that its size does not limit theirs."""
        return False

    @property
    def states_length(self) -> bool:
        """Whether a target has a length; otherwise copies of a linkage in any scale perform the task."""
        return bool(self.has_position.any())

    @property
    def middle(self) -> FloatArray:
        """Mean of the target positions, shape (2,), length; the origin where all are free."""
        return np.nanmean(self.positions, axis=0) if self.has_position.any() else np.zeros(2)

    @property
    def has_position(self) -> BoolArray:
        """Which targets have a position, shape (N,)."""
        given: BoolArray = ~np.isnan(self.positions[:, 0])
        return given

    @property
    def has_angle(self) -> BoolArray:
        """Which targets have an angle, shape (N,)."""
        return ~np.isnan(self.angles)

    @property
    def has_output(self) -> BoolArray:
        """Which targets have an output, shape (N,)."""
        return ~np.isnan(self.outputs)

    @property
    def in_plane(self) -> bool:
        """Whether a target has a place or an angle in the plane."""
        return bool((self.has_position | self.has_angle).any())

    def with_ground(self, length: float) -> Self:  # noqa: ARG002
        """The task with a usual length of the ground, where it has no size of its own."""
        return self

    def sized(self, reference: float) -> Self:  # noqa: ARG002
        """The same with a length that counts as the size, where the scale is free."""
        return self

    @property
    def is_curve(self) -> bool:
        """Whether its targets are points of a closed curve."""
        return self.closed and self.only_points and not self.is_timed

    def most_length_ratio(self, kind: Mechanism) -> float:
        """The greatest length of the curve of P over that of the closed spline; infinite without a limit."""
        usual = USUAL_RATIO if len(kind.loops) > 1 and self.is_curve else np.inf
        return usual if self.length_ratio_max is None else self.length_ratio_max

    @property
    def once_round(self) -> FloatArray:
        """The positions, without a last one that is the first again, shape (M, 2)."""
        return self.positions[:-1] if self.returns else self.positions

    @property
    def is_timed(self) -> bool:
        """Whether the driver rotations are prescribed."""
        return self.timing is not None

    @property
    def is_whole(self) -> bool:
        """Whether every target has both position and angle."""
        return bool((self.has_position & self.has_angle).all())

    @property
    def only_points(self) -> bool:
        """Whether every target is a position alone."""
        return bool((self.has_position & ~self.has_angle).all())

    @property
    def usual_margin(self) -> float:
        """Margin of full rotation where requirements do not state one."""
        return USUAL_MARGIN

    @property
    def limits_size(self) -> bool:
        """Whether its size limits that of linkages; a function has none to compare with."""
        return not self.has_output.any()

    @property
    def returns(self) -> bool:
        """Whether the last target is the first again."""
        first, last = np.column_stack([self.positions / self.size, np.exp(1j * self.angles)])[[0, -1]]
        return np.allclose(first, last, rtol=0, atol=_SAME, equal_nan=True)

    @property
    def stated_zones(self) -> dict[str, FloatArray]:
        """How far targets may be missed, by the name of the argument that states it, each of shape (N,)."""
        both = {"within": self.within, "angle_within": self.angle_within}
        return {name: zone for name, zone in both.items() if zone is not None}

    @property
    def zones(self) -> FloatArray | None:
        """How far positions (length) and angles (rad) may be missed, shape (2, N); infinite where free."""
        place, turn = self.within, self.angle_within
        if turn is not None and place is None:
            place = turn * self.angle_length
        if place is None:
            return None
        if turn is None:
            turn = np.minimum(place / self.angle_length, np.pi)
        return np.where([self.has_position, self.has_angle], [place, turn], np.inf)

    @property
    def meeting_lengths(self) -> FloatArray:
        """Length that one radian counts as where a linkage is placed at the targets, shape (N,).

        The ratio of the zones of a target, where it has both.
        """
        usual = np.full(len(self), self.angle_length)
        if self.zones is None:
            return usual
        place, turn = self.zones
        return np.where(np.isfinite(place) & np.isfinite(turn), place / turn, usual)

    @property
    def meeting_weights(self) -> FloatArray:
        """Of squared misses where a linkage is placed at the targets, shape (N,).

        The farther a target may be missed, the less it counts beside the others.
        """
        if self.zones is None:
            return self.weights
        zones = np.fmin(self.zones[0], self.zones[1] * self.angle_length)
        weights: FloatArray = self.weights * (zones.min() / zones) ** 2
        return weights

    def with_zones(self, **zones: FloatArray | None) -> Self:
        """The same targets with other zones, by the names of `stated_zones`."""
        return replace(self, **zones)  # type: ignore[type-var]

    def without_zones(self) -> Self:
        """The same targets, none of them to be missed."""
        return self.with_zones(**dict.fromkeys(self.stated_zones))

    @abstractmethod
    def some(self, index: IntArray, positions: FloatArray, angles: FloatArray) -> Self:
        """Some of the targets in order, `index` (K,), moved to other positions (K, 2) and angles (K,).

        Free values of a target stay free.
        """

    @property
    def exact_by_default(self) -> bool:
        """Whether four-bars that meet every target can be expected; see `exact_for`."""
        return self.exact_for(9)

    def exact_for(self, freedoms: int) -> bool:
        """Whether linkages with this many free dimensions can be expected to meet every target.

        As long as the equations, two for a position and one for an angle, are not more than the
        unknowns: nine of a four-bar, eight of slider kinds, how the body sits on its coupler, and a
        driver angle for every target, or one where they are timed. So for four-bars up to nine points,
        five timed ones, five complete poses (Burmester), three timed ones.
        """
        equations = 2 * np.count_nonzero(self.has_position) + np.count_nonzero(self.has_angle)
        unknowns = freedoms + self.has_angle.any() + (1 if self.is_timed else len(self))
        return bool(equations <= unknowns)

    def __len__(self) -> int:
        return len(self.positions)

    @property
    def at_limits(self) -> bool:
        """Whether the targets are the limit positions of the output."""
        return not np.isnan(self.time_ratio)

    @property
    def usual_objective(self) -> dict[str, float]:
        """Weights of the goals where a problem does not state an objective, as `Objective` takes them."""
        return {}

    def rows(self, word: str) -> tuple[Mechanism, ...]:
        """The mechanisms of a word among which linkages for it are searched.

        Of six-bars for points and poses those with P on any link that does not turn about the ground, without
        the ones whose P traces the coupler curve of a four-bar, unless the driver is timed.
        """
        every = tuple(row for row in MECHANISMS if row.word == word)
        if not every or len(every[0].loops) == 1:
            return every
        pinned = tuple(row for row in every if not row.loops[-1].dyad.slides)
        if not self.in_plane:
            return pinned
        return tuple(
            replace(row, carries=link)
            for row in pinned
            if self.is_timed or row.loops[-1].dyad.hosts not in _FOUR_BAR_CURVES
            for host, link in zip(row.loops[-1].dyad.hosts, row.loops[-1].links, strict=True)
            if host != 1
        )

    def needless(self, word: str) -> str:
        """Why no linkage of a kind is searched for it, in one line; empty where some are."""
        if self.rows(word):
            return ""
        return (
            f"mechanism is {word}; without timing its P traces the coupler curve of a four-bar: "
            "it must be four-bar, or another six-bar"
        )

    def impossible(self, word: str) -> str:
        """Why a kind of linkage cannot perform it, in one line; empty if it may."""
        if word in self.kinds:
            return ""
        return f"mechanism is {word}; of {self.described} it must be {listing(list(self.kinds))}"

    @property
    def described(self) -> str:
        """The kind of task as files state it, in a message."""
        return f'kind = "{self.kind}"'


def row_of(table: Mapping[type, _Row], task: Task) -> _Row:
    """The row of a table for the type of a task, or for its nearest base class."""
    return next(table[kind] for kind in type(task).__mro__ if kind in table)
