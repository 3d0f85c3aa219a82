"""The report on a pumpjack: its items with right figures."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from grashof.analysis import (
    AppliedMoment,
    Body,
    Kinematics,
    Loads,
    Masses,
    balance_torque,
    extremes,
    inverse_dynamics,
    output_stroke,
    solve_kinematics,
    system_centre,
    uniform_bars,
)
from grashof.figures import draw_motion, plot_linkage
from grashof.problems import FourBar, LinkageSpec, load_linkage_spec
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.study.section import Plot
from reports import published
from reports.material import HEIGHT, Analysis, Made, lines, pictured, shown

_DENSE = 7201
# N: polished-rod loads, up and down; assumed, as the report has none. They change while the head rests.
ROD_UP, ROD_DOWN, SOFT = 20e3, 9e3, 0.1
_BESIDE = 0.05  # m: nearer to a cross its name is that of the dot
_CROSS: dict[str, Any] = {
    "linestyle": "none", "marker": "x", "markersize": 7, "markeredgewidth": 1.6, "color": "#b03a2e",
    "zorder": 9,
}  # fmt: skip


def bodies(spec: LinkageSpec) -> tuple[Masses, Masses]:
    """The links as bars of 0.2 x 0.2 m, link 4 from O4 to B; and with the full beam, A + C long."""
    linkage = spec.four_bar
    bars = uniform_bars(linkage, np.array(published.DENSITIES) * published.SIDE**2)
    length = float(linkage.r4) + (spec.output_arm or 0.0)
    mass = length * published.DENSITIES[2] * published.SIDE**2
    beam = Body(mass, mass * length**2 / 12, (float(linkage.r4) - length / 2, 0.0))
    return bars, Masses(bars.crank, bars.coupler, beam)


@dataclass(frozen=True, slots=True, eq=False)
class AsPublished:
    """Results of the report's code, with theta_s + mu for theta4 in place of theta3 + mu."""

    theta4_deg: FloatArray
    omega3: FloatArray
    alpha3: FloatArray
    speed: FloatArray
    acceleration: FloatArray

    @classmethod
    def of(cls, linkage: FourBar, state: Kinematics) -> "AsPublished":
        """At the driver angles of a state, shape (N,)."""
        way = linkage.o4 - state.a.position
        theta4 = state.theta4 - (state.theta3 - np.arctan2(way[:, 1], way[:, 0]))
        lengths, angles = (linkage.r2, linkage.r3, linkage.r4), (state.theta2, state.theta3, theta4)
        two, three, four = (
            float(length) * np.exp(1j * angle) for length, angle in zip(lengths, angles, strict=True)
        )
        omega3, omega4 = _two(1j * three, -1j * four, -1j * two * state.omega2)
        push = two * state.omega2**2 + three * omega3**2 - four * omega4**2
        alpha3, alpha4 = _two(1j * three, -1j * four, push)
        r4 = float(linkage.r4)
        speed, acceleration = r4 * np.abs(omega4), r4 * np.hypot(omega4**2, alpha4)
        return cls(np.degrees(np.unwrap(theta4)), omega3, alpha3, speed, acceleration)


def _two(first: np.ndarray, second: np.ndarray, right: np.ndarray) -> tuple[FloatArray, FloatArray]:
    """Real x and y with x first + y second = right, complex; shape (N,)."""
    over = (first.conj() * second).imag
    return (right.conj() * second).imag / over, (first.conj() * right).imag / over


class Pumpjack:
    """The linkage of the report, at its speed, over its fifteen seconds."""

    def __init__(self) -> None:
        self.spec = load_linkage_spec("pumpjack")
        self.history = Analysis.of(
            self.spec, seconds=published.SECONDS, step=published.TIME_STEP, start_deg=published.START_DEG,
            at_deg=published.PICTURES,
        )  # fmt: skip
        self.bars, self.full = bodies(self.spec)

    @property
    def linkage(self) -> FourBar:
        """The linkage itself."""
        return self.spec.four_bar

    @property
    def omega2(self) -> float:
        """Speed of the crank, rad/s."""
        return self.history.study.sweep.speed_rpm * TURN / 60

    @cached_property
    def wrong(self) -> AsPublished:
        """Results of the report's code at its samples."""
        theta2 = np.radians(self.history.tables["over-time"]["theta2_total_deg"])
        return AsPublished.of(self.linkage, solve_kinematics(self.linkage, theta2, self.omega2))

    def state(self, theta2_deg: FloatArray | float) -> Kinematics:
        """Kinematics at driver angles."""
        return solve_kinematics(self.linkage, np.radians(theta2_deg), self.omega2)

    @cached_property
    def numbers(self) -> dict[str, float | str]:
        """The figures that the texts of the items quote."""
        linkage, stroke = self.linkage, output_stroke(self.linkage)
        found: dict[str, float | str] = {}
        for name, of in {
            "omega3": lambda s: s.omega3, "alpha3": lambda s: s.alpha3,
            "theta3": lambda s: np.degrees(s.theta3),
            "speed_b": lambda s: s.b.speed, "push_b": lambda s: s.b.acceleration_magnitude,
            "px": lambda s: s.p.position[..., 0], "py": lambda s: s.p.position[..., 1],
        }.items():  # fmt: skip
            reach = extremes(linkage, of, self.omega2)
            found |= {f"{name}_least": reach.low, f"{name}_greatest": reach.high}
        theta4 = np.degrees(stroke.theta4) % 360
        found |= {"theta4_least": float(theta4.min()), "theta4_greatest": float(theta4.max())}
        a = self.state(0.0).a
        found |= {"speed_a": float(a.speed), "push_a": float(a.acceleration_magnitude)}
        ends = np.sort(self.state(np.degrees(stroke.theta2)).b.acceleration_magnitude)[::-1]
        found |= {"push_end_greatest": float(ends[0]), "push_end_least": float(ends[1])}
        up, down = self.stroke_times
        found |= {
            "omega2": self.omega2, "turns": published.SECONDS * self.omega2 / TURN,
            "rotation_pi": published.SECONDS * self.omega2 / np.pi, "swing": float(np.degrees(stroke.swing)),
            "time_ratio": float(stroke.time_ratio), "up": up, "down": down,
            "slower": "slower" if down > up else "faster",
            "mass": float(self.bars.total), "mass_whole": float(self.full.total),
            "r4": float(linkage.r4), "beam": float(linkage.r4) + (self.spec.output_arm or 0.0),
        }  # fmt: skip
        upright = self.state(90.0)
        for name, masses in (("system", self.bars), ("system_whole", self.full)):
            x, y = system_centre(masses, upright).position
            found |= {f"{name}_x": x, f"{name}_y": y}
        for link, name in ((3, "coupler"), (4, "beam")):
            centre = upright.point(link, self.bars.of(link).centre).position
            found |= {f"{name}_x": float(centre[0]), f"{name}_y": float(centre[1])}
        return found | self.catalogue_numbers | self.head_numbers

    @cached_property
    def stroke_times(self) -> tuple[float, float]:
        """Times for which the horsehead rises and falls in a turn, s; it rises while theta4 grows."""
        stroke = output_stroke(self.linkage)
        at_least = stroke.theta2[np.argmin(stroke.theta4 % TURN)]
        at_greatest = stroke.theta2[np.argmax(stroke.theta4 % TURN)]
        up = float((at_greatest - at_least) % TURN / self.omega2)
        return up, TURN / self.omega2 - up

    @cached_property
    def catalogue_numbers(self) -> dict[str, float]:
        """Of the real unit, in inches."""
        unit = load_linkage_spec("lufkin-c912d")
        arm = unit.output_arm or 0.0
        stroke, state = output_stroke(unit.four_bar), solve_kinematics(unit.four_bar, 0.0)
        return {
            "unit_k": float(unit.four_bar.r1), "unit_k_deg": float(np.degrees(unit.four_bar.theta1)),
            "unit_stroke": arm * float(stroke.swing), "unit_factor": arm * float(np.abs(state.omega4)),
            "unit_k_m": float(unit.four_bar.r1) * 0.0254, "r1": float(self.linkage.r1),
        }  # fmt: skip

    # The items.

    def dimensions(self) -> Made:
        """The catalogue's row, and the part of it that the report simulates."""
        given, unit = published.CATALOGUE, load_linkage_spec("lufkin-c912d")
        base = self.linkage.o4 - self.linkage.o2
        own = {
            "R": self.linkage.r2, "P": self.linkage.r3, "C": self.linkage.r4, "A": self.spec.output_arm,
            "I": base[0], "H - G": base[1], "K": self.linkage.r1,
        }  # fmt: skip
        inches = {name: given[name] for name in "RPCAI"} | {
            "H - G": given["H"] - given["G"], "K": float(unit.four_bar.r1)
        }  # fmt: skip
        rows = [
            {
                "dimension": name,
                "catalogue_in": value,
                "catalogue_m": value * 0.0254,
                "simulated_m": own[name],
            }
            for name, value in inches.items()
        ]
        numbers = self.catalogue_numbers
        checks = [
            {"of the unit": "stroke, in", "catalogue": published.STROKE, "computed": numbers["unit_stroke"]},
            {
                "of the unit": "torque factor at 90 deg, in", "catalogue": published.TORQUE_FACTOR,
                "computed": numbers["unit_factor"],
            },
        ]  # fmt: skip
        return Made(tables={"": pd.DataFrame(rows), "unit": pd.DataFrame(checks)})

    def animation(self) -> Made:
        """The linkage in motion, at its own speed, and standing still."""
        figure = pictured(6.2, plot_linkage, self.spec, theta2=np.radians(published.START_DEG))
        seconds = TURN / self.omega2
        return Made({"": figure, "moving": draw_motion(self.spec, seconds=seconds, fps=12.5, annotated=True)})

    def over_time(self, key: str, wanted: Sequence[str] = (), name: str = "", published_as: str = "") -> Made:
        """Lines of a plot over time; with a name also the report's line, an attribute of `AsPublished`."""
        plot = self.history.plots[f"{key}-over-time"]
        if not name:
            return shown(plot)
        return shown(lines(plot, wanted, {f"{name} as published": getattr(self.wrong, published_as)}))

    def strokes(self) -> Made:
        """The horsehead's height over time, and the times of its strokes up and down."""
        time, travel, speed = self._head()
        plots = (
            Plot("head", "travel of the horsehead", "m", {"travel": travel}, time, "time (s)"),
            Plot("head-speed", "speed of the horsehead", "m/s", {"speed": speed}, time, "time (s)"),
        )
        up, down = self.stroke_times
        table = pd.DataFrame({"stroke": ["up", "down"], "time_s": [up, down]})
        made = shown(*plots)
        return replace(made, tables={**made.tables, "times": table})

    def _head(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        time = np.linspace(0, TURN / self.omega2, 361)
        state = self.state(published.START_DEG + np.degrees(self.omega2 * time))
        arm, angle = self.spec.output_arm or 0.0, np.unwrap(state.theta4)
        return time, arm * (angle - angle.min()), arm * state.omega4

    def masses(self) -> Made:
        """Volumes, densities, masses; with link 4 alone and with the full beam."""
        lengths = {"crank": self.linkage.r2, "coupler": self.linkage.r3, "rocker, O4 to B": self.linkage.r4}
        named = [*zip(lengths.items(), published.DENSITIES, strict=True)]
        beam = float(self.linkage.r4) + (self.spec.output_arm or 0.0)
        named += [(("whole beam, A + C", np.asarray(beam)), published.DENSITIES[2])]
        rows = []
        for (name, length), density in named:
            volume = float(length) * published.SIDE**2
            row = {"bar": name, "length_m": float(length), "volume_m3": volume, "density_kg_m3": density}
            rows.append({**row, "mass_kg": volume * density})
        totals = pd.DataFrame(
            {
                "moving mass": ["links simulated", "with the whole beam", "as published"],
                "kg": [float(self.bars.total), float(self.full.total), float(published.MASS)],
            }
        )
        return Made(tables={"": pd.DataFrame(rows), "total": totals})

    def centres(self) -> Made:
        """The centres of the links and of the system at 90 deg, and their places in the report."""
        state = self.state(90.0)
        right = {
            name: state.point(link, self.bars.of(link).centre).position
            for link, name in ((2, "crank"), (3, "coupler"), (4, "beam"))
        }
        right["system"] = system_centre(self.bars, state).position
        right["system with the whole beam"] = system_centre(self.full, state).position
        theirs = {**published.CENTRES, "system with the whole beam": published.SYSTEM}

        def plot(ax: Axes) -> None:
            _mark(plot_linkage(self.spec, theta2=np.pi / 2, ax=ax), right, theirs)

        rows = [
            {"centre of": name, "x_m": place[0], "y_m": place[1], **_as_published(theirs.get(name))}
            for name, place in right.items()
        ]
        return Made({"": pictured(6.6, plot)}, {"": pd.DataFrame(rows)})

    def head(self) -> Made:
        """Torque factor, and the drive torque under an assumed rod load with and without a counterweight."""
        angle, torques, factor = self._loaded
        factors = Plot("factor", "torque factor of the horsehead", "m", {"torque factor": factor}, angle)
        drive = Plot("torque", "drive torque", "N m", torques, angle)
        return shown(factors, drive)

    @cached_property
    def _loaded(self) -> tuple[FloatArray, dict[str, FloatArray], FloatArray]:
        angle = np.linspace(0, 360, 361)
        before, after, _ = self._balanced(angle)
        torques = {"no counterweight": before, "counterweight on the crank": after}
        return angle, torques, (self.spec.output_arm or 0.0) * self.state(angle).omega4 / self.omega2

    def _balanced(self, angle_deg: FloatArray) -> tuple[FloatArray, FloatArray, Body]:
        arm, gravity = self.spec.output_arm or 0.0, np.array([0.0, -9.80665])
        top = extremes(self.linkage, lambda s: s.omega4, self.omega2).high

        def pull(state: Kinematics) -> FloatArray:
            rising = np.tanh(state.omega4 / (SOFT * top))
            return -arm * (ROD_UP * (1 + rising) + ROD_DOWN * (1 - rising)) / 2

        # The rope leaves the horsehead at the same distance from O4 at every angle: a moment of its tension.
        loads = Loads(gravity=gravity, moments=(AppliedMoment(4, pull),))
        turn = self.state(np.linspace(0, 360, 720, endpoint=False))
        balanced = balance_torque(turn, self.full, loads, radius=float(self.linkage.r2))
        state = self.state(angle_deg)
        before, after = (
            inverse_dynamics(state, masses, loads).torque for masses in (self.full, balanced.masses)
        )
        return before, after, balanced.crank_weight

    @cached_property
    def head_numbers(self) -> dict[str, float]:
        """Of the horsehead and the counterweight."""
        stroke, arm = output_stroke(self.linkage), self.spec.output_arm or 0.0
        before, after, weight = self._balanced(np.linspace(0, 360, _DENSE))
        return {
            "head_stroke": arm * float(stroke.swing), "rod_up": ROD_UP / 1e3, "rod_down": ROD_DOWN / 1e3,
            "peak_before": float(np.abs(before).max()) / 1e3, "peak_after": float(np.abs(after).max()) / 1e3,
            "weight": float(weight.mass), "weight_radius": float(np.hypot(*weight.centre)),
        }  # fmt: skip

    def picture(self, theta2_deg: float) -> Made:
        """The linkage at one driver angle, in place of a photograph of the model."""
        figure = pictured(HEIGHT + 1.2, plot_linkage, self.spec, theta2=np.radians(theta2_deg))
        table = self.history.tables["positions"]
        return Made({"": figure}, {"": table[table["theta2_deg"] == theta2_deg]})


def _mark(axes: Axes, right: dict[str, FloatArray], theirs: dict[str, tuple[float, float]]) -> None:
    """Draw centres as dots, and the report's as crosses."""
    for number, (name, place) in enumerate(right.items()):
        marker = "o" if not name.startswith("system") else "Ds"[name != "system"]
        axes.plot(
            *place[:, None], linestyle="none", marker=marker, markersize=7, markerfacecolor=f"C{number}",
            markeredgecolor="black", label=f"centre: {name}", zorder=8,
        )  # fmt: skip
    for number, (name, cross) in enumerate(theirs.items()):
        axes.plot(*np.array(cross)[:, None], **_CROSS, label="as published" if number == 0 else None)
        if np.hypot(*(right[name] - cross)) > _BESIDE:
            words = name.removesuffix(" with the whole beam")
            axes.annotate(words, cross, (7, -11), textcoords="offset points", color=_CROSS["color"])
    axes.legend(loc="best", fontsize="small", ncols=2)


def _as_published(place: tuple[float, float] | None) -> dict[str, float]:
    return {} if place is None else {"published_x_m": place[0], "published_y_m": place[1]}
