"""Function generators of all kinds against the judge's positions, differences, samples and planted pairs."""

from collections.abc import Callable

import numpy as np
import pytest

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_function
from grashof.problems import Linkage, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth.quantities.kinds import KINDS
from grashof.synth.theory.functions.four_bar import FourBars
from grashof.synth.theory.functions.limits import ShapeLimits, offset_rows
from grashof.synth.theory.functions.output import Generators

EVERY = pytest.mark.parametrize("mechanism", list(KINDS))
SAMPLES = {"four-bar": 300, "slider-crank": 1500, "inverted-slider-crank": 800}  # of which many are open


def generator_of(linkage: Linkage, start: float, unit: float) -> Generators:
    """As the search sees a linkage, its driver at `start`, rad, when it begins."""
    return KINDS[linkage.mechanism.word].generators["output"].of_linkage(linkage, unit, 1, start)


def planted(
    rng: np.random.Generator, pairs: int, mechanism: str, *, full: bool = False
) -> tuple[Generators, FloatArray, FloatArray]:
    """A generator of some pairs, and the pairs in its unit."""
    task, linkage, start = planted_function(rng, pairs, full=full, mechanism=mechanism)
    return generator_of(linkage, start, task.output_unit), task.inputs, task.outputs / task.output_unit


def nearest(made: Generators, there: Generators) -> float:
    off = made.shape - there.shape
    off[:, -1] = np.angle(np.exp(1j * off[:, -1]))
    return float(np.abs(off).max(axis=1).min(initial=np.inf))


def several(mechanism: str, seed: int, span: float) -> Generators:
    rng = np.random.default_rng(seed)
    made = KINDS[mechanism].generators["output"].anything(rng, SAMPLES[mechanism], 0.0, span)
    shape = made.shape.copy()
    shape[:, -1] = rng.uniform(-np.pi, np.pi, len(made))
    return made.changed(shape)


def differences(made: Generators, of: Callable[[Generators], FloatArray]) -> FloatArray:
    """Central differences by every unknown, unknowns last."""
    steps = 1e-6 * np.eye(made.UNKNOWNS)
    ways = [[made.changed(made.shape + sign * step) for sign in (1, -1)] for step in steps]
    return np.stack([(of(ahead) - of(behind)) / 2e-6 for ahead, behind in ways], axis=-1)


@EVERY
def test_output_is_that_of_the_judge(mechanism: str) -> None:
    rng = np.random.default_rng(1)
    for _ in range(50):
        task, linkage, start = planted_function(rng, 6, mechanism=mechanism)
        made, state = generator_of(linkage, start, 1.0), solve_position(linkage, start + task.inputs)
        if task.travels:
            assert np.abs(made.outputs(task.inputs)[0] - state.travel).max() < 1e-12
            continue
        off = np.exp(1j * (made.outputs(task.inputs)[0] - np.unwrap(state.theta4)))
        assert np.abs(off - off[0]).max() < 1e-9


@EVERY
def test_random_ones_turn_fully_or_close_over_their_rotation(mechanism: str) -> None:
    rng, kind = np.random.default_rng(0), KINDS[mechanism].generators["output"]
    assert (kind.cranks(rng, 100).worst_cosine(2 * np.pi) < 1).all()
    made = kind.anything(rng, 1000, 0.5, 1.0)
    assert (made.worst_cosine(1.0) < 1).all()
    assert (made.first == 0.5).all()


@EVERY
def test_slopes_are_those_of_differences(mechanism: str) -> None:
    made, turned, _ = planted(np.random.default_rng(2), 8, mechanism)
    slopes = made.slopes(turned)
    assert np.abs(differences(made, lambda each: each.outputs(turned)) - slopes).max() < 1e-6


@EVERY
@pytest.mark.parametrize("full", [False, True])
def test_slopes_of_limits_are_those_of_differences(mechanism: str, full: bool) -> None:
    made = several(mechanism, 0, 1.0)
    count = made.lengths.shape[1]
    limits = ShapeLimits(
        2.5 if full else 1.0, caps=np.full((count, count), 3.0), transmission=0.5, over_cycle=full,
        margin=0.01 if full else None, offset=offset_rows([(0.5, 2.0)] * count, (-0.3, 0.7)),
    )  # fmt: skip
    slopes = limits.of(made).slope
    off = np.abs(differences(made, lambda each: limits.of(each).value) - slopes) / (1 + np.abs(slopes))
    assert off.max() < 1e-6


def test_slopes_of_the_stroke_are_those_of_differences() -> None:
    made = KINDS["slider-crank"].generators["output"].cranks(np.random.default_rng(0), 100)
    made = made[made.worst_cosine(2 * np.pi) < 0.95]
    limits = ShapeLimits(1.0, caps=np.full((3, 3), 3.0), margin=0.0, stroke=(0.5, 1.5))
    rows = limits.of(made)
    values, slopes = rows.value, rows.slope
    assert np.abs(differences(made, lambda each: limits.of(each).value) - slopes).max() < 1e-5
    dense = made.outputs(np.linspace(0, 2 * np.pi, 20001))
    assert np.abs(values[:, -2] - (np.ptp(dense, axis=1) - 0.5) / 0.5).max() < 1e-5


@EVERY
def test_worst_cosine_is_that_of_dense_samples(mechanism: str) -> None:
    """sin mu by the velocity of the output that the driver gives: its lever over all."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        task, linkage, start = planted_function(rng, 4, mechanism=mechanism)
        span = float(task.inputs[-1])
        state = solve_position(linkage, start + np.linspace(0, span, 20001))
        dense = np.abs(np.cos(state.theta4 - state.theta3))
        if mechanism == "inverted-slider-crank":  # the rod against A-O4, beyond which it pushes
            seen = linkage.o4 - state.a  # type: ignore[attr-defined]
            direction = np.arctan2(seen[:, 1], seen[:, 0])
            dense = np.abs(np.sin(direction - state.theta3))
        assert abs(generator_of(linkage, start, 1.0).worst_cosine(span)[0] - dense.max()) < 1e-6


@pytest.mark.slow
@pytest.mark.quick("inverted-slider-crank")
@EVERY
def test_all_planted_linkages_of_a_few_pairs_are_found(mechanism: str) -> None:
    rng, kind = np.random.default_rng(4), KINDS[mechanism].generators["output"]
    tasks = [planted(rng, kind.EXACT, mechanism) for _ in range(1000)]
    made, which = kind.through(*(np.array(each) for each in list(zip(*tasks, strict=True))[1:]))
    found = [nearest(made[which == k], tasks[k][0]) for k in range(1000)]
    assert max(found) < 1e-6
    assert set(np.bincount(which).tolist()) <= ({1} if kind.EXACT == 4 else {1, 3})


@EVERY
def test_given_starts_lead_to_the_linkage_that_has_them(mechanism: str) -> None:
    rng, kind = np.random.default_rng(6), KINDS[mechanism].generators["output"]
    for count in (kind.LINEAR + 1, 9):
        there, turned, output = planted(rng, count, mechanism)
        place = there.outputs(turned[:1])[:, 0]
        made = kind.at_starts(turned, output - output[0], there.first, place)
        assert nearest(made, there) < 1e-6
        assert np.abs(kind.place_of(kind.angle_of(place)) - place).max() < 1e-12


def test_limits_of_the_offset_leave_a_scale() -> None:
    """Against trying many scales."""
    rng = np.random.default_rng(7)
    scales = np.exp(np.linspace(-8, 8, 4001))[:, None]
    for _ in range(200):
        low, offset = np.exp(rng.normal(size=2)), np.sort(rng.normal(size=2))
        high = low * np.exp(rng.uniform(0.1, 2, 2))
        made = np.array([1.0, np.exp(rng.normal()), rng.normal()])
        sizes = [(float(a), float(b)) for a, b in zip(low, high, strict=True)]
        bounds = np.array([*sizes, offset]).T
        tried = scales * made
        fits = ((tried >= bounds[0]) & (tried <= bounds[1])).all(axis=1).any()
        lengths = max(low / made[:2]) <= min(high / made[:2])
        found = lengths and (offset_rows(sizes, (float(offset[0]), float(offset[1]))) @ made >= 0).all()
        assert found or not fits
        close = ((tried >= bounds[0] - 1e-2) & (tried <= bounds[1] + 1e-2)).all(axis=1).any()
        assert close or not found


@EVERY
@pytest.mark.parametrize("driver", [1, -1])
def test_a_generator_is_found_again_in_its_linkage(mechanism: str, driver: int) -> None:
    made = several(mechanism, 3, 1.0)[:40]
    wanted, unit = Requirements().resolved(1.0), 2.0
    for k in range(len(made)):
        one = made[k : k + 1]
        linkage = one.linkage(wanted, unit, driver)
        theta2 = one.direction(wanted) + driver * float(one.first[0])
        again = type(one).of_linkage(linkage, unit, driver, theta2)
        np.testing.assert_allclose(again.shape, one.shape, atol=1e-12)
        np.testing.assert_array_equal(again.assembly, one.assembly)


def test_three_pairs_of_the_textbook() -> None:
    """y = 1/x, Chebyshev spacing, from 30 and 240 deg (Shigley & Uicker; families: K and lengths)."""
    phi, psi = np.radians([36.03, 75, 113.97]), np.radians([251.30, 300, 326.88])
    made = FourBars.at_starts(phi - phi[0], psi - psi[0], phi[:1], psi[:1])
    assert np.abs(made.lengths[0] - [1, 2.47499, 0.91205, 2.47433]).max() < 1e-3
    theta4 = made.outputs(phi - phi[0])[0]
    assert np.abs(np.diff(theta4) - np.diff(psi)).max() < 1e-9
    # A negative r4 is half a turn more.
    assert abs(np.angle(np.exp(1j * (theta4[0] - psi[0] - np.pi)))) < 1e-9


def test_a_parallelogram_has_no_three_pairs() -> None:
    turned = np.array([0.0, 0.5, 1.0])
    made = FourBars.at_starts(turned, turned, np.array([0.3]), np.array([0.3]))
    assert not np.isfinite(made.shape).all() or len(made) == 1


def test_the_loop_closes_where_the_transmission_is_that_of_one() -> None:
    rng = np.random.default_rng(3)
    made = FourBars(rng.uniform(-1, 1, (500, 4)), np.ones(500))
    closed = np.isfinite(made.outputs(np.linspace(0.0, 2.0, 1001))).all(axis=1)
    surely = np.abs(made.worst_cosine(2.0) - 1) > 1e-3
    assert surely.sum() > 400
    assert ((made.worst_cosine(2.0) < 1) == closed)[surely].all()
