"""Optima of function generators against published and measured ones."""

import numpy as np
import pytest

from grashof.synth.theory.functions.fit import DesiredOutput
from grashof.synth.theory.functions.four_bar import FourBars
from grashof.synth.theory.functions.inverted import InvertedSliderCranks
from grashof.synth.theory.functions.limits import ShapeLimits
from grashof.synth.theory.functions.optima import Aim, refined
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.slider_crank import SliderCranks


@pytest.mark.parametrize("greatest", [False, True])
@pytest.mark.parametrize(
    ("start", "lengths"),
    [
        (SliderCranks(np.array([[0.0, np.log(2.0), 0.5, -np.pi / 2]]), np.array([1.0])), 3),
        (InvertedSliderCranks(np.array([[np.log(0.5), 0.5, 0.0]]), np.array([1.0])), 2),
    ],
    ids=["offset + r2 = r3", "r1 - r2 = offset"],
)
def test_a_start_in_a_dead_position_ends_well(start: Generators, lengths: int, greatest: bool) -> None:
    """Its output has no rate there, or an enormous one: it is left as it is, or improved."""
    turned = np.linspace(0.0, 1.0, 8)
    wanted = DesiredOutput(turned, 0.9 * start.outputs(turned)[0], np.ones(8))
    limits = ShapeLimits(1.0, caps=np.full((lengths, lengths), 5.0))
    aim = Aim(wanted, limits, greatest=greatest)
    slopes = start.slopes(turned)[0, 0]
    assert not np.abs(slopes).max() < 1e12
    found = refined(aim, start)
    assert np.isfinite(found.error).all()
    assert aim.scores(found.generators)[0] <= aim.scores(start)[0]
    if np.isnan(slopes).any():
        assert found.steps == 0
        assert found.missed > 0


@pytest.mark.parametrize("greatest", [False, True])
def test_optima_do_not_depend_on_those_beside_them(greatest: bool) -> None:
    """Each with samples and a transmission angle of its own, as alone; some of them miss their limits."""
    rng, turned = np.random.default_rng(4), np.linspace(0.0, 1.2, 21)
    starts = FourBars(rng.normal(0, 0.4, (40, 4)), rng.choice([-1.0, 1.0], 40))
    starts = starts[starts.worst_cosine(1.2) < 0.99]
    every = np.arange(len(starts))
    ways = np.where(every % 2, 1.0, -1.0)[:, None]
    desired = DesiredOutput(turned, ways * np.sin(turned), np.ones(21))
    limits = ShapeLimits(1.2, transmission=np.radians(np.where(every % 3, 20.0, 60.0)))
    aim = Aim(desired, limits, greatest=greatest)
    together = refined(aim, starts, 40)
    for k in every[:4]:
        alone = refined(aim.some(every[k : k + 1]), starts[k : k + 1], 40)
        assert alone.worth == pytest.approx(together.worth[k], rel=1e-6)
    assert 0 < (together.missed > 0).sum() < len(starts)
