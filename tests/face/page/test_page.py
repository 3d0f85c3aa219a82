"""The pages as files: complete, escaped, small, and with the figures of the lists."""

from __future__ import annotations

import json
import re
from collections import Counter
from dataclasses import replace
from html import unescape
from pathlib import Path

import numpy as np
import pytest
from page_parts import RECORD, ROCKER, Parts

import grashof.figures.parts
from grashof.analysis import Loads, driver_ranges, solve_kinematics, solve_position, virtual_work_torque
from grashof.analysis.forces.from_spec import stated_masses
from grashof.live.front import SCRIPTS
from grashof.output.run_files import write_run
from grashof.page import analysis, search
from grashof.page.analysis import analysis_page
from grashof.page.columns import Column
from grashof.page.designs import Travel, driver_travel
from grashof.page.render import script_of
from grashof.page.search import search_page
from grashof.problems import FourBar, LinkageSpec, PathTask, Problem, load, load_linkage_spec
from grashof.survey import report_on
from grashof.synth import Result
from grashof.synth.designs.table import rows_of
from grashof.synth.search.ledger import LISTED, Tally

HOSTILE = "</script><script>alert(1)</script><!-- & \u2028 ' \" {{ 7*7 }}"


def page_of(result: Result, text: str = "") -> str:
    return search_page(result, RECORD, text)


@pytest.fixture(scope="module")
def hostile(few: Result) -> str:
    problem = replace(
        few.problem, title=HOSTILE, source=HOSTILE, name=HOSTILE, length_unit=HOSTILE, dynamics=None
    )
    return page_of(replace(few, problem=problem, note=HOSTILE), HOSTILE)


def test_what_the_user_wrote_is_text(hostile: str) -> None:
    parts = Parts(hostile)
    assert parts.names.count("script") == 2
    assert hostile.count("<script>alert") == 0
    assert parts.text.count(HOSTILE) >= 5
    assert parts.data["scene"]["unit"] == HOSTILE


@pytest.mark.quick("search")
@pytest.mark.parametrize("kind", ["search", "analysis"])
def test_one_file_without_any_other(hostile: str, kind: str) -> None:
    page = hostile if kind == "search" else analysis_page(report_on(load_linkage_spec("pumpjack")), RECORD)
    for tag, attributes in Parts(page).tags:
        assert not {"src", "srcset", "data", "action"} & set(attributes), tag
        # Only tables too long for the page are named: they lie beside it.
        assert re.fullmatch(r"table-[a-z-]+\.csv", attributes.get("href", "table-x.csv") or ""), tag
        assert tag not in ("link", "iframe", "img", "object")
    assert set(re.findall(r"\w+://[^\"' ]*", page)) == {"http://www.w3.org/2000/svg"}
    assert not re.search(r"url\(|@import|fetch\(|XMLHttpRequest|import\(", page)


@pytest.mark.parametrize(
    "scripts", [search._SCRIPTS, analysis._SCRIPTS, SCRIPTS], ids=["search", "analysis", "live"]
)
def test_scripts_of_a_page_define_each_name_once(scripts: tuple[str, ...]) -> None:
    """They are joined: of two functions of one name the first would be lost without a word."""
    found = re.findall(r"^(?:async )?(?:function|const|let|class) (\w+)", script_of(scripts), re.MULTILINE)
    assert len(found) > 50
    assert [name for name, count in Counter(found).items() if count > 1] == []


def test_figures_are_those_of_the_list(few: Result, tmp_path: Path) -> None:
    write_run(tmp_path, few, {"seed": 0}, drawings=0, problem_text="kind = 'motion'")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    parts = Parts(page)
    listed = json.loads((tmp_path / "candidates.json").read_text(encoding="utf-8"))["designs"]
    assert len(parts.data["designs"]) == len(listed) == len(few)
    for shown, design in zip(parts.data["designs"], listed, strict=True):
        assert shown["linkage"] == {"mechanism": design["mechanism"], **design["linkage"]}
        assert shown["theta2"] == design["theta2"]
        for key in set(shown["figures"]) & set(design) - {"assembly"}:
            assert shown["figures"][key] == design[key], key
    record = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    assert "report.html" in record["files"]
    for version in record["versions"].values():
        assert version in parts.text
    for name, count in record["counts"].items():
        assert name.rpartition(": ")[2] in parts.text
        assert str(count) in parts.text
    assert "kind = 'motion'" in parts.text
    assert "worst transmission angle over the task: from 15 deg" in parts.text


def test_the_best_of_each_family_is_shown_with_the_number_of_the_others(alike: Result) -> None:
    page = page_of(alike)
    parts = Parts(page)
    assert "8 distinct verified designs in 5 families." in parts.text
    rows = [attributes for tag, attributes in parts.tags if tag == "tr" and "data-index" in attributes]
    assert ["hidden" in row for row in rows] == [False] * 5 + [True] * 3
    example = ["2", "1", "2", "2", "1"]  # in every row, most of them hidden
    assert re.findall(r"(\d+) like this", parts.text) == example
    assert "smallest within 1.5 times" in parts.text
    families = [each["figures"]["family"] for each in parts.data["designs"]]
    assert families == [each.family for each in alike.candidates]
    some = page_of(replace(alike.top(2), tally=Tally(totals=Counter({LISTED: 8}))))
    assert "8 distinct verified designs, listed are the best 5 in 2 families." in Parts(some).text
    plain = Parts(page_of(replace(alike, candidates=alike.candidates[2:5], tally=Tally()))).text
    assert "like this" not in plain
    assert "3 distinct verified designs." in plain


def test_fifty_designs_are_small(few: Result) -> None:
    fifty = replace(few, candidates=(few.candidates * 5)[:50])
    assert len(page_of(fifty).encode()) < 500_000


def test_colours_are_those_of_the_drawings() -> None:
    style = Path(grashof.figures.parts.__file__).parents[1] / "page" / "templates" / "page.css"
    colours = dict(
        re.findall(r"--([\w-]+): (#\w+)", style.read_text(encoding="utf-8").partition("@media")[0])
    )
    links = ("driver", "coupler", "output", "coupler_2", "output_2")
    for name in (*links, "body", "path", "scene", "ground", "target", "kept_out"):
        assert colours[name.replace("_", "-")] == getattr(grashof.figures.parts, name.upper())


def test_torque_is_that_of_virtual_work(few: Result) -> None:
    designs = Parts(page_of(few)).data["designs"]
    spec = few.problem.dynamics
    assert spec is not None
    for shown, candidate in zip(designs, few.candidates, strict=True):
        theta2 = Travel(shown["low"], shown["high"], shown["turns"]).angles()
        state = solve_kinematics(candidate.linkage, theta2, spec.omega2)
        masses, still = stated_masses(candidate.linkage, spec), np.zeros((4, len(theta2)))
        expected = virtual_work_torque(state, masses, Loads(gravity=np.array(spec.gravity)), still)
        np.testing.assert_allclose(shown["torque"], expected, rtol=1e-4, atol=1e-4 * np.abs(expected).max())


def test_travel_holds_the_targets() -> None:
    low, high = driver_ranges(ROCKER)[0]
    assert driver_travel(ROCKER, np.array([0.1, 0.2])) == pytest.approx((low, high, False))
    turned = driver_travel(ROCKER, 2 * np.pi + np.array([0.1, 0.2]))
    assert turned == pytest.approx((low, high, False))
    assert turned.ahead(2 * np.pi + 0.1) == pytest.approx(2 * np.pi)
    crank = FourBar((0, 0), (4, 0), 1, 4, 3)
    assert driver_travel(crank, np.array([-0.1, 0.2])) == pytest.approx((0, 2 * np.pi, True))
    assert driver_travel(crank, np.array([-0.1, 0.2])).ahead(-0.1) == pytest.approx(-2 * np.pi)
    angles = Travel(low, high, turns=False).angles()
    assert np.isfinite(solve_position(ROCKER, angles).theta3).all()


def test_an_empty_list_shows_the_closest_miss_as_one(few: Result) -> None:
    missed = replace(few, candidates=(), nearest=few.candidates[:1], note="nothing fits")
    row = rows_of(few.problem, few.candidates)[0] | {"misses": "r3: r3 is 9, it must be from 1 to 8"}
    parts = Parts(search_page(missed, RECORD, rows=[row]))
    assert "No design found." in parts.text
    assert "Nothing fits." in parts.text
    assert "Not a design: it misses" in parts.text
    assert parts.data["designs"][0]["figures"]["misses"] == "r3: r3 is 9, it must be from 1 to 8"
    assert parts.data["found"] is False
    assert "Pareto-optimal in" not in parts.text


def test_a_search_without_anything_shows_the_task(few: Result) -> None:
    nothing = replace(few, candidates=(), nearest=(), note="no real dyads")
    parts = Parts(page_of(nothing))
    assert parts.data["designs"] == []
    assert len(parts.data["scene"]["poses"]) == 4
    assert parts.data["scene"]["body"] is not None


def test_the_scene_is_the_problem() -> None:
    problem = load("path-ellipse")
    scene = Parts(page_of(Result(problem, note="none"))).data["scene"]
    assert scene["points"] == problem.task.positions.tolist()
    assert scene["regions"] == [{"name": "O2, O4 region", "x": [-80, 80], "y": [-80, 80]}]
    assert scene["published"]["label"] == "Lin, GA-DE 2010"
    gap = np.array(scene["published"]["path"])[:, None] - problem.task.positions
    assert np.hypot(*np.moveaxis(gap, -1, 0)).min(axis=0).max() < 0.5
    assert isinstance(problem.task, PathTask)
    other = Problem(task=PathTask(problem.task.points[1:]), name="path-ellipse")
    assert Parts(page_of(Result(other))).data["scene"]["published"] is None


@pytest.mark.slow
def test_an_analysis_shows_every_curve_and_figure() -> None:
    report = report_on(load_linkage_spec("pumpjack"))
    page = analysis_page(report, RECORD)
    parts = Parts(page)
    plots = [plot for group in parts.data["groups"] for plot in group if {"places", "angles"} <= {*plot}]
    shown = [parts.data["columns"][line["values"]] for plot in plots for line in plot["series"]]
    for name in ("kinematics", "dynamics"):
        for key, values in report.tables[name].drop(columns=["theta2_deg", "omega2"]).items():
            nearest = min(np.abs(np.array(curve, dtype=float) - values).max() for curve in shown)
            assert nearest <= 1e-4 * np.abs(values).max() + 1e-12, key
    text = unescape(parts.text)
    for fact in report.facts:
        assert fact.label in text
    for what in report.tables["extremes"]["what"]:
        assert what in text


@pytest.mark.slow
def test_what_figures_are_taken_over_is_said(few: Result) -> None:
    parts = Parts(page_of(few))
    example = {column["label"]: column["about"] for column in parts.data["columns"]}
    assert example["size"].startswith("diagonal of the box around the pivots")
    assert example["peak torque, task"] == example["peak force, task"] == "from the first target to the last"
    assert set(example.values()) - {""} <= {*parts.values("title")}
    abouts = {value["key"]: value["about"] for value in parts.data["values"]}
    assert abouts["coupler_fit_r2"] == "from the first target to the last"
    for linkage, over in ((load_linkage_spec("pumpjack"), "turn"), (LinkageSpec(ROCKER, "rocker"), "travel")):
        report = report_on(linkage)
        labels = {fact.key: fact.label for fact in report.facts}
        for key in ("size", "transmission_min_deg"):
            assert f"over the {over}" in labels[key]
        assert f"Extremes over the {over}" in Parts(analysis_page(report, RECORD)).text
    assert labels["coupler_fit_r2_degree_4"].startswith("R2 of degree 4 through the path of P over ")


def test_what_rounds_to_zero_has_no_sign() -> None:
    assert Column("o2_x", "O2", "mm", 2).text(-0.001) == "0.00"


def test_ranges_of_an_analysis_are_apart() -> None:
    double = FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1))
    report = report_on(LinkageSpec(double, "double", title=HOSTILE))
    parts = Parts(analysis_page(report, RECORD))
    assert [(each["low"], each["high"]) for each in parts.data["designs"]] == list(report.sweep.ranges)
    places = parts.data["columns"][parts.data["groups"][0][0]["places"]]
    assert places[361] is None
    for angles, (low, high) in zip((places[:361], places[362:]), report.sweep.ranges, strict=True):
        assert (angles[0], angles[-1]) == pytest.approx((np.degrees(low), np.degrees(high)), rel=1e-6)
    assert HOSTILE in parts.text
