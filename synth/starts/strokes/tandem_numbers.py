"""The numbers by which the search for two swings would make a linkage, or one near it."""

from __future__ import annotations

from typing import cast

import numpy as np

from grashof.problems import Linkage, SixBar
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.dyad import Bars, as_complex, as_vector, root_or_zero
from grashof.synth.starts.strokes.tandem_search import TandemAim
from grashof.synth.starts.strokes.tandem_shapes import (
    ARMS,
    DRIVEN_BY_CRANK,
    SHARES,
    lags,
    limit_angles,
)


def numbers_of(linkage: Linkage, aim: TandemAim) -> tuple[tuple[int, int], FloatArray, BoolArray] | None:
    """Hosts, numbers in [0, 1] and signs, for the swings and limits of a problem; None of another linkage."""
    if len(linkage.mechanism.loops) == 1 or linkage.mechanism.slides:
        return None
    return _numbers_of_pins(cast("SixBar", linkage), aim)


def _numbers_of_pins(linkage: SixBar, aim: TandemAim) -> tuple[tuple[int, int], FloatArray, BoolArray] | None:
    """The same of a six-bar with pins alone."""
    if (hosts := linkage.mechanism.loops[1].dyad.hosts) not in aim.drives:
        return None
    o2, o4, d = (_complex(getattr(linkage, name)) for name in ("o2", "o4", "d"))
    first = np.array([[abs(o4 - o2), linkage.r2, linkage.r3, linkage.r4]])
    c, side = _complex(linkage.c), float(linkage.assembly)
    head = _crank_rocker(first, aim.swings.swings[0], aim.ratio_of(0, hosts))
    if hosts == DRIVEN_BY_CRANK:
        second = np.array([[abs(d - o2), abs(c), linkage.r5, linkage.r6]])
        tail = _crank_rocker(second, aim.swings.swings[1], aim.ratio_of(1, hosts))
        tail, other = [*tail, np.angle(c) / TURN % 1], float(linkage.assembly_2) > 0
    else:
        tail, other = _driven_by_4(linkage, first, c, d - o4, float(np.angle(o4 - o2)))
    numbers = np.array([*aim.places(o2, o4, d), *head, *tail], dtype=np.float64)
    return hosts, np.clip(np.nan_to_num(numbers, nan=0.5), 0, 1), np.array([side > 0, other])


def _complex(place: FloatArray) -> complex:
    return complex(*place)


def _crank_rocker(lengths: FloatArray, swing: float, ratio: float | None) -> list[float]:
    """Numbers of lag and share of a crank-rocker, lengths (1, 4)."""
    at = [np.arccos(np.clip(cosine, -1, 1)) for cosine in _cosines(lengths)]
    lag = float((at[1] - at[0])[0])
    low, high = lags(swing)
    number = (lag - low) / (high - low) if ratio is None else 0.25 if lag < 0 else 0.75
    return [number, (float(lengths[0, 1] / lengths[0, 2]) - SHARES[0]) / (SHARES[1] - SHARES[0])]


def _cosines(lengths: FloatArray) -> list[FloatArray]:
    """Of the angles at O2 between O2O4 and O2B, stretched and folded."""
    r1, r2, r3, r4 = lengths.T
    return [(r1**2 + far**2 - r4**2) / (2 * r1 * far) for far in (r3 + r2, r3 - r2)]


def _driven_by_4(
    linkage: SixBar, first: FloatArray, c: complex, ground: complex, theta1: float
) -> tuple[list[float], bool]:
    """Numbers of the second four-bar, and whether links 4 and 6 turn in one sense; O4D is the ground."""
    theta4 = theta1 + np.pi - float(linkage.assembly) * np.stack(limit_angles(first), axis=-1)[0]
    theta4.sort()
    arms: ComplexArray = c * np.exp(1j * theta4)
    pins = as_vector(np.full(2, ground)), as_vector(arms)
    bars = float(linkage.r5), float(linkage.r6), float(linkage.assembly_2)
    out = as_complex(Bars().closed(*pins, *bars, root_or_zero).across)
    turned = float(np.angle(out[1] * out[0].conj()))
    along = out[0] * np.exp(0.5j * turned)
    middle = c * np.exp(0.5j * theta4.sum())
    length = np.log(abs(c) / abs(ground) / ARMS[0]) / np.log(ARMS[1] / ARMS[0])
    angles = (float(np.angle(each / ground)) / TURN % 1 for each in (middle, along))
    return [float(length), *angles], turned > 0
