"""Chains of the search are where the judge has them, and their slopes are differences."""

from typing import Any

import numpy as np
import pytest
from linkages_of_rows import SIX_BARS

from grashof.analysis import solve_position
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank
from grashof.synth.loop.chain import chained
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.vector import Vector

ONE_LOOP: dict[str, Linkage] = {
    "four-bar": FourBar((0, 0), (4, 0), 1, 4, 3, (2, 1)),
    "slider-crank": SliderCrank((0, 0), 1, 4, offset=0.5, slide_angle=0.3, coupler_point=(2, 1)),
    "inverted slider-crank": InvertedSliderCrank((0, 0), (4, 0), 1, offset=0.3, coupler_point=(2, 1)),
}
EVERY = ONE_LOOP | SIX_BARS


def given_of(linkage: Linkage) -> dict[str, Any]:
    """Arguments of `chained`."""
    values = {row.name: np.asarray(getattr(linkage, row.name)) for row in linkage.mechanism.parameters}
    return {name: Vector(*value) if value.shape == (2,) else value for name, value in values.items()}


def assemblies_of(linkage: Linkage) -> list[float]:
    return [float(getattr(linkage, loop.assembly)) for loop in linkage.mechanism.loops]


@pytest.mark.parametrize("name", EVERY)
def test_p_lies_where_the_judge_has_it(name: str) -> None:
    linkage = EVERY[name]
    theta2 = np.linspace(0, 6, 17)
    driver = Vector(np.cos(theta2), np.sin(theta2))
    chain = chained(linkage.mechanism, given_of(linkage), driver, assemblies_of(linkage))
    u, v = np.asarray(linkage.coupler_point)
    p = chain.frames[linkage.mechanism.carries].point(Vector(u, v))
    state = solve_position(linkage, theta2, int(linkage.assembly))
    np.testing.assert_allclose(np.stack([p.x, p.y], axis=-1), state.p, atol=1e-12)
    assert all((square > 0).all() for square in chain.squares)


@pytest.mark.parametrize("name", SIX_BARS)
def test_slopes_are_differences(name: str) -> None:
    linkage, step = EVERY[name], 1e-6
    row = linkage.mechanism

    def p_of(given: dict[str, Any]) -> Vector:
        chain = chained(row, given, Vector(np.cos(1.1), np.sin(1.1)), assemblies_of(linkage))
        placed: Vector = chain.frames[row.carries].point(given["coupler_point"])
        return placed

    for changed in ("r2", "r3", "r5"):
        given = given_of(linkage)
        if changed not in given:
            continue
        ahead, behind = (p_of(given | {changed: given[changed] + way * step}) for way in (1, -1))
        dual = Dual(np.array([[float(given[changed])]]), np.ones((1, 1, 1)))
        p = p_of(given | {changed: dual})
        for axis in "xy":
            slope = (getattr(ahead, axis) - getattr(behind, axis)) / (2 * step)
            value = getattr(p, axis)
            found = value.slope[0, 0, 0] if isinstance(value, Dual) else 0.0
            assert found == pytest.approx(slope, abs=1e-7)
