"""Linkages of every mechanism through planted points, poses and pairs, by one program for all."""

from typing import Any

import numpy as np
import pytest
from linkages_of_rows import SIX_BARS

from grashof.analysis import solve_position
from grashof.problems import FourBar, Linkage, Requirements, SixBar
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.quantities.kinds import FOUR_BAR
from grashof.synth.starts.closed_loop import SearchTargets
from grashof.synth.starts.loop_search import project
from grashof.synth.starts.six_bars.carried import Carried
from grashof.synth.starts.six_bars.chains import Shapes, draw, fitted, linkages

ONE_LOOP: dict[str, Linkage] = {
    "four-bar": FourBar((0, 0), (4, 0), 1, 4, 3, (2, 1)),
}
# P on the coupler of the second dyad: on a driver it would trace a circle, on a slider a line.
EVERY = ONE_LOOP | {name: SixBar(**one.stated | {"point_link": 5}) for name, one in SIX_BARS.items()}
# P is on the coupler of a loop with one pin on the ground and one on a link that turns about it.
FOUR_BAR_CURVES = "watt-2 on the driver", "watt-2 on the output", "press of a watt-2"
ROUND = np.linspace(0, 2 * np.pi, 3601)


def planted(name: str, count: int) -> tuple[Linkage, FloatArray]:
    rng = np.random.default_rng(count)
    gaps = rng.uniform(0.3, 1, count)
    return EVERY[name], 0.3 + 5 * np.cumsum(gaps) / gaps.sum()


def targets(count: int, **given: Any) -> SearchTargets:
    nothing = np.zeros(count)
    fields: dict[str, Any] = dict.fromkeys(("points", "weights", "turns", "turn_weights", "timing"), nothing)
    return SearchTargets(**fields | given, wanted=Requirements(), kind=FOUR_BAR, formulas={})


def found(name: str, target: SearchTargets, seed: int = 1) -> list[Linkage]:
    """Those of no error to speak of."""
    shapes = Shapes(EVERY[name].mechanism)
    batch, error = fitted(target, shapes, draw(target, shapes, 3000, np.random.default_rng(seed)), 6)
    batch = batch[error < 1e-18]
    nowhere = np.tile([0j, 1, 0], (len(batch), 1))
    z = project(target, Carried(target, shapes, batch))[0] if target.weights.any() else nowhere
    return linkages(target, shapes, batch, z)


def p_of(linkage: Linkage, theta2: FloatArray) -> ComplexArray:
    xy = solve_position(linkage, theta2, int(linkage.assembly)).p
    return np.asarray(xy[..., 0] + 1j * xy[..., 1])


@pytest.mark.quick("press of a watt-2")
@pytest.mark.parametrize("name", EVERY)
def test_nine_planted_points(name: str) -> None:
    """Some turn fully, and the judge follows the full curve through every point."""
    count = 5 if name in ONE_LOOP else 6 if name in FOUR_BAR_CURVES else 9
    linkage, theta2 = planted(name, count)
    p = p_of(linkage, theta2)
    every = found(name, targets(count, points=p - p.mean(), weights=np.ones(count)))
    made = [one for one in every if np.isfinite(p_of(one, ROUND)).all()]
    assert made
    for one in made:
        assert one.mechanism == linkage.mechanism
        curve = p_of(one, ROUND)
        for point in p - p.mean():
            off = np.abs(curve - point)
            near = np.flatnonzero((off <= np.roll(off, 1)) & (off <= np.roll(off, -1)))
            angles = ROUND[near[np.argsort(off[near])[:4]]]
            for window in (2e-3, 4e-6):
                angles = (angles[:, None] + window * np.linspace(-1, 1, 1001)).ravel()
                off = np.abs(p_of(one, angles) - point)
                angles = angles[np.argsort(off)[:1]]
            assert off.min() < 1e-6


def test_poses_of_a_six_bar() -> None:
    name, count = "watt-1 on coupler and output", 5
    linkage, theta2 = planted(name, count)
    p, carries = p_of(linkage, theta2), linkage.mechanism.carries
    turns = np.asarray(getattr(solve_position(linkage, theta2, int(linkage.assembly)), f"theta{carries}"))
    target = targets(
        count, points=p - p.mean(), weights=np.ones(count), turns=turns, turn_weights=np.ones(count)
    )
    made = [one for one in found(name, target) if np.isfinite(p_of(one, ROUND)).all()]
    assert made
    for one in made:
        curve, state = p_of(one, ROUND), solve_position(one, ROUND, int(one.assembly))
        body = np.asarray(getattr(state, f"theta{carries}")) + float(one.body_angle)
        for point, turn in zip(p - p.mean(), turns, strict=True):
            off = np.hypot(np.abs(curve - point), np.abs(np.exp(1j * body) - np.exp(1j * turn)))
            assert off.min() < 5e-3


def test_a_function_of_a_six_bar() -> None:
    name, count = "watt-2 on the output", 8
    linkage, theta2 = planted(name, count)
    theta6 = np.unwrap(np.asarray(solve_position(linkage, theta2, int(linkage.assembly)).theta6))
    turned, outputs = theta2 - theta2[0], theta6 - theta6[0]
    made = found(name, targets(count, timing=turned, outputs=outputs))
    assert made
    for one in made:
        least = np.inf
        for start in ROUND[::18]:
            for sense in (1, -1):
                state = solve_position(one, start + sense * turned, int(one.assembly))
                off = sense * np.unwrap(np.asarray(state.theta6)) - outputs
                least = min(least, float(np.ptp(off)))
        assert least < 0.05
