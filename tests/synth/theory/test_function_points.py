import numpy as np
import pytest

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_function
from grashof.problems import FourBar
from grashof.problems.values.arrays import FloatArray
from grashof.synth.theory.function_output import (
    Generators,
    closes,
    output_angles,
    output_slopes,
    worst_cosine,
)
from grashof.synth.theory.function_points import through_five_pairs, through_four_pairs, through_three_pairs


def planted(
    rng: np.random.Generator, pairs: int, *, full: bool = False
) -> tuple[Generators, FloatArray, FloatArray]:
    task, linkage, start = planted_function(rng, pairs, full=full)
    shape = np.append(np.log(linkage.lengths[1:]), start)
    return Generators(shape[None], linkage.assembly[None]), task.inputs, task.outputs


def nearest(made: Generators, there: Generators) -> float:
    off = made.shape - there.shape
    off[:, 3] = np.angle(np.exp(1j * off[:, 3]))
    return float(np.abs(off).max(axis=1).min(initial=np.inf))


def test_output_is_that_of_the_judge() -> None:
    rng = np.random.default_rng(1)
    for _ in range(50):
        made, turned, _ = planted(rng, 6)
        _, r2, r3, r4 = made.lengths[0]
        linkage = FourBar((0, 0), (1, 0), r2, r3, r4, assembly=made.assembly[0])
        theta4 = solve_position(linkage, made.shape[0, 3] + turned).theta4
        off = np.exp(1j * (output_angles(made, turned)[0] - theta4)) - 1
        assert np.abs(off).max() < 1e-9


def test_slopes_are_those_of_differences() -> None:
    made, turned, _ = planted(np.random.default_rng(2), 8)
    slopes, step = output_slopes(made, turned, output_angles(made, turned)), 1e-6
    for k in range(4):
        moved = np.zeros(4)
        moved[k] = step
        ahead, behind = (
            output_angles(Generators(made.shape + sign * moved, made.assembly), turned) for sign in (1, -1)
        )
        assert np.abs((ahead - behind) / (2 * step) - slopes[..., k]).max() < 1e-6


def test_worst_cosine_is_that_of_dense_samples() -> None:
    rng = np.random.default_rng(3)
    made = Generators(rng.uniform(-1, 1, (500, 4)), np.ones(500))
    theta2 = made.shape[:, 3:] + np.linspace(0, 2.0, 20001)
    _, r2, r3, r4 = made.lengths.T[..., None]
    square = 1 + r2**2 - 2 * r2 * np.cos(theta2)
    dense = np.abs((r3**2 + r4**2 - square) / (2 * r3 * r4)).max(axis=1)
    assert np.abs(worst_cosine(made, 2.0) - dense).max() < 1e-6
    assert ((dense < 1) == closes(made, 2.0)).all()


def test_every_planted_four_bar_of_five_pairs_is_found() -> None:
    rng = np.random.default_rng(4)
    tasks = [planted(rng, 5) for _ in range(1000)]
    made, which = through_five_pairs(*(np.array(each) for each in list(zip(*tasks, strict=True))[1:]))
    found = [nearest(made[which == k], tasks[k][0]) for k in range(1000)]
    assert max(found) < 1e-6
    assert set(np.bincount(which).tolist()) <= {1, 3}


@pytest.mark.parametrize("count", [50, pytest.param(1000, marks=pytest.mark.slow)])
def test_four_pairs_are_always_met_where_a_four_bar_meets_them(count: int) -> None:
    rng = np.random.default_rng(5)
    for _ in range(count):
        _, turned, output = planted(rng, 4)
        made = through_four_pairs(turned, output, 400)
        made = made[closes(made, float(turned[-1]))]
        dense = np.unique(np.concatenate([turned, np.linspace(0, turned[-1], 60)]))
        path = output_angles(made, dense)[:, np.searchsorted(dense, turned)]
        assert np.abs(path - path[:, :1] - output).max(axis=1).min() < 1e-8


def test_three_pairs_of_the_textbook() -> None:
    """y = 1/x, Chebyshev spacing, from 30 and 240 deg (Shigley & Uicker; families: K and lengths)."""
    phi, psi = np.radians([36.03, 75, 113.97]), np.radians([251.30, 300, 326.88])
    made = through_three_pairs(phi - phi[0], psi - psi[0], phi[:1], psi[:1])
    assert np.abs(made.lengths[0] - [1, 2.47499, 0.91205, 2.47433]).max() < 1e-3
    theta4 = output_angles(made, phi - phi[0])[0]
    assert np.abs(np.diff(theta4) - np.diff(psi)).max() < 1e-9
    # A negative r4 is half a turn more.
    assert abs(np.angle(np.exp(1j * (theta4[0] - psi[0] - np.pi)))) < 1e-9


def test_a_parallelogram_has_no_three_pairs() -> None:
    turned = np.array([0.0, 0.5, 1.0])
    made = through_three_pairs(turned, turned, np.array([0.3]), np.array([0.3]))
    assert not np.isfinite(made.shape).all() or len(made) == 1
