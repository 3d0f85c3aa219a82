"""How the links of many linkages move with their dimensions and driver angles: implicit derivatives.

The derivative of a dyad's closure gives the turns of its links from the moves of C and D, as
`grashof.synth.loop.dyad` has it: (moved . across) / lever.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanism import LoopNames, Mechanism
from grashof.synth.loop.chain import Frame
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.dyad import as_complex
from grashof.synth.loop.vector import Vector


class Move(NamedTuple):
    """The frame of a link, (n, N), and its derivatives by K columns, (n, N, K)."""

    origin: ComplexArray
    along: ComplexArray
    by_origin: ComplexArray
    by_turn: FloatArray  # of its angle

    def by_point(self, arm: ComplexArray, by_arm: ComplexArray) -> ComplexArray:
        """Derivatives of a point of the link, whose place on it is (n, 1) with derivatives (n, 1, K)."""
        turned = (1j * arm * self.along)[..., None] * self.by_turn
        found: ComplexArray = self.by_origin + turned + by_arm * self.along[..., None]
        return found

    @property
    def by_along(self) -> ComplexArray:
        """Derivatives of the direction."""
        found: ComplexArray = (1j * self.along)[..., None] * self.by_turn
        return found


def moves(mechanism: Mechanism, frames: Mapping[int, Frame], given: Mapping[str, Any]) -> dict[int, Move]:
    """The moves of all links by the columns of the dimensions `given`; the last is the driver angle."""
    driver = as_complex(frames[2].along)
    columns = given["r2"].slope.shape[2]
    still = np.zeros((*driver.shape, columns))
    turning = still.copy()
    turning[..., -1] = 1
    found = {
        1: Move(np.zeros_like(driver), np.ones_like(driver), still * 0j, still),
        2: Move(np.zeros_like(driver), driver, still * 0j, turning),
    }
    for loop in mechanism.loops:
        links = [frames[link] for link in loop.links]
        frame = [(as_complex(each.origin), as_complex(each.along)) for each in links]
        by_c = _by_joint(loop.c, loop.dyad.hosts[0], found, given)
        if loop.pinned:
            by_d = _by_joint(loop.d, loop.dyad.hosts[1], found, given)
            of_both = _pinned(loop, frame, by_c, by_d, given)
        else:
            of_both = _sliding(loop, frame, by_c, given)
        found |= zip(loop.links, of_both, strict=True)
    return found


def _by_joint(name: str, host: int, found: Mapping[int, Move], given: Mapping[str, Any]) -> ComplexArray:
    """Derivatives of C or D of a dyad."""
    return found[host].by_point(*number(given["r2"] if name == "a" else given[name]))


def _pinned(
    loop: LoopNames,
    frame: list[tuple[ComplexArray, ComplexArray]],
    by_c: ComplexArray,
    by_d: ComplexArray,
    given: Mapping[str, Any],
) -> tuple[Move, Move]:
    """Bars m from C and n from D to E: each keeps its length."""
    (c, along), (d, across) = frame
    (m, by_m), (n, by_n) = (number(given[name]) for name in loop.bars)
    apart = by_c - by_d
    sine = (along.conj() * across).imag[..., None]
    first = by_n.real - _dot(across, apart + by_m * along[..., None])
    second = _dot(along, by_n * across[..., None] - apart) - by_m.real
    return (
        Move(c, along, by_c, first / (m.real[..., None] * sine)),
        Move(d, across, by_d, second / (n.real[..., None] * sine)),
    )


def _sliding(
    loop: LoopNames,
    frame: list[tuple[ComplexArray, ComplexArray]],
    by_c: ComplexArray,
    given: Mapping[str, Any],
) -> tuple[Move, Move]:
    """A bar m from C to E on a line of the ground: E stays on it."""
    (c, along), (e, slide) = frame
    (m, by_m), (_, by_offset), (_, by_angle) = (
        number(given[name]) for name in (*loop.bars, loop.offset, loop.slide_angle)
    )
    normal, turn = 1j * slide, np.broadcast_to(by_angle.real, by_c.shape)
    moved = by_c + by_m * along[..., None]
    # E . normal is the offset, and the normal turns with the slide
    rest = by_offset.real - _dot(normal, moved) + _dot(slide, e[..., None]) * turn
    first = rest / (m.real * _dot(normal, 1j * along[..., None])[..., 0])[..., None]
    bar = Move(c, along, by_c, first)
    return bar, Move(e, slide, bar.by_point(m, by_m), turn)


def _dot(one: ComplexArray, other: ComplexArray) -> FloatArray:
    """Scalar products of vectors (n, N) with others (n, N, K)."""
    found: FloatArray = one.real[..., None] * other.real + one.imag[..., None] * other.imag
    return found


def number(each: Any) -> tuple[Any, Any]:
    """A dimension as complex numbers (n, 1), and their derivatives (n, 1, K); a place counts as x + i y."""
    if isinstance(each, Vector):
        (x, by_x), (y, by_y) = number(each.x), number(each.y)
        return np.asarray(x + 1j * y), np.asarray(by_x + 1j * by_y)
    if isinstance(each, Dual):
        return each.value + 0j, each.slope + 0j
    return np.full((1, 1), complex(each)), np.zeros((1, 1, 1), dtype=np.complex128)
