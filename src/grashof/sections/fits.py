"""Polynomials through the paths of P and the centres of mass, as y over x and over the driver angle."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from grashof.analysis import PolynomialFit, verify
from grashof.analysis.curves.path_fits import OF_THETA2, Y_OF_X, FittedPath, PathFit
from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.sections.places import centre_labels, centres_of
from grashof.study.samples import components
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.study.sweep import INSET

KEY = "fits"
_BY = ("least squares", "Newton interpolation")
_ROOM = 1.0  # times the size of a path: distance from it up to which a fit is drawn


def fits(study: LinkageStudy) -> Section | None:
    """Regressions and interpolations over part of the motion; None unless they are requested."""
    if not study.asked.wants(KEY):
        return None
    start, end, words = fit_motion(study)
    paths = list(_paths(study, start, end))
    found = [(path, fit) for path in paths for fit in path.fits]
    tables = {
        KEY: quality_table(found),
        f"{KEY}-coefficients": coefficient_table(found),
        f"{KEY}-points": _points(paths),
    }
    plots = [plot for path in paths for plot in _plots(study, path, [fit for of, fit in found if of is path])]
    facts = tuple(_facts(tables[KEY], study.spec.unit))
    return Section(KEY, "Fits of paths", facts, tables, tuple(plots), tuple(_notes(study, paths, words)))


def fit_motion(study: LinkageStudy) -> tuple[float, float, str]:
    """First and last driver angle of the fitted part, rad, and its name; ProblemError if out of reach."""
    asked, problem = study.asked, study.spec.problem
    if asked.fit_from_deg is not None and asked.fit_to_deg is not None:
        start, end = _requested(study, asked.fit_from_deg, asked.fit_to_deg)
        return start, end, "over the requested part"
    if problem is not None and not problem.task.closed:
        done = problem.task, problem.requirements
        verdict = verify(study.linkage, *done, problem=problem, cylinder=study.spec.cylinder)
        if verdict.branch_ok and (verdict.assembly == study.linkage.assembly).all():
            ends = float(verdict.theta2.min()), float(verdict.theta2.max())
            start, end = ends if verdict.direction > 0 else ends[::-1]
            return start, end, "over the task motion"
    low, high = study.sweep.ranges[0]
    if study.sweep.turns:
        return low, high, "over the full turn"
    part = "the full range of the driver" if len(study.sweep.ranges) == 1 else "its first range"
    return low + INSET, high - INSET, f"over {part}"


def _requested(study: LinkageStudy, from_deg: float, to_deg: float) -> tuple[float, float]:
    if study.sweep.turns:
        start, end = np.radians([from_deg, to_deg])
        return float(start), float(end)
    (start,), (end,) = (
        study.in_range([angle], name) for name, angle in (("fit_from_deg", from_deg), ("fit_to_deg", to_deg))
    )
    if not any(low <= start <= high and low <= end <= high for low, high in study.sweep.ranges):
        raise ProblemError(
            f"fit_from_deg is {from_deg:.6g} and fit_to_deg {to_deg:.6g}, with a dead position between them; "
            f"the driver moves {study.reach}"
        )
    return float(start), float(end)


def _paths(study: LinkageStudy, start: float, end: float) -> Iterator[FittedPath]:
    theta2, fine = FittedPath.angles(start, end, study.asked.fit_points)
    at_points, between = study.sweep.state(theta2), study.sweep.state(fine)
    there, along = centres_of(study, at_points), centres_of(study, between)
    for key, label in centre_labels(study).items():
        if key != "g":
            yield FittedPath(key, label, theta2, there[key].position, fine, along[key].position)
    yield FittedPath("p", "P", theta2, at_points.p.position, fine, between.p.position)


def _points(paths: list[FittedPath]) -> pd.DataFrame:
    theta2 = paths[0].theta2
    columns: dict[str, FloatArray] = {"theta2_deg": np.degrees(theta2)}
    for path in paths:
        columns |= components(path.key, path.points)
    table = pd.DataFrame(columns)
    table.insert(0, "point", range(1, len(theta2) + 1))
    return table


def quality_table(found: list[tuple[FittedPath, PathFit]]) -> pd.DataFrame:
    """Quality of each fit, a row each."""
    sizes = ("degree", "r2", "error_points", "error_path")
    return pd.DataFrame([
        {"path": path.label, "fit": fit.of, "by": _BY[fit.newton]} | {key: getattr(fit, key) for key in sizes}
        for path, fit in found
    ])  # fmt: skip


def coefficient_table(found: list[tuple[FittedPath, PathFit]]) -> pd.DataFrame:
    """Coefficients of powers of x or theta2 (rad) by least squares, divided differences by Newton.

    The latter belong to 1, (t - t0), (t - t0)(t - t1), ..., where t0 is the place of `first_point`.
    """
    return pd.DataFrame([{"path": path.label, **row} for path, fit in found for row in _coefficients(fit)])


def _coefficients(fit: PathFit) -> Iterator[dict[str, object]]:
    for number, piece in enumerate(fit.pieces, start=1):
        if piece is None:
            continue
        found = piece.powers if isinstance(piece, PolynomialFit) else piece.coefficients
        named = {"by": _BY[fit.newton], "degree": fit.degree, "first_point": number}
        names = (Y_OF_X,) if fit.of == Y_OF_X else ("x over theta2", "y over theta2")
        for name, column in zip(names, found.reshape(len(found), -1).T, strict=True):
            factors = {f"c{power}": float(value) for power, value in enumerate(column)}
            yield {"fit": name, **named, **factors}


def _plots(study: LinkageStudy, path: FittedPath, found: list[PathFit]) -> Iterator[Plot]:
    for of, newton, key, what in (
        (Y_OF_X, False, "regression", "regression y over x"),
        (Y_OF_X, True, "newton", "Newton interpolation y over x"),
        (OF_THETA2, False, "parametric", "x and y by polynomials in theta2"),
        (OF_THETA2, True, "parametric-newton", "x and y by Newton interpolation over theta2"),
    ):
        of_kind = [fit for fit in found if (fit.of, fit.newton) == (of, newton)]
        series = {"path": path.path} | {f"degree {fit.degree}": _near(path, fit.line) for fit in of_kind}
        title = f"path of {path.label}: {what}"
        points = {"points fitted": path.points}
        yield Plot(f"{KEY}-{key}-{path.key}", title, study.spec.unit, series, points=points)


def _near(path: FittedPath, line: FloatArray) -> FloatArray:
    """A line where it stays near the path, NaN elsewhere."""
    low, high = path.path.min(axis=0), path.path.max(axis=0)
    room = _ROOM * float((high - low).max())
    inside = ((line >= low - room) & (line <= high + room)).all(axis=1, keepdims=True)
    return np.where(inside, line, np.nan)


def _facts(quality: pd.DataFrame, unit: str) -> Iterator[Fact]:
    best = quality[quality["degree"] == quality["degree"].max()]
    for (of, by), rows in best.groupby(["fit", "by"], sort=False):
        method = "regression" if by == _BY[False] else "newton"
        key = f"fit_{method}_{'y_of_x' if of == Y_OF_X else 'of_theta2'}_error"
        label = f"paths by {by}, {of}, degree {rows['degree'].max()}: largest error"
        yield Fact(key, label, float(rows["error_path"].max()), unit)


def _notes(study: LinkageStudy, paths: list[FittedPath], words: str) -> Iterator[str]:
    count, (first, last) = len(paths[0].theta2), np.degrees(paths[0].theta2[[0, -1]])
    between = f"from theta2 = {first:.6g} to {last:.6g} deg"
    yield f"{count} points {words}, {between}; errors are those over the path between the points, too"
    back = [path.label for path in paths if path.turns_back]
    if back:
        yield (
            f"x turns back along the path of {', '.join(back)}: y is not a function of x there; no degree "
            "corrects this; the fits of x and y over theta2 are right"
        )
    if study.masses is None:
        yield "the file states no masses: points halfway between joints"
