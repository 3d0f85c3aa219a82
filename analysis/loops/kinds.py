"""The first loop of a linkage by the kind of its dyad."""

from __future__ import annotations

from typing import Any

from grashof.analysis.loops.four_bar import FourBarLoop
from grashof.analysis.loops.inverted_slider_crank import InvertedLoop
from grashof.analysis.loops.loop import FirstLoop
from grashof.analysis.loops.slider_crank import SliderCrankLoop
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import DyadKind

_LOOPS: dict[DyadKind, FirstLoop[Any]] = {
    DyadKind.RRR: FourBarLoop(),
    DyadKind.RRP: SliderCrankLoop(),
    DyadKind.RPR: InvertedLoop(),
}


def first_loop(linkage: Linkage) -> FirstLoop[Any]:
    """What is known of the first loop of a linkage in closed form."""
    return _LOOPS[linkage.mechanism.dyads[0].kind]
