"""A second opinion on any linkage: Newton's method on the equations of its loop, without closed forms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from grashof.problems import FourBar, Linkage, SliderCrank


@dataclass(frozen=True)
class SecondOpinion:
    """The loop of a single linkage as two equations in two unknowns: theta3, and theta4 or a length.

    Vectors are pairs of numbers.
    """

    linkage: Linkage

    def gap(self, theta2: Any, x: Any) -> Any:
        """The loop's gap, shape (2,)."""
        given: Any = self.linkage
        theta3, other = x
        a = given.o2 + given.r2 * _along(theta2)
        if isinstance(given, FourBar):
            return a + given.r3 * _along(theta3) - given.o4 - given.r4 * _along(other)
        if isinstance(given, SliderCrank):
            slide = _along(given.slide_angle)
            return a + given.r3 * _along(theta3) - given.o2 - other * slide - given.offset * _left(slide)
        rod = _along(theta3)
        return a + other * rod - given.o4 - given.offset * _left(rod)

    def jacobian(self, x: Any) -> Any:
        """Derivatives of the gap by the unknowns, shape (2, 2)."""
        given: Any = self.linkage
        theta3, other = x
        rod = _along(theta3)
        if isinstance(given, FourBar):
            return np.stack([given.r3 * _left(rod), -given.r4 * _left(_along(other))], axis=-1)
        if isinstance(given, SliderCrank):
            return np.stack([given.r3 * _left(rod), -_along(given.slide_angle)], axis=-1)
        return np.stack([other * _left(rod) + given.offset * rod, rod], axis=-1)

    def sine(self, x: Any) -> Any:
        """Determinant of the equations with the assembly's sign: zero where links 3 and 4 run away."""
        (first, second), (third, fourth) = self.jacobian(x)
        determinant = first * fourth - second * third
        given: Any = self.linkage
        if isinstance(given, FourBar):
            return -determinant / (given.r3 * given.r4)
        if isinstance(given, SliderCrank):
            return determinant / given.r3
        return -determinant / np.hypot(x[1], given.offset)

    def size(self, theta2: Any, x: Any) -> float:
        """How far the loop is from closed."""
        return float(np.linalg.norm(self.gap(theta2, x)))

    def solve(self, theta2: Any, x: Any) -> Any:
        """Newton's method from a guess, steps halved while they make the gap larger; NaN without an end."""
        x = np.asarray(x) + 0 * theta2
        for _ in range(40):
            gap = self.gap(theta2, x)
            size = np.linalg.norm(gap)
            if size == 0:
                break
            try:
                step = np.linalg.solve(self.jacobian(x), gap)
            except np.linalg.LinAlgError:
                break
            share = 1.0
            while (
                share > 1e-3 and np.linalg.norm(self.gap(theta2, x - share * step)) > (1 - share / 4) * size
            ):
                share /= 2
            if share <= 1e-3:
                break
            x = x - share * step
        scale = sum(np.abs(self.linkage.lengths)) + np.abs(self.linkage.o2).max()
        closed = np.linalg.norm(self.gap(theta2, x)) < 1e-11 * scale
        return x if closed else np.full(2, np.nan)

    def at(self, theta2: float, assembly: int) -> npt.NDArray[np.float64]:
        """The unknowns on one assembly, from many guesses; NaN where there is none."""
        size = float(np.sum(self.linkage.lengths)) + float(np.abs(getattr(self.linkage, "offset", 0.0)))
        turn = not isinstance(self.linkage, FourBar)
        others = np.array([-1.0, -0.4, 0.3, 0.9]) * size if turn else np.array([-2.5, -1, 0.5, 2.0])
        for theta3 in np.linspace(-np.pi, np.pi, 9)[:-1] + 0.1:
            for other in others:
                x = self.solve(theta2, np.array([theta3, other]))
                if np.sign(self.sine(x)) == assembly:
                    return x
        return np.full(2, np.nan)


def _along(angle: Any) -> Any:
    return np.stack([np.cos(angle), np.sin(angle)])


def _left(vector: Any) -> Any:
    return np.stack([-vector[1], vector[0]])


@pytest.fixture(scope="session")
def second_opinion() -> type[SecondOpinion]:
    return SecondOpinion
