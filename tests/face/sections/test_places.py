"""Masses of links, and the linkage at chosen driver angles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from section_facts import ONE_RANGE

from grashof.problems import (
    DynamicsSpec,
    FourBar,
    InvertedSliderCrank,
    Linkage,
    LinkageSpec,
    SectionSpec,
    SliderCrank,
)

STEEL = DynamicsSpec(density=7850, section=SectionSpec(0.02, 0.01), payload=0.5)
# Lengths of the bars by link; the rod of the last one reaches to the farthest place of its block.
LINKAGES: dict[str, tuple[Linkage, dict[int, float]]] = {
    "four-bar": (FourBar((0, 0), (4, 0), 1, 4, 3), {2: 1, 3: 4, 4: 3}),
    "slider-crank": (SliderCrank((0, 0), 0.5, 2), {2: 0.5, 3: 2}),
    "inverted": (InvertedSliderCrank((0, 0), (3, -2), 0.5), {2: 0.5, 3: np.sqrt(13) + 0.5}),
}


@pytest.mark.quick("four-bar", "inverted")
@pytest.mark.parametrize("kind", LINKAGES)
def test_volumes_are_those_of_the_bars(kind: str, sections: Any) -> None:
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


def test_tables_of_masses(sections: Any) -> None:
    table = sections("pumpjack")["mass-centres"].tables["masses"].set_index("link")
    assert table["mass"].tolist() == pytest.approx([372.4656, 1176.8328, 957.311268, 2506.609668])
    assert table.loc["3, coupler", ["centre_u", "centre_v"]].tolist() == [3.7719 / 2, 0]
    assert table.loc["4, output", "inertia_kg_m2"] == pytest.approx(741.513342879474)
    payload = DynamicsSpec(payload=5.0)
    spec = LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 3, (2, 1)), "x", length_unit="m", dynamics=payload)
    table = sections(spec)["mass-centres"].tables["masses"].set_index("link")
    assert table.loc["3, coupler", ["centre_u", "centre_v"]].tolist() == [2, 1]
    assert table["mass"].tolist() == [0, 5, 0, 5]


def test_the_pumpjack_at_90_deg_is_that_of_the_audit(sections: Any, golden: dict[str, Any]) -> None:
    section = sections("pumpjack", at_deg=(0, 90, 180, 135, 225))["positions"]
    table = section.tables["positions"]
    assert table["theta2_deg"].tolist() == [0, 90, 180, 135, 225]
    row = table.iloc[1]
    assert [row["g_x"], row["g_y"]] == pytest.approx([1.3821515197636443, 4.4318969846450526], abs=1e-14)
    assert [row["b_x"], row["b_y"]] == pytest.approx([1.4524716014443350, 6.1748279885398406], abs=1e-14)
    assert [row["g3_x"], row["g3_y"]] == pytest.approx([0.726236, 4.434314], abs=5e-7)
    states = golden["pumpjack_report_geometry"]["states"]["sigma=+1"]
    known = {float(state["theta2_deg"]): state for state in states}
    assert {0.0, 225.0} <= known.keys()
    for _, row in table[table["theta2_deg"].isin(known)].iterrows():
        expected = known[row["theta2_deg"]]
        for key in ("omega3", "omega4", "alpha3", "alpha4"):
            assert row[key] == pytest.approx(float(expected[key]), rel=1e-11)
        for key in ("theta3", "theta4"):  # of any sequence of angles as they are: -180 to 180 deg
            assert row[f"{key}_deg"] == pytest.approx(np.degrees(float(expected[key])), abs=1e-9)
    bars = section.plots[0].series["theta2 = 90 deg"]
    assert bars.shape == (8, 2)
    np.testing.assert_allclose(bars[2], table.loc[1, ["b_x", "b_y"]].to_numpy(dtype=float))
    assert np.hypot(*np.diff(bars[:4], axis=0).T) == pytest.approx([1.1938, 3.7719, 3.048762])


def test_angles_are_brought_into_the_range_of_the_driver(sections: Any) -> None:
    table = sections(ONE_RANGE, at_deg=(-100, 0, 360))["positions"].tables["positions"]
    assert table["theta2_deg"].tolist() == pytest.approx([-100, 0, 0])
