"""The report on unloading luggage: its items with right figures."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from hand_tuned_search import GUESSES, Tried, outcome, residual_of, tried

from grashof.analysis import Verdict, extremes_of, inverse_dynamics, solve_position, verify
from grashof.figures import plot_linkage, plot_task
from grashof.problems import FourBar, LinkageSpec, load, load_linkage_spec
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.study.asked import Asked
from grashof.study.section import DRIVER_ANGLE, Plot
from grashof.study.study import LinkageStudy
from reports import published
from reports.material import Analysis, Made, lines, pictured, shown

_FINE = 10  # steps of our curves for one of the report's
_DENSE = 7200  # of a turn, for means
COUNTED = "driver angle theta2, counted on (deg)"


class Luggage:
    """The linkage of the report, at 1 rad/s, over its job and a turn."""

    def __init__(self) -> None:
        self.problem, self.spec = load("luggage"), load_linkage_spec("luggage-report")
        # The samples start where the report's do, counted from the ground line.
        self.start = float(self.linkage.theta1) + published.POSE_1 - published.GROUND
        last, step = (published.SAMPLES - 1) * published.STEP, published.STEP
        asked: dict[str, Any] = {"seconds": last, "start_deg": float(np.degrees(self.start))}
        self.samples = Analysis.of(self.spec, step=step, sections=("differences",), **asked)
        self.fine = Analysis.of(self.spec, step=step / _FINE, sections=("newton-raphson",), **asked)

    @property
    def linkage(self) -> FourBar:
        """The linkage itself."""
        return self.spec.four_bar

    @cached_property
    def verdict(self) -> Verdict:
        """The verdict, at a tolerance that the residuals allow."""
        wanted = replace(self.problem.requirements, tolerance=2e-6)
        return verify(self.linkage, self.problem.task, wanted)

    @property
    def poses_deg(self) -> list[float]:
        """Driver angles at the poses."""
        return [float(angle) for angle in np.degrees(self.verdict.theta2)]

    @cached_property
    def fits(self) -> Analysis:
        """Paths fitted through the report's eleven points."""
        first, last = np.degrees(self.start + published.STEP * published.ELEVEN[[0, -1]])
        points = len(published.ELEVEN)
        return Analysis.of(self.spec, fit_from_deg=float(first), fit_to_deg=float(last), fit_points=points)

    @cached_property
    def guesses(self) -> list[Tried]:
        """The report's guesses, run and judged."""
        return [tried(self.problem, guess) for guess in GUESSES]

    @cached_property
    def studies(self) -> Mapping[bool, LinkageStudy]:
        """Without gravity, as in the report, and with it."""
        given = self.spec.dynamics
        heavy = replace(given, gravity=(0.0, -published.GRAVITY)) if given is not None else None
        specs: dict[bool, LinkageSpec] = {False: self.spec, True: replace(self.spec, dynamics=heavy)}
        return {gravity: LinkageStudy.of(spec, Asked()) for gravity, spec in specs.items()}

    def torque(self, theta2: FloatArray, *, gravity: bool) -> FloatArray:
        """Drive torque at driver angles, rad, N m."""
        study = self.studies[gravity]
        masses = study.masses
        if masses is None:
            return np.zeros(np.shape(theta2))
        return inverse_dynamics(study.sweep.state(theta2 % TURN), masses, study.loads).torque

    @cached_property
    def torque_table(self) -> pd.DataFrame:
        """Greatest, least, effective and mean torque at the samples, over the turn and on the job."""
        begin, end = self.verdict.theta2[[0, -1]]
        rows = []
        for gravity in (False, True):

            def curve(theta2: FloatArray, gravity: bool = gravity) -> FloatArray:
                return self.torque(theta2, gravity=gravity)

            seen = curve(self.start + published.STEP * np.arange(published.SAMPLES))
            turn, job = extremes_of(curve, 0.0, TURN, closed=True), extremes_of(curve, begin, end)
            over_turn = curve(np.arange(_DENSE) * TURN / _DENSE)
            nodes, weights = np.polynomial.legendre.leggauss(400)
            on_job = curve((begin + end) / 2 + (end - begin) / 2 * nodes)
            for where, high, low, square, mean in (
                ("101 samples", seen.max(), seen.min(), np.mean(seen**2), seen.mean()),
                ("the whole turn", turn.high, turn.low, np.mean(over_turn**2), over_turn.mean()),
                ("the job", job.high, job.low, weights @ on_job**2 / 2, weights @ on_job / 2),
            ):
                row = {"over": where, "gravity_m_s2": published.GRAVITY if gravity else 0.0}
                rows.append({**row, "max": high, "min": low, "rms": np.sqrt(square), "mean": mean})
        table = pd.DataFrame(rows)
        rounding = table["mean"].abs() <= 1e-9 * table["rms"]
        table["mean"] = table["mean"].mask(rounding, 0.0)
        return table

    @cached_property
    def numbers(self) -> dict[str, float | str]:
        """The figures that the texts of the items quote."""
        found: dict[str, float | str] = {
            "step": float(np.degrees(published.STEP)),
            "low_1": 100 * (1 - published.STEP / published.H),
            "low_2": 100 * (1 - (published.STEP / published.H) ** 2),
            "mu_task": float(np.degrees(self.verdict.transmission_min_task)),
            "mu_turn": float(np.degrees(self.verdict.transmission_min_cycle)),
            "o2_y": float(self.linkage.o2[1]), "o4_y": float(self.linkage.o4[1]),
            "miss": self.verdict.error_max * 1e6,
        }  # fmt: skip
        for name, value in zip(("left", "right"), self._residuals(), strict=True):
            found[f"residual_{name}"] = value * 1e6
        for place, short in (("101 samples", "samples"), ("the whole turn", "turn"), ("the job", "job")):
            for gravity, mark in ((0.0, ""), (published.GRAVITY, "_heavy")):
                table = self.torque_table
                row = table[(table["over"] == place) & (table["gravity_m_s2"] == gravity)].iloc[0]
                found |= {f"{short}_{key}{mark}": float(row[key]) for key in ("max", "min", "rms", "mean")}
        for each in self.guesses:
            found[f"{each.guess.name}_comes_to"] = outcome(each)
            found[f"{each.guess.name}_residual"] = 1e6 * max(each.left.residual, each.right.residual)
        deviations = self.samples.tables["differences-deviations"]
        for (derivative, order), rows in deviations.groupby(["derivative", "order"]):
            found[f"off_{derivative}_{order}"] = 100 * float(rows["share"].max())
        return found | self._fit_numbers

    @property
    def _fit_numbers(self) -> dict[str, float]:
        found: dict[str, float] = {}
        short = {"y over x": "y", "x and y over theta2": "t"}
        for row in self.fits.tables["fits"].to_dict("records"):
            link = str(row["path"])[-1]
            by = "newton" if row["by"] == "Newton interpolation" else "fit"
            key = f"{by}_{short[str(row['fit'])]}_{row['degree']}_{link}"
            found |= {key: float(row["error_path"]), f"r2_{key}": float(row["r2"])}
        factors = self.fits.tables["fits-coefficients"]
        straight = factors[(factors["fit"] == "y over x") & (factors["degree"] == 1)]
        slopes = zip(straight["path"], straight["c1"], strict=True)
        return found | {f"slope_{str(path)[-1]}": float(slope) for path, slope in slopes}

    def _residuals(self) -> tuple[float, float]:
        """Root of the sum of squares of the gaps of each dyad at the driver angles printed."""
        task, first = self.problem.task, solve_position(self.linkage, self.verdict.theta2[0])
        dyads = (self.linkage.o2, first.a, published.BETA), (self.linkage.o4, first.b, published.GAMMA)
        left, right = (
            residual_of(task)(np.array([*(joint - pivot), *(task.positions[0] - joint), *np.radians(turns)]))
            for pivot, joint, turns in dyads
        )
        return left, right

    # The items.

    def task(self) -> Made:
        """Poses, staircase and box."""
        task = self.problem.task
        table = pd.DataFrame({"x_m": task.positions[:, 0], "y_m": task.positions[:, 1]})
        table["angle_deg"] = np.degrees(task.angles).round(12)
        return Made({"": pictured(5.4, plot_task, self.problem)}, {"": table})

    def poses(self, number: int | None = None) -> Made:
        """The linkage in its four poses, or in one of them, in place of a photograph of the prototype."""
        angles = self.poses_deg if number is None else [self.poses_deg[number - 1]]
        theta2 = None if number is None else np.radians(angles[0])
        figure = pictured(6.4, plot_linkage, self.spec, self.problem, theta2=theta2)
        return Made({"": figure}, {"": Analysis.of(self.spec, at_deg=tuple(angles)).tables["positions"]})

    def guess(self, name: str) -> Made:
        """A guess of the report, its dyads by BFGS, and the verdict on them."""
        each = next(each for each in self.guesses if each.guess.name == name)
        rows = []
        sides = ("left", each.guess.left, each.left), ("right", each.guess.right, each.right)
        for side, given, dyad in sides:
            turns = np.degrees(dyad.turns)
            came = (dyad.link.real, dyad.link.imag, dyad.arm.real, dyad.arm.imag, *turns)
            names = ("W_x", "W_y", "Z_x", "Z_y", "turn_1_deg", "turn_2_deg", "turn_3_deg")
            for what, values in (("guess", given), ("came to", came)):
                row = {"dyad": side, "of": what, **dict(zip(names, map(float, values), strict=True))}
                rows.append(row | ({"residual_m": dyad.residual} if what == "came to" else {}))
        verdict = each.verdict
        lengths = dict(zip(("r1", "r2", "r3", "r4"), each.linkage.lengths.tolist(), strict=True))
        judged = {
            **lengths, "class": str(verdict.grashof_class), "one circuit": verdict.circuit_ok,
            "one branch": verdict.branch_ok, "in order": verdict.order_ok,
            "turns fully": verdict.full_rotation,
            "mu on the way, deg": float(np.degrees(verdict.transmission_min_task)),
            "mu over the turn, deg": float(np.degrees(verdict.transmission_min_cycle)),
        }  # fmt: skip
        tables = {"": pd.DataFrame(rows), "judged": pd.DataFrame([judged])}
        if not verdict.branch_ok:
            return Made(tables=tables)
        return Made({"": pictured(6.0, plot_linkage, each.linkage, self.problem)}, tables)

    def result(self) -> Made:
        """Table 7 beside the catalogue's linkage, and its errors, which the report does not state."""
        left, right = self._residuals()
        lengths = [float(length) for length in self.linkage.lengths]
        state = solve_position(self.linkage, self.verdict.theta2)
        driver = np.degrees(self.verdict.theta2 - self.verdict.theta2[0])[1:]
        output = np.degrees(np.unwrap(state.theta4) - state.theta4[0])[1:]
        names = ["LFval", "RFval", "r1", "r2", "r3", "r4"]
        printed = [*published.RESIDUALS, published.R1, published.R2, published.R3, published.R4]
        ours = [left, right, *lengths]
        for name, given, found in (("beta", published.BETA, driver), ("gamma", published.GAMMA, output)):
            for number, (given_angle, angle) in enumerate(zip(given, found, strict=True), start=1):
                names.append(f"{name}{number}, deg")
                printed.append(given_angle)
                ours.append(float(angle + 360 * round((given_angle - angle) / 360)))
        table = pd.DataFrame({"quantity": names, "printed": printed, "catalogue": ours})
        errors = pd.DataFrame(
            {
                "pose": range(1, len(self.verdict.theta2) + 1), "theta2_deg": self.poses_deg,
                "position_error_m": self.verdict.position_error,
                "angle_error_deg": np.degrees(self.verdict.angle_error),
            }
        )  # fmt: skip
        return Made(tables={"": table, "poses": errors})

    def curves(self, *keys: str) -> Made:
        """Plots of the analysis over the driver's angle."""
        return shown(*map(self.fine.over_angle, keys))

    def angular_differences(self, rate: str, order: int) -> Made:
        """The same by central differences at the samples of the report."""
        name = {"velocity": "omega", "acceleration": "alpha"}[rate]
        plots = {f"{name}{link}": self.samples.over_angle(f"differences-{name}{link}") for link in (3, 4)}
        exact = {key: plot.series["exact"] for key, plot in plots.items()}
        by_order = {key: plot.series[f"order {order}"] for key, plot in plots.items()}
        title = f"angular {rate}"
        return self._differences(replace(plots[f"{name}3"], title=title), rate, order, exact, by_order)

    def centre_differences(self, link: int, rate: str, order: int) -> Made:
        """Velocity or acceleration of a centre by central differences at the samples of the report."""
        plot = self.samples.over_angle(f"differences-g{link}-{rate}")
        exact, by_order = (
            {axis: plot.series[f"{axis}, {name}"] for axis in "xy"} for name in ("exact", f"order {order}")
        )
        return self._differences(plot, rate, order, exact, by_order)

    def _differences(
        self, plot: Plot, rate: str, order: int, exact: Mapping[str, FloatArray],
        by_order: Mapping[str, FloatArray],
    ) -> Made:  # fmt: skip
        """With the step of the samples, with the 5 deg that the report divides by, and the errors of both."""
        derivative = {"velocity": 1, "acceleration": 2}[rate]
        values, errors = dict[str, FloatArray](), dict[str, FloatArray]()
        for name, right in exact.items():
            published_one = by_order[name] * (published.STEP / published.H) ** derivative
            found = {f"{name}, order {order}": by_order[name], f"{name} as published": published_one}
            values |= {f"{name}, exact": right, **found}
            errors |= {label: each - right for label, each in found.items()}
        return shown(
            replace(plot, series=values),
            replace(plot, key="errors", title=f"error of the {rate}", series=errors),
        )

    def links(self) -> Made:
        """The specification of the links: masses, centres, inertias."""
        table = self.samples.tables["masses"].copy()
        lengths = [float(getattr(self.linkage, f"r{link}")) for link in (2, 3, 4)]
        table.insert(1, "length", [*lengths, np.nan])
        bars = [mass * length**2 / 12 for mass, length in published.BARS]
        table["inertia_slender_bar"] = [*bars, np.nan]
        return Made(tables={"": table})

    def equations(self) -> Made:
        """The nine equations at each pose."""
        angles = tuple(self.poses_deg)
        table = Analysis.of(self.spec, at_deg=angles, sections=("equations",)).tables["equations"]
        first = table[table["theta2_deg"] == table["theta2_deg"].iloc[0]].drop(columns="theta2_deg")
        return Made(tables={"": first, "every-pose": table})

    def torque_over(self, range_: str) -> Made:
        """The drive torque over the report's samples, with its extremes, over a fine turn, or on the job."""
        samples = self.start + published.STEP * np.arange(published.SAMPLES)
        begin, end = self.verdict.theta2[[0, -1]]
        theta2, over = {
            "samples": (samples, COUNTED),
            "turn": (np.linspace(0, TURN, 1441), DRIVER_ANGLE),
            "job": (np.linspace(begin, end, 481), COUNTED),
        }[range_]
        levels = (
            dict(zip(("greatest", "least"), published.TORQUE, strict=False)) if range_ == "samples" else {}
        )
        series = {
            "without gravity": self.torque(theta2, gravity=False),
            "with gravity": self.torque(theta2, gravity=True),
        }
        plot = Plot("torque", "drive torque", "N m", series, np.degrees(theta2), over)
        besides = {f"{name} as published": np.array(float(level)) for name, level in levels.items()}
        made = shown(lines(plot, besides=besides))
        return replace(made, tables={**made.tables, "figures": self.torque_table})

    def fit(self, link: int, way: str) -> Made:
        """The path of a centre with fits y(x), and beside it the fits of x and y over theta2."""
        keys, by = {
            "regression": (("regression", "parametric"), "least squares"),
            "interpolation": (("newton", "parametric-newton"), "Newton interpolation"),
        }[way]
        plots = [self.fits.plots[f"fits-{key}-g{link}"] for key in keys]
        label = f"the centre of link {link}"
        named = [replace(plot, title=plot.title.removeprefix(f"path of {label}: ")) for plot in plots]
        quality, factors = (
            table[(table["path"] == label) & (table["by"] == by)].drop(columns=["path", "by"])
            for table in (self.fits.tables["fits"], self.fits.tables["fits-coefficients"])
        )
        tables = {"": quality.dropna(axis=1, how="all"), "coefficients": factors.dropna(axis=1, how="all")}
        return Made(shown(*named, beside=True).figures, tables)
