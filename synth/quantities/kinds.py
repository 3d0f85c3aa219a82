"""The kinds of linkage that the search knows."""

from __future__ import annotations

from collections.abc import Mapping

from grashof.problems import Problem
from grashof.synth.quantities.four_bar_kind import FourBarKind
from grashof.synth.quantities.inverted_kind import InvertedKind
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.slider_crank_kind import SliderCrankKind

FOUR_BAR: Kind = FourBarKind()
# By the word for it in files.
KINDS: Mapping[str, Kind] = {kind.mechanism: kind for kind in (FOUR_BAR, SliderCrankKind(), InvertedKind())}


def kind_of(problem: Problem) -> Kind:
    """The kind of linkage that a problem of one kind asks for."""
    return KINDS[problem.mechanism[0]]
