"""Linkages with two swings in closed form, and the search among them."""

from typing import Any

import numpy as np
import pytest
from random_linkages import six_bars

from grashof.analysis import solve_kinematics, worst_transmission_cycle
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.meeting.two_outputs import two_outputs
from grashof.analysis.judge.verify import verify
from grashof.problems import Box, LinkSwing, Problem, Requirements, SixBar, TandemTask
from grashof.problems.values.arrays import FloatArray
from grashof.synth.starts.strokes.tandem import linkages
from grashof.synth.starts.strokes.tandem_numbers import numbers_of
from grashof.synth.starts.strokes.tandem_search import TandemAim, drawn, searched
from grashof.synth.starts.strokes.tandem_shapes import DRIVEN_BY_4, DRIVEN_BY_CRANK, transmissions

BOTH = [DRIVEN_BY_4, DRIVEN_BY_CRANK]
HOSTS = pytest.mark.parametrize("hosts", BOTH, ids=["link 4", "crank"])
FIXED: dict[str, Any] = {"o2": Box((1, 1), (-1, -1)), "o4": Box((0, 0), (0, 0)), "d": Box((5, 5), (0.5, 0.5))}


def aim_of(swings: FloatArray, *ratios: float | None, **wanted: Any) -> TandemAim:
    """Of swings of links 4 and 6, their time ratios, and requirements."""
    each = zip((4, 6), swings.tolist(), ratios or (None, None), strict=True)
    task = TandemTask([LinkSwing(link, swing, ratio) for link, swing, ratio in each])
    return TandemAim.of(Problem(task=task, requirements=Requirements(**wanted)))


def drawn_linkages(aim: TandemAim, hosts: tuple[int, int], count: int) -> Any:
    """Of random ones those that have both swings, and their shapes."""
    rng = np.random.default_rng(7)
    numbers, sides = drawn(rng, count // 2)
    with np.errstate(all="ignore"):
        found = aim.judged(hosts, numbers, sides)
        found = found.taken(found.missed == 0)
        made = aim.made(hosts, found.unknowns, found.sides)
    return made, linkages(made), found


@pytest.mark.slow
@HOSTS
def test_random_shapes_have_both_swings_and_turn_fully(hosts: tuple[int, int]) -> None:
    aim = aim_of(np.radians([80, 65]), link_ratio_max=50.0, **FIXED)
    made, found, _ = drawn_linkages(aim, hosts, 1500)
    assert len(found) > 20
    motion = made.motion()
    mu, peaks = transmissions(made, motion), motion.accelerations
    errors, sizes = motion.synchrony_errors(aim.swings.swings), motion.sizes(made)
    for k, linkage in enumerate(found[:20]):
        outputs = two_outputs(linkage, (4, 6))
        assert outputs is not None
        np.testing.assert_allclose(np.degrees(outputs.swings), [80, 65], atol=1e-6)
        assert mu[k] == pytest.approx(float(worst_transmission_cycle(linkage)), abs=1e-3)
        verdict = verify(linkage, aim.problem.task, aim.wanted, problem=aim.problem)
        values = Values(linkage, verdict, aim.problem)
        assert verdict.ok
        assert errors[k] == pytest.approx(values["synchrony_error"], rel=1e-2, abs=1e-3)
        assert sizes[k] == pytest.approx(values["size"], rel=5e-3)
        if mu[k] > 0.3:  # elsewhere peaks are narrow
            assert peaks[k] == pytest.approx(values["output_acceleration_max"], rel=2e-2)


@pytest.mark.quick("link 4")
@HOSTS
def test_time_ratios_are_met_too(hosts: tuple[int, int]) -> None:
    ratios = (1.12, None) if hosts == DRIVEN_BY_4 else (1.12, 1.05)
    aim = aim_of(np.radians([60, 40]), *ratios, link_ratio_max=50.0)
    for linkage in drawn_linkages(aim, hosts, 1500)[1][:6]:
        outputs = two_outputs(linkage, (4, 6))
        assert outputs is not None
        expected = (1.12, 1.12) if hosts == DRIVEN_BY_4 else ratios
        np.testing.assert_allclose(outputs.time_ratios, expected, rtol=1e-8)


def test_different_time_ratios_leave_one_kind_of_drive() -> None:
    swings = np.radians([60, 40])
    assert aim_of(swings, 1.1, 1.1).drives == aim_of(swings, None, 1.1).drives == BOTH
    assert aim_of(swings, 1.1, 1.2).drives == [DRIVEN_BY_CRANK]


@pytest.mark.slow
@HOSTS
def test_planted_linkages_are_among_them(hosts: tuple[int, int]) -> None:
    """Those whose first loop, or both, are crank-rockers and whose outputs turn back twice."""
    planted = six_bars(f"pins {hosts[0]} {hosts[1]}", 30, np.random.default_rng(5))
    count = 0
    for linkage in planted:
        outputs = two_outputs(linkage, (4, 6))
        if outputs is None or max(outputs.swings) >= np.pi or np.isnan(outputs.time_ratios).any():
            continue
        boxes = {
            name: Box((x, x), (y, y))
            for name in ("o2", "o4", "d")
            for x, y in [getattr(linkage, name).tolist()]
        }
        aim = aim_of(np.array(outputs.swings), **boxes)
        numbers = numbers_of(linkage, aim)
        assert numbers is not None
        assert numbers[0] == hosts
        if not (
            0 < numbers[1][6:].min() <= numbers[1][6:].max() < 1
        ):  # beyond what is searched, such as a tiny arm
            continue
        (again,) = linkages(aim.made(hosts, numbers[1][None], numbers[2][None]))
        assert isinstance(again, SixBar)
        for name in ("r2", "r3", "r4", "r5", "r6", "c", "d", "assembly", "assembly_2"):
            mine, other = getattr(again, name), getattr(linkage, name)
            np.testing.assert_allclose(mine, other, atol=1e-6 * float(linkage.lengths.max()), err_msg=name)
        count += 1
    assert count >= 3


@pytest.mark.study
@pytest.mark.parametrize("seed", range(2))
def test_a_search_is_as_good_as_the_best_of_many_random_ones(seed: int) -> None:
    rng = np.random.default_rng(seed)
    swings = np.radians(rng.uniform(30, 95, 2))
    there = {
        name: Box((x, x), (y, y))
        for name, (x, y) in zip(
            ("o2", "o4", "d"), [*rng.normal(0, 1, (2, 2)), rng.normal(0, 3, 2)], strict=True
        )
    }
    aim = aim_of(swings, transmission_min_deg=25.0, **there)
    for hosts in BOTH:
        best = searched(aim, hosts, np.random.default_rng(1))
        some = drawn_linkages(aim, hosts, 6000)[2]
        if len(some.score):
            assert (best.missed == 0).all()
            assert best.score.max() >= some.score.max()


def test_usable_transmission_is_looked_for_where_none_is_stated() -> None:
    swings = np.radians([60, 40])
    free, stated = aim_of(swings), aim_of(swings, transmission_min_deg=5.0)
    assert (free.least_deg, free.usable.least_deg) == (0.5, 15.0)
    assert stated.usable is stated
    assert stated.least_deg == 5.0


def test_pivots_stay_in_their_boxes() -> None:
    rng, boxes = np.random.default_rng(0), {"o2": Box((1, 2), (3, 3)), "d": Box((8, 9))}
    for wanted in (
        {**boxes, "o4": Box((-1, 0), (4, 5))},
        boxes,
        {"d": boxes["d"]},
        {"d": boxes["o2"]},
        {"o4": boxes["o2"]},
        {},
    ):
        aim = aim_of(np.radians([60, 40]), **wanted)
        numbers = rng.random((50, 6))
        pivots = aim.pivots(numbers)
        for name, place in zip(("o2", "o4", "d"), pivots.T, strict=True):
            for (low, high), at in zip(
                *[(b.x, b.y) for b in [wanted.get(name, Box())]], (place.real, place.imag), strict=True
            ):
                assert low - 1e-12 <= at.min() <= at.max() <= high + 1e-12, (name, wanted)
        if (
            wanted.get("d") is not boxes["d"]
        ):  # of a box that is open at two sides only places nearby are made
            again = np.array([aim.places(*each) for each in pivots.tolist()])
            np.testing.assert_allclose(aim.pivots(again), pivots, atol=1e-9)


def test_a_state_of_motion_is_that_of_the_analysis() -> None:
    aim = aim_of(np.radians([80, 65]), link_ratio_max=50.0, **FIXED)
    for hosts in BOTH:
        made, found, _ = drawn_linkages(aim, hosts, 1500)
        motion = made.motion()
        theta2 = np.linspace(0, 2 * np.pi, motion.a.shape[1])
        for k, linkage in enumerate(found[:3]):
            state = solve_kinematics(linkage, theta2)
            for bend, alpha in ((motion.first.bend, state.alpha4), (motion.second.bend, state.alpha6)):
                np.testing.assert_allclose(bend[k], alpha, rtol=1e-7, atol=1e-7 * np.abs(alpha).max())
            e = state.e.position
            np.testing.assert_allclose(motion.e[k], e[..., 0] + 1j * e[..., 1], atol=1e-9)
