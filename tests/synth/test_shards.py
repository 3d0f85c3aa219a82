"""Shards: however a search is divided, interrupted and merged, its list is the same."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from shutil import copytree
from typing import Any

import numpy as np
import pytest

import grashof.synth.search.journal as journal_module
from grashof import load
from grashof.problems import MotionTask, Objective, Problem, ProblemError, Requirements
from grashof.synth import Result
from grashof.synth.merging import merge_shards
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.chunks import chunk, chunks
from grashof.synth.search.journal import content_of
from grashof.synth.search.plain import plain
from grashof.synth.search.run import Run
from grashof.synth.search.workers import CrashError, Work
from grashof.synth.shards import PROBLEM, SHARDS, Shard, ShardOutcome, solve_shard

FOUR = [[0, 0, 0], [60, 90, 15], [180, 140, 40], [300, 90, 70]]
FIVE = [*FOUR, [360, 0, 90]]
ZONES = MotionTask.from_degrees(FIVE, within=12.0, angle_within_deg=3.0)
ROTATION = MotionTask.from_degrees([[0, 0, 0], [0, 0, 30], [0, 0, 50]], angle_length=1.0)
KINDS: dict[str, tuple[Problem, dict[str, Any]]] = {
    "poses": (load("luggage"), {"starts": 32}),
    "five poses": (Problem(task=MotionTask.from_degrees(FIVE)), {"starts": 16}),
    "points met": (load("path-vertical-line"), {"starts": 16, "enough": 6}),
    "points fitted": (load("path-ellipse"), {"effort": 0.5, "starts": 30}),
    "three kinds": (
        Problem(
            task=MotionTask.from_degrees(FOUR[:3]),
            mechanism=("slider-crank", "four-bar", "inverted-slider-crank"),
        ),
        {"starts": 16},
    ),
    "pairs met": (load("function-five-pairs"), {}),
    "pairs fitted": (load("function-dosing-slide"), {}),
    "limit positions": (load("quick-return"), {}),
    "zones": (Problem(task=ZONES, objective=Objective()), {"effort": 0.5, "starts": 30}),
    "none": (
        Problem(
            task=MotionTask.from_degrees(FIVE),
            requirements=Requirements(link_length=(30.0, 400.0), transmission_min_deg=35.0),
        ),
        {"effort": 0.2, "starts": 10},
    ),
    "degenerate": (Problem(task=ROTATION), {}),
}


def table(result: Result) -> str:
    return result.to_frame().to_csv() + result.note + result.ended + str(result.counts)


def divided(kind: str, folder: Path, of: int, **more: Any) -> list[ShardOutcome]:
    problem, options = KINDS[kind]
    return [solve_shard(problem, Shard(n, of), folder, **options, **more) for n in range(of, 0, -1)]


def one_shard(folder: Path) -> ShardOutcome:
    """A search of two chunks."""
    return solve_shard(load("luggage"), Shard(1, 1), folder, starts=16)


@pytest.fixture(scope="module")
def searched(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ShardOutcome]:
    """A folder with this search, and its outcome."""
    folder = tmp_path_factory.mktemp("searched")
    return folder, one_shard(folder)


@pytest.fixture
def shard(searched: tuple[Path, ShardOutcome], tmp_path: Path) -> Path:
    """A copy of it."""
    copytree(searched[0], tmp_path, dirs_exist_ok=True)
    return tmp_path


@pytest.mark.slow
@pytest.mark.quick("zones", "pairs fitted", "limit positions")
@pytest.mark.usefixtures("small_search")
@pytest.mark.parametrize("kind", KINDS)
def test_the_list_does_not_depend_on_the_number_of_shards(kind: str, tmp_path: Path) -> None:
    merged = []
    for of in (1, 3):
        made = divided(kind, tmp_path / str(of), of)
        assert all(one.complete and one.chunks == one.of for one in made)
        merged.append(merge_shards(tmp_path / str(of)))
    one, several = merged
    assert table(one) == table(several)
    assert (len(one) > 0) == (kind not in ("none", "degenerate"))
    assert all(design.verdict.ok for design in one.candidates)


@pytest.mark.slow
@pytest.mark.usefixtures("small_search")
def test_shards_search_every_kind_of_linkage(tmp_path: Path) -> None:
    problem, _ = KINDS["three kinds"]
    divided("three kinds", tmp_path, 2)
    found = {design.linkage.mechanism.word for design in merge_shards(tmp_path).candidates}
    assert found == set(problem.mechanism)


@pytest.mark.study
def test_all_chunks_are_made_and_nothing_ends_them_early(tmp_path: Path) -> None:
    problem = load("luggage")
    made = solve_shard(problem, Shard(1, 1), tmp_path, enough=1, starts=12, effort=1.5)
    assert made.chunks == made.of == 6
    assert made.solved == 18  # starts times effort
    assert len(merge_shards(tmp_path)) == made.designs


@pytest.mark.study
def test_a_killed_shard_is_resumed(tmp_path: Path, mortal: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journal_module, "EVERY", 0.0)
    whole = tmp_path / "whole"
    divided("poses", whole, 1)
    problem, options = KINDS["poses"]
    tries = 0
    while True:
        mortal.left, tries = 12, tries + 1  # of eight a chunk: one a try is made
        try:
            solve_shard(problem, Shard(1, 1), tmp_path / "killed", **options)
            break
        except mortal.killed:
            with pytest.raises(ProblemError, match=r"shard 1 of 1 to be done; --partial merges the others"):
                merge_shards(tmp_path / "killed")
    assert tries == 4
    assert table(merge_shards(tmp_path / "killed")) == table(merge_shards(whole))


@pytest.mark.study
def test_a_stopped_shard_is_not_complete(tmp_path: Path) -> None:
    problem, options = KINDS["poses"]
    seen: list[int] = []
    made = solve_shard(
        problem,
        Shard(1, 1),
        tmp_path,
        **options,
        progress=lambda step: seen.append(step.solved),
        stop=lambda: len(seen) > 1,
    )
    assert not made.complete
    assert seen[:2] == [8, 16]
    assert solve_shard(problem, Shard(1, 1), tmp_path, **options).complete


class Mortal(Work):
    """Chunks end the process that makes them; starts do not."""

    def made(self, make: Any, scaled: ScaledProblem, *which: float) -> Any:
        if make is chunk:
            raise CrashError("a worker process was lost twice")
        return super().made(make, scaled, *which)


@pytest.mark.study
def test_a_chunk_that_ends_its_process_is_made_start_by_start() -> None:
    scaled = ScaledProblem.of(load("luggage"))
    search = scaled.problem.search
    known, again = (
        list(chunks(scaled, Run(search, work, lambda: False), range(2), 5)) for work in (Work(), Mortal())
    )
    assert repr(plain(tuple(known))) == repr(plain(tuple(again)))
    assert np.shape(known) == (2,)


@pytest.mark.slow
def test_missing_shards_are_named_or_left_out(tmp_path: Path) -> None:
    problem, options = KINDS["poses"]
    for number in (1, 4):
        solve_shard(problem, Shard(number, 4), tmp_path, **options)
    with pytest.raises(ProblemError, match=r"shards 2, 3 of 4 to be done"):
        merge_shards(tmp_path)
    some = merge_shards(tmp_path, partial=True)
    for number in (2, 3):
        solve_shard(problem, Shard(number, 4), tmp_path, **options)
    assert 0 < some.counts["verified"] < merge_shards(tmp_path).counts["verified"]


@pytest.mark.slow
def test_shards_of_other_searches_are_refused(tmp_path: Path) -> None:
    problem, options = KINDS["poses"]
    solve_shard(problem, Shard(1, 2), tmp_path, **options)
    with pytest.raises(ProblemError, match="a search with seed 0; here it is 3"):
        solve_shard(problem, Shard(1, 2), tmp_path, **options, seed=3)
    with pytest.raises(ProblemError, match="for another problem"):
        solve_shard(load("path-ullah"), Shard(1, 2), tmp_path)
    solve_shard(problem, Shard(2, 2), tmp_path, **options, seed=3)
    with pytest.raises(ProblemError, match="a search with seed 3; here it is 0"):
        merge_shards(tmp_path)
    solve_shard(problem, Shard(1, 3), tmp_path, **options)
    with pytest.raises(ProblemError, match="has shards of 2 and of 3; they must be of one search"):
        merge_shards(tmp_path)


@pytest.mark.slow
@pytest.mark.quick("a verdict that is wrong")
@pytest.mark.parametrize("damage", ["truncated", "another figure", "a verdict that is wrong"])
@pytest.mark.usefixtures("shard")
def test_damaged_records_are_not_merged_but_repeated(
    damage: str, searched: tuple[Path, ShardOutcome], tmp_path: Path
) -> None:
    whole = table(merge_shards(tmp_path))
    path = tmp_path / SHARDS / Shard(1, 1).folder / "000001.json"
    text = path.read_text(encoding="utf-8")
    first = json.loads(text)["steps"][0]["result"]["Chunk"]["designs"][0]["Candidate"]
    worst = json.dumps(first["verdict"]["Verdict"]["transmission_min_task"])
    better = text.replace(worst, "1.5")
    assert better != text
    harmed = {
        "truncated": text[: len(text) // 2],
        "another figure": better,
        "a verdict that is wrong": json.dumps(content_of(json.loads(better)["steps"])),
    }
    path.write_text(harmed[damage], encoding="utf-8")
    with pytest.raises(ProblemError, match=r"is damaged; delete it, and run the shard again"):
        merge_shards(tmp_path)
    if damage == "a verdict that is wrong":  # noticed by the judge alone
        path.unlink()
    assert one_shard(tmp_path) == searched[1]
    assert table(merge_shards(tmp_path)) == whole


def tampered(folder: Path, change: Callable[[dict[str, Any]], object], *, every: bool = False) -> None:
    """Another first chunk, or every one, with a sum that is right."""
    files = sorted((folder / SHARDS / Shard(1, 1).folder).glob("0*.json"))
    for path in files if every else files[:1]:
        steps = json.loads(path.read_text(encoding="utf-8"))["steps"]
        for step in steps if every else steps[:1]:
            change(step["result"]["Chunk"])
        path.write_text(json.dumps(content_of(steps)), encoding="utf-8")


def design(chunk: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = chunk["designs"][0]["Candidate"]
    return found


def verdict(chunk: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = design(chunk)["verdict"]["Verdict"]
    return found


@pytest.mark.slow
@pytest.mark.usefixtures("shard")
def test_shards_of_another_kind_of_processor_are_merged(tmp_path: Path) -> None:

    def rounded_otherwise(chunk: dict[str, Any]) -> None:
        judged = verdict(chunk)
        judged["position_error"]["array"][2][0] += 2e-15
        judged["theta2"]["array"][2][0] *= 1 + 1e-14
        judged["transmission_min_task"] *= 1 - 1e-14

    tampered(tmp_path, rounded_otherwise)
    assert merge_shards(tmp_path).best.verdict.ok


DEFECT = {"Defect": {"requirement": "r2", "what": "\x1b[31m", "found": 1.0, "allowed": "2", "miss": 1e-3}}
CHANGES: dict[str, Callable[[dict[str, Any]], object]] = {
    "no tally": lambda chunk: chunk.update(tally=None),
    "designs that are none": lambda chunk: chunk.update(designs="two"),
    "a count of solves that is none": lambda chunk: chunk.update(solved="8"),
    "no linkage": lambda chunk: design(chunk).update(linkage=None),
    "a length that is none": lambda chunk: design(chunk)["linkage"]["FourBar"].update(r2=-1.0),
    "fewer targets": lambda chunk: verdict(chunk).update(assembly={"array": ["<i8", [0], []]}),
    "a number beyond 64 bits": lambda chunk: chunk.update(solved={"scalar": ["<i8", [], 2**80]}),
    "a formula": lambda chunk: design(chunk).update(best_at="=1+1"),
    "control characters": lambda chunk: design(chunk).update(cognate_of="\x1b[31m"),
    "a defect": lambda chunk: verdict(chunk).update(defects=[DEFECT]),
}


@pytest.mark.quick("no tally", "a formula")
@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.usefixtures("shard")
def test_a_chunk_that_no_search_leaves_is_damaged(change: str, tmp_path: Path) -> None:
    tampered(tmp_path, CHANGES[change])
    with pytest.raises(ProblemError, match=r"is damaged; delete it, and run the shard again"):
        merge_shards(tmp_path)


@pytest.mark.usefixtures("shard")
def test_misses_are_judged_again_where_they_may_be_listed(tmp_path: Path) -> None:

    def missing(chunk: dict[str, Any]) -> None:
        if chunk["designs"]:
            verdict(chunk).update(defects=[DEFECT])
            miss = {"status": "Solve_Succeeded", "candidate": chunk["designs"][0], "cognates": []}
            chunk.update(designs=[], misses=[{"Attempt": miss}])

    tampered(tmp_path, missing, every=True)
    with pytest.raises(ProblemError, match=r"is damaged; delete it, and run the shard again"):
        merge_shards(tmp_path)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"seed": "0"}, r"search\.json: search\.seed is '0'; it must be a whole number from 0"),
        ({"seed": False}, r"search\.json: search\.seed is False; it must be a whole number from 0"),
        ({"name": None}, r"search\.json: name is None; it must be text"),
        ({"name": "\x1b[31m"}, r"search\.json: name has control character U\+001B"),
        ({"format": "x" * 9999}, r"a search with format 'x{,80}\.\.\.x*'; here it is 2$"),
        ({"format": "two\nlines"}, r"a search with format 'two\\nlines'; here it is 2$"),
        ({"effort": 1}, r"a search with effort 1; here it is 1\.0$"),
    ],
)
@pytest.mark.usefixtures("shard")
def test_a_head_that_no_search_wrote_is_refused_in_a_line(
    change: dict[str, Any], said: str, tmp_path: Path
) -> None:
    head = tmp_path / SHARDS / Shard(1, 1).folder / "search.json"
    head.write_text(json.dumps(json.loads(head.read_text(encoding="utf-8")) | change), encoding="utf-8")
    with pytest.raises(ProblemError, match=said) as refused:
        merge_shards(tmp_path)
    assert str(refused.value).startswith(str(tmp_path))
    assert len(str(refused.value).splitlines()) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="no pipes in folders")
@pytest.mark.parametrize("name", ["search.json", "problem.toml", "000001.json"])
@pytest.mark.usefixtures("shard")
def test_a_pipe_in_the_place_of_a_file_is_not_waited_for(name: str, tmp_path: Path) -> None:
    path = tmp_path / SHARDS / Shard(1, 1).folder / name
    path.unlink()
    os.mkfifo(path)
    with pytest.raises(ProblemError, match=r"delete"):
        merge_shards(tmp_path)


@pytest.mark.slow
def test_the_problem_file_is_kept(tmp_path: Path) -> None:
    problem, options = KINDS["poses"]
    text = "# mine\n" + (Path(__file__).parents[2] / "problems/data/luggage.toml").read_text(encoding="utf-8")
    solve_shard(problem, Shard(1, 1), tmp_path, text=text, **options)
    assert (tmp_path / SHARDS / "0001-of-0001" / PROBLEM).read_text(encoding="utf-8") == text
    assert merge_shards(tmp_path).problem.name == "luggage"


@pytest.mark.parametrize(
    "text", ["3", "0/2", "3/2", "1/0", "-1/2", "1/2/3", "one/2", "1/999999999", "²/3", ""]
)
def test_invalid_shards_are_refused(text: str) -> None:
    with pytest.raises(ProblemError, match=r"^--shard is '.*'; it must be I/N"):
        Shard.stated(text)
