"""Functions driven by a cylinder: pairs and lengths of listed designs by circles that meet."""

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import driver_ranges, verify
from grashof.problems import (
    Box,
    Cylinder,
    CylinderSpec,
    FourBar,
    FunctionTask,
    Problem,
    Requirements,
)
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Candidate, Claim, prove, synthesize
from grashof.synth.search.plain import plain, restored

BUCKET = Problem(
    task=FunctionTask.from_degrees([0, 45, 90], [0, 62, 150]),
    length_unit="mm",
    requirements=Requirements(
        o2=Box((0, 0), (0, 0)),
        o4=Box((420, 420), (0, 0)),
        link_length=(250, 700),
        transmission_min_deg=25,
        rotatability="any",
    ),
    driver=CylinderSpec(closed=(600, 1100), on=["driver"], base=Box((-1500, -500), (0, 400))),
)


def by_circles(linkage: FourBar, theta2: FloatArray) -> FloatArray:
    """theta4 of a four-bar: circles about A and O4 meet in B, on the side that `assembly` states."""
    o2, o4 = complex(*linkage.o2), complex(*linkage.o4)
    a = o2 + linkage.r2 * np.exp(1j * theta2)
    far, between = np.abs(o4 - a), (o4 - a) / np.abs(o4 - a)
    foot = (far**2 + linkage.r3**2 - linkage.r4**2) / (2 * far)
    beside = np.sqrt(linkage.r3**2 - foot**2)
    both = [np.angle(a + between * (foot + 1j * side * beside) - o4) for side in (1, -1)]
    turns = [np.sin(theta4 - np.angle(o4 + linkage.r4 * np.exp(1j * theta4) - a)) for theta4 in both]
    (kept,) = (
        theta4 for theta4, sine in zip(both, turns, strict=True) if (np.sign(sine) == linkage.assembly).all()
    )
    return np.unwrap(kept)


def check(each: Candidate, problem: Problem, within: float) -> None:
    """Pairs, and the cylinder's lengths by the law of cosines, without the judge."""
    verdict, linkage, jack = each.verdict, each.linkage, each.verdict.cylinder
    assert isinstance(linkage, FourBar)
    assert jack is not None
    assert jack.on == "driver"
    assert problem.driver is not None
    theta2 = verdict.theta2
    turned = verdict.direction * (theta2 - theta2[0])
    np.testing.assert_allclose(turned, problem.task.driver_turns, atol=1e-12)
    output = verdict.direction * by_circles(linkage, theta2)
    off = output - problem.task.outputs
    assert np.ptp(off) <= 2 * within
    every = np.linspace(theta2[0], theta2[-1], 401)
    out, arm = np.array(jack.base) - np.array(linkage.o2), np.hypot(*jack.point)
    at_o2 = every + np.arctan2(jack.point[1], jack.point[0]) - np.arctan2(out[1], out[0])
    length = np.sqrt(arm**2 + out @ out - 2 * arm * np.hypot(*out) * np.cos(at_o2))
    step = np.diff(length)
    assert (step > 0).all() or (step < 0).all()
    assert each.values["cylinder_closed"] == pytest.approx(length.min(), rel=1e-9)
    assert each.values["cylinder_stroke"] == pytest.approx(np.ptp(length), rel=1e-9)
    low, high = problem.driver.closed or (0.0, np.inf)
    assert low <= length.min() <= high
    assert length.max() <= problem.driver.ratio_max * length.min()
    slope = np.gradient(length) / np.gradient(by_circles(linkage, every))
    assert each.values["cylinder_rate_start"] == pytest.approx(abs(slope[0]), rel=0.05)
    assert each.values["cylinder_rate_min"] <= np.abs(slope[1:-1]).min() * (1 + 1e-3)


def planted(seed: int) -> tuple[FourBar, FunctionTask, CylinderSpec]:
    """A random four-bar that swings, three of its pairs by circles, and limits of its cylinder."""
    rng = np.random.default_rng(seed)
    while True:
        r1, r2, r3, r4 = rng.uniform(1, 3, 4)
        linkage = FourBar((0, 0), (r1, 0), r2, r3, r4, assembly=int(rng.choice([-1, 1])))
        low, high = driver_ranges(linkage)[0]
        if high - low < 1.2:
            continue
        theta2 = low + 0.1 + np.cumsum([0.0, *rng.uniform(0.25, 0.5, 2)])
        theta4 = by_circles(linkage, theta2)
        if np.ptp(theta4) > 0.2:
            task = FunctionTask(theta2 - theta2[0], theta4 - theta4[0])
            return linkage, task, CylinderSpec(ratio_max=1.7, on=["driver"])


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_planted_functions_are_found_with_cylinders_that_drive(seed: int) -> None:
    linkage, task, spec = planted(seed)
    wanted = Requirements(
        rotatability="any", o2=Box((0, 0), (0, 0)), o4=Box((linkage.r1, linkage.r1), (0, 0))
    )
    problem = Problem(task=task, requirements=wanted, driver=spec)
    found = synthesize(problem, enough=3, starts=24)
    assert len(found)
    for each in found.candidates:
        check(each, problem, 1e-6)


@pytest.mark.slow
def test_a_bucket_has_its_cylinder_in_the_list_and_from_plain_text() -> None:
    found = synthesize(BUCKET, enough=3, starts=24)
    assert len(found)
    for each in found.candidates:
        check(each, BUCKET, 1e-6)
    again = restored(plain(found.best), BUCKET)
    assert again.verdict.cylinder == found.best.verdict.cylinder
    jack = found.best.verdict.cylinder
    assert jack is not None
    asked = found.best.linkage, BUCKET.task, BUCKET.requirements
    assert verify(*asked, problem=BUCKET, cylinder=jack).ok
    for other in (None, replace(jack, base=(-1501.0, jack.base[1])), Cylinder("driver", jack.base, (0, 0))):
        verdict = verify(*asked, problem=BUCKET, cylinder=other)
        assert {each.requirement.split(".base")[0] for each in verdict.defects} >= {"driver.cylinder"}


@pytest.mark.slow
@pytest.mark.quick("rms")
@pytest.mark.parametrize("norm", ["rms", "max"])
def test_laws_err_as_without_a_cylinder(norm: str) -> None:
    ranges = {"input_range_deg": 60, "output_range_deg": 90}
    task = FunctionTask.from_degrees(law="log10", x=(1, 2), norm=norm, **ranges)  # type: ignore[arg-type]
    wanted = Requirements(rotatability="any")
    free, driven = (
        synthesize(Problem(task=task, requirements=wanted, driver=spec), starts=6)
        for spec in (None, CylinderSpec(on=["driver"]))
    )
    key = f"structural_error_{norm}"
    assert driven.best.values[key] == pytest.approx(free.best.values[key], rel=1e-6)
    assert all(each.verdict.cylinder is not None for each in driven.candidates)


@pytest.mark.slow
@pytest.mark.quick("5")
@pytest.mark.parametrize("count", [3, 5])
def test_no_proof_covers_it(count: int) -> None:
    pairs = [0, 15, 30, 45, 60][:count], [0, 18, 40, 63, 90][:count]
    problem = replace(BUCKET, task=FunctionTask.from_degrees(*pairs))
    found = prove(problem)
    assert found.claim is Claim.REFUSED
    assert found.why.endswith("of none driven by a cylinder")


def test_it_comes_back_from_its_file() -> None:
    again = problem_of(problem_toml(BUCKET), "text", BUCKET.name)
    assert again.driver == BUCKET.driver
    assert problem_toml(again) == problem_toml(BUCKET)
