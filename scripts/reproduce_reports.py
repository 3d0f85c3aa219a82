"""The two engineering reports that Grashof grew from: every figure and table, with right figures.

    python scripts/reproduce_reports.py --out reports

Prints two tables of published and right values, and writes a folder with the counterpart of each figure and
table of the reports, a page of them all (index.html), and their numbers as CSV. The printed values of the
reports are given as text; every right value is computed by `grashof`.
"""

import argparse
from pathlib import Path

import numpy as np
from reports.folder import COLUMNS, Row, Sources, write_folder
from reports.luggage import Luggage
from reports.published import ELEVEN, GRAVITY, LUGGAGE, MASSES, POSE_1, SAMPLES, STEP
from reports.pumpjack import Pumpjack
from rich.console import Console
from rich.table import Table

from grashof.analysis import (
    Loads,
    greatest_error,
    inverse_dynamics,
    newton_interpolation,
    solve_kinematics,
    solve_position,
)
from grashof.problems.values.arrays import FloatArray

SAME = "same"
# Quantity, as published, right with names of figures in braces, cause: at 20 rpm, and at 1 rad/s.
ROWS: dict[str, tuple[Row, ...]] = {
    "pumpjack": (
        (
            "omega3 max / min, rad/s", "0.67 / -1.91", "{omega3_greatest:.6f} / {omega3_least:.6f}",
            "theta4 taken as theta_s + mu; right is theta3 + mu",
        ),
        ("alpha3 max / min, rad/s2", "5.08 / -4", "{alpha3_greatest:.6f} / {alpha3_least:.6f}", SAME),
        ("v_B max, a_B max", "6.4, 25.1", "{speed_b_greatest:.6f}, {push_b_greatest:.6f}", SAME),
        (
            "a_B at the ends of the stroke", "0", "{push_end_greatest:.3f} / {push_end_least:.3f}",
            "acceleration is not zero where velocity is",
        ),
        ("v_A, a_A", "2.5, 5", "{speed_a:.6f}, {push_a:.6f}", "rounding"),
        ("rocker swing, deg", "69.2 (from its code)", "{swing:.6f}", "as omega3"),
        (
            "system COM at theta2 = 90 deg", "(2.92, 3.19)",
            "({system_x:.6f}, {system_y:.6f}); with the full beam A + C "
            "({system_whole_x:.6f}, {system_whole_y:.6f})",
            "coupler assumed horizontal; one link's centre used as the next one's joint",
        ),
        (
            "moving mass, kg", "3941.98",
            "{mass:.2f} for the links simulated; {mass_whole:.2f} with the full beam",
            "beam length 7.62 used, rocker is {r4:.6f}",
        ),
    ),
    "luggage": (
        (
            "torque over its 101 samples, max / min / rms", "66.48 / -28.90 / 9.48",
            "{torque} (with gravity {torque_heavy})",
            "moment arms of rows 3, 6, 9",
        ),
        (
            "velocities by central differences", "{low_1:.1f} % low", "-",
            "h = 5 deg for samples {step:.4f} deg apart",
        ),
        ("accelerations by central differences", "{low_2:.1f} % low", "-", SAME),
        (
            "regression y(x), R2 of degree 2: links 2, 3, 4", '"fits"',
            "{r2_fit_y_2_2:.3f}, {r2_fit_y_2_3:.3f}, {r2_fit_y_2_4:.3f}", "x not monotone",
        ),
        (
            "Newton interpolation, max error: links 2, 3, 4", '"accurate"',
            "{halfway_2:.3g}, {halfway_3:.3g}, {halfway_4:.3g}",
            "same; parametric degree 4: {fit_t_4_2:.4f}, {fit_t_4_3:.4f}, {fit_t_4_4:.4f} "
            "(an audit gave link 4's for link 3 too)",
        ),
        ("worst transmission angle, task / turn", "not given", "{mu_task:.2f} / {mu_turn:.2f} deg", "-"),
    ),
}  # fmt: skip


def torque(gravity: float) -> str:
    """Greatest, least and effective drive torque, N m, of slender bars at the samples."""
    state = solve_kinematics(LUGGAGE, POSE_1 + STEP * np.arange(SAMPLES))
    torques = inverse_dynamics(state, MASSES, Loads(gravity=(0.0, -gravity))).torque
    return f"{torques.max():.2f} / {torques.min():.2f} / {np.sqrt(np.mean(torques**2)):.2f}"


def tracks(samples: FloatArray) -> dict[int, FloatArray]:
    """Centres of links 2, 3 and 4, halfway between their joints, at these of the 101 samples."""
    state = solve_position(LUGGAGE, POSE_1 + STEP * samples)
    return {2: state.a / 2, 3: (state.a + state.b) / 2, 4: (LUGGAGE.o4 + state.b) / 2}


def newton_error(link: int) -> float:
    """Greatest error of y(x) through five of the eleven, halfway in x between the first two of them."""
    track, fine = tracks(ELEVEN)[link], np.linspace(0, 30, 30001)
    x, y = tracks(fine)[link].T
    errors = []
    for first in range(7):
        halfway = track[first : first + 2, 0].mean()
        between = (fine >= 3 * first) & (fine <= 3 * first + 3)
        order = np.argsort(x[between])
        true = np.interp(halfway, x[between][order], y[between][order])
        errors.append(greatest_error(newton_interpolation(*track[first : first + 5].T), [halfway], [true]))
    return float(max(errors))


def rows_of(sources: Sources) -> dict[str, list[Row]]:
    """The tables of both reports, with their figures."""
    own: dict[str, float | str] = {f"halfway_{link}": newton_error(link) for link in (2, 3, 4)}
    own |= {"torque": torque(0.0), "torque_heavy": torque(GRAVITY)}
    found = {}
    for report, rows in ROWS.items():
        figures = sources[report].numbers | own
        found[report] = [
            (a, b.format(**figures), c.format(**figures), d.format(**figures)) for a, b, c, d in rows
        ]
    return found


def main(argv: list[str] | None = None) -> int:
    """Print both tables, and write the folder."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("reports"), help="folder; reports by default")
    folder = parser.parse_args(argv).out
    console = Console(width=250, highlight=False, markup=False)
    sources: Sources = {"pumpjack": Pumpjack(), "luggage": Luggage()}
    rows = rows_of(sources)
    for title, table_rows in zip(("1. The pumpjack", "2. The luggage linkage"), rows.values(), strict=True):
        table = Table(title=title, title_justify="left")
        for name in COLUMNS:
            table.add_column(name, no_wrap=True)
        for row in table_rows:
            table.add_row(*row)
        console.print(table)
    files = write_folder(folder, sources, rows)
    console.print(f"{len(files)} files in {folder}; open {files[-1]}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
