"""Motions and driver ranges of the analysis against the judge in body coordinates, kind by kind."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from body_coordinates import carried, follow, margins, rates, reach, start
from body_plans import Array, plan_of
from random_linkages import ROWS, any_linkages, six_bars

from grashof.analysis import (
    driver_ranges,
    solve_kinematics,
)
from grashof.problems import FourBar, InvertedSliderCrank, SliderCrank

KINDS = (FourBar, SliderCrank, InvertedSliderCrank)
COUNT = 60
DRIVER = (2.0, 0.7, -0.3)


class Both:
    """A batch of linkages with its state by the package and by the judge, at the same driver angles."""

    def __init__(self, kind: type[Any]) -> None:
        rng = np.random.default_rng(KINDS.index(kind))
        linkages, theta = any_linkages(kind, 2 * COUNT, rng), rng.uniform(-np.pi, np.pi, 2 * COUNT)
        found = np.flatnonzero(np.isfinite(start(plan_of(linkages), theta, 3, 40)).all(axis=-1))[:COUNT]
        self.rng, self.linkage, self.theta, self.plan = (
            rng,
            linkages[found],
            theta[found],
            plan_of(linkages[found]),
        )
        self.q = start(self.plan, self.theta)
        self.turn = self.theta + np.linspace(-np.pi, np.pi, 25)[:, None]
        self.motion = rates(self.plan, follow(self.plan, self.q, self.theta, self.turn), *DRIVER)
        self.state = solve_kinematics(self.linkage, self.turn, *DRIVER)
        self.clear = (np.abs(margins(self.plan, self.motion[0])) > 0.05)[..., 0]


@pytest.fixture(scope="module", params=KINDS)
def both(request: pytest.FixtureRequest) -> Both:
    return Both(request.param)


def agree(found: Array, expected: Array, clear: Array) -> None:
    """To 1e-9 of the greatest of each linkage, where it is clear of dead positions."""
    apart, size = (
        np.where(clear, np.abs(values).reshape(*clear.shape, -1).max(axis=-1), 0.0)
        for values in (found - expected, expected)
    )
    assert (apart <= 1e-9 * np.maximum(size.max(axis=0), 1e-3)).all()


def test_every_linkage_moves(both: Both) -> None:
    assert len(both.q) == COUNT
    assert np.isfinite(both.q).all()
    assert both.clear.sum() > COUNT * 25 / 3


def test_positions_and_rates_to_the_jerk(both: Both) -> None:
    """Against the greatest of all links: rounding in one is as large as rates of the others ask for."""
    places = both.rng.normal(size=(3, COUNT, 2))
    moved = [both.state.point(link, at) for link, at in enumerate(places, 2)]
    found = np.stack([carried(both.motion, link, at) for link, at in enumerate(places, 2)], axis=-1)
    for k, name in enumerate(("position", "velocity", "acceleration", "jerk")):
        expected = np.stack([getattr(motion, name) for motion in moved], axis=-1)
        agree(found[k], expected, both.clear)
    turned = [both.state.angular(link) for link in (2, 3, 4)]
    for k in (1, 2, 3):
        agree(both.motion[k, ..., 2::3], np.stack([rates[k] for rates in turned], axis=-1), both.clear)


def test_a_slide_travels_the_same(both: Both) -> None:
    slide = both.state.slide
    if slide is None:
        return
    if isinstance(both.linkage, SliderCrank):
        along = np.stack([np.cos(both.linkage.slide_angle), np.sin(both.linkage.slide_angle)], axis=-1)
        place = carried(both.motion, 4, (0.0, 0.0))
        place[0] -= both.linkage.o2
        found = (place * along).sum(axis=-1)
    else:  # how far the block is along the rod: seen from the rod it does not turn
        foot = carried(both.motion, 4, np.stack([both.linkage.offset, 0 * both.linkage.offset], axis=-1))
        found = np.linalg.norm(foot[0] - carried(both.motion, 3, (0.0, 0.0))[0], axis=-1)[None]
        found = found * both.linkage.assembly
    for k, rate in enumerate((slide.travel, slide.velocity, slide.acceleration, slide.jerk)[: len(found)]):
        agree(found[k], rate, both.clear)


def test_the_driver_stops_at_the_ends_of_its_range(both: Both) -> None:
    ranges, dead = driver_ranges(both.linkage), reach(both.plan, both.q, both.theta)
    turns = np.abs(ranges[:, 0, 1] - ranges[:, 0, 0] - 2 * np.pi) < 1e-9
    assert (np.isinf(dead).all(axis=0) == turns).all()
    assert 0 < turns.sum() < COUNT
    for k in np.flatnonzero(~turns):
        low, high = dead[:, k] - dead[0, k]
        own = ranges[k][np.isfinite(ranges[k, :, 0])]
        moved = (dead[0, k] - own[:, 0] + np.pi) % (2 * np.pi) - np.pi
        chosen = np.abs(moved).argmin()
        assert abs(moved[chosen]) < 1e-9
        assert high - low == pytest.approx(own[chosen, 1] - own[chosen, 0], abs=1e-9)


@pytest.mark.parametrize("row", ROWS)
def test_six_bars_move_alike(row: str) -> None:
    batch = six_bars(row, 40, np.random.default_rng(9))
    plan, turn = plan_of(batch), np.linspace(0, 2 * np.pi, 25)[:, None]
    motion = rates(plan, follow(plan, start(plan, 0.0), 0.0, turn[:, 0]), *DRIVER)
    clear = (np.abs(margins(plan, motion[0])) > 0.05).all(axis=-1)
    assert clear.mean() > 0.5
    state, places = solve_kinematics(batch, turn, *DRIVER), np.array([(0.3, -0.2), (-0.4, 0.7)])
    moved = [state.point(link, at) for link, at in zip((5, 6), places, strict=True)]
    found = np.stack([carried(motion, link, at) for link, at in zip((5, 6), places, strict=True)], axis=-1)
    for k, name in enumerate(("position", "velocity", "acceleration", "jerk")):
        agree(found[k], np.stack([getattr(point, name) for point in moved], axis=-1), clear)
