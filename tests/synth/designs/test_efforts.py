"""Struts of designs: placed for each of a list, written with it, read back, and judged where known."""

from dataclasses import replace
from pathlib import Path

import pytest

from grashof import load, synthesize
from grashof.analysis.effort.parts import place_on
from grashof.output.process import Interruption
from grashof.output.run_files import write_run
from grashof.problems import Box, LinkageSpec, Region, load_linkage_spec
from grashof.problems.files.linkage_writing import linkage_toml
from grashof.problems.values.dynamics.struts import EffortPlace
from grashof.synth import Candidate, Result, place_parts
from grashof.synth.designs.efforts import why_without, with_best_parts, with_parts
from grashof.wording.problem import judged_for, verdict_lines


@pytest.fixture(scope="module")
def result() -> Result:
    return synthesize(load("kitchen-flap"), seed=0, starts=6, enough=1)


@pytest.fixture(scope="module")
def best(result: Result) -> Candidate:
    assert result.best is not None
    return result.best


def test_each_design_has_its_struts(result: Result) -> None:
    for design in result.candidates:
        effort = design.verdict.effort
        assert effort is not None
        assert effort.is_placed
        assert design.verdict.ok
    row = result.to_frame().iloc[0]
    assert row["part_sizes"].startswith("2 x gas ")
    assert row["effort_deviation"] == 0


def test_a_list_without_struts_says_why(result: Result, best: Candidate) -> None:
    assert why_without(result.candidates) == result.note == ""
    dynamics = best.problem.dynamics
    assert dynamics is not None
    assert dynamics.effort is not None
    (part,) = dynamics.effort.parts
    far = replace(
        part,
        between=(EffortPlace(link=1, at=Region(inside=[[9e3, 0], [9.1e3, 0], [9e3, 50]])), part.places[1]),
    )
    problem = replace(best.problem, dynamics=replace(dynamics, effort=replace(dynamics.effort, parts=(far,))))
    bare = replace(best, problem=problem, verdict=replace(best.verdict, effort=None))
    (design,) = with_best_parts([bare])
    assert design.verdict.effort is None
    assert why_without([design]).startswith("the designs have no struts or springs: no size of effort.parts")
    assert why_without([design, best]) == ""


def test_a_list_gives_the_struts_back(result: Result, best: Candidate, tmp_path: Path) -> None:
    write_run(tmp_path / "run", result, {}, 0, Interruption())
    listed = load_linkage_spec(str(tmp_path / "run" / "candidates.json") + "#1")
    assert listed.dynamics is not None
    assert best.verdict.effort is not None
    effort = listed.dynamics.effort
    assert effort is not None
    assert effort.parts == best.verdict.effort.parts
    assert place_parts(listed) == listed
    (tmp_path / "flap.toml").write_text(linkage_toml(listed), encoding="utf-8")
    shown = load_linkage_spec(str(tmp_path / "flap.toml"))
    assert shown.dynamics == listed.dynamics
    assert judged_for(load("kitchen-flap"), shown).verdict.effort == best.verdict.effort


def test_a_known_strut_whose_stroke_ends_inside_the_travel_is_a_defect(best: Candidate) -> None:
    assert best.verdict.effort is not None
    (part,) = best.verdict.effort.parts
    size = part.sizes[0]
    for key, other in (
        ("extended", replace(size, extended=size.extended - 60, stroke=size.stroke - 10)),
        ("compressed", replace(size, stroke=20.0)),
    ):
        short = replace(part, sizes=(other,))
        judged = with_parts(replace(best, verdict=replace(best.verdict, effort=None)), [short])
        (defect, *_) = judged.verdict.defects
        assert defect.requirement == "effort.parts[0]"
        assert f"beyond {key}" in defect.what
    dynamics = replace(best.problem.dynamics, effort=replace(best.verdict.effort, parts=(short,)))
    spec = LinkageSpec(best.linkage, "flap", length_unit="mm", dynamics=dynamics)
    lines = verdict_lines(judged_for(best.problem, spec), "flap")
    assert any("missed: effort.parts[0]: the least length, beyond compressed, is " in line for line in lines)


def test_a_known_strut_outside_its_area_is_a_defect(best: Candidate) -> None:
    """Ends in the frame of the body and of its link are the same; areas are of each kind of place."""
    dynamics, effort = best.problem.dynamics, best.verdict.effort
    assert dynamics is not None
    assert effort is not None
    (part,) = effort.parts
    link, (u, v) = place_on(best.linkage, part.places[1])
    x, y = part.places[1].point
    bare = replace(best, verdict=replace(best.verdict, effort=None))
    on_link = replace(part, between=(part.places[0], EffortPlace(link, Box((u, u), (v, v)))))
    areas = {
        0.0: Region(inside=[(x, y), (x + 30, y), (x, y + 30)]),
        5.0: Region(inside=[(x + 5, y - 30), (x + 50, y - 30), (x + 50, y + 30), (x + 5, y + 30)]),
        13.0: Box((x + 5, x + 50), (y + 12, y + 50)),
        2.0: Region(on=[(x - 9, y + 2), (x + 9, y + 2)]),
    }
    for away, at in areas.items():
        asked = replace(part, between=(part.places[0], EffortPlace("body", at)))
        problem = replace(best.problem, dynamics=replace(dynamics, effort=replace(effort, parts=(asked,))))
        judged = with_parts(replace(bare, problem=problem), [on_link])
        found = [(each.requirement, each.found) for each in judged.verdict.defects]
        assert found == [("effort.parts[0].between[1].at", pytest.approx(away))] * (away > 0)
    other = replace(part, between=(part.places[0], EffortPlace(2, Box((u, u), (v, v)))))
    lines = list(map(str, with_parts(bare, [other]).verdict.defects))
    assert "effort.parts[0].between[1].link: the link of the end is 2, allowed: 3" in lines
    (defect,) = with_parts(bare, [part, part]).verdict.defects
    assert str(defect) == "effort.parts: the number of struts and springs is 2, allowed: 1"
