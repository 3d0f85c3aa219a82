"""Shared by the tests of forces: everything that can act, and linkages that it acts on."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import rotatability
from grashof.analysis.judge.planted import RANDOM
from grashof.problems import DynamicsSpec, FourBar, InvertedSliderCrank, SliderCrank
from grashof.problems.values.dynamics import load_specs as specs
from grashof.problems.values.dynamics.strength import SectionSpec
from grashof.problems.values.linkages.linkage import Linkage

CARD = ((0, 0.3, -9), (90, 0.4, -20), (180, -0.1, -20), (250, 0, -11), (360, 0.3, -9))
TRAVEL = ((-10, 1, -2), (-1, 3, 0), (0.5, -2, 1), (2, 0, 4), (10, 1, 1))
ALIKE = (
    specs.LoadSpec(3, at=(0.2, 0.3), force=(1.0, 2.0), frame="link"),
    specs.LoadSpec(2, moment=-0.7),
    specs.LoadSpec(3, at=(0.1, 0), values=((0, 1, 2), (1, -1, 0), (5, 2, 2)), over="time"),
)
OVER_THETA4 = specs.LoadSpec(4, values=((0, 1), (120, -1), (360, 1)), over="theta4")
OF_FOUR_BARS = DynamicsSpec(
    density=800.0,
    section=SectionSpec(0.05, 0.02),
    payload=1.0,
    speed_rpm=30,
    gravity=(0.5, -9.81),
    loads=(specs.LoadSpec(4, at=(-0.7, 0.1), values=CARD), *ALIKE, OVER_THETA4),
    springs=(specs.SpringSpec((specs.Place(1, (0.2, 0.9)), specs.Place(4, (0.3, 0.1))), 30.0, 0.4),),
    dampers=(specs.DamperSpec((specs.Place(2, (0.2, 0.9)), specs.Place(4, (0.3, 0.1))), 4.0),),
    torsion_springs=(specs.TorsionSpringSpec((3, 2), 2.0, 40.0), specs.TorsionSpringSpec((1, 4), 1.0)),
    counterweights=(specs.CounterweightSpec(2, 3.0, (-0.4, 0.1)),),
    friction=specs.FrictionSpec(0.1, (0.01, 0.02, 0.01, 0.03), viscous=0.1, moment=(0, 0.1, 0, 0)),
)
SLIDE = {"slide_mu": 0.05, "slide_length": 0.5, "slide_viscous": 0.7, "slide_force": 0.3}
OF_SLIDERS = replace(
    OF_FOUR_BARS,
    loads=(
        specs.LoadSpec(
            4, at=(-0.2, 0.1), values=((0, 0.3, -9), (120, 0.4, -20), (250, 0, -11), (360, 0.3, -9))
        ),
        specs.LoadSpec(4, at=(0.1, -0.3), values=TRAVEL, over="travel"),
        specs.LoadSpec(4, at=(0.1, 0.2), force=(2.0, -1.0), frame="link"),
        specs.LoadSpec(4, moment=0.9),
        *ALIKE,
    ),
    counterweights=(*OF_FOUR_BARS.counterweights, specs.CounterweightSpec(4, 2.0, (0.1, 0.2))),
)
EVERYTHING = {
    FourBar: OF_FOUR_BARS,
    SliderCrank: replace(
        OF_SLIDERS,
        torsion_springs=(specs.TorsionSpringSpec((3, 2), 2.0, 40.0), specs.TorsionSpringSpec((3, 4), 1.0)),
        friction=specs.FrictionSpec(0.1, (0.01, 0.02, 0.01, 0), viscous=0.1, moment=(0, 0.1, 0, 0), **SLIDE),
    ),
    InvertedSliderCrank: replace(
        OF_SLIDERS,
        loads=(*OF_SLIDERS.loads, OVER_THETA4),
        friction=specs.FrictionSpec(0.1, (0.01, 0.02, 0, 0.03), viscous=0.1, moment=(0, 0.1, 0, 0), **SLIDE),
    ),
}


def _made(kind: type[Linkage], count: int, margin: float = 0.05) -> list[Linkage]:
    """Linkages of a kind and of unit size, placed anywhere, whose drivers turn fully by a margin."""
    rng = np.random.default_rng(7)
    found: list[Linkage] = []
    while len(found) < count:
        one = RANDOM[kind.mechanism.word](rng)
        one = one.scaled(float(2 / one.lengths.mean()), np.zeros(2))
        if rotatability(one).min() > margin:
            found.append(one)
    return found


@pytest.fixture(scope="session")
def everything() -> dict[type[Linkage], DynamicsSpec]:
    """Everything that can act, by the kind of linkage."""
    return EVERYTHING


@pytest.fixture(scope="session")
def made() -> Callable[..., list[Linkage]]:
    """Some linkages: kind, count and least distance from a dead position."""
    return _made
