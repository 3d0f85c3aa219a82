"""Dwell linkages of the batched search, closed again by circles and lines round the turn."""

import numpy as np
import pytest

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanism import DyadKind
from grashof.synth.loop.feasible import Demand
from grashof.synth.starts.six_bars.dwell_search import DwellAim, DwellLinkages, drawn, fitted, linkages

TURN = 2 * np.pi


def _apex(c: ComplexArray, d: ComplexArray, m: FloatArray, n: FloatArray, side: FloatArray) -> ComplexArray:
    """The point m from C and n from D, on the left of C-D where the side is +1."""
    way = d - c
    angle = np.arccos((m**2 + np.abs(way) ** 2 - n**2) / (2 * m * np.abs(way)))
    return c + m * way / np.abs(way) * np.exp(1j * side * angle)


def _closed(
    found: DwellLinkages, k: int, theta2: FloatArray, slides: bool
) -> tuple[ComplexArray, FloatArray]:
    """D-E, or the way of E along the slide, and the least sine of both transmission angles."""
    r2, r3, r4, c, d, r5, r6 = (getattr(found, name)[k] for name in ("r2", "r3", "r4", "c", "d", "r5", "r6"))
    a = r2 * np.exp(1j * theta2)
    b = _apex(a, 1.0, r3, r4, found.side[k])
    at_c = a + c * (b - a) / r3
    sine = np.abs(((b - a).conj() * (b - 1)).imag) / (r3 * r4)
    if slides:
        height = r6 - (at_c * d.conj()).real
        ahead = np.sqrt(r5**2 - height**2)
        along = -1j * d
        travel = (at_c * along.conj()).real + found.side_2[k] * ahead
        return travel + 0j, np.minimum(sine, ahead / r5)
    e = _apex(at_c, d, r5, r6, found.side_2[k])
    return e - d, np.minimum(sine, np.abs(((e - at_c).conj() * (e - d)).imag) / (r5 * r6))


@pytest.mark.slow
@pytest.mark.parametrize(  # `scripts/benchmarks/dwells.py` has others
    "case",
    [
        (
            90,
            45,
            40,
            10,
            0.008,
        ),  # dwell, swing, mu, deg; link ratio; band of the best
        (90, 0, 40, 10, 2e-4),  # of a slide, as a share of its stroke
    ],
)
def test_dwells_and_their_bands(case: tuple[float, ...]) -> None:
    dwell, swing, mu, ratio, band = case
    slides = not swing
    kind = DyadKind.RRP if slides else DyadKind.RRR
    aim = DwellAim(kind, np.radians(dwell), np.radians(swing), Demand.turning(np.radians(mu), 1e-3), ratio)
    batch = fitted(aim, drawn(aim, np.random.default_rng(0)), 2e-4)
    found, _ = linkages(aim, batch, 720)
    assert len(batch) >= 20
    assert (found.ratios(kind) <= ratio).all()
    bands = []
    for k in range(len(batch)):
        turn, sine = _closed(found, k, np.arange(3600) * TURN / 3600, slides)
        still, _ = _closed(found, k, batch.unknowns[k, 5] + np.linspace(0, aim.dwell, 1001), slides)
        assert sine.min() >= np.sin(np.radians(mu)) - 1e-3
        if slides:
            bands.append(np.ptp(still.real) / np.ptp(turn.real))
            continue
        bands.append(np.degrees(np.ptp(np.angle(still / still[500]))))
        assert np.degrees(np.ptp(np.unwrap(np.angle(turn)))) == pytest.approx(swing, abs=0.01)
    assert min(bands) <= band
