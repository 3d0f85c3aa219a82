"""The linkage with a free driver: where it stays at rest, and how it moves when it is released."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from grashof.analysis import (
    Energies,
    Equilibria,
    FreeResponse,
    Masses,
    energies,
    equilibria,
    free_response,
    solve_position,
)
from grashof.problems import AssemblyError, ProblemError, SolverError
from grashof.problems.values.arrays import TURN
from grashof.problems.values.checks import number_within
from grashof.study.samples import TIME
from grashof.study.section import Fact, Plot, Section, angle_fact
from grashof.study.study import LinkageStudy

_NOTES = (
    "the driver is free, friction is left out",
    "natural frequencies are of small swings without damping",
)
SECONDS = 5.0
_ROWS = (200, 2000)  # least and greatest number of steps of the table
_PER_SECOND = 100
_LONGEST = 3600.0  # s


def equilibrium(study: LinkageStudy) -> Section | None:
    """Equilibrium positions under weights, springs and loads; None without any of these."""
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
    table = pd.concat([_equilibrium_rows(study, each) for each in found], ignore_index=True)
    tables = {"equilibrium": table} if len(table) else {}
    return Section("equilibrium", "Equilibrium", tuple(_equilibrium_facts(table)), tables, (), _NOTES)


def _equilibrium_rows(study: LinkageStudy, found: Equilibria) -> pd.DataFrame:
    state, frequency = solve_position(study.linkage, found.theta2), found.frequency
    with np.errstate(divide="ignore"):
        period = 1 / frequency
    return pd.DataFrame({
        "theta2_deg": np.degrees(found.theta2).round(9),
        **{  # of the second links of all dyads
            f"theta{link.number}_deg": np.degrees(state.angles[link.number])
            for link in study.linkage.mechanism.links[3::2]
        },
        "p_x": state.p[:, 0],
        "p_y": state.p[:, 1],
        "stable": found.stiffness > 0,
        "stiffness_nm_per_rad": found.stiffness * study.metre**2,
        "inertia_kg_m2": found.inertia * study.metre**2,
        "frequency_hz": frequency,
        "period_s": period,
    })  # fmt: skip


def _equilibrium_facts(table: pd.DataFrame) -> Iterator[Fact]:
    yield Fact("equilibria", "equilibrium positions", len(table))
    for number, row in enumerate(table.to_dict("records"), start=1):
        kind = "stable" if row["stable"] else "unstable"
        label = f"equilibrium {number}, {kind}: theta2"
        yield Fact(f"equilibrium_{number}_theta2_deg", label, float(row["theta2_deg"]), "deg")
        if np.isfinite(row["frequency_hz"]):
            label = f"equilibrium {number}: natural frequency"
            yield Fact(f"equilibrium_{number}_frequency", label, float(row["frequency_hz"]), "Hz")


def release(study: LinkageStudy) -> Section | None:
    """Free motion from a driver angle; None unless it is requested."""
    asked = study.asked
    if asked.release_deg is None:
        if asked.release_rpm is not None:
            raise ProblemError("release_rpm does not go without release; it is the speed at that angle")
        return None
    given, masses = study.spec.dynamics, study.masses
    if masses is None or given is None:
        raise ProblemError("release needs masses; [dynamics] states none")
    if any(load.over == "time" for load in given.loads):
        raise ProblemError("release does not go with a load over time; it may be over theta2 or theta4")
    found = _response(study, masses, asked.release_deg)
    state, joule, parts = found.state, study.metre**2, energies(found.state, masses, study.loads)
    theta2 = np.degrees(state.theta2)
    p = state.p.position
    table = pd.DataFrame({
        "time": found.time,
        "theta2_deg": theta2,
        "omega2": state.omega2,
        "alpha2": state.alpha2,
        **{
            f"theta{link.number}_deg": np.degrees(np.unwrap(state.angular(link.number).theta))
            for link in study.linkage.mechanism.links[2:]
        },
        "p_x": p[:, 0],
        "p_y": p[:, 1],
        "kinetic": parts.kinetic.sum(axis=0) * joule,
        "weights": parts.weight * joule,
        "springs": parts.springs * joule,
        "energy": parts.total * joule,
    })  # fmt: skip

    def plot(key: str, title: str, unit: str, **columns: str) -> Plot:
        lines = {label: table[column].to_numpy() for label, column in columns.items()}
        return Plot(key, title, unit, lines, found.time, TIME, angles=theta2)

    plots = (
        plot("release-angle", "driver angle after the release", "deg", theta2="theta2_deg"),
        plot("release-speed", "speed of the driver after the release", "rad/s", omega2="omega2"),
        plot("release-energy", "energy after the release", "J", kinetic="kinetic", sum="energy"),
        Plot("release-path", "path of P after the release", study.spec.unit, {"P": p}, angles=theta2),
    )
    facts = tuple(_release_facts(study, found, parts))
    notes = ("the driver is free; a motor that the file states is uncoupled",)
    return Section("release", "Free motion", facts, {"release": table}, plots, notes)


def _response(study: LinkageStudy, masses: Masses, release_deg: float) -> FreeResponse:
    theta2 = np.radians(number_within(release_deg, -1e6, 1e6, "release"))
    speed = study.asked.release_rpm or 0.0
    omega2 = number_within(speed, -1e6, 1e6, "release_rpm") * TURN / 60
    seconds = SECONDS if study.asked.seconds is None else study.asked.seconds
    seconds = number_within(seconds, 1e-6, _LONGEST, "seconds")
    steps = int(np.clip(round(_PER_SECOND * seconds), *_ROWS))
    try:
        time = np.linspace(0.0, seconds, steps + 1)
        return free_response(study.linkage, masses, time, float(theta2), omega2, loads=study.loads)
    except (AssemblyError, SolverError, ProblemError) as error:
        raise ProblemError(f"release: {error}") from None


def _total_rotation(found: FreeResponse) -> float:
    """Total driver rotation in both senses, rad; constant deceleration in a step in which it turns back."""
    speed, step = found.state.omega2, np.diff(found.time)
    before, after = speed[:-1], speed[1:]
    back = before * after < 0
    turned = np.abs(np.diff(found.state.theta2))
    turned[back] = ((before**2 + after**2) / (2 * np.abs(after - before)))[back] * step[back]
    return float(turned.sum())


def _release_facts(study: LinkageStudy, found: FreeResponse, parts: Energies) -> Iterator[Fact]:
    state, loads = found.state, study.loads
    yield Fact("release_ending", "free motion ended because", str(found.ending))
    yield Fact("release_seconds", "free motion lasted", found.end, "s")
    turned = state.theta2[-1] - state.theta2[0]
    yield angle_fact("release_turned", "driver turned by, from beginning to end", turned)
    yield angle_fact("release_way", "driver turned, to and fro together", _total_rotation(found))
    kinetic = float(parts.kinetic.sum(axis=0).max())
    change = found.energy - found.energy[0]
    rubs = any(loads.friction.each(name).any() for name in ("viscous", "coulomb", "radius"))
    damped = any(spring.damping for spring in loads.springs)
    if not (rubs or damped or loads.forces or loads.moments):
        drift = float(np.abs(change).max()) / kinetic if kinetic > 0 else 0.0
        yield Fact("release_energy_drift", "energy kept but for a share of the kinetic energy of", drift)
    else:
        lost = float(-change[-1]) * study.metre**2
        yield Fact("release_energy_lost", "energy given to loads, dampers and friction", lost, "J")
