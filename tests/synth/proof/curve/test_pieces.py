"""Pieces hold the curve: every point of it, with its centre, and hardly more."""

import numpy as np
import pytest
from proof_problems import planted

from grashof import load
from grashof.problems import Problem
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.proof.curve.centres import centres_of, of_rows
from grashof.synth.proof.curve.curve import Curve, Taylor
from grashof.synth.proof.curve.dyads import possible_radii
from grashof.synth.proof.curve.pieces import Tubes, contracted
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.forms.forms import Span
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.burmester import Displacements, Dyads, centre_points, circle_points_on_lines, polish

PROBLEMS = [load("luggage"), *map(planted, range(3))]


def required(problem: Problem) -> Required:
    return Required.of(ScaledProblem.of(problem))


def motion_of(curve: Curve) -> Displacements:
    return Displacements(curve.rotation, curve.shift)


def on_curve(curve: Curve, reach: float, lines: int) -> Dyads:
    """Dyads on many lines, by the roots of cubics, polished."""
    motion = motion_of(curve)
    places = np.linspace(-reach, reach, lines)
    points = np.concatenate([
        circle_points_on_lines(motion, places.astype(np.complex128), 1j),
        circle_points_on_lines(motion, 1j * places, 1.0),
    ])  # fmt: skip
    points = points[np.abs(points) < reach]
    centres = centre_points(motion, points)
    near = np.isfinite(centres) & (np.abs(centres) < 50)
    return polish(motion, Dyads(points[near], centres[near]))


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda one: one.name)
def test_polynomial_vanishes_where_four_places_are_on_a_circle(problem: Problem) -> None:
    curve = required(problem).curve
    dyads = on_curve(curve, 4.0, 60)
    taylor = curve.about(dyads.moving)
    assert len(dyads) > 50
    slope = np.maximum(np.abs(taylor.linear), 1e-3) * (1 + np.abs(dyads.moving))
    assert np.all(np.abs(taylor.value) <= 1e-9 * slope)


@pytest.mark.parametrize("problem", PROBLEMS[:2], ids=lambda one: one.name)
def test_taylor_series_is_exact(problem: Problem) -> None:
    curve, rng = required(problem).curve, np.random.default_rng(0)
    q, w = (rng.normal(size=200) + 1j * rng.normal(size=200) for _ in range(2))
    turn = np.exp(1j * rng.uniform(0, 2 * np.pi, 200))
    taylor = curve.about(q).turned(turn)
    square = np.abs(w) ** 2
    value = 2 * (taylor.cubic * w).real * square + 2 * (taylor.square * w**2).real + taylor.both * square
    value = value + 2 * (taylor.linear * w).real + taylor.value
    assert np.allclose(value, curve.about(q + turn * w).value, rtol=0, atol=1e-11)


def inside(tubes: Tubes, k: int, points: ComplexArray) -> tuple[np.ndarray, np.ndarray]:
    """The parameter of points in a tube, and the share of its rest that they use."""
    moved = (points - tubes.middle[k]) * np.conj(tubes.direction[k])
    s = moved.real / tubes.half[k]
    off = np.abs(moved.imag - tubes.tilt[k] * s - tubes.bow[k] * (s * s - 0.5))
    return s, off / tubes.rest[k]


@pytest.mark.parametrize("size", [0.4, 0.1, 0.02])
@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda one: one.name)
def test_tubes_and_centres_hold_the_points_of_their_rectangles(problem: Problem, size: float) -> None:
    about = required(problem)
    curve, rng = about.curve, np.random.default_rng(1)
    dyads = on_curve(curve, 4.0, 400)
    picked = rng.choice(len(dyads), 40)
    middle = dyads.moving[picked] + size * rng.uniform(-1, 1, 40) * np.exp(1j * rng.uniform(0, 7, 40))
    direction = np.exp(1j * rng.uniform(0, 2 * np.pi, 40))
    side = size * rng.uniform(0.2, 1, 40)
    rectangles = Tubes.rectangles(middle, direction, np.full(40, size), side)
    tubes, filled = contracted(curve, rectangles)
    centres = centres_of(curve, tubes, about.longest)
    most = most_centre = 0.0
    for k in range(40):
        moved = (dyads.moving - middle[k]) * np.conj(direction[k])
        rows = np.flatnonzero((np.abs(moved.real) <= size) & (np.abs(moved.imag) <= side[k]))
        rows = rows[np.abs(dyads.moving[rows] - dyads.ground[rows]) <= about.longest]
        assert filled[k] or not len(rows)
        s, used = inside(tubes, k, dyads.moving[rows])
        assert np.all(np.abs(s) <= 1 + 1e-9)
        assert np.all(used <= 1 + 1e-6)
        off = np.abs(dyads.ground[rows] - centres.middle[k] - centres.along[k] * s) / centres.rest[k]
        assert np.all(off <= 1 + 1e-6)
        most, most_centre = max(most, *used, 0.0), max(most_centre, *off, 0.0)
    if size < 0.4:
        assert most > 0.2  # the bounds are near what they bound
        assert most_centre > 0.05


@pytest.mark.parametrize("rows", [(0, 1), (0, 2), (1, 2)])
@pytest.mark.parametrize("scale", [1.0, 0.1, 0.01])
def test_centres_hold_every_solution_of_two_equations(rows: tuple[int, int], scale: float) -> None:
    # Wide tubes that are on no curve: every term of the remainder has its turn.
    curve, rng, count = required(PROBLEMS[1]).curve, np.random.default_rng(3), 4000
    middle = rng.normal(size=count) + 1j * rng.normal(size=count)
    direction = np.exp(1j * rng.uniform(0, 7, count))
    half, tilt, bow, rest = scale * rng.uniform(0, 0.2, (4, count)) * rng.choice([0.01, 1.0], (4, count))
    tubes = Tubes(middle, direction, half, tilt, bow, rest)
    centres = of_rows(curve, tubes, rows)
    most = 0.0
    for s, e in [
        (1.0, 1.0),
        (1.0, -1.0),
        (-1.0, 1.0),
        (-1.0, -1.0),
        (0.0, 1.0),
        (0.0, -1.0),
        *rng.uniform(-1, 1, (8, 2)),
    ]:
        z = middle + direction * (half * s + 1j * (tilt * s + bow * (s * s - 0.5) + e * rest))
        turn, move = curve.rotation[1:, None], curve.shift[1:, None]
        a = (turn - 1) * z + move
        k = (np.abs(turn * z + move) ** 2 - np.abs(z) ** 2) / 2
        i, j = rows
        c = 1j * (k[j] * a[i] - k[i] * a[j]) / (a[i].conj() * a[j]).imag
        off = np.abs(c - centres.middle - centres.along * s)
        assert np.all(off <= centres.rest * (1 + 1e-9))
        most = max(most, float((off / centres.rest)[np.isfinite(centres.rest)].max()))
    assert most > 0.95  # nothing to spare


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda one: one.name)
def test_halves_hold_what_a_tube_holds(problem: Problem) -> None:
    about, rng = required(problem), np.random.default_rng(2)
    dyads = on_curve(about.curve, 3.0, 100)
    middle = dyads.moving[rng.choice(len(dyads), 60)]
    size = np.full(60, 0.2)
    tubes, _ = contracted(about.curve, Tubes.rectangles(middle, np.ones(60, complex), size, size))
    s, e = rng.uniform(-1, 1, (2, 60))
    across = tubes.tilt * s + tubes.bow * (s * s - 0.5) + e * tubes.rest
    points = tubes.middle + tubes.direction * (tubes.half * s + 1j * across)
    held = np.zeros(60, dtype=bool)
    for half in (tubes.halves[:60], tubes.halves[60:]):
        moved = (points - half.middle) * half.direction.conj()
        held |= (np.abs(moved.real) <= half.half) & (np.abs(moved.imag) <= half.side)
    assert held.all()


def test_contracted_tubes_shrink_with_the_square_of_their_length() -> None:
    about = required(PROBLEMS[0])
    dyads = on_curve(about.curve, 3.0, 40)
    dyads = dyads[np.abs(dyads.moving - dyads.ground) < 3]
    rest = []
    for size in (0.04, 0.02, 0.01):
        count = len(dyads)
        side = np.full(count, size)
        around = Tubes.rectangles(dyads.moving, np.ones(count, complex), side, side)
        tubes, _ = contracted(about.curve, around)
        rest.append((np.median(tubes.rest), np.median(centres_of(about.curve, tubes, about.longest).rest)))
    (first, first_centre), (second, second_centre), (third, third_centre) = rest
    assert first / second > 3
    assert second / third > 3  # without the parabola, of third order
    assert 3 < second_centre / third_centre < 9
    assert first_centre > second_centre


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


X, Y = 0.7, 0.4


def taylor(cubic: complex = 0, square: complex = 0, both: float = 0) -> Taylor:
    nothing = np.zeros(1)
    complexes = np.array([[cubic], [square], [0]], dtype=np.complex128)
    return Taylor(complexes[0], complexes[1], nothing + both, complexes[2], nothing, nothing)


def greatest(one: Taylor, *, parabola: bool) -> FloatArray:
    """Of the terms on a grid with its corners, with or without that of x^2."""
    x, y = np.meshgrid(np.linspace(-X, X, 41), np.linspace(-Y, Y, 41))
    w = x + 1j * y
    f = 2 * (one.cubic * w).real * np.abs(w) ** 2 + 2 * (one.square * w**2).real + one.both * np.abs(w) ** 2
    if not parabola:
        f = f - (one.both + 2 * one.square.real) * x**2
    most: FloatArray = np.abs(f).max()
    return most


@pytest.mark.parametrize(
    "one",
    [
        taylor(cubic=1),
        taylor(cubic=1j),
        taylor(square=1j),
        taylor(square=0.5, both=1),
        taylor(square=-0.5, both=1),
    ],
)
def test_bounds_of_single_terms_are_reached(one: Taylor) -> None:
    x, y = np.array([X]), np.array([Y])
    assert one.beyond_linear(x, y) == pytest.approx(greatest(one, parabola=True), rel=1e-12)
    assert one.beyond_parabola(x, y) == pytest.approx(greatest(one, parabola=False), rel=1e-12)


def test_bounds_hold_all_terms_together() -> None:
    rng = np.random.default_rng(0)
    x, y = np.array([X]), np.array([Y])
    for _ in range(200):
        cubic, square = (complex(*rng.normal(size=2)) for _ in range(2))
        one = taylor(cubic, square, float(rng.normal()))
        assert one.beyond_linear(x, y) >= greatest(one, parabola=True) * (1 - 1e-12)
        assert one.beyond_parabola(x, y) >= greatest(one, parabola=False) * (1 - 1e-12)
