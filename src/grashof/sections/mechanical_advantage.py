"""What a torque of the driver is worth at the output and at P, and what holds the linkage at rest."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis import Kinematics, advantage, holding, output_stroke
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.study.samples import Columns, curves, over_driver, table
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.study.turn import degrees, turn_extremes

_STANDS = 1e-9  # |omega4 / omega2| at which the output stands


def mechanical_advantage(study: LinkageStudy) -> Section:
    """Velocity ratio, mechanical advantage and force ratio; with weights or loads what holds them."""
    columns, n = over_driver(study, lambda state: _ratios(study, state)), study.output
    plots = [
        curves(columns, "velocity-ratio", f"velocity ratio ω{n} / ω2", "", {"ratio": "velocity_ratio"}),
        curves(columns, "torque-ratio", f"mechanical advantage T{n} / T2", "", {"ratio": "torque_ratio"}),
        curves(columns, "force-ratio", "force at P for a force on A", "", {"ratio": "force_ratio"}),
    ]
    notes = [f"friction is left out; T{n} is what link {n} gives, the force at P acts along its path"]
    if "holding_torque" in columns:
        plots += _holding_plots(columns, n)
        notes.append("each holding torque, moment and force keeps the linkage at rest by itself")
    facts = tuple(_facts(study))
    key, title = "mechanical-advantage", "Mechanical advantage"
    return Section(key, title, facts, {key: table(columns)}, tuple(plots), tuple(notes))


def _ratios(study: LinkageStudy, state: Kinematics) -> Columns:
    found = advantage(study.linkage, state.theta2)
    columns: dict[str, FloatArray] = {
        "velocity_ratio": found.velocity_ratio,
        "torque_ratio": found.torque_ratio,
        "p_way": found.way,
        "force_ratio": found.force_ratio,
    }
    masses, loads = study.masses, study.loads
    if masses is None or not (loads.any or loads.gravity_vector().any()):
        return columns
    held = holding(study.linkage, state.theta2, masses, loads)
    metre, sense = study.metre, -1.0 if study.sweep.speed_rpm < 0 else 1.0
    return columns | {
        "holding_torque": held.torque * metre**2,
        f"holding_moment_on_{study.output}": held.moment * metre**2,
        "holding_force_at_p": sense * held.force * metre,
        "holding_force": held.force[:, None] * held.direction * metre,
    }


def _holding_plots(columns: Columns, n: int) -> Iterator[Plot]:
    for key, what in (("torque", "torque on link 2"), ("moment", f"moment on link {n}")):
        column = "holding_torque" if key == "torque" else f"holding_moment_on_{n}"
        yield curves(columns, f"holding-{key}", f"what holds it at rest: {what}", "N m", {key: column})
    forces = {"along its path": "holding_force_at_p", "x": "holding_force_x", "y": "holding_force_y"}
    yield curves(columns, "holding-force", "what holds it at rest: force at P", "N", forces)


def _facts(study: LinkageStudy) -> Iterator[Fact]:
    linkage, n = study.linkage, study.output
    if study.sweep.turns:
        found = turn_extremes(study, lambda state: advantage(linkage, state.theta2).velocity_ratio)
        for name, ratio, at in (("least", found.low, found.at_low), ("largest", found.high, found.at_high)):
            label = f"velocity ratio omega{n} / omega2, {name}"
            yield Fact(f"velocity_ratio_{name}", label, ratio)
            yield Fact(f"velocity_ratio_{name}_theta2_deg", f"{label}: theta2", degrees(at), "deg")
        if most := max(abs(found.low), abs(found.high)):
            yield Fact("mechanical_advantage_least", f"mechanical advantage |T{n} / T2|, least", 1 / most)
    if len(linkage.mechanism.dyads) == 1:
        stands = output_stroke(linkage).theta2
    else:
        stands = np.concatenate([each.theta2 for each in study.limit_positions()]) % TURN
    stands = np.sort(stands[np.abs(advantage(linkage, stands).velocity_ratio) < _STANDS])
    for number, at in enumerate(stands, start=1):
        label = f"mechanical advantage without limit, {number}: theta2"
        yield Fact(f"toggle_{number}_theta2_deg", label, degrees(at), "deg")
