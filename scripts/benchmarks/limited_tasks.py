"""Random least-squares tasks with tight limits, as problem files; for `benchmark_limited.py`.

Points and poses come from coupler curves with noise, and from shapes that no four-bar traces: smooth closed
curves, polygons, bows, hand-drawn lines. No closed path crosses itself. Limits are drawn without regard to
any linkage, so that many of them are active in the best design; some tasks may have none.
"""

import tomllib
from collections.abc import Callable

import numpy as np
from shapely import Polygon

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import random_full_crank, uneven_driver_angles
from grashof.problems import Problem
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.values.arrays import ComplexArray, FloatArray

SERIES = 11  # of the random numbers
_XY = np.array([1, 1j])


def problem_of(text: str, name: str) -> Problem:
    """The problem that a problem file's text states."""
    return problem_from(tomllib.loads(text), name)


def random_task(number: int) -> tuple[str, str]:
    """Name and text of the random task of this number, always the same."""
    rng = np.random.default_rng([SERIES, number])
    maker = _MAKERS[number % len(_MAKERS)]
    size = float(np.round(np.exp(rng.uniform(np.log(60), np.log(400)))))
    closed, lines = maker(rng, size)
    kind = "motion" if "poses" in lines[0] else "path"
    text = [f'kind = "{kind}"', 'length_unit = "mm"', f"[{kind}]", *lines]
    text += ["[requirements]", "exact = false", *_limits(rng, size, closed)]
    return f"{number:03d} {maker.__name__.strip('_').replace('_', ' ')}", "\n".join(text) + "\n"


def _path(places: ComplexArray, closed: bool, timing: FloatArray | None = None) -> tuple[bool, list[str]]:
    lines = [f"points = {np.stack([places.real, places.imag], -1).round(2).tolist()}"]
    if closed:
        lines.append("closed = true")
    if timing is not None:
        lines.append(f"timing_deg = {np.degrees(timing).round(1).tolist()}")
    return closed, lines


def _poses(places: ComplexArray, angles: FloatArray) -> tuple[bool, list[str]]:
    rows = np.stack([places.real, places.imag, np.degrees(angles)], -1).round(2)
    return False, [f"poses = {rows.tolist()}"]


def _to_size(places: ComplexArray, size: float) -> ComplexArray:
    """The places moved to about the origin and scaled to this greatest distance."""
    places = places - places.mean()
    scaled: ComplexArray = places * size / np.abs(places[:, None] - places).max()
    return scaled


def _is_simple(places: ComplexArray) -> bool:
    return bool(Polygon(np.stack([places.real, places.imag], -1)).is_valid)


def _noise(rng: np.random.Generator, count: int, size: float) -> ComplexArray:
    noise: ComplexArray = size * rng.uniform(0.003, 0.02) * (rng.normal(size=(count, 2)) @ _XY)
    return noise


def _closed_coupler_curve(rng: np.random.Generator, size: float) -> tuple[bool, list[str]]:
    places, _ = _round_trip(rng, int(rng.integers(8, 17)), size)
    return _path(places, closed=True)


def _round_trip(rng: np.random.Generator, count: int, size: float) -> tuple[ComplexArray, FloatArray]:
    """Points of a coupler curve with noise and the driver's turn to each; they do not cross themselves."""
    while True:
        gaps = rng.uniform(1, 2.5, count)
        turned = 2 * np.pi * (np.cumsum(gaps) - gaps[0]) / gaps.sum()
        theta2 = rng.uniform(-np.pi, np.pi) + rng.choice([-1, 1]) * turned
        places = _to_size(solve_position(random_full_crank(rng), theta2).p @ _XY, size)
        places = places + _noise(rng, count, size)
        if _is_simple(places):
            return places, turned


def _closed_drawn_curve(rng: np.random.Generator, size: float) -> tuple[bool, list[str]]:
    return _path(_drawn_loop(rng, int(rng.integers(8, 17)), size), closed=True)


def _drawn_loop(rng: np.random.Generator, count: int, size: float) -> ComplexArray:
    """Points of a smooth closed curve of a few harmonics, long or round, that does not cross itself."""
    angle = 2 * np.pi * np.arange(count) / count
    while True:
        weights = {k: 0.5 / abs(k) ** 1.5 * complex(*rng.normal(size=2)) for k in (-1, 2, -2, 3, -3)}
        curve = np.exp(1j * angle) + sum(weight * np.exp(1j * k * angle) for k, weight in weights.items())
        if _is_simple(curve):
            return _to_size(curve, size)


def _polygon(rng: np.random.Generator, size: float) -> tuple[bool, list[str]]:
    """Points along the sides of a convex polygon or a half moon."""
    if rng.random() < 0.3:
        bow = np.exp(1j * np.linspace(0, np.pi, 9))
        corners = np.concatenate([bow, bow[-2:0:-1].real + 1j * rng.uniform(0, 0.6) * bow[-2:0:-1].imag])
    else:
        around = (
            np.sort(rng.uniform(0, 1, 3)) if rng.random() < 0.5 else np.arange(4) + rng.uniform(0, 0.5, 4)
        )
        corners = np.exp(2j * np.pi * around / (1 if len(around) == 3 else 4))
        corners = corners.real + 1j * rng.uniform(0.3, 1) * corners.imag
    points = _along(np.append(corners, corners[0]), int(rng.integers(9, 17)) + 1)[:-1]
    turned: ComplexArray = _to_size(points, size) * np.exp(1j * rng.uniform(-np.pi, np.pi))
    return _path(turned, closed=True)


def _along(corners: ComplexArray, count: int) -> ComplexArray:
    """So many points at equal steps along a line of corners."""
    run = np.append(0.0, np.cumsum(np.abs(np.diff(corners))))
    at = np.linspace(0, run[-1], count)
    points: ComplexArray = np.interp(at, run, corners.real) + 1j * np.interp(at, run, corners.imag)
    return points


def _open_path(rng: np.random.Generator, size: float) -> tuple[bool, list[str]]:
    count = int(rng.integers(8, 15))
    if rng.random() < 0.4:
        theta2 = uneven_driver_angles(rng, count)
        places = _to_size(solve_position(random_full_crank(rng), theta2).p @ _XY, size)
        return _path(places + _noise(rng, count, size), closed=False)
    return _path(_drawn_line(rng, count, size), closed=False)


def _drawn_line(rng: np.random.Generator, count: int, size: float) -> ComplexArray:
    """A bow, a line with one bend, or a gentle wave, in any direction."""
    t, shape = np.linspace(-1, 1, count), rng.integers(3)
    if shape == 0:
        half = rng.uniform(0.3, 2.4)
        line = np.exp(1j * half * t)
    elif shape == 1:
        line = _along(np.array([-1, rng.uniform(-0.5, 0.5) + 1j * rng.uniform(0.2, 1), 1]), count)
    else:
        line = t + 1j * rng.uniform(0.1, 0.4) * np.sin(rng.uniform(1.5, 4) * t + rng.uniform(-2, 2))
    turned: ComplexArray = _to_size(line, size) * np.exp(1j * rng.uniform(-np.pi, np.pi))
    return turned


def _timed_path(rng: np.random.Generator, size: float) -> tuple[bool, list[str]]:
    count = int(rng.integers(8, 17))
    if rng.random() < 0.5:
        places, turned = _round_trip(rng, count, size)
        return _path(places, closed=True, timing=turned)
    if rng.random() < 0.5:
        turned = 2 * np.pi * np.arange(count) / count
        return _path(_drawn_loop(rng, count, size), closed=True, timing=turned)
    turned = np.radians(rng.uniform(60, 240)) * np.linspace(0, 1, count)
    return _path(_drawn_line(rng, count, size), closed=False, timing=turned)


def _coupler_poses(rng: np.random.Generator, size: float) -> tuple[bool, list[str]]:
    count, linkage = int(rng.integers(4, 9)), random_full_crank(rng)
    state = solve_position(linkage, uneven_driver_angles(rng, count))
    places = _to_size(state.p @ _XY, size) + _noise(rng, count, size)
    return _poses(places, np.unwrap(state.theta3) + rng.normal(0, 0.03, count))


def _drawn_poses(rng: np.random.Generator, size: float) -> tuple[bool, list[str]]:
    count = int(rng.integers(4, 9))
    t = np.linspace(0, 1, count)
    angles = np.radians(rng.uniform(-120, 120)) * t ** rng.uniform(0.6, 1.6) + rng.uniform(-np.pi, np.pi)
    return _poses(_drawn_line(rng, count, size), angles)


_MAKERS: tuple[Callable[[np.random.Generator, float], tuple[bool, list[str]]], ...] = (
    _closed_coupler_curve,
    _closed_drawn_curve,
    _polygon,
    _open_path,
    _timed_path,
    _coupler_poses,
    _drawn_poses,
)


def _limits(rng: np.random.Generator, size: float, closed: bool) -> list[str]:
    """Lines of [requirements]."""
    kinds = ("crank-rocker", "full-crank", "double-crank", "any")
    kind = rng.choice(kinds, p=(0.6, 0.2, 0.1, 0.1) if closed else (0.3, 0.2, 0.1, 0.4))
    over = rng.choice(("task", "cycle"), p=(0.6, 0.4))
    if kind == "any":
        over = "task"
    lines = [
        f'rotatability = "{kind}"',
        f"transmission_min_deg = {rng.integers(20, 41)}",
        f'transmission_over = "{over}"',
        f"link_length = {_pair(size * rng.uniform(0.1, 0.3), size * rng.uniform(1.2, 3))}",
    ]
    if rng.random() < 0.5:
        lines.append(f"coupler_arms = {_pair(size * rng.uniform(0, 0.3), size * rng.uniform(1, 2.5))}")
    if rng.random() < 0.5:
        lines += _boxes(rng, size)
    if rng.random() < 0.15:
        side = _pair(*(size * np.array([-2.5, rng.uniform(0, 1)])))
        lines.append(f"{rng.choice(['a', 'b'])} = {{ y = {side} }}")
    return lines


def _boxes(rng: np.random.Generator, size: float) -> list[str]:
    """Where the ground pivots may lie: both below the task, or each in a box beside it."""
    if rng.random() < 0.4:
        below = _pair(-2.5 * size, -rng.uniform(0.3, 0.9) * size)
        return [f"{pivot} = {{ y = {below} }}" for pivot in ("o2", "o4")]
    lines, first = [], rng.uniform(-np.pi, np.pi)
    for pivot, direction in (("o2", first), ("o4", first + rng.uniform(0.3, 1.5))):
        centre = size * rng.uniform(0.4, 1.3) * np.array([np.cos(direction), np.sin(direction)])
        half = size * rng.uniform(0.05, 0.4, 2)
        x, y = (_pair(c - h, c + h) for c, h in zip(centre, half, strict=True))
        lines.append(f"{pivot} = {{ x = {x}, y = {y} }}")
    return lines if rng.random() < 0.7 else lines[:1]


def _pair(low: float, high: float) -> str:
    return f"[{low:.1f}, {high:.1f}]"
