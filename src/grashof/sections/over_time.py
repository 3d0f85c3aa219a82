"""The motion over time: angles, rates, points, torque and power against seconds, over several turns."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.study.kinds import turning
from grashof.study.quantities import dynamic_quantities, kinematic_quantities, table_of
from grashof.study.samples import TIME, History, Samples
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy


def over_time(study: LinkageStudy) -> Section | None:
    """The requested history; None unless it is requested."""
    history = History.of(study)
    if history is None:
        return None
    spec, samples = study.spec, Samples.over_time(study, history)
    quantities = table_of(kinematic_quantities(spec) + dynamic_quantities(study), [history.state])
    total = np.degrees(history.total)
    columns: dict[str, FloatArray] = {"theta2_total_deg": np.asarray(np.round(total, 12), dtype=np.float64)}
    columns |= {str(key): values.to_numpy() for key, values in quantities.items() if key != "theta2_deg"}
    turns = round(float(abs(total[-1] - total[0]) / 360), 12)
    facts = (
        Fact("history_seconds", "history over time", float(history.time[-1]), "s"),
        Fact("history_turns", "history over time: turns of the driver", turns),
    )
    tables = {"over-time": samples.table(columns)}
    plots = _plots(study, samples, columns)
    notes: tuple[str, ...] = ()
    if not history.complete:
        end = f"the history ends after {history.time[-1]:.6g} s"
        notes = (f"{end}, before the dead position that the driver reaches: it moves {study.reach}",)
    return Section("over-time", "Over time", facts, tables, plots, notes)


def _plots(study: LinkageStudy, samples: Samples, columns: dict[str, FloatArray]) -> tuple[Plot, ...]:
    unit = study.spec.unit
    moving, links = study.linkage.mechanism.moving, turning(study.linkage.mechanism)
    speeds, accelerations = (
        {name.upper(): f"{name}_{size}" for name in moving} for size in ("speed", "acceleration")
    )
    time, wrapped = sawtooth(samples.places, columns["theta2_total_deg"])
    driver = Plot("theta2-over-time", "driver angle theta2 over time", "deg", {"theta2": wrapped}, time, TIME)
    rows = [
        ("theta2-total", "driver angle, counted on", "deg", {"theta2": "theta2_total_deg"}),
        ("angles", "angles", "deg", {f"theta{n}": f"theta{n}_deg" for n in links}),
        ("angular-velocity", "angular velocity", "rad/s", {f"omega{n}": f"omega{n}" for n in links}),
        ("angular-acceleration", "angular acceleration", "rad/s²", {f"alpha{n}": f"alpha{n}" for n in links}),
        ("slide", "travel of the slide", unit, {"travel": "slide_travel"}),
        ("slide-velocity", "velocity of the slide", f"{unit}/s", {"velocity": "slide_velocity"}),
        ("p-place", "place of P", unit, {"x": "p_x", "y": "p_y"}),
        ("speed", "speed", f"{unit}/s", speeds),
        ("acceleration", "acceleration", f"{unit}/s²", accelerations),
        ("torque", "drive torque", "N m", {"torque": "torque"}),
        ("power", "drive power", "W", {"power": "power"}),
    ]  # fmt: skip
    return driver, *(
        samples.plot(key, title, of, drawn)
        for key, title, of, names in rows
        if (drawn := {label: columns[column] for label, column in names.items() if column in columns})
    )


def sawtooth(time: FloatArray, angle_deg: FloatArray) -> tuple[FloatArray, FloatArray]:
    """An increasing or decreasing angle (N,) in deg over s, reduced to 0 to 360, with breaks between turns.

    A break adds three points: the edge, NaN, the other edge; steps of a turn or more only have a gap.

    >>> time, angle = sawtooth(np.array([0.0, 1.0, 2.0]), np.array([180.0, 300.0, 420.0]))
    >>> time.tolist(), angle.tolist()
    ([0.0, 1.0, 1.5, 1.5, 1.5, 2.0], [180.0, 300.0, 360.0, nan, 0.0, 60.0])
    """
    turn = np.floor(angle_deg / 360)
    ends = np.flatnonzero(np.diff(turn))
    ahead = np.maximum(turn[ends], turn[ends + 1]) * 360
    with np.errstate(divide="ignore"):
        share = (ahead - angle_deg[ends]) / (angle_deg[ends + 1] - angle_deg[ends])
    at = time[ends] + share * (time[ends + 1] - time[ends])
    rising = turn[ends + 1] > turn[ends]
    edges = np.where(rising, 360.0, 0.0)
    edges[np.abs(turn[ends + 1] - turn[ends]) > 1] = np.nan
    where = np.repeat(ends + 1, 3)
    between = np.stack([edges, np.full(len(ends), np.nan), 360.0 - edges], axis=-1).ravel()
    return np.insert(time, where, np.repeat(at, 3)), np.insert(angle_deg - turn * 360, where, between)
