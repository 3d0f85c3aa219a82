"""Positions: of the linkage at chosen driver angles, and of the centres of mass over the motion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics, PointMotion, solve_position, system_centre
from grashof.analysis.forces.bars import bars_of
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import LOOP_POINTS, Mechanism
from grashof.study.kinds import halfway
from grashof.study.quantities import dynamic_quantities, kinematic_quantities, table_of
from grashof.study.samples import History, Samples, components
from grashof.study.section import Plot, Section
from grashof.study.study import LinkageStudy

_RATES = (("position", "", ""), ("velocity", "velocity", "/s"), ("acceleration", "acceleration", "/s²"))
_SIZES = {"velocity": "speed", "acceleration": "acceleration"}
_SMALL = ("_x", "_y")


def mass_centres(study: LinkageStudy) -> Section:
    """Positions, velocities and accelerations over the driver angle, and over time if that is requested.

    Without masses those of the points halfway between the joints.
    """
    tables, plots = {}, list[Plot]()
    if not (weights := mass_table(study)).empty:
        tables["masses"] = weights
    history = History.of(study)
    for samples in (Samples.over_driver(study), *([Samples.over_time(study, history)] if history else [])):
        table, drawn = _centre_motion(study, samples)
        tables[f"mass-centres{samples.mark}"] = table
        plots += drawn
    note = () if study.masses is not None else ("the file states no masses: points halfway between joints",)
    return Section("mass-centres", "Mass centres", (), tables, tuple(plots), note)


def mass_table(study: LinkageStudy) -> pd.DataFrame:
    """Mass of each link, kg, its centre in the frame of the link, inertia about it; total mass.

    With density and section also the volumes, m^3; empty without masses.
    """
    masses, given = study.masses, study.spec.dynamics
    if masses is None or given is None or not masses.total > 0:
        return pd.DataFrame()
    rows, bars = list[dict[str, object]](), bars_of(study.linkage)
    for link in study.linkage.mechanism.links[1:]:
        body = masses.of(link.number)
        u, v = body.centre.tolist()
        row: dict[str, object] = {"link": f"{link.number}, {link.name}"}
        if given.density is not None and given.section is not None and link.number in bars:
            volume = given.section.areas[link.number - 2] * float(bars[link.number].reach)
            row |= {"density": given.density, "volume_m3": volume * study.metre**3}
        row |= {"mass": float(body.mass), "centre_u": u, "centre_v": v}
        rows.append(row | {"inertia_kg_m2": float(body.inertia) * study.metre**2})
    return pd.DataFrame([*rows, {"link": "all", "mass": float(masses.total)}])


def centres_of(study: LinkageStudy, state: Kinematics) -> dict[str, PointMotion]:
    """Motions of the centres of mass of the links, g2 to g4, and with masses of the system's, g."""
    masses, found = study.masses, {}
    for link in (link.number for link in study.linkage.mechanism.links[1:]):
        at = halfway(study.linkage, link) if masses is None else masses.of(link).centre
        found[f"g{link}"] = state.point(link, at)
    if masses is not None and masses.total > 0:
        found["g"] = system_centre(masses, state)
    return found


def centre_labels(study: LinkageStudy) -> dict[str, str]:
    """The names of `centres_of` in words."""
    masses, links = study.masses, study.linkage.mechanism.links[1:]
    labels = {f"g{link.number}": f"the centre of link {link.number}" for link in links}
    return labels | ({"g": "the system's centre"} if masses is not None and masses.total > 0 else {})


def _centre_motion(study: LinkageStudy, samples: Samples) -> tuple[pd.DataFrame, list[Plot]]:
    motions = [centres_of(study, state) for state in samples.states]
    columns, plots = dict[str, FloatArray](), []
    sizes: dict[str, dict[str, FloatArray]] = {name: {} for name in _SIZES}
    for name, label in centre_labels(study).items():
        for rate, suffix, per in _RATES:
            xy = study.joined([getattr(motion[name], rate) for motion in motions])
            columns |= components(f"{name}_{suffix}" if suffix else name, xy)
            if suffix:
                size = columns[f"{name}_{_SIZES[suffix]}"] = np.hypot(*xy.T)
                sizes[suffix][label.removeprefix("the ")] = size
            what, lines = suffix or "place", dict(zip("xy", xy.T, strict=True))
            title, unit = f"{what} of {label}", f"{study.spec.unit}{per}"
            plots.append(samples.plot(f"{name}-{what}", title, unit, lines))
    for (rate, each), unit in zip(sizes.items(), ("/s", "/s²"), strict=True):
        size, key = _SIZES[rate], f"centres-{_SIZES[rate]}"
        plots.append(samples.plot(key, f"{size} of the centres", f"{study.spec.unit}{unit}", each))
    return samples.table(columns), plots


def positions(study: LinkageStudy) -> Section | None:
    """A row and a drawing for each requested driver angle; None without any."""
    if not study.asked.at_deg:
        return None
    theta2 = study.in_range(study.asked.at_deg, "at_deg")
    state = study.sweep.state(theta2)
    tables = {"positions": position_table(study, state)}
    return Section("positions", "Chosen driver angles", (), tables, (_drawing(study, state),))


def position_table(study: LinkageStudy, state: Kinematics) -> pd.DataFrame:
    """A row for each driver angle of a state, shape (N,): angles, joints, P, centres, rates, torque."""
    quantities = kinematic_quantities(study.spec) + dynamic_quantities(study)
    # Vectors other than positions have their size only; the other tables have the components.
    listed = [each for each in quantities if each.position or not each.key.endswith(_SMALL)]
    columns = {str(key): values.to_numpy() for key, values in table_of(listed, [state]).items()}
    for each in listed:
        if each.period is not None:  # chosen angles are not in sequence
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
    """The points through which the links are drawn, "" for a gap: the loops, then further points of links."""
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
