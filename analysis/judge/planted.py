"""Planted tasks: random linkages and tasks that they are known to do, for tests and benchmarks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from grashof.analysis.four_bar.position import solve_position
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, MotionTask, PathTask, SliderCrank
from grashof.problems.values.arrays import FloatArray


def random_full_crank(rng: np.random.Generator) -> FourBar:
    """A random four-bar whose driver turns fully.

    Lengths are log-uniform in 0.15 to 1 times a scale that is itself log-uniform in 1/e to e^2;
    the coupler point is normal about A with 0.7 of the scale; position and direction are random.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    FourBar
    """
    scale = np.exp(rng.uniform(-1, 2))
    while True:
        r1, r2, r3, r4 = scale * np.exp(rng.uniform(np.log(0.15), 0, 4))
        if r1 + r2 < r3 + r4 and abs(r1 - r2) > abs(r3 - r4):
            break
    o2, theta1 = rng.normal(0, scale, 2), rng.uniform(-np.pi, np.pi)
    return FourBar(
        o2=o2,
        o4=o2 + r1 * np.array([np.cos(theta1), np.sin(theta1)]),
        r2=r2,
        r3=r3,
        r4=r4,
        coupler_point=rng.normal(0, 0.7 * scale, 2),
        assembly=rng.choice([-1, 1]),
        body_angle=rng.uniform(-np.pi, np.pi),
    )


def random_slider_crank(rng: np.random.Generator) -> SliderCrank:
    """A random slider-crank whose driver turns fully; scale and places as `random_full_crank`."""
    scale = np.exp(rng.uniform(-1, 2))
    while True:
        r2, r3 = scale * np.exp(rng.uniform(np.log(0.15), 0, 2))
        offset = rng.uniform(-1, 1) * scale
        if r2 + abs(offset) < r3:
            break
    return SliderCrank(
        o2=rng.normal(0, scale, 2),
        r2=r2,
        r3=r3,
        offset=offset,
        slide_angle=rng.uniform(-np.pi, np.pi),
        coupler_point=rng.normal(0, 0.7 * scale, 2),
        assembly=rng.choice([-1, 1]),
        body_angle=rng.uniform(-np.pi, np.pi),
    )


def random_inverted_slider_crank(rng: np.random.Generator) -> InvertedSliderCrank:
    """A random inverted slider-crank whose driver turns fully; scale and places as `random_full_crank`."""
    scale = np.exp(rng.uniform(-1, 2))
    while True:
        r1, r2 = scale * np.exp(rng.uniform(np.log(0.15), 0, 2))
        offset = rng.uniform(-1, 1) * scale
        if abs(offset) < abs(r1 - r2):
            break
    o2, theta1 = rng.normal(0, scale, 2), rng.uniform(-np.pi, np.pi)
    return InvertedSliderCrank(
        o2=o2,
        o4=o2 + r1 * np.array([np.cos(theta1), np.sin(theta1)]),
        r2=r2,
        offset=offset,
        coupler_point=rng.normal(0, 0.7 * scale, 2),
        assembly=rng.choice([-1, 1]),
        body_angle=rng.uniform(-np.pi, np.pi),
    )


# By the word for the kind of linkage.
RANDOM: dict[str, Callable[[np.random.Generator], Linkage]] = {
    FourBar.MECHANISM: random_full_crank,
    SliderCrank.MECHANISM: random_slider_crank,
    InvertedSliderCrank.MECHANISM: random_inverted_slider_crank,
}


def uneven_driver_angles(rng: np.random.Generator, count: int) -> FloatArray:
    """`count` driver angles in order, shape (count,), rad: 70 to 340 deg of a turn, in either sense.

    The gaps between them differ by up to 4 : 1.
    """
    gaps = rng.uniform(1, 4, count - 1)
    spread = rng.choice([-1, 1]) * np.radians(rng.uniform(70, 340))
    steps = np.concatenate([[0.0], np.cumsum(gaps) / gaps.sum()])
    angles: FloatArray = rng.uniform(-np.pi, np.pi) + spread * steps
    return angles


def planted_motion(
    rng: np.random.Generator, poses: int, *, timed: bool = False, mechanism: str = FourBar.MECHANISM
) -> tuple[MotionTask, Any]:
    """A motion task, and a full-crank linkage that does it exactly, in order, on one assembly.

    Parameters
    ----------
    rng : numpy.random.Generator
    poses : int
    timed : bool
        The driver rotations are prescribed.
    mechanism : str
        The kind of linkage.

    Returns
    -------
    MotionTask, Linkage

    Examples
    --------
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=4)
    >>> len(task), linkage.shape
    (4, ())
    """
    linkage = RANDOM[mechanism](rng)
    theta2 = uneven_driver_angles(rng, poses)
    state, timing = solve_position(linkage, theta2), np.abs(theta2 - theta2[0]) if timed else None
    return MotionTask(state.p, state.theta3 + linkage.body_angle, timing=timing), linkage


def planted_path(
    rng: np.random.Generator, points: int, *, timed: bool = False, mechanism: str = FourBar.MECHANISM
) -> tuple[PathTask, Any]:
    """A path task, and a full-crank linkage that does it exactly, in order, on one assembly.

    Parameters
    ----------
    rng : numpy.random.Generator
    points : int
    timed : bool
        The driver rotations are prescribed.
    mechanism : str
        The kind of linkage.

    Returns
    -------
    PathTask, Linkage
    """
    linkage = RANDOM[mechanism](rng)
    theta2 = uneven_driver_angles(rng, points)
    timing = np.abs(theta2 - theta2[0]) if timed else None
    return PathTask(solve_position(linkage, theta2).p, timing=timing), linkage
