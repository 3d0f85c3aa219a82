"""Every requirement on every kind of task: judge and screen see the misses, solves keep the requirement."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import islice, pairwise
from typing import Any

import numpy as np
import pytest
from matplotlib.path import Path

from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.analysis.judge.verify import Judge, Subject, Verdict
from grashof.problems import (
    Box,
    DynamicsSpec,
    FourBar,
    Manufacturing,
    MotionTask,
    PathTask,
    Problem,
    Region,
    Requirements,
    StrokeTask,
)
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.requirements.distances import PAIRS
from grashof.problems.values.requirements.limit_kinds import Kind
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.programme.start import Start
from grashof.synth.quantities.along_motion import ALONG
from grashof.synth.quantities.formulas import FORMULAS
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS, Screened
from grashof.synth.results.relaxations import rejudged
from grashof.synth.search.attempt import attempt
from grashof.synth.search.finder import finder_for

NEAR = 1e-5  # so close to a limit either judgement will do: the search places drivers to about 1e-6
POOL = 28  # linkages of each kind
STARTS = 14
DRAWS = 8  # of timed tasks, which bring few linkages at a time
APART = 0.01  # sizes, between linkages that differ
FREE = Requirements(link_length=(1e-3, 1e3), link_ratio_max=1e3, coupler_arms=(0.0, 1e3))
STEERED = {"transmission", "size", *FORMULAS, *ALONG}


def noisy(rows: FloatArray, seed: int) -> FloatArray:
    return rows + np.random.default_rng(seed).normal(0, 0.02 * np.ptp(rows[~np.isnan(rows)]), rows.shape)


def tasks() -> dict[str, MotionTask | PathTask | StrokeTask]:
    rng = np.random.default_rng(8)
    four, _ = planted_motion(rng, poses=4)
    many, _ = planted_motion(rng, poses=6)
    timed, _ = planted_motion(rng, poses=6, timed=True)
    five, _ = planted_path(rng, points=5)
    long, _ = planted_path(rng, points=12)
    angles = np.linspace(0, 2 * np.pi, 10, endpoint=False)
    closed = np.column_stack([2 * np.cos(angles), np.sin(angles) + 0.3 * np.cos(2 * angles)])
    free = many.positions[:5].copy()
    free[[1, 3]] = np.nan
    return {
        "poses met": four,
        "poses fitted": MotionTask(noisy(many.positions, 1), many.angles),
        "timed poses": MotionTask(noisy(timed.positions, 2), timed.angles, timing=timed.timing),
        "free parts": MotionTask(noisy(free, 3), many.angles[:5]),
        "points met": five,
        "points fitted": PathTask(noisy(long.points, 4)),
        "closed points": PathTask(closed, closed=True),
        "stroke": StrokeTask.from_degrees(swing_deg=60, time_ratio=1.15),
    }


TASKS = tasks()


def verdicts_of(linkages: Sequence[FourBar], problem: Problem) -> list[Verdict]:
    return Judge(problem.task, problem.requirements, problem=problem).verdicts([Subject(x) for x in linkages])


def apart(points: ComplexArray) -> list[int]:
    """Of linkages (n, 5) those that differ from all before."""
    picked = list[int]()
    for k in range(len(points)):
        if (np.abs(points[picked] - points[k]).max(axis=-1) > APART).all():
            picked.append(k)
    return picked


class Pool:
    """Linkages of a kind of task, as screened, as they are, and with their values."""

    def __init__(self, kind: str) -> None:
        self.problem = Problem(
            task=TASKS[kind],
            requirements=FREE,
            length_unit="m",
            dynamics=DynamicsSpec(mass_per_length=1.0, speed_rpm=60.0),
            manufacturing=Manufacturing(0.01),
        )
        scaled = ScaledProblem.of(self.problem)
        self.scale = scaled.frame.scale
        rng, draws = np.random.default_rng(3), DRAWS if scaled.timed else 1
        near = [finder_for(scaled).near(rng) for _ in range(draws)]
        found = Screened.joined(
            [one for each in near for one in (each if isinstance(each, list) else [each])]
        )
        found = found[apart(found.points)]
        found = found[np.linspace(0, len(found) - 1, min(len(found), 5 * POOL)).astype(int)]
        body = None if scaled.motion is not None else found.body_angle
        batch = scaled.linkages(found.points, found.assembly, body)
        every = enumerate(self.values([batch[k] for k in range(len(found))], self.problem))
        sound = dict(islice(((k, v) for k, v in every if v.verdict.ok and v.verdict.branch_ok), POOL))
        self.screened: Screened = found[np.array(list(sound))]
        self.known = list(sound.values())

    def values(self, linkages: Sequence[FourBar], problem: Problem) -> list[Values]:
        verdicts = verdicts_of(linkages, problem)
        return [Values(one, verdict, problem) for one, verdict in zip(linkages, verdicts, strict=True)]

    def screened_by(self, scaled: ScaledProblem) -> Screened:
        """The linkages screened by other requirements, which may state another size."""
        unit = self.scale / scaled.frame.scale
        points, coupler = unit * self.screened.points, unit * self.screened.coupler
        return rejudged(scaled, replace(self.screened, points=points, coupler=coupler))

    def verdicts(self, problem: Problem) -> list[Verdict]:
        """Of the same linkages by other requirements."""
        return verdicts_of([each.linkage for each in self.known], problem)

    def ends(self, name: str, part: str = "") -> FloatArray:
        """The least and the greatest of what a field limits, of every linkage; shape (n, 2)."""
        key = FREE.as_required(LIMITS[name].quantity).key
        every = [
            np.concatenate([np.ravel(v) for axis, v in each.parts(key).items() if not part or axis == part])
            for each in self.known
        ]
        return np.array([[each.min(), each.max()] for each in every])


@cache
def pool(kind: str) -> Pool:
    return Pool(kind)


def halving(of: Pool, name: str) -> tuple[Any, FloatArray]:
    """A requirement that about half of the linkages miss, and by how much each misses it; shape (n,)."""
    limit = LIMITS[name]
    shown = limit.quantity.unit.shown
    if limit.kind in (Kind.INSIDE, Kind.ON_BODY):
        low = of.ends(name, "x")[:, 0]
        # Near the last that misses it: in a wide gap no solve may lead from one side to the other.
        below, above = np.sort(low)[len(low) // 2 - 1 :][:2]
        least = float(0.9 * below + 0.1 * above)
        return Box(x=(least, np.inf)), least - low
    if limit.kind is Kind.NAMED:
        part = {"link_ratios": "r3/r2", "distances": "a-o4"}[name]
        low = of.ends(name, part)[:, 0]
        least = float(np.median(low))
        return {part: (least, 1e6)}, least - low
    low, high = of.ends(name).T
    if limit.kind is Kind.HEADING:
        most, wide = between_two(high), np.radians(200.0)  # fits of the same angles are much alike
        turns = 2 * np.pi * np.round((most - wide / 2 - (low + high) / 2) / (2 * np.pi))
        beyond = np.maximum(most - wide - low - turns, high + turns - most)
        return (float(np.degrees(most - wide)), float(np.degrees(most))), beyond
    if limit.kind is Kind.WORD:
        return "ccw", -low
    if limit.kind.is_angle:
        asked = float(low[0])
        return asked * shown, np.abs(np.angle(np.exp(1j * (low - asked))))
    if limit.kind is Kind.AT_LEAST:
        least = float(np.median(low))
        return least * shown, least - low
    most = float(np.median(high))
    if limit.kind is Kind.AT_MOST:
        return most * shown, high - most
    if limit.quantity.better > 0:
        least = float(np.median(low))
        return (least * shown, limit.allowed[1]), least - low
    least = limit.allowed[0] if name == "coupler_rate" else max(limit.allowed[0], 0.0)
    return (least, most * shown), high - most


def between_two(values: FloatArray) -> float:
    """The middle of the widest gap between values about the median."""
    some = np.sort(values)[len(values) // 4 : -(len(values) // 4)]
    k = int(np.argmax(np.diff(some)))
    return float(some[k : k + 2].mean())


def with_field(of: Pool, name: str, value: Any) -> Problem:
    return replace(of.problem, requirements=replace(FREE, **{name: value}))


def stated(of: Pool, name: str) -> bool:
    """Whether the problem states what a quantity needs, and linkages of the pool have it, not all alike."""
    quantity = LIMITS[name].quantity
    if not of.problem.states(quantity.needs) or quantity.key in of.problem.task.without:
        return False
    ends = of.ends(name)
    return bool(np.isfinite(ends).all()) and (np.ptp(ends[:, 0]) > NEAR or LIMITS[name].kind is Kind.WORD)


# Their searches take longer than half a second.
HEAVY = {
    "a", "coupler_arms", "frechet", "hausdorff", "joint_force_peak", "mechanical_advantage_min",
    "omega4_max", "output_acceleration_max", "output_swing_deg", "point_acceleration_max",
    "point_speed_max", "r2", "share_within_made", "size", "time_ratio", "torque_peak", "torque_rms",
    "transmission_min_deg", "worst_move",
}  # fmt: skip


def is_steered(name: str) -> bool:
    """Whether the search knows what a field limits; the others are for the judge alone."""
    quantity = LIMITS[name].quantity
    return not STEERED.isdisjoint({quantity.key, FREE.as_required(quantity).key})


@pytest.mark.quick(
    *(f"poses met-{name}" for name in LIMITS if name not in HEAVY),
    "closed points-r4",
    "closed points-driver_sense",
    *(f"stroke-{name}" for name in ("a", "b", "coupler_angle_deg", "coupler_rate", "r3")),
)
@pytest.mark.parametrize("name", LIMITS)
@pytest.mark.parametrize("kind", TASKS)
def test_misses_are_named_and_requirements_kept(kind: str, name: str) -> None:
    of = pool(kind)
    if not stated(of, name):
        return
    value, beyond = halving(of, name)
    problem = with_field(of, name, value)
    clear = np.abs(beyond) > NEAR * max(1.0, float(np.ptp(beyond)))
    # A driver that has to begin at an angle is put there, and then misses the targets.
    put_there = name == "theta2_start_deg" and kind != "poses met"
    for verdict, missed in zip(of.verdicts(problem), np.where(clear, beyond, np.nan), strict=True):
        if np.isfinite(missed) and not put_there:
            assert {defect.requirement for defect in verdict.defects} == ({name} if missed > 0 else set())
    if not is_steered(name):
        return
    scaled = ScaledProblem.of(problem)
    if not put_there:
        seen, missed = of.screened_by(scaled).violations[:, GROUPS.index(name)] > 0, beyond > 0
        if over_motion(name):  # sampled: the judge looks between
            assert not (seen & ~missed & clear).any()
            far = beyond > 0.05 * np.abs(of.ends(name)).max(axis=1)
            assert (seen & far).sum() >= 0.5 * far.sum()
        else:
            np.testing.assert_array_equal(seen[clear], missed[clear])
    if LIMITS[name].kind is not Kind.WORD:  # the start decides it
        assert solved_from_those_that_miss(scaled, of, np.where(clear, beyond, 0.0))


def over_motion(name: str) -> bool:
    return name == "size" or LIMITS[name].quantity.key in ALONG


def solved_from_those_that_miss(scaled: ScaledProblem, of: Pool, beyond: FloatArray) -> bool:
    """Whether one of a few designs that miss a requirement, the nearest first, leads to a sound one."""
    missing = [int(row) for row in np.argsort(beyond, kind="stable") if beyond[row] > 0][:STARTS]
    for row in missing:
        start = Start.of_linkage(scaled, of.known[row].linkage, of.known[row].verdict)
        done = attempt(scaled, start, 0)
        if done.verified:
            return verdicts_of([done.verified[0].linkage], scaled.problem)[0].ok
    return not missing


def distances(design: Values, pair: str) -> FloatArray:
    """Distances of two points at the targets, by the intersection of circles about A and O4."""
    linkage, theta2 = design.linkage, design.verdict.theta2
    o2, o4 = complex(*linkage.o2), complex(*linkage.o4)
    a = o2 + linkage.r2 * np.exp(1j * theta2)
    way = o4 - a
    along = (abs(way) ** 2 + linkage.r3**2 - linkage.r4**2) / (2 * abs(way))
    beside = np.sqrt(np.maximum(linkage.r3**2 - along**2, 0.0)) * np.asarray(design.verdict.assembly)
    b = a + (along + 1j * beside) * way / abs(way)
    p = a + complex(*linkage.coupler_point) * (b - a) / linkage.r3
    places = {"o2": o2, "o4": o4, "a": a, "b": b, "p": p}
    one, other = pair.split("-")
    return np.abs(places[one] - places[other]) * np.ones(len(theta2))


@pytest.mark.quick("poses met-most-b-o2", "poses met-fixed-b-p", "stroke-least-a-o4")
@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("side", ["least", "most", "fixed"])
@pytest.mark.parametrize("kind", TASKS)
def test_misses_are_named_and_distances_kept(kind: str, side: str, pair: str) -> None:
    of = pool(kind)
    low, high = np.array([[apart.min(), apart.max()] for apart in (distances(v, pair) for v in of.known)]).T
    if side == "fixed":
        if pair not in ("a-p", "b-p") or (kind == "stroke" and pair == "a-p"):  # P is A
            return  # the others change with the driver
        asked = float(np.sort(low)[len(low) // 2]) + 100 * NEAR * of.problem.task.size
        limits, beyond = (asked, asked), np.abs(low - asked)
    else:
        bound = float(np.median(low if side == "least" else high))
        limits = (bound, 1e6) if side == "least" else (0.0, bound)
        beyond = bound - low if side == "least" else high - bound
    problem = with_field(of, "distances", {pair: limits})
    clear = np.abs(beyond) > NEAR * max(1.0, float(np.ptp(beyond)))
    for verdict, missed in zip(of.verdicts(problem), np.where(clear, beyond, np.nan), strict=True):
        if np.isfinite(missed):
            found = verdict.defects
            assert {defect.requirement for defect in found} == ({"distances"} if missed > 0 else set())
            assert missed < 0 or max(each.miss for each in found) == pytest.approx(
                missed / problem.scale(LIMITS["distances"].quantity), rel=1e-6
            )
    scaled = ScaledProblem.of(problem)
    seen = of.screened_by(scaled).violations[:, GROUPS.index("distances")] > 0
    np.testing.assert_array_equal(seen[clear], (beyond > 0)[clear])
    assert solved_from_those_that_miss(scaled, of, np.where(clear, beyond, 0.0))


JOINTS = ("o2", "o4", "a", "b", "a_on_body", "b_on_body")
SLANTED = np.exp(0.4j)


def places(of: Pool, name: str) -> ComplexArray:
    """Places of a joint of every linkage, at every target: (n, N), or (n, 1)."""
    every = [each.parts(name) for each in of.known]
    return np.array([each["x"] + 1j * each["y"] for each in every])


def halving_region(of: Pool, name: str, shape: str) -> tuple[Region, FloatArray]:
    """A region that about half of the linkages miss, and how far they are outside at worst, or inside."""
    at = places(of, name)
    if shape == "segment":
        middle = at[np.argsort(at[:, 0].real)[len(at) // 2], 0]
        ends = middle + 0.7 * of.problem.task.size * SLANTED * np.array([-1, 1])
        return on(ends), distance_from(ends, at).max(axis=1)
    ahead = (at / SLANTED).real.max(axis=1)
    edge, far = float(np.median(ahead)) + 2 * NEAR, 50 * of.problem.task.size
    corners = [edge - far - 1j * far, edge - 1j * far, edge + 1j * far, edge - far + 1j * far]
    if shape == "notched":  # the notch begins beyond all of them
        corners[3:3] = [edge - far + 1j * far, edge - 0.9 * far + 0.9j * far]
        corners.pop()
    region = inside(np.array(corners) * SLANTED)
    within = contains(region, at)
    away = distance_from(np.append(region.places, region.places[0]), at)
    return region, np.where(within, -away, away).max(axis=1)


def inside(corners: ComplexArray) -> Region:
    return Region(inside=np.column_stack([corners.real, corners.imag]))  # type: ignore[arg-type]


def on(ends: ComplexArray) -> Region:
    return Region(on=np.column_stack([ends.real, ends.imag]))  # type: ignore[arg-type]


def contains(region: Region, at: ComplexArray) -> Any:
    flat = np.column_stack([at.ravel().real, at.ravel().imag])
    return Path(region.corners).contains_points(flat).reshape(at.shape)


def distance_from(line: ComplexArray, at: ComplexArray) -> FloatArray:
    """Distances of places from a polyline, by turning each of its sides onto the real axis."""
    away = np.full(at.shape, np.inf)
    for begin, end in pairwise(line.tolist()):
        turned = (at - begin) * abs(end - begin) / (end - begin)
        beyond = turned.real - np.clip(turned.real, 0, abs(end - begin))
        away = np.minimum(away, np.hypot(beyond, turned.imag))
    return away


@pytest.mark.quick(
    "poses met-polygon-o2", "poses met-notched-a_on_body", "poses met-segment-o4", "stroke-polygon-b"
)
@pytest.mark.parametrize("name", JOINTS)
@pytest.mark.parametrize("shape", ["polygon", "notched", "segment"])
@pytest.mark.parametrize("kind", TASKS)
def test_misses_are_named_and_regions_kept(kind: str, shape: str, name: str) -> None:
    of = pool(kind)
    if name.endswith("_on_body") and not of.problem.task.has_angle.any():
        return
    if shape == "segment" and name in ("a", "b"):  # a joint that turns leaves every line
        return
    region, beyond = halving_region(of, name, shape)
    problem = with_field(of, name, region)
    size = of.problem.task.size
    clear = np.abs(beyond) > NEAR * size
    for verdict, missed in zip(of.verdicts(problem), np.where(clear, beyond, np.nan), strict=True):
        if np.isfinite(missed):
            found = verdict.defects
            assert [defect.requirement for defect in found] == [name] * int(missed > 0)
            if missed > 0:
                assert found[0].found == pytest.approx(missed, rel=1e-6)
    scaled = ScaledProblem.of(problem)
    seen = of.screened_by(scaled).violations[:, GROUPS.index(name)] > 0
    np.testing.assert_array_equal(seen[clear], (beyond > 0)[clear])
    assert solved_from_those_that_miss(scaled, of, np.where(clear, beyond, 0.0))
