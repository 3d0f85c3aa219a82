"""What a run writes: the candidates as CSV and JSON, the closest miss, the record, the drawings."""

from __future__ import annotations

import json
import platform
from importlib.metadata import version
from pathlib import Path
from typing import Any

from grashof.folder import RECORD, replacing_own_files
from grashof.problems import FourBar
from grashof.synth import Candidate, Result
from grashof.synth.table import to_frame

_PACKAGES = ("grashof", "casadi", "numpy", "scipy", "pandas", "matplotlib")


def write_run(folder: Path, result: Result, settings: dict[str, Any], drawings: int) -> list[str]:
    """Write all files of a run.

    Parameters
    ----------
    folder : Path
    result : Result
    settings : dict
        How the search was run; goes into the record.
    drawings : int
        How many of the best designs to draw.

    Returns
    -------
    list of str
        Names of the files, sorted.

    Raises
    ------
    OSError
        The disk is full or the folder is lost; it then holds what it held before.
    """
    with replacing_own_files(folder) as fresh:
        if result.candidates:
            result.to_csv(fresh / "candidates.csv")
            _write_json(fresh / "candidates.json", _designs(result))
        if result.nearest:
            misses = ["; ".join(str(d) for d in candidate.verdict.defects) for candidate in result.nearest]
            frame = to_frame(result.problem, result.nearest).assign(misses=misses)
            frame.to_csv(fresh / "nearest.csv", index=False, lineterminator="\n")
        _draw(fresh, result, drawings)
        files = sorted([*(path.name for path in fresh.iterdir()), RECORD])
        _write_json(fresh / RECORD, _record(result, settings, files))
    return files


def _draw(folder: Path, result: Result, drawings: int) -> None:
    drawn = result.candidates[:drawings]
    if not drawn:
        return
    from grashof.draw import draw_design, save  # matplotlib takes half a second to import

    for rank, candidate in enumerate(drawn, start=1):
        stem = folder / f"design-{rank:02d}"
        figure = draw_design(result.problem, candidate, rank)
        save(figure, [stem.with_suffix(".png"), stem.with_suffix(".svg")])


def _designs(result: Result) -> dict[str, Any]:
    problem = result.problem
    return {
        "problem": problem.name,
        "title": problem.title,
        "length_unit": problem.length_unit,
        "angle_unit": "rad",
        "designs": [_design(rank, candidate) for rank, candidate in enumerate(result.candidates, start=1)],
    }


def _design(rank: int, candidate: Candidate) -> dict[str, Any]:
    verdict = candidate.verdict
    return {
        "rank": rank,
        "id": candidate.id,
        "family": "four-bar",
        "linkage": _linkage(candidate.linkage),
        "theta2": verdict.theta2.tolist(),
        "position_error": verdict.position_error.tolist(),
        "angle_error": verdict.angle_error.tolist(),
        "grashof_class": str(verdict.grashof_class),
        "direction": verdict.direction,
        "transmission_min_task": verdict.transmission_min_task,
        "transmission_min_cycle": verdict.transmission_min_cycle,
        "size": verdict.size,
        "start": candidate.start,
        "iterations": candidate.iterations,
    }


def _linkage(linkage: FourBar) -> dict[str, Any]:
    return {
        "o2": linkage.o2.tolist(),
        "o4": linkage.o4.tolist(),
        "r2": float(linkage.r2),
        "r3": float(linkage.r3),
        "r4": float(linkage.r4),
        "coupler_point": linkage.coupler_point.tolist(),
        "assembly": int(linkage.assembly),
        "body_angle": float(linkage.body_angle),
    }


def _record(result: Result, settings: dict[str, Any], files: list[str]) -> dict[str, Any]:
    guards = {name: result.counts.get(f"solver: {name}", 0) for name in _GUARDS}
    return {
        "problem": result.problem.name,
        "versions": {"python": platform.python_version(), **{name: version(name) for name in _PACKAGES}},
        "settings": settings,
        "complete": result.complete,
        "designs": len(result),
        "note": result.note,
        "counts": dict(result.counts),
        "guards_hit": guards,
        "seconds": {stage: round(time, 4) for stage, time in result.seconds.items()},
        "files": files,
    }


# What ended solves that would otherwise have gone on.
_GUARDS = ("Maximum_Iterations_Exceeded", "Maximum_WallTime_Exceeded")


def _write_json(path: Path, content: dict[str, Any]) -> None:
    path.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")
