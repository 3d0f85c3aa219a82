"""Mutated files for `fuzz.py`: malformed problems, linkages and lists of designs.

A mutant comes from a valid file, its seed: keys are dropped, added and renamed, values replaced by
hostile ones, lists made too long or too deep; in some files the bytes are damaged as well.
"""

from __future__ import annotations

import copy
import json
import math
import random
import sys
import tempfile
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import date, datetime, time
from pathlib import Path
from string import Template
from typing import Any, Literal, get_args

from grashof import load, synthesize
from grashof.output.run_files import write_run
from grashof.problems import catalogue, linkage_catalogue, linkage_text, problem_text

Kind = Literal["problem", "linkage", "list"]
KINDS: tuple[Kind, ...] = get_args(Kind)


@dataclass(frozen=True, slots=True)
class Seed:
    """A valid file, as parsed."""

    kind: Kind
    document: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Mutant:
    """A file that may be invalid, and the changes that made it from its seed."""

    kind: Kind
    content: bytes
    made_by: tuple[str, ...]

    @property
    def suffix(self) -> str:
        """End of the file's name."""
        return ".json" if self.kind == "list" else ".toml"


def _all_stated() -> dict[str, Any]:
    return tomllib.loads((Path(__file__).parent / "seeds.toml").read_text(encoding="utf-8"))


def write_files(folder: Path) -> None:
    """Write the files that seeds name."""
    for name, text in _all_stated()["files"].items():
        (folder / name).write_text(text, encoding="utf-8")


def _stated(kind: Kind) -> list[Seed]:
    """The seeds of seeds.toml."""
    document, found = _all_stated(), []
    for row in document[kind]:
        text = row["text"]
        while "$" in text:  # parts have parts
            text = Template(text).substitute(document["parts"])
        for old, changed in row.get("changes", {}).items():
            text = text.replace(old, changed)
        found.append(Seed(kind, tomllib.loads(text)))
    return found


def problem_seeds() -> list[Seed]:
    """The problems of the catalogue, and others; together they use every key."""
    return [
        *(Seed("problem", tomllib.loads(problem_text(name))) for name in catalogue()),
        *_stated("problem"),
    ]


def linkage_seeds() -> list[Seed]:
    """The linkages of the catalogue, and others; together they use every key."""
    known = (Seed("linkage", tomllib.loads(linkage_text(name))) for name in linkage_catalogue())
    return [*known, *_stated("linkage")]


def list_seeds() -> list[Seed]:
    """A list of designs for a problem with masses and for a path, as a search writes them."""
    found = []
    for name in ("luggage", "path-vertical-line"):
        with tempfile.TemporaryDirectory() as folder:
            write_run(Path(folder), synthesize(load(name), starts=4, enough=2), {}, drawings=0)
            document = json.loads((Path(folder) / "candidates.json").read_bytes())
        found.append(Seed("list", document | {"designs": document["designs"][:3]}))
    return found


_NUMBERS: tuple[Any, ...] = (
    math.nan, math.inf, -math.inf, 1e308, -1e308, 1e-308, 5e-324, -0.0, 0, 1, -1, 0.5, 2, 3, 90, 180, 360,
    1e20, 1.0000001e20, -1e20, 1e-20, 1e-21, 1e15, 1e-12, 10**18, 10**30, 10**400, -(10**400), 2**63, 2**64,
    16**5000,
)  # fmt: skip
_WORDS: tuple[Any, ...] = (
    "", "x" * 100_000, "motion", "path", "transmission", "torque", "any", "mm", "furlong", "1", "nan",
    "\x00", "\x1b[31m", "two\nlines", "\u202e", "\u2028", "\ufeff", "\uffff", "é", "漢字", "😀", "../../x",
    "=1+1", "</script>", "{{ 7 * 7 }}", "%s%n", "$x^$",
)  # fmt: skip
_OTHERS: tuple[Any, ...] = (
    True, False, [], {}, [[]], [{}], [[[[]]]], [1], [1, 2], [2, 1], [0, 0], [1, 2, 3], [1, "2"],
    [True, False],
    [math.nan, 0], [0, math.inf], [0, 0, 0, 0], {"x": 1}, {"x": [0, 1]}, {"x": [1, 0], "y": [0]}, {"": 1},
    {"x": {"y": {"z": 0}}}, date(2024, 1, 1), time(1, 2), datetime(1, 1, 1), [date(2024, 1, 1)] * 3,
    [[0, 0], [0, 0]], [[0, 0], [1, 1], [0, 1], [1, 0]], [[0, 0], [1, 0]], [[0, 0, 0]] * 3, [["a"]] * 3,
)  # fmt: skip
_FACTORS = (-1, 0, 0.5, 0.9, 1.01, 2, 10, 1e3, 1e-3, 1e6, 1e-6, 1e15, 1e-15)


class Mutator:
    """Makes mutants of seeds."""

    def __init__(self, seeds: list[Seed], rng: random.Random) -> None:
        self.seeds, self.rng = seeds, rng
        self._tables: dict[tuple[str, str], list[tuple[str, Any]]] = {}
        for seed in seeds:
            for path, table in tables_of(seed.document):
                self._tables.setdefault((seed.kind, path), []).extend(table.items())
        self._known = sorted({key for entries in self._tables.values() for key, _ in entries})
        self._ways: tuple[tuple[int, Callable[[dict[str, Any]], None]], ...] = (
            (6, self._scale),
            (4, self._hostile),
            (2, self._add),
            (2, self._drop),
            (1, self._rename),
            (1, self._exchange),
            (2, self._length),
            (1, self._nest),
        )

    def mutant(self) -> Mutant:
        """A mutant of one of the seeds."""
        seed = self.rng.choice(self.seeds)
        document, done = copy.deepcopy(seed.document), []
        for _ in range(self.rng.choice((1, 1, 1, 2, 2, 3, 5))):
            way = self.rng.choices([way for _, way in self._ways], [weight for weight, _ in self._ways])[0]
            if document:
                way(document)
            done.append(way.__name__.lstrip("_"))
        text = _json_text(document) if seed.kind == "list" else toml_text(document)
        content = text.encode("utf-8", "surrogatepass")
        if self.rng.random() < 0.15:
            content = self._damaged(content)
            done.append("damaged")
        return Mutant(seed.kind, content, tuple(done))

    def _place(self, document: dict[str, Any], *, deep: float = 0.75) -> tuple[Any, Any]:
        """A container somewhere in the document, and the key or index of one of its entries."""
        holder: Any = document
        while True:
            keys = list(holder) if isinstance(holder, dict) else range(len(holder))
            key = self.rng.choice(keys)
            below = holder[key]
            if not (isinstance(below, (dict, list)) and below and self.rng.random() < deep):
                return holder, key
            holder = below

    def _scale(self, document: dict[str, Any]) -> None:
        """Another number in place of one: most likely to be accepted."""
        holder, key = self._place(document, deep=1.0)
        if type(holder[key]) in (int, float):
            factor = self.rng.choice((*_FACTORS, self.rng.uniform(0.5, 2)))
            holder[key] = holder[key] * factor if abs(holder[key]) < 1e300 else factor

    def _hostile(self, document: dict[str, Any]) -> None:
        holder, key = self._place(document)
        holder[key] = copy.deepcopy(self.rng.choice(self.rng.choice((_NUMBERS, _WORDS, _OTHERS))))

    def _add(self, document: dict[str, Any]) -> None:
        """A key of another file into the same table: most likely a conflict."""
        kind = "problem" if "kind" in document else "list" if "designs" in document else "linkage"
        path, table = self.rng.choice(list(tables_of(document)))
        if entries := self._tables.get((kind, path)):
            key, value = self.rng.choice(entries)
            table[key] = copy.deepcopy(value)

    def _drop(self, document: dict[str, Any]) -> None:
        holder, key = self._place(document, deep=0.6)
        del holder[key]

    def _rename(self, document: dict[str, Any]) -> None:
        _, table = self.rng.choice(list(tables_of(document)))
        if table:
            old = self.rng.choice(list(table))
            ways = (old + "s", old[:-1], old.upper(), old + "_deg", "", "a.b", "é", "x" * 5000, "\x00", "\n")
            table[self.rng.choice((*ways, self.rng.choice(self._known)))] = table.pop(old)

    def _exchange(self, document: dict[str, Any]) -> None:
        (holder, key), (other, there) = self._place(document), self._place(document)
        holder[key] = copy.deepcopy(other[there])

    def _length(self, document: dict[str, Any]) -> None:
        """A list that is too long, too short, or says the same twice."""
        holder, key = self._place(document, deep=0.5)
        entry = holder[key]
        if isinstance(entry, list) and entry:
            at = self.rng.randrange(len(entry))
            way = self.rng.random()
            if way < 0.3:
                entry.insert(at, copy.deepcopy(entry[at]))
            elif way < 0.6:
                del entry[at]
            elif way < 0.75:
                entry.reverse()
            elif way < 0.9:
                del entry[at:]
            else:
                entry[:] = (entry * (self.rng.choice((100, 4000)) // len(entry) + 1))[:4000]

    def _nest(self, document: dict[str, Any]) -> None:
        holder, key = self._place(document)
        for _ in range(self.rng.choice((1, 1, 2, 50, 150))):
            holder[key] = [holder[key]]

    def _damaged(self, content: bytes) -> bytes:
        """The bytes cut short, in another encoding, with other line ends, with something in between."""
        text, lines = content.decode("utf-8", "replace"), content.split(b"\n")
        at = self.rng.randrange(len(content) + 1)
        line = self.rng.randrange(len(lines))
        junk = (b"\x00", b"\xff\xfe", b"\xc3", b"\xed\xa0\x80", b"\x1b", b"=", b"[", b'"', b"[" * 3000, b"\r")
        return self.rng.choice(
            (
                lambda: content[:at],
                lambda: b"\xef\xbb\xbf" + content,
                lambda: text.encode("utf-16"),
                lambda: text.encode("latin-1", "replace"),
                lambda: content.replace(b"\n", b"\r\n"),
                lambda: content.replace(b"\n", b"\r"),
                lambda: b"\n".join([*lines[:line], lines[line], *lines[line:]]),
                lambda: b"\n".join([*lines[:line], *lines[line + 1 :]]),
                lambda: content[:at] + self.rng.choice(junk) + content[at:],
                lambda: content[:at] + bytes([self.rng.randrange(256)]) + content[at + 1 :],
                lambda: content + content,
            )
        )()


def _json_text(document: dict[str, Any]) -> str:
    """The same as JSON, with numbers of thousands of digits, which Python writes only on request."""
    before = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        return json.dumps(document, default=str)
    finally:
        sys.set_int_max_str_digits(before)


def toml_text(document: dict[str, Any]) -> str:
    """A document of any content as TOML: a line for each key, then the tables."""
    plain = {key: value for key, value in document.items() if not isinstance(value, dict)}
    lines = [f"{_word(key)} = {_value(value)}" for key, value in plain.items()]
    for name, table in document.items():
        if isinstance(table, dict):
            lines += [
                f"[{_word(name)}]",
                *(f"{_word(key)} = {_value(value)}" for key, value in table.items()),
            ]
    return "\n".join(lines) + "\n"


def _word(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_word(key)} = {_value(each)}" for key, each in value.items()) + " }"
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return _word(value)
    if isinstance(value, int):  # Python writes no number of thousands of digits in decimals
        return hex(value) if value > 10**1000 else repr(value)
    return value.isoformat() if isinstance(value, (date, time)) else repr(value)


def tables_of(table: dict[str, Any], path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """A document and all tables in it, with their key paths."""
    yield path, table
    for key, value in table.items():
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, dict):
                yield from tables_of(each, f"{path}.{key}".lstrip("."))
