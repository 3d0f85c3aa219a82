"""Distinct designs, by the definition: largest difference above 1 % of the largest number."""

from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from grashof.analysis import solve_position
from grashof.problems import FourBar, FunctionTask, InvertedSliderCrank, PathTask, SliderCrank
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage
from grashof.synth.theory.distinct import (
    DISTINCT,
    apart,
    best_first,
    mirrored,
    pick_apart,
    signature,
    task_signature,
)

bounded = settings(max_examples=25)
number = st.floats(-10, 10).filter(lambda value: value == 0 or abs(value) > 1e-3)
signatures = arrays(np.float64, st.tuples(st.integers(2, 12), st.just(9)), elements=number).filter(
    lambda rows: bool((np.abs(rows).max(axis=1) > 0.1).all())
)


def share_apart(one: FloatArray, other: FloatArray) -> float:
    largest = max(max(abs(value) for value in one), max(abs(value) for value in other))
    return max(abs(x - y) for x, y in zip(one, other, strict=True)) / largest


def test_the_numbers_that_count() -> None:
    linkage = FourBar(o2=(1, 2), o4=(4, 6), r2=1, r3=4, r4=3, coupler_point=(0.5, -2), assembly=-1)
    assert signature(linkage).tolist() == [1, 2, 4, 6, 1, 4, 3, 0.5, -2]
    longer = FourBar(o2=(1, 2), o4=(4, 6), r2=1, r3=4.08, r4=3, coupler_point=(0.5, -2))
    assert apart(signature(linkage), signature(longer)[None])[0] > DISTINCT  # 0.08 of 6
    nearly = FourBar(o2=(1, 2), o4=(4, 6), r2=1.05, r3=4.05, r4=3.05, coupler_point=(0.5, -2))
    assert apart(signature(linkage), signature(nearly)[None])[0] < DISTINCT


@pytest.mark.parametrize(
    ("linkage", "image"),
    [
        (
            FourBar((1, 2), (5, 3), 1, 4, 3, (0.5, -2)),
            FourBar((1, -2), (5, -3), 1, 4, 3, (0.5, 2), assembly=-1),
        ),
        (
            SliderCrank((1, 2), 1, 4, 0.3, 0.2, (0.5, -2)),
            SliderCrank((1, -2), 1, 4, -0.3, -0.2, (0.5, 2)),
        ),
        (
            InvertedSliderCrank((1, 2), (5, 3), 1, 0.3, (0.5, -2)),
            InvertedSliderCrank((1, -2), (5, -3), 1, -0.3, (0.5, 2)),
        ),
    ],
)
def test_numbers_that_change_their_sign_in_a_mirror(linkage: Linkage, image: Linkage) -> None:
    theta2 = np.linspace(0, 6, 20)
    there, other = solve_position(linkage, theta2).p, solve_position(image, -theta2).p
    np.testing.assert_allclose(other, there * [1, -1], atol=1e-12)  # it is the image
    signs = np.ones(9)
    signs[[1, 3, *mirrored(linkage.mechanism)]] = -1
    np.testing.assert_allclose(signature(image), signature(linkage) * signs, atol=1e-12)


PAIRS = FunctionTask.from_degrees([0, 20, 45, 90], [0, 12, 31, 80])
TRAVELS = FunctionTask(PAIRS.inputs, PAIRS.outputs, travels=True)
IN_PLACE, AT_A_TENTH = (
    (
        FourBar((0, 0), (1, 0), 0.5, 1.5, 1.2, (0.3, 0.1)),
        SliderCrank((0, 0), 0.5, 1.5, 0.2, 0, (0.3, 0.1)),
        InvertedSliderCrank((0, 0), (1, 0), 0.5, 0.2, (0.3, 0.1)),
    ),
    (  # turned by a right angle, too, and moved
        FourBar((3, 4), (3, 4.1), 0.05, 0.15, 0.12, (0.03, 0.01)),
        SliderCrank((3, 4), 0.05, 0.15, 0.02, np.pi / 2, (0.03, 0.01)),
        InvertedSliderCrank((3, 4), (3, 4.1), 0.05, 0.02, (0.03, 0.01)),
    ),
)


@pytest.mark.parametrize(("one", "copy"), list(zip(IN_PLACE, AT_A_TENTH, strict=True)))
def test_copies_are_one_design_where_no_target_is_placed(one: Linkage, copy: Linkage) -> None:
    turned = solve_position(copy, np.pi / 2 + np.arange(4.0)).p - copy.o2  # it is a copy
    there = solve_position(one, np.arange(4.0)).p
    np.testing.assert_allclose(turned, 0.1 * there[:, ::-1] * [-1, 1], atol=1e-12)
    assert share_apart(task_signature(PAIRS, one), task_signature(PAIRS, copy)) < 1e-12
    travels = task_signature(TRAVELS, one)  # lengths of a travel
    np.testing.assert_allclose(travels, 10 * task_signature(TRAVELS, copy), atol=1e-12)
    placed = PathTask([(0, 0), (1, 2), (2, 2)])
    assert share_apart(task_signature(placed, one), task_signature(placed, copy)) > 0.5


@pytest.mark.slow
@bounded
@given(signatures, st.randoms(use_true_random=False), st.floats(0.01, 0.8))
def test_picked_are_apart_best_first_and_nobody_else_fits(
    rows: FloatArray, random: Random, least: float
) -> None:
    score = np.array([random.uniform(0, 1) for _ in rows])
    picked = pick_apart(rows, score, least, len(rows)).tolist()
    tie = 1e-9 * len(rows)
    assert score[picked[0]] >= score.max() - tie
    assert (np.diff(score[picked]) <= tie).all()
    for k, i in enumerate(picked):
        assert all(share_apart(rows[i], rows[j]) > least for j in picked[:k])
    for i in set(range(len(rows))) - set(picked):
        better = [j for j in picked if score[j] >= score[i] - tie]
        assert any(share_apart(rows[i], rows[j]) <= least * (1 + 1e-12) for j in better)


def test_no_more_than_required_and_of_equals_the_first() -> None:
    rows = np.eye(9)
    assert pick_apart(rows, np.zeros(9), 0.01, 4).tolist() == [0, 1, 2, 3]
    assert pick_apart(rows[[2, 2, 2]], np.zeros(3), 0.01, 9).tolist() == [0]
    assert pick_apart(rows[:0], np.zeros(0), 0.01, 4).tolist() == []


def test_rounding_changes_no_order() -> None:
    """Scores as two processors have them: ties to 1e-12 in another order each time."""
    rng = np.random.default_rng(2)
    score = np.repeat(rng.uniform(0, 2, 40), 3)
    orders = {tuple(best_first(score + 1e-12 * rng.standard_normal(score.shape)).tolist()) for _ in range(20)}
    assert len(orders) == 1
    assert best_first(np.array([np.inf, 1.0, -np.inf, 2.0])).tolist() == [0, 3, 1, 2]
    assert best_first(np.array([])).tolist() == []
    tiny = np.array([-3e-7, -1e-7, -2e-7, -1e12])  # errors: one that is huge does not make the others equal
    assert best_first(tiny).tolist() == [1, 2, 0, 3]
