"""Kinds of linkage in the search by limit positions: families, and places of their members."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from grashof.problems import Box, Requirements, Rotatability, Task
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray
from grashof.problems.values.tasks.stroke_task import EVEN
from grashof.synth.loop.dyad import ClosingDyad
from grashof.synth.programme.start import Start
from grashof.synth.theory.limit_positions import Family, StrokeLinkages, lag_of

POSITIONS = 73  # of a turn, for the size
# Fields that every kind keeps by itself.
KEPT = frozenset({
    "transmission_min_deg", "link_length", "r2", "r3", "link_ratio_max", "o2", "theta2_start_deg",
    "driver_sense", "time_ratio", "coupler_arms",
})  # fmt: skip


@dataclass(frozen=True, slots=True)
class StrokeKind(ABC):
    """Linkages of the families of a task, inside limits and in the plane.

    A member is put there by two points: O2, and the end of the length that counts as 1 in its family, along
    the ground line or the slide.
    """

    task: Task
    wanted: Requirements  # resolved, in the problem's unit

    what: ClassVar[str]  # the linkages, in words
    advised: ClassVar[str] = ""  # a word for the stroke, where the time ratio limits its transmission
    dyad: ClassVar[type[ClosingDyad]]
    line: ClassVar[str] = "ground_angle_deg"  # the field that turns the ground line, or the slide
    kept: ClassVar[frozenset[str]] = KEPT  # fields that families and places keep
    mirrored: ClassVar[tuple[bool, ...]] = (False, True)  # how members of a family are drawn at random

    @property
    def clockwise(self) -> bool:
        """Whether the driver has to turn clockwise."""
        return self.wanted.driver_sense == "cw"

    @abstractmethod
    def families(self, *, elsewhere: bool) -> list[tuple[Family, bool]]:
        """The families, and whether they are mirror images; both where limits distinguish them.

        `elsewhere`: places decide that the families do not know of.
        """

    @abstractmethod
    def inside(self, members: StrokeLinkages) -> FloatArray:
        """Margins of members to the limits of lengths, places and transmission, (n,)."""

    def least(
        self,
        members: StrokeLinkages,
        ratio: FloatArray,
        turns: FloatArray,
        angle: FloatArray,
        others: list[FloatArray],
    ) -> FloatArray:
        """The least margin of members, (n,): to the limits of all kinds, and of `others`.

        The former are the ratio of lengths, the margin of rotatability, and where both the start of the
        driver and the line of the ground or slide are given its `angle`, rad.
        """
        wanted = self.wanted
        spare = [
            members.transmission - np.radians(wanted.transmission_min_deg),
            np.log(min(max(wanted.link_ratio_max, 1.0), 1e9)) - np.log(ratio),
            turns - (0.0 if wanted.rotatability is Rotatability.ANY else wanted.rotatability_margin),
            *others,
        ]
        if getattr(wanted, self.line) is not None and wanted.theta2_start_deg is not None:
            apart = np.exp(1j * (angle - (wanted.angle_of(self.line) or 0.0)))
            spare.append(-np.abs(np.angle(apart)))
        margin: FloatArray = np.min(spare, axis=0)
        return margin

    @abstractmethod
    def factor(self, members: StrokeLinkages, preferred: float | FloatArray = 1.0) -> FloatArray:
        """By which members are scaled, (n,), length: as preferred where it is allowed, or else nearly so."""

    @abstractmethod
    def diagonals(self, members: StrokeLinkages) -> FloatArray:
        """Diagonals of the boxes around the pivots and all that A and B reach, unscaled; (n,)."""

    @abstractmethod
    def put(self, members: StrokeLinkages, factor: FloatArray) -> ComplexArray:
        """Both points of members as the limits put them into the plane, (n, 2), length."""

    @abstractmethod
    def put_anywhere(self, members: StrokeLinkages, room: Box, rng: np.random.Generator) -> ComplexArray:
        """The same at random, of random size where that is free; O2 in a room where it is not bounded."""

    @abstractmethod
    def moving(
        self, members: StrokeLinkages, points: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray, FloatArray]:
        """O4 (n,) as `Start` has it, and A, B and theta2 in the limit positions, each (n, 2).

        The points (n, 2) may be in any unit.
        """

    @abstractmethod
    def in_boxes(self, a: FloatArray, b: FloatArray) -> bool:
        """Whether A and B, (2, 2) in the limit positions, are where they may be."""

    @abstractmethod
    def worst(self, start: Start) -> float:
        """Worst transmission angle over the turn, rad, by the sizes of a start."""

    def ends(self, members: StrokeLinkages) -> tuple[FloatArray, FloatArray]:
        """Driver angles at the beginning and at the end of the slow stroke, each (n,), rad.

        Of strokes that take equally long, the one from the stretched position counts as the slow one.
        """
        first, last = members.first, members.last
        if self.clockwise and lag_of(self.task.time_ratio) <= EVEN:
            return first, last - TURN
        return (last, first) if self.clockwise else (first, last)


def across(places: ComplexArray) -> FloatArray:
    """Diagonals of the boxes around places (n, N), shape (n,)."""
    diagonal: FloatArray = np.hypot(np.ptp(places.real, axis=1), np.ptp(places.imag, axis=1))
    return diagonal
