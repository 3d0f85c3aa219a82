"""Lists of several kinds of linkages: one table, files that lose nothing, a page and drawings by kind."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from grashof.analysis import solve_position, verify
from grashof.figures.files import draw_design, drawn
from grashof.output.run_files import write_run
from grashof.output.terminal import best_rows, heading
from grashof.page.designs import legend
from grashof.problems import (
    DynamicsSpec,
    FourBar,
    InvertedSliderCrank,
    Linkage,
    PathTask,
    Problem,
    Requirements,
    SliderCrank,
    load_linkage_spec,
)
from grashof.problems.files.linkage_file import load_design
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.synth import Candidate, Result
from grashof.workshop.export import Making, export_files
from grashof.workshop.plates import PlateSizes

LINKAGES: tuple[Linkage, ...] = (
    SliderCrank((0, 0), 1, 3, 0.3, 0.2, (1, 1)),
    FourBar((0, 0), (4, 0), 1, 4, 3, (2, 1.5)),
    InvertedSliderCrank((0, 0), (2, 1), 1, 0.1, (3, 0.5)),
    InvertedSliderCrank((0, 0), (1, 0), 2, -0.3, (3, -0.5), -1),
)


def mixed(kinds: tuple[str, ...] = tuple(ONE_LOOP), linkages: tuple[Linkage, ...] = LINKAGES) -> Result:
    points = solve_position(LINKAGES[0], np.linspace(0.3, 3.3, 6)).p
    problem = Problem(
        task=PathTask(points),
        requirements=Requirements(exact=False),
        mechanism=kinds,
        name="mixed",
        length_unit="mm",
        dynamics=DynamicsSpec(masses=(1, 1, 1), inertias=(1, 1, 1), speed_rpm=60),
    )
    designs = []
    for start, linkage in enumerate(linkages):
        verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
        design = Candidate(linkage, verdict, problem, start, 0)
        designs.append(replace(design, family=design.id))
    return Result(problem, tuple(designs))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("mixed") / "mixed-designs"
    path.mkdir()
    write_run(path, mixed(), {"seed": 0}, drawings=0, problem_text="kind = 'path'")
    return path


@pytest.mark.slow
def test_every_design_comes_back_to_the_last_digit(folder: Path) -> None:
    for rank, linkage in enumerate(LINKAGES, start=1):
        design = load_design(folder / "candidates.json", str(rank))
        assert design.spec.linkage == linkage
        assert type(design.spec.linkage) is type(linkage)
        assert design.spec.problem is not None
        assert design.spec.problem.mechanism == tuple(ONE_LOOP)
        assert load_linkage_spec(f"{folder / 'candidates.json'}#{design.id}").linkage == linkage


def test_columns_that_a_kind_lacks_are_empty(folder: Path) -> None:
    with (folder / "candidates.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for row, linkage in zip(rows, LINKAGES, strict=True):
        assert row["mechanism"] == linkage.mechanism.word
        for name, value in linkage.columns.items():
            if name not in ("assembly", "body_angle_deg"):  # the task has no angles
                assert float(row[name]) == value
        others = {"o4_x", "o4_y", "r1", "r3", "r4", "offset", "slide_angle_deg"} - set(linkage.columns)
        assert all(row[name] == "" for name in others)
    far, near = np.sqrt(16 - 0.09), np.sqrt(4 - 0.09)
    assert float(rows[0]["stroke"]) == pytest.approx(far - near, rel=1e-12)
    assert [row["stroke"] for row in rows[1:]] == ["", "", ""]
    assert rows[0]["output_swing_deg"] == rows[0]["omega4_max"] == ""


def test_quantities_that_no_kind_has_are_not_listed(tmp_path: Path) -> None:
    write_run(tmp_path, mixed(("four-bar",), LINKAGES[1:2]), {"seed": 0}, drawings=0, problem_text="")
    design = json.loads((tmp_path / "candidates.json").read_text())["designs"][0]
    assert design["mechanism"] == "four-bar"
    assert not {"stroke", "move_offset"} & set(design)


def test_the_terminal_has_a_column_of_the_mechanism() -> None:
    rows = best_rows(mixed())
    assert [row["mechanism"] for row in rows] == [linkage.mechanism.word for linkage in LINKAGES]
    assert [row["offset"] for row in rows] == ["0.3", "-", "0.1", "-0.3"]
    assert [row["O4"] for row in rows] == ["-", "4, 0", "2, 1", "1, 0"]
    assert [row["r4"] for row in rows] == ["-", "3", "-", "-"]
    assert [row["class"] for row in rows][:2] == ["slider-crank", "crank-rocker"]
    assert "4 distinct verified designs" in heading(mixed(), 4)
    alone = best_rows(mixed(("slider-crank",), LINKAGES[:1]))
    assert not {"mechanism", "O4", "r1", "r4"} & set(alone[0])
    assert {"r2", "r3", "offset"} <= set(alone[0])
    plain = best_rows(mixed(("four-bar",), LINKAGES[1:2]))
    assert not {"mechanism", "offset"} & set(plain[0])


def test_the_page_has_the_same_column_and_each_kind_in_its_legend(folder: Path) -> None:
    page = (folder / "report.html").read_text(encoding="utf-8")
    for linkage in LINKAGES:
        assert f'<td class="text">{linkage.mechanism.word}</td>' in page
    data = json.loads(page.split('id="data">')[1].split("</script>")[0])
    assert [each["linkage"]["mechanism"] for each in data["designs"]] == [
        each.mechanism.word for each in LINKAGES
    ]
    assert all(len([x for x in each["torque"] if x is not None]) > 100 for each in data["designs"])
    assert dict(legend(ONE_LOOP.values()))["output"] == "output O4-B, slider B, block O4-B"
    assert "output O4-B, slider B, block O4-B" in page or "slider B, output O4-B, block O4-B" in page


def test_a_design_is_drawn_by_its_kind() -> None:
    result, block = mixed(), LINKAGES[2].mechanism.links[-1]
    text = drawn(draw_design(result.problem, result.candidates[2], 3), ".svg").decode("utf-8")
    assert f"{block.name} {'-'.join(block.labels)}" in text


def test_the_objects_have_the_columns_of_the_table(folder: Path) -> None:
    """Columns with a value in some design, named without `_deg`, angles in radians."""
    designs = json.loads((folder / "candidates.json").read_text())["designs"]
    table = pd.read_csv(folder / "candidates.csv").dropna(axis="columns", how="all")
    for name in table.columns.difference(["assembly"]):
        for design, value in zip(designs, table[name].tolist(), strict=True):
            found = design[name.removesuffix("_deg")]
            if isinstance(value, float):
                expected = np.radians(value) if name.endswith("_deg") else value
                assert found == pytest.approx(expected, rel=1e-12) if np.isfinite(value) else found is None
            else:
                assert found == value


def test_a_design_of_a_list_is_exported(folder: Path, tmp_path: Path) -> None:
    files = {kind: tmp_path / f"design.{kind}" for kind in ("dxf", "svg", "xlsx")}
    making = Making(PlateSizes(), scale="100:1")
    plan = export_files(f"{folder / 'candidates.json'}#3", making, files).plan
    assert plan is not None
    slots = [slot for part in plan.parts for slot in part.plate.slots]
    assert len(slots) == 1
    assert all(path.stat().st_size for path in files.values())


def test_names_of_designs_distinguish_kinds() -> None:
    result = mixed()
    assert len({candidate.id for candidate in result.candidates}) == 4
    turned = replace(result.candidates[0], linkage=LINKAGES[0].changed(slide_angle=0.3))
    assert turned.id != result.candidates[0].id
    assert "slider-crank, r2 1, r3 3, offset 0.3, mu" in repr(result.candidates[0])
