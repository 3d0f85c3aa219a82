"""Conditions of one dyad: the circle through three places of a point, against its radius by side lengths."""

import numpy as np
import pytest

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.proof.curve.dyads import possible_radii
from grashof.synth.proof.forms.forms import Span
from grashof.synth.theory.burmester import Displacements


def radius(places: ComplexArray) -> FloatArray:
    """Circumradius by Heron's formula, shape (n,)."""
    a, b, c = (np.abs(places[:, i] - places[:, j]) for i, j in ((0, 1), (1, 2), (2, 0)))
    half = (a + b + c) / 2
    found: FloatArray = a * b * c / (4 * np.sqrt(half * (half - a) * (half - b) * (half - c)))
    return found


@pytest.mark.parametrize("seed", range(4))
def test_radii_within_limits_are_kept_and_those_just_outside_are_not(seed: int) -> None:
    rng = np.random.default_rng(seed)
    motion = Displacements.from_poses(
        rng.normal(size=3) + 1j * rng.normal(size=3), np.concatenate([[0.0], rng.uniform(0.3, 1.5, 2)])
    )
    z = 2 * (rng.normal(size=200) + 1j * rng.normal(size=200))
    real = radius(motion.apply(z))
    z, real = z[real < 30], real[real < 30]
    for half in (1e-9, 0.01):
        steps = half * np.stack([np.ones_like(z), 1j * np.ones_like(z)])
        for s, t in ((0, 0), (1, -1), (-1, 1)):
            square = Span(z - s * steps[0] - t * steps[1], steps, np.zeros(len(z)))
            for k, r in enumerate(real):
                one = square[np.array([k])]
                assert possible_radii(motion, one, (r * (1 - 1e-9), r * (1 + 1e-9)))[0]
                if half < 1e-6:
                    assert not possible_radii(motion, one, (0.0, 0.99 * r))[0]
                    assert not possible_radii(motion, one, (1.01 * r, np.inf))[0]
