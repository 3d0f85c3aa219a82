"""What every kind of linkage says of its loop: the parts that a kind's file gives."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from enum import StrEnum
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.linkages.linkage import Linkage

CHANGE = 1e-12  # share of the lengths within which a linkage has a change point
EPS = float(np.finfo(np.float64).eps)
ROUNDING = 8 * EPS  # share of lengths

L_contra = TypeVar("L_contra", bound=Linkage, contravariant=True)


class GrashofClass(StrEnum):
    """Kinds of linkages by which links turn fully (link 2 is the driver)."""

    CRANK_ROCKER = "crank-rocker"
    DOUBLE_CRANK = "double-crank"
    DOUBLE_ROCKER = "double-rocker"
    ROCKER_CRANK = "rocker-crank"
    CHANGE_POINT = "change-point"
    NON_GRASHOF = "non-Grashof"
    SLIDER_CRANK = "slider-crank"
    SLIDER_ROCKER = "slider-rocker"
    CRANK_SHAPER = "crank-shaper"
    WHITWORTH = "Whitworth"
    INVERTED_SLIDER_ROCKER = "inverted slider-rocker"


class Loop(NamedTuple):
    """The closed loop in components, each of shape (...); those of links 3 and 4 NaN where it is open.

    `ax` and `ay` lead from O2 to A, `ab` is the length from A along link 3 to B. `sine` is that of the
    transmission angle with the sign of the assembly; it keeps its digits near a dead position.
    """

    cos2: FloatArray
    sin2: FloatArray
    cos3: FloatArray
    sin3: FloatArray
    cos4: FloatArray
    sin4: FloatArray
    sine: FloatArray
    ax: FloatArray
    ay: FloatArray
    ab: FloatArray


class Driven(NamedTuple):
    """What the driver does to A: its n-th derivative is (i push - pull) e^(i theta2), n = 1 to 3."""

    push: tuple[FloatArray, FloatArray, FloatArray]
    pull: tuple[FloatArray, FloatArray, FloatArray]

    @classmethod
    def of(cls, r2: FloatArray, omega2: FloatArray, alpha2: FloatArray, jerk2: FloatArray) -> Driven:
        """Of a driver's rates."""
        tip = r2 * omega2
        push = tip, r2 * alpha2, r2 * (jerk2 - omega2**2 * omega2)
        return cls(push, (np.zeros_like(tip), tip * omega2, 3 * tip * alpha2))


class Sides(Protocol):
    """What closes a loop: a tuple of arrays, with the formulas that close it."""

    def __iter__(self) -> Iterator[FloatArray]:
        """The arrays."""
        ...

    def close(self, theta2: FloatArray) -> Loop:
        """The loop at given driver angles."""
        ...

    def rates(
        self, loop: Loop, dead: BoolArray, omega2: FloatArray, alpha2: FloatArray, jerk2: FloatArray
    ) -> tuple[FloatArray, ...]:
        """Angular velocities of links 3 and 4, their accelerations and jerks, then those of the slide.

        Infinite, with the sign of the term that grows fastest, where the position is `dead`.
        """
        ...


class Span(NamedTuple):
    """Where a loop closes, each of shape (...): sin^2(phi/2) + a >= 0 and cos^2(phi/2) + b >= 0.

    phi is theta2 - theta1. Times a positive number that keeps all digits: a, 1 + a, b, 1 + b. `closes`
    tells that it does at some driver angle.
    """

    a: FloatArray
    more_a: FloatArray
    b: FloatArray
    more_b: FloatArray
    closes: BoolArray


class Kind(ABC, Generic[L_contra]):
    """A kind of linkage, as its loop closes. Without state; one of each is in `kind_of`'s table."""

    slides: bool  # whether a link slides on another
    dead: str  # what is so in a dead position

    @abstractmethod
    def sides_of(self, linkage: L_contra, sign: FloatArray) -> Sides:
        """The sides of a linkage's loop on an assembly."""

    @abstractmethod
    def span(self, linkage: L_contra, cosine: float = 1.0) -> Span:
        """Where its loop closes with a transmission angle whose cosine is in size at most this one."""

    @abstractmethod
    def shares(self, linkage: L_contra) -> FloatArray:
        """The two differences whose signs decide how the driver turns, shape (..., 2); see `rotatability`."""

    @abstractmethod
    def even(self, linkage: L_contra) -> tuple[float, float]:
        """A and b of a single linkage, 1 for one that is 0 (a change point); NaN where they mean nothing."""

    @abstractmethod
    def class_of(self, linkage: L_contra, tolerance: float) -> GrashofClass:
        """The class of a single linkage."""

    @abstractmethod
    def apart(self, linkage: L_contra, phi: FloatArray) -> FloatArray:
        """The length that the transmission angle hangs on at theta2 - theta1 = phi."""

    @abstractmethod
    def apart_on_line(self, linkage: L_contra) -> tuple[FloatArray, FloatArray]:
        """The same at phi = 0 and pi, where it is least and greatest."""

    @abstractmethod
    def transmission(self, linkage: L_contra, apart: FloatArray) -> FloatArray:
        """The transmission angle in [0, pi] at such a length; NaN where the loop is open."""

    @abstractmethod
    def coupler_rates(
        self, linkage: L_contra, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """First and second derivative of theta3 by theta2."""

    @abstractmethod
    def carried(
        self, linkage: L_contra, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> FloatArray:
        """Derivative of theta3 by theta2, times the sine of `Loop`: finite in dead positions, too."""

    @abstractmethod
    def output_rate(
        self, linkage: L_contra, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> FloatArray:
        """Derivative by theta2 of theta4, or of the travel along the slide; not finite in dead positions."""

    @abstractmethod
    def turning(
        self, linkage: L_contra, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Angular velocities of links 2, 3 and 4 in a motion of the loop, length^2: finite everywhere.

        They follow the circuit, in one sense all around it; link 2 stands in dead positions.
        """

    @abstractmethod
    def limits(self, linkage: L_contra) -> FloatArray:
        """Driver angles at which the output turns back, shape (..., 2), rad; NaN where there are none."""

    @abstractmethod
    def turned(
        self, linkage: L_contra, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Derivatives of theta3 and theta4 by `DIMENSIONS` without u and v, at held theta2, (..., D - 2)."""

    @abstractmethod
    def way_to_4(self, linkage: L_contra) -> tuple[FloatArray, tuple[tuple[int, FloatArray], ...]]:
        """A ground pivot, and the lengths of the links from it on to the origin of the frame of link 4."""

    @abstractmethod
    def b_from(self, linkage: L_contra) -> FloatArray:
        """How far B is along the u-axis of link 4, shape (...)."""

    def direction4(self, linkage: L_contra, theta4: FloatArray) -> FloatArray:
        """Direction of the u-axis of link 4, shape (...), rad."""
        return theta4


def from_zero(gap: FloatArray, rounding: FloatArray) -> FloatArray:
    """The gap, 0 where only rounding makes it less: there the position is dead."""
    return np.where((gap < 0) & (gap >= -rounding), 0.0, gap)


def infinite_where(
    dead: BoolArray, leading: tuple[FloatArray, ...], rates: tuple[FloatArray, ...]
) -> tuple[FloatArray, ...]:
    """The rates, where a position is dead the infinite ones that lead."""
    return tuple(np.where(dead, infinite, rate) for infinite, rate in zip(leading, rates, strict=True))
