"""From pivots in the frame of the search back to linkages."""

from collections.abc import Callable
from dataclasses import fields

import numpy as np
import pytest

from grashof.analysis import solve_position
from grashof.problems import FourBar, ProblemError
from grashof.problems.values.arrays import ComplexArray
from grashof.synth.quantities.scaled_problem import ScaledProblem

PlantedSetup = Callable[..., tuple[ScaledProblem, FourBar]]


def pivots_of(scaled: ScaledProblem, linkage: FourBar) -> ComplexArray:
    """O2, O4, and A, B, P at the first pose, from the body's place and the coupler's numbers."""
    task, frame = scaled.problem.task, scaled.frame
    coupler = np.exp(1j * (task.angles[0] - float(linkage.body_angle)))
    p = complex(*task.positions[0])
    a = p - complex(*linkage.coupler_point) * coupler
    every = np.array([complex(*linkage.o2), complex(*linkage.o4), a, a + float(linkage.r3) * coupler, p])
    return (every - frame.origin) / frame.scale


@pytest.mark.parametrize("seed", range(10))
def test_the_planted_linkage_comes_back_from_its_pivots(planted_scaled: PlantedSetup, seed: int) -> None:
    scaled, linkage = planted_scaled(seed)
    back = scaled.linkages(pivots_of(scaled, linkage), linkage.assembly)
    for name in ("o2", "o4", "r2", "r3", "r4", "coupler_point", "assembly"):
        np.testing.assert_allclose(
            getattr(back, name), getattr(linkage, name), rtol=1e-11, atol=1e-11 * scaled.frame.scale
        )
    assert abs(np.exp(1j * float(back.body_angle)) - np.exp(1j * float(linkage.body_angle))) < 1e-12


@pytest.mark.parametrize("seed", range(5))
def test_displacements_carry_the_body_and_the_dyads(planted_scaled: PlantedSetup, seed: int) -> None:
    scaled, linkage = planted_scaled(seed)
    targets = scaled.frame.inward(scaled.problem.task.positions)
    np.testing.assert_allclose(scaled.motion.apply(np.array([scaled.targets[0]]))[0], targets, atol=1e-12)
    o2, _, a, b, _ = pivots_of(scaled, linkage)
    places = scaled.motion.apply(np.array([a, b]))
    theta2 = np.angle(places[0] - o2)
    state = solve_position(linkage, theta2)
    np.testing.assert_allclose(scaled.frame.inward(state.a), places[0], atol=1e-9)
    np.testing.assert_allclose(scaled.frame.inward(state.b), places[1], atol=1e-9)


def test_a_batch_is_its_members(planted_scaled: PlantedSetup) -> None:
    scaled, linkage = planted_scaled(0)
    one = pivots_of(scaled, linkage)
    other = one + np.array([0.1, -0.2j, 0.3, 0.1j, 0.2])
    batch = scaled.linkages(np.array([one, other]), np.array([1.0, -1.0]))
    assert batch.shape == (2,)
    for member, points, assembly in ((batch[0], one, 1.0), (batch[1], other, -1.0)):
        alone = scaled.linkages(points, np.array(assembly))
        # NumPy rounds complex products of arrays and of single numbers differently.
        for field in fields(FourBar):
            np.testing.assert_allclose(getattr(member, field.name), getattr(alone, field.name), rtol=1e-13)


def test_coinciding_joints_are_refused(planted_scaled: PlantedSetup) -> None:
    scaled, linkage = planted_scaled(0)
    points = pivots_of(scaled, linkage)
    points[2] = points[0]
    with pytest.raises(ProblemError, match="r2"):
        scaled.linkages(points, np.array(1.0))
