"""Sections of an analysis in files and on the terminal: facts by key, notes, pictures where asked for."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from grashof.figures.files import save
from grashof.figures.survey_plots import section_pictures
from grashof.output.analysis_files import print_report, write_report
from grashof.output.folder import ANALYSIS_RECORD, is_own_name
from grashof.problems import load_linkage_spec
from grashof.sections.mass_centres import mass_centres
from grashof.survey import Fact, LinkageReport, Plot, Section, report_on

Grashof = Callable[..., Any]
STRENGTH = Section(
    "bar-strength",
    "Strength of the bars",
    (
        Fact("safety", "least safety factor", 2.5),
        Fact("mass", "mass of the bars", 12.25, "kg"),
        Fact("deflection", "deflection", np.inf, "m"),
        Fact("buckling", "Euler load", np.nan, "N"),
        Fact("holds", "all bars hold", False),
        Fact("count", "bars", 3),
    ),
    notes=("shear is left out",),
)
QUIET = Section("quiet", "Without facts", notes=("nobody sees this on the terminal",))
MOTOR = Section(
    "motor", "Motor", (Fact("safety", "margin of the motor", 1.25), Fact("mass", "its mass", 8.0, "kg"))
)
MORE = Section("motor", "Motor, once more", (Fact("safety", "margin", 1.5),))


@pytest.fixture(scope="module")
def jack() -> LinkageReport:
    return report_on(load_linkage_spec("pumpjack"))


@pytest.fixture(scope="module")
def told(jack: LinkageReport) -> LinkageReport:
    return replace(jack, sections=(STRENGTH, QUIET, MOTOR, MORE))


@pytest.fixture(scope="module")
def folder(told: LinkageReport, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("told") / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("grashof.figures.survey_plots.plots", lambda _: [])
        write_report(path, told)
    return path


def test_keys_of_all_facts_are_unique_and_those_of_the_summary_stay(
    folder: Path, jack: LinkageReport
) -> None:
    table = pd.read_csv(folder / "summary.csv", keep_default_na=False)
    assert table.columns.tolist() == ["quantity", "value", "unit", "what", "section"]
    assert table["quantity"].is_unique
    own = table[table["section"] == ""]
    assert own["quantity"].tolist() == [fact.key for fact in jack.facts]
    rest = table.iloc[len(own) :]
    assert rest[["quantity", "section"]].to_numpy().tolist() == [
        ["safety", "bar-strength"], ["bar_strength_mass", "bar-strength"], ["deflection", "bar-strength"],
        ["buckling", "bar-strength"], ["holds", "bar-strength"], ["count", "bar-strength"],
        ["motor_safety", "motor"], ["motor_mass", "motor"], ["motor_safety_2", "motor"],
    ]  # fmt: skip
    assert rest["value"].tolist() == ["2.5", "12.25", "inf", "", "False", "3", "1.25", "8.0", "1.5"]


def test_the_summary_is_json_that_every_reader_knows(folder: Path, jack: LinkageReport) -> None:
    def refuse(word: str) -> None:
        raise AssertionError(word)

    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"), parse_constant=refuse)
    facts = summary["facts"]
    for fact in jack.facts:
        assert facts[fact.key] == {"value": fact.value, "unit": fact.unit}
    assert facts["deflection"] == {"value": "infinite", "unit": "m", "section": "bar-strength"}
    assert facts["buckling"]["value"] is None
    assert facts["holds"]["value"] is False
    assert facts["motor_mass"] == {"value": 8.0, "unit": "kg", "section": "motor"}
    assert summary["sections"][1] == {"key": "quiet", "title": QUIET.title, "notes": list(QUIET.notes)}


def test_the_terminal_lists_facts_under_titles(
    told: LinkageReport, capsys: pytest.CaptureFixture[str]
) -> None:
    print_report(told)
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    begin = lines.index(["Strength", "of", "the", "bars", "value", "unit"])
    assert lines[begin + 2 :] == [
        ["least", "safety", "factor", "2.5"],
        ["mass", "of", "the", "bars", "12.25", "kg"],
        ["deflection", "no", "limit", "m"],
        ["Euler", "load", "-", "N"],
        ["all", "bars", "hold", "no"],
        ["bars", "3"],
        ["shear", "is", "left", "out"],
        [],
        ["Motor", "value", "unit"],
        lines[-8],
        ["margin", "of", "the", "motor", "1.25"],
        ["its", "mass", "8", "kg"],
        [],
        ["Motor,", "once", "more", "value", "unit"],
        lines[-3],
        ["margin", "1.5"],
        [],
    ]
    words = {word for line in lines for word in line}
    assert not {"Without", "nobody"} & words


def test_a_report_without_facts_of_sections_ends_with_the_extremes(
    jack: LinkageReport, capsys: pytest.CaptureFixture[str]
) -> None:
    print_report(replace(jack, sections=(QUIET,)))
    shown = capsys.readouterr().out
    print_report(replace(jack, sections=()))
    assert shown == capsys.readouterr().out


@pytest.mark.slow
def test_pictures_of_sections_are_written_when_they_are_asked_for(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("grashof.survey.report.sections_of", lambda study: (mass_centres(study),))
    monkeypatch.setattr("grashof.figures.files.save", lambda _, paths: [path.touch() for path in paths])
    folder = tmp_path / "lufkin-c912d-analysis"
    done = grashof("analyse", "lufkin-c912d", "--pictures")
    assert done.exit_code == 0, done.output
    all_of_them = {path.name for path in folder.iterdir()}
    assert grashof("analyse", "lufkin-c912d").exit_code == 0
    usual = {path.name for path in folder.iterdir()}
    assert not any(name.startswith("plot-") for name in usual)
    sections = report_on(load_linkage_spec("lufkin-c912d")).sections
    keys = [plot.key for section in sections for plot in section.plots]
    assert all_of_them - usual == {f"plot-{key}.{kind}" for key in keys for kind in ("png", "svg")}
    assert len(keys) == len(set(keys)) > 5


def test_every_file_of_a_section_is_one_that_an_analysis_may_write(jack: LinkageReport) -> None:
    tables = [f"table-{name}.csv" for section in jack.sections for name in section.tables]
    plots = [f"plot-{plot.key}.png" for section in jack.sections for plot in section.plots]
    assert len(set(tables + plots)) == len(tables + plots)
    for name in tables + plots:
        assert is_own_name(name, ANALYSIS_RECORD), name


def test_a_picture_of_curves_and_one_of_tracks(jack: LinkageReport, tmp_path: Path) -> None:
    turn = np.radians(np.arange(361.0))
    plots = (
        Plot("curve", "curve", "N", {"a": np.sin(turn)}, np.degrees(turn)),
        Plot("track", "track", "m", {"a": np.column_stack([np.cos(turn), np.sin(turn)])}),
    )
    report = replace(jack, sections=(Section("s", "S", plots=plots),))
    made = dict(section_pictures(report))
    assert list(made) == ["plot-curve", "plot-track"]
    for name, figure in made.items():
        save(figure, [tmp_path / f"{name}.png"])
        assert (tmp_path / f"{name}.png").stat().st_size > 10_000
        assert "Pumpjack" in figure.axes[0].get_title()
    assert made["plot-track"].axes[0].get_title().endswith("track")
