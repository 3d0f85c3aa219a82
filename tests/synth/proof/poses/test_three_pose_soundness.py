"""Three poses: linkages that meet a problem are in its tiles, and no bound is below what they transmit."""

import numpy as np
import pytest
from piece_descent import JUST_BELOW, Designs, Side, descent
from proof_problems import bonnet, of_three, planted, random_poses, with_links

from grashof.problems import Box, MotionTask, Problem, Requirements
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.proof.curve.curve import poles
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.forms.forms import Span
from grashof.synth.proof.poses.best_first import Tilings
from grashof.synth.proof.poses.charts import BOTH, GROUND, MOVING, Charts, Tiles
from grashof.synth.proof.poses.sides import Sites, Tiling
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.dyad_pairs import judged_pairs
from grashof.synth.theory.burmester import Displacements, Dyads, circle_dyads, circle_dyads_of_ground, polish


def about_pole(seed: int, number: int) -> Box:
    """A box of ground pivots about a pole of random poses."""
    scaled = ScaledProblem.of(random_poses(seed, 3))
    assert scaled.motion is not None
    x, y = scaled.frame.outward(poles(scaled.motion.inverse())[1][number : number + 1])[0]
    return Box((x - 0.2, x + 0.3), (y - 0.3, y + 0.2))


PARALLEL = [[0, 0, 0], [1, 0.3, 0], [0.7, -0.5, 50]]
STAIRS = np.array([[-60, -160], [100, -160], [100, -260], [-60, -260]], dtype=np.float64)
CASES = {
    "bonnet": bonnet(),
    "bonnet, area kept out": bonnet(keep_out=(STAIRS,)),
    "bonnet, angles": bonnet(driver_sense="cw", driver_rotation_deg=(10, 120), ground_angle_deg=(-90, 60)),
    "luggage over the turn": of_three(with_links(5, 1, link_ratio_max=8, transmission_over="cycle")),
    "luggage, crank-rocker": of_three(with_links(8, rotatability="crank-rocker")),
    "luggage, any order": of_three(with_links(8, order=False, rotatability="any")),
    "random": random_poses(3, 3, rotatability="any"),
    "random, short links": random_poses(
        5, 3, rotatability="any", link_length=(0.1, 2.0), coupler_arms=(0.0, 2.0)
    ),
    "boxes about poles": random_poses(3, 3, rotatability="any", o2=about_pole(3, 0), o4=about_pole(3, 1)),
    "two parallel poses": Problem(
        task=MotionTask.from_degrees(PARALLEL), requirements=Requirements(rotatability="any")
    ),
    "planted": planted(2, 3),
}


def some_dyads(charts: Charts, reach: float, count: int, rng: np.random.Generator) -> Dyads:
    """Dyads of all charts: anywhere, near poles of one pivot, and near those of both; exactly there, too."""
    motion = charts.motion

    def points(places: ComplexArray, size: float) -> ComplexArray:
        off = size * 10 ** rng.uniform(-9, 0, count) * np.exp(1j * rng.uniform(0, 2 * np.pi, count))
        return rng.choice(places, count) + off * rng.choice([0.0, 1.0], count, p=[0.02, 0.98])

    of_z, of_c = charts.poles
    anywhere = reach * np.sqrt(rng.uniform(size=count)) * np.exp(1j * rng.uniform(0, 2 * np.pi, count))
    far = np.array([*of_c, 0]) + 0j
    found = [
        circle_dyads(motion, anywhere),
        circle_dyads_of_ground(motion, 2 * anywhere),
        circle_dyads(motion, points(of_z, charts.radius)),
        circle_dyads_of_ground(motion, points(of_c, charts.radius)),
        # From the line of ground pivots that belong to a pole: moving pivots next to it.
        circle_dyads_of_ground(motion, points(far, reach)),
    ]
    for k in range(BOTH, len(charts.origin.z)):
        z = np.full(count, charts.origin.z[k]) + points(np.zeros(1, dtype=complex), charts.radius)
        c = np.full(count, charts.origin.c[k]) + points(np.zeros(1, dtype=complex), charts.radius)
        found.append(polish(motion, Dyads(z, c), 6))
    z, c = (np.concatenate([getattr(each, name) for each in found]) for name in ("moving", "ground"))
    finite = np.isfinite(z) & np.isfinite(c)
    return Dyads(z[finite], c[finite])


def exact(motion: Displacements, dyads: Dyads) -> Dyads:
    """Those of some dyads that are exact."""
    arms = np.abs(motion.apply(dyads.moving) - dyads.ground[:, None])
    return dyads[np.ptp(arms, axis=1) <= 1e-13 * (1 + arms.max(axis=1))]


def feasible_designs(problem: Problem, most: int, seed: int = 0, count: int = 4000) -> Designs:
    """At most `most` linkages that meet a problem, a good part of them near poles."""
    scaled = ScaledProblem.of(problem)
    assert scaled.motion is not None
    required, rng, body = Required.of(scaled), np.random.default_rng(seed), complex(scaled.targets[0])
    sides = Tilings.covering(required)
    every = []
    for tiling in (sides.driver, sides.driven):
        charts = tiling.side.charts
        reach = min(required.driver.arm[1], 3.0)
        dyads = exact(charts.motion, some_dyads(charts, reach, count, rng))
        _, rows = Sites.of(tiling.side, tiles_of(charts, dyads))
        every.append((charts, dyads[rows]))  # those that meet the requirements on one dyad, about
    drawn = []
    for charts, dyads in every:
        special = kinds(charts, dyads) != charts.main
        weight = np.where(special, 1 / max(special.sum(), 1), 1 / max((~special).sum(), 1))
        drawn.append(
            dyads[rng.choice(len(dyads), 60 * most, p=weight / weight.sum())] if len(dyads) else dyads
        )
    one, other = (Dyads(each.moving + body, each.ground + body) for each in drawn)
    least = min(len(one), len(other))
    judged = judged_pairs(scaled.motion, body, one[:least], other[:least], scaled.wanted)
    good = np.flatnonzero(judged.feasible & (judged.transmission > required.floor + 2 * JUST_BELOW))[:most]
    return Designs(drawn[0][good], drawn[1][good], judged.transmission[good])


def kinds(charts: Charts, dyads: Dyads) -> IntArray:
    """The chart of each dyad: the main one but near its poles, there the other one but near its poles."""
    pivots = (dyads.moving, dyads.ground)
    near = [np.abs(z[:, None] - poles) for z, poles in zip(pivots, charts.poles, strict=True)]
    main, other = charts.main, GROUND if charts.main == MOVING else MOVING
    kind = np.full(len(dyads), charts.main)
    if not len(charts.poles[0]):
        return kind
    away = near[main].min(axis=1) > charts.radius
    both = BOTH + near[0].argmin(axis=1) * len(charts.poles[1]) + near[1].argmin(axis=1)
    return np.where(away, main, np.where(near[other].min(axis=1) > charts.radius, other, both))


def coordinates(charts: Charts, kind: IntArray, dyads: Dyads) -> FloatArray:
    """Where dyads are in their charts, shape (2, n)."""
    of_z = (charts.free.z[:, kind].conj() * (dyads.moving - charts.origin.z[kind])).real
    of_c = (charts.free.c[:, kind].conj() * (dyads.ground - charts.origin.c[kind])).real
    return of_z + of_c


def tiles_of(charts: Charts, dyads: Dyads) -> Tiles:
    """Tiles of no size about dyads."""
    kind = kinds(charts, dyads)
    place = coordinates(charts, kind, dyads)
    return Tiles(charts, kind, place, np.zeros_like(place))


def holds(sites: Sites, which: IntArray, dyads: Dyads) -> BoolArray:
    """Whether tiles hold dyads, entry by entry."""
    tiles, z, c = sites.tiles[which], sites.z[which], sites.c[which]
    off = coordinates(tiles.charts, tiles.kind, dyads) - tiles.place
    s = np.clip(off / np.maximum(tiles.half, 1e-300), -1, 1)
    inside = np.all(np.abs(off) <= tiles.half * (1 + 1e-13) + 3e-16, axis=0)
    inside &= tiles.kind == kinds(tiles.charts, dyads)
    for span, points in ((z, dyads.moving), (c, dyads.ground)):
        apart = np.abs(points - span.middle - (span.steps * s).sum(axis=0))
        inside &= apart <= span.rest + 1e-12 * (1 + np.abs(points))
    return inside


def side_of(tiling: Tiling, dyads: Dyads) -> Side:
    """One dyad of each design, and the tiles that have to hold it."""
    return Side(
        np.arange(len(tiling)),
        tiling.halve,
        lambda which, designs: holds(tiling.sites, which, dyads[designs]),
    )


REPEATING = {"bonnet", "bonnet, angles", "luggage, crank-rocker", "random", "random, short links", "planted"}


@pytest.mark.quick(*(set(CASES) - REPEATING))
@pytest.mark.parametrize("name", CASES)
def test_no_linkage_is_lost_or_bounded_too_low(name: str) -> None:
    designs = feasible_designs(CASES[name], 150, count=800)
    assert len(designs) > 20
    sides = Tilings.covering(Required.of(ScaledProblem.of(CASES[name])))
    traced = [side_of(sides.driver, designs.driver), side_of(sides.driven, designs.driven)]
    found = descent(traced, designs.transmission, lambda tiles, least: sides.each_bounded(*tiles, least), 20)
    assert (found.lost, found.excluded) == (0, 0)
    assert found.nearest < np.radians(0.1)  # sharp: a bound that is 0.1 deg too low would show


def used(span: Span, points: ComplexArray, s: FloatArray) -> FloatArray:
    """Share of the rest of forms that points use."""
    apart: FloatArray = np.abs(points - span.middle - (span.steps * s).sum(axis=0))
    return apart / (span.rest + 1e-13 * (1 + np.abs(points)))


@pytest.mark.parametrize(("main", "half"), [(MOVING, 0.1), (GROUND, 0.01), (MOVING, 0.001)])
def test_charts_hold_every_dyad(main: int, half: float) -> None:
    rng, longest = np.random.default_rng(main), 6.0
    scaled = ScaledProblem.of(random_poses(3, 3))
    assert scaled.motion is not None
    charts = Charts.of(scaled.motion, longest, main, complex(np.exp(0.7j)))
    dyads = exact(charts.motion, some_dyads(charts, 3.0, 3000, rng))
    dyads = dyads[np.abs(dyads.moving - dyads.ground) < longest]
    kind = kinds(charts, dyads)
    corner = rng.choice([-1.0, 1.0], (2, len(dyads)))
    s = np.where(rng.random(len(dyads)) < 0.5, corner, rng.uniform(-1, 1, (2, len(dyads))))
    size = half * np.where(kind >= BOTH, charts.radius, 1.0)
    halves = np.stack([size, size * rng.choice([0.3, 1.0], len(dyads))])
    tiles = Tiles(charts, kind, coordinates(charts, kind, dyads) - s * halves, halves)
    z, c, known = tiles.spans
    share = np.maximum(used(z, dyads.moving, s), used(c, dyads.ground, s))
    assert share.max() <= 1 + 1e-9
    for each in (kind == MOVING, kind == GROUND, kind >= BOTH):
        assert (known & each).sum() > 20
        assert share[known & each].max() > 0.4
    assert tiles.counted(z, c).all()
