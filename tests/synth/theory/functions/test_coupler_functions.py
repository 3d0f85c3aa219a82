"""Couplers as generators: the exchange of links 3 and 4 against positions by the judge and by circles."""

import numpy as np
import pytest
from circles import closed

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_function
from grashof.problems import FourBar, Requirements
from grashof.synth.quantities.kinds import KINDS
from grashof.synth.theory.functions.four_bar import CouplerFourBars, FourBars
from grashof.synth.theory.functions.limits import ShapeLimits


def several(seed: int, count: int = 60) -> CouplerFourBars:
    """Some that close over 1 rad."""
    rng = np.random.default_rng(seed)
    made = CouplerFourBars.anything(rng, 400, 0.3, 1.0)
    return made[:count]


def test_the_exchanged_four_bar_turns_about_o4_as_the_coupler_does() -> None:
    """O4, and the fourth corner of the parallelogram on O4, B, A, at all positions."""
    rng = np.random.default_rng(0)
    for _ in range(20):
        _, linkage, start = planted_function(rng, 5)
        turned = np.linspace(0, 0.5, 21)
        state = solve_position(linkage, start + turned)
        r1, r2, r3, r4 = linkage.lengths
        other = FourBar((0, 0), (r1, 0), r2, r4, r3, assembly=-linkage.assembly)
        exchanged = solve_position(other, start + turned)
        corner = linkage.o4 + state.a - state.b
        np.testing.assert_allclose(exchanged.a, state.a, atol=1e-12)
        np.testing.assert_allclose(exchanged.b, corner, atol=1e-9)
        assert np.abs(np.exp(1j * exchanged.theta4) + np.exp(1j * state.theta3)).max() < 1e-9
        sines = np.sin(state.theta4 - state.theta3), np.sin(exchanged.theta4 - exchanged.theta3)
        np.testing.assert_allclose(sines[0], -sines[1], atol=1e-9)  # mu is the same


@pytest.mark.parametrize("driver", [1, -1])
def test_outputs_are_those_of_the_linkage_that_is_made(driver: int) -> None:
    """In the sense of the driver: mirror images turn it clockwise."""
    made, wanted, turned = several(1), Requirements().resolved(1.0), np.linspace(0, 1.0, 31)
    for k in range(len(made)):
        one = made[k : k + 1]
        linkage = one.linkage(wanted, 1.0, driver)
        numbers = np.array([*linkage.o2, *linkage.o4, *linkage.lengths[1:], 0.0, 0.0])
        a, b, _ = closed(numbers, driver * (float(one.first[0]) + turned), float(linkage.assembly))
        theta3 = driver * np.unwrap(np.angle(b - a))
        off = one.outputs(turned)[0] - theta3
        assert np.abs(off - off[0]).max() < 1e-7
        again = CouplerFourBars.of_linkage(linkage, 1.0, driver, driver * float(one.first[0]))
        np.testing.assert_allclose(again.shape, one.shape, atol=1e-12)
        np.testing.assert_array_equal(again.assembly, one.assembly)


def test_lengths_have_the_limits_of_their_own_links() -> None:
    wanted = Requirements(r3=(2.0, 3.0), r4=(0.5, 0.7)).resolved(1.0)
    names, sizes = CouplerFourBars.sizes(wanted, 1.0)
    assert names == ("r1", "r2", "r4", "r3")
    assert sizes[2:] == [(0.5, 0.7), (2.0, 3.0)]


def test_the_extent_and_the_transmission_are_those_of_the_linkage() -> None:
    made, wanted = several(2, 20), Requirements().resolved(1.0)
    extent, worst = made.extent(1.0, 1.0), made.worst_cosine(1.0)
    for k in range(len(made)):
        linkage = made[k : k + 1].linkage(wanted, 1.0, 1)
        itself = FourBars.of_linkage(linkage, 1.0, 1, float(made.first[k]))
        assert itself.worst_cosine(1.0)[0] == pytest.approx(worst[k], abs=1e-12)
        state = solve_position(linkage, made.first[k] + np.linspace(0, 1.0, 13))
        every = np.concatenate([state.a, state.b, [linkage.o2, linkage.o4]])
        assert np.hypot(*np.ptp(every, axis=0)) == pytest.approx(extent[k] * float(linkage.r1), rel=1e-9)


@pytest.mark.parametrize("shortest", [1, -1])
def test_full_cranks_are_the_same_kinds(shortest: int) -> None:
    """The crank of a crank-rocker swings its coupler, that of a double-crank turns it, too."""
    made = CouplerFourBars.cranks(np.random.default_rng(3), 60, shortest=shortest)
    limits = ShapeLimits(1.0, margin=0.0, shortest=shortest, caps=np.full((4, 4), 10.0))
    assert (limits.of(made).value.min(axis=1) >= -1e-9).all()
    name = "crank-rocker" if shortest > 0 else "double-crank"
    turned = np.linspace(0, 2 * np.pi, 2001)
    for k in range(len(made)):
        linkage = made[k : k + 1].linkage(Requirements().resolved(1.0), 1.0, 1)
        r1, r2, r3, r4 = linkage.lengths
        assert (min(r1, r2, r3, r4) == r2) == (name == "crank-rocker")
        theta3 = np.unwrap(solve_position(linkage, turned).theta3)
        assert (abs(theta3[-1] - theta3[0]) > 6) == (name == "double-crank")


def test_which_kinds_have_generators_of_couplers() -> None:
    having = {word for word, kind in KINDS.items() if "coupler" in kind.generators}
    assert having == {"four-bar", "inverted-slider-crank"}
