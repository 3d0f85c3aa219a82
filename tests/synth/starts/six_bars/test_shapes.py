"""Shapes whose loops close by construction, and their derivatives."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof.problems import Box, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import MECHANISMS, Mechanism
from grashof.synth.loop.chain import chained
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.formulas import of_six_bars
from grashof.synth.quantities.kinds import FOUR_BAR
from grashof.synth.starts.closed_loop import Batch, SearchTargets
from grashof.synth.starts.loop_search import improve
from grashof.synth.starts.six_bars.carried import Carried
from grashof.synth.starts.six_bars.chains import Fitting, draw
from grashof.synth.starts.six_bars.shapes import Shapes, plain

ROWS = [row for row in MECHANISMS if len(row.loops) > 1]
MOTIONS: dict[str, dict[str, Any]] = {
    "turn": {"transmission": 0.4, "margin": 1e-3},
    "range": {"turning": False, "transmission": 0.4, "over_turn": False},
    "turn, transmitting over a range": {"transmission": 0.5, "over_turn": False},
}
COUNT, STEP = 5, 1e-6


def named(row: Any) -> str:
    return (
        f"{row.word}-{row.loops[-1].dyad.kind}-{row.dyads[-1].hosts}" if isinstance(row, Mechanism) else row
    )


def targets(**given: Any) -> SearchTargets:
    rng, free = np.random.default_rng(1), np.zeros(COUNT)
    points = rng.normal(size=COUNT) + 1j * rng.normal(size=COUNT)
    rest: dict[str, Any] = dict.fromkeys(("turns", "turn_weights", "timing"), free)
    wanted = given.pop("wanted", Requirements())
    return SearchTargets(
        **rest | {"points": points, "weights": np.ones(COUNT), "formulas": {}} | given,
        wanted=wanted,
        kind=FOUR_BAR,
    )


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("row", ROWS, ids=named)
def test_loops_close_and_transmit_over_the_motion(row: Mechanism, motion: str) -> None:
    shapes, target = Shapes(row, **MOTIONS[motion]), targets()
    with np.errstate(all="ignore"):
        batch = draw(target, shapes, 200, np.random.default_rng(0))
        at = Carried(target, shapes, batch)
        ends = at.unknowns.ends
        made = plain(at.made.given)
        over = ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * np.linspace(0, 1, 361)
        turn = np.broadcast_to(np.linspace(0, 2 * np.pi, 361), over.shape)
        closed, kept = np.ones((2, len(batch)), dtype=bool)
        for theta2, transmits in ((turn, shapes.over_turn), (over, True)):
            if theta2 is turn and not shapes.turning:
                continue
            driver, sides = Vector(np.cos(theta2), np.sin(theta2)), list(batch.assembly.T[..., None])
            chain = chained(row, made, driver, sides)
            for loop, square in zip(row.loops, chain.squares, strict=True):
                closed &= (square > 0).all(axis=1)
                first, second = (chain.frames[link].along for link in loop.links)
                sine = first.cross(second) if loop.pinned else first.dot(second)
                if transmits:
                    kept &= (np.abs(sine) >= np.sin(shapes.transmission) - 2e-3).all(axis=1)
    assert at.closes.sum() > 80
    # near a dead position outside the range an extreme may hide between samples
    assert closed[at.closes].mean() >= (0.96 if shapes.by_ends and shapes.turning else 1.0)
    assert kept[at.closes].mean() > 0.98


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("row", ROWS, ids=named)
def test_derivatives_are_those_of_differences(row: Mechanism, motion: str) -> None:
    shapes, target = Shapes(row, **MOTIONS[motion]), targets()
    with np.errstate(all="ignore"):
        batch = draw(target, shapes, 40, np.random.default_rng(2))
        at = Carried(target, shapes, batch)
        for way in ways(batch):
            up, down = (moved(target, shapes, batch, sign * STEP * way) for sign in (1, -1))
            for name in ("origin", "along", "output"):
                expected = (getattr(up, name) - getattr(down, name)) / (2 * STEP)
                found = getattr(at, f"by_{name}").slope @ way
                off = np.abs(found - expected)[at.closes] / (1 + np.abs(expected)[at.closes])
                assert np.nanquantile(off, 0.9) < 1e-6  # beside others the sampled extreme changes


def ways(batch: Batch) -> FloatArray:
    """Directions that no error in a derivative is perpendicular to."""
    drawn = np.random.default_rng(4).normal(size=(2, batch.unknowns.shape[1]))
    return np.asarray(drawn / np.linalg.norm(drawn, axis=1, keepdims=True))


def moved(target: SearchTargets, shapes: Shapes, batch: Batch, step: np.ndarray[Any, Any]) -> Carried:
    return Carried(target, shapes, replace(batch, unknowns=batch.unknowns + step))


LIMITED = Requirements(
    link_length=(0.5, 1.5), r5=(0.4, 0.9), link_ratio_max=1.5, coupler_arms=(0.3, 0.5),
    o2=Box((-0.3, -0.2), (0.1, 0.2)), o4=Box((-0.3, -0.2), (0.1, 0.2)), a=Box((-0.1, 0.1), (-0.1, 0.1)),
    b=Box((-0.1, 0.1), (-0.1, 0.1)), ground_angle_deg=20.0, theta2_start_deg=30.0,
    driver_rotation_deg=(10, 20),
)  # fmt: skip


@pytest.mark.quick("watt-1-RRR-(3, 4)", "stephenson-3-RRR-(3, 1)")
@pytest.mark.parametrize("row", [row for row in ROWS if not row.loops[-1].dyad.slides], ids=named)
def test_limits_have_the_derivatives_of_differences_where_the_fit_is_exact(row: Mechanism) -> None:
    shapes, target = Shapes(row), targets()
    limited = replace(target, wanted=LIMITED, formulas=of_six_bars(row.lengths))
    assert len(limited.limited) > 15
    plain_fit, fit = Fitting(target, shapes), Fitting(limited, shapes, weight=1.0)
    with np.errstate(all="ignore"):
        batch = draw(target, shapes, 150, np.random.default_rng(0))
        batch, error = improve(plain_fit, batch, 60, 1e-22, 30, missed=plain_fit.missed)
        batch = batch[np.argsort(error)[:8]]
        slope = fit(batch)[2]
        for way in ways(batch):
            up, down = (
                fit.missed(replace(batch, unknowns=batch.unknowns + sign * STEP * way)) for sign in (1, -1)
            )
            expected = (up - down) / (2 * STEP)
            off = np.abs(slope @ way - expected) / (1 + np.abs(expected).max(axis=0))
            assert np.median(off[:, 2 * COUNT :], axis=0).max() < 1e-5
