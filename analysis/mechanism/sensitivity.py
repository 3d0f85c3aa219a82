"""Derivatives of positions and angles by the dimensions of a linkage, at fixed driver angles."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.closing import LinkPoint, Loop, closed_at, coupler_point
from grashof.analysis.mechanism.dyad import Vector
from grashof.problems import Linkage
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanism import LoopNames


def sensitivity(linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None) -> FloatArray:
    """Derivatives of the coupler's position by the dimensions, at fixed driver angles.

    Parameters
    ----------
    linkage, theta2, assembly
        As for `solve_position`.

    Returns
    -------
    ndarray, shape (..., 3, D), length/length and rad/length
        Rows: x and y of P, the angle of the link that carries it. Columns: the dimensions of the mechanism,
        of a four-bar r1, r2, r3, r4, u, v. NaN where the linkage cannot close, unbounded near a dead
        position.

    Examples
    --------
    A square, P at B: a longer output link lifts P by as much, and turns the coupler.

    >>> from grashof.problems import FourBar
    >>> square = FourBar(o2=(0, 0), o4=(2, 0), r2=2, r3=2, r4=2, coupler_point=(2, 0), assembly=1)
    >>> (sensitivity(square, np.pi / 2)[:, 3] + 0.0).round(9).tolist()
    [0.0, 1.0, 0.5]
    """
    varied = _Varied(linkage, theta2, assembly)
    carries, at = linkage.mechanism.carries, coupler_point(linkage, varied.frames)
    turn = varied.turns[carries]
    moved = varied.add(varied.moved(at, carries), varied.along(carries, "u", "v"))
    return np.moveaxis(np.stack([moved.real, moved.imag, turn]), (0, 1), (-2, -1))


def turn_sensitivity(linkage: Linkage, theta2: npt.ArrayLike, link: int) -> FloatArray:
    """Derivatives of the angle of a moving link by the dimensions, shape (..., D), rad/length."""
    return np.moveaxis(_Varied(linkage, theta2).turns[link], 0, -1)


class _Varied:
    """Turns and displacements of the links by each dimension, in some positions; arrays of shape (D, ...).

    The varied equations of each loop give the turns: J dq = dw less the derivatives of the gap by its
    lengths.
    """

    def __init__(
        self, linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
    ) -> None:
        self.linkage, self.names = linkage, linkage.mechanism.dimensions
        loops, self.frames = closed_at(linkage, theta2, assembly)
        shape = np.shape(loops[-1].closed.margin)
        self.turns: dict[int, FloatArray] = {2: np.zeros((len(self.names), *shape))}
        self.origins: dict[int, ComplexArray] = {2: np.zeros((len(self.names), *shape), dtype=complex)}
        for names, loop in zip(linkage.mechanism.loops, loops, strict=True):
            self._vary(names, loop)

    def add(self, moved: ComplexArray, by: dict[str, ComplexArray]) -> ComplexArray:
        """Add further displacements by some dimensions, in place."""
        for name, value in by.items():
            moved[self.names.index(name)] += value
        return moved

    def along(self, link: int, *names: str) -> dict[str, ComplexArray]:
        """Displacements of a point of a link by its coordinates along and across the link."""
        unit = np.ones((), dtype=complex) if link == 1 else _complex(self.frames[link][:2])
        return dict(zip(names, (unit, np.asarray(1j * unit)), strict=False))

    def moved(self, at: LinkPoint, link: int) -> ComplexArray:
        """Displacements of a point with the link that carries it; zero on the ground."""
        if link == 1:
            return np.zeros(self.origins[2].shape, dtype=complex)
        _, arm = at.arms[-1]
        carried: ComplexArray = 1j * _complex(arm) * self.turns[link]
        return self.origins[link] + carried

    def _vary(self, names: LoopNames, loop: Loop) -> None:
        sizes, closed, (first, second) = loop.dyad.sizes, loop.closed, names.links
        c, d = (self.moved(at, host) for at, host in zip((loop.c, loop.d), names.dyad.hosts, strict=True))
        c_by, d_by = self._own(names)
        c, d = self.add(c, c_by), self.add(d, d_by)
        named = dict(zip("mn", names.bars, strict=False)) | {"offset": names.offset}
        gap = self.add(d - c, {named[name]: _complex(by) for name, by in sizes.sizes(closed).items()})
        with np.errstate(divide="ignore", invalid="ignore"):
            one, other = ((gap * _complex(each).conj()).real for each in sizes.facing(closed))
            three, four, _ = sizes.solve(closed, (one, other), 1 / closed.margin, 1.0)
        self.turns |= {first: three, second: four + np.zeros(gap.shape)}
        self.origins |= {first: c, second: d}
        if not names.pinned:
            e3 = _complex((closed.cos3, closed.sin3))
            carried = 1j * closed.reach * e3 * three
            self.origins[second] = self.add(c + carried, {names.bars[0]: e3})

    def _own(self, names: LoopNames) -> tuple[dict[str, ComplexArray], dict[str, ComplexArray]]:
        """Displacements of C and D by their coordinates on their links."""
        (on_c, on_d), first = names.dyad.hosts, names.links[0] == 3
        c = self.along(2, "r2") if first else self.along(on_c, f"{names.c}_u", f"{names.c}_v")
        if not names.pinned:
            return c, {}
        ground = {"r1": np.exp(1j * self.linkage.theta1)}
        return c, ground if first else self.along(on_d, f"{names.d}_u", f"{names.d}_v")


def _complex(vector: Vector) -> ComplexArray:
    return np.asarray(vector[0] + 1j * vector[1])
