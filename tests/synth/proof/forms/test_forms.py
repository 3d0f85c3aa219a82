"""Affine forms hold every value, at corners and inside, and hardly more."""

from collections.abc import Callable

import numpy as np
import pytest

from grashof.problems.values.arrays import FloatArray
from grashof.synth.proof.forms.forms import Form, Span, greatest_quotient
from grashof.synth.proof.forms.square import nothing_left

COUNT = 3000
CORNERS = np.array([[x, y] for x in (-1.0, 0.0, 1.0) for y in (-1.0, 0.0, 1.0)])


def points(rng: np.random.Generator) -> FloatArray:
    """Places in the square, corners first."""
    return np.concatenate([CORNERS, rng.uniform(-1, 1, (40, 2))])


def some_form(rng: np.random.Generator, rest: float) -> Form:
    centre, s, t = rng.normal(size=(3, COUNT)) * [[2.0], [0.5], [0.5]]
    return Form(centre, s, t, rest * rng.uniform(size=COUNT))


def some_span(rng: np.random.Generator, rest: float) -> Span:
    parts = rng.normal(size=(3, COUNT)) + 1j * rng.normal(size=(3, COUNT))
    size = rng.choice([0.01, 0.3, 1.0], COUNT)
    return Span(parts[0], parts[1] * size, parts[2] * size, rest * rng.uniform(size=COUNT))


def value(form: Form, s: float, t: float, off: FloatArray) -> FloatArray:
    """A value of a form, its rest used by a share `off`."""
    return form.centre + form.s * s + form.t * t + off * form.rest


def place(span: Span, s: float, t: float, off: FloatArray, direction: FloatArray) -> FloatArray:
    """A value of a complex form."""
    moved: FloatArray = span.middle + span.s * s + span.t * t + off * span.rest * np.exp(1j * direction)
    return moved


def closest(form: Form, values: Callable[[float, float], FloatArray], rng: np.random.Generator) -> float:
    """Assert that a form holds values everywhere; how much of its rest they use at most."""
    used = 0.0
    for s, t in points(rng):
        off = np.abs(values(float(s), float(t)) - value(form, float(s), float(t), np.zeros(COUNT)))
        assert np.all(off <= form.rest + 1e-15)
        used = max(used, float((off / form.rest).max()))
    return used


@pytest.mark.parametrize("rest", [0.0, 0.3])
def test_products_hold_every_value(rest: float) -> None:
    rng = np.random.default_rng(0)
    x, y = some_form(rng, rest), some_form(rng, rest)

    def values(s: float, t: float) -> FloatArray:
        one, other = (rng.choice([-1.0, 1.0], COUNT) for _ in range(2))
        return value(x, s, t, one) * value(y, s, t, other)

    assert closest(x * y, values, rng) > 0.99


@pytest.mark.parametrize("rest", [0.0, 0.2])
def test_norms_hold_every_value(rest: float) -> None:
    rng = np.random.default_rng(1)
    span = some_span(rng, rest)

    def values(s: float, t: float) -> FloatArray:
        return np.abs(place(span, s, t, np.ones(COUNT), rng.uniform(0, 2 * np.pi, COUNT)))

    assert closest(span.norm, values, rng) > 0.95


@pytest.mark.parametrize("rest", [0.0, 0.2])
def test_signed_areas_hold_every_value(rest: float) -> None:
    rng = np.random.default_rng(2)
    u, v = some_span(rng, rest), some_span(rng, rest)

    def values(s: float, t: float) -> FloatArray:
        one, other = (place(span, s, t, np.ones(COUNT), rng.uniform(0, 2 * np.pi, COUNT)) for span in (u, v))
        area: FloatArray = (one.conj() * other).imag
        return area

    assert closest(u.cross(v), values, rng) > 0.95


def test_sums_and_multiples_hold_every_value() -> None:
    rng = np.random.default_rng(3)
    x, y = some_form(rng, 0.3), some_form(rng, 0.3)
    made = (x + y.times(-2.0)) - x.times(0.5)
    for s, t in points(rng):
        one, other = (rng.choice([-1.0, 1.0], COUNT) for _ in range(2))
        wanted = 0.5 * value(x, s, t, one) - 2 * value(y, s, t, other)
        assert np.all(np.abs(wanted - value(made, s, t, np.zeros(COUNT))) <= made.rest + 1e-12)


def test_quotients_hold_every_value_and_are_sharp() -> None:
    rng = np.random.default_rng(4)
    above, below = some_form(rng, 0.2), some_form(rng, 0.2)
    below = Form(np.abs(below.centre) + 1.5, below.s, below.t, below.rest)
    most, nearest = greatest_quotient(above, below), np.full(COUNT, np.inf)
    for s, t in points(rng):
        for sign in (-1.0, 1.0):
            down = np.full(COUNT, sign)
            ratio = value(above, s, t, np.ones(COUNT)) / value(below, s, t, down)
            positive = value(below, s, t, np.full(COUNT, -1.0)) > 0
            assert np.all((ratio <= most + 1e-12) | ~positive)
            nearest = np.minimum(nearest, np.where(np.isfinite(most), most - ratio, np.inf))
    assert nearest.min() < 1e-2
    assert np.all(np.isinf(most[below.inf <= 0]))


def test_quotient_over_what_may_vanish_is_unbounded() -> None:
    one, nothing = np.ones(1), np.zeros(1)
    constant, through_zero = Form(one, nothing, nothing, nothing), Form(nothing, one, nothing, nothing)
    assert np.isinf(greatest_quotient(constant, through_zero))


def test_propagation_never_empties_a_square_with_a_point_that_does() -> None:
    rng = np.random.default_rng(5)
    s, t = rng.uniform(-1, 1, (2, COUNT))
    forms = []
    for _ in range(6):
        slopes = rng.normal(size=(2, COUNT)) * rng.choice([1e-9, 1.0], COUNT)
        slack = rng.choice([0.0, 1e-14, 0.1], COUNT)
        forms.append(Form(slack - slopes[0] * s - slopes[1] * t, *slopes, np.zeros(COUNT)))
    assert not nothing_left(forms).any()


def test_propagation_empties_most_squares_without_such_a_point() -> None:
    rng = np.random.default_rng(6)
    slopes = rng.normal(size=(2, COUNT))
    nothing = np.zeros(COUNT)
    beyond = np.abs(slopes).sum(axis=0) * rng.uniform(1.001, 2, COUNT)
    assert nothing_left([Form(-beyond, *slopes, nothing)]).all()
    # s >= 0.5 and t >= 0.5, but s + t <= 0.8: neither form alone empties it.
    one, half = np.ones(1), np.full(1, -0.5)
    forms = [Form(half, one, 0 * one, 0 * one), Form(half, 0 * one, one, 0 * one)]
    assert not nothing_left(forms).any()
    assert nothing_left([*forms, Form(np.full(1, 0.8), -one, -one, 0 * one)]).all()
