"""Linkages that an analysis has to bear, and the sections that it makes of them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from grashof.problems import LinkageSpec, load_linkage_spec
from grashof.sections import sections_of
from grashof.study.asked import Asked
from grashof.study.section import Section
from grashof.study.study import LinkageStudy
from grashof.study.sweep import dead_positions_unwarned

Sections = Callable[..., dict[str, Section]]


@pytest.fixture(scope="session")
def sections() -> Sections:
    """All sections of an analysis of a linkage or of a name in the catalogue, by their keys."""

    def of(linkage: LinkageSpec | str, **asked: Any) -> dict[str, Section]:
        spec = load_linkage_spec(linkage) if isinstance(linkage, str) else linkage
        study = LinkageStudy.of(spec, Asked(**asked))
        with dead_positions_unwarned():
            return {section.key: section for section in sections_of(study)}

    return of


@pytest.fixture(scope="session")
def golden() -> dict[str, Any]:
    """The reference figures, 20 digits each."""
    path = Path(__file__).parents[2] / "data" / "golden.json"
    return json.loads(path.read_text(encoding="utf-8"))
