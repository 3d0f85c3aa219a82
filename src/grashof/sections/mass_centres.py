"""How the centres of mass of the links move, that of all of them together, and what the links weigh."""

from __future__ import annotations

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics, PointMotion, system_centre
from grashof.analysis.forces.bars import bars_of
from grashof.problems.values.arrays import FloatArray
from grashof.study.kinds import halfway
from grashof.study.samples import History, Samples
from grashof.study.section import Plot, Section
from grashof.study.study import LinkageStudy

_RATES = (("position", "", ""), ("velocity", "velocity", "/s"), ("acceleration", "acceleration", "/s²"))
_SIZES = {"velocity": "speed", "acceleration": "acceleration"}


def mass_centres(study: LinkageStudy) -> Section:
    """Positions, velocities and accelerations over the driver angle, and over time if that is asked for.

    Without masses: of the points halfway between the joints.
    """
    tables, plots = {}, list[Plot]()
    if not (weights := mass_table(study)).empty:
        tables["masses"] = weights
    history = History.of(study)
    for samples in (Samples.over_driver(study), *([Samples.over_time(study, history)] if history else [])):
        table, drawn = _motion(study, samples)
        tables[f"mass-centres{samples.mark}"] = table
        plots += drawn
    note = () if study.masses is not None else ("the file states no masses: points halfway between joints",)
    return Section("mass-centres", "Mass centres", (), tables, tuple(plots), note)


def mass_table(study: LinkageStudy) -> pd.DataFrame:
    """Mass of each link, kg, its centre in its frame, inertia about that; mass of all. Empty without masses.

    Of bars of stated density and section also their volume, m^3.
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
        rows.append(
            row
            | {"mass": float(body.mass), "centre_u": u, "centre_v": v}
            | {"inertia_kg_m2": float(body.inertia) * study.metre**2}
        )
    return pd.DataFrame([*rows, {"link": "all", "mass": float(masses.total)}])


def centres_of(study: LinkageStudy, state: Kinematics) -> dict[str, PointMotion]:
    """Motions of the centres of the links, g2 to g4, and with masses of the system's, g."""
    masses, found = study.masses, {}
    for link in (link.number for link in study.linkage.mechanism.links[1:]):
        at = halfway(study.linkage, link) if masses is None else masses.of(link).centre
        found[f"g{link}"] = state.point(link, at)
    if masses is not None and masses.total > 0:
        found["g"] = system_centre(masses, state)
    return found


def centre_labels(study: LinkageStudy) -> dict[str, str]:
    """The names of `centres_of` in words."""
    labels = {
        f"g{link.number}": f"the centre of link {link.number}" for link in study.linkage.mechanism.links[1:]
    }
    masses = study.masses
    return labels | ({"g": "the system's centre"} if masses is not None and masses.total > 0 else {})


def _motion(study: LinkageStudy, samples: Samples) -> tuple[pd.DataFrame, list[Plot]]:
    motions = [centres_of(study, state) for state in samples.states]
    columns, plots = dict[str, FloatArray](), []
    sizes: dict[str, dict[str, FloatArray]] = {name: {} for name in _SIZES}
    for name, label in centre_labels(study).items():
        for rate, suffix, per in _RATES:
            xy = study.joined([getattr(motion[name], rate) for motion in motions])
            keys = [f"{name}_{suffix}{'_' if suffix else ''}{axis}" for axis in "xy"]
            columns |= dict(zip(keys, xy.T, strict=True))
            if suffix:
                size = columns[f"{name}_{_SIZES[suffix]}"] = np.hypot(*xy.T)
                sizes[suffix][label.removeprefix("the ")] = size
            title, unit = f"{suffix or 'place'} of {label}", f"{study.spec.unit}{per}"
            plots.append(
                samples.plot(f"{name}-{suffix or 'place'}", title, unit, dict(zip("xy", xy.T, strict=True)))
            )
    for (rate, each), unit in zip(sizes.items(), ("/s", "/s²"), strict=True):
        size, key = _SIZES[rate], f"centres-{_SIZES[rate]}"
        plots.append(samples.plot(key, f"{size} of the centres", f"{study.spec.unit}{unit}", each))
    return samples.table(columns), plots
