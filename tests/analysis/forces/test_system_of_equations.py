"""The nine equations solved at once against the same solved in order, and against published figures."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    Body,
    Friction,
    Joint,
    Loads,
    Masses,
    Spring,
    TorsionSpring,
    driver_ranges,
    given_masses,
    inverse_dynamics,
    solve_kinematics,
    system_of_equations,
    uniform_bars,
)
from grashof.problems import DeadPositionWarning, FourBar

TURN = 2 * np.pi
FORCES = ("f12", "f32", "f43", "f14")
Array = npt.NDArray[np.float64]


def solved_in_order(found: Any) -> Array:
    parts = [*(getattr(found, name) for name in FORCES), found.torque[..., None]]
    return np.concatenate(parts, axis=-1)


def random_linkage(rng: np.random.Generator) -> FourBar:
    """Of any kind, somewhere in the plane, on either assembly."""
    lengths = rng.uniform(0.5, 5, 3)
    base = rng.uniform(-20, 20, 2)
    return FourBar(
        base, base + rng.uniform(-3, 3, 2), *lengths, coupler_point=rng.uniform(-2, 2, 2),
        assembly=rng.choice([-1.0, 1.0]),
    )  # fmt: skip


def random_bodies(rng: np.random.Generator) -> Masses:
    """Centres off the bars; a link in four has no mass."""
    heavy = rng.random(3) > 0.25
    return Masses(*(Body(rng.uniform(0, 5) * m, rng.uniform(0, 5) * m, rng.uniform(-2, 2, 2)) for m in heavy))


def random_loads(rng: np.random.Generator, radius: float) -> Loads:
    """Loads of every type."""

    def pair() -> Any:
        return tuple(rng.uniform(-2, 2, 2))

    sway = rng.uniform(-9, 9, 2)
    return Loads(
        gravity=rng.uniform(-10, 10, 2),
        forces=(
            *(AppliedForce(link, pair(), pair(), turning=bool(link % 2)) for link in (2, 3, 4)),
            AppliedForce(3, pair(), lambda state: sway * np.cos(state.theta4)[..., None]),
        ),
        moments=tuple(AppliedMoment(link, rng.uniform(-5, 5)) for link in (2, 3, 4)),
        springs=(
            Spring(1, pair(), 4, pair(), rng.uniform(0, 5), 1.3, rng.uniform(0, 2)),
            Spring(2, pair(), 3, pair(), rng.uniform(0, 5)),
        ),
        torsion_springs=tuple(
            TorsionSpring(joint, rng.uniform(0, 5), rng.uniform(-3, 3)) for joint in list(Joint)[:4]
        ),
        friction=Friction(rng.uniform(0, 2, 4), rng.uniform(0, 2, 4), radius),
    )  # fmt: skip


@pytest.mark.quick("0.0")
@pytest.mark.parametrize("pins", [0.0, 0.01])
@pytest.mark.filterwarnings("ignore::grashof.problems.DeadPositionWarning")
def test_both_ways_agree_on_random_linkages_and_loads(pins: float) -> None:
    rng = np.random.default_rng(14)
    judged = 0
    for _ in range(60):
        linkage = random_linkage(rng)
        masses, loads = random_bodies(rng), random_loads(rng, pins)
        state = solve_kinematics(linkage, np.linspace(0, TURN, 24), rng.uniform(-3, 3), rng.uniform(-3, 3))
        expected = solved_in_order(inverse_dynamics(state, masses, loads))
        solution = system_of_equations(state, masses, loads).solution
        # Near a dead position both lose digits, as rounding of the position is amplified.
        clear = np.isfinite(expected).all(axis=-1) & (np.abs(np.sin(state.theta4 - state.theta3)) > 1e-3)
        size = np.abs(expected[clear]).max(axis=-1, keepdims=True) if clear.any() else 1.0
        np.testing.assert_allclose(solution[clear] / size, expected[clear] / size, rtol=0, atol=1e-10)
        assert np.isnan(solution[~np.isfinite(state.theta3)]).all()
        judged += int(clear.sum())
    assert judged > 400


def test_reference_figures_of_the_luggage(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    bag, linkage = golden["bag_mechanism_exact"], golden_linkages["table7"]
    masses = given_masses(linkage, [float(m) for m in bag["masses"]], [float(i) for i in bag["inertias"]])
    for expected in golden["table7_lengths_theta1_0"]["states"]:
        state = solve_kinematics(linkage, np.radians(float(expected["theta2_deg"])))
        system = system_of_equations(state, masses)
        solution = dict(zip(system.UNKNOWNS, system.solution, strict=True))
        torque = float(expected["T(g=0)"])
        assert solution["T12"] == pytest.approx(torque, rel=1e-9, abs=1e-9)
        for name in ("F12", "F32", "F43", "F14"):
            force = [float(part) for part in expected[f"{name}(g=0)"]]
            limit = 1e-9 * max(1.0, *map(abs, force))
            assert [solution[f"{name}x"], solution[f"{name}y"]] == pytest.approx(force, rel=1e-9, abs=limit)


def test_the_rows_are_those_of_the_textbook() -> None:
    """Link 2 of a linkage at rest, written out: arms from its centre to O2 and A."""
    linkage = FourBar(o2=(1, 2), o4=(5, 2), r2=1, r3=4, r4=3)
    masses = given_masses(linkage, (2, 3, 4), (1, 1, 1), [(0.25, 0.0), (2, 0), (1.5, 0)])
    system = system_of_equations(solve_kinematics(linkage, np.pi / 2, 0.0), masses, Loads(gravity=(0, -10)))
    assert len(system.EQUATIONS) == len(system.UNKNOWNS) == 9
    assert system.matrix[:3].round(12).tolist() == [
        [1, 0, 1, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, 1, 0, 0, 0, 0, 0],
        [0.25, 0, -0.75, 0, 0, 0, 0, 0, 1],
    ]
    assert system.right_side.round(12).tolist() == [0, 20, 0, 0, 30, 0, 0, 40, 0]


def test_dead_and_open_positions_have_no_solution() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    end = driver_ranges(rocker)[0, 1]
    with pytest.warns(DeadPositionWarning):
        state = solve_kinematics(rocker, [0.0, end, 3.0])
    for masses in (uniform_bars(rocker, 2.0), Masses(Body(0), Body(0), Body(0))):
        solution = system_of_equations(state, masses, Loads(gravity=(0, -9.81))).solution
        np.testing.assert_array_equal(np.isfinite(solution).all(axis=-1), [True, False, False])


def test_a_batch_is_its_linkages() -> None:
    batch = FourBar(o2=(0, 0), o4=(4, 1), r2=[[1.0], [0.8]], r3=4, r4=3, coupler_point=(1, 2))
    masses = uniform_bars(batch, 2.0, payload=1.0)
    system = system_of_equations(solve_kinematics(batch, np.linspace(0, 6, 5)), masses)
    assert system.matrix.shape == (2, 5, 9, 9)
    alone = batch[1, 0]
    state = solve_kinematics(alone, np.linspace(0, 6, 5))
    expected = solved_in_order(inverse_dynamics(state, uniform_bars(alone, 2.0, payload=1.0)))
    np.testing.assert_allclose(system.solution[1], expected, atol=1e-11 * np.abs(expected).max())
