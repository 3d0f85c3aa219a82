"""Fixtures of the analysis: published figures, linkages of every class, positions by the law of cosines."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import strategies as st

from grashof.analysis import GrashofClass
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank

_SHORTEST_IN = {
    GrashofClass.DOUBLE_CRANK: 0,
    GrashofClass.CRANK_ROCKER: 1,
    GrashofClass.DOUBLE_ROCKER: 2,
    GrashofClass.ROCKER_CRANK: 3,
}


@pytest.fixture(scope="session")
def golden() -> dict[str, Any]:
    """The reference figures, 20 digits each; with their conventions."""
    return json.loads((Path(__file__).parents[1] / "data" / "golden.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def golden_linkages(golden: dict[str, Any]) -> dict[str, FourBar]:
    """The linkages whose states golden.json gives, all with assembly +1."""
    return {
        "pumpjack": _pumpjack(golden["pumpjack_report_geometry"]["inputs"]),
        "lufkin": _lufkin(golden["pumpjack_lufkin_C912D_427_144"]["inputs_in"]),
        "bag": _bag(golden["bag_mechanism_exact"]),
        "table7": _table7(golden["table7_lengths_theta1_0"]),
    }


@pytest.fixture(scope="session")
def golden_states(golden: dict[str, Any]) -> list[tuple[str, int, float, dict[str, Any]]]:
    """Every state of these linkages: name, assembly, speed of the driver in rad/s, figures."""
    pumpjack, bag = golden["pumpjack_report_geometry"]["states"], golden["bag_mechanism_exact"]
    lufkin = golden["pumpjack_lufkin_C912D_427_144"]["states(omega2=1 rad/s, inches)"]
    states = [
        *(("pumpjack", 1, 2 * np.pi / 3, state) for state in pumpjack["sigma=+1"]),
        *(("pumpjack", -1, 2 * np.pi / 3, state) for state in pumpjack["sigma=-1"]),
        *(("lufkin", 1, 1.0, state) for state in lufkin),
        *(("bag", 1, 1.0, state) for state in [*bag["states_at_poses"], *bag["states"]]),
        *(("table7", 1, 1.0, state) for state in golden["table7_lengths_theta1_0"]["states"]),
    ]
    assert len(states) == 10 + 2 + 8 + 9
    return states


def _reported(
    given: dict[str, Any], point: Callable[[float], npt.ArrayLike], body_angle: float = 0.0
) -> FourBar:
    """A linkage whose coupler point is given by its r3."""
    r2, r3, r4 = (float(given[name]) for name in ("r2", "r3", "r4"))
    return FourBar(
        o2=_pair(given["O2"]), o4=_pair(given["O4"]), r2=r2, r3=r3, r4=r4,
        coupler_point=point(r3), body_angle=body_angle,
    )  # fmt: skip


def _pumpjack(given: dict[str, Any]) -> FourBar:
    return _reported(given, lambda r3: (r3 / 2 * np.cos(0.4), r3 / 2 * np.sin(0.4)))


def _lufkin(given: dict[str, Any]) -> FourBar:
    names = {name: float(value) for name, value in given.items()}
    return FourBar(
        o2=(0, 0), o4=(names["I"], names["H"] - names["G"]), r2=names["R"], r3=names["P"], r4=names["C"]
    )


def _bag(given: dict[str, Any]) -> FourBar:
    body_angle = -float(given["states_at_poses"][0]["theta3"])
    return _reported(given, lambda r3: r3 * np.array(_pair(given["coupler_ratio"])), body_angle)


def _table7(given: dict[str, Any]) -> FourBar:
    r1, r2, r3, r4 = map(float, given["r"])
    return FourBar(o2=(0, 0), o4=(r1, 0), r2=r2, r3=r3, r4=r4)


def _pair(values: list[str]) -> tuple[float, float]:
    x, y = values
    return float(x), float(y)


@pytest.fixture(scope="session")
def close_loop() -> Callable[..., tuple[npt.NDArray[np.complex128], ...]]:
    """A, B and P as complex numbers, by the law of cosines; B is NaN where the loop cannot close."""

    def positions(
        linkage: FourBar, theta2: npt.ArrayLike, assembly: float
    ) -> tuple[npt.NDArray[np.complex128], ...]:
        a = complex(*linkage.o2) + linkage.r2 * np.exp(1j * np.asarray(theta2))
        diagonal = complex(*linkage.o4) - a
        length = np.abs(diagonal)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # A may stand on O4
            cosine = (length**2 + linkage.r3**2 - linkage.r4**2) / (2 * length * linkage.r3)
            cosine = np.where(np.abs(cosine) <= 1 + 1e-14, np.clip(cosine, -1, 1), np.nan)
            inner = np.arccos(cosine)
            coupler = diagonal / length * np.exp(1j * assembly * inner)
        return a, a + linkage.r3 * coupler, a + complex(*linkage.coupler_point) * coupler

    return positions


@pytest.fixture(scope="session")
def four_bars() -> Callable[[GrashofClass], st.SearchStrategy[FourBar]]:
    """Strategy for linkages of a class, well away from change points unless these are requested."""
    return _four_bars


@st.composite
def _four_bars(draw: st.DrawFn, kind: GrashofClass) -> FourBar:
    lengths = draw(_lengths(kind))
    scale = np.exp(draw(st.floats(-2, 2)))
    theta1 = draw(st.floats(-np.pi, np.pi))
    r1, r2, r3, r4 = scale * np.array(lengths)
    place = st.floats(-3, 3)
    o2 = scale * np.array([draw(place), draw(place)])
    return FourBar(
        o2=o2,
        o4=o2 + r1 * np.array([np.cos(theta1), np.sin(theta1)]),
        r2=r2,
        r3=r3,
        r4=r4,
        coupler_point=(scale * draw(place), scale * draw(place)),
        assembly=draw(st.sampled_from([-1, 1])),
        body_angle=draw(st.floats(-np.pi, np.pi)),
    )


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


@pytest.fixture(scope="session")
def linkages() -> Callable[[GrashofClass], st.SearchStrategy[Linkage]]:
    """Strategy for linkages of a class of any kind, as `four_bars`."""
    return lambda kind: _SLIDING[kind](kind) if kind in _SLIDING else _four_bars(kind)


@st.composite
def _slider_cranks(draw: st.DrawFn, kind: GrashofClass) -> SliderCrank:
    r2 = draw(st.integers(8, 24)) / 8
    if kind is GrashofClass.SLIDER_CRANK:
        r3 = r2 + draw(st.floats(0.2, 3))
        offset = (r3 - r2) * draw(st.floats(-0.9, 0.9))
    elif draw(st.booleans()):  # swings beside the line square to the slide, in two ranges
        r3 = r2 * draw(st.floats(0.2, 0.9))
        offset = (r2 - r3) * draw(st.floats(-0.9, 0.9))
    else:
        r3 = r2 * draw(st.floats(0.3, 3))
        least, most = abs(r3 - r2), r3 + r2
        offset = (least + (most - least) * draw(st.floats(0.1, 0.9))) * draw(st.sampled_from([-1, 1]))
    scale, place = np.exp(draw(st.floats(-2, 2))), st.floats(-3, 3)
    return SliderCrank(
        o2=scale * np.array([draw(place), draw(place)]),
        r2=scale * r2,
        r3=scale * r3,
        offset=scale * offset,
        slide_angle=draw(st.floats(-np.pi, np.pi)),
        coupler_point=(scale * draw(place), scale * draw(place)),
        assembly=draw(st.sampled_from([-1, 1])),
        body_angle=draw(st.floats(-np.pi, np.pi)),
    )


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
    scale, place, theta1 = np.exp(draw(st.floats(-2, 2))), st.floats(-3, 3), draw(st.floats(-np.pi, np.pi))
    o2 = scale * np.array([draw(place), draw(place)])
    return InvertedSliderCrank(
        o2=o2,
        o4=o2 + scale * r1 * np.array([np.cos(theta1), np.sin(theta1)]),
        r2=scale * r2,
        offset=scale * offset,
        coupler_point=(scale * draw(place), scale * draw(place)),
        assembly=draw(st.sampled_from([-1, 1])),
        body_angle=draw(st.floats(-np.pi, np.pi)),
    )


_SLIDING: dict[GrashofClass, Callable[[GrashofClass], st.SearchStrategy[Linkage]]] = {
    GrashofClass.SLIDER_CRANK: _slider_cranks,
    GrashofClass.SLIDER_ROCKER: _slider_cranks,
    GrashofClass.CRANK_SHAPER: _inverted,
    GrashofClass.WHITWORTH: _inverted,
    GrashofClass.INVERTED_SLIDER_ROCKER: _inverted,
}
