"""What is known of a first loop in closed form: driver ranges, classes, limit positions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from enum import StrEnum
from typing import Generic, NamedTuple, TypeVar

from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.linkages.linkage import Linkage

CHANGE = 1e-12  # share of the lengths within which a linkage has a change point

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


class FirstLoop(ABC, Generic[L_contra]):
    """A driver and a dyad on the ground, in closed form. Without state; one of each is in a table."""

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
    def limits(self, linkage: L_contra) -> FloatArray:
        """Driver angles at which the output turns back, shape (..., 2), rad; NaN where there are none."""
