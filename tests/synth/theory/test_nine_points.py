"""All four-bars through nine points: planted linkages, and the published count near a circle."""

import doctest
import re
from dataclasses import replace

import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis import verify
from grashof.analysis.judge.planted import planted_path
from grashof.problems import Requirements
from grashof.synth.starts import precision_points
from grashof.synth.theory import nine_points, solutions
from grashof.synth.theory.nine_points import linkages_through
from grashof.synth.theory.point_families import FOUR_BARS
from grashof.synth.theory.solutions import solutions_at
from grashof.synth.theory.stopping import StopRequested


def test_system_vanishes_on_a_planted_linkage():
    task, linkage = planted_path(np.random.default_rng(0), 9)
    verdict = verify(linkage, task, load("nine-points").requirements)
    points = task.points @ [1, 1j]
    o2, o4 = linkage.o2 @ [1, 1j], linkage.o4 @ [1, 1j]
    a = o2 + linkage.r2 * np.exp(1j * verdict.theta2[0])
    turned = (points[0] - a) / complex(*linkage.coupler_point)
    b = a + linkage.r3 * turned
    vectors = np.array([a - o2, o2 - points[0], b - o4, o4 - points[0]])
    unknowns = np.stack([vectors, vectors.conj()], axis=1).ravel()[None]
    steps = points[1:] - points[0]
    parameters = np.concatenate([steps, steps.conj()])[None]
    residual, jacobian, _ = FOUR_BARS.system(unknowns, parameters, np.zeros_like(parameters))
    assert np.abs(residual).max() < 1e-9 * np.abs(jacobian).max()


def test_what_one_run_has_lost_another_finds_and_a_stop_loses_nothing(monkeypatch):
    _, known = FOUR_BARS.known()
    runs = [known[1:], known[:9]]

    def run(*_args):
        if not runs:
            raise StopRequested
        return runs.pop(0)

    monkeypatch.setattr(solutions, "_run", run)
    found = solutions_at(FOUR_BARS, np.zeros(16, complex), np.random.default_rng(0))
    assert (len(found), runs) == (FOUR_BARS.count, [])
    runs = [known[:9]]
    assert len(solutions_at(FOUR_BARS, np.zeros(16, complex), np.random.default_rng(0))) == 9


@pytest.fixture(scope="module")
def planted():
    task, linkage = planted_path(np.random.default_rng([2, 8]), 9)
    return task, linkage, linkages_through(task.points @ [1, 1j], np.random.default_rng(1))[0]


@pytest.mark.slow
def test_planted_linkage_is_among_all_of_them(planted):
    _, linkage, found = planted
    o2, o4 = linkage.o2 @ [1, 1j], linkage.o4 @ [1, 1j]
    o6 = o2 + (o4 - o2) * complex(*linkage.coupler_point) / linkage.r3
    a2, a4, a, b, p = found.T
    every = np.stack([a2, a4, a2 + (a4 - a2) * (p - a) / (b - a)])  # pivots of a triplet, in any order
    gap = np.abs(every[:, :, None] - [o2, o4, o6]).min(axis=0).max(axis=1)
    assert gap.min() < 1e-6


@pytest.fixture(scope="module")
def computed_once():
    """All linkages through the same points are computed but once, wherever the points stand."""
    computed = {}

    def linkages(points, rng):
        along = points[-1] - points[0]
        standing = (points - points[0]) / along
        key = np.round(standing, 6).tobytes()
        if key not in computed:
            computed[key] = linkages_through(standing, rng)
        found, count = computed[key]
        return points[0] + along * found, count

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(precision_points, "linkages_through", linkages)
        yield linkages


@pytest.mark.study
@pytest.mark.usefixtures("computed_once")
def test_points_near_a_circle_have_the_published_21_triplets_and_none_without_defect():
    problem = load("nine-points")
    result = synthesize(problem, enough=200)
    assert result.counts["linkages through the points"] == 63  # Wampler, Morgan & Sommese 1992
    assert len(result) >= 63
    assert all(verify(c.linkage, problem.task, problem.requirements).ok for c in result.candidates)
    assert max(c.verdict.error_max for c in result.candidates) < 1e-9 * problem.task.size
    strict = replace(problem.requirements, order=True, same_branch=True, tolerance=1e-9)
    assert not any(verify(c.linkage, problem.task, strict).ok for c in result.candidates)


@pytest.mark.study
@pytest.mark.usefixtures("computed_once", "small_search")
def test_where_every_linkage_has_a_defect_the_note_says_so_and_the_closest_comes_as_near_as_it_says():
    problem = replace(load("nine-points"), requirements=Requirements(same_branch=True, order=True))
    result = synthesize(problem, starts=40)
    assert "none of the 63 linkages through the points meets all requirements" in result.note
    nearest = next(one for one in result.nearest if "exact" in {d.requirement for d in one.verdict.defects})
    loose = verify(nearest.linkage, problem.task, replace(problem.requirements, exact=False))
    assert loose.ok
    said = re.search(r"comes within (\S+)(?: \w+)? everywhere", result.note)
    assert loose.error_max <= float(said[1]) <= loose.error_max * 1.02


@pytest.mark.slow
def test_the_examples_are_right(computed_once):
    failed, tried = doctest.testmod(nine_points, extraglobs={"np": np, "linkages_through": computed_once})
    assert (failed, tried) == (0, 4)
