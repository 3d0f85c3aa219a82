"""Affine forms hold every value, at corners and inside, and hardly more."""

import itertools
from collections.abc import Callable

import numpy as np
import pytest

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.proof.forms.forms import Form, Span, greatest_quotient
from grashof.synth.proof.forms.square import nothing_left

COUNT = 3000
SYMBOLS = pytest.mark.parametrize("symbols", [1, 2, 4])


def points(rng: np.random.Generator, symbols: int) -> FloatArray:
    """Places in the square, or cube, corners first."""
    corners = np.array(list(itertools.product([-1.0, 0.0, 1.0], repeat=symbols)))
    return np.concatenate([corners, rng.uniform(-1, 1, (40, symbols))])


def some_form(rng: np.random.Generator, rest: float, symbols: int) -> Form:
    slopes = rng.normal(size=(symbols, COUNT)) / symbols
    return Form(2 * rng.normal(size=COUNT), slopes, rest * rng.uniform(size=COUNT))


def some_span(rng: np.random.Generator, rest: float, symbols: int) -> Span:
    parts = rng.normal(size=(1 + symbols, COUNT)) + 1j * rng.normal(size=(1 + symbols, COUNT))
    size = rng.choice([0.01, 0.3, 1.0], COUNT)
    return Span(parts[0], parts[1:] * size, rest * rng.uniform(size=COUNT))


def value(form: Form, at: FloatArray, off: FloatArray) -> FloatArray:
    """A value of a form, its rest used by a share `off`."""
    return form.centre + at @ form.slopes + off * form.rest


def anywhere(span: Span, at: FloatArray, rng: np.random.Generator) -> ComplexArray:
    """A value of a complex form, its rest used in full in any direction."""
    direction = np.exp(1j * rng.uniform(0, 2 * np.pi, COUNT))
    moved: ComplexArray = span.middle + at @ span.steps + span.rest * direction
    return moved


Made = tuple[Form, Callable[[FloatArray], FloatArray]]  # a form, and some of the values it has to hold


def product(rng: np.random.Generator, rest: float, symbols: int) -> Made:
    x, y = some_form(rng, rest, symbols), some_form(rng, rest, symbols)

    def values(at: FloatArray) -> FloatArray:
        one, other = (rng.choice([-1.0, 1.0], COUNT) for _ in range(2))
        return value(x, at, one) * value(y, at, other)

    return x * y, values


def norm(rng: np.random.Generator, rest: float, symbols: int) -> Made:
    span = some_span(rng, rest, symbols)
    return span.norm, lambda at: np.abs(anywhere(span, at, rng))


def area(rng: np.random.Generator, rest: float, symbols: int) -> Made:
    u, v = some_span(rng, rest, symbols), some_span(rng, rest, symbols)
    return u.cross(v), lambda at: (anywhere(u, at, rng).conj() * anywhere(v, at, rng)).imag


@SYMBOLS
@pytest.mark.parametrize("rest", [0.0, 0.25])
@pytest.mark.parametrize("operation", [product, norm, area])
def test_forms_hold_every_value(operation: Callable[..., Made], rest: float, symbols: int) -> None:
    rng = np.random.default_rng(0)
    form, values = operation(rng, rest, symbols)
    used = 0.0  # of its rest, at most
    for at in points(rng, symbols):
        off = np.abs(values(at) - value(form, at, np.zeros(COUNT)))
        assert np.all(off <= form.rest + 1e-15)
        used = max(used, float((off / form.rest).max()))
    assert used > 0.95


@SYMBOLS
def test_sums_and_multiples_hold_every_value(symbols: int) -> None:
    rng = np.random.default_rng(3)
    x, y = some_form(rng, 0.3, symbols), some_form(rng, 0.3, symbols)
    made = (x + y.times(-2.0)) - x.times(0.5)
    for at in points(rng, symbols):
        one, other = (rng.choice([-1.0, 1.0], COUNT) for _ in range(2))
        wanted = 0.5 * value(x, at, one) - 2 * value(y, at, other)
        assert np.all(np.abs(wanted - value(made, at, np.zeros(COUNT))) <= made.rest + 1e-12)


def test_placed_spans_hold_what_is_placed() -> None:
    rng = np.random.default_rng(7)
    span, turn, move = some_span(rng, 0.2, 2), 0.6 - 1.1j, 2.0 + 3.0j
    made = span.placed(turn, move)
    for at in points(rng, 2):
        there = turn * anywhere(span, at, rng) + move
        assert np.all(np.abs(there - made.middle - at @ made.steps) <= made.rest + 1e-12)
        assert np.all(np.abs(there - made.middle) <= made.reach + 1e-12)


@SYMBOLS
def test_quotients_hold_every_value_and_are_sharp(symbols: int) -> None:
    rng = np.random.default_rng(4)
    above, below = some_form(rng, 0.2, symbols), some_form(rng, 0.2, symbols)
    below = Form(np.abs(below.centre) + 1.5, below.slopes, below.rest)
    most, nearest = greatest_quotient(above, below), np.full(COUNT, np.inf)
    for at in points(rng, symbols):
        for sign in (-1.0, 1.0):
            down = np.full(COUNT, sign)
            ratio = value(above, at, np.ones(COUNT)) / value(below, at, down)
            positive = value(below, at, np.full(COUNT, -1.0)) > 0
            assert np.all((ratio <= most + 1e-12) | ~positive)
            nearest = np.minimum(nearest, np.where(np.isfinite(most), most - ratio, np.inf))
    assert nearest.min() < 1e-2
    assert np.all(np.isinf(most[below.inf <= 0]))


def test_quotient_over_what_may_vanish_is_unbounded() -> None:
    one, nothing = np.ones(1), np.zeros(1)
    constant, through_zero = Form(one, nothing[None], nothing), Form(nothing, one[None], nothing)
    assert np.isinf(greatest_quotient(constant, through_zero))


@SYMBOLS
def test_propagation_never_empties_a_square_with_a_point_that_does(symbols: int) -> None:
    rng = np.random.default_rng(5)
    at = rng.uniform(-1, 1, (symbols, COUNT))
    forms = []
    for _ in range(6):
        slopes = rng.normal(size=(symbols, COUNT)) * rng.choice([1e-9, 1.0], COUNT)
        slack = rng.choice([0.0, 1e-14, 0.1], COUNT)
        forms.append(Form(slack - (slopes * at).sum(axis=0), slopes, np.zeros(COUNT)))
    assert not nothing_left(forms).any()


@SYMBOLS
def test_propagation_empties_most_squares_without_such_a_point(symbols: int) -> None:
    rng = np.random.default_rng(6)
    slopes = rng.normal(size=(symbols, COUNT))
    beyond = np.abs(slopes).sum(axis=0) * rng.uniform(1.001, 2, COUNT)
    assert nothing_left([Form(-beyond, slopes, np.zeros(COUNT))]).all()


def test_propagation_joins_conditions() -> None:
    # s >= 0.5 and t >= 0.5, but s + t <= 0.8: neither form alone empties the square.
    nothing, half = np.zeros(1), np.full(1, -0.5)
    forms = [Form(half, np.array([[1.0], [0.0]]), nothing), Form(half, np.array([[0.0], [1.0]]), nothing)]
    assert not nothing_left(forms).any()
    assert nothing_left([*forms, Form(np.full(1, 0.8), np.array([[-1.0], [-1.0]]), nothing)]).all()
