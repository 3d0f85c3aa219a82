"""The deviation of the effort of a linkage from the wanted one, and strokes that end inside the travel."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from grashof.analysis.cylinder.travel import Travel
from grashof.analysis.effort.case import EffortCase, EffortState
from grashof.analysis.numerics.peaks import peaks
from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.dynamics.effort import Demand

_SAMPLES = 121
_SLACK = 1e-9  # share of a limit


class Deviation(NamedTuple):
    """The greatest excess of the effort over its limits, N; a negative one is a margin.

    At a rotation of `angle_deg` from the start of the travel, at a temperature; `words` names the demand.
    """

    excess: float
    angle_deg: float
    temperature_c: float
    words: str

    @property
    def greatest(self) -> float:
        """The greatest deviation, N: 0 where the effort is within its limits."""
        return max(self.excess, 0.0)


class Miss(NamedTuple):
    """A limit that an effort or a part misses, by its key in the file."""

    key: str
    what: str
    found: float
    allowed: str
    miss: float


@dataclass(frozen=True, slots=True)
class EffortFigures:
    """Figures of an effort over the travel.

    Parameters
    ----------
    deviation : Deviation
    without : Deviation
        The deviation without struts and springs.
    lengths : tuple of pair of float, length
        Least and greatest length of each part; for a torsion spring its turn, deg.
    misses : tuple of Miss
        Strokes that end inside the travel, and demands beyond it.
    """

    deviation: Deviation
    without: Deviation
    lengths: tuple[Limits, ...]
    misses: tuple[Miss, ...]


def effort_figures(case: EffortCase) -> EffortFigures:
    """The figures of an effort from ever closer samples, exact to rounding where its curves are smooth."""
    lengths = tuple(_extremes(case, index) for index in range(len(case.spec.parts)))
    misses = (*_beyond_travel(case), *_beyond_stroke(case, lengths))
    return EffortFigures(_greatest(case, parts=True), _greatest(case, parts=False), lengths, misses)


def excess(demand: Demand, state: EffortState, *, parts: bool = True) -> FloatArray:
    """Excess of the effort over a demand, shape (2, T, N), N: above its upper limit, and below the lower."""
    effort = state.effort if parts else np.broadcast_to(state.without, state.effort.shape)
    effort = state.sense * effort if demand.opening else effort
    end = demand.end if np.isfinite(demand.end) else demand.start + 1  # any finite value will do
    least, most = (
        np.interp(state.angle_deg, (demand.start, end), side) for side in (demand.least, demand.most)
    )
    friction = demand.friction * state.friction
    return np.stack([effort - most + friction, least - effort + friction])


def _greatest(case: EffortCase, *, parts: bool) -> Deviation:
    """The greatest excess of all demands."""
    temperatures = case.spec.temperatures_c
    found = [Deviation(-np.inf, 0.0, temperatures[0], "")]
    for demand in case.spec.demands:
        ends = case.place_at(demand.start), case.place_at(demand.end)
        if not demand.start <= case.total_deg:
            continue
        places = np.unique(np.linspace(*ends, _SAMPLES))

        def rows(at: FloatArray, demand: Demand = demand) -> FloatArray:
            return excess(demand, case.at(at), parts=parts).reshape(2 * len(temperatures), -1)

        values, where = peaks(rows, [places])
        worst = int(values.argmax())
        angle = float(case.angle_deg([where[worst]])[0])
        found.append(
            Deviation(float(values[worst]), angle, temperatures[worst % len(temperatures)], demand.words)
        )
    return max(found, key=lambda each: each.excess)


def _extremes(case: EffortCase, index: int) -> Limits:
    """Least and greatest length of a part over the travel."""

    def rows(at: FloatArray) -> FloatArray:
        length = case.at(at).parts[index].length
        return np.stack([-length, length])

    shortest, longest = peaks(rows, [case.travel.places])[0].tolist()
    return -shortest, longest


def _beyond_stroke(case: EffortCase, lengths: tuple[Limits, ...]) -> Iterator[Miss]:
    for index, (part, (least, most)) in enumerate(zip(case.spec.parts, lengths, strict=True)):
        size, key = part.sizes[0], f"effort.parts[{index}]"
        if part.turns:
            turn = max(abs(least), abs(most))
            if turn > size.turn_deg * (1 + _SLACK):
                allowed = f"up to {size.turn_deg:.6g}"
                yield Miss(
                    key, "the turn from the free angle, deg,", turn, allowed, np.radians(turn - size.turn_deg)
                )
            continue
        for end, length, past in (
            ("compressed", least, size.compressed - least),
            ("extended", most, most - size.extended),
        ):
            if past > _SLACK * size.extended:
                bound = f"from {size.compressed:.6g}" if end == "compressed" else f"up to {size.extended:.6g}"
                what = f"the {'least' if end == 'compressed' else 'greatest'} length, beyond {end},"
                yield Miss(key, what, length, bound, past / size.stroke)


def _beyond_travel(case: EffortCase) -> Iterator[Miss]:
    """Angles that the linkage does not reach."""
    total = case.total_deg
    named: dict[str, float] = {}
    for demand in case.spec.demands:
        if np.isfinite(demand.end):
            named[demand.words] = max(demand.end, named.get(demand.words, 0.0))
    for words, end in named.items():
        if total < end * (1 - _SLACK):
            key = {"stays": "stays_deg", "closes": "closes_below_deg"}.get(words, words)
            what = "the rotation over the travel, deg,"
            yield Miss(f"effort.{key}", what, total, f"{end:.6g} or more", np.radians(end - total))
    if not case.rises:
        what = "the number of senses in which the link of its angles turns"
        yield Miss("effort.over", what, 2, 'one; or over = "driver"', 1.0)


def effort_curves(case: EffortCase, count: int = 181) -> tuple[FloatArray, EffortState]:
    """Places from the start of the travel to its end, and the state there."""
    places = even_places(case, count)
    return places, case.at(places)


def even_places(case: EffortCase, count: int) -> FloatArray:
    """Places from the start of the travel to its end, closer together towards both."""
    travel: Travel = case.travel
    share = (1 - np.cos(np.linspace(0, np.pi, count))) / 2
    return np.asarray(travel.start + (travel.end - travel.start) * share)
