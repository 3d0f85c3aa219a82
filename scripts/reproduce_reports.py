"""The two engineering reports that Grashof grew from: every figure and table, with right figures.

    python scripts/reproduce_reports.py --out reports

Prints two tables of published and right values, and writes a folder with the counterpart of each figure and
table of the reports, a page of them all (index.html), and their numbers as CSV. What the reports print stands
as text; every right value is computed by `grashof`.
"""

import argparse
import warnings
from pathlib import Path

import numpy as np
from reports.folder import COLUMNS, Row, write_folder
from reports.published import ELEVEN, JOB, LUGGAGE, MASSES, POSE_1, STEP
from reports.pumpjack import bodies
from rich.console import Console
from rich.table import Table

from grashof.analysis import (
    Loads,
    NotAFunctionWarning,
    central_differences,
    extremes,
    fit_polynomial,
    greatest_error,
    inverse_dynamics,
    newton_interpolation,
    output_stroke,
    regression,
    solve_kinematics,
    solve_position,
    system_centre,
    worst_transmission,
    worst_transmission_cycle,
)
from grashof.problems import load_linkage_spec
from grashof.problems.values.arrays import FloatArray

SAME = "same"


def pumpjack() -> list[Row]:
    """Rows about the pumpjack, at 20 rpm."""
    spec = load_linkage_spec("pumpjack")
    linkage, omega2 = spec.four_bar, 20 * 2 * np.pi / 60
    omega3 = extremes(linkage, lambda state: state.omega3, omega2)
    alpha3 = extremes(linkage, lambda state: state.alpha3, omega2)
    speed = extremes(linkage, lambda state: state.b.speed, omega2).high
    push = extremes(linkage, lambda state: state.b.acceleration_magnitude, omega2).high
    stroke = output_stroke(linkage)
    ends = np.sort(solve_kinematics(linkage, stroke.theta2, omega2).b.acceleration_magnitude)[::-1]
    a = solve_kinematics(linkage, 0.0, omega2).a
    bars, full = bodies(spec)
    upright = solve_kinematics(linkage, np.pi / 2, omega2)
    centre, centre_full = (_pair(system_centre(masses, upright).position) for masses in (bars, full))
    return [
        (
            "omega3 max / min, rad/s", "0.67 / -1.91", f"{omega3.high:.6f} / {omega3.low:.6f}",
            "theta4 taken as theta_s + mu; right is theta3 + mu",
        ),
        ("alpha3 max / min, rad/s2", "5.08 / -4", f"{alpha3.high:.6f} / {alpha3.low:.6f}", SAME),
        ("v_B max, a_B max", "6.4, 25.1", f"{speed:.6f}, {push:.6f}", SAME),
        (
            "a_B at the ends of the stroke", "0", " / ".join(f"{end:.3f}" for end in ends),
            "acceleration is not zero where velocity is",
        ),
        ("v_A, a_A", "2.5, 5", f"{a.speed:.6f}, {a.acceleration_magnitude:.6f}", "rounding"),
        ("rocker swing, deg", "69.2 (from its code)", f"{np.degrees(stroke.swing):.6f}", "as omega3"),
        (
            "system COM at theta2 = 90 deg", "(2.92, 3.19)",
            f"{centre}; with the full beam A + C {centre_full}",
            "coupler assumed horizontal; one link's centre used as the next one's joint",
        ),
        (
            "moving mass, kg", "3941.98",
            f"{bars.total:.2f} for the links simulated; {full.total:.2f} with the full beam",
            f"beam length 7.62 used, rocker is {linkage.r4:.6f}",
        ),
    ]  # fmt: skip


def luggage() -> list[Row]:
    """Rows about the luggage linkage, at 1 rad/s."""
    samples = POSE_1 + STEP * np.arange(101)
    state = solve_kinematics(LUGGAGE, samples)
    torque, heavy = (
        _peaks(inverse_dynamics(state, MASSES, Loads(gravity=(0.0, -g))).torque) for g in (0.0, 9.81)
    )
    low = [_too_low(state.theta2, derivative) for derivative in (1, 2)]
    step = f"h = 5 deg for samples {np.degrees(STEP):.4f} deg apart"
    tracks = _tracks(ELEVEN)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", NotAFunctionWarning)
        r2 = [regression(track, 2).r2 for track in tracks]
    fine = np.linspace(0, 30, 601)
    parametric = [
        greatest_error(fit_polynomial(ELEVEN, track, 4), fine, true)
        for track, true in zip(tracks, _tracks(fine), strict=True)
    ]
    task = np.degrees(worst_transmission(LUGGAGE, POSE_1, POSE_1 + JOB))
    turn = np.degrees(worst_transmission_cycle(LUGGAGE))
    return [
        (
            "torque over its 101 samples, max / min / rms", "66.48 / -28.90 / 9.48",
            f"{torque} (with gravity {heavy})", "moment arms of rows 3, 6, 9",
        ),
        ("velocities by central differences", f"{low[0]:.1%} low".replace("%", " %"), "-", step),
        ("accelerations by central differences", f"{low[1]:.1%} low".replace("%", " %"), "-", SAME),
        (
            "regression y(x), R2 of degree 2: links 2, 3, 4", '"fits"',
            ", ".join(f"{each:.3f}" for each in r2), "x not monotone",
        ),
        (
            "Newton interpolation, max error: links 2, 3, 4", '"accurate"',
            ", ".join(f"{_newton_error(link):.3g}" for link in range(3)),
            f"same; parametric degree 4: {', '.join(f'{each:.4f}' for each in parametric)} "
            "(an audit gave link 4's for link 3 too)",
        ),
        ("worst transmission angle, task / turn", "not given", f"{task:.2f} / {turn:.2f} deg", "-"),
    ]  # fmt: skip


def _tracks(every: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Centres of links 2, 3 and 4, halfway between their joints, at these of the 101 samples."""
    state = solve_position(LUGGAGE, POSE_1 + STEP * every)
    return state.a / 2, (state.a + state.b) / 2, (LUGGAGE.o4 + state.b) / 2


def _newton_error(link: int) -> float:
    """Greatest error of y(x) through five of the eleven, halfway in x between the first two of them."""
    track, fine = _tracks(ELEVEN)[link], np.linspace(0, 30, 30001)
    x, y = _tracks(fine)[link].T
    errors = []
    for first in range(7):
        halfway = track[first : first + 2, 0].mean()
        between = (fine >= 3 * first) & (fine <= 3 * first + 3)
        order = np.argsort(x[between])
        true = np.interp(halfway, x[between][order], y[between][order])
        errors.append(greatest_error(newton_interpolation(*track[first : first + 5].T), [halfway], [true]))
    return float(max(errors))


def _too_low(theta2: FloatArray, derivative: int) -> float:
    """Share by which differences come out low when 5 deg is put in for the step of the samples."""
    right, wrong = (
        central_differences(step * np.arange(len(theta2)), theta2**derivative, derivative)
        for step in (STEP, np.radians(5))
    )
    return float(np.nanmean(1 - wrong / right))


def _peaks(torque: FloatArray) -> str:
    return f"{torque.max():.2f} / {torque.min():.2f} / {np.sqrt(np.mean(torque**2)):.2f}"


def _pair(point: FloatArray) -> str:
    return f"({point[0]:.6f}, {point[1]:.6f})"


def main(argv: list[str] | None = None) -> int:
    """Print both tables, and write the folder."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("reports"), help="folder; reports by default")
    folder = parser.parse_args(argv).out
    console = Console(width=250, highlight=False, markup=False)
    rows = {"pumpjack": pumpjack(), "luggage": luggage()}
    for title, table_rows in zip(("1. The pumpjack", "2. The luggage linkage"), rows.values(), strict=True):
        table = Table(title=title, title_justify="left")
        for name in COLUMNS:
            table.add_column(name, no_wrap=True)
        for row in table_rows:
            table.add_row(*row)
        console.print(table)
    files = write_folder(folder, rows)
    console.print(f"{len(files)} files in {folder}; open {files[-1]}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
