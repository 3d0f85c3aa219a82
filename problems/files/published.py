"""Designs published for problems of the catalogue, to compare with."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from importlib import resources

import numpy as np

from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.linkages.one_loop import FourBar


class ErrorDefinition(StrEnum):
    """Definitions of a published sum of squared distances.

    At the printed driver angles, at the best driver angle for the first of the timed points, or over the
    closest points of the coupler curve in whatever order.
    """

    PRINTED_ANGLES = "printed angles"
    BEST_START = "best start"
    CLOSEST_POINTS = "closest points"


@dataclass(frozen=True, slots=True, eq=False)
class PublishedDesign:
    """A design from the literature."""

    problem: str  # name in the catalogue
    method: str  # who found it, and how
    year: int
    linkage: FourBar  # as printed, so with few digits
    error: float  # length squared: sum of squared distances of the linkage as printed
    reported: float | None  # length squared: the sum that its authors state, where it differs
    error_definition: ErrorDefinition
    theta2: FloatArray | None  # (N,), rad: printed driver angle at each point
    source: str


def published(problem: str) -> tuple[PublishedDesign, ...]:
    """Published designs for a problem of the catalogue, the best first."""
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
