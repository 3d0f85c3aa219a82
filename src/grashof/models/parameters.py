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
    """The parameters as a sketch needs them: those of the linkage, and its angles where it begins.

    Angles are in deg; the sign of the assembly is in the angles.
    """
    unit, linkage = model.spec.length_unit, model.linkage
    found = [
        Row(name, float(value), "deg" if name.endswith("_deg") else unit)
        for name, value in linkage.columns.items()
        if name not in ("assembly", "body_angle_deg")
    ]
    angles = {"theta2": model.start, "theta3": float(model.first.theta3), "theta4": float(model.first.theta4)}
    return found + [Row(f"{name}_deg", math.degrees(angle), "deg") for name, angle in angles.items()]


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
