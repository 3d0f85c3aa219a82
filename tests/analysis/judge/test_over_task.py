"""Figures of the motion used: the reports', dense sampling, units, dead positions, all that acts."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof import analysis, load, synthesize
from grashof.analysis import Loads, inverse_dynamics, over_task, solve_kinematics, stated_masses, verify
from grashof.analysis.forces.joints import joints_of
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.over_task import motion_ends
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import (
    DynamicsSpec,
    FourBar,
    InvertedSliderCrank,
    Linkage,
    PathTask,
    Problem,
    Requirements,
    SliderCrank,
)
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.load_specs import DamperSpec, FrictionSpec, LoadSpec, Place, SpringSpec
from grashof.problems.values.dynamics.motor import MotorSpec

DYNAMICS = ("torque_peak", "torque_rms", "joint_force_peak")
KINEMATICS = ("omega4_max", "point_speed_max", "point_acceleration_max", "coupler_fit_r2")
BARS = DynamicsSpec(2.0, payload=3.0, speed_rpm=25.0, gravity=(1.0, -9.0))
CRANK_ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
ANY = Requirements(rotatability="any")


def judged(
    linkage: Linkage, theta2: Any, spec: DynamicsSpec = BARS, unit: str = "m", *, closed: bool = False
) -> tuple[Problem, analysis.Verdict]:
    """A task of points that the linkage passes at these driver angles, and the verdict on it."""
    task = PathTask(analysis.solve_position(linkage, theta2).p, closed=closed)
    word = linkage.mechanism.word
    problem = Problem(task=task, requirements=ANY, length_unit=unit, dynamics=spec, mechanism=word)
    return problem, verify(linkage, task, ANY)


def dense(linkage: FourBar, spec: DynamicsSpec, start: float, end: float) -> dict[str, float]:
    state = solve_kinematics(linkage, np.linspace(start, end, 20_001), spec.omega2)
    found = inverse_dynamics(state, stated_masses(linkage, spec), Loads(gravity=spec.gravity))
    square = found.torque**2
    return {
        "omega4_max": float(np.abs(state.omega4).max()),
        "point_speed_max": float(state.p.speed.max()),
        "point_acceleration_max": float(state.p.acceleration_magnitude.max()),
        "output_acceleration_max": float(np.abs(state.alpha4).max()),
        "torque_peak": float(np.abs(found.torque).max()),
        "torque_rms": float(np.sqrt((square.sum() - (square[0] + square[-1]) / 2) / 20_000)),
        "joint_force_peak": max(float(found.joint_force(joint).max()) for joint in joints_of(linkage)),
    }


def test_torque_of_the_reports_linkage_on_the_job(golden_linkages: dict[str, FourBar]) -> None:
    """The report's masses at 1 rad/s; right figures in place of the report's, without gravity and with."""
    luggage, bag = load("luggage"), golden_linkages["bag"]
    assert luggage.dynamics is not None
    verdict = verify(bag, luggage.task, luggage.requirements)
    spec = luggage.dynamics
    bare = DynamicsSpec(masses=spec.masses, inertias=spec.inertias, speed_rpm=spec.speed_rpm)
    still = over_task(bag, replace(luggage, dynamics=bare), verdict)
    assert still.torque_peak == pytest.approx(6.302, abs=5e-4)
    assert still.torque_rms == pytest.approx(1.633, abs=2e-3)  # the report's samples count both ends fully
    heavy = over_task(bag, luggage, verdict)
    assert heavy.torque_peak == pytest.approx(27.69, abs=5e-3)
    assert heavy.torque_rms == pytest.approx(19.61, abs=5e-3)
    for name in KINEMATICS:
        assert getattr(heavy, name) == getattr(still, name)
    state = solve_kinematics(bag, np.linspace(*motion_ends(luggage.task, verdict), 2001))
    torque = inverse_dynamics(state, stated_masses(bag, bare)).torque
    assert (torque.max(), torque.min()) == pytest.approx((6.302, -1.283), abs=5e-4)
    torque = inverse_dynamics(state, stated_masses(bag, spec), Loads(gravity=spec.gravity)).torque
    assert (torque.max(), torque.min()) == pytest.approx((10.64, -27.69), abs=5e-3)


def zoomed(curve: Callable[[FloatArray], FloatArray], low: float, high: float) -> float:
    """Greatest value, by twenty thousand samples and as many again about the highest one."""
    for _ in range(3):
        theta2 = np.linspace(low, high, 20_001)
        values = curve(theta2)
        top, step = theta2[np.argmax(values)], theta2[1] - theta2[0]
        low, high = top - 30 * step, top + 30 * step
    return float(values.max())


def test_a_peak_beside_a_near_dead_position_is_met() -> None:
    """|r1 - r2| and |r3 - r4| differ by 1e-5: the output jerks within some thousandths of a radian."""
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=5, r4=8 - 1e-5, coupler_point=(2, 1))
    problem, verdict = judged(linkage, [-0.5, 0.1, 0.7])
    found = over_task(linkage, problem, verdict)
    masses, loads = stated_masses(linkage, BARS), Loads(gravity=BARS.gravity)

    def state(theta2: FloatArray) -> analysis.Kinematics:
        return solve_kinematics(linkage, theta2, BARS.omega2)

    curves: dict[str, Callable[[FloatArray], FloatArray]] = {
        "omega4_max": lambda theta2: np.abs(state(theta2).omega4),
        "point_speed_max": lambda theta2: state(theta2).p.speed,
        "point_acceleration_max": lambda theta2: state(theta2).p.acceleration_magnitude,
        "output_acceleration_max": lambda theta2: np.abs(state(theta2).alpha4),
        "torque_peak": lambda theta2: np.abs(inverse_dynamics(state(theta2), masses, loads).torque),
    }
    for name, curve in curves.items():
        assert getattr(found, name) == pytest.approx(zoomed(curve, -0.5, 0.7), rel=1e-9), name
    assert found.torque_peak > 1e4 * found.omega4_max


def test_the_driver_turns_at_one_radian_a_second_or_at_its_speed() -> None:
    problem, verdict = judged(CRANK_ROCKER, [0.3, 1.0, 2.5])
    driven = over_task(CRANK_ROCKER, problem, verdict)
    slow = over_task(CRANK_ROCKER, replace(problem, dynamics=None), verdict)
    speed = 25 * np.pi / 30
    assert driven.omega4_max == pytest.approx(speed * slow.omega4_max, rel=1e-12)
    assert driven.point_speed_max == pytest.approx(speed * slow.point_speed_max, rel=1e-12)
    assert driven.point_acceleration_max == pytest.approx(speed**2 * slow.point_acceleration_max, rel=1e-12)
    turning = speed**2 * slow.output_acceleration_max
    assert driven.output_acceleration_max == pytest.approx(turning, rel=1e-12)
    assert driven.coupler_fit_r2 == slow.coupler_fit_r2
    assert np.isnan([getattr(slow, name) for name in DYNAMICS]).all()


def test_the_motion_is_the_one_from_first_to_last_target() -> None:
    forwards, verdict = judged(CRANK_ROCKER, [0.3, 1.0, 2.5])
    backwards, reverse = judged(CRANK_ROCKER, [2.5, 1.0, 0.3])
    assert motion_ends(forwards.task, verdict) == pytest.approx((0.3, 2.5))
    assert motion_ends(backwards.task, reverse) == pytest.approx((2.5, 0.3))
    one, other = over_task(CRANK_ROCKER, forwards, verdict), over_task(CRANK_ROCKER, backwards, reverse)
    for name in (*KINEMATICS, *DYNAMICS):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-12), name


def test_a_closed_path_takes_a_full_turn() -> None:
    problem, verdict = judged(CRANK_ROCKER, [0.3, 1.0, 2.5, 4.0], closed=True)
    start, end = motion_ends(problem.task, verdict)
    assert abs(end - start) == pytest.approx(2 * np.pi, rel=1e-15)
    found = over_task(CRANK_ROCKER, problem, verdict)
    for name, value in dense(CRANK_ROCKER, BARS, 0.0, 2 * np.pi).items():
        assert getattr(found, name) == pytest.approx(value, rel=1e-6), name


def test_the_motion_is_on_the_assembly_that_meets_the_targets() -> None:
    """Required on either branch, the task is met by the linkage assembled the other way."""
    mirrored = replace(CRANK_ROCKER, assembly=-1)
    problem, verdict = judged(mirrored, [0.3, 1.0, 2.5])
    free = replace(ANY, same_branch=False)
    other = verify(CRANK_ROCKER, problem.task, free)
    assert other.assembly.tolist() == [-1, -1, -1]
    assert other.ok
    found, expected = over_task(CRANK_ROCKER, problem, other), over_task(mirrored, problem, verdict)
    for name in (*KINEMATICS, *DYNAMICS):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-9), name
    peak = Values(CRANK_ROCKER, other, problem)["torque_peak"]
    assert peak == pytest.approx(expected.torque_peak, rel=1e-9)


def test_no_motion_no_figures() -> None:
    """A dead position lies between the targets."""
    problem, verdict = judged(CRANK_ROCKER, [0.3, 1.0, 2.5])
    found = over_task(CRANK_ROCKER, problem, replace(verdict, branch_ok=False))
    assert np.isnan([getattr(found, name) for name in (*KINEMATICS, *DYNAMICS)]).all()
    assert np.isnan(Values(CRANK_ROCKER, replace(verdict, branch_ok=False), problem)["torque_peak"])


@pytest.mark.filterwarnings("error")
def test_in_a_dead_position_rates_and_torque_are_infinite() -> None:
    """r2 + r3 = 5 and 4 reach O4 stretched where theta2 is 60 deg: the motion ends there."""
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=4, r3=1, r4=3, coupler_point=(0.5, 0.2))
    end = float(np.arccos((16 + 16 - 16) / 32))
    problem, verdict = judged(rocker, [end - 0.4, end - 0.2, end])
    assert verdict.branch_ok
    found = over_task(rocker, problem, verdict)
    infinite = (
        *("omega4_max", "point_speed_max", "point_acceleration_max", "output_acceleration_max"),
        *DYNAMICS,
    )
    assert np.isinf([getattr(found, name) for name in infinite]).all()
    assert np.isfinite(found.coupler_fit_r2)
    assert np.isinf(Values(rocker, verdict, problem)["torque_peak"])
    # A point on the crank does not mind.
    on_crank = FourBar(o2=(0, 0), o4=(4, 0), r2=4, r3=1, r4=3)
    found = over_task(on_crank, replace(problem, dynamics=None), verdict)
    assert (found.point_speed_max, found.point_acceleration_max) == pytest.approx((4, 4))


def test_one_target_angle_is_no_motion_but_a_place() -> None:
    problem, verdict = judged(CRANK_ROCKER, [0.3, 1.0, 2.5])
    found = over_task(CRANK_ROCKER, problem, replace(verdict, theta2=np.full(3, 0.7)))
    place = dense(CRANK_ROCKER, BARS, 0.7, 0.7)
    for name, value in place.items():
        assert getattr(found, name) == pytest.approx(value, rel=1e-9), name
    assert np.isnan(found.coupler_fit_r2)


# Everything that acts, against dense samples in time

ACTING = DynamicsSpec(
    2.0,
    speed_rpm=30,
    gravity=(0, -9.81),
    loads=(
        LoadSpec(3, (0.3, 0.1), values=((0, 0, -9), (90, 1, -20), (180, 0, -20), (360, 0, -9))),
        LoadSpec(4, values=((0, 3.0), (1, -3), (4, 2)), over="time"),
    ),
    springs=(SpringSpec((Place(1, (0, 1)), Place(4, (0.5, 0))), 20, 0.5),),
    dampers=(DamperSpec((Place(1, (0, 1)), Place(3, (0.5, 0))), 3),),
    friction=FrictionSpec(0.1, 0.02, viscous=0.3),
)
MOTORS = {
    "steady": None,
    "trapezoid": MotorSpec("trapezoid"),
    "cycloid": MotorSpec("cycloid"),
    "measured": MotorSpec(values=((0, 0), (0.5, 30), (1.5, 40), (2, 100))),
}


@pytest.mark.quick("0-steady")
@pytest.mark.parametrize("motor", MOTORS)
@pytest.mark.parametrize("seed", range(3))
def test_peaks_and_means_are_those_of_dense_samples_in_time(motor: str, seed: int) -> None:
    task, linkage = planted_motion(np.random.default_rng(seed), poses=4)
    spec = replace(ACTING, motor=MOTORS[motor])
    problem = Problem(task=task, length_unit="m", dynamics=spec)
    verdict = verify(linkage, task, problem.requirements)
    found = over_task(linkage, problem, verdict)
    start, rotation = float(verdict.theta2[0]), float(verdict.theta2[-1] - verdict.theta2[0])
    law = analysis.DriverLaw(start, rotation, np.copysign(np.pi, rotation), spec.motor or MotorSpec())
    beside = (law.corners[:, None] + [-1e-9, 1e-9]).ravel()
    share = np.unique(np.concatenate([np.linspace(0, 1, 20_001), beside]))
    time = share[(share > 0) & (share < 1)] * law.duration  # at rest friction may be anything
    state = solve_kinematics(linkage, *law.at_time(time), assembly=verdict.assembly[0])
    loads = analysis.stated_loads(spec, 1.0, lambda _: time)
    dynamics = inverse_dynamics(state, stated_masses(linkage, spec), loads)
    rms = np.sqrt(np.trapezoid(dynamics.torque**2, time) / law.duration)
    force = max(dynamics.joint_force(joint).max() for joint in joints_of(linkage))
    assert found.torque_rms == pytest.approx(rms, rel=2e-6)
    assert found.torque_peak == pytest.approx(np.abs(dynamics.torque).max(), rel=1e-6)
    assert found.joint_force_peak == pytest.approx(force, rel=1e-6)
    assert found.omega4_max == pytest.approx(np.abs(state.omega4).max(), rel=1e-6)
    assert found.point_acceleration_max == pytest.approx(state.p.acceleration_magnitude.max(), rel=1e-6)
    assert found.output_acceleration_max == pytest.approx(np.abs(state.alpha4).max(), rel=1e-6)


def test_friction_and_dampers_depend_on_the_sense() -> None:
    """The same linkage and targets, met the other way round: what resists is on the other side."""
    task, linkage = planted_motion(np.random.default_rng(1), poses=4)
    back = replace(task, positions=task.positions[::-1], angles=task.angles[::-1])
    peaks = []
    for each in (task, back):
        problem = Problem(task=each, length_unit="m", dynamics=replace(ACTING, loads=ACTING.loads[:1]))
        peaks.append(over_task(linkage, problem, verify(linkage, each, problem.requirements)).torque_peak)
    assert abs(peaks[0] - peaks[1]) > 1e-3 * max(peaks)


# Slides, under loads over their travel

ENGINE = SliderCrank((0.3, 0), 0.4, 1.5, 0.2, 0.7, (0.5, 0.2))
SHAPER = InvertedSliderCrank((0, 0), (0, -1.6), 0.6, 0.2, (2.5, 0.3))
SPEC = DynamicsSpec(
    masses=(1.0, 2.0, 3.0),
    inertias=(0.1, 0.3, 0.2),
    payload=0.5,
    speed_rpm=25.0,
    gravity=(1.0, -9.0),
    loads=(LoadSpec(4, values=((-5, 3, 1), (1.2, -6, 2), (5, 2, 2)), over="travel"),),
    friction=FrictionSpec(viscous=0.2, slide_viscous=0.3, slide_force=0.1),
)
IN_MILLIMETRES = replace(
    SPEC,
    inertias=(0.1e6, 0.3e6, 0.2e6),
    loads=(LoadSpec(4, values=((-5e3, 3, 1), (1.2e3, -6, 2), (5e3, 2, 2)), over="travel"),),
)


@pytest.mark.quick("1-linkage0-1.0", "-1-linkage1-0.001")
@pytest.mark.parametrize("metre", [1.0, 1e-3])
@pytest.mark.parametrize("linkage", [ENGINE, SHAPER])
@pytest.mark.parametrize("sense", [1, -1])
def test_figures_are_those_of_dense_samples(linkage: Linkage, sense: int, metre: float) -> None:
    own, unit = linkage.scaled(1 / metre, np.zeros(2)), "m" if metre == 1 else "mm"
    at, spec = 0.4 + sense * np.array([0.0, 0.9, 2.1, 3.0]), SPEC if metre == 1 else IN_MILLIMETRES
    problem, verdict = judged(own, at, spec, unit)
    found = over_task(own, problem, verdict)
    start, end = motion_ends(problem.task, verdict)
    assert np.sign(end - start) == sense
    theta2 = np.linspace(start, end, 20_001)
    state = solve_kinematics(own, theta2, sense * spec.omega2)
    dynamics = inverse_dynamics(state, stated_masses(own, spec, metre), analysis.stated_loads(spec, metre))
    torque = dynamics.torque * metre**2
    force = max(float(dynamics.joint_force(joint).max()) for joint in joints_of(own)) * metre
    assert found.torque_peak == pytest.approx(np.abs(torque).max(), rel=1e-6)
    assert found.torque_rms == pytest.approx(np.sqrt((torque**2).mean()), rel=1e-3)
    assert found.joint_force_peak == pytest.approx(force, rel=1e-6)
    assert Values(own, verdict, problem)["torque_peak"] == found.torque_peak
    if metre != 1:  # the same machine in another unit
        in_metres = over_task(linkage, *judged(linkage, at, SPEC))
        assert found.torque_peak == pytest.approx(in_metres.torque_peak, rel=1e-8)


SLIDING = "slider-crank", "inverted-slider-crank"


def loaded(problem: Problem, low: float, high: float) -> Problem:
    load = LoadSpec(4, at=(0.1, 0), values=[(low, 1, 0), (high, 2, 0)], over="travel")
    return replace(problem, length_unit="m", dynamics=DynamicsSpec(loads=[load]))


@pytest.mark.slow
@pytest.mark.quick("inverted-slider-crank")
@pytest.mark.parametrize("mechanism", SLIDING)
def test_rows_that_end_too_early_are_a_defect(mechanism: str) -> None:
    for seed in range(8):
        task, linkage = planted_path(np.random.default_rng(seed), points=5, mechanism=mechanism)
        plain = Problem(task=task, mechanism=mechanism)
        verdict = verify(linkage, task, plain.requirements)
        dense = solve_kinematics(linkage, np.linspace(*motion_ends(task, verdict), 200_001)).slide
        assert dense is not None
        low, high = float(dense.travel.min()), float(dense.travel.max())
        spare = 1e-6 * task.size
        for problem, found in (
            (loaded(plain, low - spare, high + spare), []),
            (loaded(plain, low + spare, high + spare), [low]),
            (loaded(plain, low - spare, high - spare), [high]),
        ):
            judged = verify(linkage, task, problem.requirements, problem=problem)
            defects = [one for one in judged.defects if one.requirement == "loads"]
            assert [one.found for one in defects] == pytest.approx(found, abs=1e-7 * task.size)
            assert found or np.isfinite(Values(linkage, judged, problem)["torque_peak"])


@pytest.mark.quick("inverted-slider-crank")
@pytest.mark.slow
@pytest.mark.parametrize("mechanism", SLIDING)
def test_a_search_lists_designs_whose_loads_are_known(mechanism: str) -> None:
    task = PathTask([[0, 0], [60, 90], [180, 140], [300, 90], [340, 0]])
    problem = loaded(Problem(task=task, mechanism=mechanism), -1000.0, 1000.0)
    result = synthesize(problem, starts=8, enough=8)
    assert len(result)
    assert not any(np.isnan(each.values["torque_peak"]) for each in result.candidates)
    short = synthesize(loaded(problem, -1.0, 1.0), starts=4, enough=4)
    assert len(short) == 0
    assert "misses loads: the travel of the slide under loads[0]" in short.note
