"""Every quantity has a measure, and the measures agree with plain samples and differences."""

import pickle
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from grashof import problems
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.measures import MEASURES, PARTS, Values
from grashof.analysis.judge.missed_limits import missed, stated_limits
from grashof.analysis.judge.over_task import motion_ends
from grashof.analysis.judge.planted import planted_motion, planted_path, random_full_crank
from grashof.analysis.judge.tolerance import made_linkages
from grashof.analysis.judge.verdict import Defect
from grashof.problems import Manufacturing, Problem, ProblemError, Requirements, TransmissionOver
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.limit_kinds import Kind, Limit
from grashof.problems.values.requirements.quantities import MEASURED, Scope
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.problems.values.units import Unit

SAMPLES = 20_001
STATED: dict[str, Any] = {
    "length_unit": "m",
    "dynamics": problems.DynamicsSpec(mass_per_length=2.0, gravity=(0, -9.81)),
    "manufacturing": Manufacturing(0.01),
    "requirements": Requirements(exact=False),
}


def planted(seed: int, kind: str = "motion") -> Values:
    """A random linkage that does its task, a little moved, so that there are errors."""
    rng = np.random.default_rng(seed)
    if kind == "closed":
        linkage = random_full_crank(rng)
        points = solve_position(linkage, np.linspace(0, 2 * np.pi, 12, endpoint=False)).p
        task: Any = problems.PathTask(points + 0.01 * rng.normal(size=points.shape), closed=True)
    else:
        task, linkage = planted_motion(rng, 4) if kind == "motion" else planted_path(rng, 7)
    problem = Problem(task=task, **STATED)
    return Values(linkage, verify(linkage, task, problem.requirements, problem=problem), problem)


@pytest.fixture(scope="module", params=[(0, "motion"), (1, "path"), (2, "closed")], ids=lambda each: each[1])
def values(request: pytest.FixtureRequest) -> Values:
    return planted(*request.param)


def test_every_quantity_is_measured_once() -> None:
    assert set(MEASURES) | set(PARTS) == set(QUANTITIES)
    assert not set(MEASURES) & set(PARTS)
    assert all(not QUANTITIES[key].listed for key in PARTS)
    assert list(planted(0)) == list(MEASURES)


def test_dimensions_of_a_linkage(values: Values) -> None:
    linkage = values.linkage
    o2, o4 = linkage.o2, linkage.o4
    assert [values[key] for key in ("o2_x", "o2_y", "o4_x", "o4_y")] == [*o2, *o4]
    assert [values[key] for key in ("p_u", "p_v")] == linkage.coupler_point.tolist()
    lengths = [float(np.hypot(*(o4 - o2))), float(linkage.r2), float(linkage.r3), float(linkage.r4)]
    assert [values[f"r{link}"] for link in (1, 2, 3, 4)] == lengths
    assert values["link_ratio"] == max(lengths) / min(lengths)
    assert values["ground_angle"] == np.arctan2(*(o4 - o2)[::-1])
    state = solve_position(linkage, values.verdict.theta2)
    for name, end in (("A-P", state.a), ("B-P", state.b)):
        np.testing.assert_allclose(
            np.hypot(*(state.p - end).T), float(values.parts("coupler_arms")[name][0]), rtol=1e-12
        )
    for name in "ab":
        place = values.parts(name)
        np.testing.assert_allclose(np.transpose([place["x"], place["y"]]), getattr(state, name), atol=1e-12)


def test_errors_are_of_the_places_that_p_comes_to(values: Values) -> None:
    task, verdict = values.problem.task, values.verdict
    state = solve_position(values.linkage, verdict.theta2, verdict.assembly)
    apart = np.hypot(*(state.p - task.positions).T)
    assert values["error_max"] == pytest.approx(apart.max(), abs=1e-12)
    assert values["error_rms"] == pytest.approx(np.sqrt(np.mean(apart**2)), abs=1e-12)
    assert values["error_sse"] == pytest.approx(np.sum(apart**2), abs=1e-12)
    turned = np.abs(np.angle(np.exp(1j * (state.theta3 + values.linkage.body_angle - task.angles))))
    square = apart**2 + np.nan_to_num(task.angle_length * turned) ** 2
    assert values["error"] == pytest.approx(np.sqrt(np.mean(square)), abs=1e-12)
    if task.has_angle.any():
        assert values["angle_error_max"] == pytest.approx(turned.max(), abs=1e-12)
        assert values["angle_error_rms"] == pytest.approx(np.sqrt(np.mean(turned**2)), abs=1e-12)
        assert values["body_angle"] == values.linkage.body_angle
    else:
        assert all(np.isnan(values[key]) for key in ("angle_error_max", "angle_error_rms", "body_angle"))


def test_extremes_of_the_motion(values: Values) -> None:
    """By plain samples: they lie a little inside the extremes."""
    linkage, (start, end) = values.linkage, motion_ends(values.problem.task, values.verdict)
    assert np.degrees(values["theta2_start"]) == pytest.approx(
        (np.degrees(start) + 180) % 360 - 180, abs=1e-9
    )
    assert values["theta2_end"] - values["theta2_start"] == pytest.approx(
        values.verdict.theta2[-1] - values.verdict.theta2[0], abs=1e-12
    )
    theta2 = np.linspace(start, end, SAMPLES)
    state = solve_position(linkage, theta2, values.verdict.assembly[0])
    points = np.concatenate([state.a, state.b, state.p, linkage.o2[None], linkage.o4[None]])
    assert values["size"] == pytest.approx(np.hypot(*np.ptp(points, axis=0)), rel=1e-6)
    omega2 = values.problem.dynamics.omega2  # type: ignore[union-attr]
    rate = np.gradient(np.unwrap(state.theta4), theta2) * omega2
    assert values["omega4_max"] == pytest.approx(np.abs(rate).max(), rel=1e-3)
    speed = np.hypot(*np.gradient(state.p, theta2, axis=0).T) * omega2
    assert values["point_speed_max"] == pytest.approx(speed.max(), rel=1e-3)
    cycle = solve_position(linkage, np.linspace(0, 2 * np.pi, SAMPLES), values.verdict.assembly[0])
    for key, each in (("transmission_min_task", state), ("transmission_min_cycle", cycle)):
        acute = np.abs(np.angle(np.exp(2j * (each.theta4 - each.theta3)))) / 2
        assert values[key] == pytest.approx(np.nanmin(acute), abs=1e-3)
    assert values["transmission"] == values["transmission_min_task"]


def test_moves_are_differences() -> None:
    values, step = planted(1, "path"), 1e-6
    linkage, theta2 = values.linkage, values.verdict.theta2
    made, _ = made_linkages(linkage, step * np.eye(6))
    moved = solve_position(made[:, None], theta2).p - solve_position(linkage, theta2).p
    for name, ways in zip(("r1", "r2", "r3", "r4", "u", "v"), moved, strict=True):
        assert values[f"move_{name}"] == pytest.approx(np.hypot(*ways.T).max() / step, rel=1e-4)


def test_known_values_are_pickled(monkeypatch: pytest.MonkeyPatch) -> None:
    values = planted(0)
    known = values["torque_peak"]
    monkeypatch.setitem(MEASURES, "torque_peak", lambda values: np.nan)
    assert pickle.loads(pickle.dumps(values))["torque_peak"] == known


def limiting(key: str, low: float, high: float) -> Any:
    """Requirements that limit one quantity by a field that there may be one day."""
    limit = Limit(MEASURED[key], Kind.BETWEEN, (-np.inf, np.inf))
    return SimpleNamespace(
        limited={key: limit},
        ranges=lambda name: {"": (low, high)},
        as_required=lambda quantity: quantity,
        same_branch=True,
        regions={},
    )


def missed_by(values: Values, wanted: Any) -> list[Defect]:
    """The defects of a design by limits."""
    stated = stated_limits(values.problem, wanted, values.linkage.mechanism.word)
    return list(missed(values, stated, wanted.same_branch))


@pytest.mark.parametrize("kind", ["motion", "closed"])
def test_every_measured_quantity_can_be_limited(kind: str) -> None:
    values = planted(2, kind)
    known = [key for key in MEASURED if not np.isnan(values[key])]
    assert len(known) > 35  # others are of six-bars, dwells, cylinders
    for key in known:
        check_limits(values, key)


def check_limits(values: Values, key: str) -> None:
    value, shown = values[key], MEASURED[key].unit.shown
    assert not missed_by(values, limiting(key, value, value))
    step = {Unit.ANGLE: 1.0, Unit.RATIO: abs(value) + 0.01}.get(MEASURED[key].unit) or values.problem.scale(
        MEASURED[key]
    )
    for low, high, allowed in (
        (value + 0.01 * step, np.inf, "from"),
        (-np.inf, value - 0.01 * step, "up to"),
    ):
        (defect,) = missed_by(values, limiting(key, low, high))
        assert (defect.requirement, defect.found) == (key, value * shown)
        assert defect.allowed.startswith(allowed)
        assert MEASURED[key].words in defect.what
        assert defect.miss == pytest.approx(0.01, rel=0.5)


def test_a_limit_needs_a_problem_that_states_its_quantity() -> None:
    values = planted(0)
    bare = Values(values.linkage, values.verdict, Problem(task=values.problem.task))
    with pytest.raises(ProblemError, match=r"requirements\.torque_peak needs a problem with dynamics"):
        missed_by(bare, limiting("torque_peak", 0, 5))


def test_without_a_motion_only_the_branch_is_named() -> None:
    values = planted(0)
    torn = Values(values.linkage, replace(values.verdict, branch_ok=False), values.problem)
    assert np.isnan(torn["omega4_max"])
    assert not missed_by(torn, limiting("omega4_max", 0, 1))
    study = limiting("omega4_max", 0, 1)
    study.same_branch = False
    (defect,) = missed_by(torn, study)
    assert np.isinf(defect.miss)


@pytest.mark.parametrize("over", TransmissionOver)
def test_the_transmission_is_that_over_the_motion_required(over: TransmissionOver) -> None:
    wanted = Requirements(transmission_over=over)
    meant = wanted.as_required(LIMITS["transmission_min_deg"].quantity)
    assert meant.key == f"transmission_min_{over}"
    assert meant.over is {"task": Scope.TASK, "cycle": Scope.CYCLE}[over]
