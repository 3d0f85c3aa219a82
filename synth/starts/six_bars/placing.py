"""Places of linkages whose task leaves them free: by limits of lengths, size, pivots and angles."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from grashof.problems import Box, Requirements
from grashof.problems.values.arrays import ComplexArray
from grashof.problems.values.box import ANYWHERE
from grashof.synth.quantities.regions import into


def place_of(
    wanted: Requirements,
    lengths: Mapping[str, float],
    reached: ComplexArray,
    usual: float,
    scale: float | None = None,
) -> tuple[float, complex, complex]:
    """Length and direction of the ground, and O2, of a linkage that is known with r1 = 1.

    By the lengths of its links and the places that its joints reach; the length of the ground is `scale`, or
    near the `usual` one where that is None.
    """
    boxes = [None if box == ANYWHERE else box for box in (wanted.o2, wanted.o4)]
    first, second = (0j if box is None else _inside(box, 0j) for box in boxes)
    turned = wanted.angle_of("ground_angle_deg")
    if turned is None and None not in boxes and first != second:
        turned = float(np.angle(second - first))
        usual = abs(second - first)
    if scale is None:
        low, high = _scales(wanted, lengths, reached)
        scale = float(np.clip(usual, low, max(low, high)))
    turn = complex(np.exp(1j * (turned or 0.0)))
    if boxes[1] is None:
        return scale, turn, first
    o2 = _inside(boxes[1], first + scale * turn) - scale * turn
    return scale, turn, o2 if boxes[0] is None else _inside(boxes[0], o2)


def _scales(wanted: Requirements, lengths: Mapping[str, float], reached: ComplexArray) -> tuple[float, float]:
    """Least and greatest length of the ground by the limits of lengths and size."""
    limits = [(getattr(wanted, name) or wanted.link_length, length) for name, length in lengths.items()]
    limits.append((wanted.size, float(np.hypot(np.ptp(reached.real), np.ptp(reached.imag)))))
    low, high = 0.0, np.inf
    for limit, length in limits:
        if limit is not None:
            low, high = max(low, limit[0] / length), min(high, limit[1] / length)
    return low, high


def _inside(box: Box, near: complex) -> complex:
    """The middle of a box; for a region the place nearest to it.

    Along an axis on which a box is open, the place in it nearest to another.
    """
    places = []
    for (low, high), at in zip((box.x, box.y), (near.real, near.imag), strict=True):
        places.append((low + high) / 2 if np.isfinite(high - low) else min(max(at, low), high))
    return complex(into(box, np.array(complex(*places))))
