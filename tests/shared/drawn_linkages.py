"""Linkages of every class for Hypothesis, tests with some of each, and positions by the law of cosines."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank

_SHORTEST_IN = {
    GrashofClass.DOUBLE_CRANK: 0,
    GrashofClass.CRANK_ROCKER: 1,
    GrashofClass.DOUBLE_ROCKER: 2,
    GrashofClass.ROCKER_CRANK: 3,
}
# Four-bars away from change points, and those of them whose drivers swing.
SMOOTH = tuple(kind for kind in FOUR_BAR_CLASSES if kind is not GrashofClass.CHANGE_POINT)
SWINGING = (GrashofClass.DOUBLE_ROCKER, GrashofClass.ROCKER_CRANK, GrashofClass.NON_GRASHOF)


def of_each_class(
    *kinds: GrashofClass, examples: int = 6, **others: st.SearchStrategy[Any]
) -> Callable[[Callable[..., None]], Any]:
    """Run a test with drawn linkages of each class; it may take `linkage`, `kind`, `data` and `others`."""

    def decorated(test: Callable[..., None]) -> Any:
        taken = inspect.signature(test).parameters

        def drawn(kind: GrashofClass, data: st.DataObject) -> None:
            offered = {"linkage": data.draw(linkages(kind)), "kind": kind, "data": data}
            offered |= {name: data.draw(strategy) for name, strategy in others.items()}
            test(**{name: offered[name] for name in taken})

        for name in ("__name__", "__qualname__", "__module__", "__doc__"):
            setattr(drawn, name, getattr(test, name))
        each = settings(max_examples=examples)(given(data=st.data())(drawn))
        return pytest.mark.parametrize("kind", kinds)(each)

    return decorated


def linkages(kind: GrashofClass) -> st.SearchStrategy[Linkage]:
    """Linkages of a class of any kind, well away from change points unless these are requested."""
    return _SLIDING[kind](kind) if kind in _SLIDING else four_bars(kind)


def close_loop(
    linkage: FourBar, theta2: npt.ArrayLike, assembly: float
) -> tuple[npt.NDArray[np.complex128], ...]:
    """A, B and P as complex numbers, by the law of cosines; B is NaN where the loop cannot close."""
    a = complex(*linkage.o2) + linkage.r2 * np.exp(1j * np.asarray(theta2))
    diagonal = complex(*linkage.o4) - a
    length = np.abs(diagonal)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # A may stand on O4
        cosine = (length**2 + linkage.r3**2 - linkage.r4**2) / (2 * length * linkage.r3)
        cosine = np.where(np.abs(cosine) <= 1 + 1e-14, np.clip(cosine, -1, 1), np.nan)
        coupler = diagonal / length * np.exp(1j * assembly * np.arccos(cosine))
    return a, a + linkage.r3 * coupler, a + complex(*linkage.coupler_point) * coupler


@st.composite
def four_bars(draw: st.DrawFn, kind: GrashofClass) -> FourBar:
    lengths = draw(_lengths(kind))
    scale, theta1, o2, rest = _anywhere(draw)
    r1, r2, r3, r4 = scale * np.array(lengths)
    return FourBar(o2, o2 + r1 * _towards(theta1), r2, r3, r4, **rest)


@st.composite
def _lengths(draw: st.DrawFn, kind: GrashofClass) -> list[float]:
    """r1 to r4 with shortest link 1: its place and the longest length make the class."""
    middle = [draw(st.integers(11, 32)) / 8, draw(st.integers(11, 32)) / 8]
    balance = sum(middle) - 1
    if kind is GrashofClass.CHANGE_POINT:
        return draw(st.permutations([1.0, *middle, balance]))
    share = draw(st.floats(0.1, 0.9))
    if kind is GrashofClass.NON_GRASHOF:
        return draw(st.permutations([1.0, *middle, balance + 2 * share]))
    longest = max(middle) + share * (balance - max(middle))
    others = draw(st.permutations([*middle, longest]))
    others.insert(_SHORTEST_IN[kind], 1.0)
    return others


@st.composite
def _slider_cranks(draw: st.DrawFn, kind: GrashofClass) -> SliderCrank:
    r2 = draw(st.integers(8, 24)) / 8
    if kind is GrashofClass.SLIDER_CRANK:
        r3 = r2 + draw(st.floats(0.2, 3))
        offset = (r3 - r2) * draw(st.floats(-0.9, 0.9))
    elif draw(st.booleans()):  # swings beside the line perpendicular to the slide, in two ranges
        r3 = r2 * draw(st.floats(0.2, 0.9))
        offset = (r2 - r3) * draw(st.floats(-0.9, 0.9))
    else:
        r3 = r2 * draw(st.floats(0.3, 3))
        least, most = abs(r3 - r2), r3 + r2
        offset = (least + (most - least) * draw(st.floats(0.1, 0.9))) * draw(st.sampled_from([-1, 1]))
    scale, angle, o2, rest = _anywhere(draw)
    return SliderCrank(o2, scale * r2, scale * r3, scale * offset, angle, **rest)


@st.composite
def _inverted(draw: st.DrawFn, kind: GrashofClass) -> InvertedSliderCrank:
    short, long = 1.0, 1 + draw(st.floats(0.2, 3))
    least, most = long - short, long + short
    turned = draw(st.booleans()) if kind is GrashofClass.INVERTED_SLIDER_ROCKER else None
    r1, r2 = (short, long) if turned or kind is GrashofClass.WHITWORTH else (long, short)
    share = draw(st.floats(0.1, 0.9)) * draw(st.sampled_from([-1, 1]))
    offset = least * share if turned is None else np.sign(share) * (least + (most - least) * abs(share))
    if turned is None and draw(st.booleans()):
        offset = 0.0
    scale, theta1, o2, rest = _anywhere(draw)
    return InvertedSliderCrank(o2, o2 + scale * r1 * _towards(theta1), scale * r2, scale * offset, **rest)


def _anywhere(draw: st.DrawFn) -> tuple[float, float, npt.NDArray[np.float64], dict[str, Any]]:
    """A scale, an angle, O2; and the coupler point, assembly and body angle."""
    scale, angle, place = np.exp(draw(st.floats(-2, 2))), draw(st.floats(-np.pi, np.pi)), st.floats(-3, 3)
    o2 = scale * np.array([draw(place), draw(place)])
    rest = {
        "coupler_point": (scale * draw(place), scale * draw(place)),
        "assembly": draw(st.sampled_from([-1, 1])),
        "body_angle": draw(st.floats(-np.pi, np.pi)),
    }
    return scale, angle, o2, rest


def _towards(angle: float) -> npt.NDArray[np.float64]:
    return np.array([np.cos(angle), np.sin(angle)])


_SLIDING: dict[GrashofClass, Callable[[GrashofClass], st.SearchStrategy[Linkage]]] = {
    GrashofClass.SLIDER_CRANK: _slider_cranks,
    GrashofClass.SLIDER_ROCKER: _slider_cranks,
    GrashofClass.CRANK_SHAPER: _inverted,
    GrashofClass.WHITWORTH: _inverted,
    GrashofClass.INVERTED_SLIDER_ROCKER: _inverted,
}
