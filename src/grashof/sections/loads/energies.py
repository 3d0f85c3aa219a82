"""The energy in the moving linkage, and who gives and takes it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis import Kinematics, Loads, Masses, energies, powers, solve_kinematics
from grashof.analysis.mechanism.driver_law import mean_in_time
from grashof.problems.values.arrays import FloatArray
from grashof.study.samples import Columns, curves, over_driver, table
from grashof.study.section import Fact, Section
from grashof.study.study import LinkageStudy
from grashof.study.turn import degrees, turn_extremes, varies

_CERTAIN = 1e-7  # share of the work put in within which an efficiency is known


def energy_section(study: LinkageStudy) -> Section | None:
    """Kinetic energy of each link, energy of weights and springs, and the powers that change them."""
    masses, loads = study.masses, study.loads
    if masses is None:
        return None
    columns = over_driver(study, lambda state: _columns(state, masses, loads, study.metre**2))
    numbers = [link.number for link in study.linkage.mechanism.links[1:]]
    kinetic = {f"link {n}": f"kinetic_{n}" for n in numbers} | {"together": "kinetic"}
    whole = {"kinetic": "kinetic", "weights": "weights", "springs": "springs", "sum": "energy"}
    given = {"drive": "drive_power", "loads": "load_power", "friction": "friction_power"}
    for labels in (whole, given):  # lines of what is not there would only be in the way
        for label, key in list(labels.items()):
            if label in ("springs", "loads", "friction") and not np.nan_to_num(columns[key]).any():
                del labels[label]
    plots = (
        curves(columns, "kinetic-energy", "kinetic energy", "J", kinetic),
        curves(columns, "energy", "energy", "J", whole),
        curves(columns, "powers", "power that changes the energy", "W", given),
    )
    notes = ("the energy of weights counts from the origin", "powers together are the rate of the energy")
    facts = (*_facts(study, masses), *_losses(study, masses, loads))
    return Section("energies", "Energies", facts, {"energies": table(columns)}, plots, notes)


def _columns(state: Kinematics, masses: Masses, loads: Loads, joule: float) -> Columns:
    found, given = energies(state, masses, loads), powers(state, masses, loads)
    none = np.zeros(state.shape)
    return {
        **{f"kinetic_{link}": each * joule for link, each in enumerate(found.kinetic, start=2)},
        "kinetic": found.kinetic.sum(axis=0) * joule,
        "weights": found.weight * joule + none,
        "springs": found.springs * joule + none,
        "energy": found.total * joule,
        "drive_power": given.drive * joule,
        "load_power": given.loads * joule + none,
        "friction_power": given.friction * joule + none,
    }


def _facts(study: LinkageStudy, masses: Masses) -> Iterator[Fact]:
    if not (study.sweep.turns and masses.total > 0):
        return
    found = turn_extremes(study, lambda state: energies(state, masses).kinetic.sum(axis=0))
    for name, value, at in (("least", found.low, found.at_low), ("largest", found.high, found.at_high)):
        yield Fact(f"kinetic_energy_{name}", f"kinetic energy, {name}", value * study.metre**2, "J")
        if varies(found):
            label = f"kinetic energy, {name}: theta2"
            yield Fact(f"kinetic_energy_{name}_theta2_deg", label, degrees(at), "deg")


def _losses(study: LinkageStudy, masses: Masses, loads: Loads) -> Iterator[Fact]:
    """What friction takes in a turn, and the efficiency that follows: of the work put in, what it leaves."""
    friction, law = study.spec.dynamics and study.spec.dynamics.friction, study.sweep.laws[0]
    if friction is None or not study.sweep.turns or not np.isfinite(law.duration):
        return

    def given(place: FloatArray) -> FloatArray:
        found = powers(solve_kinematics(study.linkage, *law.at_place(place)), masses, loads)
        return np.stack(np.broadcast_arrays(found.drive, found.loads, found.friction))

    mean, error = mean_in_time(study.linkage, law, given)
    put_in, lost = float(np.maximum(mean[:2], 0.0).sum()), -float(mean[2])
    if np.isfinite(lost) and 0 < lost <= put_in * (1 + _CERTAIN) and error.max() < _CERTAIN * put_in:
        work = lost * law.duration * study.metre**2
        yield Fact("friction_work", "work of friction in the joints, a turn", work, "J")
        left = 1 - lost / put_in
        yield Fact(
            "efficiency", "efficiency: work put in that friction leaves", left if left > _CERTAIN else 0.0
        )
