"""Joint forces: polar plots of those in the pins, and the system of equations that yields them."""

from __future__ import annotations

import numpy as np
import pandas as pd

from grashof.analysis import Dynamics, Kinematics, SystemOfEquations, inverse_dynamics, system_of_equations
from grashof.problems.values.arrays import FloatArray
from grashof.study.samples import Columns, over_driver, table, tracks
from grashof.study.section import Fact, Section
from grashof.study.study import LinkageStudy

_EQUATIONS = "equations"


def pin_forces(study: LinkageStudy) -> Section | None:
    """Polar plots of the pin forces, in global axes and in the frame of each link; None without masses."""
    masses, loads = study.masses, study.loads
    if masses is None:
        return None
    columns = over_driver(study, lambda s: _forces(s, inverse_dynamics(s, masses, loads), study.metre))
    kind = study.linkage.mechanism
    first = ", ".join(f"{joint.upper()} on {links[1]}" for joint, links in kind.joints.items())
    every = {joint.upper(): joint for joint in kind.joints}
    plots = [tracks(columns, "pin-forces", f"pin forces, global axes: {first}", "N", every)]
    for link in kind.links[1:]:
        joints = [joint for joint, links in kind.joints.items() if link.number in links]
        labels = {f"in {joint.upper()}": f"{joint}_on_{link.number}" for joint in joints}
        title = f"pin forces on link {link.number}, in its frame: u along it"
        plots.append(tracks(columns, f"pin-forces-on-{link.number}", title, "N", labels, "uv"))
    kept = {key: values for key, values in columns.items() if "_on_" in key or key in ("theta2_deg", "range")}
    note = "a bore wears where the force on its link points, a pin on the side away from the force on its own"
    return Section("pin-forces", "Pin forces", (), {"pin-forces": table(kept)}, tuple(plots), (note,))


def _forces(state: Kinematics, found: Dynamics, metre: float) -> Columns:
    columns: dict[str, FloatArray] = {}
    kind = state.linkage.mechanism
    numbers = {joint.links: number for number, joint in enumerate(kind.every_joint)}
    for joint, links in kind.joints.items():
        # Forces act on the first link, those of the ground on the second.
        force = found.forces[numbers[links]] * metre
        on = {links[0]: force, links[1]: -force} if links[0] != 1 else {links[1]: force}
        columns[joint] = on[links[1]]
        for link, each in on.items():
            turned = _in_frame(each, state.angular(link).theta)
            columns |= {f"{joint}_on_{link}_{axis}": part for axis, part in zip("uv", turned.T, strict=True)}
    return columns


def _in_frame(force: FloatArray, theta: FloatArray) -> FloatArray:
    cosine, sine = np.cos(theta), np.sin(theta)
    x, y = force.T
    return np.stack([cosine * x + sine * y, cosine * y - sine * x], axis=-1)


def equations(study: LinkageStudy) -> Section | None:
    """The system at the requested driver angles, by default the first; None unless it is requested."""
    if not study.asked.wants(_EQUATIONS):
        return None
    masses, title = study.masses, "System of equations"
    if masses is None:
        note = "the file states neither masses nor loads, so there are no forces"
        return Section(_EQUATIONS, title, notes=(note,))
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
    tables = {_EQUATIONS: equation_table(np.degrees(theta2), system, study.metre)}
    return Section(_EQUATIONS, title, (fact,), tables, notes=(note,))


def equation_table(theta2_deg: FloatArray, system: SystemOfEquations, metre: float = 1.0) -> pd.DataFrame:
    """Three rows for each moving link and driver angle (N,): an equation each, and one of the unknowns.

    Arms are in m, with the length unit of `metre`, and forces in N.
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
    return pd.DataFrame(columns).replace([np.inf, -np.inf], np.nan)  # in dead positions
