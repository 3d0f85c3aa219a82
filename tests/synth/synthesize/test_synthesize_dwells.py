"""Dwells from the problem to the list: each design closed again in body coordinates, round the turn."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from body_coordinates import follow, start
from body_plans import plan_of

import grashof.synth.starts.six_bars.dwells as dwells_module
from grashof.analysis import verify
from grashof.problems import Box, DwellTask, Manufacturing, Problem, Requirements, SixBar
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.tasks.dwell_task import USUAL_TOLERANCE
from grashof.synth import Result, synthesize
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.plain import plain, restored
from grashof.synth.starts.closed_loop import Batch
from grashof.synth.starts.six_bars.dwell_search import drawn, fitted
from grashof.synth.starts.six_bars.dwells import FEW, Dwells

STEPS = 720
WANTED = Requirements(transmission_min_deg=40, link_ratio_max=10)
TASKS = {
    "swing": DwellTask.from_degrees(dwell_deg=90, swing_deg=45),
    "stroke": DwellTask.from_degrees(dwell_deg=90, stroke=80),
}


@pytest.fixture(scope="module", params=[pytest.param(name, marks=pytest.mark.slow) for name in TASKS])
def found(request: pytest.FixtureRequest) -> Result:
    problem = Problem(
        task=TASKS[request.param], requirements=WANTED, manufacturing=Manufacturing(0.02), length_unit="mm"
    )
    return synthesize(problem, enough=6)


def _sines(q: np.ndarray, linkages: SixBar) -> np.ndarray:
    """The least sine of the transmission angles of both loops, from body coordinates (N, K, 15)."""
    angle = q[..., 2::3]  # of links 2 to 6
    last = linkages.slide_angle_2 + np.pi / 2 if linkages.mechanism.slides else angle[..., 4]
    both = np.sin([angle[..., 2] - angle[..., 1], last - angle[..., 3]])
    return np.asarray(np.abs(both).min(axis=(0, 1)))


def test_every_design_stands_still_swings_and_transmits(found: Result) -> None:
    assert len(found) >= 6
    linkages = Linkage.stacked([one.linkage for one in found.candidates])
    assert isinstance(linkages, SixBar)
    plan, slides = plan_of(linkages), bool(linkages.mechanism.slides)
    dwells = [one.verdict.dwell for one in found.candidates]
    begins = np.array([each.start for each in dwells if each is not None])
    theta2 = begins + np.arange(STEPS + 1)[:, None] * 2 * np.pi / STEPS
    q = follow(plan, start(plan, begins), begins, theta2)
    np.testing.assert_allclose(np.sin(q[-1] / 2 - q[0] / 2)[..., 2::3], 0, atol=1e-9)  # the turn closes
    assert _sines(q, linkages).min() >= np.sin(np.radians(40)) - 1e-6
    x, y, angle = np.moveaxis(q[..., -3:], -1, 0)
    along = x * np.cos(linkages.slide_angle_2) + y * np.sin(linkages.slide_angle_2) if slides else angle
    unit, whole = (1.0, 80.0) if slides else (np.degrees(1.0), 45.0)
    np.testing.assert_allclose(unit * np.ptp(along, axis=0), whole, rtol=2.5e-4)
    bands = unit * np.ptp(along[: STEPS // 4 + 1], axis=0)
    frame = found.to_frame()
    listed = frame["band" if slides else "band_deg"]
    np.testing.assert_allclose(bands, listed, rtol=1e-3)
    assert listed.min() < (0.016 if slides else 0.008)
    assert (
        frame[["r1", "r2", "r3", "r4", "r5"]].max(axis=1)
        <= 10 * frame[["r1", "r2", "r3", "r4", "r5"]].min(axis=1)
    ).all()


def test_the_list_is_ranked_by_the_band_as_made(found: Result) -> None:
    frame = found.to_frame()
    slides = found.problem.task.stroke is not None
    heads = frame[frame["family"] == frame["id"]]
    made = heads["band_made" if slides else "band_made_deg"]
    assert made.is_monotonic_increasing
    assert (made > heads["band" if slides else "band_deg"]).all()
    filled = {"hosts": "3-1", "point_link": "3", "mechanism": "stephenson-3"}
    for name, value in filled.items():
        assert (frame[name] == value).all()
    own = ["offset_2", "slide_angle_2_deg"] if slides else ["r6", "d_u", "d_v"]
    assert (
        frame[["assembly_2", "c_u", "c_v", "r5", "dwell_from_deg", "dwell_to_deg", *own]]
        .notna()
        .all(axis=None)
    )
    np.testing.assert_allclose(frame["dwell_to_deg"] - frame["dwell_from_deg"], 90, rtol=1e-12)


def test_a_record_keeps_them(found: Result) -> None:
    for one in found.candidates[:3]:
        again: Any = restored(plain(one), found.problem)
        assert again.linkage == one.linkage
        assert again.linkage.mechanism == one.linkage.mechanism
        assert again.verdict.dwell == one.verdict.dwell


@pytest.fixture(scope="module")
def shapes() -> Batch:
    """Of one round, before limits place and scale them."""
    aim = Dwells(ScaledProblem.of(Problem(task=TASKS["swing"], requirements=WANTED))).aim
    return fitted(aim, drawn(aim, np.random.default_rng(1)), USUAL_TOLERANCE, FEW)


@pytest.mark.parametrize(
    "limits",
    [
        {"r1": (100, 100), "o4": Box((200, 210), (100, 110))},
        {"r1": (100, 100), "o2": Box((50, np.inf)), "ground_angle_deg": 30.0},
        {"o2": Box((0, 0), (0, 0)), "o4": Box((30, 31), (40, 41))},
        {"size": (500, 600)},
        {"r6": (40, 50)},
    ],
)
def test_limits_place_and_scale_the_linkage(
    limits: dict[str, Any], shapes: Batch, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dwells_module, "drawn", lambda *_: None)
    monkeypatch.setattr(dwells_module, "fitted", lambda *_: shapes)
    problem = Problem(task=TASKS["swing"], requirements=replace(WANTED, **limits))
    scaled = ScaledProblem.of(problem)
    found = Dwells(scaled).closest_to(scaled, "size", np.random.default_rng(1))
    verdicts = [verify(one, problem.task, problem.requirements) for one in found if isinstance(one, SixBar)]
    assert sum(one.ok for one in verdicts) >= 3


@pytest.mark.slow
def test_a_limited_band_that_no_design_keeps_is_named() -> None:
    task = DwellTask.from_degrees(dwell_deg=180, swing_deg=90, band_deg=1e-4)
    problem = Problem(task=task, requirements=replace(WANTED, transmission_min_deg=35))
    result = synthesize(problem, starts=12)
    assert not result.candidates
    assert any(
        "the output band in the dwell in deg" in each.what
        for one in result.nearest
        for each in one.verdict.defects
    )
