"""Two outputs judged: swings, time ratios, synchrony and accelerations by circles and by body coordinates."""

from dataclasses import replace

import numpy as np
import pytest
from body_coordinates import follow, rates, start
from body_plans import plan_of
from random_linkages import six_bars

from grashof.analysis import verify
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.meeting.two_outputs import two_outputs
from grashof.problems import DynamicsSpec, LinkSwing, Problem, Requirements, SixBar, TandemTask

TURN = 2 * np.pi
WIPER = SixBar(
    *((100, -50), (0, 0), 25, 104.5, 36),
    **{"c": (140, 167), "d": (560, 0), "r5": 441.5, "r6": 223, "hosts": (4, 1)},
    **{"point_link": 6, "coupler_point": (223, 0), "assembly": 1, "assembly_2": 1},
)


def crossing(one: complex, first: float, other: complex, second: float, side: int) -> complex:
    """Where two circles meet, to the left (+1) of the way from one centre to the other."""
    way = other - one
    apart = abs(way)
    along = (first**2 - second**2 + apart**2) / (2 * apart)
    return one + way / apart * (along + 1j * side * np.sqrt(first**2 - along**2))


def angles_by_circles(linkage: SixBar, theta2: float) -> tuple[float, float]:
    """theta4 and theta6 by two crossings of circles."""
    o2, o4, c, d = (complex(*getattr(linkage, name)) for name in ("o2", "o4", "c", "d"))
    crank = np.exp(1j * theta2)
    bars = float(linkage.r3), float(linkage.r4)
    b = crossing(o2 + linkage.r2 * crank, bars[0], o4, bars[1], int(linkage.assembly))
    along = (b - o4) / abs(b - o4)
    pin = o4 + c * along if linkage.choices["hosts"][0] == 4 else o2 + c * crank
    e = crossing(pin, float(linkage.r5), d, float(linkage.r6), int(linkage.assembly_2))
    return float(np.angle(along)), float(np.angle(e - d))


def task_of(linkage: SixBar) -> TandemTask:
    """The swings and time ratios of a linkage."""
    found = two_outputs(linkage, (4, 6))
    assert found is not None
    pairs = zip((4, 6), found.swings, found.time_ratios, strict=True)
    return TandemTask(
        [LinkSwing(link, swing, ratio if np.isfinite(ratio) else None) for link, swing, ratio in pairs]
    )


def test_figures_of_a_wiper_by_hand() -> None:
    """Circles, a dense turn, and accelerations by differences of fourth order."""
    count = 14_400
    theta2 = np.arange(count) * TURN / count
    angles = np.unwrap([angles_by_circles(WIPER, angle) for angle in theta2], axis=0)
    step = TURN / count * 20
    bends = (
        -np.roll(angles, 40, 0) + 16 * np.roll(angles, 20, 0) - 30 * angles
        + 16 * np.roll(angles, -20, 0) - np.roll(angles, -40, 0)
    ) / (12 * step**2)  # fmt: skip
    task = task_of(WIPER)
    problem = Problem(task=task, length_unit="mm")
    verdict = verify(WIPER, task, problem.requirements, problem=problem)
    values = Values(WIPER, verdict, problem)
    np.testing.assert_allclose([values["swing_4"], values["swing_6"]], np.ptp(angles, axis=0), atol=1e-7)
    assert values["output_acceleration_max"] == pytest.approx(np.abs(bends).max(), rel=1e-6)
    low, high = angles.min(axis=0), angles.max(axis=0)
    one, other = ((angles - low) / (high - low)).T
    by_hand = min(np.abs(one - other).max(), np.abs(one + other - 1).max())
    assert values["synchrony_error"] == pytest.approx(by_hand, abs=1e-6)
    for column, name in zip(angles.T, ("time_ratio_4", "time_ratio_6"), strict=True):
        there = (theta2[column.argmax()] - theta2[column.argmin()]) % TURN
        ratio = max(there, TURN - there) / min(there, TURN - there)
        assert values[name] == pytest.approx(ratio, rel=2e-3)
    assert not verdict.defects


@pytest.mark.quick("pins 2 1")
@pytest.mark.parametrize("row", ["pins 4 1", "pins 2 1"])
def test_figures_are_those_of_body_coordinates(row: str) -> None:
    linkages, theta2 = six_bars(row, 6, np.random.default_rng(3)), np.linspace(0, TURN, 721)
    plan = plan_of(linkages)
    q = follow(plan, start(plan, theta2[0]), theta2[0], theta2)
    motion = rates(plan, q)
    turned, bends = (each[..., [8, 14]] for each in (np.unwrap(q, axis=0), motion[2]))
    count = 0
    for k, linkage in enumerate(linkages):
        found = two_outputs(linkage, (4, 6))
        assert found is not None
        angles = turned[:, k]
        fully = np.abs(angles[-1] - angles[0]) > 6
        np.testing.assert_array_equal(np.isinf(found.swings), fully)
        if fully.any():
            assert np.isnan(found.synchrony_error)
            continue
        np.testing.assert_allclose(found.swings, np.ptp(angles, axis=0), atol=4e-4)
        low, high = angles.min(axis=0), angles.max(axis=0)
        one, other = ((angles - low) / (high - low)).T
        error = min(np.abs(one - other).max(), np.abs(one + other - 1).max())
        assert found.synchrony_error == pytest.approx(error, abs=2e-3)
        if max(found.swings) < np.pi and np.isfinite(found.time_ratios).all():
            task = task_of(linkage)
            verdict = verify(linkage, task, Requirements(link_ratio_max=1e6))
            values = Values(linkage, verdict, Problem(task=task))
            top = int(np.abs(bends[:, k]).max(axis=1).argmax())
            near = theta2[top] + np.linspace(-1, 1, 201) * theta2[1]
            there = rates(one_plan := plan.taken([k]), follow(one_plan, q[top, [k]], theta2[top], near))
            peak = np.abs(there[2][..., [8, 14]]).max()
            assert values["output_acceleration_max"] == pytest.approx(peak, rel=1e-5)
            assert [str(each) for each in verdict.defects if each.requirement == "exact"] == []
            count += 1
    assert count > 0


def test_the_speed_of_the_driver_counts_squared() -> None:
    task = task_of(WIPER)
    slow = Problem(task=task, length_unit="mm")
    fast = replace(slow, dynamics=DynamicsSpec(mass_per_length=1e-3, speed_rpm=30))
    verdict = verify(WIPER, task, slow.requirements, problem=slow)
    one, other = (Values(WIPER, verdict, each)["output_acceleration_max"] for each in (slow, fast))
    assert other == pytest.approx(np.pi**2 * one, rel=1e-12)


def _exact(linkage: SixBar, task: TandemTask) -> list[str]:
    verdict = verify(linkage, task, Requirements(link_ratio_max=1e6))
    return [str(each) for each in verdict.defects if each.requirement == "exact"]


def test_misses_are_named_by_link() -> None:
    task = task_of(WIPER)
    four, six = task.strokes
    assert _exact(WIPER, TandemTask([replace(four, swing=four.swing + 5e-7), six])) == []
    (line,) = _exact(WIPER, TandemTask([four, replace(six, swing=six.swing + 2e-6)]))
    assert line.startswith("exact: the swing of link 6 in deg is ")
    assert six.time_ratio is not None
    (line,) = _exact(WIPER, TandemTask([four, replace(six, time_ratio=six.time_ratio * 1.001)]))
    assert line.startswith("exact: the time ratio of link 6 is ")


def test_links_that_do_not_swing_are_a_defect() -> None:
    task, turn = task_of(WIPER), np.linspace(0, TURN, 721)
    locked = WIPER.changed(r5=np.float64(300.0))
    assert "the number of links that swing over a full turn of the driver is 0" in _exact(locked, task)[0]
    slides = SixBar(
        *((100, -50), (0, 0), 25, 104.5, 36),
        **{"c": (-60, 130), "slide_angle_2": 0.0, "offset_2": 0.0, "r5": 470, "hosts": (4, 1)},
    )
    assert "the number of links that swing" in _exact(slides, task)[0]
    spinning = SixBar(
        *((0, 0), (4, 0), 1, 4, 3),
        **{"c": (3, 0), "d": (0.2, 0.1), "r5": 3.0, "r6": 3.1, "hosts": (2, 1), "point_link": 6},
    )
    angles = np.unwrap([angles_by_circles(spinning, angle)[1] for angle in turn])
    assert abs(angles[-1] - angles[0]) > 6
    assert any(line.startswith("exact: the swing of link 6 in deg is 360") for line in _exact(spinning, task))
