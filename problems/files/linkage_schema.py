"""The linkage file's structure: which keys there are, of what type, and what they may hold."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field, ValidationInfo, field_validator

from grashof.problems.files.dynamics_schema import MACHINE_TABLES, MachineTables, PumpingUnitTable
from grashof.problems.files.tables import Table, Text, listed, of_length, stated
from grashof.problems.values.checks import GREATEST, finite_number, number_within
from grashof.problems.values.dynamics_spec import metres
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.four_bar import FourBar
from grashof.problems.values.linkage_spec import LinkageSpec


def linkage_from(document: dict[str, Any], name: str, folder: Path | None = None) -> LinkageSpec:
    """Linkage stated by a parsed linkage file.

    Parameters
    ----------
    document : dict
        The file as `tomllib` gives it.
    name : str
    folder : Path, optional
        Where the file is; without it the document may name no other file.

    Raises
    ------
    ProblemError
        All errors found, a line each, with their key paths.

    Examples
    --------
    >>> given = {"o4": [4, 0], "r2": 1, "r3": 4, "r4": 3}
    >>> float(linkage_from(given, "mine").linkage.r1)
    4.0
    >>> linkage_from(given | {"coupler": [1, 1]}, "mine")
    Traceback (most recent call last):
        ...
    grashof.problems.values.errors.ProblemError: coupler is unknown; did you mean coupler_point?
    """
    return stated(LinkageTable, document, _TABLES, folder).spec(name)


_PARAMETERS = {row.key: row for row in FourBar.PARAMETERS}
Point = Annotated[list[float], listed("[x, y]"), of_length(2, "[x, y]")]


class _Linkage(Table):
    """The linkage itself; the keys of a file come in this order."""

    title: Text = ""
    source: Text = ""
    length_unit: Text = ""
    o2: Point = Field(default=[0.0, 0.0])
    o4: Point | None = None
    r1: float | None = None
    ground_angle_deg: float | None = None
    r2: float
    r3: float
    r4: float
    coupler_point: Point = Field(default=[0.0, 0.0])
    assembly: int = 1
    body_angle_deg: float = 0.0
    output_arm: float | None = None


class LinkageTable(MachineTables, _Linkage):
    """The whole linkage file."""

    pumping_unit: PumpingUnitTable | None = None

    @field_validator(*(key for key, row in _PARAMETERS.items() if row.kind != "angle"))
    @classmethod
    def _by_itself(cls, given: Any, key: ValidationInfo) -> Any:
        for number in np.ravel(_PARAMETERS[str(key.field_name)].array(given)).tolist():
            number_within(number, -GREATEST, GREATEST, str(key.field_name))
        return given

    @field_validator("r1", "output_arm")
    @classmethod
    def _length(cls, length: float | None, key: ValidationInfo) -> float | None:
        where = str(key.field_name)
        if length is not None:
            if finite_number(length, where) <= 0:
                raise ProblemError(f"{where} is {length:g}; it must be greater than zero")
            number_within(length, -GREATEST, GREATEST, where)
        return length

    @field_validator("body_angle_deg", "ground_angle_deg")
    @classmethod
    def _angle(cls, angle: float | None, key: ValidationInfo) -> float | None:
        return None if angle is None else finite_number(angle, str(key.field_name))

    def value(self) -> FourBar:
        """The linkage itself, checked with what belongs to it."""
        if (dynamics := self.dynamics_spec()) is not None and dynamics.acts:
            metres(self.length_unit)  # refuses one that is not known
        if self.pumping_unit is not None:
            metres(self.length_unit, "pumping_unit")
            if self.output_arm is None:
                raise ProblemError("output_arm is missing; pumping_unit needs that of the horsehead")
        given = {row.name: getattr(self, row.key) for row in FourBar.PARAMETERS}
        linkage = FourBar(**given | {"o4": self._o4(), "body_angle": np.radians(self.body_angle_deg)})
        if not linkage.r1 > 0:
            raise ProblemError("o4 is where o2 is; the ground pivots must be distinct")
        return linkage

    def _o4(self) -> list[float]:
        if self.o4 is not None:
            for key in ("r1", "ground_angle_deg"):
                if getattr(self, key) is not None:
                    raise ProblemError(f"{key} is given besides o4; give one of them")
            return self.o4
        if self.r1 is None:
            raise ProblemError("o4 is missing; give it, or r1 with ground_angle_deg")
        angle = np.radians(self.ground_angle_deg or 0.0)
        return [float(self.o2[0] + self.r1 * np.cos(angle)), float(self.o2[1] + self.r1 * np.sin(angle))]

    def spec(self, name: str) -> LinkageSpec:
        """What the file states."""
        return LinkageSpec(
            linkage=self.value(),
            name=name,
            title=self.title,
            source=self.source,
            length_unit=self.length_unit,
            output_arm=self.output_arm,
            dynamics=self.dynamics_spec(),
            pumping_unit=None if self.pumping_unit is None else self.pumping_unit.value(),
        )


_TABLES: dict[str, type[Table]] = {"": LinkageTable, **MACHINE_TABLES, "pumping_unit": PumpingUnitTable}
