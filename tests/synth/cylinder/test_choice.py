"""The best cylinder: its closed form, limits in all combinations, and an independent search."""

from itertools import product
from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from grashof.analysis import driver_ranges
from grashof.analysis.cylinder.lengths import CylinderFigures, cylinder_figures, cylinder_state
from grashof.analysis.cylinder.travel import Travel, travel
from grashof.problems import Box, Cylinder, CylinderSpec, FourBar
from grashof.synth.cylinder.choice import best_cylinder

LINKS = ("driver", "coupler", "output")


class Moved(NamedTuple):
    linkage: FourBar
    travel: Travel
    range_deg: float


def drawn(rng: np.random.Generator) -> Moved:
    """A four-bar whose driver covers 30 to 140 deg between its dead positions, in either sense."""
    while True:
        r1, r2, r3, r4 = rng.uniform(0.3, 3, 4)
        p = rng.uniform(-1, 1, 2) * r3
        linkage = FourBar((0, 0), (r1, 0), r2, r3, r4, p, rng.choice([-1, 1]))
        (low, high), wide = driver_ranges(linkage)[0], np.radians(rng.uniform(30, 140))
        if not high - low > 1.05 * wide:
            continue
        start = rng.uniform(low + 0.02 * wide, high - 1.02 * wide)
        ends = np.array([start, start + wide])[:: rng.choice([-1, 1])]
        found = travel(linkage, ends, np.array([int(linkage.assembly)] * 2))
        if found is not None:
            return Moved(linkage, found, float(np.degrees(wide)))


def chosen(moved: Moved, spec: CylinderSpec) -> Cylinder | None:
    share = (1 - np.cos(np.linspace(0, np.pi, 129))) / 2
    at = moved.travel.at(moved.travel.start + (moved.travel.end - moved.travel.start) * share)
    return best_cylinder(moved.linkage, (at.theta2, at.theta3, at.theta4), spec)


def figures(moved: Moved, spec: CylinderSpec) -> CylinderFigures | None:
    cylinder = chosen(moved, spec)
    return None if cylinder is None else cylinder_figures(cylinder, moved.travel)


def test_on_link_2_the_worst_angle_is_90_deg_less_half_the_range() -> None:
    rng = np.random.default_rng(3)
    for _ in range(60):
        moved = drawn(rng)
        found = figures(moved, CylinderSpec(on=["driver"]))
        assert found is not None
        assert found.monotone
        assert np.degrees(found.angle_min) == pytest.approx(90 - moved.range_deg / 2, abs=1e-5)
        assert found.ratio <= 1.6


@pytest.mark.study
def test_some_link_has_a_cylinder_of_30_deg_or_more() -> None:
    rng = np.random.default_rng(2)
    angles = []
    for _ in range(60):
        found = figures(drawn(rng), CylinderSpec())
        angles.append(0.0 if found is None else np.degrees(found.angle_min))
    assert sum(angle >= 30 for angle in angles) >= 59
    assert np.median(angles) > 75


LIMITED = {
    "closed": (1.5, 2.5),
    "ratio_max": 1.3,
    "base": Box((-3.0, 0.5), (-2.0, -0.2)),
}


@pytest.mark.parametrize("on", LINKS)
@pytest.mark.parametrize("active", list(product([False, True], repeat=3)))
def test_limits_are_kept_in_all_combinations(on: str, active: tuple[bool, bool, bool]) -> None:
    limits = {key: value for (key, value), given in zip(LIMITED.items(), active, strict=True) if given}
    spec = CylinderSpec(on=[on], **limits)
    linkage = FourBar((0, 0), (3, 0), 1.6, 2.2, 2.4, (1, 0.5))
    moved_ = travel(linkage, np.radians([55.0, 110.0]), np.array([1, 1]))
    assert moved_ is not None
    moved = Moved(linkage, moved_, 55.0)
    cylinder = chosen(moved, spec)
    assert cylinder is not None
    found = cylinder_figures(cylinder, moved.travel)
    assert found.monotone
    assert found.ratio <= spec.ratio_max
    low, high = spec.closed or (0.0, np.inf)
    assert low <= found.closed <= high
    box = spec.base or Box()
    assert box.x[0] <= cylinder.base[0] <= box.x[1]
    assert box.y[0] <= cylinder.base[1] <= box.y[1]


def searched(moved: Moved, spec: CylinderSpec, on: str, reach: float, middle: float, seed: int) -> float:
    """The worst lever angle that differential evolution finds, deg, with its own penalties."""
    box = spec.base
    assert box is not None
    places = np.linspace(moved.travel.start, moved.travel.end, 41)
    at = moved.travel.at(places)
    low, high = spec.closed or (0.0, np.inf)

    def cost(x: np.ndarray) -> float:
        radius, turn, *base = x
        point = middle + radius * np.cos(turn), radius * np.sin(turn)
        state = cylinder_state(Cylinder(on, (base[0], base[1]), point), moved.linkage, at)
        least = max(state.lever.min(), (-state.lever).min())
        closed, opened = state.length.min(), state.length.max()
        over = (
            max(opened / max(closed, 1e-9) - spec.ratio_max, 0) + max(low - closed, 0) + max(closed - high, 0)
        )
        return float(-least + 100 * over)

    bounds = [(0, reach), (-np.pi, np.pi), box.x, box.y]
    best = differential_evolution(cost, bounds, seed=seed, popsize=24, maxiter=260, tol=1e-10, polish=False)
    return float(np.degrees(np.arcsin(min(-best.fun, 1.0)))) if best.fun < 0 else 0.0


@pytest.mark.study
@pytest.mark.parametrize("seed", range(6))
def test_an_independent_search_of_great_effort_finds_no_better_one(seed: int) -> None:
    moved = drawn(np.random.default_rng(100 + seed))
    spec = CylinderSpec(closed=(1.0, 4.0), ratio_max=1.5, base=Box((-4, 5), (-4, 0)))
    linkage = moved.linkage
    p, r3 = complex(*linkage.coupler_point), float(linkage.r3)
    reaches = {"driver": linkage.r2, "output": linkage.r4, "coupler": max(r3, abs(p), abs(p - r3))}
    best = max(
        searched(moved, spec, on, float(reach), r3 / 2 if on == "coupler" else 0.0, seed)
        for on, reach in reaches.items()
    )
    found = figures(moved, spec)
    assert (0.0 if found is None else np.degrees(found.angle_min)) > best - 0.1


@pytest.mark.slow
def test_there_is_none_that_cannot_close() -> None:
    linkage = FourBar((0, 0), (3, 0), 1.6, 2.2, 2.4, (1, 0.5))
    moved = travel(linkage, np.radians([55.0, 110.0]), np.array([1, 1]))
    assert moved is not None
    far = CylinderSpec(closed=(0.1, 0.2), base=Box((50, 51), (50, 51)))
    assert chosen(Moved(linkage, moved, 55.0), far) is None
    half_a_turn = FourBar((0, 0), (4, 0), 1, 4, 3)
    round_ = travel(half_a_turn, np.radians([0.0, 200.0]), np.array([1, 1]))
    assert round_ is not None
    assert chosen(Moved(half_a_turn, round_, 200.0), CylinderSpec(on=["driver"])) is None
