"""Velocity and acceleration of P as tracks in a plane, and the jerk of P and of all driven links."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis import Kinematics
from grashof.study.samples import Columns, curves, over_driver, table, tracks
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.study.turn import degrees, turn_extremes, varies


def hodographs(study: LinkageStudy) -> Section:
    """Hodographs of P, its jerk, and the angular jerk of the links after the driver."""
    columns, unit = over_driver(study, _motion), study.spec.unit
    of_links = {f"link {link.number}": f"jerk{link.number}" for link in study.linkage.mechanism.links[2:]}
    of_p = {"x": "p_jerk_x", "y": "p_jerk_y", "size": "p_jerk"}
    plots = (
        _hodograph(columns, "velocity", f"{unit}/s"),
        _hodograph(columns, "acceleration", f"{unit}/s²"),
        curves(columns, "jerk-of-p", "jerk of P", f"{unit}/s³", of_p),
        curves(columns, "angular-jerk", "angular jerk", "rad/s³", of_links),
    )
    kept = {key: values for key, values in columns.items() if "velocity" not in key and "accel" not in key}
    return Section("hodographs", "Hodographs and jerk", tuple(_facts(study)), {"jerk": table(kept)}, plots)


def _hodograph(columns: Columns, rate: str, unit: str) -> Plot:
    return tracks(columns, f"hodograph-of-{rate}", f"hodograph: {rate} of P", unit, {"P": f"p_{rate}"})


def _motion(state: Kinematics) -> Columns:
    p, links = state.p, state.linkage.mechanism.links[2:]
    return {
        "p_velocity": p.velocity,
        "p_acceleration": p.acceleration,
        "p_jerk_x": p.jerk[:, 0],
        "p_jerk_y": p.jerk[:, 1],
        "p_jerk": np.hypot(p.jerk[:, 0], p.jerk[:, 1]),
        **{f"jerk{link.number}": state.angular(link.number).jerk + np.zeros(state.shape) for link in links},
    }


def _facts(study: LinkageStudy) -> Iterator[Fact]:
    if not study.sweep.turns:  # without limit towards dead positions
        return
    found = turn_extremes(study, lambda state: np.hypot(*state.p.jerk.T))
    yield Fact("p_jerk_largest", "jerk of P, largest", found.high, f"{study.spec.unit}/s3")
    label = "jerk of P, largest: theta2"
    if varies(found):
        yield Fact("p_jerk_largest_theta2_deg", label, degrees(found.at_high), "deg")
