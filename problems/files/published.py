"""Designs published for problems of the catalogue, to compare with."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from importlib import resources

import numpy as np

from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.linkages.four_bar import FourBar


class ErrorDefinition(StrEnum):
    """How a published sum of squared distances is meant."""

    PRINTED_ANGLES = "printed angles"
    BEST_START = "best start"
    CLOSEST_POINTS = "closest points"


@dataclass(frozen=True, slots=True, eq=False)
class PublishedDesign:
    """A design from the literature.

    Parameters
    ----------
    problem : str
        Name in the catalogue.
    method : str
        Who found it, and how.
    year : int
    linkage : FourBar
        As printed, so with few digits.
    error : float, length squared
        Sum of squared distances of the linkage as printed.
    reported : float or None, length squared
        The sum that its authors state, where it is another one.
    error_definition : ErrorDefinition
        The sum is meant at the printed driver angles, at the best driver angle for the first of
        the timed points, or over the closest points of the coupler curve in whatever order.
    theta2 : ndarray, shape (N,), rad, or None
        Printed driver angle at each point.
    source : str
    """

    problem: str
    method: str
    year: int
    linkage: FourBar
    error: float
    reported: float | None
    error_definition: ErrorDefinition
    theta2: FloatArray | None
    source: str


def published(problem: str) -> tuple[PublishedDesign, ...]:
    """Published designs for a problem of the catalogue, the best first.

    Examples
    --------
    >>> best = published("path-ellipse")[0]
    >>> best.method, best.year, float(best.linkage.r1.round(6)), round(best.error, 9)
    ('Lin, GA-DE', 2010, 80.0, 0.000401992)
    >>> published("luggage")
    ()
    """
    return tuple(design for design in _every() if design.problem == problem)


@cache
def _every() -> tuple[PublishedDesign, ...]:
    file = resources.files("grashof.problems") / "data" / "published.csv"
    rows = csv.DictReader(file.read_text(encoding="utf-8").splitlines())
    return tuple(sorted((_design(row) for row in rows), key=lambda design: design.error))


def _design(row: dict[str, str]) -> PublishedDesign:
    theta2 = np.array([float(angle) for angle in row["theta2"].split()])
    linkage = {
        each.name: np.squeeze([float(row[column]) for column in each.columns])
        for each in FourBar.mechanism.parameters
        if row.keys() >= set(each.columns)
    }
    return PublishedDesign(
        problem=row["problem"],
        method=row["method"],
        year=int(row["year"]),
        linkage=FourBar(**linkage),
        error=float(row["error"]),
        reported=float(row["reported"]) if row["reported"] else None,
        error_definition=ErrorDefinition(row["error_definition"]),
        theta2=frozen_array(theta2) if len(theta2) else None,
        source=row["source"],
    )
