"""Moving, turning, scaling and mirroring a linkage with its task changes nothing in the verdict."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, driver_ranges, solve_position, verify
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar, MotionTask, Requirements

CHECKED = settings(max_examples=10)
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]


@dataclass(frozen=True)
class Similarity:
    """z -> shift + scale e^(i turn) z, of the complex conjugate when mirrored."""

    shift: complex
    scale: float
    turn: float
    mirrored: bool

    @property
    def sense(self) -> int:
        return -1 if self.mirrored else 1

    def points(self, points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        moved = points @ np.array([1, 1j * self.sense]) * self.scale * np.exp(1j * self.turn) + self.shift
        return np.stack([moved.real, moved.imag], axis=-1)

    def linkage(self, given: FourBar) -> FourBar:
        bars = (self.scale * length for length in given.lengths[1:])
        point = self.scale * given.coupler_point * [1, self.sense]
        signs = self.sense * given.assembly, self.sense * given.body_angle
        return FourBar(self.points(given.o2), self.points(given.o4), *bars, point, *signs)

    def task(self, given: MotionTask) -> MotionTask:
        return MotionTask(
            self.points(given.positions),
            self.turn + self.sense * given.angles,
            angle_length=self.scale * given.angle_length,
        )

    def requirements(self, given: Requirements, theta1: float, start: float) -> Requirements:
        """Lengths scaled, angles turned; in such a frame the limits of each make a defect or none."""
        return Requirements(
            rotatability=given.rotatability,
            rotatability_margin=given.rotatability_margin,
            order=given.order,
            transmission_min_deg=given.transmission_min_deg,
            transmission_over=given.transmission_over,
            tolerance=given.tolerance,
            link_length=(0, 1.1 * self.scale * 4),
            coupler_arms=(0.3 * self.scale, 2.4 * self.scale),
            ground_angle_deg=np.degrees(self.turn + self.sense * theta1),
            theta2_start_deg=np.degrees(self.turn + self.sense * start),
        )


QUARTERS = [0.0, np.pi / 2, np.pi]
AS_IT_IS = Similarity(0, 1.0, 0.0, False)
similarities = st.builds(
    Similarity,
    shift=st.builds(complex, st.floats(-10, 10), st.floats(-10, 10)),
    scale=st.floats(0.1, 10),
    turn=st.one_of(st.floats(-np.pi, np.pi), st.sampled_from(QUARTERS)),
    mirrored=st.booleans(),
)


def drawn_task(linkage: FourBar, data: st.DataObject) -> tuple[MotionTask, float]:
    """Poses near to positions of the linkage, on one assembly or both, in one range or both."""
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    ranges = driver_ranges(linkage)
    ranges = ranges[np.isfinite(ranges[:, 0])]
    low, high = ranges[rng.integers(0, len(ranges) if data.draw(st.booleans()) else 1, 4)].T
    theta2 = low + (high - low) * rng.uniform(0.02, 0.98, 4)
    if data.draw(st.booleans()):
        theta2 = np.sort(theta2)
    signs = rng.choice([1, -1], 4) if data.draw(st.booleans()) else linkage.assembly
    state = solve_position(linkage, theta2, signs)
    noise = data.draw(st.sampled_from([0.0, 1e-3, 0.05])) * rng.normal(size=(4, 3))
    positions = state.p + linkage.r3 * noise[:, :2]
    angles = state.theta3 + linkage.body_angle + noise[:, 2]
    return MotionTask(positions, angles, angle_length=float(linkage.r3)), float(theta2[0])


@pytest.mark.quick("double-crank")
@pytest.mark.parametrize("kind", [kind for kind in FOUR_BAR_CLASSES if kind is not GrashofClass.CHANGE_POINT])
@given(data=st.data())
@CHECKED
def test_verdicts_do_not_depend_on_the_frame(
    four_bars: Drawer, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    task, start = drawn_task(linkage, data)
    wanted = Requirements(
        rotatability=data.draw(st.sampled_from(["any", "full-crank", "crank-rocker", "double-crank"])),
        rotatability_margin=0.0123,
        order=data.draw(st.booleans()),
        transmission_min_deg=data.draw(st.sampled_from([0.0, 17.3, 33.1])),
        transmission_over=data.draw(st.sampled_from(["task", "cycle"])),
        tolerance=1.23e-3,
    )
    moved = data.draw(similarities)
    theta1 = float(linkage.theta1) + data.draw(st.sampled_from([0.0, 0.1]))
    one = verify(linkage, task, AS_IT_IS.requirements(wanted, theta1, start))
    other = verify(moved.linkage(linkage), moved.task(task), moved.requirements(wanted, theta1, start))

    for flag in ("ok", "circuit_ok", "branch_ok", "order_ok", "full_rotation", "grashof_class"):
        assert getattr(one, flag) == getattr(other, flag), flag
    keys, other_keys = ([(d.requirement, d.what) for d in v.defects] for v in (one, other))
    assert keys == other_keys
    for here, there in zip(one.defects, other.defects, strict=True):
        assert there.miss == pytest.approx(here.miss, rel=1e-6, abs=1e-6)
    assert other.assembly.tolist() == (moved.sense * one.assembly).tolist()
    assert np.exp(1j * other.theta2) == pytest.approx(
        np.exp(1j * (moved.turn + moved.sense * one.theta2)), abs=1e-6
    )
    if wanted.order:
        assert other.direction == moved.sense * one.direction
    # Where a sum of squares is least, its driver angle is known to half the digits.
    atol = 1e-6 * float(linkage.lengths.max())
    np.testing.assert_allclose(other.position_error / moved.scale, one.position_error, rtol=0, atol=atol)
    np.testing.assert_allclose(other.angle_error, one.angle_error, rtol=0, atol=1e-6)
    for worst in ("transmission_min_task", "transmission_min_cycle"):
        assert getattr(other, worst) == pytest.approx(getattr(one, worst), abs=1e-6)
    if moved.turn in QUARTERS:  # the box whose diagonal is the size stays upright
        assert other.size == pytest.approx(moved.scale * one.size, rel=1e-6)
