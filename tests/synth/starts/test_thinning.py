"""Thinned paths: which points stay, and that driver angles between them follow the path."""

from dataclasses import replace

import numpy as np

from grashof.problems import Requirements
from grashof.synth.quantities.kinds import FOUR_BAR
from grashof.synth.starts.closed_loop import Loop, SearchTargets
from grashof.synth.starts.loop_search import draw, place
from grashof.synth.starts.thinning import AROUND, refined, thinned


def target_of(count: int, timed: bool = False, **wanted: object) -> SearchTargets:
    angle = np.linspace(0, 5, count)
    return SearchTargets(
        points=np.exp(1j * angle) + 0.2 * np.exp(-2j * angle),
        weights=np.ones(count),
        turns=np.zeros(count),
        turn_weights=np.zeros(count),
        timing=angle if timed else np.zeros(count),
        wanted=Requirements(rotatability_margin=1e-3, **wanted).resolved(1.0),
        kind=FOUR_BAR,
    )


def test_targets_in_any_order_are_refined_where_each_is_nearest() -> None:
    """Targets on the curve of a linkage: none is missed by more than from the nearest angle of the grid."""
    free = target_of(90, order=False)
    batch = draw(free, 40, np.random.default_rng(0))
    loop = Loop.of(free, batch)
    (row,) = np.flatnonzero(loop.closes)[:1]
    points = 0.3 + loop.e2[row] + (0.5 + 0.2j) * loop.e3[row]
    target, one = replace(free, points=points), batch[[row]]
    _, index = thinned(target, 30)
    known = replace(one, unknowns=one.unknowns[:, [0, 1, 2, *(3 + index)]], assembly=one.assembly[:, index])
    found = refined(target, index, known)
    step = 2 * np.pi / AROUND
    rounded = replace(
        one,
        unknowns=np.concatenate([one.unknowns[:, :3], step * np.round(one.unknowns[:, 3:] / step)], axis=1),
    )
    missed, at_most = (
        np.abs(0.3 + at.e2 + (0.5 + 0.2j) * at.e3 - points)[0]
        for at in (Loop.of(target, each) for each in (found, rounded))
    )
    assert (missed <= at_most + 1e-6).all()
    assert missed.max() < 0.1


def test_refined_angles_pass_the_kept_points_and_stay_in_order() -> None:
    target = target_of(140)
    some, index = thinned(target, 40)
    assert len(some.points) == 40
    assert (index[0], index[-1]) == (0, 139)
    batch = draw(some, 50, np.random.default_rng(0))
    before, after = place(some, batch).theta2, place(target, refined(target, index, batch)).theta2
    turned = after[:, index] - after[:, :1]
    np.testing.assert_allclose(turned, before - before[:, :1], atol=1e-3)
    steps = batch.direction[:, None] * np.diff(after, axis=1)
    assert (steps > 0).all()
    assert (steps.sum(axis=1) < 2 * np.pi).all()
