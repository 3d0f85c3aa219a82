"""Where the linkage stays at rest when its driver is free, and how it swings about there."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from grashof.analysis import Equilibria, equilibria, solve_position
from grashof.study.section import Fact, Section
from grashof.study.study import LinkageStudy

_NOTES = (
    "the driver is free, friction is left out",
    "natural frequencies are of small swings without damping",
)


def equilibrium(study: LinkageStudy) -> Section | None:
    """Equilibrium positions under weights, springs and loads; None where nothing of these acts."""
    masses, loads, given = study.masses, study.loads, study.spec.dynamics
    if masses is None or given is None or any(load.over == "time" for load in given.loads):
        return None
    if not loads.any and not (masses.total > 0 and loads.gravity_vector().any()):
        return None
    turns = study.sweep.turns
    found = [equilibria(study.linkage, masses, loads, *ends, closed=turns) for ends in study.sweep.ranges]
    if all(each.everywhere for each in found):
        facts = (Fact("equilibrium_everywhere", "at rest at every driver angle", True),)
        return Section("equilibrium", "Equilibrium", facts, notes=_NOTES[:1])
    table = pd.concat([_rows(study, each) for each in found], ignore_index=True)
    tables = {"equilibrium": table} if len(table) else {}
    return Section("equilibrium", "Equilibrium", tuple(_facts(table)), tables, (), _NOTES)


def _rows(study: LinkageStudy, found: Equilibria) -> pd.DataFrame:
    state, frequency = solve_position(study.linkage, found.theta2), found.frequency
    with np.errstate(divide="ignore"):
        period = 1 / frequency
    return pd.DataFrame({
        "theta2_deg": np.degrees(found.theta2).round(9),
        **{f"theta{link}_deg": np.degrees(state.angles[link]) for link in _shown(study)},
        "p_x": state.p[:, 0],
        "p_y": state.p[:, 1],
        "stable": found.stiffness > 0,
        "stiffness_nm_per_rad": found.stiffness * study.metre**2,
        "inertia_kg_m2": found.inertia * study.metre**2,
        "frequency_hz": frequency,
        "period_s": period,
    })  # fmt: skip


def _shown(study: LinkageStudy) -> tuple[int, ...]:
    """The second links of all dyads."""
    return tuple(link.number for link in study.linkage.mechanism.links[3::2])


def _facts(table: pd.DataFrame) -> Iterator[Fact]:
    yield Fact("equilibria", "equilibrium positions", len(table))
    for number, row in enumerate(table.to_dict("records"), start=1):
        kind = "stable" if row["stable"] else "unstable"
        label = f"equilibrium {number}, {kind}: theta2"
        yield Fact(f"equilibrium_{number}_theta2_deg", label, float(row["theta2_deg"]), "deg")
        if np.isfinite(row["frequency_hz"]):
            label = f"equilibrium {number}: natural frequency"
            yield Fact(f"equilibrium_{number}_frequency", label, float(row["frequency_hz"]), "Hz")
