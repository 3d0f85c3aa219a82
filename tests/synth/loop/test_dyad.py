"""The dyads of the search, against the judge and against differences."""

from types import SimpleNamespace

import numpy as np
import pytest
from random_linkages import any_linkages

from grashof.analysis import solve_kinematics, transmission_angle
from grashof.problems import Linkage
from grashof.problems.values.linkages.mechanisms import CLASSES
from grashof.synth.loop.dimensions import sized_loop
from grashof.synth.loop.dyad import Bars, PlacedLoop, as_complex, as_vector, coupler_of, root_or_zero
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.kinds import KINDS

TURN = np.linspace(-3, 3, 50)
SINGLE = [(word, seed) for word in CLASSES for seed in range(8)]


def drawn(word: str, seed: int) -> tuple[Linkage, SimpleNamespace]:
    """A linkage, and its ground, O2A at `TURN`, and lengths as dyads take them."""
    linkage = any_linkages(CLASSES[word], 1, np.random.default_rng(seed))[0]
    pinned = "o4" in linkage.mechanism.ground
    ground = (linkage.o4 - linkage.o2) @ [1, 1j] if pinned else np.exp(1j * linkage.theta1)
    r3, r4 = (float(getattr(linkage, name, getattr(linkage, "offset", 0.0))) for name in ("r3", "r4"))
    crank, assembly = linkage.r2 * np.exp(1j * TURN), int(linkage.assembly)
    return linkage, SimpleNamespace(ground=ground, crank=crank, r3=r3, r4=r4, assembly=assembly)


@pytest.mark.parametrize(("word", "seed"), SINGLE)
def test_the_loop_and_its_rates_are_those_of_the_judge(word: str, seed: int) -> None:
    linkage, own = drawn(word, seed)
    dyad = KINDS[word].dyad
    state = solve_kinematics(linkage, TURN, omega2=1.0)
    sound = np.sin(transmission_angle(linkage, TURN)) > 0.05
    ground, crank = as_vector(np.asarray(own.ground)), as_vector(own.crank)
    with np.errstate(invalid="ignore"):
        loop = dyad.closed(ground, crank, own.r3, own.r4, own.assembly)
        rates = dyad.rates(loop, crank, own.r4)
    coupler, direction = coupler_of(dyad, *vars(own).values())
    np.testing.assert_allclose(
        coupler[sound], ((state.b.position - state.a.position) @ [1, 1j])[sound], atol=1e-9
    )
    np.testing.assert_allclose(direction[sound], np.exp(1j * state.theta3)[sound], atol=1e-9)
    for mine, theirs in zip(rates, (state.omega3, state.omega4, state.alpha3, state.alpha4), strict=True):
        np.testing.assert_allclose(
            np.broadcast_to(mine, TURN.shape)[sound], theirs[sound], rtol=1e-8, atol=1e-9
        )


@pytest.mark.parametrize(("word", "seed"), SINGLE)
def test_moving_b_turns_link_3_and_the_output(word: str, seed: int) -> None:
    """A driver that is moved a little moves B as its rate says."""
    _, own = drawn(word, seed)
    dyad, step, ground = KINDS[word].dyad, 1e-6, as_vector(np.asarray(own.ground))
    with np.errstate(invalid="ignore", divide="ignore"):
        ways = [
            (crank, dyad.closed(ground, crank, own.r3, own.r4, own.assembly))
            for crank in (as_vector(own.crank * np.exp(1j * by)) for by in (-step, 0.0, step))
        ]
        (before, one), (crank, loop), (after, other) = ways
        turned = np.angle(as_complex(other.along) / as_complex(one.along)) / (2 * step)
        output = (dyad.output(other, after) - dyad.output(one, before)) / (2 * step)
        lever = dyad.lever(loop)
        sound = np.abs(lever) > 0.05
        speed3 = -crank.left.dot(loop.across) / lever
        np.testing.assert_allclose(speed3[sound], turned[sound], rtol=1e-5, atol=1e-6)
        moved = dyad.driven_by(loop, crank.left) / lever
    whole = np.abs(output) < 1e5  # not where an angle is counted anew
    np.testing.assert_allclose(moved[sound & whole], output[sound & whole], rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize(("word", "seed"), SINGLE)
def test_the_gap_is_zero_where_the_loop_closes_and_there_alone(word: str, seed: int) -> None:
    """With the direction of link 3 from the closure, and turned from there by 0.1 rad."""
    linkage, own = drawn(word, seed)
    dyad, at = KINDS[word].dyad, PlacedLoop()
    at.o2, at.normal = Vector(*linkage.o2), as_vector(np.asarray(own.ground))
    at.o4 = at.o2 + at.normal
    at.r1, at.r2, at.r3 = abs(own.ground), linkage.r2, own.r3
    at.r4 = at.offset = own.r4
    crank = as_vector(own.crank)
    with np.errstate(invalid="ignore"):
        loop = dyad.closed(dyad.ground(at), crank, own.r3, own.r4, own.assembly)
        sound = np.sin(transmission_angle(linkage, TURN)) > 0.1
        along, across = dyad.directions(loop, own.r3, own.r4)
        a = at.o2 + crank
        b = dyad.b(at, a, along)
        carried = dyad.across(at, b, along)
        lever = (b - a).cross(carried) / dyad.most_lever(at)
        aside = along.turned(0.1)
        at_b = dyad.b(at, a, aside)
        missed = dyad.gap(at, a, at_b, dyad.across(at, at_b, aside))
    assert sound.any()
    np.testing.assert_allclose(np.broadcast_to(dyad.gap(at, a, b, carried), TURN.shape)[sound], 0, atol=1e-9)
    assert (np.abs(missed)[sound] > 1e-4).all()
    assert (np.sign(lever)[sound] == own.assembly).all()
    unit = carried / (own.r4 if dyad.bars > 1 else 1.0)
    for mine, theirs in ((unit.x, across.x), (unit.y, across.y)):
        np.testing.assert_allclose(*(np.broadcast_to(each, TURN.shape)[sound] for each in (mine, theirs)))
    np.testing.assert_allclose(dyad.reach_at(at, a), dyad.reach(at, TURN - np.angle(own.ground)), atol=1e-9)


@pytest.mark.parametrize(("word", "seed"), SINGLE)
def test_the_loop_follows_its_dimensions(word: str, seed: int) -> None:
    """The turn of link 3 by each dimension, against differences."""
    linkage, own = drawn(word, seed)
    dyad = KINDS[word].dyad
    to_o4 = np.array([own.ground.real, own.ground.imag])
    second = linkage.o2 + to_o4 if dyad.pinned else [np.angle(own.ground), 0.0]
    start = np.array([*linkage.o2, *second, linkage.r2, own.r3, own.r4])
    e2, step = np.exp(1j * TURN), 1e-6
    loop = sized_loop(dyad, start, e2, own.assembly * np.ones(50))
    below = loop.rod * (loop.e3 * loop.e4.conj()).imag
    for k, moved in enumerate(loop.moved):
        by = step * np.eye(7)[k]
        one, other = (sized_loop(dyad, start + sign * by, e2, own.assembly * np.ones(50)) for sign in (-1, 1))
        with np.errstate(invalid="ignore", divide="ignore"):
            turned, sound = np.angle(other.e3 / one.e3) / (2 * step), np.abs(below) > 0.05
            np.testing.assert_allclose((moved / below)[sound], turned[sound], rtol=1e-5, atol=1e-6)


def test_an_open_loop_has_numbers_only_on_request() -> None:
    """A is 5.1, 4 and 0.5 from O4."""
    sizes = np.float64(3), np.float64(2), 1.0
    crank = np.array([-5.1j, -4 + 0j, -0.5])
    coupler, _ = coupler_of(Bars(), 0.0, crank, *sizes)
    assert np.isnan(coupler).tolist() == [True, False, True]
    assert abs(coupler[1]) == pytest.approx(3)
    assert abs(coupler[1] - 4) == pytest.approx(2)
    assert coupler[1].imag > 0  # B left of the line from A to O4
    nearest, _ = coupler_of(Bars(), 0.0, crank, *sizes, root_or_zero)
    assert np.isfinite(nearest).all()
