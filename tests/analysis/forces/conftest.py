"""Shared by the tests of forces: everything that can act, and linkages that it acts on."""

from collections.abc import Callable

import numpy as np
import pytest

from grashof.problems import DynamicsSpec, FourBar
from grashof.problems.values.acting import (
    CounterweightSpec,
    DamperSpec,
    FrictionSpec,
    LoadSpec,
    Place,
    SpringSpec,
    TorsionSpringSpec,
)
from grashof.problems.values.section import SectionSpec

CARD = ((0, 0.3, -9), (90, 0.4, -20), (180, -0.1, -20), (250, 0, -11), (360, 0.3, -9))
EVERYTHING = DynamicsSpec(
    density=800.0,
    section=SectionSpec(0.05, 0.02),
    payload=1.0,
    speed_rpm=30,
    gravity=(0.5, -9.81),
    loads=(
        LoadSpec(4, at=(-0.7, 0.1), values=CARD),
        LoadSpec(3, at=(0.2, 0.3), force=(1.0, 2.0), frame="link"),
        LoadSpec(2, moment=-0.7),
        LoadSpec(4, values=((0, 1), (120, -1), (360, 1)), over="theta4"),
        LoadSpec(3, at=(0.1, 0), values=((0, 1, 2), (1, -1, 0), (5, 2, 2)), over="time"),
    ),
    springs=(SpringSpec((Place(1, (0.2, 0.9)), Place(4, (0.3, 0.1))), 30.0, 0.4),),
    dampers=(DamperSpec((Place(2, (0.2, 0.9)), Place(4, (0.3, 0.1))), 4.0),),
    torsion_springs=(TorsionSpringSpec((3, 2), 2.0, 40.0), TorsionSpringSpec((1, 4), 1.0)),
    counterweights=(CounterweightSpec(2, 3.0, (-0.4, 0.1)),),
    friction=FrictionSpec(0.1, (0.01, 0.02, 0.01, 0.03), viscous=0.1, moment=(0, 0.1, 0, 0)),
)


@pytest.fixture(scope="session")
def everything() -> DynamicsSpec:
    return EVERYTHING


@pytest.fixture(scope="session")
def linkages() -> Callable[[int], list[FourBar]]:
    return crank_rockers


def crank_rockers(count: int) -> list[FourBar]:
    """Crank-rockers of all sizes, turned and placed anywhere."""
    rng, found = np.random.default_rng(7), []
    while len(found) < count:
        r2, r3, r4 = rng.uniform(0.2, 1.5), rng.uniform(0.5, 3), rng.uniform(0.5, 3)
        o2, o4 = rng.normal(size=2), rng.normal(size=2)
        made = FourBar(o2, o4, r2, r3, r4, rng.normal(size=2), assembly=rng.choice([-1, 1]))
        r1 = float(made.r1)
        if r3 + r4 > 1.02 * (r1 + r2) and abs(r1 - r2) > 1.02 * abs(r3 - r4) + 0.01:
            found.append(made)
    return found
