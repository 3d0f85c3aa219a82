"""Shared by the tests of forces: everything that can act, and linkages that it acts on."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from grashof.problems import DynamicsSpec, FourBar, InvertedSliderCrank, SliderCrank
from grashof.problems.values.dynamics.load_specs import (
    CounterweightSpec,
    DamperSpec,
    FrictionSpec,
    LoadSpec,
    Place,
    SpringSpec,
    TorsionSpringSpec,
)
from grashof.problems.values.dynamics.strength import SectionSpec
from grashof.problems.values.linkages.linkage import Linkage

CARD = ((0, 0.3, -9), (90, 0.4, -20), (180, -0.1, -20), (250, 0, -11), (360, 0.3, -9))
TRAVEL = ((-10, 1, -2), (-1, 3, 0), (0.5, -2, 1), (2, 0, 4), (10, 1, 1))
ALIKE = (
    LoadSpec(3, at=(0.2, 0.3), force=(1.0, 2.0), frame="link"),
    LoadSpec(2, moment=-0.7),
    LoadSpec(3, at=(0.1, 0), values=((0, 1, 2), (1, -1, 0), (5, 2, 2)), over="time"),
)
OVER_THETA4 = LoadSpec(4, values=((0, 1), (120, -1), (360, 1)), over="theta4")
OF_FOUR_BARS = DynamicsSpec(
    density=800.0,
    section=SectionSpec(0.05, 0.02),
    payload=1.0,
    speed_rpm=30,
    gravity=(0.5, -9.81),
    loads=(LoadSpec(4, at=(-0.7, 0.1), values=CARD), *ALIKE, OVER_THETA4),
    springs=(SpringSpec((Place(1, (0.2, 0.9)), Place(4, (0.3, 0.1))), 30.0, 0.4),),
    dampers=(DamperSpec((Place(2, (0.2, 0.9)), Place(4, (0.3, 0.1))), 4.0),),
    torsion_springs=(TorsionSpringSpec((3, 2), 2.0, 40.0), TorsionSpringSpec((1, 4), 1.0)),
    counterweights=(CounterweightSpec(2, 3.0, (-0.4, 0.1)),),
    friction=FrictionSpec(0.1, (0.01, 0.02, 0.01, 0.03), viscous=0.1, moment=(0, 0.1, 0, 0)),
)
SLIDE = {"slide_mu": 0.05, "slide_length": 0.5, "slide_viscous": 0.7, "slide_force": 0.3}
OF_SLIDERS = replace(
    OF_FOUR_BARS,
    loads=(
        LoadSpec(4, at=(-0.2, 0.1), values=((0, 0.3, -9), (120, 0.4, -20), (250, 0, -11), (360, 0.3, -9))),
        LoadSpec(4, at=(0.1, -0.3), values=TRAVEL, over="travel"),
        LoadSpec(4, at=(0.1, 0.2), force=(2.0, -1.0), frame="link"),
        LoadSpec(4, moment=0.9),
        *ALIKE,
    ),
    counterweights=(*OF_FOUR_BARS.counterweights, CounterweightSpec(4, 2.0, (0.1, 0.2))),
)
EVERYTHING = {
    FourBar: OF_FOUR_BARS,
    SliderCrank: replace(
        OF_SLIDERS,
        torsion_springs=(TorsionSpringSpec((3, 2), 2.0, 40.0), TorsionSpringSpec((3, 4), 1.0)),
        friction=FrictionSpec(0.1, (0.01, 0.02, 0.01, 0), viscous=0.1, moment=(0, 0.1, 0, 0), **SLIDE),
    ),
    InvertedSliderCrank: replace(
        OF_SLIDERS,
        loads=(*OF_SLIDERS.loads, OVER_THETA4),
        friction=FrictionSpec(0.1, (0.01, 0.02, 0, 0.03), viscous=0.1, moment=(0, 0.1, 0, 0), **SLIDE),
    ),
}


def _made(kind: type[Linkage], count: int, margin: float = 0.05) -> list[Linkage]:
    """Linkages of a kind whose drivers turn fully, of all sizes, turned and placed anywhere."""
    rng = np.random.default_rng(7 if kind is FourBar else 11)
    found: list[Linkage] = []
    while len(found) < count:
        one = _any(kind, rng)
        if _room(one) > margin:
            found.append(one)
    return found


def _any(kind: type[Linkage], rng: np.random.Generator) -> Linkage:
    if kind is FourBar:
        r2, r3, r4 = rng.uniform(0.2, 1.5), rng.uniform(0.5, 3), rng.uniform(0.5, 3)
        o2, o4 = rng.normal(size=2), rng.normal(size=2)
        return FourBar(o2, o4, r2, r3, r4, rng.normal(size=2), assembly=rng.choice([-1, 1]))
    o2, point, assembly = rng.normal(size=2), rng.normal(size=2), rng.choice([-1, 1])
    if kind is SliderCrank:
        r2, r3, offset = rng.uniform(0.2, 1.5), rng.uniform(0.5, 3), rng.normal() * 0.5
        return SliderCrank(o2, r2, r3, offset, rng.uniform(-4, 4), point, assembly)
    o4, r2, offset = rng.normal(size=2) * 1.5, rng.uniform(0.2, 3), rng.normal() * 0.3
    return InvertedSliderCrank(o2, o4, r2, offset, point, assembly)


def _room(linkage: Linkage) -> float:
    """How far the driver is from a dead position at the worst, in lengths."""
    if isinstance(linkage, FourBar):
        r1, r2, r3, r4 = linkage.lengths
        return float(min(r3 + r4 - 1.02 * (r1 + r2), abs(r1 - r2) - 1.02 * abs(r3 - r4)))
    if isinstance(linkage, SliderCrank):
        return float(linkage.r3 - linkage.r2 - np.abs(linkage.offset))
    assert isinstance(linkage, InvertedSliderCrank)
    return float(np.abs(linkage.r1 - linkage.r2) - np.abs(linkage.offset))


@pytest.fixture(scope="session")
def everything() -> dict[type[Linkage], DynamicsSpec]:
    """Everything that can act, by the kind of linkage."""
    return EVERYTHING


@pytest.fixture(scope="session")
def made() -> Callable[..., list[Linkage]]:
    """Some linkages: kind, count and least distance from a dead position."""
    return _made
