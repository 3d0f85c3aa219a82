"""Limits of joints and links of functions: rows of the search against circles and differences; designs."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import verify
from grashof.problems import (
    Box,
    CylinderSpec,
    FourBar,
    FunctionTask,
    Linkage,
    Problem,
    Region,
    Requirements,
    TargetLimits,
)
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Candidate
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.starts.functions.optima import Optima, optima
from grashof.synth.starts.functions.places import PlaceLimits
from grashof.synth.theory.functions.starts import function_starts

PAIRS = [0, 20, 45, 70, 90, 110], [0, 15, 30, 40, 46, 50]
FREE = Requirements(exact=False, rotatability="any", transmission_min_deg=10)
GROUND = {"o2": Box((0, 0), (0, 0)), "o4": Box((1, 1), (0, 0))}


def problem(task: FunctionTask | None = None, kind: str = "four-bar", **limits: Any) -> Problem:
    return Problem(
        task=task or FunctionTask.from_degrees(*PAIRS),
        requirements=replace(FREE, **limits),
        mechanism=kind,
        driver=CylinderSpec() if task is not None and task.lengthens else None,
    )


def joints(linkage: FourBar, theta2: FloatArray) -> tuple[Any, Any]:
    """A and B, by the intersection of circles about A and O4."""
    o4 = complex(*linkage.o4)
    a = complex(*linkage.o2) + linkage.r2 * np.exp(1j * theta2)
    way = o4 - a
    along = (linkage.r3**2 + abs(way) ** 2 - linkage.r4**2) / (2 * abs(way))
    beside = np.sqrt(np.maximum(linkage.r3**2 - along**2, 0.0))
    return a, a + (along + 1j * linkage.assembly * beside) * way / abs(way)


def turned(linkage: FourBar, theta2: FloatArray, of: str) -> FloatArray:
    """Rate of the coupler or the output by the driver, by differences."""
    step, found = 1e-6, []
    for way in (-1, 1):
        a, b = joints(linkage, theta2 + way * step)
        found.append(b - a if of == "coupler" else b - complex(*linkage.o4))
    rate: FloatArray = np.angle(found[1] / found[0]) / (2 * step)
    return rate


def figure(name: str, linkage: FourBar, theta2: FloatArray) -> FloatArray:
    """What is limited, at driver angles."""
    (a, b), o4 = joints(linkage, theta2), complex(*linkage.o4)
    mu = np.abs(np.angle((b - a) / (b - o4)))
    rate = turned(linkage, theta2, "coupler")
    return {
        "a": lambda: a.real,
        "b": lambda: b.imag,
        # the coupler turns about it: no velocity
        "instant_centre": lambda: (a - linkage.r2 * np.exp(1j * theta2) / rate).real,
        "distances": lambda: np.abs(a - o4),
        "past_deg": lambda: np.degrees(np.abs(np.arcsin(((b - a) * np.exp(-1j * theta2)).imag / linkage.r3))),
        "coupler_angle_deg": lambda: np.degrees(np.angle(b - a)) % 360,
        "coupler_rate": lambda: rate,
        "transmission_min_deg": lambda: np.degrees(np.minimum(mu, np.pi - mu)),
        "mechanical_advantage_min": lambda: 1 / np.abs(turned(linkage, theta2, "output")),
    }[name]()


def beyond(name: str, value: float) -> tuple[Any, tuple[float, float]]:
    """A limit that a value misses, and what it allows."""
    more = {"a": 0.1, "b": 0.1, "instant_centre": 0.3, "distances": 0.05, "coupler_angle_deg": 3.0}
    low = value + more.get(name, 0.15)
    if name in ("a", "instant_centre"):
        return Box(x=(low, np.inf)), (low, np.inf)
    if name == "b":
        return Box(y=(low, np.inf)), (low, np.inf)
    if name == "distances":
        return {"a-o4": (low, 1e6)}, (low, np.inf)
    if name == "coupler_angle_deg":
        return (low - 360 * (low > 180), low - 360 * (low > 180) + 40), (low, low + 40)
    if name == "coupler_rate":
        return (low, low + 1), (low, low + 1)
    if name == "past_deg":
        return (2, 5), (2, 5)
    least = value + 10 if name == "transmission_min_deg" else 1.2 * value
    return least, (least, np.inf)


NAMES = (
    "a", "b", "instant_centre", "distances", "past_deg", "coupler_angle_deg", "coupler_rate",
    "transmission_min_deg", "mechanical_advantage_min",
)  # fmt: skip


@pytest.fixture(scope="module")
def free() -> Candidate:
    found = synthesize(problem(**GROUND), seed=0, enough=1).candidates
    return min(found, key=lambda each: each.verdict.square)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_designs_keep_limits_at_a_pair_that_bind(name: str, free: Candidate) -> None:
    values = figure(name, free.linkage, free.verdict.theta2)
    k = int(values.argmin()) if name == "transmission_min_deg" else len(values) - 1
    stated, (low, high) = beyond(name, float(values[k]))
    limits = (TargetLimits(targets=[k + 1], **{name: stated}),)
    bound = problem(**GROUND, at=limits)
    missed = verify(free.linkage, bound.task, bound.requirements, problem=bound)
    result = synthesize(bound, seed=0)
    assert len(result) > 0
    best = min(each.verdict.square for each in result.candidates)
    assert best > free.verdict.square * (1 + 1e-9)
    assert missed.square == pytest.approx(free.verdict.square, rel=1e-6) or missed.square >= best * (1 - 1e-6)
    for each in result.candidates:
        there = figure(name, each.linkage, each.verdict.theta2)[k]
        assert low - 1e-6 <= there <= high + 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("name", ["a", "b", "distances", "coupler_angle_deg", "coupler_rate"])
def test_designs_keep_limits_at_all_pairs_or_along_the_motion(name: str, free: Candidate) -> None:
    pairs = name in ("a", "b", "distances")

    def places(each: Candidate) -> FloatArray:
        theta2 = each.verdict.theta2
        return figure(name, each.linkage, theta2 if pairs else np.linspace(*theta2[[0, -1]], 401))

    low = float(places(free).min()) + {"coupler_angle_deg": 2.0}.get(name, 0.05)
    edge = {"a": Box(x=(low, np.inf)), "b": Box(y=(low, np.inf)), "distances": {"a-o4": (low, 1e6)}}
    stated = edge.get(name, (low - 360 * (low > 180), low - 360 * (low > 180) + 200))
    if name == "coupler_rate":
        stated = (low, 50)
    result = synthesize(problem(**GROUND, **{name: stated}), seed=0)
    assert len(result) > 0
    assert min(each.verdict.square for each in result.candidates) > free.verdict.square
    for each in result.candidates:
        assert places(each).min() >= low - 1e-6


@pytest.mark.slow
def test_the_least_error_is_found_where_places_leave_little_room() -> None:
    task = FunctionTask(
        [0, 0.142, 1.466, 2.295, 2.848, 3.244, 3.722, 4.117],
        [0, 0.001, 0.383, 0.639, 0.791, 0.812, 0.83, 0.777],
    )
    at = (
        TargetLimits(targets=[1], a=Box(x=(0.554, np.inf))),
        TargetLimits(targets=[8], b=Region(inside=[(0.34, 0.51), (0.9, -0.71), (1.93, 0.17)])),
    )
    near = {"o2": Box((-0.093, 0.093), (-0.093, 0.093)), "o4": Box((0.907, 1.093), (-0.093, 0.093))}
    aims = FunctionAims.of(ScaledProblem.of(problem(task, **near, at=at)))
    begun = [(each, each.starts(each.rough(np.random.default_rng(0), 1))) for each in Optima.each(aims)]
    least = min(each.error for each in optima(begun, few=False))
    assert least == pytest.approx(0.114399, rel=1e-3)  # by `scripts/benchmarks/independent_search.py`


@pytest.mark.slow
def test_designs_keep_leverage_ratios_that_bind(free: Candidate) -> None:
    task, k = free.problem.task, 4
    low = float(turned(free.linkage, free.verdict.theta2[k], "output")) + 0.1
    limited = FunctionTask(task.inputs, task.outputs, rates=[(task.inputs[k], low, low + 1)])
    result = synthesize(problem(limited), seed=0)
    assert len(result) > 0
    assert min(each.verdict.square for each in result.candidates) > free.verdict.square
    for each in result.candidates:
        assert low - 1e-6 <= turned(each.linkage, each.verdict.theta2[k], "output") <= low + 1 + 1e-6


CASES: dict[str, tuple[FunctionTask, str]] = {
    "output": (FunctionTask.from_degrees(*PAIRS), "four-bar"),
    "coupler": (FunctionTask.from_degrees(*PAIRS, link="coupler"), "four-bar"),
    "block": (FunctionTask.from_degrees(*PAIRS), "inverted-slider-crank"),
    "slide": (FunctionTask.from_degrees(PAIRS[0], output=[0, 2, 5, 6, 8, 9]), "slider-crank"),
}


def stated_of(kind: str) -> dict[str, Any]:
    """Limits of every kind that linkages of a kind have."""
    single: dict[str, Any] = {"a": Box(x=(0.5, 2)), "coupler_angle_deg": (-20, 70), "coupler_rate": (-1, 2)}
    if kind != "inverted-slider-crank":
        single |= {"b": Region(inside=[[0, 0], [4, 1], [1, 4]]), "past_deg": (2, 5)}
    if kind == "four-bar":
        single |= {
            "instant_centre": Box(y=(0, 1)),
            "transmission_min_deg": 50,
            "mechanical_advantage_min": 2,
            "distances": {"a-o4": (2, 3)},
        }
    return {
        "at": (TargetLimits(targets=[1, 4], **single),),
        "a": Box(y=(-1, 1)),
        "coupler_angle_deg": (-30, 60),
        "o2": Box(x=(-0.1, 0.2)),
    }


def started(which: str) -> tuple[FunctionAims, Optima, Any]:
    task, kind = CASES[which]
    aims = FunctionAims.of(ScaledProblem.of(problem(task, kind, **stated_of(kind))))
    search = Optima.each(aims)[-1]
    places = search.limits.places
    assert isinstance(places, PlaceLimits)
    near = function_starts(aims.kind, search.desired, np.random.default_rng(0))
    batch = places.placed(near[np.linspace(0, len(near) - 1, 150).astype(int)].finite)
    value = places.rows(batch).value
    return aims, search, batch[np.isfinite(value).all(axis=1)][:60]


@pytest.mark.quick("output")
@pytest.mark.parametrize("which", CASES)
def test_rows_have_the_derivatives_of_differences(which: str) -> None:
    _, search, batch = started(which)
    places = search.limits.places
    assert isinstance(places, PlaceLimits)
    rows, step = places.rows(batch), 1e-6
    for k in range(batch.UNKNOWNS):
        ends = []
        for way in (1, -1):
            shape = batch.shape.copy()
            shape[:, k] += way * step
            ends.append(places.rows(batch.changed(shape)).value)
        slope = (ends[0] - ends[1]) / (2 * step)
        held = batch.PLACE.start <= k < batch.PLACE.stop and not places.free[k - batch.PLACE.start]
        off = np.abs(slope * (not held) - rows.slope[..., k]) / (1 + np.abs(slope))
        assert np.nanquantile(off, 0.95) < 1e-4


@pytest.mark.quick("output")
@pytest.mark.parametrize("which", CASES)
def test_rows_agree_with_the_judge_on_what_is_missed(which: str) -> None:
    aims, search, batch = started(which)
    task, wanted = aims.task, aims.problem.requirements
    places, agreed = search.limits.places, 0
    assert isinstance(places, PlaceLimits)
    for k in range(len(batch)):
        made: Linkage = aims.linkage(batch[k : k + 1], search.driver)
        theta2 = (
            aims.kind.direction(search.aims.wanted)
            if not batch.PLACE.stop
            else batch.shape[k, batch.PLACE][3]
        )
        start = theta2 + search.driver * (batch.first[k] + 0.0)
        verdict = verify(made, task, replace(wanted, theta2_start_deg=float(np.degrees(start)) % 360))
        misses = {each.requirement for each in verdict.defects} & {"at", "a", "coupler_angle_deg", "o2"}
        least = float(places.rows(batch[k : k + 1]).value.min())
        if np.isfinite(verdict.square) and abs(least) > 1e-4:
            assert bool(misses) == (least < 0)
            agreed += 1
    assert agreed > 10


def test_the_driver_begins_where_limits_are_kept() -> None:
    linkage = FourBar((0, 0), (1, 0), 0.6, 1.4, 1.1)
    task = FunctionTask.from_degrees([0, 30, 60, 90], [0, 9, 25, 47])
    free = verify(linkage, task, FREE)
    least = float(joints(linkage, free.theta2)[0][0].real) + 0.01
    for edge, ok in ((least, True), (5.0, False)):
        at = (TargetLimits(targets=[1], a=Box(x=(edge, np.inf))),)
        verdict = verify(linkage, task, replace(FREE, at=at))
        assert [each.requirement for each in verdict.defects] == ([] if ok else ["at"])
        if ok:
            assert joints(linkage, verdict.theta2)[0][0].real == pytest.approx(edge, abs=1e-8)
            assert verdict.square > free.square
        else:
            assert verdict.square == pytest.approx(free.square)
    k, at_pair = 2, float(turned(linkage, free.theta2[2], "output"))
    for low, ok in ((at_pair + 0.001, True), (at_pair + 5, False)):
        limited = FunctionTask(task.inputs, task.outputs, rates=[(task.inputs[k], low, low + 1)])
        verdict = verify(linkage, limited, FREE)
        assert [each.requirement for each in verdict.defects] == ([] if ok else ["function.rate"])
        if ok:
            assert turned(linkage, verdict.theta2[k], "output") == pytest.approx(low, abs=1e-8)
    fixed = (TargetLimits(targets=[1], a=Box(x=(least, least))),)  # kept at single places between those tried
    assert verify(linkage, task, replace(FREE, at=fixed)).ok
