"""Strokes judged: where the limit positions are, and what swing and time ratio miss."""

import numpy as np
import pytest

from grashof.analysis import solve_position, verify
from grashof.analysis.judge.measures import Values
from grashof.problems import Box, FourBar, Problem, Requirements, StrokeTask, TargetLimits

NORTON = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
TASK = StrokeTask.from_degrees(swing_deg=73.78177, time_ratio=1.355573)
LOOSE = Requirements(tolerance=1e-5)


def turned(linkage: FourBar, angle: float, scale: float = 1.0, mirrored: bool = False) -> FourBar:
    """The linkage turned about the origin, scaled, and perhaps mirrored in the x axis."""
    o2, o4 = (complex(*place) for place in (linkage.o2, linkage.o4))
    made = [scale * np.exp(1j * angle) * (place.conjugate() if mirrored else place) for place in (o2, o4)]
    lengths = (float(scale * length) for length in (linkage.r2, linkage.r3, linkage.r4))
    sign = -1 if mirrored else 1
    return FourBar(*((place.real, place.imag) for place in made), *lengths, assembly=sign * linkage.assembly)


def test_textbook_linkage_does_its_own_stroke() -> None:
    verdict = verify(NORTON, TASK, LOOSE)
    assert verdict.ok
    np.testing.assert_allclose(np.degrees(verdict.theta2), [24.1468, 231.3178], atol=5e-5)
    assert verdict.direction == 1
    assert (verdict.circuit_ok, verdict.branch_ok, verdict.order_ok) == (True, True, True)
    assert verdict.transmission_min_task == verdict.transmission_min_cycle
    assert np.isnan([verdict.error_max, verdict.error_rms, verdict.error_sse]).all()


@pytest.mark.parametrize("assembly", [1, -1])
@pytest.mark.parametrize("sense", ["ccw", "cw"])
@pytest.mark.parametrize("angle", [0.0, 0.7, 3.0, -2.0])
def test_targets_are_where_driver_and_coupler_are_in_line(assembly: int, sense: str, angle: float) -> None:
    linkage = turned(NORTON, angle, 0.3, mirrored=assembly < 0)
    verdict = verify(linkage, TASK, Requirements(tolerance=1e-5, driver_sense=sense))
    assert verdict.ok
    assert verdict.direction == (1 if sense == "ccw" else -1)
    state = solve_position(linkage, verdict.theta2)
    assert np.abs(np.sin(state.theta3 - verdict.theta2)).max() < 1e-9
    assert -np.pi < verdict.theta2[0] <= np.pi
    slow = verdict.direction * float(np.diff(verdict.theta2)[0])
    assert slow == pytest.approx(TASK.driver_rotation, abs=1e-5)


def stands(end: int) -> tuple[complex, complex]:
    """A and B in the stretched (0) and in the folded position (1), by the triangle O2-B-O4."""
    far = 160 if end == 0 else 80
    along = (far**2 + 100**2 - 80**2) / 200
    ahead = (along + 1j * np.sqrt(far**2 - along**2)) / far
    return (1 - 2 * end) * 40 * ahead, far * ahead


@pytest.mark.parametrize("kept", [True, False])
@pytest.mark.parametrize("sense", ["ccw", "cw"])
@pytest.mark.parametrize("target", [1, 2])
@pytest.mark.parametrize("name", ["a", "b", "distances", "coupler_angle_deg", "transmission_min_deg"])
def test_limits_hold_in_the_limit_position_that_is_named(
    name: str, target: int, sense: str, kept: bool
) -> None:
    """The slow stroke begins stretched where the driver turns counter-clockwise, else folded."""
    a, b = stands(target - 1 if sense == "ccw" else 2 - target)
    by = 1e-6 if kept else -1e-6
    mu = np.degrees(abs(np.angle((b - a) / (b - 100))))
    coupler = float(np.degrees(np.angle(b - a)))
    given = {
        "a": Box(x=(a.real - by, np.inf)),
        "b": Box(y=(-np.inf, b.imag + by)),
        "distances": {"a-o4": (abs(a - 100) - by, 1e6)},
        "coupler_angle_deg": (coupler - 50, coupler + by),
        "transmission_min_deg": float(min(mu, 180 - mu)) - by,
    }
    at = (TargetLimits(targets=[target], **{name: given[name]}),)
    wanted = Requirements(tolerance=1e-5, driver_sense=sense, at=at)
    verdict = verify(NORTON, TASK, wanted)
    assert [each.requirement for each in verdict.defects] == ([] if kept else ["at"])
    assert all(f"at target {target}" in each.what for each in verdict.defects)


@pytest.mark.parametrize("sense", ["ccw", "cw"])
def test_of_strokes_that_take_equally_long_the_first_begins_stretched(sense: str) -> None:
    swing, share = np.radians(60), 0.3
    r4 = share / np.sin(swing / 2)  # half the chord of B is r2
    even = FourBar(o2=(0, 0), o4=(float(np.hypot(1, r4 * np.cos(swing / 2))), 0), r2=share, r3=1, r4=r4)
    verdict = verify(even, StrokeTask(swing=float(swing)), Requirements(driver_sense=sense))
    assert verdict.ok
    state = solve_position(even, verdict.theta2)
    assert np.cos(state.theta3 - verdict.theta2) == pytest.approx([1, -1])


@pytest.mark.parametrize(
    ("swing", "ratio", "missed"),
    [
        (73.78177, 1.355573, []),
        (73.9, 1.355573, ["the swing in deg"]),
        (73.78177, 1.36, ["the time ratio"]),
        (20, 1.0, ["the swing in deg", "the time ratio"]),
    ],
)
def test_missed_swings_and_ratios_are_reported(swing: float, ratio: float, missed: list[str]) -> None:
    verdict = verify(NORTON, StrokeTask.from_degrees(swing_deg=swing, time_ratio=ratio), LOOSE)
    assert [defect.what for defect in verdict.defects] == missed
    assert all(defect.requirement == "exact" and defect.miss > 0 for defect in verdict.defects)


def test_an_output_that_turns_fully_swings_by_a_turn() -> None:
    double_crank = FourBar(o2=(0, 0), o4=(1, 0), r2=2, r3=2.5, r4=2.2)
    assert "exact: the swing in deg is 360" in str(verify(double_crank, TASK, LOOSE).defects[0])


def test_a_driver_that_swings_has_no_time_ratio() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=2, r4=2.5)
    verdict = verify(rocker, TASK, Requirements(tolerance=1e-5, rotatability="any"))
    assert {"exact", "rotatability"} <= {defect.requirement for defect in verdict.defects}


def test_a_change_point_is_no_crank() -> None:
    verdict = verify(FourBar(o2=(0, 0), o4=(3, 0), r2=1, r3=3, r4=1), TASK, LOOSE)
    assert "rotatability" in {defect.requirement for defect in verdict.defects}


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_the_scale_is_free_however_small_or_great(scale: float) -> None:
    assert verify(turned(NORTON, 0.4, scale), TASK, LOOSE).ok


def test_limits_of_lengths_are_kept() -> None:
    verdict = verify(NORTON, TASK, Requirements(tolerance=1e-5, r1=(120, 120), a=None, r4=(0, 70)))
    assert [defect.requirement for defect in verdict.defects] == ["r1", "r4"]


def test_quantities_of_a_stroke() -> None:
    problem = Problem(task=TASK, requirements=LOOSE, length_unit="mm")
    values = Values(NORTON, verify(NORTON, TASK, LOOSE), problem)
    assert np.degrees(values["output_swing"]) == pytest.approx(73.78182, abs=1e-5)
    assert values["time_ratio"] == pytest.approx(1.355573, abs=1e-6)
    assert values["driver_rotation"] == pytest.approx(TASK.driver_rotation, abs=1e-5)
    assert np.isnan(values["hausdorff"])
    assert np.isnan(values["error_max"])
