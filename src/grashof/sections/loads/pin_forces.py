"""The forces in the pins as tracks in a plane: where they press, and where pins and bores wear."""

from __future__ import annotations

import numpy as np

from grashof.analysis import Dynamics, Kinematics, inverse_dynamics
from grashof.problems.values.arrays import FloatArray
from grashof.study.samples import Columns, over_driver, table, tracks
from grashof.study.section import Section
from grashof.study.study import LinkageStudy


def pin_forces(study: LinkageStudy) -> Section | None:
    """Polar plots of the joint forces: in global axes, and in the frame of each link."""
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
        # On the first link, of the ground on the second.
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
