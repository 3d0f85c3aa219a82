"""The equations of inverse dynamics as a system: its matrix and solution at chosen driver angles."""

from __future__ import annotations

import numpy as np
import pandas as pd

from grashof.analysis import SystemOfEquations, inverse_dynamics, system_of_equations
from grashof.problems.values.arrays import FloatArray
from grashof.study.section import Fact, Section
from grashof.study.study import LinkageStudy

KEY = "equations"


def equations(study: LinkageStudy) -> Section | None:
    """The system at the driver angles asked for, or else at the first one, if it is asked for."""
    if not study.asked.wants(KEY):
        return None
    masses, title = study.masses, "System of equations"
    if masses is None:
        return Section(
            KEY, title, notes=("the file states neither masses nor loads, so there are no forces",)
        )
    theta2 = study.chosen
    state = study.sweep.state(theta2)
    system = system_of_equations(state, masses, study.loads)
    in_order = inverse_dynamics(state, masses, study.loads)
    apart = np.abs(system.solution[..., -1] - in_order.torque) * study.metre**2
    label = "system of equations: torque apart from that solved in order by up to"
    fact = Fact("equations_torque_difference", label, float(np.nanmax(apart, initial=0.0)), "N m")
    note = (
        "of each link the sum of forces is m a, and that of moments about its centre of mass I alpha; forces "
        "in N, arms in m, moments in N m"
    )
    tables = {KEY: equation_table(np.degrees(theta2), system, study.metre)}
    return Section(KEY, title, (fact,), tables, notes=(note,))


def equation_table(theta2_deg: FloatArray, system: SystemOfEquations, metre: float = 1.0) -> pd.DataFrame:
    """Three rows for each moving link and driver angle (N,): an equation each, and one of the unknowns.

    Arms are given in m, a length unit being `metre`, and forces in N.
    """
    count, rows = len(theta2_deg), len(system.equations)
    moment = np.arange(rows) % 3 == 2
    forces = np.array([name.startswith("F") for name in system.unknowns])
    arms = np.where(moment, metre, 1.0)[:, None] * np.where(forces, 1.0, 1 / metre)
    matrix = (system.matrix * arms + 0.0).reshape(-1, rows)
    columns: dict[str, object] = {
        "theta2_deg": np.repeat(np.round(theta2_deg, 12), rows),
        "equation": list(system.equations) * count,
    }
    columns |= {name: matrix[:, index] for index, name in enumerate(system.unknowns)}
    columns["right_side"] = (system.right_side * np.where(moment, metre**2, metre)).ravel()
    columns["unknown"] = list(system.unknowns) * count
    columns["solution"] = (system.solution * np.where(forces, metre, metre**2)).ravel()
    return pd.DataFrame(columns).replace([np.inf, -np.inf], np.nan)  # in a dead position
