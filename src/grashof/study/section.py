"""A section of an analysis: facts, tables and plots about one subject, as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from grashof.problems.values.arrays import FloatArray

DRIVER_ANGLE = "driver angle theta2 (deg)"


@dataclass(frozen=True, slots=True)
class Fact:
    """One line of a summary.

    Parameters
    ----------
    key : str
        Its name in files.
    label : str
        Label for the reader.
    value : float, int, str or bool
    unit : str
    aside : bool
        It is folded on a page.
    """

    key: str
    label: str
    value: float | int | str | bool
    unit: str = ""
    aside: bool = False


def angle_fact(key: str, label: str, angle: float | FloatArray) -> Fact:
    """A fact about an angle, rad, which is stated in deg; `_deg` is appended to the key."""
    return Fact(f"{key}_deg", label, float(np.degrees(angle)), "deg")


@dataclass(frozen=True, slots=True, eq=False)
class Plot:
    """Curves over a common axis, or tracks in a plane.

    Parameters
    ----------
    key : str
        Its name in files, lower case with hyphens, unique in the analysis.
    title : str
    unit : str
        Of the values, and of both axes of tracks.
    series : mapping of str to ndarray
        By their labels: curves of shape (N,), or tracks of shape (N, 2); NaN where a line is broken.
    places : ndarray, shape (N,), optional
        Abscissae of curves. Without them the series are tracks, drawn with equal axes.
    over : str
        Label of the abscissa with its unit: `DRIVER_ANGLE` (deg), or such as "time (s)".
    points : mapping of str to ndarray, shape (K, 2)
        Single points: data to which a curve is fitted, or a track at chosen angles.
    angles : ndarray, shape (N,), optional
        Driver angles (deg) of the points of tracks, or of other abscissae: a mark then follows the linkage.
    bounded : bool
        No value grows without bound, however sharp the peaks between distant samples.
    """

    key: str
    title: str
    unit: str
    series: Mapping[str, FloatArray]
    places: FloatArray | None = None
    over: str = DRIVER_ANGLE
    points: Mapping[str, FloatArray] = field(default_factory=dict)
    angles: FloatArray | None = None
    bounded: bool = False

    @property
    def swings(self) -> bool:
        """Whether its abscissae are driver angles between dead positions, not a full turn."""
        if self.places is None or self.over != DRIVER_ANGLE or not len(self.places):
            return False
        known = np.isfinite(self.places)
        return not (known.all() and np.ptp(self.places) >= 360 - 1e-9)


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """The results of an analysis on one subject.

    Parameters
    ----------
    key : str
        "mass-centres": its name in files.
    title : str
        "Mass centres": its heading.
    facts : tuple of Fact
    tables : mapping of str to DataFrame
        By their names: "mass-centres" is written as table-mass-centres.csv.
    plots : tuple of Plot
    notes : tuple of str
        Remarks for the reader, a sentence each without its full stop.
    """

    key: str
    title: str
    facts: tuple[Fact, ...] = ()
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    plots: tuple[Plot, ...] = ()
    notes: tuple[str, ...] = ()
