"""The linkage file's structure: which keys there are, of what type, and what they may hold."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, Field, ValidationInfo, create_model, field_validator

from grashof.problems.files.dynamics_schema import MachineTables, PumpingUnitTable
from grashof.problems.files.tables import Table, Text, listed, of_length, stated
from grashof.problems.values.checks import GREATEST, MOST_TURNS, finite_number, noted, number_within, refused
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.linkage_parts import Parameter
from grashof.problems.values.linkages.mechanism import ONE_LOOP, Mechanism
from grashof.problems.values.linkages.mechanisms import FOUR_BAR, PARAMETERS, linkage_of, mechanism, not_had
from grashof.problems.values.specs.linkage_spec import LinkageSpec


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
    kind = mechanism(document.get("mechanism", FOUR_BAR))
    wrong = dict(_of_other_kinds(document, kind))
    rest = {key: value for key, value in document.items() if key not in wrong}
    lines = list(wrong.values())
    with noted(lines):
        found: LinkageTable = stated(FILES[kind], rest, folder)
        if not lines:
            return found.spec(name)
    raise refused(lines)


def _of_other_kinds(document: dict[str, Any], kind: str) -> Iterator[tuple[str, str]]:
    """Keys that only linkages of other kinds have, with what is wrong."""
    for key in (key for key in document if key not in FILES[kind].model_fields):
        if having := [word for word, file in FILES.items() if key in file.model_fields]:
            yield key, not_had(key, (kind,), having)


_PARAMETERS = {row.key: row for row in PARAMETERS}
Point = Annotated[list[float], listed("[x, y]"), of_length(2, "[x, y]")]
_TYPES: dict[str, Any] = {"place": Point, "arm": Point, "sign": int}
_USUAL: dict[str, Any] = {"arm": [0.0, 0.0], "distance": 0.0, "sign": 1, "angle": 0.0}


_Word = Annotated[str, AfterValidator(mechanism)]


class _Heading(Table):
    """What every linkage file may begin with; the keys of a file come in this order.

    Parameters
    ----------
    title : str
        For people: headings of pages and drawings.
    source : str
        Where the linkage is from, for people.
    length_unit : str
        Unit of all lengths: mm, cm, m, in or ft where there are masses, otherwise any word.
    mechanism : str
        The kind of linkage; each has parameters of its own.
    """

    title: Text = ""
    source: Text = ""
    length_unit: Text = ""
    mechanism: _Word = FOUR_BAR


class LinkageTable(MachineTables, _Heading):
    """The whole linkage file, whatever the kind; the tables of each kind have its parameters besides.

    Parameters
    ----------
    r1 : float, length
        Instead of `o4`: length O2O4.
    ground_angle_deg : float, deg
        With `r1`: direction of O4 from O2; 0 without it.
    """

    @field_validator(*(key for key, row in _PARAMETERS.items() if row.kind != "angle"), check_fields=False)
    @classmethod
    def _by_itself(cls, given: Any, key: ValidationInfo) -> Any:
        if given is not None:
            for number in np.ravel(_PARAMETERS[str(key.field_name)].array(given)).tolist():
                number_within(number, -GREATEST, GREATEST, str(key.field_name))
        return given

    @field_validator("r1", "output_arm", check_fields=False)
    @classmethod
    def _length(cls, length: float | None, key: ValidationInfo) -> float | None:
        where = str(key.field_name)
        if length is not None:
            if finite_number(length, where) <= 0:
                raise ProblemError(f"{where} is {length:g}; it must be greater than zero")
            number_within(length, -GREATEST, GREATEST, where)
        return length

    @field_validator(
        "ground_angle_deg",
        *(key for key, row in _PARAMETERS.items() if row.kind == "angle"),
        check_fields=False,
    )
    @classmethod
    def _angle(cls, angle: float | None, key: ValidationInfo) -> float | None:
        most = MOST_TURNS * 360
        return None if angle is None else number_within(angle, -most, most, str(key.field_name))

    def value(self) -> Linkage:
        """The linkage itself, checked with what belongs to it."""
        if (dynamics := self.dynamics_spec()) is not None and dynamics.acts:
            metres(self.length_unit)  # refuses one that is not known
        if self._given("pumping_unit") is not None:
            metres(self.length_unit, "pumping_unit")
            if self._given("output_arm") is None:
                raise ProblemError("output_arm is missing; pumping_unit needs that of the horsehead")
        kind = ONE_LOOP[self.mechanism]
        given = {row.name: getattr(self, row.key) for row in kind.parameters}
        given |= {row.name: np.radians(given[row.name]) for row in kind.parameters if row.kind == "angle"}
        linkage = linkage_of(self.mechanism, given | ({"o4": self._o4()} if "o4" in given else {}))
        if "r1" in kind.lengths and not linkage.lengths[0] > 0:
            raise ProblemError("o4 is where o2 is; the ground pivots must be distinct")
        return linkage

    def _o4(self) -> list[float]:
        given: list[float] | None = self._given("o4")
        if given is not None:
            for key in ("r1", "ground_angle_deg"):
                if getattr(self, key) is not None:
                    raise ProblemError(f"{key} is given besides o4; give one of them")
            return given
        r1: float | None = self._given("r1")
        if r1 is None:
            raise ProblemError("o4 is missing; give it, or r1 with ground_angle_deg")
        (x, y), angle = self._given("o2"), np.radians(self._given("ground_angle_deg") or 0.0)
        return [float(x + r1 * np.cos(angle)), float(y + r1 * np.sin(angle))]

    def _given(self, key: str) -> Any:
        """What a key states; None where the kind has no such key."""
        return getattr(self, key, None)

    def spec(self, name: str) -> LinkageSpec:
        """What the file states."""
        unit = self._given("pumping_unit")
        return LinkageSpec(
            linkage=self.value(),
            name=name,
            title=self.title,
            source=self.source,
            length_unit=self.length_unit,
            output_arm=self._given("output_arm"),
            dynamics=self.dynamics_spec(),
            pumping_unit=None if unit is None else unit.value(),
        )


def _keys(row: Parameter) -> Iterator[tuple[str, Any]]:
    """The keys of a parameter, with type and default."""
    if row.name == "o4":
        yield from (("o4", (Point | None, None)), ("r1", (float | None, None)))
        yield "ground_angle_deg", (float | None, None)
    elif row.name == "o2":
        yield "o2", (Point, Field(default=[0.0, 0.0]))
    else:
        yield row.key, (_TYPES.get(row.kind, float), _USUAL.get(row.kind, ...))


def _file(kind: Mechanism) -> type[LinkageTable]:
    """The file of a kind: the parameters that it has, and what else goes with them."""
    keys = {key: made for row in kind.parameters for key, made in _keys(row)}
    also: dict[str, Any] = {"output_arm": (float | None, None)} if "o4" in keys else {}
    if kind.word == FOUR_BAR:
        also["pumping_unit"] = (PumpingUnitTable | None, None)
    name = kind.word.title().replace("-", "")
    begin = create_model(f"_{name}", __base__=_Heading, **keys)
    bases: tuple[Any, ...] = (LinkageTable, MachineTables, begin)
    file: type[LinkageTable] = create_model(f"{name}Table", __base__=bases, **also)
    return file


FILES: dict[str, type[LinkageTable]] = {word: _file(kind) for word, kind in ONE_LOOP.items()}
