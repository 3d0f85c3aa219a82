"""Soundness: linkages that meet a problem are in its pieces, and no bound is below what they transmit."""

from collections.abc import Callable

import numpy as np
import pytest
from piece_descent import JUST_BELOW, Descent, Designs, descent, of_table
from proof_problems import STAIRS, luggage, planted, random_poses, with_links

from grashof import load
from grashof.problems import Box, Problem
from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.synth.proof.curve.curve import Curve
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.curve.table import Table
from grashof.synth.proof.poses.pairs import rows_left
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.dyad_pairs import judged_pairs, screen
from grashof.synth.theory.burmester import Dyads, polish, trace_four_pose_curves

WITHIN = {"o2": Box((-4, 4), (-5, 5)), "b": Box((-3, 9), (-8, 8)), "a_on_body": Box((-6, 6), (-6, 6))}
TURNED = {"driver_sense": "ccw", "driver_rotation_deg": (20, 120), "ground_angle_deg": (-60, 90)}


def feasible_designs(problem: Problem, most: int, seed: int = 0) -> Designs:
    """At most `most` linkages that meet a problem, from traced curves, drawn at random."""
    scaled = ScaledProblem.of(problem)
    motion, body, wanted = scaled.motion, complex(scaled.targets[0]), scaled.wanted
    assert motion is not None
    longest = max(limits[1] for limits in wanted.link_lengths)
    reach = min(1 + 1.2 * ((wanted.coupler_arms or (0, 30))[1] + longest), 200.0)
    found = screen(motion, body, trace_four_pose_curves(motion, reach, 300, 0.02), wanted, 400_000)
    rng = np.random.default_rng(seed)
    if len(found) > most:
        found = found[np.sort(rng.choice(len(found), most, replace=False))]
    o2, o4, a, b, _ = found.points.T
    driver, driven = polish(motion, Dyads(a, o2), 3), polish(motion, Dyads(b, o4), 3)
    judged = judged_pairs(motion, body, driver, driven, wanted)
    good = judged.feasible & (judged.transmission > Required.of(scaled).floor + 2 * JUST_BELOW)
    one, other = (Dyads(each.moving - body, each.ground - body)[good] for each in (driver, driven))
    return Designs(one, other, judged.transmission[good])


def followed(problem: Problem, designs: Designs, levels: int = 8) -> Descent:
    """Follow designs down halves of pieces, each with its own transmission angle as the threshold."""
    required = Required.of(ScaledProblem.of(problem))
    table = Table.covering(required)
    slack = (1e-9, 1e-13, 1e-12)
    sides = [
        of_table(table, table.pieces.driver, designs.driver, slack),
        of_table(table, table.pieces.driven, designs.driven, slack),
    ]

    def left(pieces: list[IntArray], least: FloatArray) -> tuple[IntArray, FloatArray]:
        return rows_left(required, table.pieces, *pieces, least)

    return descent(sides, designs.transmission, left, levels)


CASES = {
    "luggage": load("luggage"),
    "short links over the turn": with_links(5, transmission_over="cycle"),
    "long links, crank-rocker": with_links(12, rotatability="crank-rocker"),
    "any rotatability": with_links(5, rotatability="any"),
    "any order": luggage(order=False),
    "any order and branch": luggage(order=False, same_branch=False, transmission_over="cycle"),
    "boxes": luggage(**WITHIN),
    "areas kept out": with_links(8, rotatability="any", keep_out=(STAIRS,)),
    "sense, rotation, ground angle": luggage(**TURNED),
    **{f"random {seed}": random_poses(seed, 4, rotatability="any") for seed in (104, 105)},
    **{
        f"any order, random {seed}": random_poses(seed, 4, rotatability="any", order=False)
        for seed in (100, 102)
    },
    "planted": planted(2),
    "planted, over the turn": planted(4, transmission_over="cycle"),
}
REPEATING = {"planted", "luggage", "boxes", "random 105", "any order", "any order, random 102"}


@pytest.mark.quick(*(set(CASES) - REPEATING))
@pytest.mark.parametrize("name", CASES)
def test_no_linkage_is_lost_or_bounded_too_low(name: str) -> None:
    problem = CASES[name]
    designs = feasible_designs(problem, 400)
    assert len(designs) > 10
    descent = followed(problem, designs)
    assert (descent.lost, descent.excluded) == (0, 0)
    assert descent.nearest < np.radians(0.1)  # sharp: a bound that is 0.1 deg too low would show


def off_the_ground_line(designs: Designs, curve: Curve) -> FloatArray:
    """How far A is from its places on the ground line when it is first or last at a pose, rad, at least.

    Where A almost passes the ground line, its transmission angle there must not count.
    """
    a, o2 = designs.driver.moving, designs.driver.ground
    line = np.angle(designs.driven.ground - o2)
    ends = (np.angle(place - o2) for place in (a, curve.rotation[-1] * a + curve.shift[-1]))
    off: FloatArray = np.min([np.abs((end - line + np.pi / 2) % np.pi - np.pi / 2) for end in ends], axis=0)
    return off


def least_area(designs: Designs, curve: Curve) -> FloatArray:
    """The smaller of the two triangles of A that state its sense, over the square of r2.

    It is small where the driver hardly moves between two poses.
    """
    a = designs.driver.moving
    chord = [(turn - 1) * a + move for turn, move in zip(curve.rotation, curve.shift, strict=True)]
    areas = [(chord[i].conj() * chord[j]).imag for i, j in ((1, 2), (2, 3))]
    least: FloatArray = np.min(np.abs(areas), axis=0) / np.abs(a - designs.driver.ground) ** 2
    return least


@pytest.mark.quick("8-off_the_ground_line", "0-least_area")
@pytest.mark.parametrize(
    ("seed", "measure"),
    [*((seed, off_the_ground_line) for seed in (2, 6, 8)), *((seed, least_area) for seed in (0, 3, 7))],
)
def test_no_linkage_is_lost_on_the_verge_of_another_case(
    seed: int, measure: Callable[[Designs, Curve], FloatArray]
) -> None:
    problem = planted(seed, rotatability="any")
    designs = feasible_designs(problem, 40_000)
    value = measure(designs, Required.of(ScaledProblem.of(problem)).curve)
    least = np.argsort(value)[:400]
    number, most = {off_the_ground_line: (399, np.radians(0.5)), least_area: (200, 1e-2)}[measure]
    assert value[least[number]] < most
    descent = followed(problem, designs[least], levels=12)
    assert (descent.lost, descent.excluded) == (0, 0)


@pytest.mark.slow
def test_no_linkage_is_lost_whose_angles_are_just_within_limits() -> None:
    designs = feasible_designs(luggage(driver_sense="ccw"), 12)
    curve = Required.of(ScaledProblem.of(luggage())).curve
    for k in range(0, len(designs), 6):
        one = designs[np.array([k])]
        a, o2, o4 = one.driver.moving[0], one.driver.ground[0], one.driven.ground[0]
        start, ground = np.degrees(np.angle([a - o2, o4 - o2])).tolist()
        last = curve.rotation[-1] * a + curve.shift[-1]
        turned = float(np.degrees(np.angle((last - o2) / (a - o2)))) % 360
        for limits in (
            {"theta2_start_deg": start},
            {"ground_angle_deg": ground},
            {"ground_angle_deg": (ground, ground + 30)},
            {"driver_sense": "ccw", "driver_rotation_deg": (turned - 1e-6, turned + 1e-6)},
            {"driver_sense": "ccw", "driver_rotation_deg": (0, turned + 1e-6)},
        ):
            descent = followed(luggage(**limits), one, levels=12)
            assert (descent.lost, descent.excluded) == (0, 0), limits
