"""Central differences of second and fourth order beside the exact rates of angles and centres of mass."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics, central_differences
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.sections.mass_centres import centre_labels, centres_of
from grashof.study.kinds import turning
from grashof.study.samples import History, Samples
from grashof.study.section import Fact, Section
from grashof.study.study import LinkageStudy

KEY = "differences"
ORDERS = (2, 4)
_DEGREE, _BESIDE = TURN / 360, 2  # samples on either side of one that order 4 needs
_ANGULAR, _LINEAR = (("omega", "rad/s"), ("alpha", "rad/s²")), (("velocity", "/s"), ("acceleration", "/s²"))


@dataclass(frozen=True, slots=True, eq=False)
class Rate:
    """The first or second derivative of positions, exact and by differences of each order, (N,) or (N, 2).

    NaN divides the ranges of the driver, and stands where a difference lacks neighbours on both sides.
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

    def apart(self, order: int) -> FloatArray:
        """Distances from the exact values, shape (N,); NaN where there are none."""
        return _size(self.by_order[order] - np.where(np.isfinite(self.exact), self.exact, np.nan))


class _Part(NamedTuple):
    """Samples in equal steps of the driver or of time; `cut` of them at each end are neighbours only."""

    state: Kinematics
    at: FloatArray
    cut: int = 0
    over_time: bool = False


def differences(study: LinkageStudy) -> Section | None:
    """Differences of theta3, theta4 and the centres of mass, if they are asked for.

    Over the driver angle in steps of a degree, or over the history that is asked for, in its steps.
    """
    if not study.asked.wants(KEY):
        return None
    title, (samples, parts) = "Central differences", _even_samples(study)
    if min(len(part.at) for part in parts) <= 2 * _BESIDE:
        return Section(KEY, title, notes=(f"differences need {2 * _BESIDE + 1} samples or more",))
    rates = list(_rates(study, parts))
    columns = {key: values for rate in rates for key, values in rate.columns.items()}
    deviations = _deviations(samples, rates)
    tables = {KEY: samples.table(columns), f"{KEY}-deviations": deviations}
    plots = [
        samples.plot(f"differences-{rate.key.replace('_', '-')}", rate.label, rate.unit, rate.lines)
        for rate in rates
    ]
    return Section(KEY, title, tuple(_facts(deviations)), tables, tuple(plots), _notes(study))


def _even_samples(study: LinkageStudy) -> tuple[Samples, list[_Part]]:
    """What is shown, and the parts of it in equal steps with their neighbours."""
    if (history := History.of(study)) is not None:
        return Samples.over_time(study, history), [_Part(history.state, history.time, over_time=True)]
    if study.sweep.turns:  # beyond either end the motion goes on as it began
        angles = np.linspace(-_BESIDE, 360 + _BESIDE, 361 + 2 * _BESIDE) * _DEGREE
        return Samples.over_driver(study), [_Part(study.sweep.state(angles), angles, _BESIDE)]
    parts = []
    for low, high in study.sweep.ranges:
        steps = max(int((high - low) / _DEGREE), 2 * _BESIDE + 2)
        angles = np.linspace(low, high, steps + 1)[1:-1]  # in a dead position there is no rate
        parts.append(_Part(study.sweep.state(angles), angles))
    return Samples.of(study, tuple(part.state for part in parts)), parts


def _rates(study: LinkageStudy, parts: list[_Part]) -> Iterator[Rate]:
    for link in turning(study.linkage.mechanism):
        angles = [np.unwrap(getattr(part.state, f"theta{link}")) for part in parts]
        for derivative, (name, unit) in enumerate(_ANGULAR, start=1):
            exact = [getattr(part.state, f"{name}{link}") for part in parts]
            yield _rate((f"{name}{link}", f"{name}{link}", unit), derivative, angles, exact, parts)
    centres = [centres_of(study, part.state) for part in parts]
    for key, label in centre_labels(study).items():
        places = [each[key].position for each in centres]
        for derivative, (name, per) in enumerate(_LINEAR, start=1):
            exact = [getattr(each[key], name) for each in centres]
            named = (f"{key}_{name}", f"{name} of {label}", f"{study.spec.unit}{per}")
            yield _rate(named, derivative, places, exact, parts)


def _rate(
    named: tuple[str, str, str],
    derivative: int,
    places: list[FloatArray],
    exact: list[FloatArray],
    parts: list[_Part],
) -> Rate:
    by_order = {
        order: _joined(
            parts, [_by_time(*pair, derivative, order) for pair in zip(parts, places, strict=True)]
        )
        for order in ORDERS
    }
    return Rate(*named, derivative, _joined(parts, exact), by_order)


def _by_time(part: _Part, values: FloatArray, derivative: int, order: int) -> FloatArray:
    """First or second derivative by time: from that by theta2 through the driver's own motion."""
    found = central_differences(part.at, values, derivative, order)
    if part.over_time:
        return found
    omega2, alpha2 = (
        each if values.ndim == 1 else each[:, None] for each in (part.state.omega2, part.state.alpha2)
    )
    if derivative == 1:
        return found * omega2
    return found * omega2**2 + central_differences(part.at, values, 1, order) * alpha2


def _joined(parts: list[_Part], values: list[FloatArray]) -> FloatArray:
    kept = [each[part.cut : len(each) - part.cut] for part, each in zip(parts, values, strict=True)]
    return LinkageStudy.joined(kept)


def _deviations(samples: Samples, rates: list[Rate]) -> pd.DataFrame:
    """Where each rate by differences is farthest from the exact one, and by which share of its peak."""
    rows = []
    for rate in rates:
        for order in ORDERS:
            apart = rate.apart(order)
            worst = int(np.argmax(np.where(np.isfinite(apart), apart, -1.0)))
            size = _size(rate.exact)
            peak = float(np.max(size[np.isfinite(size)], initial=0.0))
            named: dict[str, object] = {
                "quantity": rate.label,
                "unit": rate.unit,
                "derivative": rate.derivative,
                "order": order,
            }
            share = float(apart[worst]) / peak if peak > 0 else 0.0
            where = {key: float(values[worst]) for key, values in samples.columns.items()}
            rows.append(named | {"largest": float(apart[worst]), "share": share} | where)
    return pd.DataFrame(rows)


def _facts(deviations: pd.DataFrame) -> Iterator[Fact]:
    for derivative, name in ((1, "velocities"), (2, "accelerations")):
        for order in ORDERS:
            rows = deviations[(deviations["derivative"] == derivative) & (deviations["order"] == order)]
            label = f"{name} by central differences of order {order}: largest error, as a share of the peak"
            yield Fact(f"differences_{name}_order_{order}", label, float(rows["share"].max()))


def _notes(study: LinkageStudy) -> tuple[str, ...]:
    if study.sweep.turns:
        return ()
    return ("towards a dead position no step is small enough: rates grow without bound there",)


def _components(values: FloatArray, name: str, name_of_axis: str) -> dict[str, FloatArray]:
    """Numbers by their name, shape (N,), or vectors, shape (N, 2), by components."""
    if values.ndim == 1:
        return {name: values}
    return {name_of_axis.format(axis=axis): values[:, index] for index, axis in enumerate("xy")}


def _size(values: FloatArray) -> FloatArray:
    return np.abs(values) if values.ndim == 1 else np.hypot(*values.T)
