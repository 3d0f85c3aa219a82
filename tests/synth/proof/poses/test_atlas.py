"""Regions: every linkage that transmits enough is in one of them, and each has its best in the list."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from proof_problems import planted

from grashof import load, synthesize
from grashof.analysis import solve_position
from grashof.problems import FourBar
from grashof.synth import Claim, Result
from grashof.synth.proof.claims.bounds import Proving
from grashof.synth.proof.poses.atlas import Atlas, atlas_of
from grashof.synth.proof.provers import bounds_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.dyad_pairs import screen
from grashof.synth.theory.burmester import trace_four_pose_curves

PROBLEMS = {"luggage": load("luggage")} | {
    f"planted {seed}": planted(seed, transmission_over="cycle") for seed in (0, 3, 7)
}


@cache
def atlas(name: str) -> Atlas:
    scaled = ScaledProblem.of(PROBLEMS[name])
    bounds = bounds_of(scaled, Proving())
    assert bounds is not None
    made = atlas_of(scaled, bounds)
    assert made is not None
    return made


@pytest.mark.quick("luggage")
@pytest.mark.parametrize("name", PROBLEMS)
def test_linkages_of_another_search_lie_in_regions(name: str) -> None:
    problem, made = PROBLEMS[name], atlas(name)
    scaled = ScaledProblem.of(problem)
    assert scaled.motion is not None
    traced = trace_four_pose_curves(scaled.motion, 30.0, 400, 0.02)
    found = screen(scaled.motion, complex(scaled.targets[0]), traced, scaled.wanted, 400_000)
    best = made.linkages.transmission.max()
    least = max(0.5 * best, float(np.radians(problem.requirements.transmission_min_deg)))
    found = found[found.transmission > 1.02 * least]
    found = found[:: max(1, len(found) // 500)]
    assert len(found) > 20
    here, there = found.points[:, :4], made.linkages.points[:, :4]
    for one in here:
        apart = np.abs(there - one).max(axis=1)
        assert apart.min() <= 4 * made.size


def test_linkages_of_regions_meet_the_requirements() -> None:
    made = atlas("planted 7")
    assert made.linkages.feasible.all()
    best = [made.linkages.transmission[made.region == number].max() for number in range(1, made.count + 1)]
    assert best == sorted(best, reverse=True)


@pytest.fixture(scope="module")
def several() -> Result:
    return synthesize(PROBLEMS["planted 7"])


@pytest.mark.slow
def test_the_list_has_the_best_of_every_region(several: Result) -> None:
    assert several.proof is not None
    assert several.proof.claim is Claim.BEST
    listed = {one.region for one in several.candidates} - {0}
    assert listed == set(range(1, several.proof.regions + 1))
    made = atlas("planted 7")
    for number in listed:
        seen = made.linkages.transmission[made.region == number].max()
        best = max(one.values["transmission_min_cycle"] for one in several.candidates if one.region == number)
        assert best >= seen - 1e-3


@pytest.mark.slow
def test_the_joints_of_listed_designs_lie_on_the_curves_that_are_drawn(several: Result) -> None:
    loci, size = several.loci, several.problem.task.size
    assert loci is not None

    def apart(point: np.ndarray, ends: np.ndarray) -> float:
        """From the nearest piece, sizes."""
        start, step = ends[:, 0], ends[:, 1] - ends[:, 0]
        share = np.clip(((point - start) * step).sum(1) / np.maximum((step**2).sum(1), 1e-300), 0, 1)
        return float(np.linalg.norm(point - start - share[:, None] * step, axis=1).min()) / size

    for one in several.candidates:
        if one.region:
            state = solve_position(one.linkage, one.verdict.theta2[0], one.verdict.assembly[0])
            linkage = one.linkage
            assert isinstance(linkage, FourBar)
            assert max(apart(point, loci.ground) for point in (linkage.o2, linkage.o4)) < 0.1
            assert max(apart(point, loci.moving) for point in (state.a, state.b)) < 0.1
    assert loci.transmission.max() <= several.best.values["transmission_min_cycle"] + 1e-3


@pytest.mark.slow
def test_the_seed_changes_nothing(several: Result) -> None:
    again = synthesize(PROBLEMS["planted 7"], seed=7)
    assert [one.id for one in again.candidates] == [one.id for one in several.candidates]


def test_a_constraint_of_ones_own_is_kept() -> None:
    problem = load("luggage")
    found = synthesize(problem, constraints=[lambda design: design.r1 - design.r3 + 1.0], enough=10)
    assert found.candidates
    assert all(one.linkage.r1 - one.linkage.r3 + 1.0 <= 1e-9 for one in found.candidates)  # type: ignore[attr-defined]


def test_requirements_without_a_form_are_kept() -> None:
    problem = load("luggage")
    wanted = replace(problem.requirements, size=(0.0, 12.5))
    found = synthesize(replace(problem, requirements=wanted), enough=10)
    assert found.candidates
    assert max(one.values["size"] for one in found.candidates) <= 12.5 * (1 + 1e-9)
    assert found.proof is not None
    assert found.proof.left_out == ("size",)
