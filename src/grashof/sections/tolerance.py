"""Displacements of P and the output due to inexact dimensions."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis import Kinematics, made_moves
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import GREATEST, number_within, positive_number
from grashof.study.kinds import output_turns
from grashof.study.samples import Columns, curves, over_driver, table
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.study.turn import degrees, turn_peaks

_SAME = 1e-12  # share by which equal displacements may differ due to rounding
_ALL = {"worst": "worst senses", "rms": "root of the sum of squares"}


def tolerance(study: LinkageStudy) -> Section | None:
    """Displacements of P and the output link over the driver angle; None unless a tolerance is requested."""
    if study.asked.tolerance is None:
        return None
    off = number_within(positive_number(study.asked.tolerance, "tolerance"), 0.0, GREATEST, "tolerance")
    unit = study.spec.unit
    columns = over_driver(study, lambda state: _columns(state, off))
    each = {dimension: f"p_{dimension}" for dimension in study.linkage.mechanism.dimensions}
    plots = _plots(columns, "p", "move of P", unit, each)
    if output_turns(study.linkage.mechanism):
        theta = f"theta{study.output}"
        what = f"turn of link {study.output}"
        turns = {dimension: f"{theta}_{dimension}_deg" for dimension in _of_loops(study.linkage)}
        plots += _plots(columns, theta, what, "deg", turns)
    facts = (Fact("tolerance", "each dimension is off by", off, unit), *_facts(study, off))
    notes = ("the driver angle is held; moves are linear in the tolerance, without limit in dead positions",)
    return Section("tolerance", "Inexact dimensions", facts, {"tolerance": table(columns)}, plots, notes)


def _plots(columns: Columns, key: str, what: str, unit: str, each: dict[str, str]) -> tuple[Plot, ...]:
    """Displacements by each dimension alone, and by all of them."""
    ending = "_deg" if unit == "deg" else ""
    together = {"worst": f"{key}_worst{ending}", "root of squares": f"{key}_rms{ending}"}
    return (
        curves(columns, f"tolerance-of-{key}", f"{what}, one dimension off", unit, each),
        curves(columns, f"tolerance-of-{key}-all", f"{what}, all dimensions off", unit, together),
    )


def _columns(state: Kinematics, off: float) -> Columns:
    found = made_moves(state.linkage, state.theta2, off)
    columns: dict[str, FloatArray] = {
        f"p_{dimension}": found.point[:, k] for k, dimension in enumerate(state.linkage.mechanism.dimensions)
    }
    columns |= {"p_worst": found.point_worst, "p_rms": found.point_rms}
    if not output_turns(state.linkage.mechanism):
        return columns
    theta = f"theta{state.linkage.mechanism.links[-1].number}"
    columns |= {
        f"{theta}_{dimension}_deg": np.degrees(found.theta4[:, k])
        for k, dimension in enumerate(_of_loops(state.linkage))
    }
    return columns | {
        f"{theta}_worst_deg": np.degrees(found.theta4_worst),
        f"{theta}_rms_deg": np.degrees(found.theta4_rms),
    }


def _of_loops(linkage: Linkage) -> tuple[str, ...]:
    """The dimensions that affect the rotation of links: all but the position of P; they are the first."""
    return tuple(name for name in linkage.mechanism.dimensions if name not in ("u", "v"))


def _facts(study: LinkageStudy, off: float) -> Iterator[Fact]:
    if not study.sweep.turns:  # infinite in dead positions
        return

    def rows(state: Kinematics) -> FloatArray:
        found = made_moves(state.linkage, state.theta2, off)
        moves = (found.point_worst, found.point_rms, found.theta4_worst, found.theta4_rms)
        return np.stack([*moves, *found.point.T])

    values, places = turn_peaks(study, rows)
    what = [("p", "P", study.spec.unit, 1.0)]
    if output_turns(study.linkage.mechanism):
        what.append((f"theta{study.output}", f"link {study.output}", "deg", 180 / np.pi))
    for k, (key, part, unit, scale) in enumerate(what):
        for j, (name, how) in enumerate(_ALL.items()):
            label = f"largest {'move' if key == 'p' else 'turn'} of {part}, all off: {how}"
            ending = "_deg" if unit == "deg" else ""
            yield Fact(f"tolerance_{key}_{name}{ending}", label, float(values[2 * k + j]) * scale, unit)
            if name == "worst":
                at = degrees(float(places[2 * k]))
                yield Fact(f"tolerance_{key}_worst_theta2_deg", f"{label}, at theta2", at, "deg")
    most = int(np.argmax(values[4:] >= (1 - _SAME) * values[4:].max()))  # of equals the first
    label = "dimension that moves P most"
    yield Fact("tolerance_dimension", label, study.linkage.mechanism.dimensions[most])
    yield Fact("tolerance_dimension_move", f"{label}: by", float(values[4 + most]), study.spec.unit)
