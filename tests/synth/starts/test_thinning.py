"""Thinned paths: which points stay, and that driver angles between them follow the path."""

import numpy as np

from grashof.problems import Requirements
from grashof.synth.starts.closed_loop import SearchTargets
from grashof.synth.starts.loop_search import draw, place
from grashof.synth.starts.thinning import refined, thinned


def target_of(count: int, timed: bool = False, **wanted: object) -> SearchTargets:
    angle = np.linspace(0, 5, count)
    return SearchTargets(
        points=np.exp(1j * angle) + 0.2 * np.exp(-2j * angle),
        weights=np.ones(count),
        turns=np.zeros(count),
        turn_weights=np.zeros(count),
        timing=angle if timed else np.zeros(count),
        wanted=Requirements(**wanted).resolved(1.0),
    )


def test_short_paths_and_unordered_ones_stay_whole() -> None:
    for target in (target_of(20), target_of(60, order=False, same_branch=False)):
        some, index = thinned(target, 30)
        assert some is target
        assert index.tolist() == list(range(len(target.points)))
        batch = draw(target, 5, np.random.default_rng(0))
        assert refined(target, index, batch) is batch


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


def test_timing_is_thinned_with_its_points() -> None:
    target = target_of(90, timed=True)
    some, index = thinned(target, 30)
    np.testing.assert_array_equal(some.timing, target.timing[index])
    batch = refined(target, index, draw(some, 5, np.random.default_rng(0)))
    assert place(target, batch).theta2.shape == (5, 90)
