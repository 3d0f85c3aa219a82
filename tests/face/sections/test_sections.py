"""Every section on request, on linkages that are hard to analyse."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, load_linkage
from grashof.problems.values.dynamics.section import SectionSpec
from grashof.study.asked import ON_REQUEST
from grashof.study.section import Section
from grashof.study.sweep import Sweep

OWN = {"over-time", "positions", "mass-centres", *ON_REQUEST}
LINKAGES = {
    "crank-rocker": load_linkage("pumpjack"),
    "two ranges": FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)),
    "one range": FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1)),
    "parallelogram": FourBar((0, 0), (4, 0), 1, 4, 1, (1, 1)),
    "kite": FourBar((0, 0), (4, 0), 4, 2, 2, (1, 1)),
    "antiparallelogram": FourBar((0, 0), (4, 0), 2, 4, 2, (1, 1), -1),
    "change point": FourBar((0, 0), (4, 0), 1, 3, 2, (1, 1)),
    "P in A": FourBar((0, 0), (4, 0), 1, 4, 3),
    "minute": FourBar((0, 0), (4e-9, 0), 1e-9, 4e-9, 3e-9, (1e-9, 1e-9)),
    "huge": FourBar((1e9, 0), (4e12, 0), 1e12, 4e12, 3e12, (1e12, 1e12)),
    "all but a change point": FourBar((0, 0), (4, 0), 1, 4, 1.0000001, (1, 1)),
}
DYNAMICS = {
    "none": ("m", None),
    "clockwise, a link without mass": (
        "mm", DynamicsSpec(masses=(1, 0, 2), inertias=(0, 0, 0.1), gravity=(0, -9.81), speed_rpm=-30)
    ),
    "at rest": ("in", DynamicsSpec(mass_per_length=2.0, speed_rpm=0.0)),
    "payload alone": ("m", DynamicsSpec(payload=3.0)),
}  # fmt: skip


@pytest.mark.quick("crank-rocker-none", "minute-none")
@pytest.mark.parametrize("dynamics", DYNAMICS)
@pytest.mark.parametrize("name", LINKAGES)
def test_all_is_finite_or_empty_and_nothing_warns(sections: Any, name: str, dynamics: str) -> None:
    unit, given = DYNAMICS[dynamics]
    spec = LinkageSpec(LINKAGES[name], name, length_unit=unit, dynamics=given)
    low, high = np.degrees(Sweep.of(spec).ranges[0])
    some = {
        "at_deg": (low, (low + high) / 2, high),
        "fit_from_deg": low + 1e-3,
        "fit_to_deg": (low + high) / 2,
    }
    for asked in ({"seconds": 0.1}, {"seconds": 3.0}, some):
        found = sections(spec, sections=ON_REQUEST, **asked)
        assert len(found) > 4
        check([section for section in found.values() if section.key in OWN])


def check(sections: list[Section]) -> None:
    plots = [plot for section in sections for plot in section.plots]
    assert len({plot.key for plot in plots}) == len(plots)
    for table in (table for section in sections for table in section.tables.values()):
        assert not np.isinf(table.select_dtypes("number").to_numpy(dtype=float)).any()
    for plot in plots:
        for label, values in plot.series.items():
            assert not np.isinf(values).any(), (plot.key, label)
            assert plot.places is None or len(values) == len(plot.places)
            assert plot.places is not None or values.shape[1:] == (2,)
    for fact in (fact for section in sections for fact in section.facts):
        assert not isinstance(fact.value, float) or np.isfinite(fact.value), fact


def test_tables_of_masses(sections: Any) -> None:
    table = sections("pumpjack")["mass-centres"].tables["masses"].set_index("link")
    assert table["mass"].tolist() == pytest.approx([372.4656, 1176.8328, 957.311268, 2506.609668])
    assert table.loc["3, coupler", ["centre_u", "centre_v"]].tolist() == [3.7719 / 2, 0]
    assert table.loc["4, output", "inertia_kg_m2"] == pytest.approx(741.513342879474)
    loaded = LinkageSpec(
        FourBar((0, 0), (4, 0), 1, 4, 3, (2, 1)), "x", length_unit="m", dynamics=DynamicsSpec(payload=5.0)
    )
    table = sections(loaded)["mass-centres"].tables["masses"].set_index("link")
    assert table.loc["3, coupler", ["centre_u", "centre_v"]].tolist() == [2, 1]
    assert table["mass"].tolist() == [0, 5, 0, 5]


def test_volumes_of_bars_of_stated_density(sections: Any) -> None:
    inch = 0.0254
    dynamics = DynamicsSpec(density=7800, section=SectionSpec(0.2 / inch, 0.1 / inch), payload=7.0)
    spec = LinkageSpec(
        FourBar((0, 0), (50, 0), 10, 45, 40, (1, 1)), "bars", length_unit="in", dynamics=dynamics
    )
    table = sections(spec)["mass-centres"].tables["masses"].set_index("link")
    volumes = [0.02 * length * inch for length in (10, 45, 40)]
    assert table["volume_m3"].iloc[:3].tolist() == pytest.approx(volumes)
    masses = [7800 * volume for volume in volumes]
    assert table["mass"].tolist() == pytest.approx([masses[0], masses[1] + 7, masses[2], sum(masses) + 7])


@pytest.mark.study
def test_names_on_the_command_line(grashof: Any, tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    import grashof.figures.files as files

    monkeypatch.setattr(files, "save", lambda _, paths: [path.touch() for path in paths])
    asked = ("--all", "--seconds", "1", "--at", " 0, -90 ", "--fit-from-deg", "0", "--fit-to-deg", "90")
    done = grashof("analyse", "pumpjack", *asked)
    assert done.exit_code == 0, done.output
    folder = tmp_path / "pumpjack-analysis"
    names = {
        "over-time", "positions", "masses", "mass-centres", "mass-centres-over-time", "fits",
        "fits-coefficients", "fits-points", "newton-raphson", "differences", "differences-deviations",
        "equations",
    }  # fmt: skip
    written = {path.stem.removeprefix("table-") for path in folder.glob("table-*.csv")}
    assert names <= written
    some = grashof("analyse", "pumpjack", "--with", "equations, fits")
    assert some.exit_code == 0
    left = {"masses", "mass-centres", "fits", "fits-coefficients", "fits-points", "equations"}
    written -= {path.stem.removeprefix("table-") for path in folder.glob("table-*.csv")}
    assert written == names - left
    for wrong, message in (
        (("--at", "0;90"), "--at is '0;90'; it must be numbers with commas between them, such as 0,90,180"),
        (
            ("--with", "fit"),
            "sections is 'fit'; it must be some of newton-raphson, differences, fits, equations",
        ),
        (("--seconds", "1e9"), "seconds is 1000000000 and step 0.05; that is more than 20000 rows"),
    ):
        refused = grashof("analyse", "pumpjack", *wrong)
        assert refused.exit_code == 2
        assert message in refused.stderr
        assert refused.stderr.count("\n") == 1
