"""Struts: the greatest deviation from the wanted effort, and that of an independent search ten times as long.

The independent search knows nothing of `grashof.synth`: it follows the four-bar by the elbow formula, takes
the effort from differences of potential energy along the path of the hand, and improves random places and
sizes by differential evolution. Both values are the judge's. A case fails where the deviation of
`place_parts` exceeds 1.05 times that of the other; where limits are kept, margins are compared.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from time import process_time
from typing import Any

import numpy as np
import shapely
from independent_limits import elbow
from measuring import Case

from grashof import load, synthesize
from grashof.analysis.effort.case import EffortCase
from grashof.analysis.effort.deviation import effort_figures
from grashof.analysis.judge.effort_travel import effort_of_design
from grashof.problems import Box, MotionTask, Problem, Region, Requirements, Rotatability
from grashof.problems.files.effort_schema import usual_sizes
from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.effort import EffortSpec
from grashof.problems.values.dynamics.struts import BODY, EffortPlace, PartSpec
from grashof.synth.effort.placing import placed

TIMES, DESIGNS = 10, 3
STEPS, MEMBERS = 120, 300


def bonnet() -> Problem:
    """The bonnet of the gallery, with P in its centre of mass, and two struts."""
    around = Box((-60, 350), (-260, -60))
    plate = Box((-520, -170), (-60, 30))
    part = PartSpec(
        "gas",
        (EffortPlace(1, Box((-50, 700), (-250, -80))), EffortPlace(BODY, Box((-500, 300), (-80, -20)))),
        usual_sizes("gas", "mm"),
        count=2,
    )
    effort = EffortSpec(
        EffortPlace(BODY, Box((520, 520), (-10, -10))),
        wanted=((0.0, 40.0), (25.0, 0.0), (50.0, -30.0)),
        temperatures_c=(-10.0, 40.0),
        parts=(part,),
    )
    return Problem(
        name="bonnet",
        length_unit="mm",
        task=MotionTask.from_degrees([[520, -40, 0], [539.046, 83.905, 10], [440.891, 382.632, 50]]),
        requirements=Requirements(
            rotatability=Rotatability.ANY,
            link_length=(60, 260),
            o2=around,
            o4=around,
            a_on_body=plate,
            b_on_body=plate,
        ),
        dynamics=DynamicsSpec(payload=18, gravity=(0, -9.81), effort=effort),
    )


# Corners of polygons in shares of the box around them, of the fixed end and of the moving one.
SLANTED = [(0.0, 0.3), (0.7, 0.0), (1.0, 0.4), (0.4, 1.0)]
NOTCHED = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.6), (0.6, 0.2), (0.3, 1.0), (0.0, 0.8)]


def in_polygons(of: Callable[[], Problem]) -> Problem:
    """The same with a polygon in the box of each end, one of them concave."""
    problem = of()
    dynamics = problem.dynamics
    if dynamics is None or dynamics.effort is None:
        return problem
    (part,) = dynamics.effort.parts
    first, second = (
        replace(place, at=Region(inside=places_in(place.at, np.array(corners)).tolist()))
        for place, corners in zip(part.places, (SLANTED, NOTCHED), strict=True)
    )
    effort = replace(dynamics.effort, parts=(replace(part, between=(first, second)),))
    return replace(problem, dynamics=replace(dynamics, effort=effort))


@dataclass(frozen=True, slots=True)
class Moves:
    """A four-bar in steps of its travel: middles of links 1 and of the body in N places."""

    origin: ComplexArray  # of the body
    axis: ComplexArray
    angle: FloatArray  # deg, from the start of the travel, halfway between two places
    hand: FloatArray  # paths of the hand, (N - 1,)
    weight: FloatArray  # gain of potential energy, N mm


def moves(problem: Problem, case: EffortCase) -> Moves:
    """The body along the travel, by the elbow formula; its sense is that of the judge."""
    linkage: Any = case.linkage  # a four-bar
    spec = case.spec
    places = np.linspace(case.travel.start, case.travel.end, STEPS)
    at = case.travel.at(places)
    theta2, side = at.theta2, np.sign(at.margins[0])
    o2, o4 = complex(*linkage.o2), complex(*linkage.o4)
    a = o2 + linkage.r2 * np.exp(1j * theta2)
    b = a + elbow(o4 - a, linkage.r3, linkage.r4, side)
    along = (b - a) / linkage.r3
    p = a + complex(*linkage.coupler_point) * along
    axis = along * np.exp(1j * float(linkage.body_angle))
    hand = p + complex(*spec.on.point) * axis
    turned = np.degrees(np.unwrap(np.angle(axis)))
    turned = np.abs(turned - turned[0])
    mass = 0.0 if problem.dynamics is None else problem.dynamics.payload
    return Moves(
        p, axis, (turned[1:] + turned[:-1]) / 2, np.abs(np.diff(hand)), mass * 9.81 * np.diff(p.imag)
    )


def deviations(moved: Moves, spec: EffortSpec, x: FloatArray, rows: IntArray) -> FloatArray:
    """The greatest excess of candidates (K, 4) of sizes (K,), N; strokes that end inside cost much."""
    (part,) = spec.parts
    ends: list[Any] = []
    for place, shares in zip(part.places, (x[:, :2], x[:, 2:]), strict=True):
        at = places_in(place.at, shares) @ np.array([1, 1j])
        ends.append(at[:, None] if place.link == 1 else moved.origin + at[:, None] * moved.axis)
    length = np.abs(ends[1] - ends[0])
    sizes = np.array(
        [(z.extended, z.compressed, z.force_extended, z.force_compressed, z.friction) for z in part.sizes]
    )
    extended, compressed, last, first, rubbed = (sizes[rows, k][:, None] for k in range(5))
    slope = (first - last) / (extended - compressed)
    stored = part.count * (slope * (extended - length) ** 2 / 2 - last * length)
    worst = np.full(len(x), -np.inf)
    friction = part.count * rubbed * np.abs(np.diff(length, axis=1)) / moved.hand
    for warm in {part.warmth(each) for each in spec.temperatures_c}:
        effort = (moved.weight + warm * np.diff(stored, axis=1)) / moved.hand
        for over in excesses(spec, moved.angle, effort, friction):
            worst = np.maximum(worst, over.max(axis=1, initial=-np.inf))
    past = np.maximum(length.max(axis=1) - extended[:, 0], compressed[:, 0] - length.min(axis=1))
    return np.where(past > 0, 1e3 + past, worst)


def places_in(area: Box, shares: FloatArray) -> FloatArray:
    """Places (K, 2) by their shares of the box around an area; those outside moved to its boundary."""
    low, high = np.array([area.x, area.y]).T
    at: FloatArray = low + (high - low) * shares
    if isinstance(area, Region):
        polygon, points = shapely.Polygon(area.corners), shapely.points(at)
        line = shapely.boundary(polygon)
        border: Any = shapely.line_interpolate_point(line, shapely.line_locate_point(line, points))
        at = np.where(
            np.reshape(shapely.covers(polygon, points), (-1, 1)), at, shapely.get_coordinates(border)
        )
    return at


def excesses(
    spec: EffortSpec, angle: FloatArray, effort: FloatArray, friction: FloatArray
) -> Iterator[FloatArray]:
    """Excess over the demands on the effort, one after the other."""
    if spec.wanted is not None:
        inside = angle <= spec.wanted[-1][0]
        yield np.abs(effort - np.interp(angle, *np.array(spec.wanted).T))[:, inside]
    if spec.stays_deg is not None:
        low, high = spec.stays_deg
        yield (np.abs(effort) - friction)[:, (angle >= low) & (angle <= high)]
    if spec.closes_below_deg is not None:
        yield (friction - effort)[:, angle <= spec.closes_below_deg]


def evolved(
    moved: Moves, spec: EffortSpec, seconds: float, rng: np.random.Generator
) -> tuple[FloatArray, int]:
    """The best candidate of differential evolution within a time, restarted whenever it has converged."""
    begun, count = process_time(), len(spec.parts[0].sizes)
    best, least = (np.zeros(4), 0), np.inf
    while process_time() - begun < seconds:
        x = rng.random((MEMBERS, 5))
        cost = deviations(moved, spec, x[:, :4], (x[:, 4] * count).astype(int))
        for _ in range(400):
            one, two, three = (rng.permutation(MEMBERS) for _ in range(3))
            pull = x[cost.argmin()] if rng.random() < 0.3 else x[one]
            tried = pull + rng.uniform(0.4, 0.9) * (x[two] - x[three])
            tried = np.where(rng.random(x.shape) < 0.9, tried, x)
            tried = np.where((tried < 0) | (tried >= 1), np.clip(tried, 0, 1 - 1e-12), tried)
            found = deviations(moved, spec, tried[:, :4], (tried[:, 4] * count).astype(int))
            better = found < cost
            x[better], cost[better] = tried[better], found[better]
            if process_time() - begun > seconds or np.ptp(cost) < 1e-6:
                break
        if cost.min() < least:
            least, first = float(cost.min()), x[cost.argmin()]
            best = first[:4], int(first[4] * count)
    return best


def judged(case: EffortCase, effort: EffortSpec) -> float:
    """The greatest excess by the judge; infinite where a stroke ends inside the travel."""
    figures = effort_figures(replace(case, dynamics=replace(case.dynamics, effort=effort)))
    past = any(miss.key.startswith("effort.parts") and miss.miss > 1e-3 for miss in figures.misses)
    return np.inf if past else figures.deviation.excess


def compared(of: Any, count: int, seed: int) -> Iterator[str]:
    """Both searches on the first designs of a list."""
    problem: Problem = of()
    plain = replace(problem, dynamics=problem.dynamics and replace(problem.dynamics, effort=None))
    for number, design in enumerate(synthesize(plain, seed=seed, enough=6).candidates[:count], start=1):
        if (case := effort_of_design(design.linkage, problem, design.verdict)) is None:
            continue
        begun = process_time()
        found = placed(case, seed)
        seconds = process_time() - begun
        mine = np.inf if found is None else judged(case, found)
        x, row = evolved(moves(problem, case), case.spec, TIMES * seconds, np.random.default_rng(seed))
        (part,) = case.spec.parts
        first, second = (
            place.placed(*places_in(place.at, shares[None])[0].tolist())
            for place, shares in zip(part.places, (x[:2], x[2:]), strict=True)
        )
        other = replace(part, sizes=(part.sizes[row],), between=(first, second))
        theirs = judged(case, replace(case.spec, parts=(other,)))
        sound = mine <= theirs + 0.05 * abs(theirs)
        yield (
            f"design {number}: {mine:.4f} N in {seconds:.2f} s, independently {theirs:.4f} N in "
            f"{TIMES * seconds:.1f} s{'' if sound else ' !'}"
        )


TASKS: dict[str, Callable[[], Problem]] = {
    "trunk lid": partial(load, "trunk-lid-struts"),
    "bonnet": bonnet,
    "kitchen flap": partial(load, "kitchen-flap"),
}
CASES = [
    *(Case(name, DESIGNS, partial(compared, of)) for name, of in TASKS.items()),
    *(
        Case(f"{name} in polygons", DESIGNS, partial(compared, partial(in_polygons, of)))
        for name, of in TASKS.items()
    ),
]
