"""Numerical methods beside closed forms: positions by Newton-Raphson, rates by central differences."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics, central_differences, newton_position
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.sections.places import centre_labels, centres_of
from grashof.study.kinds import turning
from grashof.study.samples import History, Samples
from grashof.study.section import Fact, Section
from grashof.study.study import LinkageStudy

_NEWTON = "newton-raphson"
_OTHER = 1.0  # deg from the closed form: beyond it the steps have ended on the other assembly
_DIFFERENCES = "differences"
ORDERS = (2, 4)
_DEGREE, _BESIDE = TURN / 360, 2  # samples on either side of one that order 4 needs
_ANGULAR, _LINEAR = (("omega", "rad/s"), ("alpha", "rad/s²")), (("velocity", "/s"), ("acceleration", "/s²"))


def newton_raphson(study: LinkageStudy) -> Section | None:
    """Both solutions at every sample, each from its own guess; None unless they are requested."""
    if not study.asked.wants(_NEWTON):
        return None
    samples = Samples.requested(study)
    theta2 = study.joined([state.theta2 for state in samples.states])
    exact = np.degrees([study.joined([getattr(s, f"theta{n}") for s in samples.states]) for n in (3, 4)])
    known = np.isfinite(theta2)
    found = newton_position(study.four_bar, theta2[known])
    solved, steps = np.full(exact.shape, np.nan), np.full(theta2.shape, np.nan)
    solved[:, known], steps[known] = np.degrees([found.theta3, found.theta4]), found.steps
    off = (solved - exact + 180) % 360 - 180
    columns = {
        "theta3_deg": solved[0], "theta4_deg": solved[1], "steps": steps,
        "theta3_closed_deg": exact[0], "theta4_closed_deg": exact[1],
        "theta3_difference_deg": off[0], "theta4_difference_deg": off[1],
    }  # fmt: skip
    apart = np.abs(off).max(axis=0)
    same = apart < _OTHER
    furthest = float(apart[same].max(initial=0.0))
    label = "Newton-Raphson: largest difference from the closed form"
    facts = (
        Fact("newton_steps_max", "Newton-Raphson: most steps", int(np.nanmax(steps)) if known.any() else 0),
        Fact("newton_difference_max_deg", label, furthest, "deg"),
    )
    lines = {"theta3": _unwrapped(solved[0]), "theta4": _unwrapped(solved[1])}
    plots = (
        samples.plot("newton-raphson", "angles by Newton-Raphson", "deg", lines),
        samples.plot("newton-raphson-steps", "Newton-Raphson steps", "", {"steps": steps}),
    )
    missed = int((known & ~same).sum())
    table = samples.table(columns).astype({"steps": int})
    note = "do not converge, or end on the other assembly: near a dead position the two lie close together"
    notes = (f"at {missed} of {int(known.sum())} driver angles the steps {note}",) if missed else ()
    return Section(_NEWTON, "Newton-Raphson", facts, {_NEWTON: table}, plots, notes)


def _unwrapped(angles_deg: np.ndarray) -> np.ndarray:
    """Angles without jumps, where they are known."""
    unwrapped, known = angles_deg.copy(), np.isfinite(angles_deg)
    unwrapped[known] = np.unwrap(angles_deg[known], period=360)
    return unwrapped


@dataclass(frozen=True, slots=True, eq=False)
class Rate:
    """The first or second derivative of positions, exact and by differences of each order, (N,) or (N, 2).

    NaN separates the ranges of the driver, and marks differences without neighbours on both sides.
    """

    key: str
    label: str
    unit: str
    derivative: int
    exact: FloatArray
    by_order: Mapping[int, FloatArray]

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Columns of a table."""
        found = _components(self.exact, self.key, f"{self.key}_{{axis}}")
        for order, values in self.by_order.items():
            found |= _components(values, f"{self.key}_order_{order}", f"{self.key}_{{axis}}_order_{order}")
        return found

    @property
    def lines(self) -> dict[str, FloatArray]:
        """Lines of a plot by their labels."""
        found = _components(self.exact, "exact", "{axis}, exact")
        for order, values in self.by_order.items():
            found |= _components(values, f"order {order}", f"{{axis}}, order {order}")
        return found

    def deviation(self, order: int) -> FloatArray:
        """Distance from the exact values, shape (N,); NaN where one is missing."""
        return _size(self.by_order[order] - np.where(np.isfinite(self.exact), self.exact, np.nan))


class _Part(NamedTuple):
    """Samples in equal steps of driver angle or time; `cut` of them at each end are neighbours only."""

    state: Kinematics
    at: FloatArray
    cut: int = 0
    over_time: bool = False


def differences(study: LinkageStudy) -> Section | None:
    """Differences of link angles and centres of mass; None unless they are requested.

    Over the driver angle in steps of a degree, or over the requested history in its steps.
    """
    if not study.asked.wants(_DIFFERENCES):
        return None
    title, (samples, parts) = "Central differences", _even_samples(study)
    if min(len(part.at) for part in parts) <= 2 * _BESIDE:
        return Section(_DIFFERENCES, title, notes=(f"differences need {2 * _BESIDE + 1} samples or more",))
    rates = list(_rates(study, parts))
    columns = {key: values for rate in rates for key, values in rate.columns.items()}
    deviations = _deviations(samples, rates)
    tables = {_DIFFERENCES: samples.table(columns), f"{_DIFFERENCES}-deviations": deviations}
    plots = [
        samples.plot(f"differences-{rate.key.replace('_', '-')}", rate.label, rate.unit, rate.lines)
        for rate in rates
    ]
    towards = "towards a dead position no step is small enough: rates grow without bound there"
    notes = () if study.sweep.turns else (towards,)
    return Section(_DIFFERENCES, title, tuple(_deviation_facts(deviations)), tables, tuple(plots), notes)


def _even_samples(study: LinkageStudy) -> tuple[Samples, list[_Part]]:
    """The samples of the table, and its parts in equal steps with their neighbours."""
    if (history := History.of(study)) is not None:
        return Samples.over_time(study, history), [_Part(history.state, history.time, over_time=True)]
    if study.sweep.turns:  # the motion is periodic
        angles = np.linspace(-_BESIDE, 360 + _BESIDE, 361 + 2 * _BESIDE) * _DEGREE
        return Samples.over_driver(study), [_Part(study.sweep.state(angles), angles, _BESIDE)]
    parts = []
    for low, high in study.sweep.ranges:
        steps = max(int((high - low) / _DEGREE), 2 * _BESIDE + 2)
        angles = np.linspace(low, high, steps + 1)[1:-1]  # rates are infinite in dead positions
        parts.append(_Part(study.sweep.state(angles), angles))
    return Samples.of(study, tuple(part.state for part in parts)), parts


def _rates(study: LinkageStudy, parts: list[_Part]) -> Iterator[Rate]:
    for link in turning(study.linkage.mechanism):
        angles = [np.unwrap(getattr(part.state, f"theta{link}")) for part in parts]
        for derivative, (name, unit) in enumerate(_ANGULAR, start=1):
            exact = [getattr(part.state, f"{name}{link}") for part in parts]
            yield _rate(parts, (f"{name}{link}", f"{name}{link}", unit), derivative, angles, exact)
    centres = [centres_of(study, part.state) for part in parts]
    for key, label in centre_labels(study).items():
        places = [each[key].position for each in centres]
        for derivative, (name, per) in enumerate(_LINEAR, start=1):
            exact = [getattr(each[key], name) for each in centres]
            named = (f"{key}_{name}", f"{name} of {label}", f"{study.spec.unit}{per}")
            yield _rate(parts, named, derivative, places, exact)


def _rate(
    parts: list[_Part],
    named: tuple[str, str, str],
    derivative: int,
    places: list[FloatArray],
    exact: list[FloatArray],
) -> Rate:
    pairs = list(zip(parts, places, strict=True))
    by_order = dict[int, FloatArray]()
    for order in ORDERS:
        by_order[order] = _joined(parts, [_by_time(*pair, derivative, order) for pair in pairs])
    return Rate(*named, derivative, _joined(parts, exact), by_order)


def _by_time(part: _Part, values: FloatArray, derivative: int, order: int) -> FloatArray:
    """First or second derivative by time: of that by theta2 by the chain rule with the driver's motion."""
    found = central_differences(part.at, values, derivative, order)
    if part.over_time:
        return found
    shape = (-1,) + (1,) * (values.ndim - 1)
    omega2, alpha2 = np.reshape(part.state.omega2, shape), np.reshape(part.state.alpha2, shape)
    if derivative == 1:
        return found * omega2
    return found * omega2**2 + central_differences(part.at, values, 1, order) * alpha2


def _joined(parts: list[_Part], values: list[FloatArray]) -> FloatArray:
    kept = [each[part.cut : len(each) - part.cut] for part, each in zip(parts, values, strict=True)]
    return LinkageStudy.joined(kept)


def _deviations(samples: Samples, rates: list[Rate]) -> pd.DataFrame:
    """The largest deviation of each rate by differences, its place, and its share of the peak."""
    rows = []
    for rate, order in product(rates, ORDERS):
        off = rate.deviation(order)
        worst = int(np.argmax(np.where(np.isfinite(off), off, -1.0)))
        largest = float(off[worst])
        size = _size(rate.exact)
        peak = float(np.max(size[np.isfinite(size)], initial=0.0))
        row: dict[str, object] = {
            "quantity": rate.label,
            "unit": rate.unit,
            "derivative": rate.derivative,
            "order": order,
            "largest": largest,
            "share": largest / peak if peak > 0 else 0.0,
        }
        rows.append(row | {key: float(values[worst]) for key, values in samples.columns.items()})
    return pd.DataFrame(rows)


def _deviation_facts(deviations: pd.DataFrame) -> Iterator[Fact]:
    for derivative, name in ((1, "velocities"), (2, "accelerations")):
        for order in ORDERS:
            rows = deviations[(deviations["derivative"] == derivative) & (deviations["order"] == order)]
            label = f"{name} by central differences of order {order}: largest error, as a share of the peak"
            yield Fact(f"differences_{name}_order_{order}", label, float(rows["share"].max()))


def _components(values: FloatArray, name: str, name_of_axis: str) -> dict[str, FloatArray]:
    """Scalars (N,) by their name, or vectors (N, 2) by components."""
    if values.ndim == 1:
        return {name: values}
    return {name_of_axis.format(axis=axis): values[:, index] for index, axis in enumerate("xy")}


def _size(values: FloatArray) -> FloatArray:
    return np.abs(values) if values.ndim == 1 else np.hypot(*values.T)
