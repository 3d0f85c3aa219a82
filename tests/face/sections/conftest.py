"""Linkages that an analysis has to bear, and the sections that it makes of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from grashof.problems import LinkageSpec
from grashof.sections import SECTIONS
from grashof.study.study import LinkageStudy
from grashof.study.sweep import dead_positions_unwarned
from grashof.survey import Asked, Section

Sections = Callable[..., dict[str, Section]]


@pytest.fixture(scope="session")
def sections() -> Sections:
    """All sections of an analysis, by their keys."""

    def of(spec: LinkageSpec, **asked: Any) -> dict[str, Section]:
        study = LinkageStudy.of(spec, Asked(**asked))
        with dead_positions_unwarned():
            made = [section for make in SECTIONS if (section := make(study)) is not None]
        return {section.key: section for section in made}

    return of
