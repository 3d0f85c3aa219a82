"""The cylinder that drives a design: length, lever angle and force over the task motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis import Verdict, solve_position, verify
from grashof.analysis.cylinder.lengths import cylinder_state
from grashof.analysis.judge.cylinder_drive import cylinder_force_peak, cylinder_forces, figures_of
from grashof.analysis.judge.over_task import motion_ends
from grashof.problems import Problem
from grashof.problems.values.arrays import FloatArray
from grashof.study.kinds import output_turns
from grashof.study.samples import Columns, curves, table
from grashof.study.section import Fact, Section, angle_fact
from grashof.study.study import LinkageStudy

KEY, _TITLE = "cylinder", "Cylinder"
_SAMPLES = 181
_NOTE = (
    "over the task motion; the lever angle is that between the cylinder and the arm of its pivot, on "
    "coupler and slider 90 deg less the angle between the cylinder and the path of its pivot"
)
_RATES = {
    "start": "at the first target",
    "end": "at the last target",
    "min": "where it is least",
    "max": "where it is greatest",
}


def cylinder(study: LinkageStudy) -> Section | None:
    """Length, rate, lever angle and, with dynamics, force; None where no cylinder drives the linkage."""
    driven, problem = study.spec.cylinder, study.spec.problem
    if driven is None or problem is None:
        return None
    verdict = verify(study.linkage, problem.task, problem.requirements, problem=problem, cylinder=driven)
    if not verdict.branch_ok:
        return None
    theta2 = np.linspace(*motion_ends(problem.task, verdict), _SAMPLES)
    over = _columns(study, problem, verdict, theta2)
    targets = table(_columns(study, problem, verdict, verdict.theta2))
    targets.insert(0, "target", np.arange(1, len(targets) + 1))
    unit = study.spec.unit
    plots = [
        curves(over, "cylinder-length", "length of the cylinder", unit, {"length": "length"}),
        curves(over, "cylinder-rate", "rate of the cylinder dL/dθ2", f"{unit}/rad", {"rate": "rate"}),
        curves(over, "cylinder-angle", "lever angle of the cylinder", "deg", {"angle": "angle_deg"}),
    ]
    notes = [_NOTE]
    if "output_rate" in over:
        title, shown = "rate of the cylinder dL/dθ4", {"rate": "output_rate"}
        plots.insert(2, curves(over, "cylinder-output-rate", title, f"{unit}/rad", shown))
        notes.append("dL/dθ4 is the moment arm of the cylinder's force on link 4")
    if "force" in over:
        plots.append(curves(over, "cylinder-force", "force of the cylinder", "N", {"force": "force"}))
        notes.append("positive forces push; mass and friction of the cylinder itself are left out")
    tables = {KEY: table(over), f"{KEY}-at-targets": targets}
    return Section(KEY, _TITLE, tuple(_facts(study, problem, verdict)), tables, tuple(plots), tuple(notes))


def _columns(study: LinkageStudy, problem: Problem, verdict: Verdict, theta2: FloatArray) -> Columns:
    if verdict.cylinder is None:
        return {}
    found = cylinder_state(verdict.cylinder, study.linkage, solve_position(study.linkage, theta2))
    columns: dict[str, FloatArray] = {
        "theta2_deg": np.degrees(theta2),
        "length": found.length,
        "rate": found.rate,
        **({"output_rate": found.output_rate} if output_turns(study.linkage.mechanism) else {}),
        "angle_deg": np.degrees(found.angle),
        "pivot_x": found.pivot[:, 0],
        "pivot_y": found.pivot[:, 1],
    }
    if problem.dynamics is not None:
        columns["force"] = cylinder_forces(study.linkage, problem, verdict, theta2)
    return columns


def _facts(study: LinkageStudy, problem: Problem, verdict: Verdict) -> Iterator[Fact]:
    driven, found, unit = verdict.cylinder, figures_of(study.linkage, problem.task, verdict), study.spec.unit
    if driven is None or found is None:
        return
    yield Fact("cylinder_on", "link that the cylinder acts on", driven.on)
    labels = ("base, x", "base, y", "pivot, u", "pivot, v")
    for (name, value), label in zip(driven.columns.items(), labels, strict=True):
        yield Fact(name, f"cylinder: {label}", value, unit)
    yield Fact("cylinder_closed", "cylinder: closed length", found.closed, unit)
    yield Fact("cylinder_open", "cylinder: open length", found.open, unit)
    yield Fact("cylinder_stroke", "cylinder: stroke", found.stroke, unit)
    yield Fact("cylinder_ratio", "cylinder: open over closed length", found.ratio)
    yield angle_fact("cylinder_angle_min", "cylinder: worst lever angle", found.angle_min)
    if output_turns(study.linkage.mechanism):
        for name, where in _RATES.items():
            label = f"cylinder: rate |dL/dθ4| {where}"
            yield Fact(f"cylinder_rate_{name}", label, getattr(found, f"rate_{name}"), f"{unit}/rad")
    if problem.dynamics is not None:
        peak = cylinder_force_peak(study.linkage, problem, verdict)
        yield Fact("cylinder_force_max", "cylinder: peak force", peak, "N")
