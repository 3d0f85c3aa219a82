"""The parameters of a linkage for a sketch in CAD: SolidWorks equations, a FreeCAD spreadsheet."""

from __future__ import annotations

import csv
import math
from io import StringIO
from typing import NamedTuple

from grashof.models.model import Model

SOLIDWORKS_UNITS = ("mm", "cm", "m", "in", "ft")
_DIGITS = 15


class Row(NamedTuple):
    """A parameter: its name, its value, its unit."""

    name: str
    value: float
    unit: str


def rows(model: Model) -> list[Row]:
    """The linkage's parameters and its angles where it begins, deg, which hold the assemblies' signs."""
    unit, linkage = model.spec.length_unit, model.linkage
    kind = linkage.mechanism
    left_out = {row.name for row in kind.parameters if row.kind == "sign"} | {
        "body_angle_deg",
        *linkage.choices,
    }
    found = [
        Row(name, float(value), "deg" if name.endswith("_deg") else unit)
        for name, value in linkage.columns.items()
        if name not in left_out
    ]
    angles = model.first.angles.items()
    return found + [Row(f"theta{number}_deg", math.degrees(angle), "deg") for number, angle in angles]


def solidworks(model: Model) -> str:
    """Global variables as a text that SolidWorks imports (Tools > Equations > Import).

    Examples
    --------
    >>> from grashof.problems import load_linkage_spec
    >>> solidworks(Model.of(load_linkage_spec("engine"))).splitlines()[0]
    '"r2" = 40mm'
    """
    units = {unit: unit for unit in SOLIDWORKS_UNITS} | {"deg": "deg"}
    return "".join(
        f'"{row.name}" = {row.value:.{_DIGITS}g}{units.get(row.unit, "")}\r\n' for row in rows(model)
    )


def freecad(model: Model) -> str:
    """A table that FreeCAD's Spreadsheet workbench imports: names, and values with their units.

    Separated by tabs, as the workbench wants it.
    """
    text = StringIO()
    writer = csv.writer(text, delimiter="\t", lineterminator="\n")
    for row in rows(model):
        writer.writerow([row.name, f"={row.value:.{_DIGITS}g} {row.unit}".rstrip()])
    return text.getvalue()
