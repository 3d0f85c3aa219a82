"""Intervals: exact fractions of what doubles are lie in them."""

from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from grashof.synth.proof.strokes.ranges import HALF_TURN, Range, hypotenuse

PI = Fraction("3.14159265358979323846264338327950288419716939937510")
ENDS = st.tuples(*(st.floats(-1e6, 1e6).filter(lambda x: x == 0 or abs(x) > 1e-100),) * 2).map(sorted)
SHARE = st.fractions(0, 1)


def inside(found: Range, exact: Fraction) -> bool:
    return Fraction(float(found.low)) <= exact <= Fraction(float(found.high))


def at(ends: list[float], share: Fraction) -> tuple[Range, Fraction]:
    """An interval, and a number in it."""
    low, high = (Fraction(end) for end in ends)
    return Range(np.array(ends[0]), np.array(ends[1])), low + share * (high - low)


@given(ENDS, ENDS, SHARE, SHARE)
def test_sums_products_and_quotients_are_enclosed(one, other, first, second) -> None:
    (a, x), (b, y) = at(one, first), at(other, second)
    assert inside(a + b, x + y)
    assert inside(a - b, x - y)
    assert inside(a * b, x * y)
    assert inside(a.size, abs(x))
    if other[0] > 0:
        assert inside(a / b, x / y)
    else:
        assert np.isinf([(a / b).low, (a / b).high]).all()


@given(ENDS, ENDS, SHARE, SHARE)
def test_roots_are_enclosed(one, other, first, second) -> None:
    (a, x), (b, y) = at(one, first), at(other, second)
    long = hypotenuse(a, b)
    assert Fraction(float(long.low)) ** 2 <= x * x + y * y <= Fraction(float(long.high)) ** 2


def test_half_a_turn_and_sines_of_its_parts_are_enclosed() -> None:
    assert inside(HALF_TURN, PI)
    assert (HALF_TURN / Range.of(6.0)).sine.holds(0.5)
    assert (HALF_TURN / Range.of(3.0)).cosine.holds(0.5)
    eighth = (HALF_TURN / Range.of(4.0)).cosine
    assert inside(eighth * eighth, Fraction(1, 2))
    assert HALF_TURN.sine.holds(0.0)
    assert eighth.high - eighth.low < 1e-14


def test_wide_angles_are_enclosed() -> None:
    angle = Range(np.linspace(-3, 3, 50), np.linspace(-3, 3, 50) + 0.3)
    for share in np.linspace(0, 1, 9):
        inner = angle.low + share * (angle.high - angle.low)
        assert angle.sine.holds(np.sin(inner))
        assert angle.cosine.holds(np.cos(inner))
