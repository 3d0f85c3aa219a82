"""The two reports: right figures to the digits of the audit, every figure and table, none written down."""

from __future__ import annotations

import ast
import base64
import json
import re
from collections import Counter
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

SCRIPTS = Path(__file__).parents[2] / "scripts"
GOLDEN = json.loads((SCRIPTS.parent / "tests" / "data" / "golden.json").read_text(encoding="utf-8"))

PUMPJACK = [
    ("omega3 max / min, rad/s", "0.67 / -1.91", "0.724890 / -0.712527"),
    ("alpha3 max / min, rad/s2", "5.08 / -4", "1.322680 / -2.019482"),
    ("v_B max, a_B max", "6.4, 25.1", "2.661607, 7.364377"),
    ("a_B at the ends of the stroke", "0", "7.217 / 4.379"),
    ("v_A, a_A", "2.5, 5", "2.500289, 5.236593"),
    ("rocker swing, deg", "69.2 (from its code)", "46.650006"),
    (
        "system COM at theta2 = 90 deg",
        "(2.92, 3.19)",
        "(1.382152, 4.431897); with the full beam A + C (3.031086, 3.999380)",
    ),
    ("moving mass, kg", "3941.98", "2506.61 for the links simulated; 3942.22 with the full beam"),
]
LUGGAGE = [
    (
        "torque over its 101 samples, max / min / rms",
        "66.48 / -28.90 / 9.48",
        "276.39 / -435.84 / 61.61 (with gravity 348.16 / -399.11 / 69.05)",
    ),
    ("velocities by central differences", "3.6 % low", "-"),
    ("accelerations by central differences", "7.1 % low", "-"),
    ("regression y(x), R2 of degree 2: links 2, 3, 4", '"fits"', "0.592, 0.726, 0.843"),
    ("Newton interpolation, max error: links 2, 3, 4", '"accurate"', "7.58, 24.8, 51.9"),
    ("worst transmission angle, task / turn", "not given", "22.27 / 8.27 deg"),
]


@pytest.fixture(scope="module")
def sources(script: Callable[[str], ModuleType]) -> dict[str, Any]:
    """The makers of the items of either report."""
    return {
        "pumpjack": script("reports.pumpjack").Pumpjack(), "luggage": script("reports.luggage").Luggage()
    }  # fmt: skip


@pytest.fixture(scope="module")
def reports(script: Callable[[str], ModuleType]) -> ModuleType:
    return script("reproduce_reports")


def listed() -> list[Any]:
    with pytest.MonkeyPatch.context() as patched:
        patched.syspath_prepend(SCRIPTS)
        return list(import_module("reports.folder").items())


ITEMS = listed()


@pytest.mark.slow
def test_both_tables_are_those_of_the_audit_and_are_printed(
    reports: ModuleType, sources: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    written: dict[str, Any] = {}
    for name, source in sources.items():
        monkeypatch.setattr(reports, name.capitalize(), lambda source=source: source)
    monkeypatch.setattr(
        reports, "write_folder", lambda *given: written.update(given[-1]) or [Path("index.html")]
    )
    assert reports.main(["--out", str(tmp_path)]) == 0
    assert [row[:3] for row in written["pumpjack"]] == PUMPJACK
    rows = written["luggage"]
    assert [row[:3] for row in rows] == LUGGAGE
    assert rows[4][3].startswith("same; parametric degree 4: 0.0031, 0.0103, 0.0098 ")
    assert rows[1][3] == "h = 5 deg for samples 4.8194 deg apart"
    printed = capsys.readouterr().out.splitlines()
    for row in PUMPJACK + LUGGAGE:
        assert any(all(cell in line for cell in row) for line in printed), row


def test_the_parametric_fit_by_a_second_method(reports: ModuleType) -> None:
    """Link 3's figure is not link 4's, as the audit has it: its error is that of the two others added up."""
    fine, off = np.linspace(0, 30, 3001), []
    for track, true in zip(
        reports.tracks(reports.ELEVEN).values(), reports.tracks(fine).values(), strict=True
    ):
        off.append(np.polynomial.Chebyshev.fit(reports.ELEVEN, track[:, 0] + 1j * track[:, 1], 4)(fine))
        off[-1] -= true[:, 0] + 1j * true[:, 1]
    assert [round(float(np.abs(each).max()), 4) for each in off] == [0.0031, 0.0103, 0.0098]
    np.testing.assert_allclose(off[1], off[0] + off[2], rtol=0, atol=1e-12)


def test_no_right_figure_is_written_down() -> None:
    """Neither those of the tables nor, with all their digits, those that the items quote."""
    code = [SCRIPTS / "reproduce_reports.py", *(SCRIPTS / "reports").glob("*.py")]
    texts = [
        str(node.value)
        for path in code
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and "``" not in str(node.value)
    ]
    written = "\n".join(text for text in texts if not text.startswith("The two engineering reports"))
    written += "\n".join(item.right + item.wrong for item in ITEMS)
    for _, _, right in PUMPJACK + LUGGAGE:
        for figure in right.replace("(", " ").replace(")", " ").replace(",", " ").replace(";", " ").split():
            if "." in figure:
                assert figure not in written, figure


def test_every_figure_and_table_of_the_reports_is_listed() -> None:
    """The lists of both: figures and tables by number, and statements besides."""
    found = {
        name: Counter(item.figure for item in ITEMS if item.report == name)
        for name in ("pumpjack", "luggage")
    }
    assert found["pumpjack"] == Counter(
        {"-": 1, "F1": 1, "F2": 3, "F3": 1, "F4": 1, "F5": 1, "F6": 1, "printed": 1, "text": 2, "table": 2}
    ) + Counter({"pictures": 4})  # fmt: skip
    single = [f"F{n}" for n in (*range(1, 19), 36, 37, 38, 39, 40, 41)] + [f"T{n}" for n in range(2, 10)]
    ranges = {"F19 to F22": 4, "F23 to F34": 12, "F35": 3, "printed": 1}
    assert found["luggage"] == Counter(single) + Counter(ranges)
    assert len({item.stem for item in ITEMS}) == len(ITEMS)
    angles = [item.args[0] for item in ITEMS if item.figure == "pictures"]
    assert sorted(angles) == [0, 90, 135, 180]


@pytest.mark.quick("pumpjack-f1", "luggage-f2", "luggage-f13", "luggage-f29", "luggage-printed")
@pytest.mark.parametrize("item", ITEMS, ids=lambda item: item.stem)
def test_each_has_its_counterpart(item: Any, sources: dict[str, Any]) -> None:
    for words in (item.title, item.reported, item.right, item.wrong):
        assert len(words) > 5
    # Right figures are in braces; decimals of the report occur in `reported` alone.
    plain = re.sub(r"{[^}]*}", "", item.right + item.wrong)
    assert re.findall(r"\d\.\d", plain) == []
    source = sources[item.report]
    for words in (item.right, item.wrong):
        assert "nan" not in words.format(**source.numbers)
    if item.make == "printed":
        return
    made = getattr(source, item.make)(*item.args)
    assert made.figures or made.tables
    for figure in made.figures.values():
        if isinstance(figure, Figure):
            assert all(drawn(axes) for axes in figure.axes)
        else:
            figure._draw_was_started = True  # else matplotlib warns that it was never seen
    for table in made.tables.values():
        assert len(table)
        assert not np.isinf(table.select_dtypes("number").to_numpy(dtype=float)).any()


def drawn(axes: Axes) -> bool:
    return any(np.isfinite(np.asarray(line.get_xydata())).all(axis=1).any() for line in axes.lines)


def test_the_curves_as_published_are_those_of_the_code_of_the_report(sources: dict[str, Any]) -> None:
    """Its wrong theta4 put into the right equations gives what its code gives at its 301 samples."""
    wrong, published = sources["pumpjack"].wrong, GOLDEN["report_figures"]["pumpjack"]["code_301_samples"]
    for values, key in (
        (np.radians(wrong.theta4_deg), "theta4"), (wrong.omega3, "theta3dot"), (wrong.alpha3, "theta3ddot"),
        (wrong.speed, "vC"), (wrong.acceleration, "aC"),
    ):  # fmt: skip
        assert [values.min(), values.max()] == pytest.approx(published[key], rel=1e-8)


def test_words_quote_the_figures_of_the_audit(sources: dict[str, Any]) -> None:
    said = {item.stem: item.right.format(**sources[item.report].numbers) for item in ITEMS}
    said |= {f"{item.stem} wrong": item.wrong.format(**sources[item.report].numbers) for item in ITEMS}
    for stem, figures in {
        "pumpjack-dimensions": ("145.556", "68.825"),
        "pumpjack-dimensions wrong": ("192.875608", "51.525764"),
        "pumpjack-f2-angles": ("46.650006",),
        "pumpjack-f3": ("0.724890", "-0.712527"),
        "pumpjack-f4": ("2.500289", "2.661607"),
        "pumpjack-f5": ("1.322680", "-2.019482"),
        "pumpjack-f6": ("5.236593", "7.364377", "7.217", "4.379"),
        "pumpjack-strokes": ("1.0658", "slower"),
        "pumpjack-masses": ("2506.61", "3942.22", "7.620762"),
        "pumpjack-centres": (
            "(0.726236, 4.434314)", "(2.726236, 5.337414)", "(1.382152, 4.431897)", "(3.031086, 3.999380)"
        ),
        "luggage-f2": ("22.27", "8.27"),
        "luggage-t7": ("5.96", "4.60"),
        "luggage-f19 wrong": ("4.8194", "3.6 %"),
        "luggage-f20 wrong": ("7.1 %",),
        "luggage-f35-samples": ("276.39", "-435.84", "61.6", "348.16", "-399.11", "69.05"),
        "luggage-f35-turn": ("299.093", "-464.690", "70.5188"),
        "luggage-f35-job": ("6.302", "-1.283", "1.632", "10.64", "-27.69", "19.61"),
        "luggage-f36": ("0.9839", "0.532", "0.592", "0.605", "0.637", "0.0031"),
        "luggage-f37": ("1.0308", "0.726"),
        "luggage-f38": ("1.0577", "0.711", "0.843", "0.856", "0.0098"),
    }.items():  # fmt: skip
        for figure in figures:
            assert figure in said[stem], (stem, figure, said[stem])


@pytest.mark.study
def test_the_folder_has_them_all(reports: ModuleType, tmp_path: Path) -> None:
    assert reports.main(["--out", str(tmp_path / "made")]) == 0
    folder = tmp_path / "made"
    page = (folder / "index.html").read_text(encoding="utf-8")
    assert "http" not in page
    for item in ITEMS:
        files = [*folder.glob(f"{item.stem}.*"), *folder.glob(f"{item.stem}-*")]
        assert files, item.stem
        assert all(path.stat().st_size > 10 for path in files)
        assert f'id="{item.stem}"' in page
    for path in folder.glob("*.png"):
        with Image.open(path) as picture:
            assert picture.width == 1105
        assert base64.b64encode(path.read_bytes()).decode() in page
    for path in folder.glob("*.csv"):
        assert len(pd.read_csv(path))
    with Image.open(folder / "pumpjack-f1-moving.gif") as moving:
        assert moving.n_frames > 30
