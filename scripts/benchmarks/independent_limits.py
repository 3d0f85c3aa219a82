"""Designs of the independent search: their joints, misses, and every limit as an excess.

The loop is closed by the elbow formula; it shares nothing with `grashof.synth`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from grashof.problems import (
    Box,
    CylinderSpec,
    FunctionTask,
    MotionTask,
    PathTask,
    Problem,
    Region,
    Requirements,
    Rotatability,
)
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray
from grashof.problems.values.requirements.target_limits import TargetLimits

# Distance of designs from their limits, sizes and rad (the judge forgives 1e-9); step of differences.
INSIDE, NUDGE = 2e-7, 1e-7
HAIR = 1e-12  # added to the length of a line, which may be zero
GREATEST = 5.0  # of logarithms of the sizes of a cylinder
BESIDE = 5e-7  # share of a segment: how far beside it a joint may lie


@dataclass(frozen=True, slots=True)
class Aim:
    """A task in its own size about its own middle; `wanted` stays in lengths of the problem."""

    size: float
    middle: complex
    points: ComplexArray
    angles: FloatArray
    root_weights: FloatArray
    angle_length: float
    timing: FloatArray
    closed: bool
    wanted: Requirements
    placed: bool  # the targets have positions
    link: str  # whose angles the targets have: "coupler", with a body, or "output"
    anywhere: bool  # the pivots are unknown; else O2 = 0 and O4 = 1
    turned: bool  # the targets have angles
    timed: bool  # the driver rotations are prescribed
    over_turn: bool  # the transmission angle counts over the full turn
    rates: Sequence[tuple[int, float, float]] = ()  # pairs, and the limits of d(output)/d(input) there
    lengthening: FloatArray | None = None  # (N,): of a cylinder on the driver, whose limits follow
    cylinder: CylinderSpec | None = None
    potential: Any = None  # its slope is the drive torque, see `wanted_torque.Potential`

    @classmethod
    def of(cls, problem: Problem, potential: Any = None) -> "Aim":
        """The aim of a problem."""
        task, wanted = problem.task, problem.requirements.resolved(problem.task.size)
        set_angles = (wanted.ground_angle_deg, wanted.theta2_start_deg) != (None, None)
        if wanted.keep_out or not wanted.order or not wanted.same_branch or set_angles:
            raise ValueError("areas, other branches, any order and prescribed angles are not supported here")
        placed, size, angles = isinstance(task, (MotionTask, PathTask)), task.size, task.angles
        places = task.positions @ np.array([1, 1j]) if placed else np.zeros(len(task), dtype=complex)
        middle = complex(places.mean())
        function = isinstance(task, FunctionTask)
        if function:
            angles = task.outputs  # as a body that turns with the link, wherever it is
        elif not placed or not (task.is_whole or task.only_points):
            raise ValueError("poses with free parts are not supported here")
        if task.travels:
            raise ValueError("functions of slides are not supported here")
        on_ground = Box(x=(0.0, 0.0), y=(0.0, 0.0)), Box(x=(1.0, 1.0), y=(0.0, 0.0))
        directed = any(box not in (None, Box()) for box in (wanted.o2, wanted.o4, wanted.a, wanted.b))
        directed |= any(each.a or each.b or each.coupler_angle_deg for each in wanted.at)
        return cls(
            size, middle, (places - middle) / size, angles, np.sqrt(task.weights),
            task.angle_length / size, task.driver_turns, task.closed, wanted, placed,
            link=task.link if function else "coupler",
            anywhere=placed or (directed and (wanted.o2, wanted.o4) != on_ground),
            turned=not np.isnan(angles).any(),
            timed=task.lengthens or not np.isnan(task.driver_turns).any(),
            over_turn=task.closed or wanted.transmission_over == "cycle", potential=potential,
            rates=rates_at_pairs(task) if isinstance(task, FunctionTask) and task.rates is not None else (),
            lengthening=task.inputs / size if task.lengthens else None,
            cylinder=problem.driver,
        )  # fmt: skip


def rates_at_pairs(task: FunctionTask) -> list[tuple[int, float, float]]:
    """Limits of the leverage ratio, with the number of the pair where each holds."""
    number = {turned: k for k, turned in enumerate(task.inputs.tolist())}
    rates = np.asarray(task.rates).tolist()
    if not number.keys() >= {at for at, _, _ in rates}:
        raise ValueError("leverage ratios between pairs are not supported here")
    return [(number[at], low, high) for at, low, high in rates]


@dataclass(frozen=True, slots=True)
class Designs:
    """A batch of B designs being improved."""

    x: FloatArray  # (B, n): O2, O4, logarithms of r2, r3, r4, coupler point, body angle, driver angles
    elbow: FloatArray  # (B,): side of B on A-O4, +1 or -1
    sense: FloatArray  # (B,): of the driver, +1 or -1

    def __getitem__(self, rows: IntArray | slice) -> "Designs":
        return Designs(*(getattr(self, name)[rows] for name in self.__slots__))

    def nudged(self) -> "Designs":
        """Each design, and n copies with one unknown each slightly increased, all in one batch."""
        count, unknowns = self.x.shape
        many = self[np.repeat(np.arange(count), unknowns + 1)]
        nudge = NUDGE * np.vstack([np.zeros(unknowns), np.eye(unknowns)])
        return replace(many, x=many.x + np.tile(nudge, (count, 1)))


@dataclass(frozen=True, slots=True)
class Places:
    """Joints of a batch at every target: complex of shape (B, N), lengths of shape (B, 1)."""

    o2: ComplexArray
    o4: ComplexArray
    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    coupler: ComplexArray
    body: FloatArray
    theta2: FloatArray
    a: ComplexArray
    b: ComplexArray
    p: ComplexArray

    def of(self, link: str) -> ComplexArray:
        """The joint from which a link leads to B."""
        return self.a if link == "coupler" else self.o4

    @property
    def r1(self) -> FloatArray:
        """Length O2O4, shape (B, 1)."""
        return np.abs(self.o4 - self.o2)


def elbow(line: ComplexArray, near: Any, far: Any, side: Any) -> ComplexArray:  # closure: RRR
    """From the start of a line to the point `near` from it and `far` from its end, left where `side` is 1."""
    length = np.abs(line) + HAIR
    along = (length**2 + near**2 - far**2) / (2 * length)
    across = np.sqrt(np.maximum(near**2 - along**2, 1e-16))  # in line where there is none
    found: ComplexArray = line / length * (along + 1j * side * across)
    return found


def places(aim: Aim, designs: Designs) -> Places:
    """All joints at all targets; where a loop does not close, links 3 and 4 are in line."""
    x = designs.x
    o2, o4, coupler = (x[:, k : k + 1] + 1j * x[:, k + 1 : k + 2] for k in (0, 2, 7))
    if not aim.anywhere:
        o2, o4 = 0 * o2, 0 * o4 + 1
    if not aim.placed:
        coupler = 0 * coupler
    r2, r3, r4 = (np.exp(np.clip(x[:, k : k + 1], -20, 20)) for k in (4, 5, 6))
    theta2 = x[:, 10:]
    if aim.lengthening is not None:
        theta2 = x[:, 10:11] + designs.sense[:, None] * np.arccos(np.clip(opening(aim, x), -1, 1))
    elif aim.timed:
        theta2 = theta2 + designs.sense[:, None] * aim.timing
    a = o2 + r2 * np.exp(1j * theta2)
    b = a + elbow(o4 - a, r3, r4, designs.elbow[:, None])
    p = a + coupler * (b - a) / np.abs(b - a)
    return Places(o2, o4, r2, r3, r4, coupler, x[:, 9:10], theta2, a, b, p)


def opening(aim: Aim, x: FloatArray) -> FloatArray:
    """Cosine of the angle at O2 between base and pivot of the cylinder at the targets, (B, N)."""
    base, arm, closed = np.exp(np.clip(x[:, 11:14], -20, 20)).T[..., None]
    cosine: FloatArray = (base**2 + arm**2 - (closed + aim.lengthening) ** 2) / (2 * base * arm)
    return cosine


def misses(aim: Aim, designs: Designs, at: Places) -> FloatArray:
    """Terms of the sum of squares: weighted distances of points, turns of poses as lengths; shape (B, M)."""
    gap = (at.p - aim.points) * aim.root_weights
    parts = [gap.real, gap.imag] if aim.placed else []
    if aim.turned:
        side = 1.0 if aim.placed else designs.sense[:, None]  # outputs count in the sense of the driver
        turn = np.angle((at.b - at.of(aim.link)) * np.exp(1j * (at.body - side * aim.angles)))
        parts.append(turn * aim.angle_length * aim.root_weights)
    if aim.potential is not None:
        untimed = replace(aim, timed=False)

        def turned(theta2: FloatArray) -> Places:
            return places(untimed, replace(designs, x=np.concatenate([designs.x[:, :10], theta2], axis=1)))

        ends = at.theta2[:, :1], at.theta2[:, -1:]
        parts.append(np.sqrt(len(aim.points)) * aim.potential.misses(turned, *ends, designs.sense[:, None]))
    return np.concatenate(parts, axis=1)


def oversteps(aim: Aim, designs: Designs, at: Places) -> FloatArray:
    """Excess over each limit, negative inside; shape (B, K)."""
    wanted, rows = aim.wanted, list[FloatArray]()
    lengths = np.concatenate([at.r1, at.r2, at.r3, at.r4], axis=1)
    for number, limits in enumerate(wanted.link_lengths):
        rows += beyond(lengths[:, number : number + 1], aim, limits)
    ratio = lengths.max(axis=1) / lengths.min(axis=1)
    rows.append(np.log(ratio / wanted.link_ratio_max)[:, None] + INSIDE)
    for name, limits in wanted.ranges("link_ratios").items():
        one, other = (getattr(at, link) for link in name.split("/"))
        for side, limit in zip((-1, 1), limits, strict=True):
            rows.append(side * np.log(one / other / limit) + INSIDE * (limits[0] < limits[1]))
    for name, limits in wanted.ranges("distances").items():
        rows += beyond(apart(at, name), aim, limits)
    for arm in (at.coupler, at.coupler - at.r3) if aim.placed else ():
        rows += beyond(np.abs(arm), aim, wanted.coupler_arms or (0.0, np.inf))
    for name in ("o2", "o4", "a", "b") if aim.anywhere else ("a", "b"):
        rows += astray(getattr(at, name), aim, getattr(wanted, name))
    for single in wanted.at:
        for number in single.targets:
            rows += at_target(at, aim, single, number - 1)
    for k, low, high in aim.rates:
        driver, coupler, output = (each[:, [k]] for each in (at.a - at.o2, at.b - at.a, at.b - at.o4))
        rate = cross(coupler, driver) / (cross(coupler, output) + HAIR)
        rows += [low - rate + INSIDE, rate - high + INSIDE]
    if aim.lengthening is not None and aim.cylinder is not None:
        logs = designs.x[:, 11:14]
        base, arm, closed = np.exp(np.clip(logs, -20, 20)).T[..., None]
        length = closed + np.linspace(0, aim.lengthening[-1], 200)
        lever = (arm**2 + length**2 - base**2) / (2 * arm * length)  # cosine of the angle at its pivot
        least = np.radians(wanted.cylinder_angle_min_deg or 0.0)
        rows += [np.abs(opening(aim, designs.x)) - 1 + INSIDE, np.abs(lever) - np.cos(least) + INSIDE]
        ratio = length[:, -1:] / closed
        rows += [np.log(ratio / aim.cylinder.ratio_max) + INSIDE, np.abs(logs) - GREATEST]
        rows += [*beyond(closed, aim, aim.cylinder.closed or (0.0, np.inf)), arm - at.r2]  # as the search
    rows += [*turning(aim, at), *transmission(aim, at)]
    if not aim.timed:
        step = designs.sense[:, None] * np.diff(at.theta2, axis=1)
        rows += [-step, step.sum(axis=1, keepdims=True) - TURN + INSIDE]
    return np.concatenate(rows, axis=1)


def beyond(value: FloatArray, aim: Aim, limits: tuple[float, float], middle: float = 0.0) -> list[FloatArray]:
    """Excess of values in sizes from the middle over finite limits in lengths of the problem."""
    pairs = zip((-1, 1), limits, strict=True)
    return [
        side * (value - (limit - middle) / aim.size) + INSIDE for side, limit in pairs if np.isfinite(limit)
    ]


def astray(joint: ComplexArray, aim: Aim, box: Box | None) -> list[FloatArray]:
    """Excess of places over a box or a convex region."""
    if box is None:
        return []
    rows = beyond(joint.real, aim, box.x, aim.middle.real) + beyond(joint.imag, aim, box.y, aim.middle.imag)
    for normal, least in sides(box) if isinstance(box, Region) else ():
        middle = (aim.middle * normal.conjugate()).real
        rows += beyond((joint * normal.conjugate()).real, aim, (least, np.inf), middle)
    return rows


def at_target(at: Places, aim: Aim, single: TargetLimits, k: int) -> list[FloatArray]:
    """Excess over limits at target k alone; angles in rad, the advantage by its logarithm."""
    a, b = at.a[:, [k]], at.b[:, [k]]
    driver, coupler, output = a - at.o2, b - a, b - at.o4
    rows = astray(a, aim, single.a) + astray(b, aim, single.b)
    if single.instant_centre is not None:
        share = cross(at.o4 - at.o2, output) / (cross(driver, output) + HAIR)
        rows += astray(at.o2 + np.clip(share, -1e6, 1e6) * driver, aim, single.instant_centre)
    if single.past_deg is not None:
        low, high = (aim.size * np.radians(single.past_deg)).tolist()
        rows += beyond(past_toggle(at, k), aim, (low, high))
    for name, limits in single.named.get("distances", {}).items():
        rows += beyond(apart(at, name)[:, [k]], aim, limits)
    if single.coupler_angle_deg is not None:
        low, high = np.radians(single.coupler_angle_deg).tolist()
        off = np.angle(coupler * np.exp(-0.5j * (low + high)))
        rows.append(np.abs(off) - (high - low) / 2 + INSIDE)
    if single.coupler_rate is not None:
        rate = -cross(driver, output) / (cross(coupler, output) + HAIR)
        rows += [
            side * (rate - limit) + INSIDE for side, limit in zip((-1, 1), single.coupler_rate, strict=True)
        ]
    if single.transmission_min_deg is not None:
        least = np.radians(single.transmission_min_deg) + INSIDE
        mu = np.abs(np.angle(coupler / output))
        rows.append(least - np.minimum(mu, np.pi - mu))
    if single.mechanical_advantage_min is not None:
        # The power that enters at A leaves at B, through the force along the coupler.
        by_driver, by_output = (np.abs(cross(each, coupler)) + HAIR for each in (driver, output))
        rows.append(np.log(single.mechanical_advantage_min * by_driver / by_output) + INSIDE)
    return rows


def sides(region: Region) -> list[tuple[complex, float]]:
    """Inward normals of a convex polygon, or of both sides of a segment, and the least places along them."""
    corners = region.corners @ np.array([1, 1j])
    along = np.roll(corners, -1) - corners
    turns = np.sign((along.conj() * np.roll(along, -1)).imag)  # 1 where the corners go counter-clockwise
    if np.ptp(turns) > 1:
        raise ValueError("concave regions are not supported here")
    normals = 1j * (turns.sum() or 1) * along
    least = (corners * normals.conj()).real / np.abs(normals) - BESIDE * np.abs(along) * (
        region.on is not None
    )
    return list(zip(normals / np.abs(normals), least.tolist(), strict=True))


def apart(at: Places, name: str) -> FloatArray:
    """Distance of two points at the targets, (B, N)."""
    one, other = (getattr(at, point) for point in name.split("-"))
    return np.asarray(np.abs(one - other))


def cross(one: ComplexArray, other: ComplexArray) -> FloatArray:
    """Cross product of vectors."""
    found: FloatArray = (one.conj() * other).imag
    return found


def past_toggle(at: Places, k: int) -> FloatArray:
    """Angle of driver and coupler past toggle at target k, rad, (B, 1)."""
    bend = (at.b - at.a) / (at.a - at.o2 + HAIR) + HAIR
    before = np.angle(bend[:, [0 if k else -1]] / bend[:, [k]])
    return np.asarray(-np.sign(before) * np.angle(bend[:, [k]] ** 2) / 2)  # whichever way the line points


def turning(aim: Aim, at: Places) -> list[FloatArray]:
    """Whether the driver turns fully: the diagonal A-O4 stays between |r3 - r4| and r3 + r4."""
    kind, margin = aim.wanted.rotatability, aim.wanted.rotatability_margin
    if kind is Rotatability.ANY:
        if not aim.closed:
            return []
        margin = 0.0
    longer = at.r2 - at.r1 if kind is Rotatability.DOUBLE_CRANK else at.r1 - at.r2
    if kind not in (Rotatability.CRANK_ROCKER, Rotatability.DOUBLE_CRANK):
        longer = np.abs(longer)
    least = margin * (at.r1 + at.r2 + at.r3 + at.r4) + INSIDE
    difference, stretched = at.r3 - at.r4, at.r3 + at.r4 - at.r1 - at.r2
    return [least - stretched, least - longer + difference, least - longer - difference]


def transmission(aim: Aim, at: Places) -> list[FloatArray]:
    """The diagonal A-O4 stays between the lengths at which mu reaches its least and its greatest value."""
    least = np.radians(aim.wanted.transmission_min_deg) + INSIDE
    square, product = at.r3**2 + at.r4**2, 2 * at.r3 * at.r4 * np.cos(least)
    shortest, longest = np.abs(at.r1 - at.r2), at.r1 + at.r2
    if not aim.over_turn:
        # Driver angles from the ground line; A passes it within the motion or not.
        around = (at.theta2 - np.angle(at.o4 - at.o2)) / TURN
        low, high = around.min(axis=1, keepdims=True), around.max(axis=1, keepdims=True)
        ends = np.abs(at.o4 - at.a)[:, [0, -1]] + HAIR
        folded, drawn = np.floor(high) > np.floor(low), np.floor(high - 0.5) > np.floor(low - 0.5)
        shortest = np.where(folded, shortest, ends.min(axis=1, keepdims=True))
        longest = np.where(drawn, longest, ends.max(axis=1, keepdims=True))
    return [np.sqrt(square - product) - shortest, longest - np.sqrt(square + product)]


def slopes(aim: Aim, at: Places) -> FloatArray:
    """Half the derivative of the squares by the driver angles on which limits depend; (B, 0) if none do.

    The judge takes the driver angles that come nearest, of a function among those that keep its limits. Where
    the transmission angle at the ends or the places of A and B are limited, a design may not gain by others.
    """
    boxed = (aim.wanted.a, aim.wanted.b) != (Box(), Box()) or bool(aim.wanted.at or aim.wanted.distances)
    if not aim.placed or (aim.over_turn and not boxed and aim.potential is None):
        return np.empty((len(at.p), 0))
    coupler, output, driver = at.b - at.a, at.b - at.o4, at.a - at.o2
    down = (coupler.conj() * output).imag
    rate3 = -(driver.conj() * output).imag / np.where(np.abs(down) < 1e-9, 1e-9, down)
    rate_p = 1j * (driver + (at.p - at.a) * rate3)
    slope = aim.root_weights**2 * ((at.p - aim.points).conj() * rate_p).real
    if aim.turned:
        turn = np.angle(coupler * np.exp(1j * (at.body - aim.angles)))
        slope = slope + (aim.root_weights * aim.angle_length) ** 2 * turn * rate3
    if aim.timed:
        slope = slope.sum(axis=1, keepdims=True)
    elif not boxed:
        slope = slope[:, [0, -1]]
    return slope
