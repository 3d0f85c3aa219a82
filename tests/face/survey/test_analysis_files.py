"""An analysis in files and on the terminal: facts by key, notes, pictures where asked for, exit codes."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import grashof.figures.files
from grashof.figures.files import save
from grashof.figures.section_plots import section_pictures
from grashof.output.analysis_files import print_report, write_report
from grashof.output.folder import ANALYSIS_RECORD, is_own_name
from grashof.output.run_files import write_run
from grashof.problems import FourBar, load_linkage_spec
from grashof.sections.places import mass_centres
from grashof.survey import Fact, LinkageReport, Plot, Section, report_on
from grashof.synth import Result

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
def report(jack: LinkageReport) -> LinkageReport:
    return replace(jack, sections=(STRENGTH, QUIET, MOTOR, MORE))


@pytest.fixture(scope="module")
def folder(report: LinkageReport, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("report") / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("grashof.figures.section_plots.plots", lambda _: [])
        write_report(path, report)
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
    report: LinkageReport, capsys: pytest.CaptureFixture[str]
) -> None:
    print_report(report)
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
@pytest.mark.usefixtures("unsaved")
def test_pictures_of_sections_are_written_when_they_are_asked_for(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("grashof.survey.report.sections_of", lambda study: (mass_centres(study),))
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


def test_a_linkage_that_never_closes_is_bad_input(refused: Callable[..., str], tmp_path: Path) -> None:
    (tmp_path / "far.toml").write_text("o4 = [9, 0]\nr2 = 1\nr3 = 1\nr4 = 1\n")
    assert "closes at no driver angle" in refused("analyse", "far.toml")
    assert not (tmp_path / "far-analysis").exists()


@pytest.fixture
def unsaved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures as empty files: saving them takes most of the time."""
    monkeypatch.setattr(grashof.figures.files, "save", lambda _, paths: [path.touch() for path in paths])


TABLES = {
    "kinematics.csv", "extremes.csv", "summary.csv", "summary.json", "analysis.json", "analysis.html",
}  # fmt: skip


def section_tables(name: str) -> set[str]:
    sections = report_on(load_linkage_spec(name)).sections
    return {f"table-{table}.csv" for section in sections for table in section.tables}


def pictures(*names: str) -> set[str]:
    return {f"{name}.{kind}" for name in names for kind in ("png", "svg")}


@pytest.mark.slow
@pytest.mark.usefixtures("unsaved")
def test_files_and_terminal(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("analyse", "pumpjack")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "pumpjack-analysis"
    kinematic = pictures("path", "angles", "velocities", "accelerations")
    expected = TABLES | {"dynamics.csv"} | kinematic | pictures("torque", "forces")
    expected |= section_tables("pumpjack")
    assert {path.name for path in folder.iterdir()} == expected
    assert "46.65" in done.stdout
    assert "no limit" not in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 100
    summary = json.loads((folder / "summary.json").read_text())
    assert FourBar(**summary["linkage"]) == load_linkage_spec("pumpjack").linkage
    swing = pd.read_csv(folder / "summary.csv").set_index("quantity").loc["output_swing_deg", "value"]
    assert float(swing) == summary["facts"]["output_swing_deg"]["value"]
    # Without masses the files about them go; what is not Grashof's own stays.
    (folder / "notes.txt").write_text("mine")
    again = grashof("analyse", "lufkin-c912d", "--out", folder, "--speed-rpm", "6.5")
    assert again.exit_code == 0
    expected = TABLES | section_tables("lufkin-c912d") | kinematic | {"notes.txt"}
    assert {path.name for path in folder.iterdir()} == expected


@pytest.mark.slow
@pytest.mark.usefixtures("unsaved")
def test_designs_of_a_list_beside_the_list(grashof: Grashof, few: Result, tmp_path: Path) -> None:
    folder = tmp_path / "luggage-designs"
    write_run(folder, few, {}, 0)
    lists = {path.name for path in folder.iterdir()}
    done = grashof("analyse", "luggage-designs/candidates.json#2", "--out", folder)
    assert done.exit_code == 0, done.output
    assert lists < {path.name for path in folder.iterdir()}
    row = pd.read_csv(folder / "candidates.csv").iloc[1]
    summary = json.loads((folder / "summary.json").read_text())["facts"]
    expected = pytest.approx(row["transmission_min_cycle_deg"])
    assert summary["transmission_min_deg"]["value"] == expected


def test_a_file_that_is_not_ours_is_not_replaced(refused: Callable[..., str], tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "summary.csv").write_text("mine")
    assert "summary.csv in it is not Grashof's own" in refused("analyse", "pumpjack", "--out", out)
    assert (out / "summary.csv").read_text() == "mine"


@pytest.mark.slow
@pytest.mark.usefixtures("unsaved")
def test_a_limited_range_on_the_terminal(grashof: Grashof, tmp_path: Path) -> None:
    text = "o4 = [4, 0]\nr2 = 3\nr3 = 1\nr4 = 3\nlength_unit = 'mm'\n[dynamics]\nmass_per_length = 0.01\n"
    (tmp_path / "rocker.toml").write_text(text)
    done = grashof("analyse", "rocker.toml")
    assert done.exit_code == 0, done.output
    assert done.stderr.count("\n") == 3  # the note, the files, the page to open
    assert "dead positions bound the driver's motion" in done.stderr
    assert "no limit" in done.stdout
    assert "infinite" in (tmp_path / "rocker-analysis" / "summary.json").read_text()


@pytest.mark.parametrize("given", ["pumpjak", "no/such.toml", "x.json#1", "x.json"])
def test_bad_input_is_one_line(refused: Callable[..., str], given: str) -> None:
    assert given.partition("#")[0] in refused("analyse", given)


@pytest.mark.quick("=1+1")
@pytest.mark.usefixtures("unsaved")
@pytest.mark.parametrize("unit", ["=1+1", "@SUM(A1)", "+1", "-1"])
def test_no_unit_is_a_formula_to_a_spreadsheet(grashof: Grashof, tmp_path: Path, unit: str) -> None:
    text = f'length_unit = "{unit}"\no4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n'
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    assert grashof("analyse", "mine.toml").exit_code == 0
    for name in ("summary.csv", "extremes.csv"):
        table = pd.read_csv(tmp_path / "mine-analysis" / name, dtype=str, keep_default_na=False)
        assert f"'{unit}" in set(table["unit"])
        assert not table["unit"].str.startswith(tuple("=+-@")).any()
    numbers = pd.read_csv(tmp_path / "mine-analysis" / "extremes.csv")["min"]
    assert numbers.dtype == float
    assert numbers.min() < 0
