"""Motions and driver ranges of the analysis against the judge in body coordinates, kind by kind."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from body_coordinates import carried, reach
from random_linkages import GRID, KINDS, Moving, agree

from grashof.analysis import driver_ranges, solve_kinematics, solve_position
from grashof.problems import InvertedSliderCrank, SliderCrank

COUNT, STEPS = 60, 25
DRIVER = (2.0, 0.7, -0.3)


class Both(Moving):
    """A batch of linkages with its state by the package besides, at the same driver angles."""

    def __init__(self, kind: Any) -> None:
        super().__init__(kind, COUNT if kind in KINDS else 40, STEPS, DRIVER)
        self.state = solve_kinematics(self.linkage, self.turn, *DRIVER)


@cache
def both_of(kind: Any) -> Both:
    return Both(kind)


QUICK = (*KINDS, "pins 2 3", "pins 2 4", "pins 3 1", "slide 4 1")  # all hosts, with and without a slide


@pytest.fixture(
    params=[each if each in QUICK else pytest.param(each, marks=pytest.mark.study) for each in GRID]
)
def both(request: pytest.FixtureRequest) -> Both:
    return both_of(request.param)


@pytest.fixture(params=KINDS)
def one_loop(request: pytest.FixtureRequest) -> Both:
    return both_of(request.param)


def test_every_linkage_moves(both: Both) -> None:
    assert len(both.q) >= 40
    assert np.isfinite(both.q).all()
    assert both.clear.mean() > (0.5 if len(both.links) > 3 else 1 / 3)


def test_positions_and_rates_to_the_jerk(both: Both) -> None:
    """Of points of every link, A, B and P; against the greatest of all links.

    Rounding in one is as large as rates of the others ask for.
    """
    linkage, state = both.linkage, both.state
    on_4 = getattr(linkage, "r4", linkage.offset if isinstance(linkage, InvertedSliderCrank) else 0.0)
    tips = [(0.0, 0.0), (0.0, 0.0), linkage.coupler_point]
    tips[0], tips[1] = (np.stack([x + 0 * linkage.r2, 0 * linkage.r2], axis=-1) for x in (linkage.r2, on_4))
    own = list(zip((2, 4, linkage.mechanism.carries), tips, (state.a, state.b, state.p), strict=True))
    places = both.rng.normal(size=(len(both.links), len(both.q), 2))
    own += [(link, at, state.point(link, at)) for link, at in zip(both.links, places, strict=True)]
    found = np.stack([carried(both.motion, link, at) for link, at, _ in own], axis=-1)
    for k, name in enumerate(("position", "velocity", "acceleration", "jerk")):
        agree(found[k], np.stack([getattr(point, name) for *_, point in own], axis=-1), both.clear)
    turned, place = [state.angular(link) for link in both.links], solve_position(linkage, both.turn)
    for link, turning in zip(both.links, turned, strict=True):
        np.testing.assert_array_equal(place.angles[link], turning.theta)
        np.testing.assert_array_equal(getattr(place, f"theta{link}"), turning.theta)
    for k in (1, 2, 3):
        agree(both.motion[k, ..., 2::3], np.stack([rates[k] for rates in turned], axis=-1), both.clear)


def test_a_slide_travels_the_same(one_loop: Both) -> None:
    both, slide = one_loop, one_loop.state.slide
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


def test_the_driver_stops_at_the_ends_of_its_range(one_loop: Both) -> None:
    both = one_loop
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
