"""Every requirement on every kind of task: judge and screen see the misses, solves keep the requirement."""

from dataclasses import replace
from functools import cache
from itertools import islice
from typing import Any

import numpy as np
import pytest

from grashof.analysis import verify
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import (
    Box,
    DynamicsSpec,
    FourBar,
    Manufacturing,
    MotionTask,
    PathTask,
    Problem,
    Requirements,
)
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.requirements.quantities import Kind
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
POOL = 14  # linkages of each kind
STARTS = 6
FREE = Requirements(link_length=(1e-3, 1e3), link_ratio_max=1e3, coupler_arms=(0.0, 1e3))
STEERED = {"transmission", "size", *FORMULAS, *ALONG}


def noisy(rows: FloatArray, seed: int) -> FloatArray:
    return rows + np.random.default_rng(seed).normal(0, 0.02 * np.ptp(rows[~np.isnan(rows)]), rows.shape)


def tasks() -> dict[str, MotionTask | PathTask]:
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
    }


TASKS = tasks()


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
        found = finder_for(scaled).near(np.random.default_rng(3))
        found = found[np.linspace(0, len(found) - 1, min(len(found), 5 * POOL)).astype(int)]
        body = None if scaled.motion is not None else found.body_angle
        batch = scaled.linkages(found.points, found.assembly, body)
        every = ((k, self.values(batch[k], FREE)) for k in range(len(found)))
        sound = dict(islice(((k, v) for k, v in every if v.verdict.ok and v.verdict.branch_ok), POOL))
        self.screened: Screened = found[np.array(list(sound))]
        self.known = list(sound.values())

    def values(self, linkage: FourBar, wanted: Requirements) -> Values:
        problem = replace(self.problem, requirements=wanted)
        return Values(linkage, verify(linkage, problem.task, wanted, problem=problem), problem)

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
        least = float(np.median(low))
        return Box(x=(least, np.inf)), least - low
    if limit.kind is Kind.RATIOS:
        low = of.ends(name, "r3/r2")[:, 0]
        least = float(np.median(low))
        return {"r3/r2": (least, 1e6)}, least - low
    low, high = of.ends(name).T
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
    return (max(limit.allowed[0], 0.0), most * shown), high - most


def with_field(of: Pool, name: str, value: Any) -> Problem:
    return replace(of.problem, requirements=replace(FREE, **{name: value}))


def stated(of: Pool, name: str) -> bool:
    """Whether the problem states what a quantity needs, and linkages of the pool have it."""
    if not of.problem.states(LIMITS[name].quantity.needs):
        return False
    return bool(np.isfinite(of.ends(name)).all())


# Their searches take longer than half a second.
HEAVY = {
    "a",
    "frechet",
    "hausdorff",
    "joint_force_peak",
    "mechanical_advantage_min",
    "omega4_max",
    "output_swing_deg",
    "point_acceleration_max",
    "point_speed_max",
    "r2",
    "share_within_made",
    "size",
    "time_ratio",
    "torque_peak",
    "torque_rms",
    "transmission_min_deg",
    "worst_move",
}


def is_steered(name: str) -> bool:
    """Whether the search knows what a field limits; the others are for the judge alone."""
    quantity = LIMITS[name].quantity
    return not STEERED.isdisjoint({quantity.key, FREE.as_required(quantity).key})


@pytest.mark.quick(
    *(f"poses met-{name}" for name in LIMITS if name not in HEAVY),
    "closed points-r4",
    "closed points-driver_sense",
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
    for each, missed in zip(of.known, np.where(clear, beyond, np.nan), strict=True):
        if np.isfinite(missed) and not put_there:
            verdict = verify(each.linkage, problem.task, problem.requirements, problem=problem)
            assert {defect.requirement for defect in verdict.defects} == ({name} if missed > 0 else set())
    if not is_steered(name):
        return
    scaled = ScaledProblem.of(problem)
    if not put_there:
        seen, missed = rejudged(scaled, of.screened).violations[:, GROUPS.index(name)] > 0, beyond > 0
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
            return of.values(done.verified[0].linkage, scaled.problem.requirements).verdict.ok
    return not missing
