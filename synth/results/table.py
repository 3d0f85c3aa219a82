"""The candidate list as a table: the columns of candidates.csv."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from grashof.analysis import curve_distances, over_task, robustness
from grashof.problems import FourBar, Problem
from grashof.synth.results.candidate import Candidate
from grashof.synth.results.ranking import pareto_optimal

# Of the motion from the first target to the last.
MOTION = ("omega4_max", "point_speed_max", "point_acceleration_max", "coupler_fit_r2")
# The same, filled when the problem has dynamics.
DYNAMICS = ("torque_peak", "torque_rms", "joint_force_peak")
# Filled when the problem says how exactly linkages are made.
MANUFACTURING = (
    *(f"move_{name}" for name in FourBar.DIMENSIONS), "worst_move",
    "share_within_linear", "share_within_made",
)  # fmt: skip
# Columns without a meaning for a task stay empty.
COLUMNS = (
    "rank", "id", "mechanism", "family", "grashof_class", "direction", "assembly", "o2_x", "o2_y", "o4_x",
    "o4_y", "r1", "r2", "r3", "r4", "p_u", "p_v", "body_angle_deg", "theta2_start_deg", "theta2_end_deg",
    "error", "error_max", "error_rms", "error_sse", "angle_error_max_deg", "angle_error_rms_deg",
    "transmission_min_task_deg", "transmission_min_cycle_deg", "circuit_ok", "branch_ok", "order_ok",
    "full_rotation", "omega4_max", "point_speed_max", "point_acceleration_max", "torque_peak",
    "torque_rms", "joint_force_peak", "coupler_fit_r2", "size", "pareto", "cognate_of", "start", "iterations",
    "best_at", "hausdorff", "frechet", *MANUFACTURING,
)  # fmt: skip


def to_frame(problem: Problem, candidates: tuple[Candidate, ...]) -> pd.DataFrame:
    """Candidates as rows, in the order given, with the columns `COLUMNS`."""
    motions = [over_task(candidate.linkage, problem, candidate.verdict) for candidate in candidates]
    best = pareto_optimal(problem, candidates)
    rows = [
        {
            "rank": rank,
            "pareto": bool(front),
            **_row(candidate),
            **_fitted(problem, candidate),
            **{name: getattr(motion, name) for name in (*MOTION, *DYNAMICS)},
            **_distances(problem, candidate),
            **_made(problem, candidate),
        }
        for rank, (candidate, front, motion) in enumerate(
            zip(candidates, best, motions, strict=True), start=1
        )
    ]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def labels(candidate: Candidate) -> dict[str, str | None]:
    """What a design is called and what it is like, by column; None where there is nothing to say."""
    return {
        "id": candidate.id,
        "mechanism": "four-bar",
        "family": candidate.family or candidate.id,
        "cognate_of": candidate.cognate_of or None,
        "best_at": candidate.best_at or None,
    }


def _fitted(problem: Problem, candidate: Candidate) -> dict[str, float]:
    """What least squares makes small: positions and angles together, weighted; root mean square."""
    if problem.requirements.is_exact(problem.task):
        return {}
    return {"error": candidate.error(problem) * problem.task.size}


def _distances(problem: Problem, candidate: Candidate) -> dict[str, float]:
    """Between the coupler curve and the polygon through the points of a closed task."""
    task, verdict = problem.task, candidate.verdict
    if not task.closed or not task.has_position.all() or not verdict.full_rotation:
        return {}
    distances = curve_distances(candidate.linkage, task.positions, verdict.direction)
    return dict(zip(("hausdorff", "frechet"), distances, strict=True))


def _made(problem: Problem, candidate: Candidate) -> dict[str, float]:
    if problem.manufacturing is None:
        return {}
    made = robustness(candidate.linkage, problem.task, candidate.verdict, problem.manufacturing)
    figures = (*made.moves.tolist(), made.worst_move, made.share_linear, made.share_made)
    return dict(zip(MANUFACTURING, figures, strict=True))


def _row(candidate: Candidate) -> dict[str, Any]:
    linkage, verdict = candidate.linkage, candidate.verdict
    driver = np.degrees(verdict.theta2[[0, -1]])
    start, end = (driver - 360 * np.ceil((driver[0] - 180) / 360)).tolist()  # it starts in (-180, 180]
    angles = {"body_angle_deg": np.nan}  # of a path, where nothing is carried
    if not np.isnan(verdict.angle_error).all():
        angle_error = np.degrees(verdict.angle_error)
        angles = {
            "angle_error_max_deg": float(np.nanmax(angle_error)),
            "angle_error_rms_deg": float(np.sqrt(np.nanmean(angle_error**2))),
        }
    return {
        **labels(candidate),
        "grashof_class": str(verdict.grashof_class),
        "direction": verdict.direction,
        **linkage.columns,
        "theta2_start_deg": start,
        "theta2_end_deg": end,
        "error_max": verdict.error_max,
        "error_rms": verdict.error_rms,
        "error_sse": verdict.error_sse,
        **angles,
        "transmission_min_task_deg": float(np.degrees(verdict.transmission_min_task)),
        "transmission_min_cycle_deg": float(np.degrees(verdict.transmission_min_cycle)),
        "circuit_ok": verdict.circuit_ok,
        "branch_ok": verdict.branch_ok,
        "order_ok": verdict.order_ok,
        "full_rotation": verdict.full_rotation,
        "size": verdict.size,
        "start": candidate.start,
        "iterations": candidate.iterations,
    }
