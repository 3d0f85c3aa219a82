"""Formulas by blocks give the same values as in one call."""

import numpy as np
import pytest

from grashof.analysis.numerics.blockwise import in_blocks


@pytest.mark.parametrize(
    "shapes",
    [
        [(), ()],
        [(7,), ()],
        [(30000,), ()],
        [(3, 20000), (20000,)],
        [(20000, 3), (20000, 1)],
        [(2, 1), (1, 9000)],
        [(1, 3, 9000), (9000,)],
        [(0, 5), (5,)],
    ],
)
def test_blocks_give_the_values_of_one_call(shapes: list[tuple[int, ...]]) -> None:
    rng = np.random.default_rng(1)
    first, second = (np.asarray(rng.normal(size=shape)) for shape in shapes)
    found = in_blocks(lambda x, y: (x + y, x * y), (first, second), 2)
    np.testing.assert_array_equal(found[0], first + second)
    np.testing.assert_array_equal(found[1], first * second)
    assert found.shape == (2, *np.broadcast_shapes(*shapes))


def test_blocks_are_short() -> None:
    lengths = []

    def formula(x: np.ndarray) -> tuple[np.ndarray]:
        lengths.append(x.size)
        return (x,)

    in_blocks(formula, (np.zeros((5, 30000)),), 1)
    assert max(lengths) <= 8192
    assert sum(lengths) == 150000
