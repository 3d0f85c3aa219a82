"""The analysis of one linkage: tables over the motion, extremes, a summary, sections."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from grashof.analysis import GrashofClass, Masses, grashof_class, solve_position
from grashof.analysis.curves.coupler_curve import smooth_polygon
from grashof.problems import LinkageSpec
from grashof.problems.values.arrays import FloatArray
from grashof.sections import sections_of
from grashof.sections.places import centres_of
from grashof.study.asked import Asked
from grashof.study.quantities import Quantity, dynamic_quantities, kinematic_quantities, table_of
from grashof.study.section import Fact, Section
from grashof.study.study import LinkageStudy
from grashof.study.sweep import Sweep, dead_positions_unwarned
from grashof.survey.extremes import extremes_table
from grashof.survey.facts import facts_of


@dataclass(frozen=True, slots=True, eq=False)
class LinkageReport:
    """The report on a linkage.

    Parameters
    ----------
    sweep : Sweep
        The analysed motion.
    masses : Masses, optional
    facts : tuple of Fact
    tables : mapping of str to DataFrame
        "kinematics" and, with masses, "dynamics": a row for each driver angle; "extremes".
    notes : tuple of str
        Remarks on limits of the motion.
    sections : tuple of Section
        Further results by subject.
    drawn : mapping of str to DataFrame
        The tables over the driver angle with the rows that curves need.
    """

    sweep: Sweep
    masses: Masses | None
    facts: tuple[Fact, ...]
    tables: Mapping[str, pd.DataFrame]
    notes: tuple[str, ...]
    sections: tuple[Section, ...] = ()
    drawn: Mapping[str, pd.DataFrame] = field(default_factory=dict)


def report_on(spec: LinkageSpec, asked: Asked | None = None) -> LinkageReport:
    """Analyse a linkage over the entire motion of its driver on its own assembly.

    Parameters
    ----------
    spec : LinkageSpec
    asked : Asked, optional
        Options, such as further sections.

    Returns
    -------
    LinkageReport

    Raises
    ------
    ProblemError
        The linkage closes at no driver angle, or a speed is not finite or beyond 1e20.
    """
    study = LinkageStudy.of(spec, Asked() if asked is None else asked)
    sweep, masses = study.sweep, study.masses
    with dead_positions_unwarned():
        states, quantities = sweep.states(), kinematic_quantities(spec)
        tables = {"kinematics": table_of(quantities, states)}
        if dynamic := dynamic_quantities(study):
            tables["dynamics"] = table_of(dynamic, states)
        tables["extremes"] = extremes_table(sweep, quantities + dynamic)
        drawn = _drawn(sweep, {"kinematics": quantities, "dynamics": dynamic}, tables)
        facts = tuple(facts_of(study, tables))
        sections = sections_of(study)
    return LinkageReport(sweep, masses, facts, tables, _notes(sweep), sections, drawn)


def _drawn(
    sweep: Sweep, quantities: Mapping[str, list[Quantity]], tables: Mapping[str, pd.DataFrame]
) -> dict[str, pd.DataFrame]:
    states = sweep.states_drawn()
    known = {name: tables[name] for name in quantities if name in tables}
    if sum(len(state.theta2) for state in states) == len(known["kinematics"]):
        return known
    return {name: table_of(quantities[name], states) for name in known}


def _notes(sweep: Sweep) -> tuple[str, ...]:
    if sweep.turns:
        return ()
    between = " and ".join(f"{np.degrees(low):.6g} to {np.degrees(high):.6g}" for low, high in sweep.ranges)
    change = grashof_class(sweep.spec.linkage) is GrashofClass.CHANGE_POINT
    why = "links 3 and 4 may go either way there" if change else "rates and forces grow without bound there"
    linkage = sweep.spec.linkage
    signs = [getattr(linkage, row.name) for row in linkage.mechanism.parameters if row.kind == "sign"]
    assembly = f"shown is assembly {' '.join(f'{int(sign):+d}' for sign in signs)}"
    return (f"dead positions bound the driver's motion, {between} deg: {why}; {assembly}",)


def mass_tracks(report: LinkageReport) -> dict[str, FloatArray]:
    """Tracks (N, 2) of the centres of mass of each link and of all; without masses, of points halfway."""
    study, angles = LinkageStudy(report.sweep), report.sweep.angles()
    with dead_positions_unwarned():
        fine = (smooth_polygon(lambda t: solve_position(study.linkage, t).b, each)[0] for each in angles)
        motions = [centres_of(study, report.sweep.state(each)) for each in fine]
    names = {key: "all links" if key == "g" else f"link {key.removeprefix('g')}" for key in motions[0]}
    return {name: study.joined([motion[key].position for motion in motions]) for key, name in names.items()}
