"""Function generators that may lie anywhere: their place counts where limits of places do.

The shape has four more numbers, behind the links: O2, the logarithm of the unit of the lengths, and the
direction of the ground line or the slide, rad; O2 and the unit in the usual unit of the problem.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, ClassVar, Self

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.loop.dyad import Closed
from grashof.synth.loop.vector import Vector
from grashof.synth.theory.functions.four_bar import CouplerFourBars, FourBars
from grashof.synth.theory.functions.inverted import InvertedSliderCranks
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.slider_crank import SliderCranks

NUMBERS = 4


class Placed(Generators):
    """Generators of a kind, `anywhere`, with the place of each."""

    __slots__ = ()

    anywhere: ClassVar[type[Generators]]

    def __init_subclass__(cls) -> None:
        """The place adds unknowns, which no pair depends on."""
        super().__init_subclass__()
        first = cls.anywhere.UNKNOWNS - 1
        cls.UNKNOWNS, cls.PLACE = first + NUMBERS + 1, slice(first, first + NUMBERS)

    @classmethod
    def of(cls, batch: Generators, places: FloatArray) -> Self:
        """Generators (M,) with a place each, or one for all, (M, 4) or (4,)."""
        place = np.broadcast_to(places, (len(batch), NUMBERS))
        return cls(np.column_stack([batch.shape[:, :-1], place, batch.shape[:, -1]]), batch.assembly)

    @property
    def own_shape(self) -> FloatArray:
        return np.delete(self.shape, self.PLACE, axis=1)

    @classmethod
    def sizes_of(cls, shape: Sequence[Any]) -> tuple[Any, Any, Any, Any]:
        return cls.anywhere.sizes_of([*shape[: cls.PLACE.start], shape[-1]])

    def moves(self, crank: Vector, loop: Closed) -> list[Vector]:
        *links, first = self.anywhere.moves(self, crank, loop)
        return [*links, *NUMBERS * [Vector(0.0, 0.0)], first]


class PlacedFourBars(Placed, FourBars):
    """Four-bars with their places."""

    __slots__ = ()
    anywhere = FourBars


class PlacedCouplerFourBars(Placed, CouplerFourBars):
    """Four-bars whose coupler follows the function, with their places."""

    __slots__ = ()
    anywhere = CouplerFourBars

    @property
    def itself(self) -> FourBars:
        return CouplerFourBars(self.own_shape, self.assembly).itself


class PlacedSliderCranks(Placed, SliderCranks):
    """Slider-cranks with their places."""

    __slots__ = ()
    anywhere = SliderCranks


class PlacedInvertedSliderCranks(Placed, InvertedSliderCranks):
    """Inverted slider-cranks with their places."""

    __slots__ = ()
    anywhere = InvertedSliderCranks


PLACED: Mapping[type[Generators], type[Placed]] = MappingProxyType(
    {
        each.anywhere: each
        for each in (PlacedFourBars, PlacedCouplerFourBars, PlacedSliderCranks, PlacedInvertedSliderCranks)
    }
)
