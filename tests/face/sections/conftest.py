"""Linkages that an analysis has to bear, and the sections that it makes of them."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from grashof.problems import LinkageSpec, load_linkage_spec
from grashof.sections import SECTIONS
from grashof.study.asked import Asked
from grashof.study.section import Section
from grashof.study.study import LinkageStudy
from grashof.study.sweep import dead_positions_unwarned

# Rows by the keys of their sections: the name of the function, unless given here.
NAMES = {"function_section": "function", "dwell_section": "dwell", "energy_section": "energies"}
ROWS = {NAMES.get(name := row.make.__name__, name.replace("_", "-")): row for row in SECTIONS}


class Sections(Mapping[str, Section]):
    """The sections of an analysis by their keys, each made when it is read."""

    def __init__(self, study: LinkageStudy) -> None:
        self.study = study
        self.made: dict[str, Section | None] = {}

    def __getitem__(self, key: str) -> Section:
        if key not in self.made:
            row = ROWS[key]
            with dead_positions_unwarned():
                self.made[key] = row.make(self.study) if row.suits(self.study.linkage.mechanism) else None
        section = self.made[key]
        if section is None:
            raise KeyError(key)
        assert section.key == key
        return section

    def __iter__(self) -> Iterator[str]:
        return (key for key in ROWS if key in self)

    def __len__(self) -> int:
        return sum(1 for _ in self)


@pytest.fixture(scope="session")
def sections() -> Callable[..., Sections]:
    """The sections of an analysis of a linkage or of a name in the catalogue."""

    def of(linkage: LinkageSpec | str, **asked: Any) -> Sections:
        spec = load_linkage_spec(linkage) if isinstance(linkage, str) else linkage
        return Sections(LinkageStudy.of(spec, Asked(**asked)))

    return of


@pytest.fixture(scope="session")
def golden() -> dict[str, Any]:
    """The reference figures, 20 digits each."""
    path = Path(__file__).parents[2] / "data" / "golden.json"
    return json.loads(path.read_text(encoding="utf-8"))
