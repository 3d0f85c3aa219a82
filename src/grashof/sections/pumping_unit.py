"""The linkage as a pumping unit: torque factors, loads and the reducer's torque as the API counts them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from grashof.analysis import (
    Extremes,
    ReducerTorque,
    RodMotion,
    beam_limits,
    driver_angle,
    extremes_of,
    output_stroke,
    reducer_torque,
    rod_load,
    rod_motion,
)
from grashof.analysis.forces.loads import wrenches
from grashof.analysis.numerics.minimax import least_peak
from grashof.analysis.numerics.quadrature import integrate
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.dynamics.pumping_unit import PumpingUnitSpec
from grashof.study.samples import line
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.study.turn import degrees

_ANGLE = "API crank angle (deg)"
_ROWS = np.arange(0.0, 360.0, 15.0)
_FINE = np.arange(0.0, 361.0)
Load = Callable[[FloatArray, RodMotion], FloatArray]


def pumping_unit(study: LinkageStudy) -> Section | None:
    """Rod motion, torque factors and, with a rod load, the reducer torque; None for other linkages."""
    given, arm = study.spec.pumping_unit, study.spec.output_arm
    if given is None or arm is None:
        return None
    load = rod_load(given) or _load_of_file(study, given, arm)
    rods = _Rods(study, given, arm, load, beam_limits(study.four_bar))
    columns = rods.columns(np.radians(_FINE))
    notes = ["crank angles are clockwise from 12 o'clock, seen with the well to the right"]
    if rods.load is None:
        notes.append("no load on the polished rod is stated, so the reducer's torque is not known")
    if study.spec.dynamics is not None and study.sweep.speed_rpm * given.sense * given.side > 0:
        notes.append(f"this view turns the crank {given.crank}; speed_rpm turns it the other way")
    table = pd.DataFrame(rods.columns(np.radians(_ROWS))).replace([np.inf, -np.inf], np.nan)
    facts = (*rods.motion_facts(), *rods.torque_facts())
    plots = tuple(_plots(columns, study.spec.unit))
    return Section("pumping-unit", "Pumping unit", facts, {"pumping-unit": table}, plots, tuple(notes))


def _load_of_file(study: LinkageStudy, unit: PumpingUnitSpec, arm: float) -> Load | None:
    """The forces and moments of the file on the beam, as a load on the polished rod."""
    loads = replace(study.loads, springs=(), torsion_springs=())
    if 4 not in {force.link for force in loads.forces} | {moment.link for moment in loads.moments}:
        return None
    newton = study.metre / arm

    def load(crank: FloatArray, motion: RodMotion) -> FloatArray:  # noqa: ARG001
        state = study.sweep.state(driver_angle(crank, unit) % TURN)
        return -unit.side * wrenches(state, loads)[4].moment * newton + np.zeros(np.shape(crank))

    return load


@dataclass(frozen=True, slots=True)
class _Rods:
    """Motion and load of the polished rod."""

    study: LinkageStudy
    unit: PumpingUnitSpec
    arm: float
    load: Load | None
    limits: FloatArray

    @property
    def metre(self) -> float:
        return metres(self.study.spec.length_unit, "pumping_unit")

    def motion(self, crank: FloatArray) -> RodMotion:
        return rod_motion(self.study.four_bar, crank, self.arm, self.unit, self.limits)

    def reducer(self, crank: FloatArray, unit: PumpingUnitSpec | None = None) -> ReducerTorque:
        motion = self.motion(crank)
        load = np.full(crank.shape, np.nan) if self.load is None else self.load(crank, motion)
        return reducer_torque(unit or self.unit, crank, motion.torque_factor * self.metre, load)

    def columns(self, crank: FloatArray) -> dict[str, FloatArray]:
        """Columns (N,) by key; those of the load only where there is one."""
        motion, found = self.motion(crank), self.reducer(crank)
        columns = {
            "crank_deg": np.degrees(crank).round(9),
            "theta2_deg": np.degrees(driver_angle(crank, self.unit) % TURN).round(9),
            "position": motion.position,
            "torque_factor": motion.torque_factor,
            "counterbalance_torque": found.counterbalance,
        }
        if self.unit.rating is not None:
            columns["permissible_load"] = found.permissible_load
        if self.load is not None:
            columns |= {
                "rod_load": self.load(crank, motion),
                "net_load": found.net_load,
                "gearbox_torque": found.torque,
            }
        return columns

    def motion_facts(self) -> Iterator[Fact]:
        linkage, unit = self.study.four_bar, self.study.spec.unit
        yield Fact("api_k", "K: from the crankshaft to the saddle bearing", float(linkage.r1), unit)
        angle = float(np.degrees(linkage.theta1)) % 360
        yield Fact("api_k_angle_deg", "direction of K, counter-clockwise from the right", angle, "deg")
        stroke = self.arm * float(output_stroke(linkage).swing)
        yield Fact("rod_stroke", "stroke of the polished rod", stroke, unit)
        found = _extremes(lambda crank: self.motion(crank).torque_factor)
        for name, value, at in (("up", found.high, found.at_high), ("down", found.low, found.at_low)):
            label = f"torque factor, largest on the {name} stroke"
            yield Fact(f"torque_factor_{name}", label, value, unit)
            yield Fact(f"torque_factor_{name}_crank_deg", f"{label}: crank angle", degrees(at), "deg")
        factor = float(self.motion(np.array([np.pi / 2])).torque_factor[0])
        yield Fact("torque_factor_at_crank_90_deg", "torque factor at crank angle 90 deg", factor, unit)

    def torque_facts(self) -> Iterator[Fact]:
        if self.load is None:
            return
        found = _extremes(lambda crank: self.reducer(crank).torque)
        for name, value, at in (("largest", found.high, found.at_high), ("least", found.low, found.at_low)):
            yield Fact(f"gearbox_torque_{name}", f"gearbox torque, {name}", value, "N m")
            label = f"gearbox torque, {name}: crank angle"
            yield Fact(f"gearbox_torque_{name}_crank_deg", label, degrees(at), "deg")
        if self.unit.rating is not None:
            share = max(abs(found.low), abs(found.high)) / self.unit.rating
            yield Fact("gearbox_load", "gearbox torque as a share of the rating", share)
        mean, square = self._means()
        yield Fact("gearbox_torque_mean", "gearbox torque, mean over the turn", mean, "N m")
        yield Fact("gearbox_torque_rms", "gearbox torque, rms over the turn", np.sqrt(square), "N m")
        yield Fact("rod_work", "work on the polished rod, each stroke", mean * TURN, "J")
        if mean > 0:
            yield Fact("cyclic_load_factor", "cyclic load factor (rms over mean)", np.sqrt(square) / mean)
        moment, peak = self._balanced()
        yield Fact("counterbalance_even", "counterbalance moment of the least peak torque", moment, "N m")
        yield Fact("gearbox_torque_even", "gearbox torque, peak with that counterbalance", peak, "N m")

    def _means(self) -> tuple[float, float]:
        """Means of torque and of its square over the turn."""

        def curves(crank: FloatArray) -> FloatArray:
            torque = self.reducer(crank).torque
            return np.stack([torque, torque**2])

        ends = np.pi / 2 - self.unit.side * output_stroke(self.study.linkage).theta2
        nodes = np.concatenate([np.linspace(0, TURN, 9), ends % TURN])
        if self.unit.values is not None and self.unit.over == "crank":
            nodes = np.concatenate([nodes, np.radians([row[0] for row in self.unit.values]) % TURN])
        mean, square = integrate(curves, np.unique(nodes)).total / TURN
        return float(mean), float(square)

    def _balanced(self) -> tuple[float, float]:
        """The counterbalance moment, at the same phase, that makes the peak torque least, and that peak."""
        bare, one = replace(self.unit, counterbalance=0.0), replace(self.unit, counterbalance=1.0)

        def outermost(curve: Callable[[FloatArray], FloatArray]) -> tuple[float, float]:
            found = _extremes(curve)
            return found.at_low, found.at_high

        found = least_peak(
            lambda crank: self.reducer(crank, bare).torque,
            lambda crank: -self.reducer(crank, one).counterbalance[:, None],
            0.0,
            TURN,
            outermost,
        )
        return float(found.parameters[0]), found.peak


def _extremes(curve: Callable[[FloatArray], FloatArray]) -> Extremes:
    return extremes_of(curve, 0.0, TURN, closed=True)


def _plots(columns: dict[str, FloatArray], unit: str) -> Iterator[Plot]:
    crank = columns["crank_deg"]

    def plot(key: str, title: str, per: str, **names: str) -> Plot:
        lines = {
            label.replace("_", " "): line(columns[name]) for label, name in names.items() if name in columns
        }
        return Plot(key, title, per, lines, crank, _ANGLE, angles=columns["theta2_deg"])

    yield plot("rod-position", "position of the polished rod, share of the stroke", "", position="position")
    yield plot("api-torque-factor", "torque factor, positive on the up stroke", unit, factor="torque_factor")
    loads = {"rod_load": "rod_load", "net_load": "net_load", "permissible": "permissible_load"}
    if columns.keys() & set(loads.values()):
        yield plot("rod-load", "load on the polished rod", "N", **loads)
    torques = {"gearbox": "gearbox_torque", "counterbalance": "counterbalance_torque"}
    if "gearbox_torque" in columns or columns["counterbalance_torque"].any():
        yield plot("gearbox-torque", "torque in the sense of the crank", "N m", **torques)
