"""The tables of motion and forces as sections, the first on the page of an analysis."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.study.kinds import forces_of, turning
from grashof.study.quantities import by_range
from grashof.study.section import Plot, Section
from grashof.survey.report import LinkageReport

_RATES = ("velocity", "s"), ("acceleration", "s²")
_MU = {"mu_deg": "μ", "mu_2_deg": "μ of loop 2"}
# Key, title and unit of a plot, and its columns with their labels.
Panel = tuple[str, str, str, Mapping[str, str]]


def motion_sections(report: LinkageReport) -> list[Section]:
    """Sections with plots only, of all columns of motion and forces over the driver angle.

    >>> from grashof.problems import load_linkage_spec
    >>> from grashof.survey import report_on
    >>> for section in motion_sections(report_on(load_linkage_spec("lufkin-c912d"))):
    ...     print(f"{section.title}: {', '.join(plot.key for plot in section.plots[:3])}")
    Angles and velocities: angles, angular-velocity, angular-acceleration
    Torque and power: torque-factor
    Points A, B and P: place-of-p, velocity-of-p, acceleration-of-p
    """
    table = pd.concat(list(report.drawn.values()), axis=1)
    table = table.loc[:, ~table.columns.duplicated()]
    theta2 = by_range(table, "theta2_deg")
    sections = []
    for key, title, panels in _groups(report.sweep.spec.unit, report.sweep.spec.linkage.mechanism):
        plots = tuple(
            Plot(name, heading, unit, {columns[each]: by_range(table, each) for each in known}, theta2)
            for name, heading, unit, columns in panels
            if (known := [each for each in columns if each in table])
        )
        if plots:
            sections.append(Section(key, title, plots=plots))
    return sections


def _groups(unit: str, kind: Mechanism) -> list[tuple[str, str, list[Panel]]]:
    """Key, title and plots of each section."""
    points, joints = {name: name.upper() for name in kind.moving}, forces_of(kind)
    speeds, accelerations = (
        {f"{name}_{size}": label for name, label in points.items()} for size in ("speed", "acceleration")
    )
    *others, last = sorted(points.values())
    every, links = ", ".join(points.values()), turning(kind)
    motion: list[Panel] = [
        ("angles", "angles", "deg", {f"theta{n}_deg": f"θ{n}" for n in links} | _MU),
        ("angular-velocity", "angular velocity", "rad/s", {f"omega{n}": f"ω{n}" for n in links}),
        ("angular-acceleration", "angular acceleration", "rad/s²", {f"alpha{n}": f"α{n}" for n in links}),
        ("slide", "travel of the slide", unit, {"slide_travel": "travel"}),
        *(
            (f"slide-{rate}", f"{rate} of the slide", f"{unit}/{per}", {f"slide_{rate}": rate})
            for rate, per in _RATES
        ),
        ("speeds", f"speed of {every}", f"{unit}/s", speeds),
        ("accelerations", f"acceleration of {every}", f"{unit}/s²", accelerations),
    ]
    power: list[Panel] = [
        (
            "torque-factor",
            "torque factor of the output arm",
            unit,
            {"torque_factor": "size", "torque_factor_signed": "signed"},
        ),
        ("torque", "drive torque", "N m", {"torque": "torque"}),
        ("power", "drive power", "W", {"power": "power"}),
    ]
    forces: list[Panel] = [
        ("joint-forces", "joint forces", "N", joints),
        ("slide-force", "force across the slide", "N", {"slide_force": "force"}),
        ("slide-moment", "moment that the slide bears", "N m", {"slide_moment": "moment"}),
        ("shaking-force", "shaking force", "N", _xy("shaking_force") | {"shaking_force": "size"}),
        ("shaking-moment", "shaking moment about O2", "N m", {"shaking_moment": "moment"}),
        *((name, f"force {name.upper()} in {joint}", "N", _xy(name)) for name, joint in joints.items()),
    ]
    places: list[Panel] = []
    for name, point in reversed(points.items()):
        places.append((f"place-of-{name}", f"place of {point}", unit, _xy(name)))
        for rate, per in _RATES:
            columns = _xy(f"{name}_{rate}")
            places.append((f"{rate}-of-{name}", f"{rate} of {point}", f"{unit}/{per}", columns))
    return [
        ("motion", "Angles and velocities", motion),
        ("power", "Torque and power", power),
        ("forces", "Forces", forces),
        ("points", f"Points {', '.join(others)} and {last}", places),
    ]


def _xy(name: str) -> dict[str, str]:
    return {f"{name}_{axis}": axis for axis in "xy"}
