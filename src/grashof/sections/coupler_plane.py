"""What the plane of the coupler does: its centrodes, inflection circle, and acceleration pole."""

from __future__ import annotations

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics, centrodes, coupler_circles, solve_position
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.study.samples import Columns, components, curves, over_driver, table, track
from grashof.study.section import Plot, Section
from grashof.study.study import LinkageStudy

_SHOWN = 2.0  # times the lengths of the links together: so far from A the pole is drawn
_NOTES = (
    "points of the coupler on the inflection circle pass a straight piece of their paths",
    "those on Bresse's circle have no tangential acceleration while the driver turns steadily",
)


def coupler_plane(study: LinkageStudy) -> Section:
    """Both centrodes; inflection circle and Bresse's at the driver angles asked for."""
    linkage, unit = study.linkage, study.spec.unit
    columns = over_driver(study, lambda state: _columns(study, state))
    reach = _SHOWN * float(linkage.lengths.sum())
    theta2 = columns["theta2_deg"]
    far = np.hypot(columns["moving_u"], columns["moving_v"]) > reach
    fixed, moving = track(columns, "fixed"), track(columns, "moving", "uv")
    pivots = {name.upper(): np.array([getattr(linkage, name)]) for name in linkage.mechanism.ground}
    # The B of an inverted slider-crank moves along its rod.
    frame = {name.upper(): _in_coupler(linkage, name) for name in linkage.mechanism.links[2].points}
    shown = [np.where(far[:, None], np.nan, points) for points in (fixed, moving)]
    circles, diameter = _circles(study, study.chosen), {"diameter": "inflection_diameter"}
    named = {name: place[None] for name, place in frame.items()}
    of_fixed, of_moving = (
        "fixed centrode: I13 in the frame",
        "moving centrode: I13 in the coupler, u along AB",
    )
    plots = (
        Plot("fixed-centrode", of_fixed, unit, {"I13": shown[0]}, points=pivots, angles=theta2),
        Plot("moving-centrode", of_moving, unit, {"I13": shown[1]}, points=named, angles=theta2),
        _circle_plot(study, circles),
        curves(columns, "inflection-diameter", "diameter of the inflection circle", unit, diameter),
    )
    tables = {"centrodes": table(columns), "coupler-circles": circles}
    return Section("coupler-plane", "Centrodes and inflection circle", (), tables, plots, _NOTES)


def _columns(study: LinkageStudy, state: Kinematics) -> Columns:
    rolling, circles = centrodes(study.linkage, state.theta2), coupler_circles(study.linkage, state.theta2)
    return {
        "fixed": rolling.fixed,
        "moving_u": rolling.moving[:, 0],
        "moving_v": rolling.moving[:, 1],
        "inflection": circles.inflection,
        "inflection_diameter": circles.inflection_diameter,
    }


def _in_coupler(linkage: Linkage, name: str) -> FloatArray:
    """A point of link 3 in its frame, shape (2,)."""
    if name in ("a", "b"):
        return np.array([0.0 if name == "a" else linkage.columns["r3"], 0.0], dtype=np.float64)
    return np.asarray(getattr(linkage, "coupler_point" if name == "p" else name))


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
    """Points of a circle through the pole that lie within reach of A; shape (N, 2)."""
    radius, span = float(np.hypot(*(centre - pole))), float(np.hypot(*(pole - a))) + reach
    if not (np.isfinite(radius) and radius > 0):
        return np.full((1, 2), np.nan)
    turn = np.linspace(np.arccos(min(1.0, span / (2 * radius))), np.pi / 2, 91)
    turn = (
        np.concatenate([-turn[::-1], [np.nan], turn]) if turn[0] > 0 else np.concatenate([-turn[:0:-1], turn])
    )
    angle = np.arctan2(*(centre - pole)[::-1]) + turn
    arc = pole + 2 * radius * np.cos(turn)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    near = np.hypot(*(arc - a).T) <= reach
    return np.where(near[:, None], arc, np.nan)
