"""The greatest loads on the bars and pins of a linkage in its motion, and their safety factors."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from grashof.analysis.forces.bars import bar_lengths
from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.joints import Joint, pins_of
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.analysis.numerics.peaks import peaks
from grashof.analysis.strength.along_bar import Along
from grashof.analysis.strength.strength import governing_measure, pin_measures, strength_at
from grashof.analysis.strength.structure import MEASURES, Structure
from grashof.problems import AssemblyError, DeadPositionWarning, Linkage
from grashof.problems.values.arrays import FloatArray

Motion = Callable[[FloatArray], Kinematics]
_BUCKLING = {
    "buckling": "buckling in the plane of motion",
    "buckling_across": "buckling out of the plane of motion",
}


@dataclass(frozen=True, slots=True)
class StrengthPeak:
    """The greatest value of a measure over the motion.

    Parameters
    ----------
    key, label, unit : str
        Those of the `Measure`.
    part : str
        "link 2", or the joint: "O2".
    value : float
        Infinite where the motion touches a dead position.
    place : float
        The argument of the motion: driver angle, rad.
    at : float, length
        Where along the bar, from its link's origin; NaN of a pin, and of an infinite value.
    """

    key: str
    label: str
    unit: str
    part: str
    value: float
    place: float
    at: float


@dataclass(frozen=True, slots=True)
class SafetyFactor:
    """The strength of a part over its greatest load in the motion.

    Parameters
    ----------
    key, label : str
        The kind of failure: "yield", "buckling", "buckling_across", "pin_shear" or "bearing".
    part : str
        "link 2" or "O2".
    value : float
        Above 1 it holds; infinite without load.
    limit : float
        Its strength, Pa or N.
    place : float
        Where in the motion, as of a `StrengthPeak`.
    at : float, length
        Where along the bar; NaN of a pin.
    """

    key: str
    label: str
    part: str
    value: float
    limit: float
    place: float
    at: float


@dataclass(frozen=True, slots=True)
class StrengthSummary:
    """Peaks and safety factors of a motion.

    Parameters
    ----------
    peaks : tuple of StrengthPeak
        Of the links that are bars and the joints that are pins, in turn.
    factors : tuple of SafetyFactor
        Of the same; none without strengths.
    """

    peaks: tuple[StrengthPeak, ...]
    factors: tuple[SafetyFactor, ...]

    @property
    def worst(self) -> SafetyFactor | None:
        """The least safety factor of all; None without strengths."""
        return min(self.factors, key=lambda factor: factor.value, default=None)

    @property
    def worst_bar(self) -> StrengthPeak:
        """The peak of `governing_measure` in the bar where it is highest."""
        key = governing_measure({peak.key for peak in self.peaks})
        return max((peak for peak in self.peaks if peak.key == key), key=lambda peak: peak.value)

    def peak(self, key: str, part: str) -> StrengthPeak:
        """The peak of a measure of "link 2" or "O2"; KeyError where there is none."""
        return {(peak.key, peak.part): peak for peak in self.peaks}[key, part]


def strength_over(structure: Structure, motion: Motion, stretches: Sequence[FloatArray]) -> StrengthSummary:
    """Greatest loads on bars and pins in a motion, and their safety factors.

    Parameters
    ----------
    structure : Structure
        Of a single linkage.
    motion : callable
        From driver angles, or whatever else it runs over, shape (N,), to a `Kinematics`.
    stretches : sequence of ndarray, shape (N,)
        Ascending samples of each interval of the motion, such as of `driver_samples`.

    Returns
    -------
    StrengthSummary

    Raises
    ------
    AssemblyError
        The linkage cannot close in between.

    Examples
    --------
    >>> from grashof.analysis import Loads, driver_samples, solve_kinematics, uniform_bars
    >>> from grashof.problems import FourBar, SectionSpec, StrengthSpec
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> steel = StrengthSpec(235e6, 210e9, pin_diameter=0.1)
    >>> structure = Structure(
    ...     uniform_bars(jack, 312), Loads(gravity=(0, -9.81)), SectionSpec(0.2, 0.2), steel
    ... )
    >>> turn = [driver_samples(jack, 0.0, 2 * np.pi)]
    >>> found = strength_over(structure, lambda angle: solve_kinematics(jack, angle, 2 * np.pi / 3), turn)
    >>> found.worst_bar.part, round(found.worst.value, 2)
    ('link 2', 12.99)
    """
    with warnings.catch_warnings(action="ignore", category=DeadPositionWarning):
        linkage = _closing(motion, stretches)
        lengths, pins = bar_lengths(linkage), pins_of(linkage)
        found = [peak for link in lengths for peak in _bar_peaks(structure, motion, stretches, link)]
        found += _pin_peaks(structure, motion, stretches, linkage)
    return StrengthSummary(tuple(found), tuple(_factors(structure, lengths, pins, found)))


def _closing(motion: Motion, stretches: Sequence[FloatArray]) -> Linkage:
    """The linkage, which has to close all the way; at the very ends rounding may open it."""
    for samples in stretches:
        state = motion(samples[1:-1])
        is_open = np.isnan(state.turning[-1].theta)
        if is_open.any():
            open_at = np.degrees(np.broadcast_to(state.theta2, state.shape)[is_open][0])
            raise AssemblyError(f"the linkage cannot close at driver angle {open_at:.6g} deg")
    return state.linkage


def _bar_peaks(
    structure: Structure, motion: Motion, stretches: Sequence[FloatArray], link: int
) -> list[StrengthPeak]:
    def measures(places: FloatArray) -> dict[str, Along]:
        return dict(strength_at(motion(places), structure, links=[link]).bars[link])

    def values(places: FloatArray) -> FloatArray:
        return np.stack([along.value for along in measures(places).values()])

    greatest, places = peaks(values, stretches)
    along = measures(places)
    return [
        _peak(key, f"link {link}", greatest[row], places[row], along[key].at[row])
        for row, key in enumerate(along)
    ]


def _pin_peaks(
    structure: Structure, motion: Motion, stretches: Sequence[FloatArray], linkage: Linkage
) -> list[StrengthPeak]:
    joints = pins_of(linkage)

    def values(places: FloatArray) -> FloatArray:
        found = inverse_dynamics(motion(places), structure.masses, structure.loads)
        return np.stack([found.joint_force(joint) for joint in joints])

    greatest, places = peaks(values, stretches)
    pins = pin_measures(linkage, dict(zip(joints, greatest, strict=True)), structure)
    return [
        _peak(key, joint.name, float(value), places[row], np.nan)
        for row, (joint, measures) in enumerate(pins.items())
        for key, value in measures.items()
    ]


def _factors(
    structure: Structure, lengths: Mapping[int, float], pins: Sequence[Joint], peaks: Sequence[StrengthPeak]
) -> Iterator[SafetyFactor]:
    """Safety factors of the links (of lengths between their joints), then of the pins."""
    strength, by_part = structure.strength, {(peak.part, peak.key): peak for peak in peaks}
    if strength is None:
        return

    def factor(key: str, label: str, part: str, measure: str, limit: float) -> SafetyFactor:
        peak = by_part[part, measure]
        value = limit / peak.value if peak.value > 0 else np.inf
        return SafetyFactor(key, label, part, value, limit, peak.place, peak.at)

    for link, length in lengths.items():
        part = f"link {link}"
        yield factor("yield", "yield", part, "stress", strength.yield_stress)
        for key, load in structure.buckling_loads(link, length).items():
            yield factor(key, _BUCKLING[key], part, "thrust", float(load))
    for joint in pins if strength.pin_diameter is not None else ():
        yield factor("pin_shear", "shear of the pin", joint.name, "pin_shear", strength.shear_limit)
        yield factor("bearing", "bearing pressure", joint.name, "bearing", strength.bearing_limit)


def _peak(key: str, part: str, value: float, place: float, at: float) -> StrengthPeak:
    measure = MEASURES[key]
    at = float(at) if np.isfinite(value) else np.nan
    return StrengthPeak(key, measure.label, measure.unit, part, float(value), float(place), at)
