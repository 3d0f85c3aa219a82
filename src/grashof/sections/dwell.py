"""How long the output dwells while the driver turns on."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis import Dwell, Kinematics, dwell
from grashof.problems import AssemblyError
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.checks import number_within
from grashof.study.quantities import counted_on, counted_with
from grashof.study.samples import curves, over_driver
from grashof.study.section import Fact, Section
from grashof.study.study import LinkageStudy
from grashof.study.sweep import INSET


def dwell_section(study: LinkageStudy) -> Section | None:
    """The longest rest of the output within a band; None unless a band is asked for."""
    if study.asked.dwell_deg is None:
        return None
    band = np.radians(number_within(study.asked.dwell_deg, 1e-6, 360.0, "dwell_deg"))
    found = [_rest(study, band, low, high) for low, high in study.sweep.ranges]
    theta, key = f"theta{study.output}", f"theta{study.output}_deg"
    columns = over_driver(study, lambda state: {key: counted_on(np.degrees(getattr(state, theta)), 360.0)})
    swing = float(np.nanmin(columns[key])), float(np.nanmax(columns[key]))
    numbered = enumerate(found, start=1)
    facts = tuple(fact for number, rest in numbered for fact in _facts(study, rest, number, swing))
    at = columns["theta2_deg"]
    dwelling = np.zeros(at.shape, dtype=bool)
    for rest in found:
        start, end = np.degrees([rest.start, rest.end])
        dwelling |= (at - start) % 360 <= end - start if study.sweep.turns else (at >= start) & (at <= end)
    columns["dwelling"] = np.where(dwelling, columns[key], np.nan)
    labels = {theta: key, "dwell": "dwelling"}
    title = f"dwell of link {study.output} within {study.asked.dwell_deg:g} deg"
    plot = curves(columns, "dwell", title, "deg", labels)
    return Section("dwell", "Dwell", facts, {}, (plot,))


def _rest(study: LinkageStudy, band: float, low: float, high: float) -> Dwell:
    def theta(state: Kinematics) -> FloatArray:
        return state.angular(study.output).theta

    if study.sweep.turns:
        return dwell(study.linkage, theta, band, period=TURN)
    try:
        return dwell(study.linkage, theta, band, low, high, TURN)
    except AssemblyError:  # rounding at the very end of a range
        return dwell(study.linkage, theta, band, low + INSET, high - INSET, TURN)


def _facts(study: LinkageStudy, rest: Dwell, number: int, swing: tuple[float, float]) -> Iterator[Fact]:
    many = len(study.sweep.ranges) > 1
    mark, where = (f"_{number}", f", range {number}") if many else ("", "")
    theta = f"theta{study.output}"
    what = f"dwell of {theta} within {study.asked.dwell_deg:g} deg{where}"
    yield Fact(f"dwell{mark}_deg", f"{what}: turn of the driver", float(np.degrees(rest.duration)), "deg")
    for name, angle in (("from", rest.start), ("to", rest.end)):
        yield Fact(f"dwell{mark}_{name}_deg", f"{what}: {name} theta2", float(np.degrees(angle)), "deg")
    middle = float(np.degrees(rest.low + rest.high)) / 2
    turned = counted_with(middle, [swing], 360.0) - middle
    for name, angle in (("low", rest.low), ("high", rest.high)):
        label = f"{what}: {theta}, {name} end of the band"
        yield Fact(f"dwell{mark}_{name}_{theta}_deg", label, float(np.degrees(angle)) + turned, "deg")
    if study.sweep.speed_rpm != 0:
        seconds = float(np.degrees(rest.duration)) / 6 / abs(study.sweep.speed_rpm)
        yield Fact(f"dwell{mark}_seconds", f"{what}: time at the driver's speed", seconds, "s")
