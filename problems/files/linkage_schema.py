"""The structure of linkage files: their keys, types and allowed values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import AfterValidator, Field, ValidationInfo, create_model, field_validator

from grashof.problems.files.dynamics_schema import MachineTables, PumpingUnitTable
from grashof.problems.files.tables import (
    TWO,
    SpecTable,
    Table,
    Text,
    keys_of,
    listed,
    of_length,
    one_of,
    stated,
)
from grashof.problems.values import checks
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.errors import ProblemError, shown
from grashof.problems.values.linkages.cylinder import Cylinder
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import (
    MECHANISMS,
    ONE_LOOP,
    WORDS,
    DyadKind,
    Mechanism,
    Parameter,
)
from grashof.problems.values.linkages.mechanisms import (
    FOUR_BAR,
    PARAMETERS,
    linkage_of,
    mechanism,
    not_had,
)
from grashof.problems.values.specs.linkage_spec import LinkageSpec


def linkage_from(document: dict[str, Any], name: str, folder: Path | None = None) -> LinkageSpec:
    """Linkage stated by a parsed linkage file; `ProblemError` has a line with the key path of each error.

    Without the folder of the file the document may name no other file.
    """
    kind = mechanism(document.get("mechanism", FOUR_BAR), among=WORDS)
    wrong = dict(_of_other_kinds(document, kind))
    rest = {key: value for key, value in document.items() if key not in wrong}
    lines = list(wrong.values())
    with checks.noted(lines):
        found: LinkageTable = stated(FILES[kind], rest, folder)
        if not lines:
            return found.spec(name)
    raise checks.refused(lines)


def as_document(given: Mapping[str, Any]) -> dict[str, Any]:
    """`Linkage.stated` without angles, by the keys of a linkage file."""
    inner = {key: given[row.name] for key, row in OF_DYAD.items() if row.name in given}
    names = ("hosts", *(row.name for row in OF_DYAD.values()))
    rest = {name: value for name, value in given.items() if name not in names}
    if "hosts" in given:
        kind = DyadKind.RRP if "offset_2" in given else DyadKind.RRR
        rest["dyad"] = {"kind": str(kind), "hosts": given["hosts"], **inner}
    return rest


def _of_other_kinds(document: dict[str, Any], kind: str) -> Iterator[tuple[str, str]]:
    """Keys that only linkages of other kinds have, with their errors."""
    own = set(FILES[kind].model_fields)
    own |= set(DyadTable.model_fields) if "dyad" in own else set()  # such a key is in the wrong place
    for key in (key for key in document if key not in own):
        having = [word for word, file in FILES.items() if key in file.model_fields]
        if having:
            one_loop = [word for word in having if word in ONE_LOOP]
            yield key, not_had(key, (kind,), one_loop or having)


_SIX_BARS = tuple(row for row in MECHANISMS if len(row.dyads) > 1)


def _by_key(row: Parameter) -> tuple[str, Parameter]:
    return replace(row, name=row.name.removesuffix("_2")).key, row


# Parameters of the second dyad of six-bars, by the keys of its table; the first loop is a four-bar.
OF_DYAD = dict(
    _by_key(each) for row in _SIX_BARS for each in row.parameters if each not in row.one_loop.parameters
)
_PARAMETERS = {row.key: row for row in PARAMETERS} | {
    key: replace(row, name=row.name.removesuffix("_2")) for key, row in OF_DYAD.items()
}
_IN_RADIANS = {row.key.removesuffix("_deg") for row in _PARAMETERS.values() if row.kind == "angle"}
Point = Annotated[list[float], listed("[x, y]"), of_length(2, "[x, y]"), TWO]
_Arm = Annotated[list[float], listed("[u, v]"), of_length(2, "[u, v]"), TWO]
_Hosts = Annotated[list[int], listed("two numbers of links"), of_length(2, "two numbers of links")]
_TYPES: dict[str, Any] = {"place": Point, "arm": Point, "sign": int}
_USUAL: dict[str, Any] = {
    "o2": [0.0, 0.0], "coupler_point": [0.0, 0.0], "offset": 0.0, "assembly": 1, "slide_angle_deg": 0.0,
    "body_angle_deg": 0.0,
}  # fmt: skip


_Word = Annotated[str, AfterValidator(partial(mechanism, where="mechanism", among=WORDS))]


class _Heading(Table):
    """The heading of every linkage file; the keys of a file come in this order.

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


class _Checked(Table):
    """Parameters of a linkage, each checked by itself."""

    @field_validator("*")
    @classmethod
    def _by_itself(cls, given: Any, key: ValidationInfo) -> Any:
        where, most = str(key.field_name), checks.MOST_TURNS * 360
        row = _PARAMETERS.get(where)
        if given is None:
            return given
        if where in ("r1", "output_arm"):
            checks.positive_bounded(given, where)
        elif where == "ground_angle_deg" or (row is not None and row.kind == "angle"):
            checks.number_within(given, -most, most, where)
        elif where in _IN_RADIANS:
            checks.number_within(given, -np.radians(most), np.radians(most), where)
        elif row is not None:
            for number in np.ravel(row.array(given)).tolist():
                checks.bounded(number, where)
        return given


class _DyadTable(_Checked):
    """The second dyad of a six-bar.

    Parameters
    ----------
    kind : {"RRR", "RRP"}
        Its joints from C over E to D: three pins, or instead of D a slide on the ground.
    hosts : list of int
        The links that carry C and D, in this order: 1 is the ground. Needed where a mechanism has several.
    offset : float, length
        With a slide: of its line from O2, positive to the left of its direction; 0 without it.
    slide_angle_deg : float, deg
        With a slide: its direction, counter-clockwise from +x; 0 without it.
    slide_angle : float, rad
        Instead of `slide_angle_deg`, in radians.
    assembly : int
        +1 when E lies left of the directed line C->D, or ahead of C along the slide; else -1.
    """

    kind: Annotated[str, one_of(DyadKind.RRR, DyadKind.RRP)] = str(DyadKind.RRR)
    hosts: _Hosts | None = None

    def value(self) -> dict[str, Any]:
        """The arguments of `SixBar` that it states."""
        found, wrong = {}, []
        for key, row in OF_DYAD.items():
            having = _kinds_having(row)
            given = _argument(self, key, row)
            if self.kind in having:
                given = _USUAL.get(key) if given is None else given
                wrong += [f"{key} is missing"] if given is None else []
                found[row.name] = given
            elif given is not None:
                wrong.append(f"{key} does not go with kind {self.kind}; only {' and '.join(having)} has it")
        checks.refuse(wrong)
        return found

    def row(self, word: str) -> Mechanism:
        """The six-bar that it makes of those with a word."""
        of_kind = [row for row in _SIX_BARS if row.dyads[1].kind == self.kind]
        rows = {row.dyads[1].hosts: row for row in of_kind if row.word == word}
        ground = "a slide lies on the ground, so " if self.kind == DyadKind.RRP else ""
        if not rows:
            raise ProblemError(f"dyad.kind is '{self.kind}'; {ground}it must be RRR with mechanism {word}")
        allowed = f"{' or '.join(str(list(pair)) for pair in rows)} with mechanism {word}"
        if self.hosts is None and len(rows) > 1:
            raise ProblemError(f"dyad.hosts is missing; it must be {allowed}")
        hosts = next(iter(rows)) if self.hosts is None else (self.hosts[0], self.hosts[1])
        if hosts in rows:
            return rows[hosts]
        made = [f", which makes a {row.word}" for row in of_kind if row.dyads[1].hosts == hosts]
        given = f"dyad.hosts is {shown(self.hosts)}{''.join(made)}"
        raise ProblemError(f"{given}; {ground}it must be {allowed}")


def _kinds_having(parameter: Parameter) -> list[str]:
    """The kinds of a second dyad that have a parameter."""
    kinds = (row.dyads[1].kind for row in _SIX_BARS if parameter.name in [x.name for x in row.parameters])
    return list(dict.fromkeys(map(str, kinds)))


def _argument(table: Table, key: str, row: Parameter) -> Any:
    """The value of a parameter in a table, an angle in rad; ProblemError where it is given twice."""
    given = getattr(table, key)
    if row.kind != "angle":
        return given
    radians = in_radians(key)
    if getattr(table, radians) is None:
        return None if given is None else np.radians(given)
    if key in table.model_fields_set:
        raise ProblemError(f"{radians} is given besides {key}; give one of them")
    return getattr(table, radians)


def in_radians(key: str) -> str:
    """The key of an angle in rad, by that in deg."""
    return key.removesuffix("_deg")


class LinkageTable(_Checked, MachineTables, _Heading):
    """The complete linkage file of any kind; each kind adds its parameters.

    Parameters
    ----------
    r1 : float, length
        Instead of `o4`: length O2O4.
    ground_angle_deg : float, deg
        With `r1`: direction of O4 from O2; 0 without it.
    """

    one_loop: ClassVar[Mechanism]  # the kind without a second dyad

    def value(self) -> Linkage:
        """The linkage itself, checked with its other values."""
        if (dynamics := self.dynamics_spec()) is not None and dynamics.acts:
            metres(self.length_unit)  # refuses one that is not known
        if self._given("pumping_unit") is not None:
            metres(self.length_unit, "pumping_unit")
        kind, second = self.one_loop, dict[str, Any]()
        dyad: _DyadTable | None = self._given("dyad")
        if dyad is not None:
            kind = dyad.row(self.mechanism)
            second = dyad.value() | {"hosts": kind.dyads[1].hosts, "point_link": self._given("point_link")}
        first = [row for row in kind.parameters if row.name not in second]
        given = {row.name: _argument(self, row.key, row) for row in first} | second
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
        """The value of a key; None where the kind has no such key."""
        return getattr(self, key, None)

    def spec(self, name: str) -> LinkageSpec:
        """The file as a value."""
        unit, driven = self._given("pumping_unit"), self._given("cylinder")
        return LinkageSpec(
            linkage=self.value(),
            name=name,
            title=self.title,
            source=self.source,
            length_unit=self.length_unit,
            output_arm=self._given("output_arm"),
            dynamics=self.dynamics_spec(),
            pumping_unit=None if unit is None else unit.value(),
            cylinder=None if driven is None else driven.value(),
        )


@keys_of(Cylinder, {"base": Point, "point": Point})
class OwnCylinderTable(SpecTable):
    pass


def _keys(row: Parameter) -> Iterator[tuple[str, Any]]:
    """The keys of a parameter, with type and default."""
    if row.name == "o4":
        yield from (("o4", (Point | None, None)), ("r1", (float | None, None)))
        yield "ground_angle_deg", (float | None, None)
    else:
        yield row.key, (_TYPES.get(row.kind, float), Field(default=_USUAL.get(row.key, ...)))
        if row.kind == "angle":
            yield in_radians(row.key), (float | None, None)


def _file(word: str, kind: Mechanism, **more: Any) -> type[LinkageTable]:
    """The file of a kind: its parameters and the keys that go with them."""
    keys = {key: made for row in kind.parameters for key, made in _keys(row)} | more
    also: dict[str, Any] = {"output_arm": (float | None, None)} if "o4" in keys and not more else {}
    if "r4" in keys and not more:  # the walking beam
        also["pumping_unit"] = (PumpingUnitTable | None, None)
    also |= {} if more else {"cylinder": (OwnCylinderTable | None, None)}
    name = word.title().replace("-", "")
    begin = create_model(f"_{name}", __base__=_Heading, **keys)
    bases: tuple[Any, ...] = (LinkageTable, MachineTables, begin)
    file: type[LinkageTable] = create_model(f"{name}Table", __base__=bases, **also)
    file.one_loop = kind
    return file


def _dyad_file() -> type[_DyadTable]:
    """The table of the second dyad: keys of all kinds, and of some."""
    keys: dict[str, Any] = {}
    for key, row in OF_DYAD.items():
        of_all = set(_kinds_having(row)) == {row.dyads[1].kind for row in _SIX_BARS}
        given = _Arm if row.paired else _TYPES.get(row.kind, float)
        keys[key] = (given, _USUAL.get(key, ...)) if of_all else (given | None, None)
        keys |= {in_radians(key): (float | None, None)} if row.kind == "angle" else {}
    doc = _DyadTable.__doc__
    table: type[_DyadTable] = create_model("DyadTable", __base__=_DyadTable, __doc__=doc, **keys)
    return table


DyadTable = _dyad_file()
_SIX_BAR = _file("six-bar", _SIX_BARS[0].one_loop, point_link=(int, 5), dyad=(DyadTable, ...))
FILES: dict[str, type[LinkageTable]] = {
    **{word: _file(word, kind) for word, kind in ONE_LOOP.items()},
    **{row.word: _SIX_BAR for row in _SIX_BARS},
}
