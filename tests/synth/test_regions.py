"""Designs found under regions keep them, also regions of tasks without places and at single targets."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely

from grashof import load, synthesize
from grashof.analysis import solve_position, verify
from grashof.problems import Problem, Region, Requirements, TargetLimits
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.sweep.keys import assigned, key_parts
from grashof.wording.problem import summary


def luggage(**wanted: Any) -> Problem:
    problem = load("luggage")
    return replace(problem, requirements=replace(problem.requirements, **wanted))


def inside(corners: ComplexArray) -> Region:
    return Region(inside=np.column_stack([corners.real, corners.imag]))  # type: ignore[arg-type]


def on(ends: ComplexArray) -> Region:
    return Region(on=np.column_stack([ends.real, ends.imag]))  # type: ignore[arg-type]


def away(region: Region, places: list[FloatArray]) -> float:
    shape = shapely.Polygon(region.corners) if region.on is None else shapely.LineString(region.corners)
    return max(float(shapely.distance(shape, shapely.Point(*place))) for place in places)


# A polygon about the pivots of good designs, one with a notch in its middle, and an edge through them.
BEST_O2 = 3.99874 - 3.91163j
EDGE = on(BEST_O2 + np.array([0.5 - 2j, 1 + 2j]))
NOTCHED = inside(BEST_O2 + np.array([-1 - 1j, 1 - 1j, 1 + 1j, 0.4 + 1j, 0.4 - 0.6j, -1 - 0.6j]))


@pytest.mark.slow
@pytest.mark.parametrize(
    "region",
    [inside(BEST_O2 + np.array([0.2 - 1j, 2, 0.4 + 1j])), NOTCHED, EDGE],
    ids=["polygon", "notched", "segment"],
)
def test_every_design_of_a_list_keeps_a_region(region: Region) -> None:
    result = synthesize(luggage(o2=region), seed=0, starts=60)
    assert len(result) > 5
    beside = away(region, [each.linkage.o2 for each in result.candidates])
    assert beside <= (1e-9 if region.on is None else 1e-6) * load("luggage").task.size


@pytest.mark.slow
def test_a_region_at_one_target_alone_binds_there() -> None:
    first = synthesize(luggage(), seed=0, enough=5).best
    a = complex(*solve_position(first.linkage, first.verdict.theta2).a[0])
    region = inside(a + np.array([0.3 - 3j, 3, 0.3 + 3j]))
    at = (TargetLimits(targets=[1], a=region),)
    best = synthesize(luggage(at=at), seed=0, enough=5).best
    assert away(region, [solve_position(best.linkage, best.verdict.theta2).a[0]]) <= 1e-8
    of = verify(first.linkage, load("luggage").task, Requirements(at=at))
    assert [each.what for each in of.defects if each.requirement == "at"] == [
        "the distance of A from its region at target 1"
    ]


@pytest.mark.quick("quick-return-slide")
@pytest.mark.parametrize("name", ["function-five-pairs", "quick-return", "quick-return-slide"])
def test_a_task_without_places_puts_its_pivot_into_the_region(name: str) -> None:
    triangle = Region(inside=[(10, 5), (14, 5), (10, 9)])
    problem = load(name)
    for region in (triangle, Region(on=[(10, 5), (14, 8)])):
        wanted = replace(problem.requirements, o2=region)
        result = synthesize(replace(problem, requirements=wanted), seed=0, starts=6, enough=4)
        assert len(result) > 0
        assert away(region, [each.linkage.o2 for each in result.candidates]) < 1e-9


def test_resolved_requirements_keep_regions() -> None:
    region = Region(inside=[(0, 0), (4, 0), (0, 4)])
    wanted = Requirements(o2=region)
    assert wanted.resolved(2.0).regions == {"o2": region}
    assert hash(wanted) == hash(Requirements(o2=Region(inside=[(0, 0), (4, 0), (0, 4)])))
    assert wanted != Requirements(o2=Region(inside=[(0, 0), (4, 0), (0, 5)]))


@pytest.mark.slow
def test_no_design_names_the_region_that_is_in_the_way() -> None:
    far = Region(inside=[(0.5, -3), (2, -2), (1, 1)])
    result = synthesize(luggage(o2=far), seed=0, starts=20)
    assert len(result) == 0
    assert "o2 anywhere instead of in its region, such as 2.76 outside" in result.note
    assert any("from its region" in each.what for one in result.nearest for each in one.verdict.defects)


def test_regions_in_words() -> None:
    region, edge = Region(inside=[(0, 0), (4, 0), (0, 4)]), Region(on=[(0, 0), (4, 2)])
    said = summary(luggage(o2=region, a=edge, at=(TargetLimits(targets=[2], b=edge),)))
    unit = load("luggage").length_unit
    assert f"  place of O2: inside a polygon of 3 corners, x 0 to 4, y 0 to 4 {unit}" in said
    assert f"  place of A: on the line from (0, 0) to (4, 2) {unit}" in said
    assert f"  at target 2: B on the line from (0, 0) to (4, 2) {unit}" in said


def test_a_sweep_moves_a_corner() -> None:
    document = {"requirements": {"o2": {"inside": [[0, 0], [4, 0], [1, 2]]}}}
    moved = assigned(document, key_parts("requirements.o2.inside[2][1]"), 3.5)
    assert moved == {"requirements": {"o2": {"inside": [[0, 0], [4, 0], [1, 3.5]]}}}
