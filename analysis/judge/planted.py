"""Planted tasks: random linkages and tasks that they do exactly, for tests and benchmarks."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from grashof.analysis.mechanism.mobility import rotatability
from grashof.analysis.mechanism.position import Position, solve_position
from grashof.analysis.mechanism.transmission import worst_transmission
from grashof.problems import (
    FourBar,
    FunctionTask,
    InvertedSliderCrank,
    Linkage,
    MotionTask,
    PathTask,
    SixBar,
    SliderCrank,
)
from grashof.problems.values.arrays import TURN, FloatArray

_LEAST_MARGIN = 0.002  # of full rotation, of planted functions


def random_full_crank(rng: np.random.Generator) -> FourBar:
    """A random four-bar whose driver turns fully.

    Lengths are log-uniform in 0.15 to 1 of a scale log-uniform in 1/e to e^2, the coupler point normal about
    A with 0.7 of it.
    """
    (r1, *others), _, o2, theta1, rest = _turning(
        rng, 4, lambda r, _: r[0] + r[1] < r[2] + r[3] and abs(r[0] - r[1]) > abs(r[2] - r[3])
    )
    return FourBar(o2, _ahead(o2, r1, theta1), *others, **rest)


def random_slider_crank(rng: np.random.Generator) -> SliderCrank:
    """A random slider-crank whose driver turns fully; scale and places as `random_full_crank`."""
    (r2, r3), offset, o2, slide_angle, rest = _turning(rng, 2, lambda r, e: r[0] + abs(e) < r[1])
    return SliderCrank(o2, r2, r3, offset=offset, slide_angle=slide_angle, **rest)


def random_inverted_slider_crank(rng: np.random.Generator) -> InvertedSliderCrank:
    """A random inverted slider-crank whose driver turns fully; scale and places as `random_full_crank`."""
    (r1, r2), offset, o2, theta1, rest = _turning(rng, 2, lambda r, e: abs(e) < abs(r[0] - r[1]))
    return InvertedSliderCrank(o2, _ahead(o2, r1, theta1), r2, offset=offset, **rest)


def _turning(
    rng: np.random.Generator, count: int, turns: Callable[[FloatArray, float], bool]
) -> tuple[FloatArray, float, FloatArray, float, dict[str, Any]]:
    """Lengths that let the driver turn, the offset (of kinds with two), O2, a direction, the other fields."""
    scale = np.exp(rng.uniform(-1, 2))
    while True:
        lengths = scale * np.exp(rng.uniform(np.log(0.15), 0, count))
        offset = rng.uniform(-1, 1) * scale if count == 2 else 0.0
        if turns(lengths, offset):
            break
    o2, direction = rng.normal(0, scale, 2), rng.uniform(-np.pi, np.pi)
    coupler_point, assembly = rng.normal(0, 0.7 * scale, 2), rng.choice([-1, 1])
    rest = {"coupler_point": coupler_point, "assembly": assembly, "body_angle": rng.uniform(-np.pi, np.pi)}
    return lengths, offset, o2, direction, rest


def _ahead(o2: FloatArray, r1: float, theta1: float) -> FloatArray:
    return o2 + r1 * np.array([np.cos(theta1), np.sin(theta1)])


def random_six_bar(
    rng: np.random.Generator, hosts: tuple[int, int] = (3, 1), least_mu: float = 5.0, ratio: float = 12.0
) -> SixBar:
    """A random six-bar whose driver turns fully, with `hosts` for C and D, and P on link 5.

    O2 = (0, 0) and O4 = (1, 0); the transmission angle is at least `least_mu`, deg, in both loops, and no
    link is more than `ratio` times as long as another.
    """
    sine = np.sin(np.radians(least_mu))
    while True:
        lengths = np.exp(rng.normal((-0.8, 0, 0, 0, 0), 0.5))
        every = np.append(lengths, 1.0)
        c, d, p = rng.normal(0, 0.8, (3, 2))
        if every.max() > ratio * every.min():
            continue
        r2, r3, r4, r5, r6 = lengths
        rest: dict[str, Any] = {"c": c, "d": d, "coupler_point": p, "hosts": hosts}
        signs = dict(zip(("assembly", "assembly_2"), rng.choice([-1, 1], 2), strict=True))
        made = SixBar((0, 0), (1, 0), r2, r3, r4, r5=r5, r6=r6, **rest, **signs)
        margins = np.array(solve_position(made, np.linspace(0, TURN, 181)).margins)
        if np.abs(margins).min() >= sine:  # NaN where it does not close
            return made


# By the word for the kind of linkage of one loop.
RANDOM: dict[str, Callable[[np.random.Generator], Linkage]] = {
    FourBar.mechanism.word: random_full_crank,
    SliderCrank.mechanism.word: random_slider_crank,
    InvertedSliderCrank.mechanism.word: random_inverted_slider_crank,
}
# Of six-bars one mechanism for each word.
SIX_BARS: dict[str, Callable[[np.random.Generator], Linkage]] = {
    "stephenson-3": random_six_bar,
    "stephenson-1": partial(random_six_bar, hosts=(2, 4)),
    "watt-1": partial(random_six_bar, hosts=(3, 4)),
    "watt-2": partial(random_six_bar, hosts=(4, 1)),
}


def uneven_driver_angles(rng: np.random.Generator, count: int) -> FloatArray:
    """Driver angles (count,) in order, over 70 to 340 deg in either sense, with gaps up to 4 : 1."""
    gaps = rng.uniform(1, 4, count - 1)
    spread = rng.choice([-1, 1]) * np.radians(rng.uniform(70, 340))
    steps = np.concatenate([[0.0], np.cumsum(gaps) / gaps.sum()])
    angles: FloatArray = rng.uniform(-np.pi, np.pi) + spread * steps
    return angles


def planted_motion(
    rng: np.random.Generator, poses: int, *, timed: bool = False, mechanism: str = FourBar.mechanism.word
) -> tuple[MotionTask, Any]:
    """A motion task, and a full-crank linkage that does it exactly, in order, on one assembly."""
    linkage, state, timing = _planted(rng, poses, timed, mechanism)
    return MotionTask(state.p, state.carrying + linkage.body_angle, timing=timing), linkage


def planted_path(
    rng: np.random.Generator, points: int, *, timed: bool = False, mechanism: str = FourBar.mechanism.word
) -> tuple[PathTask, Any]:
    """A path task, and a full-crank linkage that does it exactly, in order, on one assembly."""
    linkage, state, timing = _planted(rng, points, timed, mechanism)
    return PathTask(state.p, timing=timing), linkage


def _planted(
    rng: np.random.Generator, count: int, timed: bool, mechanism: str
) -> tuple[Linkage, Position, FloatArray | None]:
    linkage, theta2 = (RANDOM | SIX_BARS)[mechanism](rng), uneven_driver_angles(rng, count)
    return linkage, solve_position(linkage, theta2), np.abs(theta2 - theta2[0]) if timed else None


def planted_function(
    rng: np.random.Generator, pairs: int, *, full: bool = False, mechanism: str = FourBar.mechanism.word,
    link: str = "output",
) -> tuple[FunctionTask, Any, float]:  # fmt: skip
    """Pairs that a linkage generates, the linkage, and its driver angle (rad) at the first pair.

    The driver turns counter-clockwise, fully if `full`, as all six-bars. O2 = (0, 0), and O4 = (1, 0) or the
    slide runs along x; lengths are 0.2 to 5, the range 30 to 300 deg, the least transmission angle 10 deg.
    The link is the output or the coupler, as of `FunctionTask`.
    """
    while True:
        made = (_LOOSE | SIX_BARS)[mechanism](rng)
        start, span = rng.uniform(-np.pi, np.pi), np.radians(rng.uniform(30, 300))
        linkage = made.changed(assembly=rng.choice([-1, 1]))
        if full and rotatability(linkage).min() < _LEAST_MARGIN:
            continue
        if not (worst_transmission(linkage, start, start + span) >= np.radians(10)):
            continue
        inputs = np.concatenate([[0.0], np.sort(rng.uniform(0, span, pairs - 2)), [span]])
        dense = np.unique(np.concatenate([inputs, np.linspace(0, span, 201)]))
        state = solve_position(linkage, start + dense)
        if np.isnan(state.last).any() or np.diff(inputs).min() < span / pairs / 10:
            continue
        travels = mechanism == SliderCrank.mechanism.word
        moved = state.travel if travels else np.unwrap(state.theta3 if link == "coupler" else state.last)
        outputs = moved[np.searchsorted(dense, inputs)]
        if not travels and np.ptp(outputs) > TURN:
            continue
        task = FunctionTask(inputs, outputs - outputs[0], travels=travels, link=link)
        return task, linkage, float(start)


def _lengths(rng: np.random.Generator, count: int) -> FloatArray:
    lengths: FloatArray = np.exp(np.log(5) * rng.uniform(-1, 1, count))
    return lengths


def _loose_slider_crank(rng: np.random.Generator) -> SliderCrank:
    r2, r3 = _lengths(rng, 2)
    return SliderCrank((0, 0), r2, r3, offset=rng.uniform(-1, 1) * max(r2, r3))


def _loose_inverted(rng: np.random.Generator) -> InvertedSliderCrank:
    (r2,) = _lengths(rng, 1)
    return InvertedSliderCrank((0, 0), (1, 0), r2, offset=rng.uniform(-1, 1) * max(r2, 1.0))


# Linkages whose driver need not turn fully, by the word for their kind.
_LOOSE: dict[str, Callable[[np.random.Generator], Linkage]] = {
    FourBar.mechanism.word: lambda rng: FourBar((0, 0), (1, 0), *_lengths(rng, 3)),
    SliderCrank.mechanism.word: _loose_slider_crank,
    InvertedSliderCrank.mechanism.word: _loose_inverted,
}
