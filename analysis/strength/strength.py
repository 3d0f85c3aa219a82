"""Stress, pressure and deflection in the bars and pins of a linkage at a driver angle."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from grashof.analysis.forces.dynamics import Dynamics, inverse_dynamics
from grashof.analysis.forces.joints import Joint, pins_of
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.analysis.strength.along_bar import Along, deflection, greatest, greatest_deflection, greatest_of
from grashof.analysis.strength.section_forces import BarForces, section_forces
from grashof.analysis.strength.structure import MEASURES, Structure
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.strength import CrossSection
from grashof.problems.values.linkages.linkage import Linkage

_ROUNDING = 1e-12  # share of the greatest force in a bar below which other forces are none


@dataclass(frozen=True, slots=True, eq=False)
class StrengthHistory:
    """Loads on bars and pins at driver angles; not finite where joint forces are not.

    Parameters
    ----------
    bars : mapping of int to mapping of str to Along
        By link and key of `BAR_MEASURES`, in their units: those that the structure gives. Arrays of the
        shape of the motion.
    pins : mapping of Joint to mapping of str to ndarray
        By joint and key of `PIN_MEASURES`.
    """

    bars: Mapping[int, Mapping[str, Along]]
    pins: Mapping[Joint, Mapping[str, FloatArray]]

    @property
    def worst_link(self) -> FloatArray:
        """The link under the greatest load (by `governing_measure`), shape (...); NaN where unknown."""
        key = governing_measure(next(iter(self.bars.values())))
        sizes = np.stack([measures[key].value for measures in self.bars.values()])
        worst = np.array(list(self.bars), dtype=np.float64)[sizes.argmax(axis=0)]
        return np.where(np.isnan(sizes).any(axis=0), np.nan, worst)


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def strength_at(
    state: Kinematics, structure: Structure, found: Dynamics | None = None, links: Sequence[int] | None = None
) -> StrengthHistory:
    """Loads on bars and pins at every driver angle.

    Parameters
    ----------
    state : Kinematics
    structure : Structure
    found : Dynamics, optional
        Of `inverse_dynamics` for them; by default it is computed.
    links : sequence of int, optional
        The bars to examine; all by default.

    Returns
    -------
    StrengthHistory

    Notes
    -----
    Bars are straight and prismatic, see `section_forces`; stress concentrations, such as of the holes
    for the pins, and fatigue are left out, and so is the shear in deflections. Normal stress is
    |N| / A + |M| c / I, shear stress the section's factor times |V| / A, equivalent stress that of von
    Mises (see `von_mises`).
    """
    structure.check(state.linkage)
    found = inverse_dynamics(state, structure.masses, structure.loads) if found is None else found
    forces = section_forces(state, structure.masses, structure.loads, found, links)
    bars = {
        link: {
            key: Along(along.value * structure.in_si(MEASURES[key].unit), along.at)
            for key, along in _bar_measures(bar, structure).items()
        }
        for link, bar in forces.items()
    }
    in_pins = {joint: found.joint_force(joint) for joint in pins_of(state.linkage)}
    return StrengthHistory(bars, pin_measures(state.linkage, in_pins, structure))


def governing_measure(keys: Container[str]) -> str:
    """The measure that governs a bar: the share of its strength in use, else stress, else moment."""
    return next(key for key in ("utilisation", "stress", "moment") if key in keys)


def pin_measures(
    linkage: Linkage, forces: Mapping[Joint, FloatArray], structure: Structure
) -> dict[Joint, dict[str, FloatArray]]:
    """Measures of pins, in the units of `PIN_MEASURES`, from forces in kg, s and the length unit."""
    return {
        joint: {"pin_force": force * structure.in_si("N")}
        | {
            key: force / area * structure.in_si("Pa")
            for key, area in structure.pin_areas(joint, linkage.mechanism.every_joint[joint].links).items()
        }
        for joint, force in forces.items()
    }


def _bar_measures(bar: BarForces, structure: Structure) -> dict[str, Along]:
    """All measures of a bar, in kg, s and the length unit."""
    found = {
        "tension": greatest(bar, bar.normal),
        "compression": greatest(bar, -bar.normal),
        "thrust": greatest(bar, -bar.normal, spans=bar.between_joints),
        "shear": greatest(bar, bar.shear, size=True),
        "moment": greatest(bar, bar.moment, size=True),
    }
    reach = bar.stations[..., -1] - bar.stations[..., 0]
    sizes = [found[key].value for key in ("tension", "compression", "shear")]
    least = _ROUNDING * np.max([*sizes, found["moment"].value / reach], axis=0)
    found = {key: _above(along, least * reach if key == "moment" else least) for key, along in found.items()}
    if structure.section is None:
        return found
    section = structure.section.of(bar.link)
    found |= _stresses(bar, section)
    found["shear_stress"] = _above(found["shear_stress"], least * section.shear_factor / section.area)
    if structure.modulus is not None:
        stiffness = structure.modulus * section.inertia
        bow = greatest_deflection(bar, deflection(bar, stiffness))
        found["deflection"] = _above(bow, least * reach**3 / stiffness)
    if structure.strength is not None:
        used = found["stress"].value * structure.in_si("Pa") / structure.strength.yield_stress
        thrust = found["thrust"].value * structure.in_si("N")
        for load in structure.buckling_loads(bar.link, bar.length).values():
            used = np.maximum(used, thrust / load)
        found["utilisation"] = Along(used, found["stress"].at)
    return found


def _stresses(bar: BarForces, section: CrossSection) -> dict[str, Along]:
    axial, shear = bar.normal / section.area, bar.shear * (section.shear_factor / section.area)
    bending = bar.moment * (section.extreme_fibre / section.inertia)
    pulled = np.concatenate([axial, np.zeros_like(axial[..., :1])], axis=-1)
    normal = greatest(bar, pulled + bending, pulled - bending, size=True)
    # In fibres further inside, and where it is greatest in the outermost, exactly.
    inner = greatest_of(bar, lambda *stresses: von_mises(*map(np.abs, stresses)), axial, bending, shear)
    deeper = inner.value > normal.value
    stress = Along(np.where(deeper, inner.value, normal.value), np.where(deeper, inner.at, normal.at))
    return {"normal_stress": normal, "shear_stress": greatest(bar, shear, size=True), "stress": stress}


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def von_mises(axial: FloatArray, bending: FloatArray, shear: FloatArray) -> FloatArray:
    """Greatest equivalent stress in a section, shape (...).

    Arguments are magnitudes: the stress of the normal force, that of bending in the extreme fibre, and the
    shear stress at the neutral axis, where it is greatest. At a share y of the way from axis to fibre
    sigma = axial + bending y and tau = shear (1 - y^2), which is exact for a rectangle, and
    sigma'^2 = sigma^2 + 3 tau^2 (von Mises; Shigley, *Mechanical Engineering Design*, secs. 3-10, 3-11 and
    5-5). The greatest lies at y = 0, at y = 1, or at the middle root of y^3 + p y + q = 0.
    """
    p = bending**2 / (6 * shear**2) - 1
    q = axial * bending / (6 * shear**2)
    third = np.arccos(3 * q / (2 * p) * np.sqrt(-3 / p)) / 3
    inner = 2 * np.sqrt(-p / 3) * np.cos(third - 2 * np.pi / 3)
    inner = np.clip(np.where(np.isfinite(inner), inner, 0.0), 0.0, 1.0)
    squares = [(axial + bending * y) ** 2 + 3 * (shear * (1 - y**2)) ** 2 for y in (0.0, 1.0, inner)]
    found: FloatArray = np.sqrt(np.max(np.broadcast_arrays(*squares), axis=0))
    return found


def _above(along: Along, least: FloatArray) -> Along:
    """A measure along a bar, zero where it may be rounding."""
    return Along(np.where(along.value <= least, 0.0, along.value), along.at)
