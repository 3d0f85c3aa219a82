"""The linkage at chosen driver angles: where everything is, how it moves, and a drawing of all of them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics, solve_position
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import LOOP_POINTS, Mechanism
from grashof.sections.mass_centres import centres_of
from grashof.study.quantities import dynamic_quantities, kinematic_quantities, table_of
from grashof.study.samples import components
from grashof.study.section import Plot, Section
from grashof.study.study import LinkageStudy

_SMALL = ("_x", "_y")


def positions(study: LinkageStudy) -> Section | None:
    """A row and a drawing for each driver angle that is asked for, if any is."""
    if not study.asked.at_deg:
        return None
    theta2 = study.in_range(study.asked.at_deg, "at_deg")
    state = study.sweep.state(theta2)
    tables = {"positions": position_table(study, state)}
    return Section("positions", "Chosen driver angles", (), tables, (_drawing(study, state),))


def position_table(study: LinkageStudy, state: Kinematics) -> pd.DataFrame:
    """A row for each driver angle of a state, shape (N,): angles, joints, P, centres, rates, torque."""
    quantities = kinematic_quantities(study.spec) + dynamic_quantities(study)
    # Of vectors other than positions the size says enough here; the other tables have their components.
    listed = [each for each in quantities if each.position or not each.key.endswith(_SMALL)]
    columns = {str(key): values.to_numpy() for key, values in table_of(listed, [state]).items()}
    for each in listed:
        if each.period is not None:  # chosen angles are no sequence to count on along
            columns[each.key] = (columns[each.key] + 180) % 360 - 180
    for name, motion in centres_of(study, state).items():
        columns |= components(name, motion.position)
    return pd.DataFrame(columns)


def _drawing(study: LinkageStudy, state: Kinematics) -> Plot:
    linkage = study.linkage
    places = {name: getattr(state, name).position for name in linkage.mechanism.moving}
    p = places["p"]
    places |= {name: np.broadcast_to(getattr(linkage, name), p.shape) for name in linkage.mechanism.ground}
    gap = np.full(p.shape, np.nan)
    bars = np.stack([places.get(name, gap) for name in _bars(linkage.mechanism)], axis=1)
    labels = [f"theta2 = {angle:.6g} deg" for angle in study.asked.at_deg]
    series: dict[str, FloatArray] = {"path of P": _path(study)}
    series |= {label: bars[number] for number, label in enumerate(labels)}
    pivots = {name.upper(): getattr(linkage, name)[None] for name in linkage.mechanism.ground}
    title = "the linkage at chosen driver angles"
    return Plot("positions", title, study.spec.unit, series, points={**pivots, "P": p})


def _bars(kind: Mechanism) -> list[str]:
    """Through which points the links are drawn, with a gap at "": the loops, then what links have beside."""
    drawn = ["o2"]
    for c, d, e in LOOP_POINTS[: len(kind.dyads)]:
        drawn += [*([""] if len(drawn) > 1 else []), c, e, *([d] if d in kind.points else [])]
    pairs = {frozenset(pair) for pair in pairwise(drawn)}
    for first, *others in (link.points for link in kind.links[1:]):
        if len(others) > 1:
            drawn += ["", first, *others[1:], others[0]]
        elif others and frozenset((first, *others)) not in pairs:
            drawn += ["", first, *others]
    return drawn


def _path(study: LinkageStudy) -> FloatArray:
    return study.joined([solve_position(study.linkage, angles).p for angles in study.sweep.angles()])
