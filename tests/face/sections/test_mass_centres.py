"""Masses of links: bars of a density and a section, of every kind of linkage."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from grashof.problems import (
    DynamicsSpec,
    FourBar,
    InvertedSliderCrank,
    Linkage,
    LinkageSpec,
    SectionSpec,
    SliderCrank,
)
from grashof.study.section import Section

STEEL = DynamicsSpec(density=7850, section=SectionSpec(0.02, 0.01), payload=0.5)
# Lengths of the bars by link; the rod of the last one reaches to the farthest place of its block.
LINKAGES: dict[str, tuple[Linkage, dict[int, float]]] = {
    "four-bar": (FourBar((0, 0), (4, 0), 1, 4, 3), {2: 1, 3: 4, 4: 3}),
    "slider-crank": (SliderCrank((0, 0), 0.5, 2), {2: 0.5, 3: 2}),
    "inverted": (InvertedSliderCrank((0, 0), (3, -2), 0.5), {2: 0.5, 3: np.sqrt(13) + 0.5}),
}


@pytest.mark.quick("four-bar", "inverted")
@pytest.mark.parametrize("kind", LINKAGES)
def test_volumes_are_those_of_the_bars(kind: str, sections: Callable[..., dict[str, Section]]) -> None:
    linkage, lengths = LINKAGES[kind]
    for unit, metre in (("m", 1.0), ("mm", 1e-3)):
        spec = LinkageSpec(linkage, kind, length_unit=unit, dynamics=STEEL)
        table = sections(spec)["mass-centres"].tables["masses"].set_index("link")
        volume = {int(name[0]): row for name, row in table["volume_m3"].dropna().items()}
        expected = {link: 2e-4 * length * metre**3 for link, length in lengths.items()}
        assert volume == pytest.approx(expected, rel=1e-9, abs=0)
        mass = {int(name[0]): row for name, row in table["mass"].items() if name != "all"}
        bars = {link: 7850 * each for link, each in volume.items()}
        assert {link: mass[link] - (link == 3) * 0.5 for link in bars} == pytest.approx(bars)
        assert table.loc["all", "mass"] == pytest.approx(sum(bars.values()) + 0.5)
