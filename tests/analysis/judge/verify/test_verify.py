"""The judge: no defect where there is none, and each defect provoked by itself."""

import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof import analysis
from grashof.analysis import Defect, GrashofClass, Verdict, rotatability, verify, worst_transmission
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import FourBar, MotionTask, Requirements

CHECKED = settings(max_examples=10)
# In general position, so that no two limits are missed at once.
CRANK_ROCKER = FourBar(
    o2=(0.5, -1), o4=(4.2, 0.3), r2=1.1, r3=3.2, r4=2.6, coupler_point=(1.5, 0.8), body_angle=0.3
)
DOUBLE_CRANK = FourBar(
    o2=(0, 0), o4=(1, 0.2), r2=2.5, r3=2.2, r4=2.4, coupler_point=(1.5, 0.8), body_angle=-0.4
)
ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3, coupler_point=(1, 1))  # swings 108 deg either way
DOUBLE_ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=1, r4=3, coupler_point=(0.6, 0.5))
DEGREES = [60.0, 90.0, 130.0, 170.0]
ANY = Requirements(rotatability="any", order=False)


def task_of(linkage: FourBar, degrees: list[float], assembly: npt.ArrayLike | None = None) -> MotionTask:
    """The poses of the body at these driver angles."""
    state = analysis.solve_position(linkage, np.radians(degrees), assembly)
    return MotionTask(state.p, state.theta3 + linkage.body_angle)


def off_at_the_third(shift: tuple[float, float], angle_length: float) -> MotionTask:
    right = task_of(CRANK_ROCKER, DEGREES)
    shifts = np.array([(0.0, 0.0), (0.0, 0.0), shift, (0.0, 0.0)])
    return MotionTask(right.positions + shifts, right.angles, angle_length=angle_length)


def judged(requirements: Requirements, linkage: FourBar = CRANK_ROCKER) -> Verdict:
    return verify(linkage, task_of(linkage, DEGREES), requirements)


def only(verdict: Verdict, key: str) -> Defect:
    """The one defect there is, which has to be about `key`."""
    assert [defect.requirement for defect in verdict.defects] == [key]
    assert not verdict.ok
    assert verdict.defects[0].miss > 0
    return verdict.defects[0]


def test_bag_mechanism_does_the_luggage_task(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    given_figures, linkage = golden["bag_mechanism_exact"], golden_linkages["bag"]
    poses = np.array(golden["motion4pose"]["poses"], dtype=np.float64)
    task = MotionTask.from_degrees(poses)
    verdict = verify(linkage, task, Requirements(transmission_min_deg=22.2668))
    assert verdict.defects == ()
    assert verdict.ok
    assert verdict.error_max <= 1e-12 * task.size
    assert verdict.angle_error.max() <= 1e-12
    beta = np.array([0.0, *map(float, given_figures["beta_deg"])])
    expected = float(given_figures["theta2_pose1_deg"]) + beta
    np.testing.assert_allclose(np.degrees(verdict.theta2), expected, rtol=1e-12)
    assert (verdict.assembly == 1).all()
    assert verdict.grashof_class is GrashofClass.CRANK_ROCKER
    assert (verdict.full_rotation, verdict.circuit_ok, verdict.branch_ok, verdict.order_ok) == (True,) * 4
    assert verdict.direction == 1
    task_worst, cycle_worst = given_figures["mu_at_poses_deg"][0], given_figures["mu_full_rev_deg"][0]
    assert np.degrees(verdict.transmission_min_task) == pytest.approx(float(task_worst), rel=1e-12)
    assert np.degrees(verdict.transmission_min_cycle) == pytest.approx(float(cycle_worst), rel=1e-12)
    assert np.degrees(verdict.transmission_min_task).round(4) == 22.2668
    assert np.degrees(verdict.transmission_min_cycle).round(4) == 8.2731


@given(seed=st.integers(0, 2**32), poses=st.integers(2, 8))
@CHECKED
def test_planted_linkages_have_no_defect(seed: int, poses: int) -> None:
    task, linkage = planted_motion(np.random.default_rng(seed), poses)
    # Planted linkages may turn with next to no margin, and two poses may lie next to each other.
    absurd = Requirements(rotatability_margin=0, link_length=(0, 1e3), coupler_arms=(0, 1e3), tolerance=1e-3)
    verdict = verify(linkage, task, absurd)
    assert verdict.defects == ()
    reach = linkage.lengths.max() + np.abs(task.positions).max()
    assert verdict.error_max <= 1e-12 * reach
    assert verdict.error_rms <= verdict.error_max
    assert verdict.error_sse == pytest.approx(poses * verdict.error_rms**2)
    assert verdict.angle_error.max() <= 1e-11
    assert verdict.circuit_ok
    assert verdict.branch_ok
    assert verdict.order_ok
    assert verdict.full_rotation
    assert verdict.transmission_min_task >= verdict.transmission_min_cycle > 0


def test_a_wrong_position_is_not_exact() -> None:
    task = off_at_the_third((3e-4, 4e-4), angle_length=1e-3)
    defect = only(verify(CRANK_ROCKER, task, Requirements()), "exact")
    assert defect.what == "the largest position error"
    assert 0 < defect.found <= 5e-4
    assert defect.miss == pytest.approx(defect.found / task.size - 1e-6)
    allowed = f"{1e-6 * task.size:.6g}"
    assert str(defect) == f"exact: the largest position error is {defect.found:.6g}, allowed: up to {allowed}"


def test_a_wrong_angle_is_not_exact() -> None:
    right = task_of(CRANK_ROCKER, DEGREES)
    wrong = right.angles + np.array([0, 0, 0, 1e-3])
    task = MotionTask(right.positions, wrong, angle_length=1e-2)
    wide = Requirements(tolerance=5e-6)
    verdict = verify(CRANK_ROCKER, task, wide)
    assert verdict.position_error.max() <= 5e-6 * task.size
    defect = only(verdict, "exact")
    assert defect.what == "the largest angle error in deg"
    assert defect.found == pytest.approx(np.degrees(1e-3), rel=1e-2)
    assert defect.allowed == f"up to {np.degrees(5e-6 * task.size / 1e-2):.6g}"


def test_tolerance_is_inclusive() -> None:
    task = off_at_the_third((1e-3, 0), angle_length=1e-6)
    found = verify(CRANK_ROCKER, task, Requirements(tolerance=1)).error_max / task.size
    assert verify(CRANK_ROCKER, task, Requirements(tolerance=found * (1 + 1e-15))).ok
    assert not verify(CRANK_ROCKER, task, Requirements(tolerance=found * (1 - 1e-9))).ok


def test_targets_out_of_sequence() -> None:
    task = task_of(CRANK_ROCKER, [20, 110, 60, 150])
    verdict = verify(CRANK_ROCKER, task, Requirements())
    defect = only(verdict, "order")
    assert not verdict.order_ok
    assert defect.what == "turns of the driver to meet the targets in sequence"
    assert defect.found == pytest.approx(490 / 360)
    assert str(defect).endswith("is 1.36111, allowed: up to 1")
    free = verify(CRANK_ROCKER, task, Requirements(order=False))
    assert free.ok
    assert not free.order_ok
    arc = worst_transmission(CRANK_ROCKER, *np.radians([20.0, 150.0]))
    assert free.transmission_min_task == pytest.approx(arc, rel=1e-9)


def test_a_rocker_that_has_to_turn_back() -> None:
    task = task_of(ROCKER, [-60, 40, 10, 80])
    verdict = verify(ROCKER, task, replace(ANY, order=True))
    defect = only(verdict, "order")
    assert str(defect) == "order: the number of reversals of the driver between targets is 2, allowed: 0"
    assert verify(ROCKER, task, ANY).ok
    assert verify(ROCKER, task_of(ROCKER, [80, 40, 10, -60]), replace(ANY, order=True)).direction == -1


def test_a_closed_motion_ends_where_it_began() -> None:
    task = task_of(CRANK_ROCKER, [20, 110, 200, 290, 20])
    verdict = verify(CRANK_ROCKER, task, Requirements())
    assert verdict.ok
    np.testing.assert_allclose(np.degrees(verdict.theta2), [20, 110, 200, 290, 380], rtol=1e-12)
    assert verdict.transmission_min_task == pytest.approx(verdict.transmission_min_cycle, rel=1e-12)


@pytest.mark.parametrize(
    ("linkage", "degrees", "assembly", "wanted", "circuit_ok", "counted"),
    [
        (CRANK_ROCKER, DEGREES, [1, 1, -1, 1], Requirements(), False, "circuits used"),
        (
            ROCKER,
            [-60, 10, 40, 80],
            [1, 1, -1, -1],
            ANY,
            True,
            "branches used (a dead position lies between)",
        ),
        (DOUBLE_ROCKER, [60, 65, -65, -60], [1, 1, 1, 1], ANY, False, "circuits used"),
    ],
    ids=["both assemblies of a crank", "both of a rocker", "both ranges of a double-rocker"],
)
def test_targets_on_several_circuits_or_branches(
    linkage: FourBar,
    degrees: list[float],
    assembly: list[int],
    wanted: Requirements,
    circuit_ok: bool,
    counted: str,
) -> None:
    task = task_of(linkage, degrees, assembly)
    verdict = verify(linkage, task, wanted)
    assert (verdict.circuit_ok, verdict.branch_ok) == (circuit_ok, False)
    assert verdict.assembly.tolist() == assembly
    assert str(only(verdict, "same_branch")) == f"same_branch: the number of {counted} is 2, allowed: 1"
    assert verify(linkage, task, replace(wanted, same_branch=False)).ok


def test_one_range_of_a_double_rocker_is_one_circuit() -> None:
    verdict = verify(
        DOUBLE_ROCKER, task_of(DOUBLE_ROCKER, [60, 62, 64, 66]), replace(ANY, link_length=(0, 5))
    )
    assert verdict.ok
    assert verdict.grashof_class is GrashofClass.DOUBLE_ROCKER


@pytest.mark.parametrize(("linkage", "requirements"), [(CRANK_ROCKER, Requirements()), (ROCKER, ANY)])
def test_the_assembly_declared_is_the_one_that_has_to_do_it(
    linkage: FourBar, requirements: Requirements
) -> None:
    task = task_of(linkage, [-60, 10, 40, 80], -1)
    verdict = verify(linkage, task, requirements)
    assert (verdict.assembly == -1).all()
    assert (verdict.circuit_ok, verdict.branch_ok) == (True, True)
    found = str(only(verdict, "same_branch"))
    assert found == "same_branch: the assembly at the targets is -1, allowed: +1, the linkage's own"
    assert verify(linkage, task, replace(requirements, same_branch=False)).ok


@pytest.mark.parametrize(
    ("linkage", "value", "what"),
    [
        (CRANK_ROCKER, "full-crank", None),
        (CRANK_ROCKER, "crank-rocker", None),
        (CRANK_ROCKER, "double-crank", "r1 - r2"),
        (CRANK_ROCKER, "any", None),
        (DOUBLE_CRANK, "full-crank", None),
        (DOUBLE_CRANK, "crank-rocker", "r1 - r2"),
        (DOUBLE_CRANK, "double-crank", None),
        (DOUBLE_CRANK, "any", None),
    ],
)
def test_kinds_of_rotation(linkage: FourBar, value: str, what: str | None) -> None:
    verdict = judged(Requirements(rotatability=value), linkage)
    if what is None:
        assert verdict.ok
    else:
        defect = only(verdict, "rotatability")
        assert defect.what == what
        assert defect.found == pytest.approx(float(linkage.r1 - linkage.r2))
        assert value in str(defect)


@pytest.mark.parametrize("value", ["full-crank", "crank-rocker", "double-crank"])
def test_a_rocker_does_not_turn(value: str) -> None:
    verdict = verify(ROCKER, task_of(ROCKER, [-60, 10, 40, 80]), Requirements(rotatability=value))
    found = {defect.what: defect for defect in verdict.defects}
    margin = found.pop("the margin of full rotation")
    assert margin.requirement == "rotatability"
    assert margin.found == pytest.approx(rotatability(ROCKER).min())
    assert str(margin).endswith(f"allowed: from 0.001 ({value})")
    assert set(found) == ({"r1 - r2"} if value == "double-crank" else set())
    assert not verdict.full_rotation


def test_margin_of_rotation_is_inclusive() -> None:
    least = float(rotatability(CRANK_ROCKER).min())
    assert judged(Requirements(rotatability_margin=least)).ok
    defect = only(judged(Requirements(rotatability_margin=least + 1e-6)), "rotatability")
    assert defect.found == pytest.approx(least)
    assert defect.miss == pytest.approx(1e-6, rel=1e-6)
    assert judged(Requirements(rotatability="any", rotatability_margin=0.25)).ok


def test_transmission_over_the_task_and_over_the_cycle() -> None:
    over_task = float(np.degrees(worst_transmission(CRANK_ROCKER, *np.radians([60.0, 170.0]))))
    over_cycle = float(np.degrees(analysis.worst_transmission_cycle(CRANK_ROCKER)))
    assert over_cycle < over_task - 5
    for over, motion, worst in (("task", "task", over_task), ("cycle", "turn", over_cycle)):
        assert judged(Requirements(transmission_over=over, transmission_min_deg=worst)).ok
        strict = Requirements(transmission_over=over, transmission_min_deg=worst + 1e-4)
        defect = only(judged(strict), "transmission_min_deg")
        assert defect.what == f"the worst transmission angle over the {motion} in deg"
        assert defect.found == pytest.approx(worst)
        assert defect.allowed == f"from {worst + 1e-4:g}"
        assert defect.miss == pytest.approx(np.radians(1e-4), rel=1e-6)


def test_a_linkage_that_cannot_close_misses_the_targets() -> None:
    apart = FourBar(o2=(0, 0), o4=(9, 0), r2=1, r3=2, r4=2)
    verdict = verify(apart, MotionTask([[0, 0], [5, 0], [5, 5]], [0.0, 0.2, 0.4]), Requirements())
    keys = {defect.requirement for defect in verdict.defects}
    assert keys == {"exact", "same_branch", "rotatability"}
    assert np.isinf(verdict.error_max)
    assert not verdict.circuit_ok
    assert verdict.transmission_min_task == verdict.transmission_min_cycle == 0


def test_analysis_never_imports_casadi() -> None:
    code = "import sys, grashof.analysis; print('casadi' in sys.modules, 'grashof.synth' in sys.modules)"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.split() == ["False", "False"]
