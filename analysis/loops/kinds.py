"""The kinds of linkages by their types."""

from __future__ import annotations

from typing import Any

from grashof.analysis.loops.four_bar import FourBarKind
from grashof.analysis.loops.inverted_slider_crank import InvertedSliderCrankKind
from grashof.analysis.loops.loop import Kind
from grashof.analysis.loops.slider_crank import SliderCrankKind
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.four_bar import FourBar
from grashof.problems.values.linkages.inverted_slider_crank import InvertedSliderCrank
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.slider_crank import SliderCrank

_KINDS: dict[type[Linkage], Kind[Any]] = {
    FourBar: FourBarKind(),
    SliderCrank: SliderCrankKind(),
    InvertedSliderCrank: InvertedSliderCrankKind(),
}


def kind_of(linkage: Linkage) -> Kind[Any]:
    """How the loop of a linkage closes."""
    return _KINDS[type(linkage)]


def way_to(linkage: Linkage, link: int) -> tuple[FloatArray, tuple[tuple[int, FloatArray], ...]]:
    """A ground pivot, and the links from it on to the origin of a link's frame, with their lengths."""
    if link == 4:
        return kind_of(linkage).way_to_4(linkage)
    return linkage.o2, ((2, linkage.r2),) if link == 3 else ()
