"""The plane of the coupler: its centrodes and circles; hodographs and jerk of P."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics, centrodes, coupler_circles, solve_position
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.study.samples import Columns, components, curves, over_driver, table, track, tracks
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.study.turn import extreme_facts, turn_extremes

_SHOWN = 2.0  # times the sum of the link lengths: distance from A up to which the pole is drawn
_NOTES = (
    "points of the coupler on the inflection circle pass a straight piece of their paths",
    "those on Bresse's circle have no tangential acceleration while the driver turns steadily",
)


def coupler_plane(study: LinkageStudy) -> Section:
    """Both centrodes, and the inflection circle and Bresse's at the requested driver angles."""
    linkage, unit = study.linkage, study.spec.unit
    columns = over_driver(study, lambda state: _plane_columns(study, state))
    reach = _SHOWN * float(linkage.lengths.sum())
    theta2 = columns["theta2_deg"]
    far = np.hypot(columns["moving_u"], columns["moving_v"]) > reach
    fixed, moving = track(columns, "fixed"), track(columns, "moving", "uv")
    pivots = {name.upper(): np.array([getattr(linkage, name)]) for name in linkage.mechanism.ground}
    # The B of an inverted slider-crank moves along its rod.
    frame = {name.upper(): _in_coupler(linkage, name) for name in linkage.mechanism.links[2].points}
    shown = [np.where(far[:, None], np.nan, points) for points in (fixed, moving)]
    circles, diameter = _circles(study, study.chosen), {"diameter": "inflection_diameter"}
    of_fixed = "fixed centrode: I13 in the frame"
    of_moving = "moving centrode: I13 in the coupler, u along AB"
    plots = (
        Plot("fixed-centrode", of_fixed, unit, {"I13": shown[0]}, points=pivots, angles=theta2),
        Plot("moving-centrode", of_moving, unit, {"I13": shown[1]}, points=frame, angles=theta2),
        _circle_plot(study, circles),
        curves(columns, "inflection-diameter", "diameter of the inflection circle", unit, diameter),
    )
    tables = {"centrodes": table(columns), "coupler-circles": circles}
    return Section("coupler-plane", "Centrodes and inflection circle", (), tables, plots, _NOTES)


def _plane_columns(study: LinkageStudy, state: Kinematics) -> Columns:
    rolling, circles = centrodes(study.linkage, state.theta2), coupler_circles(study.linkage, state.theta2)
    return {
        "fixed": rolling.fixed,
        "moving_u": rolling.moving[:, 0],
        "moving_v": rolling.moving[:, 1],
        "inflection": circles.inflection,
        "inflection_diameter": circles.inflection_diameter,
    }


def _in_coupler(linkage: Linkage, name: str) -> FloatArray:
    """A point of link 3 in its frame, shape (1, 2)."""
    if name in ("a", "b"):
        return np.array([[0.0 if name == "a" else linkage.columns["r3"], 0.0]], dtype=np.float64)
    return np.reshape(getattr(linkage, "coupler_point" if name == "p" else name), (1, 2))


def _circles(study: LinkageStudy, angles: FloatArray) -> pd.DataFrame:
    found = coupler_circles(study.linkage, angles)
    columns = {"theta2_deg": np.degrees(angles).round(9)}
    for name in ("pole", "inflection", "bresse", "acceleration_pole"):
        columns |= components(name, getattr(found, name))
        if name in ("inflection", "bresse"):
            columns[f"{name}_diameter"] = getattr(found, f"{name}_diameter")
    return pd.DataFrame(columns).replace([np.inf, -np.inf], np.nan)


def _circle_plot(study: LinkageStudy, circles: pd.DataFrame) -> Plot:
    """The inflection circle and Bresse's at each angle, over the path of P where the coupler carries it."""
    tracks, points = dict[str, FloatArray](), dict[str, FloatArray]()
    if carried := "p" in study.linkage.mechanism.links[2].points:
        tracks["path of P"] = study.joined([state.p.position for state in study.states])
    for row in circles.to_dict("records"):
        at, state = f"{row['theta2_deg']:g}°", solve_position(study.linkage, np.radians(row["theta2_deg"]))
        places = {
            name: np.array([row[f"{name}_x"], row[f"{name}_y"]])
            for name in ("pole", "inflection", "bresse", "acceleration_pole")
        }
        for name, label in (("inflection", "inflection circle"), ("bresse", "Bresse's circle")):
            arc = _arc(places["pole"], places[name], state.a, float(study.linkage.lengths.sum()))
            if np.isfinite(arc).any():
                tracks[f"{label}, {at}"] = arc
        for name, label in (("pole", "I13"), ("acceleration_pole", "acceleration pole")):
            if np.isfinite(places[name]).all():
                points[f"{label}, {at}"] = places[name][None]
        if carried:
            points[f"P, {at}"] = state.p[None]
    title = "inflection circle and Bresse's circle"
    return Plot("inflection-circle", title, study.spec.unit, tracks, points=points)


def _arc(pole: FloatArray, centre: FloatArray, a: FloatArray, reach: float) -> FloatArray:
    """Points of a circle through the pole that lie within `reach` of A, shape (N, 2)."""
    radius, span = float(np.hypot(*(centre - pole))), float(np.hypot(*(pole - a))) + reach
    if not (np.isfinite(radius) and radius > 0):
        return np.full((1, 2), np.nan)
    turn = np.linspace(np.arccos(min(1.0, span / (2 * radius))), np.pi / 2, 91)
    other = [*-turn[::-1], np.nan] if turn[0] > 0 else -turn[:0:-1]
    turn = np.concatenate([other, turn])
    angle = np.arctan2(*(centre - pole)[::-1]) + turn
    arc = pole + 2 * radius * np.cos(turn)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    near = np.hypot(*(arc - a).T) <= reach
    return np.where(near[:, None], arc, np.nan)


def hodographs(study: LinkageStudy) -> Section:
    """Hodographs of P, its jerk, and the angular jerk of the links after the driver."""
    columns, unit = over_driver(study, _rates), study.spec.unit
    of_links = {f"link {link.number}": f"jerk{link.number}" for link in study.linkage.mechanism.links[2:]}
    of_p = {"x": "p_jerk_x", "y": "p_jerk_y", "size": "p_jerk"}
    plots = (
        _hodograph(columns, "velocity", f"{unit}/s"),
        _hodograph(columns, "acceleration", f"{unit}/s²"),
        curves(columns, "jerk-of-p", "jerk of P", f"{unit}/s³", of_p),
        curves(columns, "angular-jerk", "angular jerk", "rad/s³", of_links),
    )
    kept = {key: values for key, values in columns.items() if "velocity" not in key and "accel" not in key}
    facts = tuple(_jerk_facts(study))
    return Section("hodographs", "Hodographs and jerk", facts, {"jerk": table(kept)}, plots)


def _hodograph(columns: Columns, rate: str, unit: str) -> Plot:
    return tracks(columns, f"hodograph-of-{rate}", f"hodograph: {rate} of P", unit, {"P": f"p_{rate}"})


def _rates(state: Kinematics) -> Columns:
    p, links = state.p, state.linkage.mechanism.links[2:]
    return {
        "p_velocity": p.velocity,
        "p_acceleration": p.acceleration,
        "p_jerk_x": p.jerk[:, 0],
        "p_jerk_y": p.jerk[:, 1],
        "p_jerk": np.hypot(p.jerk[:, 0], p.jerk[:, 1]),
        **{f"jerk{link.number}": state.angular(link.number).jerk + np.zeros(state.shape) for link in links},
    }


def _jerk_facts(study: LinkageStudy) -> Iterator[Fact]:
    if not study.sweep.turns:  # without limit towards dead positions
        return
    found = turn_extremes(study, lambda state: np.hypot(*state.p.jerk.T))
    yield from extreme_facts("p_jerk", "jerk of P", found, f"{study.spec.unit}/s3", ends=("largest",))
