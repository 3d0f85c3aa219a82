"""Quantities: the formula of the search is the measure of the judge, and limits are kept."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import shapely

from grashof import load, synthesize
from grashof.analysis import Verdict, solve_kinematics, solve_position, verify
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, FourBar, MotionTask, Objective, Problem, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Candidate
from grashof.synth.quantities.formulas import FORMULAS, Part
from grashof.synth.quantities.kinds import FOUR_BAR
from grashof.synth.quantities.screening import Many

pytestmark = pytest.mark.usefixtures("small_search")
JUDGED = 50


def three_poses() -> Problem:
    """Three poses, which leave much freedom: drivers turn in either sense."""
    return Problem(task=planted_motion(np.random.default_rng([12, 2]), poses=3)[0])


def conveyor() -> Problem:
    """Five poses of a conveyor that no linkage within these lengths meets."""
    poses = [[0, 0, 0], [60, 90, 15], [180, 140, 40], [300, 90, 70], [360, 0, 90]]
    wanted = Requirements(exact=False, link_length=(30.0, 400.0))
    return Problem(task=MotionTask.from_degrees(poses), requirements=wanted, length_unit="mm")


@cache
def planted(seed: int) -> tuple[MotionTask, FourBar, Verdict]:
    """A linkage that meets five poses with its driver turning fully."""
    task, linkage = planted_motion(np.random.default_rng([12, seed]), poses=5)
    return task, linkage, verify(linkage, task, Requirements())


def as_seen(task: MotionTask, linkage: FourBar, values: Values) -> Many:
    """The same linkage as the search sees it, in the problem's own unit."""
    state = values.at_targets
    a, b, p = (getattr(state, name) @ np.array([1, 1j]) for name in "abp")
    o2, o4 = (pivot @ np.array([1, 1j]) for pivot in (linkage.o2, linkage.o4))
    theta2, turn = values.verdict.theta2[None], np.array([task.angles[0]])
    return Many(p[:1], o2[None], a[None], o4[None], b[None], theta2, turn, kind=FOUR_BAR)


def of_part(part: Part, view: Many) -> FloatArray:
    """All numbers of a part, as the judge counts them."""
    value = part.of(view) if part.per is None else part.of(view) / part.per(view)
    return np.ravel(np.sqrt(value) if part.squared else value)


@pytest.mark.parametrize("key", FORMULAS)
def test_the_formula_is_the_measure(key: str) -> None:
    for seed in range(JUDGED):
        task, linkage, verdict = planted(seed)
        values = Values(linkage, verdict, Problem(task=task))
        view, parts = as_seen(task, linkage, values), values.parts(key)
        for part in FORMULAS[key]:
            found, expected = of_part(part, view), parts[part.axis or (part.name if len(parts) > 1 else "")]
            if key in ("ground_angle", "theta2_start"):  # modulo a turn
                found, expected = np.exp(1j * found), np.exp(1j * expected)  # type: ignore[assignment]
            if np.isnan(expected).any():  # a double-crank has no time ratio
                assert (found == 0).all()
                continue
            near = 1e-9 * max(task.size, np.abs(expected).max())
            found, expected = np.broadcast_arrays(found, expected)
            np.testing.assert_allclose(found, expected, rtol=0, atol=near)


TASKS: dict[str, tuple[Problem, dict[str, Any]]] = {
    "poses met": (three_poses(), {"enough": 12}),
    "poses fitted": (conveyor(), {"effort": 0.2}),
    "points met": (load("path-8-points"), {"enough": 6, "starts": 12}),
}


def limited(problem: Problem, **wanted: Any) -> Problem:
    return replace(problem, requirements=replace(problem.requirements, **wanted))


def values_of(problem: Problem, key: str, **search: Any) -> list[float]:
    """A quantity of every design of a list, as the judge has it of the linkage alone."""
    found = solved(problem, tuple(search.items()))
    wanted = problem.requirements
    verdicts = [verify(each.linkage, problem.task, wanted, problem=problem) for each in found]
    assert [verdict.defects for verdict in verdicts if not verdict.ok] == []
    return [
        Values(each.linkage, verdict, problem)[key] for each, verdict in zip(found, verdicts, strict=True)
    ]


@cache
def solved(problem: Problem, search: tuple[tuple[str, Any], ...]) -> tuple[Candidate, ...]:
    return synthesize(problem, **dict(search)).candidates


def about_the_median(free: FloatArray) -> tuple[float, float]:
    """Swings of rockers, deg, within 4 deg of the usual one."""
    usual = float(np.median(free[free < 350])) if (free < 350).any() else 180.0
    return usual - 4, usual + 4


# Of a quantity its field, limits by the values of designs without them, other requirements, and the tasks.
LIMITED: dict[str, tuple[str, Callable[[FloatArray], Any], dict[str, Any], tuple[str, ...]]] = {
    "driver_rotation": (
        "driver_rotation_deg", lambda free: (0, float(np.quantile(free, 0.25))), {}, tuple(TASKS),
    ),
    "output_swing": ("output_swing_deg", about_the_median, {}, tuple(TASKS)),
    "time_ratio": (
        "time_ratio", lambda free: (float(np.median(free)), 100), {"rotatability": "crank-rocker"},
        tuple(TASKS),
    ),
    "mechanical_advantage": (
        "mechanical_advantage_min", lambda free: float(np.median(free)), {}, ("poses met", "points met"),
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.quick(*(f"{key}-poses met" for key in LIMITED))
@pytest.mark.parametrize(("key", "kind"), [(key, kind) for key in LIMITED for kind in LIMITED[key][3]])
def test_a_quantity_is_kept_within_limits(key: str, kind: str) -> None:
    (problem, search), (field, limits_of, others, _) = TASKS[kind], LIMITED[key]
    asked, unit = limited(problem, **others), np.degrees(1.0) if field.endswith("_deg") else 1.0
    limits = limits_of(unit * np.array(values_of(asked, key, **search)))
    kept = unit * np.array(values_of(limited(asked, **{field: limits}), key, **search))
    low, high = limits if isinstance(limits, tuple) else (limits, np.inf)
    assert len(kept) >= 2
    assert min(kept) >= low - 1e-6
    assert max(kept) <= high + 1e-6


@pytest.mark.quick("poses met-ccw")
@pytest.mark.parametrize("sense", ["ccw", "cw"])
@pytest.mark.parametrize("kind", TASKS)
def test_the_driver_turns_in_the_requested_sense(kind: str, sense: str) -> None:
    problem, search = TASKS[kind]
    senses = values_of(limited(problem, driver_sense=sense), "driver_sense", **search)
    assert len(senses) >= 1
    assert set(senses) == {1.0 if sense == "ccw" else -1.0}


def test_the_output_swing_is_that_of_the_full_turn() -> None:
    """From the linkage alone: the greatest less the least angle of link 4 over a turn."""
    for seed in range(12):
        task, linkage, verdict = planted(seed)
        found = Values(linkage, verdict, Problem(task=task))["output_swing"]
        theta4 = np.unwrap(solve_position(linkage, np.linspace(0, 2 * np.pi, 20001)).theta4)
        assert found == pytest.approx(np.ptp(theta4), abs=1e-6)


@pytest.mark.slow
def test_the_output_swing_as_a_goal() -> None:
    problem, search = TASKS["poses met"]
    wide = replace(problem, objective=Objective(transmission=0, output_swing=1))
    free, best = (values_of(each, "output_swing", **search) for each in (problem, wide))
    assert best[0] >= max(free) - 1e-6


def test_the_time_ratio_is_that_of_a_steady_driver() -> None:
    """From the linkage alone: shares of a turn in which link 4 swings forth and back."""
    for seed in range(12):
        task, linkage, verdict = planted(seed)
        found = Values(linkage, verdict, Problem(task=task))["time_ratio"]
        theta4 = np.unwrap(solve_position(linkage, np.linspace(0, 2 * np.pi, 200001)).theta4)
        forth = float(np.mean(np.diff(theta4) > 0))
        if 0 < forth < 1:
            assert found == pytest.approx(max(forth, 1 - forth) / min(forth, 1 - forth), abs=1e-4)
        else:
            assert np.isnan(found)


def test_the_mechanical_advantage_is_omega2_over_omega4() -> None:
    for seed in range(12):
        task, linkage, verdict = planted(seed)
        values = Values(linkage, verdict, Problem(task=task))
        motion = np.linspace(verdict.theta2.min(), verdict.theta2.max(), 4001)
        ratio = 1 / solve_kinematics(linkage, motion, 1.0).omega4
        for key in ("mechanical_advantage", "mechanical_advantage_min"):  # as a goal, and as the column
            assert values[key] == pytest.approx(np.abs(ratio).min(), rel=1e-5)


@pytest.mark.quick("b-poses met")
@pytest.mark.quick("a-poses met")
@pytest.mark.parametrize("kind", ["poses met", "poses fitted"])
@pytest.mark.parametrize("joint", ["a", "b"])
def test_a_joint_sits_on_the_body_where_it_may(kind: str, joint: str) -> None:
    problem, search = TASKS[kind]

    def places(asked: Problem) -> FloatArray:
        """From the positions at every target: the joint less P, turned back with the body."""
        found = []
        for each in solved(asked, tuple(search.items())):
            state = solve_position(each.linkage, each.verdict.theta2, each.verdict.assembly)
            arm = (getattr(state, joint) - state.p) @ np.array([1, 1j])
            place = arm * np.exp(-1j * (state.theta3 + each.linkage.body_angle))
            assert np.ptp(place.real) < 1e-9 * problem.task.size
            found.append([place[0].real, place[0].imag])
        return np.array(found)

    middle, half = np.median(places(problem), axis=0), 0.5 * problem.task.size
    sides = [(float(at - half), float(at + half)) for at in middle]
    kept = places(limited(problem, **{f"{joint}_on_body": Box(*sides)}))
    assert len(kept) >= 1
    assert (np.abs(kept - middle) <= half * (1 + 1e-6)).all()


@pytest.mark.study
def test_the_body_keeps_out_of_areas() -> None:
    """The outline carried through three poses, against a post that it would sweep; by shapely alone."""
    outline = np.array([[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3], [-0.3, 0.3]])
    plain, search = TASKS["poses met"]
    task = MotionTask(plain.task.positions, plain.task.angles, body=outline * plain.task.size)
    bodies = replace(plain, task=task)

    def swept(design: Candidate) -> shapely.Geometry:
        motion = np.linspace(design.verdict.theta2.min(), design.verdict.theta2.max(), 6000)  # some run fast
        state = solve_position(design.linkage, motion, design.verdict.assembly[0])
        turned = np.exp(1j * (state.theta3 + design.linkage.body_angle))[:, None]
        corners = (state.p @ np.array([1, 1j]))[:, None] + turned * (task.body @ np.array([1, 1j]))
        return shapely.union_all(shapely.polygons(np.stack([corners.real, corners.imag], axis=-1)))

    free = synthesize(bodies, **search).candidates[:5]
    rooms = [swept(each) for each in free]
    spare = shapely.difference(rooms[0], shapely.union_all(rooms[1:3]))
    if spare.is_empty:
        spare = shapely.difference(rooms[0], rooms[1])
    x, y = (float(at) for at in shapely.get_coordinates(shapely.point_on_surface(spare))[0])
    half = 0.01 * task.size
    post = [[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]]
    asked = limited(bodies, keep_out=[post], keep_out_for=["body"])
    missed = [verify(each.linkage, task, asked.requirements).defects for each in free]
    for room, defects in zip(rooms, missed, strict=True):
        told, square, near = bool(defects), shapely.Polygon(post), 0.005 * task.size
        if shapely.intersects(room.buffer(-near), square):
            assert told
        elif not shapely.intersects(room.buffer(near), square):
            assert not told
    kept = synthesize(asked, **search).candidates[:5]
    assert len(kept) >= 3
    assert not any(shapely.intersects(swept(each), shapely.Polygon(post).buffer(-1e-6)) for each in kept)
