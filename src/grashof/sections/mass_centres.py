"""How the centres of mass of the links move, and that of all of them together."""

from __future__ import annotations

import numpy as np

from grashof.analysis import Kinematics, PointMotion, system_centre
from grashof.problems.values.arrays import FloatArray
from grashof.study.columns import line, table
from grashof.study.section import Plot, Section
from grashof.study.study import LinkageStudy

_RATES = (("position", "", ""), ("velocity", "velocity", "/s"), ("acceleration", "acceleration", "/s²"))


def mass_centres(study: LinkageStudy) -> Section:
    """Positions, velocities and accelerations over the driver angle.

    Without masses: of the points halfway between the joints.
    """
    states = study.states
    motions = [centres_of(study, state) for state in states]
    theta2 = study.joined([np.degrees(state.theta2) for state in states])
    columns: dict[str, FloatArray] = {"theta2_deg": theta2}
    plots = []
    for name, label in _labels(study).items():
        for rate, suffix, per in _RATES:
            xy = study.joined([getattr(motion[name], rate) for motion in motions])
            keys = [f"{name}_{suffix}{'_' if suffix else ''}{axis}" for axis in "xy"]
            columns |= dict(zip(keys, xy.T, strict=True))
            title, unit = f"{suffix or 'place'} of {label}", f"{study.spec.unit}{per}"
            lines = dict(zip("xy", map(line, xy.T), strict=True))
            plots.append(Plot(f"{name}-{suffix or 'place'}", title, unit, lines, theta2))
    note = () if study.masses is not None else ("the file states no masses: points halfway between joints",)
    return Section("mass-centres", "Mass centres", (), {"mass-centres": table(columns)}, tuple(plots), note)


def centres_of(study: LinkageStudy, state: Kinematics) -> dict[str, PointMotion]:
    """Motions of the centres by the names that `_labels` gives them."""
    masses, found = study.masses, {}
    for link in (link.number for link in study.linkage.LINKS[1:]):
        halfway = np.array([float(getattr(study.linkage, f"r{link}")) / 2, 0.0])
        found[f"g{link}"] = state.point(link, halfway if masses is None else masses.of(link).centre)
    if masses is not None and masses.total > 0:
        found["g"] = system_centre(masses, state)
    return found


def _labels(study: LinkageStudy) -> dict[str, str]:
    labels = {f"g{link.number}": f"the centre of link {link.number}" for link in study.linkage.LINKS[1:]}
    masses = study.masses
    return labels | ({"g": "the system's centre"} if masses is not None and masses.total > 0 else {})
